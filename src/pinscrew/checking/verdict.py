"""What `check` says of an answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from pinscrew.checking.marked import marked_matrix, marked_page
from pinscrew.ground.words import brief
from pinscrew.reporting.document import Account, Case, Document, Problem, ResultTable, Sentence, Strong
from pinscrew.reporting.documented import Documented

__all__ = ["AnswerVerdict", "VerdictData"]

Place = tuple[int, int]


@dataclass(frozen=True, slots=True)
class VerdictData:
    """What was found out about one answer.

    Attributes:
        robot: the robot's name.
        quantity: what was asked for; see `quantities.QUANTITIES`.
        entries: rows and columns, from 1, of the entries that are wrong.
        unread: the same of those that can't be read, each with the reason; they are neither right nor wrong.
        slips: what explains what is wrong, in words; empty where no single slip does.
        structure: what keeps a wrong answer from being a matrix of its kind, in words: RᵀR = I, a last row.
        follows: quantities that were answered wrongly before, and from which this follows by the right formula.
        meant: letters of the answer's own for lengths, each with the length that it was found to stand for.
        given: the answer's entries as they were written.
        expected: the right ones.
    """

    robot: str
    quantity: str
    entries: tuple[Place, ...]
    unread: tuple[tuple[Place, str], ...]
    slips: tuple[str, ...]
    given: tuple[tuple[str, ...], ...]
    expected: tuple[tuple[str, ...], ...]
    structure: tuple[str, ...] = ()
    follows: tuple[str, ...] = ()
    meant: tuple[tuple[str, str], ...] = ()

    @property
    def right(self) -> bool | None:
        """Whether every entry is right; None where none is wrong, but some can't be read."""
        if self.entries:
            return False
        return None if self.unread else True


class AnswerVerdict(Documented, VerdictData):
    """The verdict on one answer; ``print`` shows it."""

    __slots__ = ()

    def document(self) -> Document:
        """The report in no format yet."""
        word = {True: "right", False: "wrong", None: "can't be read in whole"}[self.right]
        rows = []
        reasons = dict(self.unread)
        for i, j in sorted({*self.entries, *reasons}):
            said = Strong("wrong") if (i, j) in self.entries else "not read"
            rows.append((str(i), str(j), said, brief(self.given[i - 1][j - 1]), self.expected[i - 1][j - 1]))
        lines = [Sentence(fault) for fault in self.structure]
        if self.follows:
            lines.append(Sentence(f"it follows rightly from your {', '.join(self.follows)}"))
        lines += [Sentence(slip, "remark", "slip") for slip in self.slips]
        if self.right is False and not self.slips and not self.follows:
            lines.append(Sentence("no single slip explains it"))
        if self.meant:
            read = ", ".join(f"{brief(letter, 40)} as {length}" for letter, length in self.meant)
            lines.append(Sentence(f"read: {read}, the one assignment of lengths that fits", "note"))
        lines += [Sentence(f"entry ({i}, {j}) is not read: {why}") for (i, j), why in self.unread]
        problem = None if self.right else Problem("failure" if self.entries else "error", word, "check")
        account = Account(
            title=self.robot,
            heading=f"{self.quantity} of {self.robot}: {word}",
            table=ResultTable(("row", "column", "", "given", "expected"), tuple(rows)) if rows else None,
            lines=tuple(lines),
            cases=(Case(self.quantity, problem),),
        )
        return Document("pinscrew check", bool(self.right), (account,), data=self.data())

    def marked(self) -> str:
        """The answer as a part of a page in HTML, with the wrong entries marked."""
        (account,) = self.document().accounts
        unread = {place for place, _ in self.unread}
        said = [line.text for line in account.lines]
        return marked_matrix(account.heading, self.given, self.expected, self.entries, unread, said)

    def to_html(self) -> str:
        """The report as a page."""
        return marked_page(f"{self.quantity} of {self.robot}", [self.marked()])

    def _repr_html_(self) -> str:
        return self.marked()

    def data(self) -> dict[str, Any]:
        """The verdict as JSON has it, schema ``pinscrew.check/1``."""
        answer = {
            "quantity": self.quantity,
            "right": self.right,
            "entries": [list(place) for place in self.entries],
            "unread": [{"entry": list(place), "reason": why} for place, why in self.unread],
            "slips": list(self.slips),
            "structure": list(self.structure),
            "follows": list(self.follows),
            "meant": dict(self.meant),
            "given": [list(row) for row in self.given],
            "expected": [list(row) for row in self.expected],
        }
        return {"schema": "pinscrew.check/1", "robot": self.robot, "answers": [answer]}
