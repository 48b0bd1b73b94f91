"""One change of a formula: a sign, a function, a symbol, a factor or a term, the simplest first."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain
from typing import Final, TypeAlias

from pinscrew.derivation.derivation import Derivation
from pinscrew.mathtext import Node, Number, Operation, Symbol, symbols

__all__ = ["edits", "symbol_names"]

MOST: Final = 1500
"""Changes of one formula that are tried."""

_Change: TypeAlias = tuple[str, Node]


def symbol_names(derivation: Derivation) -> tuple[str, ...]:
    """Names of symbols in formulas about a robot: cosines and sines of sums of angles, values, rates, lengths."""
    found: list[str] = []
    for group in derivation.chain.algebra.angles:
        labels = [variable.label for variable in derivation.variables if variable.symbol in group]
        for i in range(len(labels)):
            for j in range(i, len(labels)):
                if all(label.isdigit() and len(label) == 1 for label in labels):
                    found += [f"{letter}{''.join(labels[i : j + 1])}" for letter in "cs"]
    for variable in derivation.variables:
        found += [str(variable.symbol), str(variable.rate)]
    return (*found, *map(str, derivation.lengths))


def edits(node: Node, names: Sequence[str]) -> Iterator[_Change]:
    """What a formula becomes by one change, each with what was wrong in words.

    Args:
        node: the formula.
        names: of symbols that may stand in it instead, or as a further factor.
    """
    kinds = (
        _signs,
        _functions,
        lambda inner: _symbols(inner, names),
        _fewer,
        _numbers,
        lambda inner: _throughout(inner, names) if inner is node else iter(()),
        lambda inner: _further(inner, names),
    )
    changes = chain.from_iterable(_everywhere(node, kind) for kind in kinds)
    for _, change in zip(range(MOST), changes, strict=False):
        yield change


def _everywhere(node: Node, kind: Callable[[Node], Iterator[_Change]]) -> Iterator[_Change]:
    """The changes of one kind of a formula and of each formula in it."""
    yield from kind(node)
    if isinstance(node, Operation):
        for i, operand in enumerate(node.operands):
            for words, changed in _everywhere(operand, kind):
                yield words, replace(node, operands=(*node.operands[:i], changed, *node.operands[i + 1 :]))


def _signs(node: Node) -> Iterator[_Change]:
    if not (isinstance(node, Operation) and node.operator == "negate"):
        yield f"the sign of {_text(node)}", Operation("negate", (node,))


def _functions(node: Node) -> Iterator[_Change]:
    if isinstance(node, Operation) and node.operator in ("sin", "cos"):
        other: Node = Operation("cos" if node.operator == "sin" else "sin", node.operands)
        yield f"{_text(node)} for {_text(other)}", other


def _symbols(node: Node, names: Sequence[str]) -> Iterator[_Change]:
    if isinstance(node, (Symbol, Number)):
        mine = _text(node)
        for name in names:
            if name != mine.replace("_", ""):
                yield f"{mine} for {name}", Symbol(name)


def _throughout(node: Node, names: Sequence[str]) -> Iterator[_Change]:
    """One symbol for another, or one index for another, wherever it stands."""
    mine = sorted(symbols(node))
    for old in mine:
        for new in names:
            if new != old.replace("_", ""):
                yield f"{old} for {new} throughout", _renamed(node, {old: new})
    indices = sorted({digit for name in mine for digit in name if digit.isdigit()})
    for i in indices:
        for j in sorted({digit for name in names for digit in name if digit.isdigit()} - {i}):
            changed = {name: name.replace(i, j) for name in mine}
            yield f"the index {i} for {j} throughout", _renamed(node, changed)
    dotted = {name: name.replace("dd", "d", 1) for name in mine if name.startswith("dd")}
    if dotted:
        yield "a dot too many", _renamed(node, dotted)


def _renamed(node: Node, names: Mapping[str, str]) -> Node:
    if isinstance(node, Symbol):
        return Symbol(names.get(node.name, node.name))
    if isinstance(node, Operation):
        return replace(node, operands=tuple(_renamed(operand, names) for operand in node.operands))
    return node


def _numbers(node: Node) -> Iterator[_Change]:
    if isinstance(node, (Symbol, Number)):
        for value in (0.0, 1.0, -1.0):
            if node != Number(value):
                yield f"{_text(node)} for {value:g}", Number(value)


def _fewer(node: Node) -> Iterator[_Change]:
    if isinstance(node, Operation) and node.operator in ("add", "multiply"):
        what = "term" if node.operator == "add" else "factor"
        for i, operand in enumerate(node.operands):
            rest = (*node.operands[:i], *node.operands[i + 1 :])
            left = rest[0] if len(rest) == 1 else replace(node, operands=rest)
            yield f"the {what} {_text(operand)} is too many", left


def _further(node: Node, names: Sequence[str]) -> Iterator[_Change]:
    if not (isinstance(node, Operation) and node.operator == "negate"):
        for name in names:
            yield f"the factor {name} of {_text(node)} is missing", Operation("multiply", (node, Symbol(name)))
        for name in names:
            yield f"a term {name} beside {_text(node)} is missing", Operation("add", (node, Symbol(name)))
            negative: Node = Operation("negate", (Symbol(name),))
            yield f"a term -{name} beside {_text(node)} is missing", Operation("add", (node, negative))


_PRIORITY: Final = {"add": 0, "negate": 1, "multiply": 2, "divide": 2, "power": 3}


def _text(node: Node, outside: int = 0) -> str:
    """The formula in a line, as one would type it."""
    if isinstance(node, Number):
        return f"{node.value:g}"
    if isinstance(node, Symbol):
        return node.name
    own = _PRIORITY.get(node.operator, 4)
    parts = [_text(operand, own + (i > 0 and own > 1)) for i, operand in enumerate(node.operands)]
    if node.operator == "add":
        written = " + ".join(parts).replace("+ -", "- ")
    elif node.operator == "negate":
        written = f"-{_text(node.operands[0], 2)}"
    elif own < 4:
        written = {"multiply": "*", "divide": "/", "power": "^"}[node.operator].join(parts)
    else:
        return f"{node.operator}({_text(node.operands[0])})"
    return f"({written})" if own < outside else written
