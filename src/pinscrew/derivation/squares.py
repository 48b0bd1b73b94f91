"""Sums of squares: det(AᵀA) as what can be seen to vanish, or not to."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

import sympy as sp

from pinscrew.derivation.chain import Elements

__all__ = ["blocks", "sum_of_squares"]


def sum_of_squares(minors: Sequence[sp.Expr], explicit: Mapping[sp.Symbol, sp.Expr]) -> tuple[list[sp.Expr], sp.Expr]:
    """The factors that all minors have, and the sum of the squares of what is left of them.

    A pair of squares a² c² + a² s² of one angle's cosine and sine is a².
    """
    common = [
        factor
        for factor in sp.Mul.make_args(minors[0])
        if factor.free_symbols and all(factor in sp.Mul.make_args(minor) for minor in minors)
    ]
    left = Counter(minor / sp.Mul(*common) for minor in minors)
    squares: Counter[sp.Expr] = Counter()
    for term, count in left.items():
        squares[_unsigned(term)] += count
    partner = {}
    for symbol, meaning in explicit.items():
        partner[symbol] = (isinstance(meaning, sp.cos), meaning.args[0])
    # Pairs until none is left: the sum of two squares may be half of another pair, as in
    # (a c1 c2)² + (a c1 s2)² + (a s1)² = (a c1)² + (a s1)² = a².
    again = True
    while again:
        again = False
        for term in list(squares):
            for other in list(squares):
                joined = _joined(term, other, partner)
                count = min(squares[term], squares[other])
                if joined is not None and count > 0:
                    squares[term] -= count
                    squares[other] -= count
                    squares[joined] += count
                    again = True
    return common, sp.Add(*(count * term**2 for term, count in squares.items()))


def _unsigned(term: sp.Expr) -> sp.Expr:
    """A product without its sign, which its square has not."""
    return sp.Mul(*(-f if f.could_extract_minus_sign() else f for f in sp.Mul.make_args(term)))


def blocks(matrix: Elements) -> list[tuple[list[int], list[int]]]:
    """Rows and columns of the blocks that a matrix falls into when both are put in order."""
    separate: list[tuple[list[int], list[int]]] = []
    for column in range(matrix.shape[1]):
        rows = {row for row in range(matrix.shape[0]) if matrix[row, column]}
        # Columns that share a row stand in one block; a column may join two blocks that were apart.
        touched = [block for block in separate if rows & set(block[0])]
        separate = [block for block in separate if block not in touched]
        columns = [column, *(k for _, those in touched for k in those)]
        separate.append((sorted(rows.union(*(those for those, _ in touched))), sorted(columns)))
    return separate


def _joined(term: sp.Expr, other: sp.Expr, partner: Mapping[sp.Symbol, tuple[bool, sp.Expr]]) -> sp.Expr | None:
    """``a`` for the terms a c and a s (or -a s) of one angle."""
    for factor in sp.Mul.make_args(term):
        cosine, angle = partner.get(factor, (False, None))
        if not cosine:
            continue
        for second in sp.Mul.make_args(other):
            if partner.get(second) == (False, angle) and term / factor in (other / second, -other / second):
                return term / factor
    return None
