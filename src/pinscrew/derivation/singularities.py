"""Manipulability and singular configurations: determinants of Jacobians, with the sines and cosines they contain.

The square of the manipulability is det(JᵀJ) for an arm of fewer than six joints, (det J)² for six. A determinant is
a trigonometric polynomial; written with s² = 1 - c² as a(c) + b(c) s, it is divisible by s = sin θ where it vanishes
at θ = 0 and π, that is where a(1) = a(-1) = 0, and then a = (1 - c²) a′ and the quotient is a′ s + b. So sines (and
in the same way cosines) of single joints are divided out as often as they go; what is left is shown as it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Final

import numpy as np
import sympy as sp
from sympy.polys.domains import QQ
from sympy.polys.rings import PolyElement, PolyRing

from pinscrew.derivation.chain import Elements
from pinscrew.derivation.factoring import operations
from pinscrew.derivation.forms import ClosedForms
from pinscrew.derivation.squares import blocks, sum_of_squares
from pinscrew.derivation.trig import Algebra, Element

__all__ = ["Measure", "Singularities", "singularities"]

MOST_TERMS: Final = 20_000
"""Terms of a minor above which a determinant is given up."""


@dataclass(frozen=True, slots=True)
class Measure:
    """A determinant that vanishes at singular configurations.

    Attributes:
        name: what it is, in LaTeX.
        value: the determinant, factored.
        factors: those of its factors that can vanish.
    """

    name: str
    value: sp.Expr
    factors: tuple[sp.Expr, ...]


@dataclass(frozen=True, slots=True)
class Singularities:
    """The determinants that say where an arm is singular.

    Attributes:
        words: which they are, and why.
        measures: the determinants; none where they are too long to be of use.
    """

    words: str
    measures: tuple[Measure, ...]


class _TooLongError(Exception):
    """A determinant has more than `MOST_TERMS` terms."""


def singularities(derivation: ClosedForms) -> Singularities:
    """The determinants of a derivation's Jacobian that fit its number of joints."""
    d = derivation
    n = len(d.screws)
    if d.follows:
        return Singularities("Where joints follow others, a determinant in closed form is not offered.", ())
    if not 0 < n <= 6:
        words = "There are no joints." if not n else "For more than six joints $\\det(J J^T)$ is too long to be of use."
        return Singularities(words, ())
    found = []
    trig = _Polynomials(d)
    try:
        if n == 6:
            words = "The six columns are dependent where the determinant vanishes; it is the same in every frame."
            found.append(trig.measure(r"\det J", trig.determinant(d.normal.at(3))))
        else:
            words = (
                "The columns are dependent where $\\det(J^T J)$ vanishes, the square of the manipulability. It adds "
                "metres to radians, so its size means nothing; where it is zero does."
            )
            body = d.normal.body
            found.append(trig.squares(r"\det\left( (J^{b})^{T} J^{b} \right)", body))
            position = body[:3][[bool(row.any()) for row in body[:3]]]
            if len(position) == n:
                found.append(trig.measure(r"\det J_{v}", trig.determinant(position)))
                words += " $J_{v}$ has the rows of the tool's origin that are not zero everywhere."
            elif len(position) > n:
                found.append(trig.squares(r"\det\left( J_{v}^{T} J_{v} \right)", position))
                words += " $J_{v}$ has the rows of the tool's origin that are not zero everywhere."
    except _TooLongError:
        return Singularities("Its determinant is too long to be of use.", ())
    return Singularities(words, tuple(found))


class _Polynomials:
    """Elements as polynomials in the sines and cosines of single joints, reduced by s² = 1 - c²."""

    def __init__(self, derivation: ClosedForms) -> None:
        self.d = derivation
        self.algebra: Algebra = derivation.chain.algebra
        self.angles = [angle for group in self.algebra.angles for angle in group]
        coefficients = self.algebra.ring
        self.count = len(coefficients.symbols)
        self.pairs = [(sp.Symbol(f"cos_{a}"), sp.Symbol(f"sin_{a}")) for a in self.angles]
        self.ring = PolyRing((*coefficients.symbols, *(s for pair in self.pairs for s in pair)), QQ)
        self.trig = {a: self.ring.gens[self.count + 2 * i : self.count + 2 * i + 2] for i, a in enumerate(self.angles)}

    def polynomial(self, element: Element) -> PolyElement:
        """An element as a polynomial."""
        out = self.ring.zero
        # cos(m·θ) and sin(m·θ) by their addition theorems, one angle at a time: c12 becomes c1 c2 - s1 s2.
        for key, poly in element.terms.items():
            zeros = (0,) * (2 * len(self.angles))
            term = self.ring.from_dict({(*monomial, *zeros): c for monomial, c in poly.items()})
            for group, atom in zip(self.algebra.angles, key, strict=True):
                if atom is not None:
                    cosine, sine = self.ring.one, self.ring.zero
                    for angle, factor in zip(group, atom[1], strict=True):
                        c, s = self.trig[angle]
                        s = s if factor > 0 else -s
                        for _ in range(abs(factor)):
                            cosine, sine = cosine * c - sine * s, sine * c + cosine * s
                    term *= sine if atom[0] else cosine
            out += term
        return self.reduced(out)

    def reduced(self, poly: PolyElement, *, cosines: bool = False) -> PolyElement:
        """The polynomial with s² = 1 - c² (or, ``cosines``, c² = 1 - s²) put in."""
        if len(poly) > MOST_TERMS:
            raise _TooLongError
        for angle in self.angles:
            c, s = self.trig[angle]
            gone, kept = (c, s) if cosines else (s, c)
            i = self.ring.gens.index(gone)
            if all(monomial[i] < 2 for monomial in poly):
                continue
            out = self.ring.zero
            for monomial, coefficient in poly.items():
                power = monomial[i]
                low = (*monomial[:i], power % 2, *monomial[i + 1 :])
                out += self.ring.term_new(low, coefficient) * (1 - kept**2) ** (power // 2)
            poly = out
        return self._tidy(poly)

    def _tidy(self, poly: PolyElement) -> PolyElement:
        """The polynomial with roots multiplied out, or numbers rounded, as its algebra does with coefficients."""
        parts: dict[tuple[int, ...], dict[tuple[int, ...], object]] = {}
        for monomial, coefficient in poly.items():
            parts.setdefault(monomial[self.count :], {})[monomial[: self.count]] = coefficient
        ring = self.algebra.ring
        tidied = {tail: self.algebra.tidy(ring.from_dict(head)) for tail, head in parts.items()}
        return self.ring.from_dict({(*m, *tail): c for tail, head in tidied.items() for m, c in head.items()})

    def determinant(self, matrix: Elements) -> PolyElement:
        """The determinant of a square matrix of elements."""
        return self._determinant([[self.polynomial(x) for x in row] for row in matrix])

    def squares(self, name: str, matrix: Elements) -> Measure:
        """det(AᵀA) in factors that are sums of squares, so that it is seen whether they can vanish.

        By Cauchy and Binet it is Σ m², over the minors m of A with all columns. Where A falls into blocks (columns
        that share no row with the others), it is the product of those of the blocks. Example, the spherical arm:
        column 1 of J^b has -r c2, -s2, c2 in rows of its own, whose squares are 1 + r² c2².
        """
        value, factors = sp.Integer(1), []
        for rows, columns in blocks(matrix):
            block = matrix[np.ix_(rows, columns)]
            minors = [self._minor(block[list(chosen)]) for chosen in combinations(range(len(rows)), len(columns))]
            minors = [minor for minor in minors if minor]
            if not minors:
                return Measure(name, sp.Integer(0), ())
            common, rest = sum_of_squares(minors, self.d.atoms.explicit)
            value *= rest * sp.Mul(*(factor**2 for factor in common))
            factors += [factor for factor in common if self._varies(factor)]
            if self._varies(rest) and not any(term.is_positive for term in sp.Add.make_args(rest)):
                factors.append(rest)
        return Measure(name, value, tuple(dict.fromkeys(factors)))

    def _minor(self, rows: Elements) -> sp.Expr:
        poly = self.determinant(rows)
        return self.measure("", poly).value

    def _varies(self, expression: sp.Expr) -> bool:
        return bool(expression.free_symbols & (self.d.atoms.explicit.keys() | set(self.d.joint_values)))

    def _determinant(self, rows: Sequence[Sequence[PolyElement]]) -> PolyElement:
        """Laplace's expansion, row by row over sets of columns."""
        minors: dict[tuple[int, ...], PolyElement] = {(): self.ring.one}
        for row in rows:
            longer: dict[tuple[int, ...], PolyElement] = {}
            # Minors of the rows so far by their columns: 2ⁿ of them instead of n! products.
            for columns, minor in minors.items():
                for j, entry in enumerate(row):
                    if entry and minor and j not in columns:
                        place = sum(k > j for k in columns)  # how many columns the new one stands before: its sign
                        chosen = tuple(sorted((*columns, j)))
                        term = self.reduced(minor * entry)
                        longer[chosen] = longer.get(chosen, self.ring.zero) + (-term if place % 2 else term)
            minors = longer
        return self.reduced(minors.get(tuple(range(len(rows))), self.ring.zero))

    def measure(self, name: str, poly: PolyElement) -> Measure:
        """A determinant in factors."""
        if not poly:
            return Measure(name, sp.Integer(0), ())
        outside: list[tuple[sp.Expr, int]] = []
        for angle in self.angles:
            for sine in (True, False):
                power = 0
                while (quotient := self._divided(poly, angle, sine=sine)) is not None:
                    poly, power = quotient, power + 1
                if power:
                    atom = self.algebra.sine(angle) if sine else self.algebra.cosine(angle)
                    outside.append((self._written(atom), power))
        rest = self._rest(poly)
        factors = [factor for factor, _ in outside]
        for factor in sp.Mul.make_args(rest):
            base = factor.base if factor.is_Pow else factor
            if base.is_positive:
                continue
            if base.free_symbols & (self.d.atoms.explicit.keys() | set(self.d.joint_values)):
                factors.append(base)
        return Measure(name, sp.Mul(rest, *(factor**power for factor, power in outside)), tuple(factors))

    def _divided(self, poly: PolyElement, angle: sp.Symbol, *, sine: bool) -> PolyElement | None:
        """The polynomial divided by the sine or cosine of an angle, or None where that is not possible."""
        c, s = self.trig[angle]
        divisor, other = (s, c) if sine else (c, s)
        poly = self.reduced(poly, cosines=not sine)
        i = self.ring.gens.index(divisor)
        # a(c) + b(c) s, as s² = 1 - c² leaves s to the first power. Example: c² - 1 - 2 c s is (-s - 2 c) s.
        b = self.ring.from_dict({(*m[:i], 0, *m[i + 1 :]): x for m, x in poly.items() if m[i]})
        a = poly - b * divisor
        # a vanishes where the other is ±1, so that it is (1 - other²) a′
        quotient, remainder = divmod(a, 1 - other**2)
        if self._tidy(remainder) or not poly:
            return None
        return self.reduced(quotient * divisor + b)

    def _rest(self, poly: PolyElement) -> sp.Expr:
        """What is left, in the shorter of two forms: sums of angles, or single angles."""
        poly = self.reduced(poly)
        element = self.algebra.constant(0)
        for monomial, coefficient in poly.items():
            head = self.algebra.element(
                {self.algebra.one: self.algebra.ring.from_dict({monomial[: self.count]: coefficient})}
            )
            for i, angle in enumerate(self.angles):
                c, s = monomial[self.count + 2 * i : self.count + 2 * i + 2]
                for _ in range(c):
                    head = head * self.algebra.cosine(angle)
                for _ in range(s):
                    head = head * self.algebra.sine(angle)
            element = element + head
        forms = [self._written(element)]
        names = {}
        for angle, (c, s) in zip(self.angles, self.pairs, strict=True):
            names[c] = self._written(self.algebra.cosine(angle))
            names[s] = self._written(self.algebra.sine(angle))
        if self.algebra.exact and len(poly) <= 200:
            factored = [sp.factor(self.reduced(poly, cosines=flag).as_expr()).xreplace(names) for flag in (False, True)]
            forms += factored
        return min(forms, key=operations)

    def _written(self, element: Element) -> sp.Expr:
        return self.d.write(np.array([[element]], dtype=object))[0, 0]
