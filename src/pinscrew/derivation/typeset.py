"""Expressions as LaTeX in a textbook's order: lengths before sines and cosines, those in the order of the joints."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, Final

import sympy as sp

from pinscrew.derivation.forms import ClosedForms
from pinscrew.derivation.subexpressions import Subexpressions

__all__ = ["Typesetter", "escape"]

_INDEXED: Final = re.compile(r"([A-Za-z])_?(\d+)")
_FRACTION: Final = 12
"""Largest denominator that is set as a fraction; other finite decimals are set as such."""
_DECIMALS: Final = 9
_ADD, _PRODUCT, _UNIT = 0, 1, 2
WIDEST: Final = 150
"""Rough width (characters) of a matrix beyond which its entries are listed one by one."""
LONGEST_CELL: Final = 12
"""Rough width of an entry that is not listed by itself."""


def escape(text: str) -> str:
    """Plain text for LaTeX."""
    special = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
    return "".join(special.get(c, "\\" + c if c in "_%&#{}$" else c) for c in text)


class Typesetter:
    """Sets the expressions of one derivation."""

    def __init__(self, derivation: ClosedForms) -> None:
        self._d = derivation
        self._symbols: dict[sp.Symbol, str] = {}
        self._rank: dict[sp.Symbol, int] = {symbol: i for i, symbol in enumerate(derivation.lengths)}
        for i, variable in enumerate(derivation.variables):
            self._symbols[variable.symbol], self._symbols[variable.rate] = variable.latex
            self._rank[variable.symbol] = 50 + i
        self.used: set[sp.Symbol] = set()
        self._rates = {variable.rate: i for i, variable in enumerate(derivation.variables)}
        self._texts: dict[sp.Expr, tuple[str, int]] = {}
        self._sums = Subexpressions(self._width, [str(s) for s in self._rank])
        self._shown = 0

    def symbol(self, symbol: sp.Symbol) -> str:
        """A symbol, which is noted in `used`."""
        self.used.add(symbol)
        found = self._symbols.get(symbol) or self._d.atoms.latex.get(symbol)
        if found is None:
            name = str(symbol)
            indexed = _INDEXED.fullmatch(name)
            found = f"{indexed[1]}_{{{indexed[2]}}}" if indexed else name
            found = found if indexed or len(name) == 1 else rf"\mathrm{{{escape(name)}}}"
            self._symbols[symbol] = found
        return found

    def __call__(self, expression: Any) -> str:
        """An expression."""
        return self._set(sp.sympify(expression))[0]

    def _set(self, e: sp.Expr) -> tuple[str, int]:
        """The LaTeX of an expression, and how it binds."""
        if e.is_Add or e.is_Mul:
            if e not in self._texts:
                self._texts[e] = self._compound(e)
            return self._texts[e]
        return self._compound(e)

    def _compound(self, e: sp.Expr) -> tuple[str, int]:  # noqa: PLR0911 (one for each kind of expression)
        if e.is_Add and _content(e) != 1:
            return self._product(e)
        if e.is_Add:
            return self._sum(e), _ADD
        if e.is_Mul or (e.is_Pow and e.exp.is_Rational and e.exp < 0) or (e.is_Rational and e < 0):
            return self._product(e)
        if e.is_Number:
            return _number(e), _UNIT
        if e is sp.pi:
            return r"\pi", _UNIT
        if e.is_Symbol:
            return self.symbol(e), _UNIT
        if e.is_Pow and e.exp == sp.Rational(1, 2):
            return rf"\sqrt{{{self(e.base)}}}", _UNIT
        if e.is_Pow:
            base, binds = self._set(e.base)
            base = base if binds == _UNIT and not e.base.is_Pow else _bracketed(base)
            return f"{base}^{{{self(e.exp)}}}", _UNIT
        if isinstance(e, (sp.cos, sp.sin)):
            argument, binds = self._set(e.args[0])
            single = e.args[0].is_Symbol or (binds == _UNIT and argument.startswith(r"\frac"))
            return rf"\{e.func.__name__} " + (argument if single else _bracketed(argument)), _UNIT
        return str(sp.latex(e)), _PRODUCT

    def _sum(self, e: sp.Expr) -> str:
        terms = sorted(e.args, key=self._term_key)
        shown = [self._set(term) for term in terms]
        texts = [_bracketed(text) if binds == _ADD else text for text, binds in shown]
        first = next((i for i, text in enumerate(texts) if not text.startswith("-")), 0)
        texts.insert(0, texts.pop(first))  # a sum does not begin with a minus where it need not
        return "".join(texts[:1] + [f" - {text[1:]}" if text.startswith("-") else f" + {text}" for text in texts[1:]])

    def _term_key(self, e: sp.Expr) -> tuple[Any, ...]:
        symbols = self._within(e)
        atoms = sorted(self._d.atoms.order[s] for s in symbols if s in self._d.atoms.order)
        lengths = sorted(self._rank.get(s, 40) for s in symbols if s not in self._d.atoms.order)
        return bool(atoms), atoms, lengths, str(e)

    def _within(self, e: sp.Expr) -> set[sp.Symbol]:
        """The symbols of an expression, for the name of a sum those of the sum."""
        symbols: set[sp.Symbol] = set()
        for symbol in e.free_symbols:
            symbols |= self._within(self._sums.meaning[symbol]) if symbol in self._sums.meaning else {symbol}
        return symbols

    def _product(self, e: sp.Expr) -> tuple[str, int]:
        r"""A product: one sign, one number, the factors, and what divides them.

        Signs and numbers are taken out of sums first, as `sympy` multiplies them in: -N_1 (-a/1000 - b/1000) is
        0.001 N_1 (a + b). A sum that is a factor always stands in parentheses.
        """
        number, above, below = _split(e)
        sign, number = ("-", -number) if number.is_negative else ("", number)
        factors, divisor = sp.Mul(*above), sp.Mul(*below)
        plain = factors.is_Symbol or not factors.free_symbols
        if divisor != 1 or (number.q != 1 and not _decimal(number) and plain):
            whole = number.p if not _decimal(number) else number
            under = self._factors(below, number.q if not _decimal(number) else 1)
            return rf"{sign}\frac{{{self._factors(above, whole)}}}{{{under}}}", _PRODUCT if sign else _UNIT
        joined = self._factors(above, number, signed=bool(sign))
        return sign + joined, _PRODUCT if sign or len(above) + (number != 1) > 1 else _UNIT

    def _factors(self, factors: Sequence[sp.Expr], number: Any, *, signed: bool = False) -> str:
        """A number, which is not written if it is 1, and factors in a textbook's order, perhaps after a minus."""
        number = sp.sympify(number)
        shown = [] if number == 1 and factors else [_number(number)]
        alone = len(factors) + len(shown) == 1 and not signed
        for factor in sorted(factors, key=self._factor_key):
            text, binds = self._set(factor)
            shown.append(text if alone or (binds != _ADD and not text.startswith("-")) else _bracketed(text))
        return " ".join(shown)

    def _factor_key(self, e: sp.Expr) -> tuple[Any, ...]:
        base = e.base if e.is_Pow else e
        if e.is_number:
            return (0, (), str(e)) if e.is_Rational else (1, (), str(e))
        if base in self._d.atoms.order:
            return 4, self._d.atoms.order[base], ""
        if base in self._rates:
            return 6, (self._rates[base],), ""
        if base.is_Symbol and base not in self._sums.meaning:
            return 2, (self._rank.get(base, 40),), str(base)
        rates = any(s in self._rates for s in self._within(e))
        atoms = any(s in self._d.atoms.order for s in self._within(e))
        return (7 if rates else 5 if atoms else 3), (len(e.args),), str(e)

    def matrix(self, matrix: Any) -> str:
        """A matrix in brackets."""
        rows = (" & ".join(self(x) for x in matrix.row(i)) for i in range(matrix.rows))
        return r"\begin{bmatrix} " + r" \\ ".join(rows) + r" \end{bmatrix}"

    def is_wide(self, matrix: Any) -> bool:
        """Whether a matrix is too wide for a page."""
        widths = [max(len(_plain(self(x))) for x in matrix.col(j)) for j in range(matrix.cols)]
        return sum(widths) > WIDEST

    def _width(self, expression: sp.Expr) -> int:
        """About how many characters are seen of a formula."""
        return len(_plain(self(expression)))

    def entries(self, name: str, matrix: Any) -> tuple[str, list[tuple[str, str]], list[tuple[str, str]]]:
        """A wide matrix with placeholders for its long entries, these entries, and the sums that have names in them.

        Both lists are of left and right sides. Of the sums there are those that no list had before.
        """
        rows, listed = [], []
        for i in range(matrix.rows):
            cells = []
            for j in range(matrix.cols):
                if self._width(matrix[i, j]) > LONGEST_CELL:
                    cells.append(f"{name}_{{{i + 1}{j + 1}}}")
                    listed.append((cells[-1], self(self._sums.shortened(matrix[i, j]))))
                else:
                    cells.append(self(matrix[i, j]))
            rows.append(" & ".join(cells))
        new = list(self._sums.meaning.items())[self._shown :]
        self._shown += len(new)
        sums = [(self(symbol), self(meaning)) for symbol, meaning in new]
        return r"\begin{bmatrix} " + r" \\ ".join(rows) + r" \end{bmatrix}", listed, sums


def _bracketed(text: str) -> str:
    """A sum in parentheses, which are no taller than they must be."""
    return rf"\left({text}\right)" if "(" in text or "frac" in text else f"({text})"


def _plain(latex: str) -> str:
    """About what is seen of a formula."""
    return re.sub(r"\\(left|right|,|dot|theta|mathrm|tfrac|frac|sqrt|cdot)|[{}_ ]", "", latex)


def _content(total: sp.Expr) -> sp.Rational:
    """The number that all terms of a sum have in common but for signs; negative where all terms are, otherwise 1."""
    numbers = [term.as_coeff_Mul()[0] for term in total.args]
    negative = all(map(_negative, total.args))
    first = abs(numbers[0])
    shared = first if first.is_Rational and all(abs(x) == first for x in numbers) else sp.Integer(1)
    return -shared if negative else shared


def _split(e: sp.Expr) -> tuple[sp.Rational, list[sp.Expr], list[sp.Expr]]:
    """A product as a rational number, factors without one, and what divides them."""
    number: sp.Rational = sp.Integer(1)
    above: list[sp.Expr] = []
    below: list[sp.Expr] = []
    for factor in sp.Mul.make_args(e):
        if factor.is_Rational:
            number *= factor
        elif factor.is_Mul:
            inner, over, under = _split(factor)
            number, above, below = number * inner, above + over, below + under
        elif factor.is_Add and _content(factor) != 1:
            content = _content(factor)
            number *= content
            above.append(sp.Add(*(term / content for term in factor.args)))
        elif factor.is_Pow and factor.exp.is_Rational and factor.exp < 0:
            below.append(1 / factor)
        elif factor.is_Float and factor < 0:
            number, above = -number, [*above, -factor]
        else:
            above.append(factor)
    return number, above, below


def _negative(e: sp.Expr) -> bool:
    coefficient = e.as_coeff_Mul()[0]
    if coefficient.is_number and coefficient.is_negative:
        return True
    return bool(e.is_Add and all(_negative(term) for term in e.args))


def _decimal(number: sp.Expr) -> bool:
    """Whether a rational is better read as a decimal."""
    q = int(number.q)
    return q > _FRACTION and 10**_DECIMALS % q == 0


def _number(number: sp.Expr) -> str:
    if number.is_Integer:
        return str(number)
    if number.is_Rational:
        if _decimal(number):
            return f"{float(number):.{_DECIMALS}f}".rstrip("0")
        return rf"\tfrac{{{number.p}}}{{{number.q}}}"
    value = f"{float(number):.6g}"
    mantissa, _, exponent = value.partition("e")
    return rf"{mantissa} \cdot 10^{{{int(exponent)}}}" if exponent else value
