"""Inverse kinematics: configurations that put a frame where it is to be, each checked by a second engine."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from pinscrew.engines.base import Engine
from pinscrew.engines.pair import pair_of
from pinscrew.ground.arrays import numbers
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.lie import se3, so3
from pinscrew.lie.checks import read, require_bottom_row, require_finite, require_rotation
from pinscrew.motion.descent import Descent
from pinscrew.motion.freedoms import Freedoms, Task, freedoms, task_rows
from pinscrew.robot.loading import RobotLike, robot_of

__all__ = ["TOLERANCE", "Solution", "ik"]

TOLERANCE: Final = 1e-9
"""Error (rad, and m over max(1, length)) of a target that is reached."""

MARGIN: Final = 1e-3
"""What the search aims at, as a part of the tolerance: one step more."""
LEAST: Final = 1e-13
"""The least that it aims at: rounding."""
STEPS: Final = 60
SETTLED: Final = 0.9
"""A start is given up when `WINDOW` steps leave more than this of its squared error."""
LAST_STEPS: Final = 1000
LAST_SETTLED: Final = 1.0 - 1e-6
"""The same of the nearest configuration, where none reaches the target."""
DRAWN: Final = 10
"""Configurations that are drawn for each start: the nearest to the target become starts."""
GROWTH: Final = 4
"""By how much each round of starts is larger than the one before."""
BLOCK: Final = 512
"""Targets that are searched for together."""


@dataclass(frozen=True, eq=False)
class Solution:
    """What `ik` found, for targets with batch axes ``...``.

    Attributes:
        robot: the robot's name.
        frame: the frame.
        task: what was to be reached: ``"pose"`` or ``"position"``.
        q: the configuration that reaches the target, or the nearest that was found; always within the limits;
            shape (..., nq).
        solved: whether ``q`` reaches the target, shape (...).
        position_error: distance (m) of the frame from the target at ``q``, shape (...).
        angle_error: angle (rad) between them, shape (...); it does not count in a position task.
        reason: why a target is not reached, shape (...): ``""`` where it is; ``"outside limits"`` if it is
            reached without the limits only; ``"unreachable"`` if every start ended at a minimum of the error;
            ``"stalled"`` if the error still fell when the steps ran out; ``"unconfirmed"`` if the first engine
            says that it is reached, and the second not.
    """

    robot: str
    frame: str
    task: Task
    q: FloatArray
    solved: npt.NDArray[np.bool_]
    position_error: FloatArray
    angle_error: FloatArray
    reason: npt.NDArray[np.str_]

    @property
    def ok(self) -> bool:
        """Whether every target is reached."""
        return bool(self.solved.all())

    def __str__(self) -> str:
        words = f"{self.robot}, {self.task} of {self.frame}: {int(self.solved.sum())} of {self.solved.size} reached"
        if not self.solved.size:
            return words
        words += f", largest error {self.position_error.max():.3g} m, {self.angle_error.max():.3g} rad"
        reasons, counts = np.unique(self.reason[~self.solved], return_counts=True)
        return "; ".join([words, *(f"{reason}: {count}" for reason, count in zip(reasons, counts, strict=True))])


def ik(
    robot: RobotLike,
    T_base_tip: ArrayLike,
    q0: ArrayLike | None = None,
    *,
    frame: str | None = None,
    task: Task = "pose",
    limits: ArrayLike | None = None,
    starts: int = 100,
    seed: int = 0,
    tolerance: float = TOLERANCE,
    engines: tuple[Engine, Engine] | None = None,
) -> Solution:
    """Configurations within the limits that put ``frame`` at ``T_base_tip``.

    Newton's method on the error twist log(T⁻¹T*), damped in proportion to the error (`pinscrew.motion.descent`),
    from ``q0`` and then from the nearest of ten times ``starts`` configurations drawn within the limits. The first
    start that reaches the target wins: where ``q0`` is near the target, this is a configuration near ``q0``. A last
    forward kinematics by the second engine decides what is solved. All targets are searched for at once, each for
    itself; the same seed finds the same configurations.

    Args:
        robot: a robot, or a name or path that `load` takes.
        T_base_tip: targets, shape (..., 4, 4), m.
        q0: where to start, shape (..., nq), within the limits; its batch axes broadcast against those of the targets.
            Coordinates that do not move the frame keep its values, and angles that can turn are given nearest to it.
            By default `Robot.neutral`, brought within the limits, has its part in this, but is no start.
        frame: a link's name; by default the robot's tip.
        task: reach the ``"pose"``, or only the ``"position"`` of the target.
        limits: lower and upper limit of each entry of ``q``, shape (nq, 2); by default the robot's.
        starts: most starts for a target, ``q0`` among them.
        seed: of the starts.
        tolerance: largest error of a target that is reached, in rad, and in m over max(1, `Freedoms.length`).
        engines: two engines to search and to check with, instead of `PoE` and `Pinocchio` of this robot.

    Returns:
        the configurations, with what is not reached and why. That a target is unreachable is no proof.

    Raises:
        UnknownNameError, AmbiguousTipError: see `Robot.frame`.
        InputError: if a target is no pose, ``q0`` has another shape, is not finite or is outside the limits, no joint
            moves the frame or a planar or floating one does, a displacement has no limits, ``limits`` are reversed,
            there is no such task, ``starts`` is not positive, ``seed`` negative or ``tolerance`` not positive.
        EngineError, UnsupportedError: if Pinocchio does not take the robot.
    """
    robot = robot_of(robot)
    free = freedoms(robot, frame, limits)
    task_rows(task, free.length)
    if not 0.0 < tolerance < math.inf:
        raise InputError("tolerance", f"tolerance={tolerance}", remedy="give a positive number, such as 1e-9")
    T, q, batch = _asked(free, T_base_tip, q0, limits)
    search = _Search(free, engines or pair_of(robot), task, starts, seed, tolerance)
    parts = [search.solve(T[i : i + BLOCK], q[i : i + BLOCK], q0 is not None) for i in range(0, len(T), BLOCK)]
    found = [np.concatenate(part) for part in zip(*(parts or [search.solve(T, q, q0 is not None)]), strict=True)]
    configurations, distance, angle, reason = found
    return Solution(
        robot=robot.name,
        frame=free.frame,
        task=task,
        q=configurations.reshape(*batch, robot.nq),
        solved=(reason == "").reshape(batch),
        position_error=distance.reshape(batch),
        angle_error=angle.reshape(batch),
        reason=reason.reshape(batch),
    )


class _Search:
    """The search for configurations of one robot's frame."""

    def __init__(
        self, free: Freedoms, engines: tuple[Engine, Engine], task: Task, starts: int, seed: int, tolerance: float
    ) -> None:
        self._free = free
        self._engines = engines
        self._task: Task = task
        self._starts = starts
        self._tolerance = tolerance
        self._drawn = free.draw(seed, starts, DRAWN)
        self._marks = self._features(Descent(free, engines[0], free.robot.neutral, task, 0.0).poses(self._drawn))

    def solve(
        self, T: FloatArray, q: FloatArray, given: bool
    ) -> tuple[FloatArray, FloatArray, FloatArray, npt.NDArray[np.str_]]:
        """Configurations (N, nq), errors (N,) in m and rad, and reasons (N,), from ``q`` (N, nq) first if ``given``."""
        nearest = self._nearest(T)
        first = q[:, self._free.q]
        if given:
            nearest = np.concatenate([first[:, None], nearest[:, : self._starts - 1]], axis=1)
        x, reached = self._descend(self._free, T, nearest)
        reason = np.where(reached, "", "unreachable").astype("U16")
        missed = np.flatnonzero(~reached)
        last = self._descent(self._free).run(T[missed], x[missed], LAST_STEPS, LAST_SETTLED, downhill=True)
        x[missed] = last.x
        reason[missed[~last.settled]] = "stalled"
        reason[missed[last.converged]] = ""
        missed = missed[~last.converged]
        if np.isfinite(self._free.limits[~self._free.wraps]).any():
            _, beyond = self._descend(self._free.unlimited(), T[missed], nearest[missed])
            reason[missed[beyond]] = "outside limits"
        out = self._free.put(q, self._free.nearest_turn(x, first))
        distance, angle = self._errors(T, out)
        # A comparison with NaN is false, so the good ones are asked for.
        good = distance <= self._tolerance * max(1.0, self._free.length)
        if self._task == "pose":
            good &= angle <= self._tolerance
        reason[~good & (reason == "")] = "unconfirmed"
        reason[good] = ""
        return out, distance, angle, reason

    def _descend(self, free: Freedoms, T: FloatArray, starts: FloatArray) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
        """The best values (N, m) from starts (N, S, m), tried in rounds of growing size, and whether they do."""
        descent = self._descent(free)
        x, error, reached = starts[:, 0].copy(), np.full(len(T), np.inf), np.zeros(len(T), dtype=bool)
        at, size = 0, 1
        while at < starts.shape[1] and not reached.all():
            left = np.flatnonzero(~reached)
            chosen = starts[left, at : at + size]
            count = chosen.shape[1]
            lanes = descent.run(np.repeat(T[left], count, axis=0), chosen.reshape(-1, len(free.q)), STEPS, SETTLED)
            converged, errors = lanes.converged.reshape(-1, count), lanes.error.reshape(-1, count)
            # The first that converged, or else the one with the least error.
            best = np.where(converged.any(axis=1), converged.argmax(axis=1), errors.argmin(axis=1))
            rows = np.arange(len(left))
            reached[left] = converged[rows, best]
            better = reached[left] | (errors[rows, best] < error[left])
            x[left[better]] = lanes.x.reshape(-1, count, len(free.q))[rows, best][better]
            error[left[better]] = errors[rows, best][better]
            at, size = at + size, GROWTH * size
        return x, reached

    def _descent(self, free: Freedoms) -> Descent:
        return Descent(free, self._engines[0], free.robot.neutral, self._task, max(LEAST, MARGIN * self._tolerance))

    def _features(self, T: FloatArray) -> FloatArray:
        """Numbers (N, k) whose distances tell how far poses are from each other."""
        p = T[:, :3, 3] / self._free.length
        # ‖R₁ - R₂‖² = 4 (1 - cos θ), twice the squared angle where that is small.
        return p if self._task == "position" else np.concatenate([p, T[:, :3, :3].reshape(-1, 9) / math.sqrt(2.0)], 1)

    def _nearest(self, T: FloatArray) -> FloatArray:
        """The drawn configurations nearest to each target, shape (N, starts, m), nearest first."""
        distances = (self._marks**2).sum(axis=1) - 2.0 * self._features(T) @ self._marks.T
        order = np.argsort(distances, axis=1, kind="stable")[:, : self._starts]
        return self._drawn[order]

    def _errors(self, T: FloatArray, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Distances and angles (N,) from the targets, by the second engine."""
        found = self._engines[1].fk(q, self._free.frame)
        turn = so3.log(np.swapaxes(found[:, :3, :3], 1, 2) @ T[:, :3, :3])
        return np.linalg.norm(found[:, :3, 3] - T[:, :3, 3], axis=1), np.linalg.norm(turn, axis=1)


def _asked(
    free: Freedoms, T_base_tip: ArrayLike, q0: ArrayLike | None, limits: ArrayLike | None
) -> tuple[FloatArray, FloatArray, tuple[int, ...]]:
    """Targets (N, 4, 4) and configurations (N, nq), checked, and their common batch axes."""
    robot = free.robot
    T = read(T_base_tip, (4, 4), "ik", "T_base_tip")
    require_finite(T, 2, "ik", "T_base_tip")
    require_rotation(T[..., :3, :3], "ik", "the rotation part of T_base_tip")
    require_bottom_row(T, "ik", "T_base_tip")
    q = robot.neutral if q0 is None else read(q0, (robot.nq,), "ik", "q0")
    require_finite(q, 1, "ik", "q0")
    bounds = robot.limits if limits is None else numbers(limits, "limits", robot.name)
    within = np.clip(q, *bounds.T)
    if q0 is not None and (np.abs(within - q) > TOLERANCE).any():
        i = int(np.argwhere(np.abs(within - q) > TOLERANCE)[0][-1])
        what = f"q0 holds a value of {robot.coordinate_names[i]!r} outside its limits {bounds[i].tolist()}"
        raise InputError("outside-limits", what, where=robot.name, remedy="start within the limits")
    try:
        batch = np.broadcast_shapes(T.shape[:-2], q.shape[:-1])
    except ValueError:
        what = f"the batch axes of T_base_tip {T.shape[:-2]} and q0 {q.shape[:-1]} do not broadcast"
        raise InputError("shape", what, where=robot.name) from None
    poses = np.broadcast_to(se3.project(T), (*batch, 4, 4)).reshape(-1, 4, 4)
    return poses, np.broadcast_to(within, (*batch, robot.nq)).reshape(math.prod(batch), robot.nq), batch
