"""The search for singular configurations: Newton's method on the singular value that vanishes there."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.engines.poe import PoE
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.motion.freedoms import TURN, Freedoms, Task, freedoms
from pinscrew.motion.singularity import TOLERANCE, ScaledJacobian, Singularity
from pinscrew.robot.loading import RobotLike, robot_of

__all__ = ["SingularFamilies", "find_singularities"]

STEPS: Final = 200
LONGEST: Final = 0.5
"""Longest step (rad) of the search."""
ZERO: Final = 1e-15
"""A singular value that can't be lessened."""
SAME: Final = 1e-6
"""Difference of values of one joint (rad, or displacements over the characteristic length) that are the same."""


class SingularFamilies(tuple[Singularity, ...]):
    """Singular configurations, one of each family, and what they are singular in.

    Attributes:
        robot: the robot's name.
        frame: the frame's.
        task: ``"pose"`` or ``"position"``.
    """

    robot: str
    frame: str
    task: Task

    def __new__(cls, found: Iterable[Singularity], *, robot: str, frame: str, task: Task) -> SingularFamilies:
        self = super().__new__(cls, found)
        self.robot, self.frame, self.task = robot, frame, task
        return self

    def __getnewargs_ex__(self) -> tuple[tuple[tuple[Singularity, ...]], dict[str, str]]:
        return (tuple(self),), {"robot": self.robot, "frame": self.frame, "task": self.task}

    def __str__(self) -> str:
        families = "1 singular family" if len(self) == 1 else f"{len(self) or 'no'} singular families"
        head = f"{self.robot}, {self.task} of {self.frame}: {families}"
        return "\n".join([head, *map(str, self)])


def find_singularities(
    robot: RobotLike,
    frame: str | None = None,
    *,
    task: Task | None = None,
    limits: ArrayLike | None = None,
    starts: int = 100,
    seed: int = 0,
    tolerance: float = TOLERANCE,
    length: float | None = None,
    engine: Engine | None = None,
) -> SingularFamilies:
    """Singular configurations of ``frame`` within the limits, one of each family that is found.

    From configurations at random, Newton's method goes the shortest way to where the smallest singular value is zero.
    Singular configurations come in families: two belong to one if they have the same rank, depend on the same joints
    and, where that is a single joint, on the same value of it. The one nearest to `Robot.neutral` stands for each.
    A family that no start leads to is not found, and what is found apart may be one family, met at a special point.

    Args:
        robot, frame, tolerance, length, engine: see `classify_singularity`.
        task: see there; by default the one that a person means: the pose of a frame that can have any twist, else the
            position. A SCARA, whose 6×3 Jacobian never loses rank, is singular where it is stretched out.
        limits: lower and upper limit of each entry of ``q``, shape (nq, 2); by default the robot's.
        starts: how many starts.
        seed: of the starts.

    Returns:
        the singular configurations, those that the most starts led to first; other coordinates are neutral. It knows
        the task, which there being none would not tell.

    Raises:
        UnknownNameError, AmbiguousTipError: see `Robot.frame`.
        InputError: see `classify_singularity`; also if a displacement has no limits, ``limits`` are reversed,
            ``starts`` is not positive or ``seed`` negative.
    """
    robot = robot_of(robot)
    free = freedoms(robot, frame, limits, length)
    jacobian = _of_task(free, engine or PoE(robot), task, tolerance)
    x = _descend(jacobian, free.draw(seed, starts))
    found = [jacobian.classify(q) for q in free.put(robot.neutral, free.nearest_turn(x, np.zeros_like(x)))]
    families: dict[tuple[object, ...], list[Singularity]] = {}
    for one in found:
        if one.singular:
            families.setdefault(_family(one, free), []).append(one)
    ordered = sorted(families.values(), key=len, reverse=True)
    nearest = (min(family, key=lambda one: _distance(one, free)) for family in ordered)
    return SingularFamilies(nearest, robot=robot.name, frame=free.frame, task=jacobian.task)


def _of_task(free: Freedoms, engine: Engine, task: Task | None, tolerance: float) -> ScaledJacobian:
    """The Jacobian of a task, or of the one that is meant where none is named."""
    whole = ScaledJacobian(free, engine, task or "pose", tolerance)
    if task is not None or whole.freedoms == 6:
        return whole
    position = ScaledJacobian(free, engine, "position", tolerance)
    return position if position.freedoms else whole


def _descend(jacobian: ScaledJacobian, x: FloatArray) -> FloatArray:
    """From values (N, m) to where the last singular value is zero, or as small as can be: (N, m)."""
    free, last = jacobian.free, jacobian.freedoms - 1
    x, going = x.copy(), np.arange(len(x) if last >= 0 else 0)
    for _ in range(STEPS):
        q = free.put(free.robot.neutral, x[going])
        U, values, Vt = np.linalg.svd(jacobian.matrix(q))
        # σ = uᵀ J z, so that ∂σ/∂qᵢ = uᵀ (∂J/∂qᵢ) z, as u and z stay unit vectors (Golub & Van Loan, 8.6.1). The
        # shortest step that Newton's method makes of σ + gᵀ dq = 0 is dq = -σ g / ‖g‖².
        sigma = values[:, last]
        g = np.einsum("na,niab,nb->ni", U[:, :, last], jacobian.derivatives(q), Vt[:, last])
        g[free.held(x[going], -g)] = 0.0  # a coordinate at its limit can't go further
        slope = np.linalg.norm(g, axis=1)
        on = (sigma > ZERO) & (slope > ZERO)  # where there is no slope, it is as small as can be
        going, g, slope = going[on], g[on], slope[on]
        if not len(going):
            break
        # Far away the tangent promises too much: where σ is nearly flat, the full step is many turns long.
        length = np.minimum(sigma[on] / slope, LONGEST)
        x[going] = free.brought_within(x[going] - free.scales * (length / slope)[:, None] * g)
    return x


def _family(one: Singularity, free: Freedoms) -> tuple[object, ...]:
    """What is the same for all singular configurations of a family."""
    if len(one.joints) != 1:
        return one.rank, one.joints
    i = free.names.index(one.joints[0])
    value = float(one.q[free.q[i]] / free.scales[i])
    number = round((value % TURN if free.turns[i] else value) / SAME)
    return one.rank, one.joints, number % round(TURN / SAME) if free.turns[i] else number


def _distance(one: Singularity, free: Freedoms) -> float:
    """From `Robot.neutral`, in rad."""
    return float(np.linalg.norm((one.q - free.robot.neutral)[free.q] / free.scales))
