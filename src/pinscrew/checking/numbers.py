"""Answers in numbers, at a configuration: how near is near enough, and angles taken for degrees."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

import numpy as np
import sympy as sp

from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.trig import Element, fraction
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray

__all__ = ["Near", "at_configuration", "last_digit", "number"]

ROUNDING: Final = 1e-9
FEW_DIGITS: Final = 1e-6
"""How near a number with no, or one, decimal must be: it is taken for exact."""
_LITERAL: Final = re.compile(r"[-+]?\d*(?:\.(\d*))?(?:[eE]([-+]?\d{1,3}))?")


@dataclass(frozen=True, slots=True)
class Near:
    """A number, and by how much another one may differ and still be it."""

    value: float
    tolerance: float = 0.0

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Near):
            return NotImplemented
        size = ROUNDING * max(1.0, abs(self.value), abs(other.value))
        return abs(self.value - other.value) <= max(self.tolerance, other.tolerance, size)

    def __hash__(self) -> int:
        return 0  # near is not transitive

    def __neg__(self) -> Near:
        return Near(-self.value, self.tolerance)

    def __bool__(self) -> bool:
        return self != Near(0.0)


def last_digit(cell: str) -> float:
    """By how much a number may differ as it is written: one in its last decimal, of which it has two or more.

    ``0.71`` is 0.7071 and ``0.707`` too; ``0.7`` and ``1`` are what they say. A formula is exact.
    """
    found = _LITERAL.fullmatch(cell.strip())
    if not found or len(found[1] or "") < 2:
        return FEW_DIGITS if found else 0.0
    return float(10.0 ** (int(found[2] or 0) - len(found[1])))


def at_configuration(derivation: Derivation, q: FloatArray) -> dict[sp.Symbol, float]:
    """The numbers of the symbols at a configuration: joints' values (rad, m) and the lengths of the robot (m).

    Raises:
        InputError: q is not of the robot's shape (nq,), or not finite.
    """
    robot = derivation.robot
    q = np.asarray(q, dtype=float)
    if q.shape != (robot.nq,) or not np.isfinite(q).all():
        what = f"q has shape {q.shape}, or is not finite; {robot.name} has {robot.nq} coordinates"
        raise InputError("shape", what)
    found = {symbol: float(value) for symbol, value in derivation.lengths.items()}
    for variable in derivation.variables:
        found[variable.symbol] = float(q[robot.coordinate_names.index(variable.joint)])
    return found


def number(element: Element, at: Mapping[sp.Symbol, float], scale: int = 1) -> float:
    """What an element is worth.

    Args:
        element: of an algebra whose angles are those of ``at``, divided by ``scale``.
        at: numbers of the symbols.
        scale: 2 for half angles.

    Raises:
        InputError: a symbol has no number: a joint's rate.
    """
    total = 0.0
    for key, poly in element.terms.items():
        factor = 1.0
        for atom, angles in zip(key, element.algebra.angles, strict=True):
            if atom is not None:
                turned = sum(m * at[angle] for angle, m in zip(angles, atom[1], strict=True) if m) / scale
                factor *= math.sin(turned) if atom[0] else math.cos(turned)
        for monomial, coefficient in poly.items():
            term = float(Fraction(fraction(coefficient)))
            for symbol, power in zip(element.algebra.ring.symbols, monomial, strict=True):
                if power:
                    term *= _worth(symbol, at) ** power
            total += factor * term
    return total


def _worth(symbol: sp.Expr, at: Mapping[sp.Symbol, float]) -> float:
    if symbol in at:
        return at[symbol]
    if symbol.free_symbols:
        what = f"{symbol} has no number: -q gives joints' values, and no rates"
        raise InputError("check-quantity", what, remedy="give the answer in symbols")
    return float(symbol)
