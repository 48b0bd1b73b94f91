"""One matrix against its right form: its entries read, valued, compared, and what is wrong explained."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from pinscrew.checking.edits import symbol_names
from pinscrew.checking.explaining import Explainer
from pinscrew.checking.letters import letters_meant
from pinscrew.checking.meanings import Meanings, given
from pinscrew.checking.quantities import right_form
from pinscrew.checking.scope import NoValueError, Quotient, Scope
from pinscrew.checking.slips import Asked, slips
from pinscrew.checking.structure import structure
from pinscrew.checking.texts import Written
from pinscrew.checking.verdict import AnswerVerdict
from pinscrew.derivation.chain import Elements
from pinscrew.derivation.derivation import Derivation
from pinscrew.ground.errors import InputError
from pinscrew.mathtext import Node, Operation, read_latex, read_plain, symbols

__all__ = ["Graded", "Place", "graded", "graded_entry", "read_cell", "read_cells", "shaped"]

Place = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Graded:
    """A verdict, and what the answer is worth.

    Attributes:
        verdict: what is said.
        scope: the algebra of the values.
        values: the value of each entry by row and column, from 1; those that can't be read are not there.
    """

    verdict: AnswerVerdict
    scope: Scope
    values: Mapping[Place, Quotient]

    @property
    def elements(self) -> Elements | None:
        """The answer as elements of the scope's algebra; None where an entry is a quotient, or can't be read."""
        expected = self.verdict.expected
        return _elements(self.values, (len(expected), len(expected[0])), self.scope)


def shaped(matrix: Written, shape: tuple[int, ...], key: str) -> Written:
    """The matrix in the shape of the right one, where only a vector's direction differs.

    Raises:
        InputError: it has another shape.
    """
    rows = matrix.rows
    if matrix.vector and shape[1] == 1:
        rows = tuple((cell,) for row in rows for cell in row)
    elif matrix.vector and shape[0] == 1:
        rows = (tuple(cell for row in rows for cell in row),)
    if (len(rows), len(rows[0])) != shape:
        what = f"{key} has {shape[0]} rows and {shape[1]} columns, the answer {len(rows)} and {len(rows[0])}"
        raise InputError("shape", what)
    return Written(rows, matrix.language, matrix.factor)


def read_cell(cell: str, matrix: Written) -> Node:
    """The formula of a cell, with the factor that stands before its matrix.

    Raises:
        InputError: it can't be read.
    """
    if matrix.language == "latex":
        node = read_latex(cell)
        return Operation("multiply", (read_latex(matrix.factor), node)) if matrix.factor not in ("", "+") else node
    return read_plain(cell, _arrays(cell), side_by_side=matrix.language == "plain")


def read_cells(matrix: Written) -> tuple[dict[Place, Node], dict[Place, str]]:
    """The formulas of a matrix by row and column, from 1; and the reasons of those that can't be read."""
    nodes: dict[Place, Node] = {}
    unread: dict[Place, str] = {}
    for i, row in enumerate(matrix.rows, 1):
        for j, cell in enumerate(row, 1):
            try:
                nodes[i, j] = read_cell("-(" + cell + ")" if matrix.factor == "-" else cell, _unsigned(matrix))
            except InputError as error:
                unread[i, j] = str(error)
    return nodes, unread


def _arrays(cell: str) -> set[str]:
    """Names that stand with an index in a cell."""
    return {name for name in ("q", "theta", "th", "qd", "dq") if f"{name}[" in cell or f"{name}(" in cell}


def graded(
    derivation: Derivation,
    key: str,
    matrix: Written,
    defined: Mapping[str, Node],
    free: Iterable[str] = (),
    scope: Scope | None = None,
) -> Graded:
    """The verdict on a matrix.

    Args:
        derivation: the closed forms; see `checkable`.
        key: the quantity; see `quantity_key`.
        matrix: the answer as it is written.
        defined: formulas that it gives names to, in order.
        free: names that are letters of their own, and mean nothing that the robot has.
        scope: where values are worked out, if they are to be compared with others'.

    Raises:
        InputError: it has another shape than the quantity.
    """
    scope, meanings = scope or Scope(derivation, free), Meanings(derivation, free)
    scope.refill()
    right = right_form(derivation, key)
    matrix = shaped(matrix, right.shape, key)
    question = Asked(derivation, key, scope, lambda element: Quotient(scope.adopt(element), scope.one))
    due = question.adopt(right)
    nodes, unread = read_cells(matrix)
    names = {name for node in (*nodes.values(), *defined.values()) for name in symbols(node)}
    known = given(names, meanings, scope, defined)
    meant = letters_meant(nodes, known, set(defined), due, derivation, scope)
    known |= {letter: scope.symbol(length) for letter, length in meant.items()}
    values: dict[tuple[int, int], Quotient] = {}
    for place, node in nodes.items():
        try:
            values[place] = scope.value(node, known)
        except NoValueError as error:
            unread[place] = str(error)
    if key.startswith("q") and not unread:
        due = _nearest(right_form(derivation, f"omega{key[1:]}"), due, values, scope)
    wrong = tuple(place for place, value in values.items() if value != due[place[0] - 1][place[1] - 1])
    found: tuple[str, ...] = ()
    faults: tuple[str, ...] = ()
    if wrong and not unread:
        both = range(1, right.shape[0] + 1), range(1, right.shape[1] + 1)
        explainer = Explainer(scope, symbol_names(derivation), due, meanings, known)

        def explain(i: int, j: int) -> str:
            return explainer.words(nodes[i + 1, j + 1], values[i + 1, j + 1], due[i][j])

        answer = _elements(values, right.shape, scope)
        faults = structure(key, answer) if answer is not None else ()
        found = slips(question, [[values[i, j] for j in both[1]] for i in both[0]], due, explain)
    expected = derivation.write(right)
    verdict = AnswerVerdict(
        robot=derivation.robot.name,
        quantity=key,
        entries=wrong,
        unread=tuple(sorted(unread.items())),
        slips=found,
        given=matrix.rows,
        expected=tuple(tuple(str(x) for x in row) for row in expected.tolist()),
        structure=faults,
        meant=tuple((letter, str(length)) for letter, length in meant.items()),
    )
    return Graded(verdict, scope, values)


def _elements(values: Mapping[Place, Quotient], shape: tuple[int, ...], scope: Scope) -> Elements | None:
    """The values as elements; None where one is a quotient, or is not there."""
    places = [(i, j) for i in range(1, shape[0] + 1) for j in range(1, shape[1] + 1)]
    if any(place not in values or values[place].under is not scope.one for place in places):
        return None
    return np.array([values[place].over for place in places], dtype=object).reshape(shape)


def graded_entry(derivation: Derivation, node: Node, right: Node, free: Iterable[str] = ()) -> str | None:
    """What is wrong with one entry for itself: words, ``""`` where no one change explains it; None if it is right.

    Args:
        derivation: the closed forms.
        node: the entry.
        right: the right one.
        free: as for `graded`; those that stand in a sum of angles are angles.

    Raises:
        NoValueError: the right one has no value.
    """
    free = (*free, "?")
    scope, meanings = Scope(derivation, free), Meanings(derivation, free)
    known = given(set(symbols(node) | symbols(right)), meanings, scope, {})
    due = scope.value(right, known)
    try:
        value = scope.value(node, known)
    except NoValueError:  # √x² say: what is wrong may be this very part
        value = Quotient(scope.free("?"), scope.one)
    if value == due:
        return None
    if value == -due:
        return "the sign"
    return Explainer(scope, symbol_names(derivation), [[due]], meanings, known).words(node, value, due)


def _nearest(
    direction: Elements, due: list[list[Quotient]], values: Mapping[Place, Quotient], scope: Scope
) -> list[list[Quotient]]:
    """The point of an axis that is nearest to the one that is given: q + ω ωᵀ(x - q), for any point is right."""
    if any(value.under is not scope.one for value in values.values()):
        return due
    w = [scope.adopt(element) for element in direction[:, 0]]
    away = [values[i, 1].over - due[i - 1][0].over for i in (1, 2, 3)]
    along = w[0] * away[0] + w[1] * away[1] + w[2] * away[2]
    return [[Quotient(row[0].over + x * along, scope.one)] for x, row in zip(w, due, strict=True)]


def _unsigned(matrix: Written) -> Written:
    return Written(matrix.rows, matrix.language) if matrix.factor == "-" else matrix
