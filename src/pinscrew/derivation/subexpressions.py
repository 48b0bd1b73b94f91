"""Names for the long sums inside an entry that would not fit on a line."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Final

import sympy as sp

__all__ = ["Subexpressions"]

WIDEST: Final = 100
"""Rough width (characters) of an entry beyond which sums inside it get names."""
LONG: Final = 28
"""Rough width of a sum inside it that is worth a name."""


class Subexpressions:
    """Sums that have names of their own: k1, k2, … or another letter, where lengths are called so.

    In ``c1 (c2 (c3 (l1 + l2 c4) + l3 s4) + s2 …)`` the innermost sums get names first, each where it is longer than
    `LONG`, so that every line that is left is short, whatever the size of the whole. A sum that occurs twice, or
    with the opposite sign, has one name. What is named is not changed: put back, it gives the same expression.

    Attributes:
        meaning: what each name stands for; in it the names made before may occur.
    """

    def __init__(self, width: Callable[[sp.Expr], int], taken: Collection[str]) -> None:
        """Name sums by a letter that no symbol ``taken`` has; ``width`` tells about how wide a formula is."""
        self.meaning: dict[sp.Symbol, sp.Expr] = {}
        self._names: dict[sp.Expr, sp.Symbol] = {}
        self._width = width
        self._letter = next(x for x in "kuwhyz" if not any(name[1:].isdigit() and name[0] == x for name in taken))

    def shortened(self, expression: sp.Expr) -> sp.Expr:
        """The expression itself if it fits on a line, otherwise with names for its long sums."""
        if self._width(expression) <= WIDEST:
            return expression
        return expression.func(*map(self._named, expression.args))

    def _named(self, e: sp.Expr) -> sp.Expr:
        if self._width(e) <= LONG:
            return e
        e = e.func(*map(self._named, e.args))
        if not e.is_Add or self._width(e) <= LONG:
            return e
        if -e in self._names:
            return -self._names[-e]
        if e not in self._names:
            symbol = sp.Symbol(f"{self._letter}{len(self._names) + 1}", real=True)
            self._names[e], self.meaning[symbol] = symbol, e
        return self._names[e]
