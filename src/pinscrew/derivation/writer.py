"""What the sections of a report share: names, matrices, results, and how much of the way to them is shown."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, Literal, TypeAlias, get_args

import sympy as sp

from pinscrew.derivation.blocks import Block, Formula, Paragraph
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.notation import NOTATIONS
from pinscrew.derivation.typeset import Typesetter
from pinscrew.ground.errors import InputError

__all__ = ["DETAILS", "Detail", "Writer"]

Detail: TypeAlias = Literal["result", "steps", "full"]
DETAILS: Final[tuple[Detail, ...]] = get_args(Detail)
"""Results alone; with what they are products of; with every matrix on the way."""


class Writer:
    """What is needed to write about one derivation."""

    def __init__(self, derivation: Derivation, detail: Detail = "steps") -> None:
        """Write about ``derivation``.

        Raises:
            InputError: there is no such ``detail``.
        """
        if detail not in DETAILS:
            raise InputError("derive-option", f"detail={detail!r}", remedy=f"use one of {', '.join(DETAILS)}")
        self.d = derivation
        self.n = NOTATIONS[derivation.convention]
        self.set = Typesetter(derivation)
        self.values = [self.set(joint.variable.symbol) for joint in derivation.chain.joints]
        self.pose_name = self.n.pose.split("(", maxsplit=1)[0]
        self.numbers = range(1, len(self.values) + 1)
        self.small = not derivation.large
        self.steps, self.full = detail != "result", detail == "full"
        self.explained: set[sp.Symbol] = set()

    def short_forms(self) -> Iterable[Block]:
        """What the sines and cosines that were written since this was last asked for are short for, in order."""
        order = self.d.atoms.order
        new = sorted((self.set.used & order.keys()) - self.explained, key=order.__getitem__)
        self.explained.update(new)
        if new:
            shown = ", ".join(f"${self.set(symbol)} = {self._meaning(symbol)}$" for symbol in new)
            yield Paragraph(f"Sines and cosines are written in short: {shown}.")

    def _meaning(self, symbol: sp.Symbol) -> str:
        in_joints, in_coordinates = self.d.explicit(symbol), self.d.in_coordinates(symbol)
        shown = self.set(in_joints)
        return shown if in_joints == in_coordinates else f"{shown} = {self.set(in_coordinates)}"

    def twist(self, i: int) -> str:
        """ξ_i."""
        return self.n.twist.format(i)

    def exponential(self, i: int) -> str:
        """e^{ξ̂_i θ_i}."""
        return self.n.exponential(i, self.values[i - 1])

    def hat(self, letter: str, sub: str = "") -> str:
        """The matrix of a vector, as the book has it: an accent, or brackets."""
        sub = f"_{{{sub}}}" if sub else ""
        return f"[{letter}{sub}]" if self.n.angular_first else rf"\hat{{{letter}}}{sub}"

    def column(self, matrix: sp.Matrix) -> str:
        """A twist or Jacobian in brackets, its rows in the book's order."""
        return self.set.matrix(self.n.rows(matrix))

    def result(self, *head: str, matrix: sp.Matrix, name: str) -> list[Block]:
        """``head = matrix``, the entries one by one where it is wide."""
        if not self.set.is_wide(matrix):
            return [Formula((*head, self.set.matrix(matrix)))]
        placeholders, entries, sums = self.set.entries(name, matrix)
        blocks: list[Block] = [Formula((*head, placeholders)), Paragraph("with the entries"), *map(Formula, entries)]
        if sums:
            blocks += [Paragraph("where the long sums have names of their own:"), *map(Formula, sums)]
        return blocks

    def product(self, *head: str, factors: Iterable[sp.Matrix], matrix: sp.Matrix, name: str) -> list[Block]:
        """``head = factors = matrix``, without the factors where one is wide."""
        factors = list(factors)
        if not any(map(self.set.is_wide, factors)):
            head = (*head, " ".join(map(self.set.matrix, factors)))
        return self.result(*head, matrix=matrix, name=name)

    def cite(self, topic: str) -> str:
        """Book and equation."""
        book = "MLS" if self.d.convention == "mls" else "LP"
        return f"{book}, {self.n.equations[topic]}"
