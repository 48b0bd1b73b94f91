"""Whose Jacobian or twist it is: everything that is known is tried, and then points that the file does not name."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from pinscrew.engines.base import Engine
from pinscrew.ground.typing import FloatArray
from pinscrew.identification.given import GivenSamples
from pinscrew.identification.observers import Observer, observed, observers
from pinscrew.identification.outcome import Candidate
from pinscrew.identification.points import movable
from pinscrew.identification.rates import rated
from pinscrew.identification.writings import UNITS, Writing, columns
from pinscrew.robot.robot import Robot

__all__ = ["jacobians", "per_angle", "unknown_points"]


def jacobians(
    robot: Robot, engine: Engine, asked: GivenSamples, relative: float, absolute: float
) -> Iterator[Candidate]:
    """Those that fit of all that is known: ω in any axes, and rates in place of ω.

    Args:
        robot: the robot.
        engine: who says what would be right.
        asked: Jacobians, or twists and the rates of joints.
        relative: how far off a number may be, of the largest beside it.
        absolute: and in addition, in the units that were given.
    """
    for observer in observers(robot):
        if asked.quantity == "screws" and observer.kind not in ("spatial", "body"):
            continue
        ours = _seen(engine, observer, asked)
        empty = frozenset(np.flatnonzero(abs(ours).max(axis=(0, 1)) == 0.0).tolist())
        for writing, values in _writings(robot, asked):
            near = _Nearness(values, writing, relative, absolute)
            if not near.linear(robot, asked, ours).any(axis=(1, 2)).all():
                continue
            for each in _kinds(observer, values.shape[1], asked):
                expected = ours if each.rates is None else _seen(engine, each, asked)
                yield from _fitting(robot, asked, each, near, expected, empty)


def unknown_points(
    robot: Robot, engine: Engine, asked: GivenSamples, relative: float, absolute: float
) -> Iterator[Candidate]:
    """Jacobians with all columns in their order, of points that the file does not name; see `jacobians`."""
    if asked.quantity != "jacobian" or sorted(asked.values.shape[1:]) != sorted((6, robot.nv)):
        return
    turning, joints = per_angle(robot), tuple(range(robot.nv))
    seen = list(movable(robot, engine, asked.q))
    for plain, given in _writings(robot, asked):
        if given.shape[1] != 6:
            continue
        writing = replace(plain, joints=joints, signs=(1,) * robot.nv)
        ours = given * np.where((turning > 0.0) & (writing.angle == "deg"), 180.0 / np.pi, 1.0)
        linear, angular = _blocks(ours, writing)
        near = _Nearness(given, writing, relative, absolute)
        for each in seen:
            for observer in each.explaining(linear * UNITS[writing.unit], angular):
                expected = writing.rows(observed(engine, observer, asked.q), turning)
                if near.whole(expected)[joints, joints, 0].all():
                    residual = float(abs(given - expected).max())
                    yield Candidate(asked.quantity, residual, robot.velocity_names, turning, observer, writing)


def per_angle(robot: Robot) -> FloatArray:
    """1 for each velocity that is an angle's, otherwise 0; shape (nv,)."""
    return np.array([1.0 if unit == "rad" else 0.0 for unit in robot.velocity_units])


class _Nearness:
    """Which of the columns that were given are near which that would be right."""

    def __init__(self, values: FloatArray, writing: Writing, relative: float, absolute: float) -> None:
        self.values, self.writing = values, writing
        self._relative, self._absolute = relative, absolute

    def linear(self, robot: Robot, asked: GivenSamples, ours: FloatArray) -> NDArray[np.bool_]:
        """By v alone, whatever stands in place of ω; shape (m, n, 2), for the column and its opposite."""
        expected = self.writing.rows(ours, _scaled(robot, asked))
        return self._near(_blocks(self.values, self.writing)[0], _blocks(expected, self.writing)[0])

    def whole(self, expected: FloatArray) -> NDArray[np.bool_]:
        """By all rows."""
        theirs, ours = _blocks(self.values, self.writing), _blocks(expected, self.writing)
        return self._near(theirs[0], ours[0]) & self._near(theirs[1], ours[1])

    def _near(self, theirs: FloatArray, ours: FloatArray) -> NDArray[np.bool_]:
        tolerance = self._absolute + self._relative * max(abs(theirs).max(initial=0.0), 1e-3)
        given, right = theirs[:, :, :, None], ours[:, :, None, :]
        off = np.stack([abs(given - right), abs(given + right)], axis=-1)
        return np.asarray(off.max(axis=(0, 1)) <= tolerance)


def _fitting(
    robot: Robot, asked: GivenSamples, observer: Observer, near: _Nearness, ours: FloatArray, empty: frozenset[int]
) -> Iterator[Candidate]:
    expected = near.writing.rows(ours, _scaled(robot, asked))
    fits, turning = near.whole(expected), per_angle(robot)
    if asked.qd is not None:
        ways: list[tuple[tuple[int, ...], tuple[int, ...]]] = [((), ())] if fits[0, 0, 0] else []
    else:
        ways = columns(fits, empty)
    for joints, signs in ways:
        chosen = expected if asked.qd is not None else expected[:, :, list(joints)] * signs
        residual = float(abs(near.values - chosen).max())
        written = replace(near.writing, joints=joints, signs=signs)
        yield Candidate(asked.quantity, residual, robot.velocity_names, turning, observer, written)


def _writings(robot: Robot, asked: GivenSamples) -> Iterator[tuple[Writing, FloatArray]]:
    """Ways to read what was given as columns, and the columns: shape (N, 6 or 7, m)."""
    twist = asked.qd is not None
    values = asked.values[:, :, None] if twist else asked.values
    degrees = ("rad", "deg") if not twist or per_angle(robot).any() else ("rad",)
    layouts = ["rows"] if values.shape[1] in (6, 7) else []
    layouts += ["transposed"] if values.shape[2] in (6, 7) and not twist else []
    for order, unit, angle, layout in product(("v,w", "w,v"), UNITS, degrees, layouts):
        writing = Writing(order, unit, angle, layout)  # type: ignore[arg-type]
        yield writing, np.swapaxes(values, 1, 2) if layout == "transposed" else values


def _kinds(observer: Observer, rows: int, asked: GivenSamples) -> Iterator[Observer]:
    """The observer itself, and where it sees the velocity of a frame's origin in the base those that have rates."""
    if rows == 6:
        yield observer
    if observer.kind == "hybrid":
        # The rates of a twist are in degrees already where its writing says so.
        known = (each for each in rated(rows) if asked.qd is None or each.angle == "rad")
        yield from (replace(observer, rates=each) for each in known)


def _seen(engine: Engine, observer: Observer, asked: GivenSamples) -> FloatArray:
    J = observed(engine, observer, asked.q)
    return J if asked.qd is None else J @ asked.qd[:, :, None]


def _scaled(robot: Robot, asked: GivenSamples) -> FloatArray:
    return per_angle(robot) if asked.qd is None else np.zeros(0)


def _blocks(rows: FloatArray, writing: Writing) -> tuple[FloatArray, FloatArray]:
    """The linear rows and the others."""
    return (rows[:, :3], rows[:, 3:]) if writing.order == "v,w" else (rows[:, -3:], rows[:, :-3])
