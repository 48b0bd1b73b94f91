"""The search for singular configurations: Newton's method on the singular value that vanishes there."""

from __future__ import annotations

from typing import Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.engines.poe import PoE
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.motion.freedoms import TURN, Freedoms, Task, freedoms
from pinscrew.motion.singularity import TOLERANCE, ScaledJacobian, Singularity
from pinscrew.robot.loading import RobotLike, robot_of

__all__ = ["find_singularities"]

STEPS: Final = 200
LONGEST: Final = 0.5
"""Longest step (rad) of the search."""
ZERO: Final = 1e-15
"""A singular value that can't be lessened."""
SAME: Final = 1e-6
"""Difference of values of one joint (rad, or displacements over the characteristic length) that are the same."""


def find_singularities(
    robot: RobotLike,
    frame: str | None = None,
    *,
    task: Task = "pose",
    limits: ArrayLike | None = None,
    starts: int = 100,
    seed: int = 0,
    tolerance: float = TOLERANCE,
    length: float | None = None,
    engine: Engine | None = None,
) -> tuple[Singularity, ...]:
    """Singular configurations of ``frame`` within the limits, one of each family that is found.

    From configurations at random, Newton's method goes the shortest way to where the smallest singular value is zero.
    Singular configurations come in families: two belong to one if they have the same rank, depend on the same joints
    and, where that is a single joint, on the same value of it. The one nearest to `Robot.neutral` stands for each.
    A family that no start leads to is not found, and what is found apart may be one family, met at a special point.

    Args:
        robot, frame, task, tolerance, length, engine: see `classify_singularity`.
        limits: lower and upper limit of each entry of ``q``, shape (nq, 2); by default the robot's.
        starts: how many starts.
        seed: of the starts.

    Returns:
        the singular configurations, those that the most starts led to first; other coordinates are neutral.

    Raises:
        UnknownNameError, AmbiguousTipError: see `Robot.frame`.
        InputError: see `classify_singularity`; also if a displacement has no limits, ``limits`` are reversed,
            ``starts`` is not positive or ``seed`` negative.
    """
    robot = robot_of(robot)
    free = freedoms(robot, frame, limits, length)
    jacobian = ScaledJacobian(free, engine or PoE(robot), task, tolerance)
    x = _descend(jacobian, free.draw(seed, starts))
    found = [jacobian.classify(q) for q in free.put(robot.neutral, free.nearest_turn(x, np.zeros_like(x)))]
    families: dict[tuple[object, ...], list[Singularity]] = {}
    for one in found:
        if one.singular:
            families.setdefault(_family(one, free), []).append(one)
    ordered = sorted(families.values(), key=len, reverse=True)
    return tuple(min(family, key=lambda one: _distance(one, free)) for family in ordered)


def _descend(jacobian: ScaledJacobian, x: FloatArray) -> FloatArray:
    """From values (N, m) to where the last singular value is zero, or as small as can be: (N, m)."""
    free, last = jacobian.free, jacobian.freedoms - 1
    x, going = x.copy(), np.arange(len(x) if last >= 0 else 0)
    for _ in range(STEPS):
        q = free.put(free.robot.neutral, x[going])
        U, values, Vt = np.linalg.svd(jacobian.matrix(q))
        sigma = values[:, last]
        g = np.einsum("na,niab,nb->ni", U[:, :, last], jacobian.derivatives(q), Vt[:, last])
        g[free.held(x[going], -g)] = 0.0
        slope = np.linalg.norm(g, axis=1)
        on = (sigma > ZERO) & (slope > ZERO)  # where there is no slope, it is as small as can be
        going, g, slope = going[on], g[on], slope[on]
        if not len(going):
            break
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
