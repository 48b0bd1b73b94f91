"""The coordinates that move a frame, the range of each, and grids and samples over those ranges."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Final, TypeAlias

import numpy as np

from pinscrew.ground.errors import InputError, MissingExtraError, UnknownNameError
from pinscrew.ground.typing import FloatArray
from pinscrew.robot.robot import Robot

__all__ = ["Axis", "GridSteps", "Ranges", "axes", "grid_counts", "grid_points", "sobol", "spread"]

Ranges: TypeAlias = Mapping[str, tuple[float, float]]
"""Lower and upper end by coordinate, rad or m."""
GridSteps: TypeAlias = float | Mapping[str, float]
"""The step of a grid for all angles (rad), or for each coordinate by name (rad or m)."""

ROUNDING: Final = 1e-9
"""By how much of a step a range may miss a whole number of steps: 5° in radians is no exact number."""
MOST_POINTS: Final = 2**30
"""Points of scipy's Sobol sequence: its numbers have 30 bits."""


@dataclass(frozen=True, slots=True)
class Axis:
    """The range of one coordinate.

    Attributes:
        name: the coordinate's.
        index: where it stands in ``q``.
        lower: lower end, rad or m.
        upper: upper end.
        angle: whether it is an angle.
        turn: whether the range is the full turn of an angle without limits, whose ends are one configuration.
    """

    name: str
    index: int
    lower: float
    upper: float
    angle: bool
    turn: bool = False


def axes(robot: Robot, frame: str, ranges: Ranges | None = None) -> tuple[Axis, ...]:
    """The coordinates that move ``frame``, in the order of ``q``, each with its range.

    A range is the one given, else the coordinate's limits, else, for an angle without limits, a full turn from -π.

    Raises:
        InputError: if none moves the frame, a floating joint does, or a range is missing, reversed, not finite or
            of a coordinate that does not move the frame.
        UnknownNameError: if a range is of a coordinate that does not exist.
    """
    given = dict(ranges or {})
    for name in given:
        if name not in robot.coordinate_names:
            known = robot.coordinate_names
            raise UnknownNameError("unknown-coordinate", "coordinate", name, known, where=robot.name)
    found = tuple(_axis(robot, index, given) for index in _moving(robot, frame))
    idle = sorted(set(given) - {axis.name for axis in found})
    if idle:
        what = f"{idle[0]!r} does not move the frame {frame!r}"
        raise InputError("range", what, where=robot.name, remedy=f"those that do: {', '.join(a.name for a in found)}")
    return found


def _moving(robot: Robot, frame: str) -> list[int]:
    """Indices in ``q`` of the coordinates that move a frame, in order."""
    moving: set[int] = set()
    for index in robot.motions_above(frame):
        motion = robot.mechanism.motions[index]
        if motion.joint.type == "floating":
            what = f"the floating joint {motion.joint.name!r} moves the frame {frame!r}, and poses have no range"
            raise InputError("floating", what, where=robot.name, remedy="sweep the robot without its floating base")
        moving.update(range(robot.nq)[motion.coordinates])
    if not moving:
        raise InputError("nothing-moves", f"no joint moves the frame {frame!r}", where=robot.name)
    return sorted(moving)


def _axis(robot: Robot, index: int, given: Ranges) -> Axis:
    name, angle = robot.coordinate_names[index], not robot.mechanism.coordinates.slides[index]
    try:
        lower, upper = map(float, given.get(name, robot.limits[index]))
    except (TypeError, ValueError, OverflowError):
        what = f"the range of {name!r} is {given[name]!r}"
        raise InputError("range", what, where=robot.name, remedy="give two numbers") from None
    if name not in given and angle and not (math.isfinite(lower) and math.isfinite(upper)):
        return Axis(name, index, -math.pi, math.pi, angle, turn=True)
    if not math.isfinite(upper - lower):
        what = f"the range of {name!r} is {lower:g} to {upper:g}"
        raise InputError("range", what, where=robot.name, remedy=f"give finite ends, such as {name}=-1:1")
    if lower > upper:
        what = f"the range of {name!r} is reversed: {lower:g} to {upper:g}"
        raise InputError("range", what, where=robot.name, remedy="give the lower end first")
    return Axis(name, index, lower, upper, angle)


def grid_counts(axes: Sequence[Axis], steps: GridSteps) -> list[int]:
    """How many values a grid has on each axis.

    Both ends of a range are in it, but for one end of a full turn; a step that does not divide the range is
    shortened to the next that does.

    Raises:
        InputError: if a step is missing, not positive and finite, or larger than its range.
        UnknownNameError: if a step is of a coordinate that does not move the frame.
    """
    if isinstance(steps, Mapping):
        names = tuple(axis.name for axis in axes)
        for name in steps:
            if name not in names:
                raise UnknownNameError("unknown-coordinate", "coordinate that moves the frame", name, names)
    return [_count(axis, steps) for axis in axes]


def _count(axis: Axis, steps: GridSteps) -> int:
    step = steps.get(axis.name) if isinstance(steps, Mapping) else steps if axis.angle else None
    span = axis.upper - axis.lower
    if span == 0.0:
        return 1
    if step is None:
        example = f"{axis.name}=5deg" if axis.angle else f"{axis.name}=0.01"
        raise InputError("grid", f"the grid has no step for {axis.name!r}", remedy=f"give one, such as {example}")
    if not (isinstance(step, Real) and 0.0 < step < math.inf):
        raise InputError("grid", f"the step of {axis.name!r} is {step}", remedy="give a positive number")
    if step > span * (1.0 + ROUNDING):
        what = f"the step of {axis.name!r}, {step:g}, is larger than its range, {axis.lower:g} to {axis.upper:g}"
        raise InputError("grid", what, remedy="give a smaller step")
    if not math.isfinite(span / step):
        raise InputError("grid", f"the step of {axis.name!r} is {step:g}", remedy="give a larger step")
    intervals = max(1, math.ceil(span / step - ROUNDING))
    return intervals if axis.turn else intervals + 1


def grid_points(axes: Sequence[Axis], counts: Sequence[int]) -> FloatArray:
    """All points of a grid, the last axis varying fastest, shape (N, k)."""
    lines = [np.linspace(a.lower, a.upper, n, endpoint=not a.turn) for a, n in zip(axes, counts, strict=True)]
    return np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, len(lines))


def sobol(axes: Sequence[Axis], samples: int, seed: int) -> FloatArray:
    """Points of low discrepancy in the ranges: scipy's Sobol sequence, scrambled by the seed, shape (samples, k).

    The first 2ⁿ points are balanced best: Sobol, USSR Comp. Math. 7:4 (1967); Owen, J. Complexity 14 (1998).

    Raises:
        InputError: if there are more points than the sequence has.
        MissingExtraError: if scipy is not installed.
    """
    try:
        from scipy.stats import qmc
    except ModuleNotFoundError:
        raise MissingExtraError("scipy is not installed", "workspace") from None
    if samples > MOST_POINTS:
        remedy = f"give at most {MOST_POINTS}, or make a reachability map, which keeps voxels only"
        raise InputError("samples", f"samples={samples}", remedy=remedy)
    sequence = qmc.Sobol(len(axes), scramble=True, seed=np.random.default_rng(seed))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # that another number than 2ⁿ is less balanced
        return spread(axes, sequence.random(samples))


def spread(axes: Sequence[Axis], unit: FloatArray) -> FloatArray:
    """Points of the unit cube carried into the ranges, shape (..., k)."""
    lower, upper = np.array([(axis.lower, axis.upper) for axis in axes]).T
    carried: FloatArray = lower + unit * (upper - lower)
    return carried
