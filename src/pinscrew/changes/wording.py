"""Lengths, angles and directions as an engineer says them: millimetres, degrees, named axes."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from pinscrew.ground.typing import FloatArray

__all__ = ["degrees", "interval", "millimetres", "moved", "number"]

ALONG: Final = 1e-6
"""Largest other component of a unit vector that still is called x, y or z."""


def number(value: float) -> str:
    """A number to six digits."""
    return f"{value + 0.0:.6g}"


def millimetres(length: float) -> str:
    """A length (m) in millimetres."""
    return f"{number(length * 1e3)} mm"


def degrees(angle: float) -> str:
    """An angle (rad) in degrees."""
    return f"{number(math.degrees(angle))}°"


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


def interval(lower: float, upper: float, *, sliding: bool) -> str:
    """Limits (rad, or m of a sliding joint), such as ``[-170°, 170°]``."""
    ends = (lower, upper)
    if sliding:
        return f"[{', '.join(number(end * 1e3) for end in ends)}] mm"
    return f"[{', '.join(degrees(end) for end in ends)}]"


def _axis(direction: FloatArray) -> tuple[int, str] | None:
    """Sign and name of the axis that a unit vector is along, if it is."""
    i = int(abs(direction).argmax())
    others = np.delete(direction, i)
    return (1 if direction[i] > 0.0 else -1, "xyz"[i]) if (abs(others) <= ALONG).all() else None


def _vector(values: FloatArray) -> str:
    largest = abs(values).max()
    return f"({', '.join(number(x) if abs(x) > ALONG * largest else '0' for x in values)})"
