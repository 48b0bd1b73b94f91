"""Formulas as people type them and programs have them: ``L0 - s2*(L3 + theta3)``, ``math.cos(theta1)``, ``x.^2``.

Names are whole words; factors stand side by side only where that cannot be read in two ways. Nothing is run.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from typing import Final

from pinscrew.mathtext.tokens import CLOSING, DEEPEST, TokenReader
from pinscrew.mathtext.tree import Node, Number, Operation, Operator, Symbol

__all__ = ["read_plain"]

_TOKEN: Final = re.compile(
    r"\s+|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[^\W\d]\w*(?:\.[^\W\d]\w*)*|\*\*|\.[*/^]|.", re.DOTALL
)
_TIMES: Final = {"*", ".*"}
_OVER: Final = {"/", "./"}
_POWERS: Final = {"**", "^", ".^"}
_LIBRARIES: Final = {"math", "np", "numpy", "sp", "sympy"}
_FUNCTIONS: Final[dict[str, tuple[Operator, int]]] = {
    "cos": ("cos", 1),
    "sin": ("sin", 1),
    "tan": ("tan", 1),
    "sqrt": ("sqrt", 1),
    "pow": ("power", 2),
}
_PI: Final = 3.141592653589793


def read_plain(text: str, arrays: Collection[str] = (), *, side_by_side: bool = True) -> Node:
    """The formula that a text is.

    Args:
        text: numbers, names, pi, + - * / ** (or ^), parentheses, cos, sin, tan, sqrt, pow.
        arrays: names that are followed by an index: ``q[0]`` or ``q(1)`` is then one symbol of that name.
        side_by_side: whether ``2 x (y + 1)`` is a product; programs need a sign.

    Raises:
        InputError: the text is no such formula; the message has the place.
    """
    return _Reader(text, arrays, side_by_side=side_by_side).whole()


class _Reader(TokenReader):
    """Reads one text by descent, each rule a method."""

    def __init__(self, text: str, arrays: Collection[str], *, side_by_side: bool) -> None:
        super().__init__(text, _TOKEN)
        self._arrays = arrays
        self._side_by_side = side_by_side

    def whole(self) -> Node:
        node = self._sum()
        if self._token():
            self._refuse(f"{self._token()!r} is not expected")
        return node

    def _sum(self) -> Node:
        terms: list[Node] = []
        while not terms or self._token() in ("+", "-"):
            sign = self._next() if self._token() in ("+", "-") else "+"
            term = self._product()
            terms.append(Operation("negate", (term,)) if sign == "-" else term)
        return terms[0] if len(terms) == 1 else Operation("add", tuple(terms))

    def _product(self) -> Node:
        """Factors and divisors from the left, as every language has them."""
        factors = [self._power()]
        divisions = 0
        while True:
            if self._token() in _TIMES:
                self._at += 1
                factors.append(self._power())
            elif self._token() in _OVER:
                self._at += 1
                factors = [Operation("divide", (_product_of(factors), self._power()))]
                divisions += 1
                if divisions > DEEPEST:
                    self._refuse(f"more than {DEEPEST} divisions follow one another")
            elif not self._starts():
                return _product_of(factors)
            elif not self._side_by_side or re.match(r"[\d.]", self._token()):
                self._refuse("a sign is missing between two factors")
            elif divisions:
                self._refuse("what follows a quotient may stand above or below: use * or parentheses")
            else:
                factors.append(self._power())

    def _starts(self) -> bool:
        return self._token() == "(" or bool(re.match(r"\.?\d|[^\W\d]", self._token()))

    def _power(self) -> Node:
        base = self._unit()
        if self._token() not in _POWERS:
            return base
        self._at += 1
        negative = self._token() == "-"
        self._at += negative
        exponent = self._unit()
        if self._token() in _POWERS:
            self._refuse("a power of a power is read in two ways: use parentheses")
        return Operation("power", (base, Operation("negate", (exponent,)) if negative else exponent))

    def _unit(self) -> Node:
        ahead = self._token()
        if re.match(r"\.?\d", ahead):
            return Number(float(self._next()))
        if ahead == "(":
            return self._arguments()[0]
        if not re.match(r"[^\W\d]", ahead):
            self._refuse(f"{ahead!r} is not expected" if ahead else "something is missing")
        name = ahead.rpartition(".")[2] if ahead.partition(".")[0] in _LIBRARIES else ahead
        if name in _FUNCTIONS:
            return self._function(name)
        if "." in name:
            self._refuse(f"{ahead!r} is no name")
        self._at += 1
        if name in ("pi", "M_PI", "π"):
            return Number(_PI)
        return Symbol(name + (self._index() if name in self._arrays else ""))

    def _function(self, name: str) -> Node:
        operator, count = _FUNCTIONS[name]
        self._at += 1
        if self._token() != "(":
            self._refuse("a function's argument stands in parentheses")
        return Operation(operator, self._arguments(count))

    def _arguments(self, count: int = 1) -> tuple[Node, ...]:
        closing = CLOSING[self._next()]
        self._deeper()
        found = [self._sum()]
        while len(found) < count:
            self._expect(",")
            found.append(self._sum())
        self._expect(closing)
        self._depth -= 1
        return tuple(found)

    def _index(self) -> str:
        opening, index, closing = self._token(), self._token(1), self._token(2)
        if opening not in ("[", "(") or not index.isdecimal() or closing != CLOSING[opening]:
            self._refuse("an index is missing")
        self._at += 3
        return opening + index + closing


def _product_of(factors: list[Node]) -> Node:
    return factors[0] if len(factors) == 1 else Operation("multiply", tuple(factors))
