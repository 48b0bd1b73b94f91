"""The algebra in which an answer and the right form are compared, and what a formula is worth in it.

It is that of `derivation.trig` with half angles: an angle θ stands for 2θ/2, so
that cos²(θ/2) has a normal form too. A joint's value is also a plain symbol, for θ without its cosine is a slip that
has to be told from others. Quotients are kept as two elements, and compared crosswise.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

import sympy as sp
from sympy.polys.rings import PolyElement

from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.trig import Algebra, Element, fraction
from pinscrew.ground.words import brief
from pinscrew.mathtext import Node, Number, Operation, Symbol

__all__ = ["NoValueError", "Quotient", "Scope"]

HIGHEST: Final = 12
"""The largest power."""
MOST_PRODUCTS: Final = 400_000
"""Products of terms in all that one scope works out: what no answer needs, and what ends within a second."""


class NoValueError(Exception):
    """A formula has no value in a scope; the message says why."""


@dataclass(frozen=True, slots=True)
class Quotient:
    """One element over another that is not zero."""

    over: Element
    under: Element

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Quotient) and not self.over * other.under - other.over * self.under

    def __neg__(self) -> Quotient:
        return Quotient(-self.over, self.under)

    def __hash__(self) -> int:
        return 0  # equal quotients may be written in many ways


class Scope:
    """What the symbols of formulas may stand for, and the algebra of their values.

    Args:
        derivation: the closed forms.
        free: letters of an answer that the robot does not have.
    """

    def __init__(self, derivation: Derivation, free: Iterable[str] = ()) -> None:
        chain = derivation.chain
        self.scale = 2
        values = [s for variable in derivation.variables for s in (variable.symbol, variable.rate)]
        roots = [int(s.args[0]) for s in chain.algebra.ring.symbols if s.is_Pow]
        letters = tuple(sp.Symbol(f"free {name}", real=True) for name in free)
        # A second derivative is in no right form; it is a letter, so that a dot too many is wrong, and not unread.
        self.accelerations = tuple(sp.Symbol(f"d{variable.rate}", real=True) for variable in derivation.variables)
        known = (*derivation.lengths, *values, *letters, *self.accelerations)
        # Within a group angles add, and so do they with letters; where these are no angles, they have no cosines.
        first, *others = chain.algebra.angles or ((),)
        groups = ((*first, *letters), *others) if letters else chain.algebra.angles
        self.algebra = Algebra(groups, known, sorted({2, 3, *roots}), exact=derivation.exact)
        self._angles = {angle for group in self.algebra.angles for angle in group}
        self._left = MOST_PRODUCTS
        self.one = self.algebra.constant(1)

    def refill(self) -> None:
        """Let as much be worked out as at the beginning, for another answer."""
        self._left = MOST_PRODUCTS

    def symbol(self, symbol: sp.Symbol) -> Element:
        """A symbol as itself."""
        return self.algebra.constant(symbol)

    def free(self, name: str) -> Element:
        """A letter that the robot does not have, as itself."""
        return self.symbol(sp.Symbol(f"free {name}", real=True))

    def turn(self, factors: Mapping[sp.Symbol, Fraction], constant: Fraction = Fraction(0)) -> tuple[Element, Element]:
        """Cosine and sine of a sum of angles times factors, and of a multiple of π.

        Raises:
            NoValueError: a factor is none of which the algebra has sines and cosines.
        """
        whole: dict[sp.Symbol, int] = {}
        for angle, factor in factors.items():
            scaled = factor * self.scale
            if scaled.denominator != 1 or abs(scaled) > 8 * self.scale:
                raise NoValueError(f"cosines and sines of {factor} {angle} are not compared")
            whole[angle] = int(scaled)
        cosine, sine = self.algebra.angle_sum(whole)
        if not constant:
            return cosine, sine
        if 12 % constant.denominator:
            raise NoValueError(f"cosines and sines of {constant} π are not compared: write a multiple of 15°")
        at = sp.Rational(constant.numerator, constant.denominator) * sp.pi
        c, s = (self.algebra.constant(sp.expand(f(at))) for f in (sp.cos, sp.sin))
        return cosine * c - sine * s, sine * c + cosine * s

    def adopt(self, element: Element) -> Element:
        """An element of the derivation's algebra, or of this one, in this one."""
        if element.algebra is self.algebra:
            return element
        found = self.algebra.constant(0)
        groups = element.algebra.angles
        for key, poly in element.terms.items():
            term = self._polynomial(poly)
            for atom, angles in zip(key, groups, strict=True):
                if atom is not None:
                    sine, m = atom
                    factors = {angle: Fraction(k) for angle, k in zip(angles, m, strict=True) if k}
                    term = term * self.turn(factors)[sine]
            found = found + term
        return found

    def _polynomial(self, poly: PolyElement) -> Element:
        return self.algebra.element({self.algebra.one: poly.set_ring(self.algebra.ring)})

    def value(self, node: Node, meanings: Mapping[str, Element]) -> Quotient:
        """What a formula is worth.

        Args:
            node: the formula.
            meanings: what its symbols stand for.

        Raises:
            NoValueError: it has none, or one that takes too long to find.
        """
        if isinstance(node, Number):
            return Quotient(self._number(node.value), self.one)
        if isinstance(node, Symbol):
            if node.name not in meanings:
                raise NoValueError(f"{brief(node.name)!r} is no symbol that is known here")
            return Quotient(meanings[node.name], self.one)
        return self._operation(node, [self.value(operand, meanings) for operand in node.operands])

    def _operation(self, node: Operation, operands: list[Quotient]) -> Quotient:
        first = operands[0]
        match node.operator:
            case "add":
                for other in operands[1:]:
                    first = self._sum(first, other)
            case "multiply":
                for other in operands[1:]:
                    first = self._product(first, other)
            case "negate":
                first = Quotient(-first.over, first.under)
            case "divide":
                first = self._divided(first, operands[1])
            case "power":
                first = self._power(first, operands[1])
            case "sqrt":
                first = Quotient(self.algebra.constant(self._root(first)), self.one)
            case "cos" | "sin" | "tan":
                cosine, sine = self.turn(*self._angle(first))
                if node.operator == "tan" and not cosine:
                    raise NoValueError("a tangent of 90° is no number")
                pair = {"cos": (cosine, self.one), "sin": (sine, self.one), "tan": (sine, cosine)}
                first = Quotient(*pair[node.operator])
        return first

    def _sum(self, a: Quotient, b: Quotient) -> Quotient:
        if a.under == b.under:
            return Quotient(a.over + b.over, a.under)
        return Quotient(self._times(a.over, b.under) + self._times(b.over, a.under), self._times(a.under, b.under))

    def _product(self, a: Quotient, b: Quotient) -> Quotient:
        return Quotient(self._times(a.over, b.over), self._times(a.under, b.under))

    def _times(self, a: Element, b: Element) -> Element:
        if a is self.one or b is self.one:
            return b if a is self.one else a
        self._left -= sum(map(len, a.terms.values())) * sum(map(len, b.terms.values())) * 2 ** len(self.algebra.one)
        if self._left < 0:
            raise NoValueError("the formula is too long, multiplied out")
        return a * b

    def _divided(self, a: Quotient, b: Quotient) -> Quotient:
        if not b.over:
            raise NoValueError("there is a division by zero")
        number = _rational(b.over)
        if number is not None and b.under is self.one:
            inverse = sp.Rational(number.denominator, number.numerator)
            return Quotient(self._times(a.over, self.algebra.constant(inverse)), a.under)
        return Quotient(self._times(a.over, b.under), self._times(a.under, b.over))

    def _power(self, base: Quotient, exponent: Quotient) -> Quotient:
        n = _rational(exponent.over) if exponent.under is self.one else None
        if n is not None and n == Fraction(1, 2):
            return Quotient(self.algebra.constant(self._root(base)), self.one)
        if n is None or n.denominator != 1 or abs(n) > HIGHEST:
            raise NoValueError(f"a power is not read; powers are whole numbers up to {HIGHEST}")
        if n < 0:
            base = self._divided(Quotient(self.one, self.one), base)
        found = Quotient(self.one, self.one)
        for _ in range(abs(int(n))):
            found = self._product(found, base)
        return found

    def _root(self, of: Quotient) -> sp.Expr:
        over, under = _rational(of.over), _rational(of.under)
        if over is None or under is None or over / under < 0:
            raise NoValueError("a root of something else than a number is not compared")
        ratio = over / under
        root = (
            sp.sqrt(sp.Rational(ratio.numerator, ratio.denominator)) if max(ratio.as_integer_ratio()) < 10**6 else None
        )
        try:
            _ = self.algebra.polynomial(root)
        except (TypeError, KeyError, sp.SympifyError):
            raise NoValueError(f"the root of {ratio} is not compared") from None
        return root

    def _number(self, value: float) -> Element:
        if value == math.pi:
            return self.algebra.constant(sp.pi)
        if value and not 1e-15 <= abs(value) <= 1e15:
            raise NoValueError(f"the number {value:g} is too large or too small")
        exact = Fraction(repr(value))
        return self.algebra.constant(sp.Rational(exact.numerator, exact.denominator))

    def _angle(self, of: Quotient) -> tuple[dict[sp.Symbol, Fraction], Fraction]:
        """A sum of angles by its factors, and its constant in multiples of π."""
        under = _rational(of.under)
        if under is None or any(key != self.algebra.one for key in of.over.terms):
            raise NoValueError("the angle of a cosine or sine is no sum of joints' values")
        factors: dict[sp.Symbol, Fraction] = {}
        constant = Fraction(0)
        for monomial, coefficient in of.over.terms.get(self.algebra.one, self.algebra.ring.zero).items():
            number = fraction(coefficient) / under
            there = [s for s, power in zip(self.algebra.ring.symbols, monomial, strict=True) if power]
            if sum(monomial) == 1 and there[0] in self._angles:
                factors[there[0]] = number
            elif sum(monomial) == 1 and there[0] == sp.pi:
                constant = number
            elif not there and not self.algebra.exact:
                constant = Fraction(float(number) / math.pi).limit_denominator(12)
                if abs(float(constant) * math.pi - float(number)) > 1e-12:
                    raise NoValueError("a cosine or sine of a number is not compared")
            else:
                what = "a number; write degrees as π/2" if not there else "what is no joint's angle"
                raise NoValueError(f"the angle of a cosine or sine has {what} in it")
        return factors, constant


def _rational(element: Element) -> Fraction | None:
    """The number that an element is."""
    if not element.terms:
        return Fraction(0)
    if len(element.terms) > 1 or element.algebra.one not in element.terms:
        return None
    poly = element.terms[element.algebra.one]
    return fraction(poly.coeff(1)) if poly.is_ground else None
