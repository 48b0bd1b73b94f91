"""Which one slip explains a wrong answer: the simplest hypothesis that makes every entry right."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final, TypeAlias

from pinscrew.checking.alternatives import alternatives
from pinscrew.checking.quantities import right_form
from pinscrew.checking.scope import Scope
from pinscrew.derivation.chain import Elements
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.trig import Element

__all__ = ["Asked", "slips"]

Values: TypeAlias = list[list[Any]]
"""What can be compared and negated: quotients of elements, or numbers that are near enough."""
Explain: TypeAlias = Callable[[int, int], str]
"""What is wrong with the entry of a row and column, from 0, in words; or ``""``."""

_OTHERS: Final = {
    "Js": ("Jb", "Jh", "twists"),
    "Jb": ("Js", "Jh", "twists"),
    "Jh": ("Js", "Jb", "twists"),
    "Vs": ("Vb", "Vh"),
    "Vb": ("Vs", "Vh"),
    "Vh": ("Vs", "Vb"),
    "Vshat": ("Vbhat",),
    "Vbhat": ("Vshat",),
    "Ad": ("Adinv",),
    "Adinv": ("Ad",),
    "pdot": ("v(Vs)", "v(Vb)"),
    "T": ("Tinv", "M"),
    "Tinv": ("T",),
}
_SWAPPED: Final = (3, 4, 5, 0, 1, 2)


@dataclass(frozen=True, slots=True)
class Asked:
    """What was asked for.

    Attributes:
        derivation: the closed forms.
        key: the quantity.
        scope: where an angle can stand without its sine and cosine.
        value: what an element is worth where answers are compared.
    """

    derivation: Derivation
    key: str
    scope: Scope
    value: Callable[[Element], Any]

    def adopt(self, elements: Elements) -> Values:
        """What a matrix of elements is worth where answers are compared."""
        return [[self.value(element) for element in row] for row in elements]


def slips(question: Asked, given: Values, right: Values, explain: Explain) -> tuple[str, ...]:
    """In words, the slip that explains the whole answer; else one change in each entry that is wrong.

    Args:
        question: what was asked for.
        given: the values of the answer.
        right: the right ones, of the same shape.
        explain: finds the one change of an entry.
    """
    for words, hypothesis in _wholes(question, right):
        if hypothesis() == given:
            return (words,)
    places = [(i, j) for i, row in enumerate(given) for j, x in enumerate(row) if x != right[i][j]]
    of_one_joint = question.key.startswith(("xi", "exp"))
    found = _entries(given, right, places, explain) if len(places) == 1 and not of_one_joint else ()
    if found:
        return found
    for words, elements in alternatives(question.derivation, question.key, question.scope):
        if question.adopt(elements()) == given:
            return (words,)
    return _entries(given, right, places, explain)


def _entries(given: Values, right: Values, places: Sequence[tuple[int, int]], explain: Explain) -> tuple[str, ...]:
    """What is wrong with each of the entries, or nothing where one can't be explained."""
    found = []
    for i, j in places:
        if given[i][j] == -right[i][j]:
            found.append(f"the sign of entry ({i + 1}, {j + 1})")
        elif words := explain(i, j):
            found.append(f"entry ({i + 1}, {j + 1}): {words}")
        else:
            return ()
    return tuple(found)


def _wholes(question: Asked, right: Values) -> Iterator[tuple[str, Callable[[], Values]]]:
    rows, columns, key = range(len(right)), range(len(right[0])), question.key
    yield f"every sign: this is -{key}", partial(_signs, right, rows, columns)
    for other in _OTHERS.get(key, ()):
        yield f"this is {other}, asked was {key}", partial(_other, question, other)
    if len(right) == 6:
        yield "the rows are (ω, v), asked was (v, ω)", partial(_picked, right, _SWAPPED)
        yield "v is negated: q × ω is right, not ω × q", partial(_signs, right, range(3), columns)
    if len(rows) > 1 and len(rows) == len(columns):
        yield "it is transposed", partial(_transposed, right)
    if len(rows) > 1 and len(columns) > 1:
        for i in rows:
            yield f"the sign of row {i + 1}", partial(_signs, right, range(i, i + 1), columns)
        for j in columns:
            yield f"the sign of column {j + 1}", partial(_signs, right, rows, range(j, j + 1))


def _signs(right: Values, rows: range, columns: range) -> Values:
    """The right form with the signs in some rows and columns changed."""
    return [[-x if i in rows and j in columns else x for j, x in enumerate(row)] for i, row in enumerate(right)]


def _picked(right: Values, order: Sequence[int]) -> Values:
    return [right[i] for i in order]


def _transposed(right: Values) -> Values:
    return [list(column) for column in zip(*right, strict=True)]


def _other(question: Asked, key: str) -> Values:
    return question.adopt(right_form(question.derivation, key))
