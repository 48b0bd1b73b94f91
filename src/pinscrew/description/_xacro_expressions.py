"""Evaluating xacro's ``${…}`` and ``$(eval …)`` without running what a file says.

An expression is parsed, every node of its syntax tree is held against a whitelist, and attribute access and powers
are replaced by calls that look at their operands before they act. What is left is arithmetic, comparison,
conditionals, containers, and calls of the functions below.
"""

from __future__ import annotations

import ast
import contextlib
import math
import re
from collections import ChainMap
from collections.abc import Callable, Mapping
from typing import Any, Final

__all__ = ["FUNCTIONS", "ForbiddenError", "evaluate"]

LONGEST: Final = 10_000
"""Characters of an expression."""
LARGEST_POWER: Final = 4096
"""Bits of an integer power."""
MOST_DIGITS: Final = 400
"""Digits that a number is rounded to: for an integer, Python takes ten to the power of it."""
LONGEST_RANGE: Final = 100_000
"""Length of a ``range``, a product of sequences, or a repeated sequence."""

_NODES: Final = (
    ast.Expression,
    ast.Constant,
    ast.Name,
    ast.Load,
    ast.Store,
    ast.UnaryOp,
    ast.UAdd,
    ast.USub,
    ast.Not,
    ast.BinOp,
    ast.Add,
    ast.Sub,
    ast.Mult,
    ast.Div,
    ast.FloorDiv,
    ast.Mod,
    ast.Pow,
    ast.BoolOp,
    ast.And,
    ast.Or,
    ast.Compare,
    ast.cmpop,
    ast.IfExp,
    ast.Call,
    ast.keyword,
    ast.Attribute,
    ast.Subscript,
    ast.Slice,
    ast.Tuple,
    ast.List,
    ast.Set,
    ast.Dict,
    ast.ListComp,
    ast.SetComp,
    ast.DictComp,
    ast.GeneratorExp,
    ast.comprehension,
)


class ForbiddenError(Exception):
    """An expression goes beyond the whitelist."""


def _range(*arguments: int) -> range:
    found = range(*arguments)
    if len(found) > LONGEST_RANGE:
        raise ForbiddenError(f"range of more than {LONGEST_RANGE} numbers")
    return found


def _power(base: Any, exponent: Any) -> Any:
    if isinstance(base, int) and isinstance(exponent, int) and abs(base).bit_length() * abs(exponent) > LARGEST_POWER:
        raise ForbiddenError(f"power of more than {LARGEST_POWER} bits")
    if not all(isinstance(operand, (int, float)) for operand in (base, exponent)):
        raise ForbiddenError("power of what is no number")
    return base**exponent


def _product(a: Any, b: Any) -> Any:
    for sequence, times in ((a, b), (b, a)):
        if hasattr(sequence, "__len__") and isinstance(times, int) and len(sequence) * times > LONGEST_RANGE:
            raise ForbiddenError(f"sequence repeated to more than {LONGEST_RANGE} entries")
    for number in (a, b):
        if isinstance(number, int) and number.bit_length() > LARGEST_POWER:
            raise ForbiddenError(f"product of more than {LARGEST_POWER} bits")
    return a * b


def _modulo(a: Any, b: Any) -> Any:
    if isinstance(a, bytes):
        raise ForbiddenError("a format of bytes")
    if isinstance(a, str) and ("*" in a or re.search(r"\d{4}", a)):
        raise ForbiddenError("a format with a width of more than three digits")
    return a % b


def _round(number: Any, ndigits: Any = None) -> Any:
    if isinstance(ndigits, int) and abs(ndigits) > MOST_DIGITS:
        raise ForbiddenError(f"rounding to more than {MOST_DIGITS} digits")
    return round(number, ndigits)


FUNCTIONS: Final[Mapping[str, Any]] = {
    **{f.__name__: f for f in (list, dict, map, len, str, float, int, bool, min, max, sorted, abs, all, any)},
    **{f.__name__: f for f in (divmod, enumerate, filter, isinstance, ord, repr, reversed, set, sum, tuple, zip)},
    "range": _range,
    "round": _round,
    "True": True,
    "False": False,
}
"""The builtins that an expression may use."""

# Functions of `math` whose result can be made huge by a small argument.
_UNBOUNDED: Final = frozenset({"factorial", "comb", "perm", "lcm", "prod"})

MATH: Final[Mapping[str, Any]] = {
    name: value for name, value in vars(math).items() if not name.startswith("_") and name not in _UNBOUNDED
}
"""The math functions and constants that an expression may use."""


class _Guard(ast.NodeTransformer):
    """Refuses what is not on the whitelist, and puts a look at the operands before what may go wrong."""

    def generic_visit(self, node: ast.AST) -> ast.AST:
        if not isinstance(node, _NODES):
            raise ForbiddenError(f"{type(node).__name__} in an expression")
        return super().generic_visit(node)

    def visit_Name(self, node: ast.Name) -> ast.AST:
        if node.id.startswith("__"):
            raise ForbiddenError(f"the name {node.id}")
        return self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> ast.AST:
        if not isinstance(node.func, (ast.Name, ast.Attribute)):
            raise ForbiddenError("a call of what is not a named function")
        if any(isinstance(argument, ast.Starred) for argument in node.args) or not all(k.arg for k in node.keywords):
            raise ForbiddenError("an unpacked argument")
        return self.generic_visit(node)

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        if node.attr.startswith("_") or not isinstance(node.ctx, ast.Load):
            raise ForbiddenError(f"the attribute {node.attr}")
        value = self.visit(node.value)
        return _call("__attribute", node, value, ast.Constant(node.attr))

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        self.generic_visit(node)
        if isinstance(node.op, ast.Pow):
            return _call("__power", node, node.left, node.right)
        if isinstance(node.op, ast.Mult):
            return _call("__product", node, node.left, node.right)
        if isinstance(node.op, ast.Mod):
            return _call("__modulo", node, node.left, node.right)
        return node


def _call(name: str, at: ast.expr, *arguments: ast.expr) -> ast.expr:
    call = ast.Call(ast.Name(name, ast.Load()), list(arguments), [])
    return ast.fix_missing_locations(ast.copy_location(call, at))


def evaluate(expression: str, symbols: Any, attribute: Callable[[Any, str], Any]) -> Any:
    """The value of an expression.

    Args:
        expression: Python syntax.
        symbols: a mapping from names to values and functions, all of which the expression may use.
        attribute: what ``value.name`` means.

    Raises:
        ForbiddenError: if it goes beyond the whitelist.
        Exception: whatever its evaluation raises.
    """
    text = expression.strip()
    if len(text) > LONGEST:
        raise ForbiddenError(f"an expression of more than {LONGEST} characters")
    try:
        tree = _Guard().visit(ast.parse(text, mode="eval"))
        code = compile(tree, "<expression>", "eval")
    except (RecursionError, MemoryError):
        raise ForbiddenError("an expression nested too deeply") from None
    guards: dict[str, Any] = {
        "__builtins__": {},
        "__attribute": attribute,
        "__power": _power,
        "__product": _product,
        "__modulo": _modulo,
    }
    if any(isinstance(node, ast.comprehension) for node in ast.walk(tree)):
        # Names inside a comprehension are looked up among the globals only.
        for name in {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)} - guards.keys():
            with contextlib.suppress(KeyError, NameError):
                guards[name] = symbols[name]
    # The guards come first: a macro's parameter may be called as one of them.
    return eval(code, guards, ChainMap(guards, symbols))  # noqa: S307 (checked above, node by node)
