"""Expressions as LaTeX in a textbook's order: lengths before sines and cosines, those in the order of the joints."""

from __future__ import annotations

import re
from typing import Any, Final

import sympy as sp

from pinscrew.derivation.forms import ClosedForms

__all__ = ["Typesetter", "escape"]

_INDEXED: Final = re.compile(r"([A-Za-z])_?(\d+)")
_FRACTION: Final = 12
"""Largest denominator that is set as a fraction; other finite decimals are set as such."""
_DECIMALS: Final = 9
_ADD, _PRODUCT, _UNIT = 0, 1, 2
WIDEST: Final = 150
"""Rough width (characters) of a matrix beyond which its entries are listed one by one."""


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
        self._rates = {variable.rate: i for i, variable in enumerate(derivation.variables)}

    def symbol(self, symbol: sp.Symbol) -> str:
        """A symbol."""
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

    def _set(self, e: sp.Expr) -> tuple[str, int]:  # noqa: PLR0911 (one for each kind of expression)
        """The LaTeX of an expression, and how it binds."""
        if e.is_Add:
            return self._sum(e), _PRODUCT if _negative(e) else _ADD
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
            argument = self(e.args[0])
            return rf"\{e.func.__name__} " + (_bracketed(argument) if e.args[0].is_Add else argument), _UNIT
        return str(sp.latex(e)), _PRODUCT

    def _sum(self, e: sp.Expr) -> str:
        terms = sorted(e.args, key=self._term_key)
        signs = [_negative(term) for term in terms]
        if all(signs):
            return f"-{_bracketed(self(-e))}"
        if signs[0]:
            first = signs.index(False)
            terms.insert(0, terms.pop(first))
        text = ""
        for i, term in enumerate(terms):
            shown = self(-term if _negative(term) else term)
            text += (" - " if i else "-") + shown if _negative(term) else (" + " if i else "") + shown
        return text

    def _term_key(self, e: sp.Expr) -> tuple[Any, ...]:
        atoms = sorted(self._d.atoms.order[s] for s in e.free_symbols if s in self._d.atoms.order)
        lengths = sorted(self._rank.get(s, 40) for s in e.free_symbols if s not in self._d.atoms.order)
        return bool(atoms), atoms, lengths, str(e)

    def _product(self, e: sp.Expr) -> tuple[str, int]:
        sign = "-" if _negative(e) else ""
        e = -e if sign else e
        if sign and e.is_Add:
            return f"-{_bracketed(self(e))}", _PRODUCT
        above, below = sp.fraction(e)
        if below != 1 and not (e.is_Rational and _decimal(e)):
            number = sp.Integer(1)
            if below.is_Rational:
                number, rest = above.as_coeff_Mul()
                number /= below
                if _decimal(number) or (rest.free_symbols and not rest.is_Symbol):
                    joined = self._factors(rest)
                    shown = _number(number) if _decimal(number) else rf"\tfrac{{{number.p}}}{{{number.q}}}"
                    return f"{sign}{shown} {joined}", _PRODUCT
            return rf"{sign}\frac{{{self(above)}}}{{{self(below)}}}", _UNIT if not sign else _PRODUCT
        return sign + self._factors(e), _PRODUCT if e.is_Mul or sign else _UNIT

    def _factors(self, e: sp.Expr) -> str:
        factors = sorted(sp.Mul.make_args(e), key=self._factor_key)
        shown = []
        for factor in factors:
            text, binds = self._set(factor)
            shown.append(_bracketed(text) if binds == _ADD and len(factors) > 1 else text)
        return " ".join(shown)

    def _factor_key(self, e: sp.Expr) -> tuple[Any, ...]:
        base = e.base if e.is_Pow else e
        if e.is_number:
            return (0, (), str(e)) if e.is_Rational else (1, (), str(e))
        if base in self._d.atoms.order:
            return 4, self._d.atoms.order[base], ""
        if base in self._rates:
            return 6, (self._rates[base],), ""
        if base.is_Symbol:
            return 2, (self._rank.get(base, 40),), str(base)
        rates = any(s in self._rates for s in e.free_symbols)
        atoms = any(s in self._d.atoms.order for s in e.free_symbols)
        return (7 if rates else 5 if atoms else 3), (len(e.args),), str(e)

    def matrix(self, matrix: Any) -> str:
        """A matrix in brackets."""
        rows = (" & ".join(self(x) for x in matrix.row(i)) for i in range(matrix.rows))
        return r"\begin{bmatrix} " + r" \\ ".join(rows) + r" \end{bmatrix}"

    def is_wide(self, matrix: Any) -> bool:
        """Whether a matrix is too wide for a page."""
        widths = [max(len(_plain(self(x))) for x in matrix.col(j)) for j in range(matrix.cols)]
        return sum(widths) > WIDEST

    def entries(self, name: str, matrix: Any) -> list[str]:
        """The entries that are not plain numbers one by one, and the matrix with placeholders for them."""
        rows, listed = [], []
        for i in range(matrix.rows):
            cells = []
            for j in range(matrix.cols):
                shown = self(matrix[i, j])
                if len(_plain(shown)) > 12:
                    cell = f"{name}_{{{i + 1}{j + 1}}}"
                    listed.append(f"{cell} = {shown}")
                    shown = cell
                cells.append(shown)
            rows.append(" & ".join(cells))
        return [r"\begin{bmatrix} " + r" \\ ".join(rows) + r" \end{bmatrix}", *listed]


def _bracketed(text: str) -> str:
    """A sum in parentheses, which are no taller than they must be."""
    return rf"\left({text}\right)" if "(" in text or "frac" in text else f"({text})"


def _plain(latex: str) -> str:
    """About what is seen of a formula."""
    return re.sub(r"\\(left|right|,|dot|theta|mathrm|tfrac|frac|sqrt|cdot)|[{}_ ]", "", latex)


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
