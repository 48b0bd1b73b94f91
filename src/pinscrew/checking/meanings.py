"""What the symbols of an answer stand for: joints, rates, lengths, and sines and cosines of sums of angles.

Names are compared without underscores and braces. A letter that is known by no name has no
meaning, and none is guessed.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Final

import sympy as sp

from pinscrew.checking.scope import NoValueError, Quotient, Scope
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.trig import Element
from pinscrew.mathtext import Node

__all__ = ["Meanings", "given"]

LONGEST_NAME: Final = 40
"""Characters of a name."""
_VALUE: Final = r"(?:theta|vartheta|th|t|q|θ|ϑ)"
_SHORT: Final = re.compile(rf"(c|s|C|S|cos|sin)({_VALUE}?(?:[\d+\-,m*x]|{_VALUE})*\d)")
_TERM: Final = re.compile(r"([+-]?)(?:(\d)[*x])?(\d+)")
_RATE: Final = re.compile(
    rf"(?:dot|d)({_VALUE}|d)(\d+)|({_VALUE}|d)(\d+)(?:dot|d|p)|({_VALUE})(?:dot|d|p)(\d+)|(?:qd|dq|qdot)(?:\[(\d+)\]|\((\d+)\))"
)


class Meanings:
    """The names that have a meaning for one robot's joints and lengths."""

    def __init__(self, derivation: Derivation, free: Iterable[str] = ()) -> None:
        self._free = frozenset(free)
        self._variables = {variable.label: variable for variable in derivation.variables}
        self._numbered = list(derivation.variables)
        self._lengths = {_plain(str(symbol)): symbol for symbol in derivation.lengths}
        self._angles = {angle for group in derivation.chain.algebra.angles for angle in group}
        self._joints = {_plain(variable.joint): variable.symbol for variable in derivation.variables}
        self._joints |= {str(variable.symbol): variable.symbol for variable in derivation.variables}
        self._rates = {str(variable.rate): variable.rate for variable in derivation.variables}

    def find(self, name: str, scope: Scope) -> Element | None:
        """What a name stands for, or None if nothing is known of it."""
        if len(name) > LONGEST_NAME:
            return None
        if name in self._free:
            return scope.free(name)
        return self._known(_plain(name), scope)

    def _known(self, plain: str, scope: Scope) -> Element | None:
        length = self._length(plain)
        if length is not None:
            return scope.symbol(length)
        if plain in self._rates or plain in self._joints:
            return scope.symbol(self._rates.get(plain) or self._joints[plain])
        rate = self._rate(plain)
        if rate is not None:
            return scope.symbol(rate)
        twice = re.fullmatch(rf"dd(?:ot)?(?:{_VALUE}|d)(\d+)", plain)
        if twice:
            number = int(twice[1])
            there = 1 <= number <= len(self._numbered)
            return scope.symbol(scope.accelerations[number - 1]) if there else None
        short = _SHORT.fullmatch(plain)
        if short:
            angles = self._sum(re.sub(_VALUE, "", short[2]))
            return None if angles is None else scope.turn(angles)[short[1][0] in "sS"]
        return self._value(plain, scope)

    def _length(self, plain: str) -> sp.Symbol | None:
        if plain in self._lengths:
            return self._lengths[plain]
        same = [symbol for known, symbol in self._lengths.items() if known.lower() == plain.lower()]
        return same[0] if len(same) == 1 else None

    def _rate(self, plain: str) -> sp.Symbol | None:
        found = _RATE.fullmatch(plain)
        if not found:
            return None
        groups = found.groups()
        digits = groups[1] or groups[3] or groups[5]
        number = int(digits) if digits else int(groups[6]) + 1 if groups[6] else int(groups[7] or 0)
        return self._numbered[number - 1].rate if 1 <= number <= len(self._numbered) else None

    def _value(self, plain: str, scope: Scope) -> Element | None:
        indexed = re.fullmatch(rf"{_VALUE}(?:\[(\d+)\]|\((\d+)\))", plain)
        if indexed:
            number = int(indexed[1]) + 1 if indexed[1] else int(indexed[2])
            return self._of_number(number, scope)
        named = re.fullmatch(rf"({_VALUE}|d)(\d*)", plain)
        if not named:
            return None
        if not named[2]:
            return self._of_number(1, scope) if len(self._numbered) == 1 and named[1] != "t" else None
        number = int(named[2])
        if number <= len(self._numbered):
            sliding = number >= 1 and self._numbered[number - 1].symbol not in self._angles
            return self._of_number(number, scope) if named[1] != "d" or sliding else None
        angles = self._sum(named[2]) if named[1] != "d" else None  # θ12 is θ1 + θ2
        if angles is None:
            return None
        parts = [scope.symbol(angle) * scope.algebra.constant(int(factor)) for angle, factor in angles.items()]
        return sum(parts, scope.algebra.constant(0))

    def _of_number(self, number: int, scope: Scope) -> Element | None:
        if not 1 <= number <= len(self._numbered):
            return None
        return scope.symbol(self._numbered[number - 1].symbol)

    def _sum(self, text: str) -> dict[sp.Symbol, Fraction] | None:
        """The angles of an index such as 12, 1-2, 1+2, 1m2 or 2*1."""
        text = text.replace("m", "-").replace(",", "+")
        if not re.fullmatch(rf"(?:{_TERM.pattern})+", text):
            return None
        found: dict[sp.Symbol, Fraction] = {}
        for sign, factor, digits in _TERM.findall(text):
            for position, digit in enumerate(digits):
                variable = self._variables.get(digit)
                if variable is None or variable.symbol not in self._angles:
                    return None
                weight = int(factor or 1) * (-1 if sign == "-" and position == 0 else 1)
                found[variable.symbol] = found.get(variable.symbol, Fraction(0)) + weight
        return found


def given(names: set[str], meanings: Meanings, scope: Scope, definitions: Mapping[str, Node]) -> dict[str, Element]:
    """What each of some names stands for; those that stand for nothing are left out.

    Args:
        names: the names.
        meanings: of the robot.
        scope: whose elements are wanted.
        definitions: formulas that the answer gives names to, in order: ``c1 = cos(t1)``.
    """
    found: dict[str, Element] = {}
    for name in names:
        element = meanings.find(name, scope)
        if element is not None:
            found[name] = element
    for name, node in definitions.items():
        try:
            value: Quotient = scope.value(node, found)
        except NoValueError:
            found.pop(name, None)  # what the answer says it is, it is not understood: it is nothing else either
            continue
        if value.under is scope.one:
            found[name] = value.over
    return found


def _plain(name: str) -> str:
    """A name without what is only typography."""
    return re.sub(r"[_{}\s\\^]", "", name)
