"""Inverse kinematics: configurations that put a frame where it is to be, each checked by a second engine."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
import numpy.typing as npt

from pinscrew.engines.base import Engine
from pinscrew.engines.pair import pair_of
from pinscrew.ground.arrays import numbers
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.lie import se3
from pinscrew.lie.checks import read, require_bottom_row, require_finite, require_rotation
from pinscrew.motion.branches import NO_OTHER, every, require_isolated
from pinscrew.motion.freedoms import Freedoms, Task, freedoms, task_rows
from pinscrew.motion.search import Search
from pinscrew.robot.loading import RobotLike, robot_of

__all__ = ["TOLERANCE", "Solution", "ik"]

TOLERANCE: Final = 1e-9
"""Error (rad, and m over max(1, length)) of a target that is reached."""

SOLUTIONS: Final = ("one", "all")
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
            says that it is reached, and the second not; ``"no other"`` in the place of a solution that another
            target has and this one not.
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
        return bool((self.solved | (self.reason == NO_OTHER)).all())

    def __str__(self) -> str:
        there = self.reason != NO_OTHER
        reached, count = int(self.solved.sum()), int(there.sum())
        words = f"{self.robot}, {self.task} of {self.frame}: {reached} of {count} reached"
        if not count:
            return words
        distance, angle = self.position_error[there].max(), self.angle_error[there].max()
        words += f", largest error {distance:.3g} m, {angle:.3g} rad"
        reasons, counts = np.unique(self.reason[there & ~self.solved], return_counts=True)
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
    solutions: Literal["one", "all"] = "one",
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
        solutions: ``"one"``, or ``"all"`` that differ by more than whole turns, for arms that reach a target in
            finitely many ways: all arrays of the answer then have a last batch axis, over the k solutions of the
            target that has most, nearest to ``q0`` first. Where a target has fewer, ``q`` and the errors are NaN,
            ``solved`` is False and ``reason`` is ``"no other"``; one without any has its nearest configuration first.
            From random starts, until each was met twice (`pinscrew.motion.branches`).
        engines: two engines to search and to check with, instead of `PoE` and `Pinocchio` of this robot.

    Returns:
        the configurations, with what is not reached and why. That a target is unreachable is no proof.

    Raises:
        UnknownNameError, AmbiguousTipError: see `Robot.frame`.
        InputError: if a target is no pose, ``q0`` has another shape, is not finite or is outside the limits, no joint
            moves the frame or a planar or floating one does, a displacement has no limits, ``limits`` are reversed,
            there is no such task, ``starts`` is not positive, ``seed`` negative or ``tolerance`` not positive, or all
            solutions are asked for and are infinitely many.
        EngineError, UnsupportedError: if Pinocchio does not take the robot.
    """
    robot = robot_of(robot)
    free = freedoms(robot, frame, limits)
    task_rows(task, free.length)
    if not 0.0 < tolerance < math.inf:
        raise InputError("tolerance", f"tolerance={tolerance}", remedy="give a positive number, such as 1e-9")
    if solutions not in SOLUTIONS:
        raise InputError("solutions", f"solutions={solutions!r}", remedy=f"use {' or '.join(map(repr, SOLUTIONS))}")
    T, q, batch = _asked(free, T_base_tip, q0, limits)
    both = engines or pair_of(robot)
    search = Search(free, both, task, starts, seed, tolerance)
    if solutions == "all":
        require_isolated(free, both[0], task, search.drawn)
        configurations, distance, angle, reason = every(search, T, q, q0 is not None)
        batch = (*batch, reason.shape[1])
    else:
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
