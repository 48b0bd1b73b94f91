"""`check_file`: every quantity that a file of answers has is graded."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from numpy.typing import ArrayLike

from pinscrew.checking.blockwise import put_together
from pinscrew.checking.carried import follows_from
from pinscrew.checking.grading import Graded, graded
from pinscrew.checking.meanings import Meanings
from pinscrew.checking.names import quantity_in_heading, quantity_named
from pinscrew.checking.passages import Passage, passages
from pinscrew.checking.run import checkable, definitions, listed, verdict_on
from pinscrew.checking.scope import Scope
from pinscrew.checking.sheet import AnswerSheet, Refused
from pinscrew.checking.texts import Assigned, Written, written
from pinscrew.checking.verdict import AnswerVerdict
from pinscrew.derivation.chain import Elements
from pinscrew.derivation.derivation import Derivation
from pinscrew.description import markup
from pinscrew.ground.errors import InputError
from pinscrew.mathtext import Node, symbols
from pinscrew.robot.loading import RobotLike

__all__ = ["BLANK", "check_file"]

BLANK: Final = "?"
"""What stands in a worksheet where an entry is to be written."""
_EMPTY: Final = re.compile(r"\?|\.\.\.|…|_+|\\(?:square|Box|dots|ldots|cdots)|\{\}|None|NaN|nan|\[\]")
MOST_ANSWERS: Final = 200


@dataclass(frozen=True, slots=True)
class _NamedMatrix:
    """A matrix, or why it is none: its name, where it stands, and what had names before it."""

    name: str
    passage: Passage
    matrix: Written | None
    reason: str
    before: Mapping[str, Node]


def check_file(
    robot: RobotLike,
    path: str | Path,
    *,
    q: ArrayLike | None = None,
    tip: str | None = None,
    reference: str | None = None,
) -> AnswerSheet:
    """Every quantity that a file of answers has, each held against its right form as `check` does.

    A matrix belongs to the quantity of its name, ``J^b = …`` or ``Jb = …``; one without a name to that of the heading
    above it, or of the function that returns it. Formulas that get names, ``c1 = cos(q1)``, are known in the whole
    file. Nothing is run.

    Args:
        robot: a robot, or a name or path that `load` takes.
        path: Markdown, LaTeX, Python, MATLAB, a notebook or JSON, by its suffix.
        q: the configuration (nq,) at which the answers are in numbers; without it they are in symbols.
        tip: the frame; by default the robot's tip.
        reference: the frame 0 that the answers are in; by default the base.

    Raises:
        DescriptionError: the file is not there, can't be read, or is not UTF-8.
        InputError: files of its kind are not read, or it is no JSON or too long.
        UnsupportedError: see `check`.
    """
    path = Path(path)
    derivation = checkable(robot, tip, reference)
    stands = passages(markup.read(path), path.suffix.lower())
    joints = len(derivation.chain.joints)
    found, later = _found(stands, derivation)
    scope, earlier = Scope(derivation), dict[str, Elements]()
    verdicts: list[tuple[AnswerVerdict, int]] = []
    refused: list[Refused] = []
    blank: dict[str, None] = {}
    passed: list[str] = []
    for each, key in _with_keys(found, joints):
        if key is None:
            passed.append(each.name)
            continue
        if each.matrix is not None and all(_EMPTY.fullmatch(cell) for row in each.matrix.rows for cell in row):
            blank[key] = None
            continue
        if len(verdicts) + len(refused) == MOST_ANSWERS:
            raise InputError("check-file", f"there are more than {MOST_ANSWERS} answers", where=str(path))
        try:
            if each.matrix is None:
                raise InputError("formula", each.reason)
            defined = {**later, **each.before}
            if q is None:
                verdict = _following(derivation, graded(derivation, key, each.matrix, defined, scope=scope), earlier)
            else:
                verdict = verdict_on(derivation, key, each.matrix, defined, q)
            verdicts.append((verdict, each.passage.line))
        except InputError as error:
            refused.append(Refused(key, each.passage.line, str(error)))
    answered = {verdict.quantity for verdict, _ in verdicts}
    return AnswerSheet(
        robot=derivation.robot.name,
        file=path.name,
        verdicts=tuple(verdicts),
        # A product of matrices is a step on the way to what stands below it.
        refused=tuple(each for each in refused if each.quantity not in answered),
        blank=tuple(key for key in blank if key not in answered),
        passed=tuple(passed),
    )


def _following(derivation: Derivation, answer: Graded, earlier: dict[str, Elements]) -> AnswerVerdict:
    """The verdict, with the earlier wrong answers that a wrong one follows from; a wrong one is an earlier one then."""
    verdict, given = answer.verdict, answer.elements
    if verdict.right is not False or given is None:
        return verdict
    follows = follows_from(derivation, answer.scope, verdict.quantity, given, earlier) if earlier else ()
    earlier[verdict.quantity] = given
    return replace(verdict, follows=follows, slips=()) if follows else verdict


def _found(stands: list[Passage], derivation: Derivation) -> tuple[list[_NamedMatrix], dict[str, Node]]:
    """The matrices of a file in order, and all that has a name in it."""
    scope, meanings = Scope(derivation), Meanings(derivation)
    named: dict[str, Node] = {}
    matrices: dict[str, Written] = {}
    found: list[_NamedMatrix] = []
    for passage in stands:
        if passage.value is not None and not isinstance(passage.value, str):
            try:
                found.append(_NamedMatrix(passage.heading, passage, listed(passage.value), "", {}))
            except InputError as error:
                found.append(_NamedMatrix(passage.heading, passage, None, str(error), {}))
            continue
        try:
            assigned = written(passage.text)
        except InputError as error:
            if name := _left_side(passage.text):
                found.append(_NamedMatrix(name, passage, None, str(error), {}))
            continue
        for each in assigned:
            if each.listed:
                matrix = put_together(each.matrix, matrices)
                matrices[each.name] = matrix
                found.append(_NamedMatrix(each.name, passage, matrix, "", dict(named)))
            else:
                named |= _definition(each, meanings, scope)
    return found, named


def _definition(each: Assigned, meanings: Meanings, scope: Scope) -> dict[str, Node]:
    """What one formula gives a name to: nothing where a joint or length is set to a number for a while."""
    return {
        name: node for name, node in definitions((each,)).items() if symbols(node) or meanings.find(name, scope) is None
    }


def _left_side(text: str) -> str:
    left, equals, _ = text.partition("=")
    return left.strip().strip("&").strip() if equals else ""


def _with_keys(found: list[_NamedMatrix], joints: int) -> Iterator[tuple[_NamedMatrix, str | None]]:
    """Each matrix with the quantity that it is an answer to; of several without a name below a heading, the last."""
    last = {each.passage.heading: i for i, each in enumerate(found) if not each.name}
    for i, each in enumerate(found):
        if each.name:
            yield each, quantity_named(each.name, joints)
        elif last[each.passage.heading] == i:
            key = quantity_in_heading(each.passage.heading, joints)
            if key is not None:
                yield each, key
