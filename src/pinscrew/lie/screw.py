"""Screws: a twist as geometry. A line, a pitch along it, and a magnitude.

Source: Murray, Li, Sastry, *A Mathematical Introduction to Robotic Manipulation*, CRC 1994 (MLS), §2.3.3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.lie.checks import read, require_finite

__all__ = ["Screw"]

# What was normalised in doubles is within 1e-15 of unit length. What was written with some digits is not, and
# Screw.through is there to normalise it.
_UNIT_TOLERANCE = 1e-12


@dataclass(frozen=True, eq=False, repr=False)
class Screw:
    """A screw: M times the motion along and about a line, by h metres for each radian.

    It stands for the twist ξ = (v, ω) = M(h u - u × q, u), and for M(u, 0) when h is infinite. Point and
    direction are in the frame of the twist: the base for a spatial twist, the body for a body twist.

    Attributes:
        point: q, a point of the line, shape ``(3,)``, m. It does not matter for a translation.
        direction: u, the direction of the line, shape ``(3,)``, of unit length.
        pitch: h, m/rad: 0 for a rotation, ``inf`` for a translation.
        magnitude: M > 0, in radians (metres for a translation), or in rad/s (m/s) for a velocity.

    Raises:
        InputError: for a wrong shape, a direction that is not of unit length, a pitch that is NaN or -inf, a
            magnitude that is not positive, or any other number that is not finite.
    """

    point: FloatArray
    direction: FloatArray
    pitch: float = 0.0
    magnitude: float = 1.0

    def __post_init__(self) -> None:
        point, direction = _vector(self.point, 3, "point"), _vector(self.direction, 3, "direction")
        pitch, magnitude = float(self.pitch), float(self.magnitude)
        length = math.hypot(*direction)
        if abs(length - 1.0) > _UNIT_TOLERANCE:
            raise InputError(
                "not-unit",
                f"direction has the length {length:.17g}",
                where="Screw",
                remedy="expected 1; Screw.through normalises",
            )
        if math.isnan(pitch) or pitch == -math.inf:
            raise InputError(
                "pitch",
                f"pitch is {pitch}",
                where="Screw",
                remedy="expected m/rad, or inf for a translation (to go back, reverse the direction)",
            )
        if not 0.0 < magnitude < math.inf:
            raise InputError(
                "magnitude",
                f"magnitude is {magnitude}",
                where="Screw",
                remedy="expected a positive number (to go back, reverse the direction)",
            )
        fields = {"point": point, "direction": direction, "pitch": pitch, "magnitude": magnitude}
        for name, value in fields.items():
            object.__setattr__(self, name, value)

    @classmethod
    def through(cls, point: ArrayLike, direction: ArrayLike, pitch: float = 0.0, magnitude: float = 1.0) -> Screw:
        """The screw through a point, along a direction of any length but zero.

        Args:
            point: shape ``(3,)``, m.
            direction: shape ``(3,)``; only its direction counts.
            pitch: m/rad; ``inf`` for a translation.
            magnitude: rad, or m for a translation.

        Raises:
            InputError: if the direction is zero, or as the class says.
        """
        vector = _vector(direction, 3, "direction")
        if not vector.any():
            raise InputError("zero-direction", "direction is zero", where="Screw", remedy="give the line one")
        return cls(_vector(point, 3, "point"), _normalised(vector)[0], pitch, magnitude)

    @classmethod
    def from_twist(cls, xi: ArrayLike) -> Screw:
        """The screw of a twist: h = ωᵀv/‖ω‖², q = ω × v/‖ω‖² (the point nearest to the origin), M = ‖ω‖.

        For ω = 0: h = ∞, the line through the origin along v, M = ‖v‖; MLS §2.3.3.

        ω counts as zero only when it is exactly zero. Metres and radians have no common scale, so no ratio of
        ω to v makes the twist a translation: 1 m with 1e-9 rad is a turn about a line up to 1e9 m away. Set ω
        to zero where it is known to be the rounding of zero.

        Args:
            xi: ξ = (v, ω), shape ``(6,)``, m and rad.

        Raises:
            InputError: if ξ has another shape, is zero or not finite, or if its pitch or point exceed the
                range of doubles (‖v‖/‖ω‖ > 1.8e308).
        """
        xi = _vector(xi, 6, "xi")
        v, omega = xi[:3], xi[3:]
        if not xi.any():
            raise InputError("zero-twist", "xi is zero", where="Screw", remedy="no motion has no screw")
        if not omega.any():
            direction, magnitude = _normalised(v)
            return cls(np.zeros(3), direction, math.inf, magnitude)
        direction, magnitude = _normalised(omega)
        with np.errstate(over="ignore", invalid="ignore"):
            point = np.cross(direction, v) / magnitude
            pitch = direction @ v / magnitude
        if not (math.isfinite(pitch) and np.isfinite(point).all()):
            raise InputError(
                "overflow",
                f"ω has the length {magnitude:.3g}, too small beside v for a finite pitch and point",
                where="Screw",
                remedy="set it to zero if the twist is a translation",
            )
        return cls(point, direction, float(pitch), magnitude)

    def twist(self) -> FloatArray:
        """ξ = (v, ω) = M(h u - u × q, u), or M(u, 0) for a translation; shape ``(6,)``."""
        if math.isinf(self.pitch):
            return np.concatenate([self.magnitude * self.direction, np.zeros(3)])
        v = self.pitch * self.direction - np.cross(self.direction, self.point)
        return self.magnitude * np.concatenate([v, self.direction]) + 0.0  # no minus zeros

    def isclose(self, other: Screw, rtol: float = 1e-9, atol: float = 1e-12) -> bool:
        """Whether both are the same motion: the same line, direction along it, pitch and magnitude.

        Which points name the lines does not matter, and for translations, where the lines are, neither.

        Args:
            other: the other screw.
            rtol: relative tolerance of pitch and magnitude, and of the lines' distance beside the points'
                distances from the origin; absolute of the unit directions.
            atol: absolute tolerance of the pitch, m/rad, and of the distance, m.
        """
        if math.hypot(*(self.direction - other.direction)) > rtol:
            return False
        if not math.isclose(self.magnitude, other.magnitude, rel_tol=rtol):
            return False
        if not math.isclose(self.pitch, other.pitch, rel_tol=rtol, abs_tol=atol):
            return False
        if math.isinf(self.pitch):
            return True
        distance = math.hypot(*np.cross(self.direction, other.point - self.point))
        return distance <= atol + rtol * max(math.hypot(*self.point), math.hypot(*other.point))

    def __repr__(self) -> str:
        return (
            f"Screw(point={self.point.tolist()}, direction={self.direction.tolist()}, "
            f"pitch={self.pitch!r}, magnitude={self.magnitude!r})"
        )

    def __str__(self) -> str:
        u = _words(self.direction)
        if math.isinf(self.pitch):
            return f"translation along {u}, magnitude {self.magnitude:.6g} m"
        kind = "rotation" if self.pitch == 0.0 else f"screw of pitch {self.pitch:.6g} m/rad"
        line = f"the line through {_words(self.point)} m along {u}"
        return f"{kind} about {line}, magnitude {self.magnitude:.6g} rad"


def _vector(value: ArrayLike, size: int, name: str) -> FloatArray:
    """A read-only copy, with 0 for minus zero, refused unless it is one finite vector of the given size."""
    array = read(value, (size,), "Screw", name)
    if array.ndim != 1:
        raise InputError("shape", f"{name} has shape {array.shape}", where="Screw", remedy=f"expected ({size},)")
    require_finite(array, 1, "Screw", name)
    array = array + 0.0
    array.flags.writeable = False
    return array


def _normalised(vector: FloatArray) -> tuple[FloatArray, float]:
    """The direction and the length of a vector that is not zero."""
    # A power of two is exact, and gives a subnormal vector the digits to be normalised.
    scaled = np.ldexp(vector, -math.frexp(float(np.abs(vector).max()))[1])
    return scaled / math.hypot(*scaled), math.hypot(*vector)


def _words(vector: FloatArray) -> str:
    return f"({', '.join(f'{x:.6g}' for x in vector)})"
