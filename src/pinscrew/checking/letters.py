"""Letters of a student's own for the robot's lengths: the one assignment that fits, if there is one."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from itertools import permutations
from typing import Final

import sympy as sp

from pinscrew.checking.scope import NoValueError, Quotient, Scope
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.trig import Element
from pinscrew.mathtext import Node, symbols

__all__ = ["assignment", "letters_meant"]

MOST: Final = 400
"""Assignments that are tried."""


def assignment(
    letters: Sequence[str], lengths: Sequence[str], fit: Callable[[Mapping[str, str]], tuple[int, int]]
) -> dict[str, str]:
    """Which length each letter stands for, where one assignment fits better than any other; else nothing.

    Args:
        letters: names in an answer that the robot has not.
        lengths: names that the robot has, and the answer has not.
        fit: of the entries with such letters in them, how many are right with an assignment, and how many there are.
    """
    if not letters or len(letters) > len(lengths):
        return {}
    best: list[tuple[int, dict[str, str]]] = []
    for count, chosen in enumerate(permutations(lengths, len(letters))):
        if count == MOST:
            return {}
        meant = dict(zip(letters, chosen, strict=True))
        right, of = fit(meant)
        if right and 2 * right >= of:  # a letter that is in wrong entries alone might be anything
            best.append((right, meant))
    best.sort(key=lambda each: -each[0])
    if not best or (len(best) > 1 and best[0][0] == best[1][0]):
        return {}
    return best[0][1]


_NO_LENGTH: Final = re.compile(
    r"[csCS]_?\{?[\d+-]+\}?|(?:d*dot ?|d{1,2})?(?:theta|vartheta|th|q|t)_?.*|[csCS]|sin|cos|e|i|j"
)
"""Names that people give to something else than lengths."""


def _family(name: str) -> str:
    return re.sub(r"[\d_{}]", "", name)


def letters_meant(
    nodes: Mapping[tuple[int, int], Node],
    known: Mapping[str, Element],
    defined: set[str],
    due: list[list[Quotient]],
    derivation: Derivation,
    scope: Scope,
) -> dict[str, sp.Symbol]:
    """The lengths that letters of a student's own stand for, where one assignment fits.

    Args:
        nodes: the entries by row and column, from 1.
        known: what names stand for that are known.
        defined: names that the answer defines.
        due: the right values.
        derivation: the closed forms, with the lengths.
        scope: the algebra of the values.
    """
    named = {place: symbols(node) for place, node in nodes.items()}
    used = {name for names in named.values() for name in names}
    letters = sorted(used - set(known) - defined)
    if not letters or any(_NO_LENGTH.fullmatch(letter) for letter in letters):
        return {}
    if {_family(letter) for letter in letters} & {_family(str(length)) for length in derivation.lengths}:
        return {}  # L_9 beside the robot's L0: it may as well be a wrong index
    taken = {str(known[name].terms) for name in used & set(known)}
    lengths = {str(length): length for length in derivation.lengths if str(scope.symbol(length).terms) not in taken}
    concerned = [place for place, names in named.items() if names & set(letters)]

    def fit(meant: Mapping[str, str]) -> tuple[int, int]:
        with_letters = {**known, **{letter: scope.symbol(lengths[length]) for letter, length in meant.items()}}
        right = 0
        for i, j in concerned:
            try:
                right += scope.value(nodes[i, j], with_letters) == due[i - 1][j - 1]
            except NoValueError:
                continue
        return right, len(concerned)

    found = assignment(letters, list(lengths), fit)
    scope.refill()
    return {letter: lengths[length] for letter, length in found.items()}
