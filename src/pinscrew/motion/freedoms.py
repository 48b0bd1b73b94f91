"""The coordinates that move a frame, and the units in which metres and radians compare."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from pinscrew.ground.counts import whole
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.lie.checks import read
from pinscrew.robot.mechanism import JointMotion
from pinscrew.robot.robot import Robot

__all__ = ["TASKS", "TURN", "Freedoms", "Task", "freedoms", "task_rows"]

Task: TypeAlias = Literal["pose", "position"]

TASKS: Final[tuple[Task, ...]] = ("pose", "position")

TURN: Final = 2.0 * np.pi
"""A whole turn, rad."""


@dataclass(frozen=True, slots=True)
class Freedoms:
    """The m coordinates that move a frame.

    Attributes:
        robot: the robot.
        frame: the frame.
        q: where they stand in ``q``, shape (m,).
        v: where their velocities stand in ``qd``, shape (m,).
        limits: their lower and upper limits, shape (m, 2).
        slides: which of them are displacements, shape (m,).
        turns: which of them leave the frame as it is when they change by 2π, shape (m,).
        length: characteristic length L (m): so many metres count as much as one radian.
    """

    robot: Robot
    frame: str
    q: npt.NDArray[np.intp]
    v: npt.NDArray[np.intp]
    limits: FloatArray
    slides: npt.NDArray[np.bool_]
    turns: npt.NDArray[np.bool_]
    length: float

    @property
    def names(self) -> tuple[str, ...]:
        """The coordinates' names."""
        return tuple(self.robot.coordinate_names[i] for i in self.q)

    @property
    def scales(self) -> FloatArray:
        """What counts as a step of 1: 1 rad for an angle, L for a displacement; shape (m,)."""
        return np.where(self.slides, self.length, 1.0)

    @property
    def wraps(self) -> npt.NDArray[np.bool_]:
        """Which of them have no limit in effect, since a whole turn brings any value within theirs; shape (m,)."""
        return np.asarray(self.turns & (self.limits[:, 1] - self.limits[:, 0] >= TURN))

    def unlimited(self) -> Freedoms:
        """The same freedoms without limits."""
        return replace(self, limits=np.broadcast_to([-math.inf, math.inf], self.limits.shape))

    def held(self, x: FloatArray, step: FloatArray) -> npt.NDArray[np.bool_]:
        """Which of these coordinates are at a limit that a step from ``x`` would cross, shape (..., m)."""
        lower, upper = self.limits.T
        return np.asarray(~self.wraps & (((x <= lower) & (step < 0.0)) | ((x >= upper) & (step > 0.0))))

    def put(self, q: FloatArray, x: FloatArray) -> FloatArray:
        """``q`` (..., nq) with the values ``x`` (..., m) of these coordinates."""
        out = np.broadcast_to(q, (*x.shape[:-1], self.robot.nq)).copy()
        out[..., self.q] = x
        return out

    def brought_within(self, x: FloatArray) -> FloatArray:
        """``x`` (..., m) within the limits: by whole turns where that is possible, else at the nearest limit."""
        lower, upper = self.limits.T
        down = TURN * np.maximum(0.0, np.ceil((x - upper) / TURN))
        up = TURN * np.maximum(0.0, np.ceil((lower - x) / TURN))
        return np.clip(np.where(self.wraps, x - down + up, x), lower, upper)

    def nearest_turn(self, x: FloatArray, reference: FloatArray) -> FloatArray:
        """``x`` (..., m), moved by whole turns to be as near to ``reference`` (..., m) as the limits let it be."""
        moved = x + TURN * np.where(self.wraps, np.round((reference - x) / TURN), 0.0)
        return self.brought_within(moved)

    def draw(self, seed: int, starts: int, each: int = 1) -> FloatArray:
        """Values within limits to start from, uniform; of an angle without them, or that may turn, one turn.

        Returns:
            shape (starts times each, m).

        Raises:
            InputError: if ``starts`` is no positive or ``seed`` a negative number, or a displacement has no limits.
        """
        starts, seed = whole("starts", starts, 1), whole("seed", seed, 0)
        lower, upper = self.limits.T
        endless = ~np.isfinite(lower) | ~np.isfinite(upper)
        if (endless & self.slides).any():
            name = self.names[int((endless & self.slides).argmax())]
            what = f"the displacement {name!r} has no limits to search within"
            raise InputError("limits", what, where=self.robot.name, remedy="give limits=, an array (nq, 2)")
        one_turn = endless | self.wraps
        with np.errstate(invalid="ignore"):
            middle = np.clip(0.0, np.where(one_turn, lower + np.pi, 0.0), np.where(one_turn, upper - np.pi, 0.0))
        low, high = np.where(one_turn, middle - np.pi, lower), np.where(one_turn, middle + np.pi, upper)
        return np.random.default_rng(seed).uniform(low, high, (starts * each, len(self.q)))


def freedoms(
    robot: Robot, frame: str | None = None, limits: ArrayLike | None = None, length: float | None = None
) -> Freedoms:
    """The coordinates that move ``frame``.

    Args:
        robot: the robot.
        frame: a link's name; by default the robot's tip.
        limits: lower and upper limit of each entry of ``q``, shape (nq, 2); by default the robot's.
        length: characteristic length (m); by default an upper bound of the frame's distance from the base: the
            robot's `reach` and the farthest displacements of the prismatic joints on the way, where limited. It
            is 1 m where that is zero.

    Raises:
        UnknownNameError, AmbiguousTipError: see `Robot.frame`.
        InputError: if no joint moves the frame, a planar or floating one does, ``limits`` have another shape, are
            NaN or reversed, or ``length`` is not positive and finite.
    """
    frame = robot.frame(frame)
    motions = [robot.mechanism.motions[index] for index in robot.motions_above(frame)]
    if not motions:
        raise InputError("nothing-moves", f"no joint moves the frame {frame!r}", where=robot.name)
    for motion in motions:
        if motion.freedoms > 1:
            what = f"the {motion.joint.type} joint {motion.joint.name!r} moves the frame {frame!r}"
            raise InputError("free-joint", what, where=robot.name, remedy="joints of one coordinate are expected")
    bounds = _limits(robot, limits)
    if length is None:
        length = robot.reach + sum(_travel(motion, bounds) for motion in motions) or 1.0
    if not 0.0 < length < math.inf:
        raise InputError("length", f"length={length}", remedy="give a positive number of metres")
    velocity = dict(sorted((motion.q, motion.v) for motion in motions))
    q = np.array(list(velocity), dtype=np.intp)
    return Freedoms(
        robot=robot,
        frame=frame,
        q=q,
        v=np.array(list(velocity.values()), dtype=np.intp),
        limits=bounds[q],
        slides=robot.mechanism.coordinates.slides[q],
        turns=np.array([all(_whole(motion) for motion in motions if motion.q == i) for i in velocity]),
        length=length,
    )


def task_rows(task: Task, length: float) -> FloatArray:
    """The weight of each row (v, ω) of a Jacobian in a task, shape (6,) or (3,): metres are divided by ``length``.

    Raises:
        InputError: if there is no such task.
    """
    if task not in TASKS:
        raise InputError("task", f"task={task!r}", remedy=f"use {' or '.join(map(repr, TASKS))}")
    return np.array([1.0 / length] * 3 + [1.0] * (3 if task == "pose" else 0))


def _whole(motion: JointMotion) -> bool:
    """Whether a joint is where it was when its coordinate has changed by 2π."""
    return motion.joint.type != "prismatic" and float(motion.multiplier).is_integer()


def _travel(motion: JointMotion, limits: FloatArray) -> float:
    """How far (m) a prismatic joint can be drawn out; 0 where nothing limits it."""
    farthest = abs(motion.multiplier) * float(np.abs(limits[motion.q]).max())
    return farthest if motion.joint.type == "prismatic" and math.isfinite(farthest) else 0.0


def _limits(robot: Robot, limits: ArrayLike | None) -> FloatArray:
    if limits is None:
        return robot.limits
    bounds = read(limits, (robot.nq, 2), robot.name, "limits")
    if bounds.shape != (robot.nq, 2):
        what = f"limits has shape {bounds.shape}"
        raise InputError("shape", what, where=robot.name, remedy=f"expected ({robot.nq}, 2)")
    wrong = ~((bounds[:, 0] <= bounds[:, 1]) & (bounds[:, 0] < math.inf) & (bounds[:, 1] > -math.inf))
    if wrong.any():
        i = int(wrong.argmax())
        what = f"the limits of {robot.coordinate_names[i]!r} are {bounds[i].tolist()}"
        raise InputError("limits", what, where=robot.name, remedy="give the lower, then the upper limit")
    return bounds
