"""One matrix of numbers against its right form at a configuration."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import partial

import sympy as sp

from pinscrew.checking.edits import symbol_names
from pinscrew.checking.grading import Place, read_cells, shaped
from pinscrew.checking.meanings import Meanings, given
from pinscrew.checking.numbers import Near, at_configuration, last_digit, number
from pinscrew.checking.quantities import right_form
from pinscrew.checking.scope import Scope
from pinscrew.checking.slips import Asked, Values, slips
from pinscrew.checking.texts import Written
from pinscrew.checking.verdict import AnswerVerdict
from pinscrew.derivation.chain import Elements
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.trig import Element
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.mathtext import Node, evaluate, symbols

__all__ = ["graded_at"]


def graded_at(
    derivation: Derivation, key: str, matrix: Written, defined: Mapping[str, Node], q: FloatArray
) -> AnswerVerdict:
    """The verdict on a matrix of numbers, or of formulas in numbers.

    Args:
        derivation: the closed forms.
        key: the quantity.
        matrix: the answer as it is written; a number may be rounded in its last decimal, see `last_digit`.
        defined: formulas that it gives names to.
        q: the configuration, shape (nq,); rad and m.

    Raises:
        InputError: the answer or q has another shape, or the quantity has rates in it.
    """
    at = at_configuration(derivation, q)
    scope, meanings = Scope(derivation), Meanings(derivation)
    right = right_form(derivation, key)
    matrix = shaped(matrix, right.shape, key)
    nodes, unread = read_cells(matrix)

    def value(element: Element, numbers: Mapping[sp.Symbol, float] = at) -> Near:
        return Near(number(element, numbers, 2 if element.algebra is scope.algebra else 1))

    names = {name for node in (*nodes.values(), *defined.values()) for name in symbols(node)}
    known = {name: value(element).value for name, element in given(names, meanings, scope, {}).items()}
    for name, node in defined.items():
        try:
            known[name] = float(evaluate(node, known))
        except InputError:
            known.pop(name, None)
    values: dict[Place, Near] = {}
    for (i, j), node in nodes.items():
        try:
            values[i, j] = Near(float(evaluate(node, known)), last_digit(matrix.rows[i - 1][j - 1]))
        except InputError as error:
            unread[i, j] = str(error)
    question = Asked(derivation, key, scope, value)
    due = question.adopt(right)
    if key.startswith("q") and not unread:
        due = _nearest(question.adopt(right_form(derivation, f"omega{key[1:]}")), due, values)
    wrong = tuple(place for place, mine in values.items() if mine != due[place[0] - 1][place[1] - 1])
    found: tuple[str, ...] = ()
    if wrong and not unread:
        mine = [[values[i, j] for j in range(1, right.shape[1] + 1)] for i in range(1, right.shape[0] + 1)]
        found = tuple(_degrees(derivation, right, mine, at))[:1]
        names_of = symbol_names(derivation)
        symbols_known = given(set(names_of), meanings, scope, {})
        plain = {name: _worth(symbols_known.get(name), value) for name in names_of}
        found = found or slips(question, mine, due, partial(_explained, mine, due, plain))
    return AnswerVerdict(
        robot=derivation.robot.name,
        quantity=key,
        entries=wrong,
        unread=tuple(sorted(unread.items())),
        slips=found,
        given=matrix.rows,
        expected=tuple(tuple(f"{x.value + 0.0:.6g}" for x in row) for row in due),
    )


def _degrees(derivation: Derivation, right: Elements, mine: Values, at: Mapping[sp.Symbol, float]) -> Iterator[str]:
    """Sines and cosines of angles in the other unit."""
    angles = {angle for group in derivation.chain.algebra.angles for angle in group}
    for factor, words in (
        (math.pi / 180.0, "the angles are in radians, and were taken for degrees"),
        (180.0 / math.pi, "the angles were taken in degrees where sines and cosines want radians"),
    ):
        numbers = {symbol: x * factor if symbol in angles else x for symbol, x in at.items()}
        if [[Near(number(element, numbers)) for element in row] for row in right] == mine:
            yield words


def _worth(element: Element | None, value: Callable[[Element], Near]) -> Near:
    try:
        return Near(math.nan) if element is None else value(element)
    except InputError:  # a rate
        return Near(math.nan)


def _explained(mine: Values, due: Values, plain: Mapping[str, Near], i: int, j: int) -> str:
    """Which symbol's number stands there for which, or which other entry's."""
    of = [name for name, x in plain.items() if x == mine[i][j]]
    wanted = [name for name, x in plain.items() if x == due[i][j]]
    if of and wanted:
        return f"{of[0]} for {wanted[0]}"
    for k, row in enumerate(due):
        for m, other in enumerate(row):
            if other and abs(other.value) != 1.0 and other == mine[i][j]:
                return f"what is due at ({k + 1}, {m + 1}) stands here"
    return ""


def _nearest(direction: Values, due: Values, values: Mapping[Place, Near]) -> Values:
    """The point of an axis that is nearest to the one that is given, for any is right."""
    w = [row[0].value for row in direction]
    along = sum(x * (values[i, 1].value - due[i - 1][0].value) for i, x in enumerate(w, 1))
    return [[Near(row[0].value + x * along)] for x, row in zip(w, due, strict=True)]
