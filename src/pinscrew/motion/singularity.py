"""Singular configurations in numbers: what a frame can't do there, and which joints then move without moving it.

A frame is singular at q where the rank of its Jacobian is less than almost everywhere else. Near q, along q + tw, the
image of J contains (∂J/∂w) z for each z with Jz = 0: what of these is not in the image of J(q) is lost at q. The
smallest singular value σ = uᵀJz that vanishes at singular configurations has the derivative uᵀ(∂J/∂qᵢ)z, which says
on which joints the condition σ = 0 depends.

What is lost at q is a direction u that no velocity of the frame has a part in. As a motion it depends on how metres
compare with radians. As a wrench F it does not: FᵀJ = 0, F does no work on any motion that is left. A pure force along
a line says that no point of that line can move along it; a pure couple, that the frame can't turn about its axis.

Closed forms, for arms that have them, are in `pinscrew.derivation.singularities`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.engines.poe import PoE
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.lie.checks import read, require_finite
from pinscrew.lie.screw import Screw
from pinscrew.motion.freedoms import Freedoms, Task, freedoms, task_rows
from pinscrew.robot.loading import RobotLike, robot_of

__all__ = ["TOLERANCE", "ScaledJacobian", "Singularity", "classify_singularity"]

TOLERANCE: Final = 1e-9
"""Singular values below this part of the largest count as zero."""

DEPENDS: Final = 1e-6
"""Derivatives below this part of the largest count as zero."""
SAMPLES: Final = 8
"""Configurations at which the rank is taken that a Jacobian has almost everywhere."""


@dataclass(frozen=True, eq=False)
class Singularity:
    """A configuration, and what a frame can't do there.

    Metres are divided by ``length``, in rows of the Jacobian and in displacements of joints, so that singular values
    have no unit and directions can be perpendicular.

    Attributes:
        robot: the robot's name.
        frame: the frame.
        task: what counts: its whole motion, ``"pose"``, or that of its origin, ``"position"``.
        q: the configuration, shape (nq,).
        length: characteristic length (m); see `pinscrew.motion.freedoms.freedoms`.
        singular_values: of the scaled Jacobian, largest first.
        rank: how many of them are not zero.
        freedoms: the rank that the Jacobian has at almost all configurations.
        lost: twists (v, ω) that the frame can't have here, but has next to here: hybrid ones, v that of its origin,
            with the axes of the base; shape (6, k), ω or else v of length 1. They are perpendicular to all that it
            can have. None at regular configurations, and where no first derivative brings them back.
        wrenches: the same as wrenches (f, m), m about the frame's origin, that do no work on what the frame can do;
            they do not depend on ``length``. Shape (6, k), f or else m of length 1.
        self_motions: velocities that do not move the frame, shape (nv, s): the kernel of the Jacobian.
        joints: the joints whose values decide whether it is singular, to first order.
        outside: the coordinates whose value is outside the robot's limits.
        T_base_frame: pose of the frame, shape (4, 4).
        coordinate_names: the names of ``q``.
        velocity_names: the names of ``self_motions``' rows.
    """

    robot: str
    frame: str
    task: Task
    q: FloatArray
    length: float
    singular_values: FloatArray
    rank: int
    freedoms: int
    lost: FloatArray
    wrenches: FloatArray
    self_motions: FloatArray
    joints: tuple[str, ...]
    outside: tuple[str, ...]
    T_base_frame: FloatArray
    coordinate_names: tuple[str, ...]
    velocity_names: tuple[str, ...]

    @property
    def singular(self) -> bool:
        """Whether the frame has less freedom here than elsewhere."""
        return self.rank < self.freedoms

    @property
    def wrench_screws(self) -> tuple[Screw, ...]:
        """The lines and pitches of the wrenches, in the base frame: pitch 0 for a force, ∞ for a couple."""
        p = self.T_base_frame[:3, 3]
        # A wrench (f, τ) about p has about the origin the moment τ + p × f; as a screw, f stands for a twist's ω and
        # the moment for its v (MLS 2.5, ray and axis coordinates).
        screws = (Screw.from_twist([*(F[3:] + np.cross(p, F[:3])), *F[:3]]) for F in self.wrenches.T)
        return tuple(replace(s, pitch=0.0) if abs(s.pitch) < TOLERANCE * self.length else s for s in screws)

    def __str__(self) -> str:
        kind = "singular" if self.singular else "regular"
        lines = [f"{self.robot}, {self.task} of {self.frame}: {kind}, rank {self.rank} of {self.freedoms}"]
        if self.singular:
            lines[0] += f", by {self._cause()}"
        if self.outside:
            lines[0] += f" (outside the limits of {', '.join(self.outside)})"
        lines += [f"lost: {_words(screw, self.task)}" for screw in self.wrench_screws]
        for motion in self.self_motions.T:
            moving = [f"{name} {x:+.3g}" for name, x in zip(self.velocity_names, motion, strict=True) if x]
            lines.append(f"moves without moving {self.frame}: {', '.join(moving)}")
        return "\n".join(lines)

    def _cause(self) -> str:
        if len(self.joints) != 1:
            return ", ".join(self.joints) or "no joint to first order"
        return f"{self.joints[0]} = {round(float(self.q[self.coordinate_names.index(self.joints[0])]), 9) + 0.0:.6g}"


def classify_singularity(
    robot: RobotLike,
    q: ArrayLike,
    frame: str | None = None,
    *,
    task: Task = "pose",
    tolerance: float = TOLERANCE,
    length: float | None = None,
    engine: Engine | None = None,
) -> Singularity:
    """Whether ``frame`` is singular at ``q``, and what it has lost there.

    Args:
        robot: a robot, or a name or path that `load` takes.
        q: the configuration, shape (nq,), rad and m.
        frame: a link's name; by default the robot's tip.
        task: what counts, the motion of its ``"pose"`` or of its ``"position"``. An arm whose joint axes stay
            independent as screws is singular in its position only.
        tolerance: part of the largest singular value below which one counts as zero.
        length: characteristic length (m) that counts as much as a radian; see `pinscrew.motion.freedoms.freedoms`.
        engine: what to ask instead of `PoE`.

    Raises:
        UnknownNameError, AmbiguousTipError: see `Robot.frame`.
        InputError: if ``q`` has another shape or is not finite, no joint moves the frame or a planar or floating one
            does, there is no such task, or ``tolerance`` or ``length`` is not positive.
    """
    robot = robot_of(robot)
    free = freedoms(robot, frame, length=length)
    values = read(q, (robot.nq,), "classify_singularity", "q")
    if values.ndim != 1:
        raise InputError("shape", f"q has shape {values.shape}", where=robot.name, remedy=f"expected ({robot.nq},)")
    require_finite(values, 1, "classify_singularity", "q")
    jacobian = ScaledJacobian(free, engine or PoE(robot), task, tolerance)
    return jacobian.classify(values)


class ScaledJacobian:
    """The scaled Jacobian of a task, and its derivatives."""

    def __init__(self, free: Freedoms, engine: Engine, task: Task, tolerance: float) -> None:
        if not 0.0 < tolerance < 1.0:
            raise InputError("tolerance", f"tolerance={tolerance}", remedy="give a small positive number, such as 1e-9")
        self.free = free
        self._engine = engine
        self.task: Task = task
        self._tolerance = tolerance
        self._weights = task_rows(task, free.length)
        # A Jacobian is analytic in q, so nearly every configuration has the largest rank, limits or not.
        x = free.scales * np.random.default_rng(0).uniform(-np.pi, np.pi, (SAMPLES, len(free.q)))
        values = np.linalg.svd(self.matrix(free.put(free.robot.neutral, x)), compute_uv=False)
        self.freedoms = int((values > tolerance * values[:, :1]).sum(axis=1).max())

    def classify(self, q: FloatArray) -> Singularity:
        """What `classify_singularity` returns, for coordinates (nq,)."""
        free, robot = self.free, self.free.robot
        J, dJ = self.matrix(q), self.derivatives(q)
        U, values, _ = np.linalg.svd(J)
        rank = int((values > self._tolerance * values[0]).sum())
        left, kernel = U[:, rank:], self._kernel(J, rank)
        # What the next configurations bring back of what this one can't do: (left, m, kernel).
        regained = np.einsum("al,iab,bk->lik", left, dJ, kernel)
        lost = left
        # Three cases. Full rank: nothing is lost. A task of which something can never be done (rank at most m < k, such
        # as tilting for a SCARA): of the left null space only what neighbours regain is lost here. Else all of it.
        if rank == self.freedoms:
            lost = left[:, :0]
        elif self.freedoms < len(self._weights):
            directions, strengths, _ = np.linalg.svd(regained.reshape(left.shape[1], -1))
            lost = left @ directions[:, : int((strengths > DEPENDS * max(1.0, strengths[0])).sum())]
        # On which joints σ = 0 depends: ∂σ/∂qᵢ = uᵀ (∂J/∂qᵢ) z, over all pairs of u and z.
        share = np.linalg.norm(np.einsum("al,iab,bk->lik", lost, dJ, kernel), axis=(0, 2))
        depends = share > DEPENDS * max(1.0, share.max())
        # Rows were divided by lengths: a direction of motion goes back by them, a wrench against them, so that F·V is
        # the same power in both.
        lengths = 1.0 / self._weights
        outside = (q < robot.limits[:, 0] - TOLERANCE) | (q > robot.limits[:, 1] + TOLERANCE)
        motions = np.zeros((robot.nv, kernel.shape[1]))
        motions[free.v] = free.scales[:, None] * _tidy(kernel)
        return Singularity(
            robot=robot.name,
            frame=free.frame,
            task=self.task,
            q=q,
            length=free.length,
            singular_values=values,
            rank=rank,
            freedoms=self.freedoms,
            lost=_unit(_tidy(lost) * lengths[:, None], first=3),
            wrenches=_unit(_tidy(lost) / lengths[:, None], first=0),
            self_motions=motions,
            joints=tuple(name for name, matters in zip(free.names, depends, strict=True) if matters),
            outside=tuple(name for name, out in zip(robot.coordinate_names, outside, strict=True) if out),
            T_base_frame=self._engine.fk(q, free.frame),
            coordinate_names=robot.coordinate_names,
            velocity_names=robot.velocity_names,
        )

    def _kernel(self, J: FloatArray, rank: int) -> FloatArray:
        """An orthonormal basis (m, m - rank) of what J takes to zero.

        A joint that does not move the frame by itself, such as the last of an arm the place of its own axis, is in
        it by itself. The rest is the kernel of the other columns: one basis of all would mix the two by rounding.
        """
        sizes = np.linalg.norm(J, axis=0)
        idle = sizes <= self._tolerance * sizes.max(initial=0.0)
        rest = np.linalg.svd(J[:, ~idle])[2][rank:].T
        kernel = np.zeros((J.shape[1], int(idle.sum()) + rest.shape[1]))
        kernel[idle, : idle.sum()] = np.eye(int(idle.sum()))
        kernel[~idle, idle.sum() :] = rest
        return kernel

    def matrix(self, q: FloatArray) -> FloatArray:
        """The scaled hybrid Jacobian (..., k, m)."""
        return self._scaled(self._engine.jacobian(q, self.free.frame, "hybrid"))

    def derivatives(self, q: FloatArray) -> FloatArray:
        """Its derivatives (..., m, k, m) by each scaled coordinate, in the second axis from the first."""
        free = self.free
        qd = np.zeros((len(free.q), free.robot.nv))
        qd[np.arange(len(free.q)), free.v] = free.scales
        return self._scaled(self._engine.jacobian_derivative(q[..., None, :], qd, free.frame, "hybrid"))

    def _scaled(self, J: FloatArray) -> FloatArray:
        rows = len(self._weights)
        return self._weights[:, None] * J[..., :rows, :][..., self.free.v] * self.free.scales


def _tidy(directions: FloatArray) -> FloatArray:
    """Orthonormal columns with the rounding of zero as zero, and the largest entry of each positive."""
    out = np.where(np.abs(directions) < TOLERANCE, 0.0, directions)
    largest = np.take_along_axis(out, np.abs(out).argmax(axis=0, keepdims=True), axis=0)
    return np.asarray(out * np.sign(largest) + 0.0)


def _unit(directions: FloatArray, first: int) -> FloatArray:
    """Columns (6, k), where three entries from the ``first``, or else the others, have the length 1."""
    out = np.zeros((6, directions.shape[1]))
    out[: len(directions)] = directions
    sizes = np.linalg.norm(out[first : first + 3], axis=0)
    return np.asarray(out / np.where(sizes > 0.0, sizes, np.linalg.norm(out, axis=0)))


def _words(screw: Screw, task: Task) -> str:
    """What is lost, where a wrench with this screw does no work."""
    direction, point = (
        f"({', '.join(f'{x:.4g}' for x in np.round(vector, 9) + 0.0)})" for vector in (screw.direction, screw.point)
    )
    if math.isinf(screw.pitch):
        return f"rotation about {direction}"
    if task == "position":
        return f"translation along {direction}"
    line = f"the line through {point} m along {direction}"
    if screw.pitch == 0.0:
        return f"translation of the points on {line}, along it"
    return f"what a wrench of pitch {screw.pitch:.4g} m on {line} would drive"
