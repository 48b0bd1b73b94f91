"""What a formula is, once read: numbers, symbols and operations on them; and its value."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np

from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray

__all__ = ["Node", "Number", "Operation", "Symbol", "evaluate", "symbols"]

Operator: TypeAlias = Literal["add", "multiply", "negate", "divide", "power", "cos", "sin", "tan", "sqrt"]


@dataclass(frozen=True, slots=True)
class Number:
    """A number as it stands."""

    value: float


@dataclass(frozen=True, slots=True)
class Symbol:
    """A letter or name with its index: ``theta_1``, ``c_12``, ``L_0``; its rate is ``dot theta_1``."""

    name: str


@dataclass(frozen=True, slots=True)
class Operation:
    """An operation; sums and products have as many operands as they have terms and factors."""

    operator: Operator
    operands: tuple[Node, ...]


Node: TypeAlias = Number | Symbol | Operation

_FUNCTIONS: Final[dict[str, Callable[..., FloatArray]]] = {
    "negate": np.negative,
    "divide": np.divide,
    "power": np.power,
    "cos": np.cos,
    "sin": np.sin,
    "tan": np.tan,
    "sqrt": np.sqrt,
}


def symbols(node: Node) -> frozenset[str]:
    """The names of a formula's symbols."""
    if isinstance(node, Symbol):
        return frozenset({node.name})
    return frozenset().union(*map(symbols, node.operands)) if isinstance(node, Operation) else frozenset()


def evaluate(node: Node, values: Mapping[str, float | FloatArray]) -> FloatArray:
    """The value of a formula.

    Args:
        node: the formula.
        values: a number, or an array, for each of its symbols; arrays broadcast as numpy's do.

    Raises:
        InputError: a symbol has no value, or the formula has none there (a division by zero, say).
    """
    if missing := sorted(symbols(node) - set(values)):
        raise InputError("formula", f"{missing[0]!r} has no value", remedy="give one for each symbol")
    with np.errstate(all="ignore"):
        value = _value(node, values)
    if not np.isfinite(value).all():
        raise InputError("formula", "the formula has no finite value there")
    return value


def _value(node: Node, values: Mapping[str, float | FloatArray]) -> FloatArray:
    if isinstance(node, Number):
        return np.asarray(node.value, dtype=float)
    if isinstance(node, Symbol):
        return np.asarray(values[node.name], dtype=float)
    operands = [_value(operand, values) for operand in node.operands]
    if node.operator in ("add", "multiply"):
        combine = np.add if node.operator == "add" else np.multiply
        result = operands[0]
        for operand in operands[1:]:
            result = combine(result, operand)
        return result
    return np.asarray(_FUNCTIONS[node.operator](*operands))
