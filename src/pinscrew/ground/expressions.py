"""Arithmetic as people write it, such as ``pi/4``, ``45deg`` or ``0.3 - 0.1*(t - 5)``: parsed, never run as Python."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any, Final

from pinscrew.ground.errors import InputError

__all__ = ["Expression", "number"]

LONGEST: Final = 100
"""Characters of an expression."""

_OPERATORS: Final[dict[type[ast.operator], Callable[[Any, Any], Any]]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
}
_CONSTANTS: Final = {"pi": math.pi, "deg": math.pi / 180.0}
_UNIT: Final = re.compile(r"(?<=[0-9.)])\s*(deg|pi)\b")
_WRONG: Final = (SyntaxError, ValueError, ZeroDivisionError, OverflowError, RecursionError, MemoryError)


@dataclass(frozen=True, slots=True)
class Expression:
    """Numbers, ``pi``, ``deg`` and variables, with ``+ - * /`` and brackets.

    Attributes:
        text: as it was written.
        tree: its syntax.
    """

    text: str
    tree: ast.expr

    @classmethod
    def parse(cls, text: str, variables: Collection[str] = ()) -> Expression:
        """Read an expression of these variables.

        Raises:
            InputError: if it is none.
        """
        shown = text if len(text) <= LONGEST else f"{text[:LONGEST]}…"
        problem = InputError(
            "expression",
            f"{shown!r} is no arithmetic" + (f" of {', '.join(variables)}" if variables else ""),
            remedy="use numbers, pi, deg, brackets and + - * /",
        )
        if len(text) > LONGEST:
            raise problem
        try:
            found = cls(text, ast.parse(_UNIT.sub(r"*\1", text.strip()), mode="eval").body)
            _check(found.tree, variables)
        except _WRONG:
            raise problem from None
        return found

    def value(self, variables: Mapping[str, Any] | None = None) -> Any:
        """The value where the variables, numbers or arrays, have these values; arrays broadcast.

        Raises:
            ArithmeticError: if numbers are divided by zero.
        """
        return _value(self.tree, variables or {})


def number(text: str) -> float:
    """The value of an expression without variables, such as ``-0.5``, ``pi/4``, ``45deg`` or ``2*(pi-1)``.

    Raises:
        InputError: if it is none, or not finite.
    """
    expression = Expression.parse(text)
    try:
        value = float(expression.value())
    except _WRONG:
        value = math.nan
    if not math.isfinite(value):
        raise InputError("expression", f"{text!r} is no finite number")
    return value


def _check(node: ast.expr, variables: Collection[str]) -> None:
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.UAdd, ast.USub)):
        _check(node.operand, variables)
    elif isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        _check(node.left, variables)
        _check(node.right, variables)
    elif isinstance(node, ast.Name):
        if node.id not in _CONSTANTS and node.id not in variables:
            raise ValueError(node.id)
    elif not _is_number(node):
        raise ValueError("not arithmetic")


def _is_number(node: ast.expr) -> bool:
    value = node.value if isinstance(node, ast.Constant) else None
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _value(node: ast.expr, variables: Mapping[str, Any]) -> Any:
    """The value of what `_check` let pass."""
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        return float(node.value)
    if isinstance(node, ast.Name):
        return variables[node.id] if node.id in variables else _CONSTANTS[node.id]
    if isinstance(node, ast.UnaryOp):
        value = _value(node.operand, variables)
        return -value if isinstance(node.op, ast.USub) else value
    if isinstance(node, ast.BinOp):
        return _OPERATORS[type(node.op)](_value(node.left, variables), _value(node.right, variables))
    raise TypeError(type(node).__name__)
