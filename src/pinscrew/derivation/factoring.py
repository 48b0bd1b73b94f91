"""From the normal form to what a person would write: common factors outside, angle sums kept.

An element is a sum of (coefficient × one atom of each group). What all terms share goes outside: an atom, a factor
of the coefficients. Then the terms are parted, by the atom of one group or by their coefficients, whichever saves
most operations, and each part is treated in the same way. Nothing is expanded and nothing is tried blindly, so the
work grows with the number of terms, and what can't be shortened is left as it is.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from functools import reduce
from typing import Any, Final, TypeAlias

import sympy as sp
from sympy.polys.rings import PolyElement

from pinscrew.derivation.atoms import Atoms
from pinscrew.derivation.trig import Element, Key

__all__ = ["Factoring", "operations"]

Terms: TypeAlias = tuple[tuple[Key, PolyElement], ...]

WAYS: Final = 2
"""Ways of parting that are followed to the end, the most promising ones."""
MANY: Final = 24
"""Terms above which only the most promising way is followed."""
LONGEST: Final = 40
"""Monomials above which no polynomial factors are looked for."""
FINE: Final = 10**12
"""Denominators above which a coefficient is written as a decimal: it is one of `trig.DIGITS` digits."""


def operations(expression: sp.Expr) -> int:
    """How many additions and multiplications an expression takes as it is written; a sign is free."""
    if not expression.args or expression.is_Rational:
        return 0
    inner = sum(operations(argument) for argument in expression.args)
    if expression.is_Pow:
        return inner + int(expression.exp) - 1 if expression.exp.is_Integer and expression.exp > 0 else inner
    free = int(expression.is_Mul and expression.args[0] == -1)
    return inner + len(expression.args) - 1 - free


class Factoring:
    """Writes elements of one algebra as sympy expressions in the symbols of `Atoms`."""

    def __init__(self, atoms: Atoms) -> None:
        self.atoms = atoms
        self._known: dict[Hashable, sp.Expr] = {}
        self._polynomials: dict[PolyElement, sp.Expr] = {}

    def expression(self, element: Element) -> sp.Expr:
        """The element as an expression."""
        return self._written(tuple(sorted(element.terms.items(), key=_by_key)), exact=element.algebra.exact)

    def _written(self, terms: Terms, *, exact: bool) -> sp.Expr:
        if not terms:
            return sp.Integer(0)
        memo = tuple((key, tuple(poly.items())) for key, poly in terms)
        if memo not in self._known:
            self._known[memo] = self._split(terms, exact=exact)
        return self._known[memo]

    def _split(self, terms: Terms, *, exact: bool) -> sp.Expr:
        """What all terms share, times the rest."""
        # Example: l1 c1 c3 + l2 c1 s3 shares c1, and is c1 (l1 c3 + l2 s3).
        shared = _shared(terms)
        outside = [self.atoms.symbol(g, atom) for g, atom in enumerate(shared) if atom is not None]
        common = _content([poly for _, poly in terms], exact=exact)
        inner = tuple(
            (tuple(None if s is not None else atom for s, atom in zip(shared, key, strict=True)), _exquo(poly, common))
            for key, poly in terms
        )
        outside += self._signed(common)
        if len(inner) == 1:
            return sp.Mul(*self._signed(inner[0][1]), *outside)
        return sp.Mul(self._sum(inner, exact=exact), *outside)

    def _sum(self, terms: Terms, *, exact: bool) -> sp.Expr:
        """A sum without common factors, parted as it is shortest."""
        if len(terms) == 2:
            return sp.Add(*(self._term(key, poly) for key, poly in terms))
        # Example: l1 c1 + l2 c1 c2 + l2 s1 s2 is c1 (l1 + l2 c2) + l2 s1 s2, parted by the first group, and
        # l1 c1 + l2 (c1 c2 + s1 s2), parted by coefficients. The shortest is kept.
        groups = range(len(terms[0][0]))
        partings = [_parted(terms, lambda key, _, g=g: key[g]) for g in groups]  # type: ignore[misc]
        partings.append(_parted(terms, lambda _, poly: tuple(sorted(poly.monic().items()))))
        partings = sorted((parts for parts in partings if 1 < len(parts) < len(terms)), key=len)
        if len(terms) > MANY and partings:
            return sp.Add(*(self._written(part, exact=exact) for part in partings[0]))
        best = sp.Add(*(self._term(key, poly) for key, poly in terms))
        cost = operations(best)
        for parts in partings[:WAYS]:
            found = sp.Add(*(self._written(part, exact=exact) for part in parts))
            if operations(found) < cost:
                best, cost = found, operations(found)
        return best

    def _term(self, key: Key, poly: PolyElement) -> sp.Expr:
        atoms = (self.atoms.symbol(g, atom) for g, atom in enumerate(key) if atom is not None)
        return sp.Mul(*self._signed(poly), *atoms)

    def _signed(self, poly: PolyElement) -> tuple[sp.Expr, ...]:
        """The factors of a coefficient, signs and numbers by themselves: sympy would multiply them into sums."""
        if poly.LC < 0:
            return sp.Integer(-1), *self._signed(-poly)
        if len(poly) > 1 and poly.LC != 1 and len({abs(c) for c in poly.values()}) == 1:
            return _coefficient(poly.LC), self._polynomial(poly.monic())
        return (self._polynomial(poly),)

    def _polynomial(self, poly: PolyElement) -> sp.Expr:
        if poly not in self._polynomials:
            self._polynomials[poly] = _factored(poly)
        return self._polynomials[poly]


def _by_key(term: tuple[Key, PolyElement]) -> tuple[Any, ...]:
    return tuple((atom is None, atom or ()) for atom in term[0])


def _shared(terms: Terms) -> Key:
    """The atoms that all terms have."""
    columns = zip(*(key for key, _ in terms), strict=True)
    return tuple(atoms[0] if all(atom == atoms[0] for atom in atoms) else None for atoms in columns)


def _parted(terms: Terms, way: Callable[[Key, PolyElement], Hashable]) -> list[Terms]:
    parts: dict[Hashable, list[tuple[Key, PolyElement]]] = {}
    for key, poly in terms:
        parts.setdefault(way(key, poly), []).append((key, poly))
    return [tuple(part) for part in parts.values()]


def _content(polys: Sequence[PolyElement], *, exact: bool) -> PolyElement:
    """A common factor of polynomials, with the sign that leaves them positive where they are all negative."""
    first = polys[0]
    if all(poly in (first, -first) for poly in polys):
        common = first
    elif exact and sum(map(len, polys)) <= LONGEST and all(map(_has_factors, polys)):
        common = reduce(lambda a, b: a.gcd(b), polys)
        common = first.ring.one if common.is_ground else common.monic()
    else:
        common = _monomial(polys)
    # -(a + b) rather than (-a - b), with one sign outside.
    negative = all(poly.LC < 0 for poly in polys)
    return -common if negative == (common.LC > 0) else common


def _monomial(polys: Sequence[PolyElement]) -> PolyElement:
    """The largest monomial that divides all polynomials."""
    ring = polys[0].ring
    lowest = tuple(map(min, zip(*(monomial for poly in polys for monomial in poly), strict=True)))
    return ring.term_new(lowest, ring.domain.one)


def _has_factors(poly: PolyElement) -> bool:
    """Whether every monomial has symbols and none has roots: numbers have no factors worth the search."""
    plain = [symbol.is_Symbol for symbol in poly.ring.symbols]
    return all(any(m) and all(p or not power for p, power in zip(plain, m, strict=True)) for m in poly)


def _exquo(poly: PolyElement, divisor: PolyElement) -> PolyElement:
    return poly if divisor == 1 else poly.exquo(divisor)


def _factored(poly: PolyElement) -> sp.Expr:
    """A polynomial in factors, as far as they are found quickly."""
    monomial = _monomial([poly])
    rest = poly.exquo(monomial)
    plain = sp.Mul(_expanded(monomial), _expanded(rest))
    roots = [i for i, symbol in enumerate(poly.ring.symbols) if not symbol.is_Symbol]
    if len(rest) < 2 or len(rest) > LONGEST or any(m[i] for m in rest for i in roots) or _is_fine(rest):
        return plain
    if max(map(sum, rest)) < 2:
        return plain
    factor, parts = rest.factor_list()
    if len(parts) == 1 and parts[0][1] == 1:
        return plain
    return sp.Mul(_coefficient(factor), _expanded(monomial), *(_expanded(part) ** power for part, power in parts))


def _is_fine(poly: PolyElement) -> bool:
    return any(c.denominator > FINE for c in poly.values())


def _expanded(poly: PolyElement) -> sp.Expr:
    symbols = poly.ring.symbols
    return sp.Add(
        *(
            sp.Mul(_coefficient(c), *(s**e for s, e in zip(symbols, monomial, strict=True) if e))
            for monomial, c in poly.items()
        )
    )


def _coefficient(value: Any) -> sp.Expr:
    exact = sp.Rational(int(value.numerator), int(value.denominator))
    return exact if exact.q <= FINE else exact.n(17)
