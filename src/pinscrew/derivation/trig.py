"""Sums of products of sines and cosines in a normal form: two of them are equal only if they are the same.

Joints whose axes stay parallel whatever the joints do form a *group*: within one, rotations commute and angles add.
With θ the angles of a group and m a vector of integers, write C_m = cos(m·θ) and S_m = sin(m·θ). The products

    C_m C_n = ½ C_{m-n} + ½ C_{m+n},   S_m S_n = ½ C_{m-n} - ½ C_{m+n},   S_m C_n = ½ S_{m+n} + ½ S_{m-n}

are linear again, so every polynomial in the sines and cosines of a group is a sum of C_m and S_m; and those are
linearly independent once m and -m are taken as one (C_{-m} = C_m, S_{-m} = -S_m, C_0 = 1, S_0 = 0). An element is
therefore a sum over products of at most one C or S from each group, with polynomials in lengths, displacements and
rates as coefficients. It is zero only if it has no terms: no identity such as s² + c² = 1 is ever looked for.

Angle sums come by themselves: c1 c2 - s1 s2 is C_{(1,1)} = c12. And since a pose g is affine in the C and S of each
group, so are g⁻¹ and the Jacobians: the ½ all cancel, and what is left is what one would write by hand.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from functools import cache
from typing import Any, Final, TypeAlias

import sympy as sp
from sympy.polys.domains import QQ
from sympy.polys.rings import PolyElement, PolyRing

__all__ = ["Algebra", "Atom", "Element", "Key", "fraction"]

Atom: TypeAlias = tuple[bool, tuple[int, ...]]
"""A sine (True) or cosine (False), and the vector m; the first entry of m that is not zero is positive."""
Key: TypeAlias = tuple[Atom | None, ...]
"""One atom, or None for 1, from each group."""

DIGITS: Final = 30
"""Decimals kept of numbers that are not exact, and of their products."""
NOTHING: Final = Fraction(1, 10**20)
"""Coefficients below it come of rounding at `DIGITS`, where there are numbers that are not exact."""


@cache
def _times(a: Atom, b: Atom) -> tuple[tuple[Atom | None, Fraction], ...]:
    """The product of two atoms of one group as a sum."""
    (a_sine, m), (b_sine, n) = a, b
    plus = tuple(i + j for i, j in zip(m, n, strict=True))
    minus = tuple(i - j for i, j in zip(m, n, strict=True))
    # Such as s1 · c12: m = (1,0), n = (1,1), ½ S(2,1) + ½ S(0,-1), which `_atom` makes ½ s(2·1+2) - ½ s2.
    half = Fraction(1, 2)
    if a_sine and b_sine:
        terms = (_atom(False, minus, half), _atom(False, plus, -half))
    elif a_sine:
        terms = (_atom(True, plus, half), _atom(True, minus, half))
    elif b_sine:
        terms = (_atom(True, plus, half), _atom(True, minus, -half))
    else:
        terms = (_atom(False, minus, half), _atom(False, plus, half))
    return tuple((atom, factor) for atom, factor in terms if factor)


def _atom(sine: bool, m: tuple[int, ...], factor: Fraction) -> tuple[Atom | None, Fraction]:
    """A C or S times a number, with m made positive; None stands for C_0 = 1."""
    first = next((i for i in m if i), 0)
    if not first:
        return None, Fraction(0) if sine else factor
    if first < 0:
        return (sine, tuple(-i for i in m)), -factor if sine else factor
    return (sine, m), factor


@cache
def _product(a: Key, b: Key) -> tuple[tuple[Key, Fraction], ...]:
    """The product of two keys as a sum."""
    # Groups are independent of each other, so that their products multiply out: (a + b)(c + d) over the groups.
    found: list[tuple[Key, Fraction]] = [((), Fraction(1))]
    for x, y in zip(a, b, strict=True):
        factors = ((x or y, Fraction(1)),) if x is None or y is None else _times(x, y)
        found = [((*key, atom), c * factor) for key, c in found for atom, factor in factors]
    return tuple(found)


def fraction(value: Any) -> Fraction:
    """A rational number of sympy's polynomials, whatever library keeps it."""
    return Fraction(int(value.numerator), int(value.denominator))


class Algebra:
    """What elements are made of: the groups of angles, and the symbols of the coefficients.

    Attributes:
        angles: the angles of each group, as symbols, in the order of the joints.
        ring: polynomials with rational coefficients in `symbols` and in the roots of some primes.
        exact: whether all numbers are; otherwise roots are numbers, and `DIGITS` decimals are kept.
        one: the empty product of each group.
    """

    def __init__(
        self, angles: Sequence[Sequence[sp.Symbol]], symbols: Iterable[sp.Expr], primes: Iterable[int], *, exact: bool
    ) -> None:
        self.angles = tuple(tuple(group) for group in angles)
        self.exact = exact
        self._primes = tuple(primes) if exact else ()
        self.symbols = (*symbols, *(() if not exact else (sp.pi,)))
        self.ring = PolyRing((*self.symbols, *(sp.sqrt(p) for p in self._primes)), QQ)
        self._first_root = len(self.symbols)
        self._generators: dict[Any, PolyElement] = dict(zip(self.ring.symbols, self.ring.gens, strict=True))
        self.one: Key = (None,) * len(self.angles)
        self._place = {a: (g, i) for g, group in enumerate(self.angles) for i, a in enumerate(group)}

    def polynomial(self, expression: Any) -> PolyElement:  # noqa: PLR0911 (one for each kind of expression)
        """A coefficient, read from a polynomial expression in the symbols, roots and numbers."""
        expression = sp.sympify(expression)
        if expression in self._generators:
            return self._generators[expression]
        if expression.is_Rational:
            return self.tidy(self.ring.ground_new(QQ(expression.p, expression.q)))
        if not expression.free_symbols and not self.exact:
            decimal = sp.Rational(str(expression.n(DIGITS + 10)))
            return self.tidy(self.ring.ground_new(QQ(decimal.p, decimal.q)))
        if expression.is_Add:
            return sum((self.polynomial(term) for term in expression.args), self.ring.zero)
        if expression.is_Mul:
            found = self.ring.one
            for factor in expression.args:
                found = self.tidy(found * self.polynomial(factor))
            return found
        if expression.is_Pow and expression.exp.is_Integer and expression.exp > 0:
            return self.tidy(self.polynomial(expression.base) ** int(expression.exp))
        if expression.is_Pow and expression.exp == sp.Rational(1, 2) and expression.base.is_Integer:
            factors = (self.polynomial(sp.sqrt(p)) ** k for p, k in sp.factorint(expression.base).items())
            found = self.ring.one
            for factor in factors:
                found = self.tidy(found * factor)
            return found
        raise TypeError(f"{expression} is no polynomial in {self.ring.symbols}")

    def tidy(self, poly: PolyElement) -> PolyElement:
        """The polynomial with √p² = p put in, or with its numbers rounded."""
        if not self.exact:
            unit = 10**DIGITS
            rounded = ((monomial, QQ(round(fraction(c) * unit), unit)) for monomial, c in poly.items())
            return poly.new({monomial: c for monomial, c in rounded if abs(fraction(c)) > NOTHING})
        start = self._first_root
        if not any(max(monomial[start:], default=0) > 1 for monomial in poly):
            return poly
        out = self.ring.zero
        for monomial, coefficient in poly.items():
            low, whole = list(monomial), 1
            for i, prime in enumerate(self._primes, start):
                whole *= prime ** (low[i] // 2)
                low[i] %= 2
            out += self.ring.term_new(tuple(low), coefficient * QQ(whole))
        return out

    def element(self, terms: Mapping[Key, PolyElement]) -> Element:
        """The element with these terms."""
        tidied = ((key, self.tidy(poly)) for key, poly in terms.items())
        return Element(self, {key: poly for key, poly in tidied if poly})

    def constant(self, expression: Any) -> Element:
        """An element without sines and cosines."""
        return self.element({self.one: self.polynomial(expression)})

    def cosine(self, angle: sp.Symbol) -> Element:
        """cos of one angle."""
        return self._single(angle, sine=False)

    def sine(self, angle: sp.Symbol) -> Element:
        """sin of one angle."""
        return self._single(angle, sine=True)

    def _single(self, angle: sp.Symbol, *, sine: bool) -> Element:
        g, i = self._place[angle]
        m = [0] * len(self.angles[g])
        m[i] = 1
        return self._of_group(g, tuple(m), sine=sine)

    def _of_group(self, group: int, m: tuple[int, ...], *, sine: bool) -> Element:
        atom, factor = _atom(sine, m, Fraction(1))
        key = (*self.one[:group], atom, *self.one[group + 1 :])
        return self.element({key: self.ring.ground_new(QQ(factor.numerator, factor.denominator))})

    def angle_sum(self, coefficients: Mapping[sp.Symbol, int]) -> tuple[Element, Element]:
        """cos and sin of a sum of angles times integers, which may be of several groups."""
        cosine, sine = self.constant(1), self.constant(0)
        for g, group in enumerate(self.angles):
            m = tuple(coefficients.get(angle, 0) for angle in group)
            if any(m):
                c, s = self._of_group(g, m, sine=False), self._of_group(g, m, sine=True)
                # cos(a + b) and sin(a + b): across groups they stay products, which is their normal form.
                cosine, sine = cosine * c - sine * s, sine * c + cosine * s
        return cosine, sine

    def read(self, expression: Any) -> Element:
        """An element from an expression: a polynomial in the symbols and in sines and cosines of angle sums.

        Raises:
            TypeError: if it is something else.
        """
        expression = sp.sympify(expression)
        if expression.is_Add:
            return sum((self.read(term) for term in expression.args), self.constant(0))
        if expression.is_Mul:
            found = self.constant(1)
            for factor in expression.args:
                found = found * self.read(factor)
            return found
        if expression.is_Pow and expression.exp.is_Integer and expression.exp > 0:
            found = self.constant(1)
            for _ in range(int(expression.exp)):
                found = found * self.read(expression.base)
            return found
        if isinstance(expression, (sp.cos, sp.sin)):
            (argument,) = expression.args
            linear = argument.as_coefficients_dict()
            if not all(angle in self._place and factor.is_Integer for angle, factor in linear.items()):
                raise TypeError(f"{expression} is not of a sum of angles")
            both = self.angle_sum({angle: int(factor) for angle, factor in linear.items()})
            return both[isinstance(expression, sp.sin)]
        return self.constant(expression)


class Element:
    """A sum of products of sines and cosines, in normal form; made by an `Algebra`."""

    __slots__ = ("algebra", "terms")

    def __init__(self, algebra: Algebra, terms: dict[Key, PolyElement]) -> None:
        self.algebra = algebra
        self.terms = terms

    def __repr__(self) -> str:
        return f"<Element of {len(self.terms)} terms>"

    def __bool__(self) -> bool:
        return bool(self.terms)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Element) and not self - other

    def __hash__(self) -> int:
        return hash(frozenset((key, frozenset(poly.items())) for key, poly in self.terms.items()))

    def __neg__(self) -> Element:
        return Element(self.algebra, {key: -poly for key, poly in self.terms.items()})

    def __add__(self, other: Element) -> Element:
        if not self.terms or not other.terms:
            return self if self.terms else other
        terms = dict(self.terms)
        for key, poly in other.terms.items():
            terms[key] = terms[key] + poly if key in terms else poly
        return self.algebra.element(terms)

    def __sub__(self, other: Element) -> Element:
        return self + -other

    def __mul__(self, other: Element) -> Element:
        terms: dict[Key, PolyElement] = {}
        for a, p in self.terms.items():
            for b, q in other.terms.items():
                coefficient = p * q
                for key, factor in _product(a, b):
                    scaled = (
                        coefficient if factor == 1 else coefficient.mul_ground(QQ(factor.numerator, factor.denominator))
                    )
                    terms[key] = terms[key] + scaled if key in terms else scaled
        return self.algebra.element(terms)

    def derivative(self, symbol: sp.Symbol) -> Element:
        """The partial derivative with respect to an angle or a symbol of the coefficients."""
        if symbol not in self.algebra._place:
            generator = self.algebra.polynomial(symbol)
            return self.algebra.element({key: poly.diff(generator) for key, poly in self.terms.items()})
        group, i = self.algebra._place[symbol]
        terms: dict[Key, PolyElement] = {}
        for key, poly in self.terms.items():
            atom = key[group]
            if atom is not None and atom[1][i]:
                # d/dθᵢ C_m = -mᵢ S_m and d/dθᵢ S_m = mᵢ C_m: the other atom of the same m.
                turned = (*key[:group], (not atom[0], atom[1]), *key[group + 1 :])
                terms[turned] = poly.mul_ground(QQ(atom[1][i] if atom[0] else -atom[1][i]))
        return self.algebra.element(terms)
