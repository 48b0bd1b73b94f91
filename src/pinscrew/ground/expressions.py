"""Arithmetic as people write it, such as ``pi/4``, ``45deg``, ``2cm`` or ``0.3 - 0.1*(t - 5)``.

It is parsed, never run as Python, and its units are checked: angles are rad, lengths m, and a number without a unit is
either. So ``10deg`` is no length, ``2cm + 1deg`` is nothing, and ``pi/2 + 10deg`` an angle.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal, TypeAlias

from pinscrew.ground.errors import InputError

__all__ = ["Expression", "Unit", "check_unit", "number", "quantity"]

Unit: TypeAlias = Literal["rad", "m", ""]
"""What a number is of: an angle, a length, or neither."""

LONGEST: Final = 100
"""Characters of an expression."""

_OPERATORS: Final[dict[type[ast.operator], Callable[[Any, Any], Any]]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
}
_UNITS: Final[dict[str, Unit]] = {"rad": "rad", "deg": "rad", "m": "m", "cm": "m", "mm": "m"}
_CONSTANTS: Final = {"pi": math.pi, "rad": 1.0, "deg": math.pi / 180.0, "m": 1.0, "cm": 1e-2, "mm": 1e-3}
_SUFFIX: Final = re.compile(rf"(?<=[0-9.)])\s*({'|'.join(_CONSTANTS)})\b")
_NAMES: Final[dict[Unit, str]] = {"rad": "an angle", "m": "a length", "": "a number"}
EXAMPLES: Final[dict[Unit, str]] = {"rad": "0.1, pi/4 or 45deg", "m": "0.1, 2cm or 30mm", "": "0.1 or 1e5"}
"""What to write, by what is needed."""
_WRONG: Final = (SyntaxError, ValueError, ZeroDivisionError, OverflowError, RecursionError, MemoryError)


@dataclass(frozen=True, slots=True)
class Expression:
    """Numbers, ``pi``, units and variables, with ``+ - * /`` and brackets.

    Attributes:
        text: as it was written.
        tree: its syntax.
        unit: what its value is of; variables have no unit.
    """

    text: str
    tree: ast.expr
    unit: Unit = ""

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
            remedy="use numbers, pi, deg, rad, m, cm, mm, brackets and + - * /",
        )
        if len(text) > LONGEST:
            raise problem
        try:
            tree = ast.parse(_SUFFIX.sub(r"*\1", text.strip()), mode="eval").body
            _check(tree, variables)
        except _WRONG:
            raise problem from None
        return cls(text, tree, _unit(tree, variables, text))

    def value(self, variables: Mapping[str, Any] | None = None) -> Any:
        """The value where the variables, numbers or arrays, have these values; arrays broadcast.

        Raises:
            ArithmeticError: if numbers are divided by zero.
        """
        return _value(self.tree, variables or {})


def quantity(text: str) -> tuple[float, Unit]:
    """The value of an expression without variables, in rad or m, and what it is of.

    Raises:
        InputError: if it is none, its units do not fit together, or it is not finite.
    """
    expression = Expression.parse(text)
    try:
        value = float(expression.value())
    except _WRONG:
        value = math.nan
    if not math.isfinite(value):
        raise InputError("expression", f"{text!r} is no finite number")
    return value, expression.unit


def number(text: str, unit: Unit = "") -> float:
    """The value of an expression without variables, such as ``-0.5``, ``pi/4``, ``45deg`` or ``2*(pi-1)``.

    Args:
        text: what was written.
        unit: what is needed; a number without a unit is rad or m then.

    Raises:
        InputError: if it is none, not finite, or of another unit.
    """
    value, of = quantity(text)
    check_unit(text, of, unit)
    return value


def check_unit(text: str, of: Unit, needed: Unit) -> None:
    """Refuse what is of another unit than is needed; a number without a unit fits all.

    Raises:
        InputError: if the units differ.
    """
    if of not in ("", needed):
        what = f"{text.strip()!r} is {_NAMES[of]}, where {_NAMES[needed]} is needed"
        raise InputError("unit", what, remedy=f"write such as {EXAMPLES[needed]}")


def _unit(node: ast.expr, variables: Collection[str], text: str) -> Unit:
    """What the value of what `_check` let pass is of."""
    if isinstance(node, ast.Name):
        return "" if node.id in variables else _UNITS.get(node.id, "")
    if isinstance(node, ast.UnaryOp):
        return _unit(node.operand, variables, text)
    if not isinstance(node, ast.BinOp):
        return ""
    a, b = _unit(node.left, variables, text), _unit(node.right, variables, text)
    if isinstance(node.op, (ast.Add, ast.Sub)) and (a == b or "" in (a, b)):
        return a or b
    if isinstance(node.op, ast.Mult) and "" in (a, b):
        return a or b
    if isinstance(node.op, ast.Div) and b in ("", a):
        return a if not b else ""
    verb = {ast.Add: "added to", ast.Sub: "subtracted from", ast.Mult: "multiplied by"}.get(type(node.op), "divided by")
    raise InputError("unit", f"in {text.strip()!r}, {_NAMES[a]} is {verb} {_NAMES[b]}", remedy="use one unit")


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
