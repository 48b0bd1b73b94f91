r"""Formulas in LaTeX: sums, products without a sign between, fractions, roots, powers, cosines and sines, matrices.

A function takes what is in parentheses, a fraction or one symbol: ``\cos\theta_1 L`` is L cos θ1, and ``\cos 2 x`` is
refused, for it is read in two ways. What cannot be read is refused with its place, never guessed.
"""

from __future__ import annotations

import re
from typing import Final

from pinscrew.ground.errors import InputError
from pinscrew.mathtext.tokens import CLOSING, LONGEST, TokenReader
from pinscrew.mathtext.tree import Node, Number, Operation, Operator, Symbol

__all__ = ["read_latex", "read_latex_matrix"]

_TOKEN: Final = re.compile(r"\s+|\\[A-Za-z]+|\\.|\d+\.?\d*|\.\d+|.", re.DOTALL)
_SPACES: Final = {r"\,", r"\;", r"\:", r"\!", r"\ ", r"\quad", r"\qquad", r"\displaystyle"}
_SIZES: Final = {r"\left", r"\right", r"\big", r"\bigl", r"\bigr", r"\Big", r"\Bigl", r"\Bigr"}
_TIMES: Final = {r"\cdot", r"\times", "*"}
_GREEK: Final = {
    r"\alpha",
    r"\beta",
    r"\gamma",
    r"\delta",
    r"\ell",
    r"\theta",
    r"\vartheta",
    r"\phi",
    r"\varphi",
    r"\psi",
    r"\lambda",
    r"\mu",
    r"\omega",
    r"\rho",
}
_FUNCTIONS: Final[dict[str, Operator]] = {r"\cos": "cos", r"\sin": "sin", r"\tan": "tan"}
_FRACTIONS: Final = {r"\frac", r"\tfrac", r"\dfrac"}
_NAMES: Final = {r"\mathrm", r"\text", r"\operatorname", r"\mathit"}
_MATRIX: Final = re.compile(
    r"\s*\\begin\{([bpvBV]?matrix|smallmatrix)\}(?P<inside>(?:(?!\\begin).)*?)\\end\{\1\}\s*", re.DOTALL
)
_PI: Final = 3.141592653589793


def read_latex(text: str) -> Node:
    """The formula that a text is.

    Raises:
        InputError: the text is no formula that this reader knows; the message has the place.
    """
    return _Reader(text).whole()


def read_latex_matrix(text: str) -> tuple[tuple[Node, ...], ...]:
    """The entries of a matrix, by rows.

    Raises:
        InputError: the text is no matrix, its rows differ in length, or an entry cannot be read.
    """
    matrix = _MATRIX.fullmatch(text) if len(text) <= LONGEST else None
    if matrix is None:
        raise InputError("formula", "this is no matrix", remedy=r"write it as \begin{bmatrix} … \end{bmatrix}")
    lines = matrix["inside"].split(r"\\")
    if not lines[-1].strip():
        del lines[-1]
    place = matrix.start("inside")
    rows = []
    for line in lines:
        row = []
        for cell in line.split("&"):
            row.append(_Reader(cell, place).whole())
            place += len(cell) + 1
        rows.append(tuple(row))
        place += 1  # the ampersand that the last cell has not, and the two characters of the line's end
    if len({len(row) for row in rows}) != 1:
        raise InputError("formula", "the rows of the matrix differ in length, or there are none")
    return tuple(rows)


class _Reader(TokenReader):
    """Reads one text by descent, each rule a method."""

    def __init__(self, text: str, place: int = 0) -> None:
        super().__init__(text, _TOKEN, _SPACES | _SIZES, place)

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
        node = self._factors()
        if self._token() == "/":
            self._at += 1
            node = Operation("divide", (node, self._power()))
            if self._starts() or self._token() in _TIMES | {"/"}:
                self._refuse("what follows a quotient may stand above or below: use parentheses")
        return node

    def _factors(self) -> Node:
        factors = [self._power()]
        while self._token() in _TIMES or self._starts():
            if self._token() in _TIMES:
                self._at += 1
            elif re.match(r"[\d.]", self._token()):
                self._refuse("a number after a factor needs a sign between them")
            factors.append(self._power())
        return factors[0] if len(factors) == 1 else Operation("multiply", tuple(factors))

    def _starts(self) -> bool:
        token = self._token()
        known = _GREEK | set(_FUNCTIONS) | _NAMES | _FRACTIONS | {r"\sqrt", r"\dot", r"\ddot", r"\pi"}
        return token in known or token in CLOSING or bool(re.match(r"[A-Za-z\d.]", token))

    def _power(self) -> Node:
        base = self._unit()
        if self._token() != "^":
            return base
        self._at += 1
        return Operation("power", (base, self._argument()))

    def _argument(self) -> Node:
        """What stands in braces, or the one digit or letter there."""
        if self._token() == "{":
            return self._bracketed()
        if not re.fullmatch(r"[A-Za-z\d]|\\pi", self._token()):
            self._refuse("braces are missing")
        return self._unit()

    def _part(self) -> Node:
        r"""The argument of a fraction: of ``\frac12``, which is a half, TeX takes a digit each."""
        if re.fullmatch(r"\d{2,}", self._token()):
            digits, place = self._tokens[self._at]
            self._tokens[self._at] = (digits[1:], place + 1)
            return Number(float(digits[0]))
        return self._argument()

    def _bracketed(self) -> Node:
        closing = CLOSING[self._next()]
        self._deeper()
        node = self._sum()
        self._expect(closing)
        self._depth -= 1
        return node

    def _unit(self) -> Node:
        ahead = self._token()
        if re.match(r"\.?\d", ahead):
            return Number(float(self._next()))
        if ahead in CLOSING:
            return self._bracketed()
        if ahead in _FRACTIONS:
            self._at += 1
            return Operation("divide", (self._part(), self._part()))
        if ahead in (r"\sqrt", r"\pi"):
            return self._root_or_pi()
        return self._function() if ahead in _FUNCTIONS else self._symbol()

    def _root_or_pi(self) -> Node:
        if self._next() == r"\pi":
            return Number(_PI)
        if self._token() != "{":
            self._refuse("a root's argument stands in braces, without an index")
        return Operation("sqrt", (self._bracketed(),))

    def _function(self) -> Node:
        r"""``\cos`` of what is in parentheses, or of the one symbol or fraction after it; ``\cos^2 x`` is (cos x)²."""
        operator = _FUNCTIONS[self._next()]
        exponent: Node | None = None
        if self._token() == "^":
            self._at += 1
            exponent = self._argument()
            if not isinstance(exponent, Number):
                self._refuse("a function's power is a number")
        if self._token() in CLOSING:
            node: Node = Operation(operator, (self._bracketed(),))
        elif self._token() in _FRACTIONS:
            node = Operation(operator, (self._unit(),))
        else:
            node = Operation(operator, (self._symbol(),))
        if self._token() == "^":
            self._refuse("a power after a function may be of its argument: use parentheses")
        return node if exponent is None else Operation("power", (node, exponent))

    def _symbol(self) -> Symbol:
        ahead = self._token()
        if ahead in (r"\dot", r"\ddot"):
            self._at += 1
            braces = self._token() == "{"
            self._at += braces
            if self._token() in (r"\dot", r"\ddot"):
                self._refuse("two dots are not read: write \\ddot")
            inner = self._symbol()
            if braces:
                self._expect("}")
            return Symbol(f"{ahead[1:]} {inner.name}" + ("" if "_" in inner.name else self._index()))
        if ahead in _NAMES:
            self._at += 1
            name = self._raw()
        elif ahead in _GREEK or re.fullmatch(r"[A-Za-z]", ahead):
            name = self._next().lstrip("\\")
        else:
            self._refuse(f"{ahead!r} is not expected" if ahead else "something is missing")
        return Symbol(name + self._index())

    def _index(self) -> str:
        if self._token() != "_":
            return ""
        self._at += 1
        if self._token() == "{":
            return "_" + self._raw()
        if not re.fullmatch(r"[A-Za-z\d]", self._token()):
            self._refuse("an index of more than one character stands in braces")
        return "_" + self._next()

    def _raw(self) -> str:
        """The letters, digits and signs in braces, as they stand, names in them without braces of their own."""
        self._expect("{")
        name = ""
        while self._token() not in ("}", ""):
            if self._token() in _NAMES:
                self._at += 1
                self._deeper()
                name += self._raw()
                self._depth -= 1
                continue
            if not re.fullmatch(r"\\?_|\\?[A-Za-z]+|\d+|[,+-]", self._token()):
                self._refuse(f"{self._token()!r} is not expected in a name or an index")
            name += {r"\cdot": "*"}.get(self._token(), self._token().lstrip("\\"))
            self._at += 1
        self._expect("}")
        return name or self._refuse("a name or an index is empty")
