"""What a person types, as an expression of sympy: ``L0 - s2*(L3 + theta3)``. It is parsed, never run as Python."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from typing import Any, Final

import sympy as sp

from pinscrew.derivation.exact import bounded
from pinscrew.ground.errors import InputError

__all__ = ["expression", "matrix"]

LONGEST: Final = 10_000
"""Characters of a text."""
HIGHEST: Final = 20
"""The largest power."""

_FUNCTIONS: Final = {"cos": sp.cos, "sin": sp.sin, "sqrt": sp.sqrt}
_WRONG: Final = (SyntaxError, ValueError, ZeroDivisionError, OverflowError, RecursionError, MemoryError)


def expression(text: str, symbols: Mapping[str, sp.Symbol]) -> sp.Expr:
    """The expression that a text is: numbers, ``symbols``, pi, cos, sin, sqrt, with + - * / ** (or ^) and brackets.

    Decimals are exact: 0.1 is 1/10.

    Raises:
        InputError: if it is none, or has a symbol that is not among ``symbols``.
    """
    try:
        if len(text) > LONGEST:
            raise ValueError(f"longer than {LONGEST} characters")
        return _read(ast.parse(text.strip().replace("^", "**"), mode="eval").body, text, symbols)
    except InputError:
        raise
    except _WRONG as error:
        raise _refused(text, f"is no expression: {error}") from None


def matrix(value: Any, symbols: Mapping[str, sp.Symbol]) -> sp.Matrix:
    """A matrix of what a person has: a matrix, a list of lists, one expression; each entry a text, a number or sympy's.

    Raises:
        InputError: if an entry is no expression.
    """
    if isinstance(value, str) or not (hasattr(value, "shape") or isinstance(value, (list, tuple))):
        value = [[value]]
    rows = value.tolist() if hasattr(value, "tolist") else list(value)
    listed = [list(row) if isinstance(row, (list, tuple)) else [row] for row in rows]
    if len({len(row) for row in listed}) > 1:
        raise InputError("formula", "the rows of the matrix differ in length")
    return sp.Matrix(
        [[expression(x, symbols) if isinstance(x, str) else sp.sympify(x, strict=True) for x in row] for row in listed]
    )


def _read(node: ast.expr, text: str, symbols: Mapping[str, sp.Symbol]) -> sp.Expr:  # noqa: PLR0911 (one for each kind)
    match node:
        case ast.Constant(value=True | False as value):
            raise _refused(text, f"has {value} in it")
        case ast.Constant(value=int() | float()):
            return sp.Rational(bounded(ast.get_source_segment(text.strip().replace("^", "**"), node) or "0"))
        case ast.Name(id="pi"):
            return sp.pi
        case ast.Name(id=name):
            if name not in symbols:
                raise _refused(text, f"has {name!r} in it, which is no symbol of the closed forms", ", ".join(symbols))
            return symbols[name]
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_read(operand, text, symbols)
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return _read(operand, text, symbols)
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](_read(argument, text, symbols))
        case ast.BinOp(left=left, op=operator, right=right):
            return _combined(operator, _read(left, text, symbols), _read(right, text, symbols), text)
    raise _refused(text, "has something else in it than numbers, symbols, + - * / ** and brackets")


def _combined(operator: ast.operator, a: sp.Expr, b: sp.Expr, text: str) -> sp.Expr:
    if isinstance(operator, ast.Add):
        return a + b
    if isinstance(operator, ast.Sub):
        return a - b
    if isinstance(operator, ast.Mult):
        return a * b
    if isinstance(operator, ast.Div):
        if b == 0:
            raise ZeroDivisionError("division by zero")
        return a / b
    if isinstance(operator, ast.Pow) and b.is_Integer and abs(b) <= HIGHEST:
        return a ** int(b)
    raise _refused(text, f"has an operation or a power in it that is not read; powers are whole, up to {HIGHEST}")


def _refused(text: str, reason: str, known: str = "") -> InputError:
    remedy = f"the symbols are: {known}" if known else "write it like L0 - s2*(L3 + theta3)"
    return InputError("formula", f"{text[:60]!r} {reason}", remedy=remedy)
