"""Lengths, angles and directions as an engineer says them: millimetres, degrees, named axes."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from pinscrew.ground.typing import FloatArray

__all__ = ["degrees", "intervals", "millimetres", "moved", "number", "told_apart"]

DIGITS: Final = 6
"""Digits of a number that stands for itself."""
MOST_DIGITS: Final = 17
"""Digits that tell any two doubles apart."""
ALONG: Final = 1e-6
"""Largest other component of a unit vector that still is called x, y or z."""


def number(value: float, digits: int = DIGITS) -> str:
    """A number to some digits."""
    return f"{value + 0.0:.{digits}g}"


def millimetres(length: float, digits: int = DIGITS) -> str:
    """A length (m) in millimetres."""
    return f"{number(length * 1e3, digits)} mm"


def degrees(angle: float, digits: int = DIGITS) -> str:
    """An angle (rad) in degrees."""
    return f"{number(math.degrees(angle), digits)}°"


def told_apart(old: float, new: float, written: Callable[[float, int], str] = number) -> tuple[str, str]:
    """Two numbers, written with as many digits as tell them apart: six where these do, or where the two are equal."""
    texts = written(old, DIGITS), written(new, DIGITS)
    for digits in range(DIGITS + 1, MOST_DIGITS + 1):
        if texts[0] != texts[1] or old == new:
            break
        texts = written(old, digits), written(new, digits)
    return texts


def moved(shift: FloatArray, turn: FloatArray, *, length: float, angle: float) -> str:
    """How something moved, such as ``turned by 0.5° about x and moved by 4 mm along y``.

    Args:
        shift: displacement, shape (3,), m.
        turn: rotation vector, shape (3,), rad.
        length: tolerance of the displacement, m.
        angle: tolerance of the rotation, rad.
    """
    parts = []
    turned, far = float(np.linalg.norm(turn)), float(np.linalg.norm(shift))
    small = turned <= angle and far <= length
    if turned > angle or (small and turned * length >= far * angle):
        axis = _axis(turn / turned) if turned else None
        if axis is None:
            parts.append(f"turned by {degrees(turned)} about {_vector(turn / turned if turned else turn)}")
        else:
            parts.append(f"turned by {degrees(axis[0] * turned)} about {axis[1]}")
    if far > length or (small and not parts):
        axis = _axis(shift / far) if far else None
        if axis is None:
            parts.append(f"moved by {_vector(shift * 1e3)} mm")
        else:
            parts.append(f"moved by {millimetres(axis[0] * far)} along {axis[1]}")
    return " and ".join(parts)


def intervals(old: tuple[float, float], new: tuple[float, float], *, sliding: bool) -> tuple[str, str]:
    """Limits (rad, or m of a sliding joint) before and after, such as ``[-170°, 170°]``, told apart."""
    written = _thousandths if sliding else degrees
    lower, upper = (told_apart(*ends, written) for ends in zip(old, new, strict=True))
    unit = " mm" if sliding else ""
    return f"[{lower[0]}, {upper[0]}]{unit}", f"[{lower[1]}, {upper[1]}]{unit}"


def _thousandths(length: float, digits: int) -> str:
    return number(length * 1e3, digits)


def _axis(direction: FloatArray) -> tuple[int, str] | None:
    """Sign and name of the axis that a unit vector is along, if it is."""
    i = int(abs(direction).argmax())
    others = np.delete(direction, i)
    return (1 if direction[i] > 0.0 else -1, "xyz"[i]) if (abs(others) <= ALONG).all() else None


def _vector(values: FloatArray) -> str:
    largest = abs(values).max()
    return f"({', '.join(number(x) if abs(x) > ALONG * largest else '0' for x in values)})"
