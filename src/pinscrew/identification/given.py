"""What was given: the samples, what kind of quantity they are of, and how exact their numbers are."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal, TypeAlias

import numpy as np

from pinscrew.ground.arrays import numbers
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.robot.robot import Robot

__all__ = ["GivenSamples", "Quantity", "samples", "tolerances"]

Quantity: TypeAlias = Literal["jacobian", "pose", "twist", "screws"]

DOUBLE: Final = 1e-9
"""Relative: numbers of 64 bits, by whatever way they were computed."""
SINGLE: Final = 2e-6
"""Relative: numbers of 32 bits."""
DIGITS: Final = range(8, 1, -1)
"""How many decimals are looked for in numbers that were printed."""
_WHERE: Final = "identify"
_SHAPES: Final = "give a Jacobian (6, m), (m, 6) or with 7, a pose (4, 4), or rows of 6 or 7 numbers, for each q"


@dataclass(frozen=True, eq=False)
class GivenSamples:
    """N configurations, and what somebody says of each.

    Attributes:
        quantity: of what kind.
        q: configurations, shape (N, nq).
        values: what was given: (N, 6, m) or (N, m, 6), the same with 7, (N, 4, 4), (N, 6) or (N, 7).
        qd: rates of a twist, shape (N, nv); otherwise None.
        home: it is of the robot at zero by what it is: a list of screw axes or a home pose.
    """

    quantity: Quantity
    q: FloatArray
    values: FloatArray
    qd: FloatArray | None = None
    home: bool = False


def samples(robot: Robot, q: ArrayLike | None, given: Sequence[ArrayLike]) -> GivenSamples:
    """What was given, checked.

    Args:
        robot: the robot.
        q: configurations, shape (nq,) or (N, nq); None for a list of screw axes or a home pose.
        given: one array for each q, or rates of the shape (nv,) or (N, nv) and twists (6,) or (N, 6).

    Raises:
        InputError: if a shape is none of these, or a number is not finite.
    """
    if q is None:
        found = samples(robot, robot.neutral, given)
        if found.quantity == "twist":
            raise InputError("shape", "a twist is given without q", where=_WHERE, remedy="give the q that it is at")
        return replace(found, quantity="screws" if found.quantity == "jacobian" else "pose", home=True)
    at = _finite(q, "q")
    if at.ndim not in (1, 2) or at.shape[-1] != robot.nq or not at.size:
        remedy = f"{robot.name} takes {robot.nq} coordinates: ({robot.nq},) or (N, {robot.nq}), N at least 1"
        raise InputError("shape", f"q has the shape {at.shape}", where=_WHERE, remedy=remedy)
    lead = at.shape[:-1]
    at = at.reshape(-1, robot.nq)
    if len(given) == 2:
        qd, twist = (_finite(array, name) for array, name in zip(given, ("qd", "V"), strict=True))
        _check(qd, (*lead, robot.nv), "qd")
        _check(twist, (*lead, 6), "V")
        return GivenSamples("twist", at, twist.reshape(-1, 6), qd.reshape(-1, robot.nv))
    if len(given) != 1:
        what = f"{len(given)} arrays are given beside q"
        raise InputError("shape", what, where=_WHERE, remedy="give one, or rates and twists")
    values = _finite(given[0], "the array")
    shape = values.shape[len(lead) :]
    if values.shape[: len(lead)] != lead or not values.size or not _known(shape):
        what = f"the array has the shape {values.shape} for q of the shape {(*lead, robot.nq)}"
        raise InputError("shape", what, where=_WHERE, remedy=_SHAPES)
    quantity: Quantity = "jacobian" if len(shape) == 2 and shape != (4, 4) else "pose"
    return GivenSamples(quantity, at, values.reshape(-1, *shape))


def tolerances(values: FloatArray) -> Iterator[tuple[float, float]]:
    """How far off right numbers may be, the strictest first: relative to the largest beside them, and absolute.

    Numbers of 64 bits come first. Where nothing fits these, they may be numbers of 32 bits, or printed: then all of
    them are whole multiples of a power of ten, and half of it is what each may be off.
    """
    yield DOUBLE, 0.0
    if np.array_equal(values, values.astype(np.float32)):
        yield SINGLE, 0.0
    for decimals in DIGITS:
        if np.allclose(values, np.round(values, decimals), rtol=1e-14, atol=1e-14) and not np.allclose(
            values, np.round(values, decimals - 1), rtol=1e-14, atol=1e-14
        ):
            yield DOUBLE, 0.501 * 10.0**-decimals


def _known(shape: tuple[int, ...]) -> bool:
    return shape in ((6,), (7,), (4, 4)) or (len(shape) == 2 and (6 in shape or 7 in shape))


def _finite(value: ArrayLike, name: str) -> FloatArray:
    array = numbers(value, name, _WHERE)
    if not np.isfinite(array).all():
        raise InputError("not-finite", f"{name} holds NaN or infinity", where=_WHERE)
    return array


def _check(array: FloatArray, shape: tuple[int, ...], name: str) -> None:
    if array.shape != shape:
        what = f"{name} has the shape {array.shape}"
        raise InputError("shape", what, where=_WHERE, remedy=f"expected {shape}")
