"""Which one slip explains a wrong answer: the simplest hypothesis that makes every entry right."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Final, TypeAlias

from pinscrew.checking.quantities import right_form
from pinscrew.checking.scope import Quotient, Scope
from pinscrew.derivation.derivation import Derivation

__all__ = ["slips"]

Values: TypeAlias = list[list[Quotient]]
Explain: TypeAlias = Callable[[int, int], str]
"""What is wrong with the entry of a row and column, from 0, in words; or ``""``."""

_OTHERS: Final = {
    "Js": ("Jb", "Jh"),
    "Jb": ("Js", "Jh"),
    "Jh": ("Js", "Jb"),
    "Vs": ("Vb", "Vh"),
    "Vb": ("Vs", "Vh"),
    "Vh": ("Vs", "Vb"),
    "T": ("Tinv", "M"),
    "Tinv": ("T",),
}
_SWAPPED: Final = (3, 4, 5, 0, 1, 2)


def slips(
    derivation: Derivation, scope: Scope, key: str, given: Values, right: Values, explain: Explain
) -> tuple[str, ...]:
    """In words, the slip that explains the whole answer; else one change in each entry that is wrong.

    Args:
        derivation: the closed forms.
        scope: the algebra of the values.
        key: the quantity.
        given: the values of the answer.
        right: the right ones, of the same shape.
        explain: finds the one change of an entry.
    """
    for words, hypothesis in _wholes(derivation, scope, key, right):
        if hypothesis() == given:
            return (words,)
    found, wrong = [], 0
    for i, (row, due) in enumerate(zip(given, right, strict=True), 1):
        for j, (mine, theirs) in enumerate(zip(row, due, strict=True), 1):
            if mine == theirs:
                continue
            wrong += 1
            if mine == _negated(theirs):
                found.append(f"the sign of entry ({i}, {j})")
            elif words := explain(i - 1, j - 1):
                found.append(f"entry ({i}, {j}): {words}")
    return tuple(found) if len(found) == wrong else ()


def _wholes(
    derivation: Derivation, scope: Scope, key: str, right: Values
) -> Iterator[tuple[str, Callable[[], Values]]]:
    rows, columns = range(len(right)), range(len(right[0]))
    yield f"every sign: this is -{key}", partial(_signs, right, rows, columns)
    for other in _OTHERS.get(key, ()):
        yield f"this is {other}, asked was {key}", partial(_other, derivation, scope, other)
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
    return [
        [_negated(x) if i in rows and j in columns else x for j, x in enumerate(row)] for i, row in enumerate(right)
    ]


def _picked(right: Values, order: Sequence[int]) -> Values:
    return [right[i] for i in order]


def _transposed(right: Values) -> Values:
    return [list(column) for column in zip(*right, strict=True)]


def _negated(value: Quotient) -> Quotient:
    return Quotient(-value.over, value.under)


def _other(derivation: Derivation, scope: Scope, key: str) -> Values:
    return [[Quotient(scope.adopt(element), scope.one) for element in row] for row in right_form(derivation, key)]
