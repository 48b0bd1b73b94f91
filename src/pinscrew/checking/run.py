"""`check`: from an answer to its verdict."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from pinscrew.checking.blockwise import put_together
from pinscrew.checking.grading import graded, read_cell
from pinscrew.checking.numeric import graded_at
from pinscrew.checking.quantities import quantity_key
from pinscrew.checking.texts import Assigned, Written, written
from pinscrew.checking.verdict import AnswerVerdict
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.run import derive
from pinscrew.ground.errors import InputError, UnsupportedError
from pinscrew.mathtext import Node, Symbol, read_latex
from pinscrew.robot.loading import RobotLike

__all__ = ["check", "checkable", "definitions", "listed", "verdict_on"]


def check(
    robot: RobotLike,
    quantity: str,
    answer: Any,
    *,
    q: ArrayLike | None = None,
    tip: str | None = None,
    reference: str | None = None,
) -> AnswerVerdict:
    """Whether an answer is right, and if not, where and why.

    Both are brought to one normal form, in which two formulas are equal only if they are the same: an answer is right
    however it is written. What can't be read is said to be unread, and never wrong. Nothing is run.

    Args:
        robot: a robot, or a name or path that `load` takes.
        quantity: what was asked for: ``"M"``, ``"xi1"``, ``"T"``, ``"Js"``, ``"Jb"``, ``"Jh"``, ``"Vb"``, …; twists
            and rows of Jacobians are (v, ω), in m and rad.
        answer: LaTeX, Python or MATLAB; or an array, a matrix of sympy's, a list of lists.
        q: the configuration (nq,) at which the answer is in numbers; they may be rounded in the last of two or more
            decimals. Without it the answer is in symbols, and exact.
        tip: the frame; by default the robot's tip.
        reference: the frame 0 that the answer is in; by default the base.

    Raises:
        InputError: there is no such quantity, the answer is no matrix that can be read, or of another shape.
        UnsupportedError: joints follow others, or see `derive`.
    """
    derivation = checkable(robot, tip, reference)
    matrix, defined = _answer(answer)
    key = quantity_key(quantity, len(derivation.chain.joints))
    return verdict_on(derivation, key, matrix, defined, q)


def verdict_on(
    derivation: Derivation, key: str, matrix: Written, defined: Mapping[str, Node], q: ArrayLike | None
) -> AnswerVerdict:
    """The verdict on a matrix, in symbols or, at a configuration, in numbers; see `graded` and `graded_at`."""
    if q is None:
        return graded(derivation, key, matrix, defined).verdict
    return graded_at(derivation, key, matrix, defined, np.asarray(q, dtype=float))


def checkable(robot: RobotLike, tip: str | None = None, reference: str | None = None) -> Derivation:
    """The closed forms that answers are held against.

    Raises:
        UnsupportedError: joints follow others, or see `derive`.
    """
    derivation = derive(robot, tip, reference=reference)
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
    named = {each.name: each.matrix for each in wanted[:-1] if each.name}
    return put_together(wanted[-1].matrix, named), definitions(assigned[: assigned.index(wanted[-1])])


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
                found[name.name] = read_cell(each.matrix.rows[0][0], each.matrix)
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
