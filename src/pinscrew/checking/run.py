"""`check`: from an answer to its verdict."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pinscrew.checking.edits import edits, symbol_names
from pinscrew.checking.meanings import Meanings, given
from pinscrew.checking.quantities import quantity_key, right_form
from pinscrew.checking.scope import NoValueError, Quotient, Scope
from pinscrew.checking.slips import slips
from pinscrew.checking.texts import Assigned, Written, written
from pinscrew.checking.verdict import AnswerVerdict
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.run import derive
from pinscrew.derivation.trig import Element
from pinscrew.ground.errors import InputError, UnsupportedError
from pinscrew.mathtext import Node, Operation, Symbol, read_latex, read_plain, symbols
from pinscrew.robot.loading import RobotLike

__all__ = ["check", "checkable", "definitions", "graded", "listed"]


def check(robot: RobotLike, quantity: str, answer: Any, *, tip: str | None = None) -> AnswerVerdict:
    """Whether an answer is right, and if not, where and why.

    Both are brought to one normal form, in which two formulas are equal only if they are the same: an answer is right
    however it is written. What can't be read is said to be unread, and never wrong. Nothing is run.

    Args:
        robot: a robot, or a name or path that `load` takes.
        quantity: what was asked for: ``"M"``, ``"xi1"``, ``"T"``, ``"Js"``, ``"Jb"``, ``"Jh"``, ``"Vb"``, …; twists
            and rows of Jacobians are (v, ω), in m and rad, in the base frame.
        answer: LaTeX, Python or MATLAB; or an array, a matrix of sympy's, a list of lists.
        tip: the frame; by default the robot's tip.

    Raises:
        InputError: there is no such quantity, the answer is no matrix that can be read, or of another shape.
        UnsupportedError: joints follow others, or see `derive`.
    """
    derivation = checkable(robot, tip)
    matrix, defined = _answer(answer)
    return graded(derivation, quantity_key(quantity, len(derivation.chain.joints)), matrix, defined)


def checkable(robot: RobotLike, tip: str | None = None) -> Derivation:
    """The closed forms that answers are held against.

    Raises:
        UnsupportedError: joints follow others, or see `derive`.
    """
    derivation = derive(robot, tip)
    if derivation.follows:
        what = "joints that follow others move the frame: their answers are not checked"
        file = derivation.robot.description.file
        raise UnsupportedError("check-mimic", what, file=file, remedy="name a tip that none of them moves")
    return derivation


def _answer(answer: Any) -> tuple[Written, dict[str, Node]]:
    """The last matrix of an answer, or its last formula where there is none, and what was given names before."""
    if not isinstance(answer, str):
        return listed(answer), {}
    assigned = written(answer)
    if not assigned:
        raise InputError("formula", "the answer is empty", remedy="give a matrix in LaTeX, Python or MATLAB")
    wanted = [each for each in assigned if each.listed] or list(assigned)
    return wanted[-1].matrix, definitions(assigned[: assigned.index(wanted[-1])])


def definitions(assigned: tuple[Assigned, ...]) -> dict[str, Node]:
    """Formulas that have names; one that can't be read is nothing that has a value, and no more."""
    found: dict[str, Node] = {}
    for each in assigned:
        if each.listed or not each.name:
            continue
        try:
            name = read_latex(each.name) if each.matrix.language == "latex" else Symbol(each.name)
            if isinstance(name, Symbol):
                found[name.name] = Symbol("?")
                found[name.name] = _read(each.matrix.rows[0][0], each.matrix)
        except InputError:
            continue
    return found


def listed(answer: Any) -> Written:
    """An array, a matrix of sympy's or a list of lists as it would be written.

    Raises:
        InputError: it is none, or its rows differ in length.
    """
    rows = answer.tolist() if hasattr(answer, "tolist") else answer
    if not isinstance(rows, (list, tuple)) or not rows:
        raise InputError("formula", f"an answer is a text or a matrix, not {type(answer).__name__}")
    rows = [list(row) if isinstance(row, (list, tuple)) else [row] for row in rows]
    if len({len(row) for row in rows}) != 1 or not rows[0]:
        raise InputError("formula", "the rows of the matrix differ in length, or there are none")
    return Written(tuple(tuple(str(x) for x in row) for row in rows), "plain")


def _shaped(matrix: Written, shape: tuple[int, ...], key: str) -> Written:
    """The matrix in the shape of the right one, where only a vector's direction differs."""
    rows = matrix.rows
    if matrix.vector and shape[1] == 1:
        rows = tuple((cell,) for row in rows for cell in row)
    elif matrix.vector and shape[0] == 1:
        rows = (tuple(cell for row in rows for cell in row),)
    if (len(rows), len(rows[0])) != shape:
        what = f"{key} has {shape[0]} rows and {shape[1]} columns, the answer {len(rows)} and {len(rows[0])}"
        raise InputError("shape", what)
    return Written(rows, matrix.language, matrix.factor)


def _read(cell: str, matrix: Written) -> Node:
    if matrix.language == "latex":
        node = read_latex(cell)
        return Operation("multiply", (read_latex(matrix.factor), node)) if matrix.factor not in ("", "+") else node
    return read_plain(cell, _arrays(cell), side_by_side=matrix.language == "plain")


def _arrays(cell: str) -> set[str]:
    """Names that stand with an index in a cell."""
    return {name for name in ("q", "theta", "th", "qd", "dq") if f"{name}[" in cell or f"{name}(" in cell}


def graded(derivation: Derivation, key: str, matrix: Written, defined: Mapping[str, Node]) -> AnswerVerdict:
    """The verdict on a matrix.

    Args:
        derivation: the closed forms; see `checkable`.
        key: the quantity; see `quantity_key`.
        matrix: the answer as it is written.
        defined: formulas that it gives names to, in order.

    Raises:
        InputError: it has another shape than the quantity.
    """
    scope, meanings = Scope(derivation), Meanings(derivation)
    right = right_form(derivation, key)
    matrix = _shaped(matrix, right.shape, key)
    due = [[Quotient(scope.adopt(element), scope.one) for element in row] for row in right]
    nodes: dict[tuple[int, int], Node] = {}
    unread: dict[tuple[int, int], str] = {}
    for i, row in enumerate(matrix.rows, 1):
        for j, cell in enumerate(row, 1):
            try:
                nodes[i, j] = _read("-(" + cell + ")" if matrix.factor == "-" else cell, _unsigned(matrix))
            except InputError as error:
                unread[i, j] = str(error)
    names = {name for node in (*nodes.values(), *defined.values()) for name in symbols(node)}
    known = given(names, meanings, scope, defined)
    values: dict[tuple[int, int], Quotient] = {}
    for place, node in nodes.items():
        try:
            values[place] = scope.value(node, known)
        except NoValueError as error:
            unread[place] = str(error)
    wrong = tuple(place for place, value in values.items() if value != due[place[0] - 1][place[1] - 1])
    found: tuple[str, ...] = ()
    if wrong and not unread:
        both = range(1, right.shape[0] + 1), range(1, right.shape[1] + 1)
        names = set(symbol_names(derivation))
        known |= given(names - set(known), meanings, scope, {})

        def explain(i: int, j: int) -> str:
            words = _one_change(scope, nodes[i + 1, j + 1], due[i][j], known, symbol_names(derivation))
            return words or _copied(values[i + 1, j + 1], due)

        found = slips(derivation, scope, key, [[values[i, j] for j in both[1]] for i in both[0]], due, explain)
    expected = derivation.write(right)
    return AnswerVerdict(
        robot=derivation.robot.name,
        quantity=key,
        entries=wrong,
        unread=tuple(sorted(unread.items())),
        slips=found,
        given=matrix.rows,
        expected=tuple(tuple(str(x) for x in row) for row in expected.tolist()),
    )


def _one_change(scope: Scope, node: Node, due: Quotient, known: Mapping[str, Element], names: tuple[str, ...]) -> str:
    """The first change of a formula that makes it right, in words."""
    for words, changed in edits(node, names):
        try:
            if scope.value(changed, known) == due:
                return words
        except NoValueError:
            continue
    return ""


def _copied(value: Quotient, due: list[list[Quotient]]) -> str:
    """Which other entry's right form stands there; nothing of 0, which is everywhere."""
    for i, row in enumerate(due, 1):
        for j, other in enumerate(row, 1):
            if value.over and value == other:
                return f"what is due at ({i}, {j}) stands here"
    return ""


def _unsigned(matrix: Written) -> Written:
    return Written(matrix.rows, matrix.language) if matrix.factor == "-" else matrix
