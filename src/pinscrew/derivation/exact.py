"""Exact numbers for those that a file prints: 0.333 is 333/1000, 1.5708 is π/2, 0.57735 0.57735 0.57735 is (1,1,1)/√3.

A decimal of up to 15 digits is taken at its word. Longer ones are what a program printed: they become a simple
fraction, or one times √2, √3 or π, where that is the same double. Angles are snapped to the nearest multiple of 30°
or 45° within `LAST_PLACES` units of their last printed place, but by no more than the tolerance. What is none of
these stays a number of 40 digits, and the derivation then keeps 30 decimals instead of being exact.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction
from typing import Final

import sympy as sp

__all__ = ["PRIMES", "SNAP", "Snapped", "Snaps", "angle", "bounded", "direction", "length", "rotation"]

SNAP: Final = 2e-3
"""Largest change of an angle (rad) or of an entry of an axis to an exact value, if no other is asked for."""
LAST_PLACES: Final = 5
"""How many units of its last printed place a number may be off: π/2 is also printed 1.570796325."""
PRIMES: Final = (2, 3, 5, 7, 11, 13)
"""Primes whose roots are kept as roots."""

_DIGITS: Final = 40
_SIMPLE: Final = 1000
_ROUNDING: Final = 4 * 2.0**-52
_ANGLES: Final = {float(a): a for n in (4, 6) for k in range(-2 * n, 2 * n + 1) for a in [sp.Rational(k, n) * sp.pi]}
_ENTRIES: Final = {
    float(x): x for x in (sp.Integer(0), sp.Rational(1, 2), sp.sqrt(2) / 2, sp.sqrt(3) / 2, sp.Integer(1))
}


@dataclass(frozen=True, slots=True)
class Snapped:
    """A number of a file that was replaced by an exact one.

    Attributes:
        where: what it is, such as ``"joint 'elbow', rpy"``.
        printed: the number in the file.
        value: what it was taken for.
        change: the difference.
    """

    where: str
    printed: str
    value: sp.Expr
    change: float


@dataclass
class Snaps:
    """The numbers that were snapped so far, and how far a number may be moved."""

    tolerance: float = SNAP
    found: list[Snapped] = field(default_factory=list)

    def near(self, text: str, candidates: Mapping[float, sp.Expr], where: str) -> sp.Expr | None:
        """The candidate that a printed number stands for, or None."""
        value = float(text)
        nearest = min(candidates, key=lambda candidate: abs(candidate - value))
        change, exact = abs(nearest - value), candidates[nearest]
        if change <= _ROUNDING * max(1.0, abs(value)):
            return exact
        if change > min(self.tolerance, LAST_PLACES * _place(text)):
            return None
        self.found.append(Snapped(where, text, exact, change))
        return exact


def _place(text: str) -> float:
    """The value of one unit in the last printed place of a decimal."""
    exponent = Decimal(text).as_tuple().exponent
    return 10.0**exponent if isinstance(exponent, int) else 0.0


def bounded(text: str) -> str:
    """A printed number as it is, if it has no more digits than one can mean; else the double that it is.

    The number of a file is a double, so 0e99999999 is 0. As a fraction it would have a hundred million digits.

    Raises:
        ValueError: if it is no finite number.
    """
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text!r} is not finite")
    plain = len(Decimal(text).as_tuple().digits) <= _DIGITS and abs(Decimal(text).adjusted()) <= _DIGITS
    return text.strip() if plain and value else repr(value)


def length(text: str) -> sp.Expr:
    """The number that a decimal stands for: a rational, one times √2, √3 or π, or one of 40 digits."""
    decimal = Decimal(text)
    if len(decimal.normalize().as_tuple().digits) <= 15:
        return sp.Rational(text)
    value = float(text)
    for scale in (sp.Integer(1), sp.sqrt(2), sp.sqrt(3), sp.pi, 1 / sp.pi):
        ratio = Fraction(value / float(scale)).limit_denominator(_SIMPLE)
        if abs(float(ratio) * float(scale) - value) <= _ROUNDING * abs(value):
            return sp.Rational(ratio.numerator, ratio.denominator) * scale
    shorter = Decimal(f"{value:.14e}")
    if abs(float(shorter) - value) <= _ROUNDING * abs(value):
        return sp.Rational(str(shorter))
    return sp.Float(text, _DIGITS)


def angle(text: str, where: str, snaps: Snaps) -> sp.Expr:
    """An angle (rad) as a multiple of π, or as the number it is."""
    turns = round(float(text) / (2 * math.pi))
    if abs(turns) <= 1:
        found = snaps.near(text, _ANGLES, where)
        if found is not None:
            return found
    return sp.Float(text, _DIGITS)


def direction(texts: Sequence[str], where: str, snaps: Snaps) -> sp.Matrix:
    """A unit vector along three printed numbers, shape (3, 1)."""
    exact = sp.Matrix([sp.Rational(text) for text in texts])
    if _square(exact) is None:
        entries = [_entry(text, where, snaps) for text in texts]
        if all(entry is not None for entry in entries) and sp.Matrix(entries).norm() == 1:
            return sp.Matrix(entries)
        largest = max(exact, key=abs)
        simple = sp.Matrix([sp.Rational(Fraction(float(x / largest)).limit_denominator(12)) for x in exact])
        close = max(abs(float(x / largest - y)) for x, y in zip(exact, simple, strict=True))
        if close <= _ROUNDING and _square(simple) is not None:
            return sp.sign(largest) * simple / sp.sqrt(simple.dot(simple))
        return (exact / sp.sqrt(exact.dot(exact))).n(_DIGITS)
    return exact / sp.sqrt(exact.dot(exact))


def _entry(text: str, where: str, snaps: Snaps) -> sp.Expr | None:
    sign = -1 if text.strip().startswith("-") else 1
    found = snaps.near(text.strip().lstrip("+-"), _ENTRIES, where)
    return None if found is None else sign * found


def _square(vector: sp.Matrix) -> sp.Expr | None:
    """The square of a vector's length if its root is kept as a root, else None."""
    square = vector.dot(vector)
    if max(square.p, square.q) > 10**9:
        return None
    primes = {p for p, k in {**sp.factorint(square.p), **sp.factorint(square.q)}.items() if k % 2}
    return square if primes <= set(PRIMES) else None


def rotation(angles: Sequence[sp.Expr]) -> sp.Matrix:
    """Rz(yaw) Ry(pitch) Rx(roll) of URDF's roll, pitch, yaw: shape (3, 3)."""
    (cr, sr), (cp, sp_), (cy, sy) = ((sp.cos(a), sp.sin(a)) for a in angles)
    return sp.Matrix(
        [
            [cy * cp, cy * sp_ * sr - sy * cr, cy * sp_ * cr + sy * sr],
            [sy * cp, sy * sp_ * sr + cy * cr, sy * sp_ * cr - cy * sr],
            [-sp_, cp * sr, cp * cr],
        ]
    ).applyfunc(sp.expand)
