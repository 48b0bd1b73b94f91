"""The one change that makes a wrong entry right."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations_with_replacement
from typing import Final

from pinscrew.checking.edits import edits
from pinscrew.checking.meanings import Meanings, given
from pinscrew.checking.scope import NoValueError, Quotient, Scope
from pinscrew.derivation.trig import Element
from pinscrew.mathtext import Node

__all__ = ["Explainer"]

MOST_FACTORS: Final = 3
"""Of a term that is looked for where one is missing."""


class Explainer:
    """Finds the one change that makes a wrong entry right.

    Args:
        scope: the algebra of the values.
        names: of symbols that may stand in an entry; see `edits.symbol_names`.
        due: the right values.
        meanings: of the robot.
        known: what the symbols of the answer stand for.
    """

    def __init__(
        self,
        scope: Scope,
        names: tuple[str, ...],
        due: list[list[Quotient]],
        meanings: Meanings,
        known: Mapping[str, Element],
    ) -> None:
        self._scope, self._names, self._due = scope, names, due
        self._known = {**given(set(names) - set(known), meanings, scope, {}), **known}
        self._terms: dict[Element, str] | None = None

    def words(self, node: Node, value: Quotient, due: Quotient) -> str:
        """What is wrong with an entry, in words; or ``""``.

        Args:
            node: its formula.
            value: what it is worth.
            due: what is right.
        """
        if not value.over:
            return "0 stands there: it is left out"
        for words, changed in edits(node, self._names):
            try:
                if self._scope.value(changed, self._known) == due:
                    return words
            except NoValueError:
                continue
        return self._copied(value) or self._term(value, due)

    def _copied(self, value: Quotient) -> str:
        """Which other entry's right form stands there."""
        for i, row in enumerate(self._due, 1):
            for j, other in enumerate(row, 1):
                if other.over and value == other:
                    return f"what is due at ({i}, {j}) stands here"
                if other.over and value == -other:
                    return f"what is due at ({i}, {j}), negated, stands here"
        return ""

    def _term(self, value: Quotient, due: Quotient) -> str:
        """A term of a few factors that is missing, or too many."""
        if value.under is not self._scope.one or due.under is not self._scope.one:
            return ""
        if self._terms is None:
            self._terms = {}
            for count in range(1, MOST_FACTORS + 1):
                for chosen in combinations_with_replacement(self._names, count):
                    product = self._scope.one
                    for name in chosen:
                        product = product * self._known[name]
                    self._terms.setdefault(product, "*".join(chosen))
        difference = due.over - value.over
        if difference in self._terms:
            return f"a term {self._terms[difference]} is missing"
        if -difference in self._terms:
            return f"a term -{self._terms[-difference]} is missing"
        return ""
