"""What `check` says of a file of answers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from pinscrew.checking.marked import marked_matrix, marked_page
from pinscrew.checking.verdict import AnswerVerdict
from pinscrew.ground.words import brief
from pinscrew.reporting.document import Account, Case, Document, Problem, Sentence
from pinscrew.reporting.documented import Documented

__all__ = ["AnswerSheet", "Refused", "SheetData"]


@dataclass(frozen=True, slots=True)
class Refused:
    """An answer that can't be held against anything.

    Attributes:
        quantity: what was asked for.
        line: where it stands, or 0.
        reason: why.
    """

    quantity: str
    line: int
    reason: str


@dataclass(frozen=True, slots=True)
class SheetData:
    """What was found out about a file of answers.

    Attributes:
        robot: the robot's name.
        file: the file's.
        verdicts: one for each answer that has the shape of its quantity, with its line, in order.
        refused: the answers that have not, or are no matrix that is read.
        blank: quantities whose matrix is not filled in.
        passed: names of matrices that are no quantity that is known, or no result.
    """

    robot: str
    file: str
    verdicts: tuple[tuple[AnswerVerdict, int], ...]
    refused: tuple[Refused, ...]
    blank: tuple[str, ...]
    passed: tuple[str, ...]

    @property
    def right(self) -> bool | None:
        """Whether all that is answered is right; None where nothing is wrong, but something unread or nothing there.

        What is not filled in is neither right nor wrong.
        """
        words = [verdict.right for verdict, _ in self.verdicts] + [None] * len(self.refused)
        if False in words:
            return False
        return True if words and None not in words else None

    def count(self, word: bool | None) -> int:
        """How many answers are right (True), wrong (False) or not read in whole (None)."""
        return sum(verdict.right is word for verdict, _ in self.verdicts) + len(self.refused) * (word is None)


class AnswerSheet(Documented, SheetData):
    """The verdicts on a file of answers; ``print`` shows them."""

    __slots__ = ()

    def document(self) -> Document:
        """The report in no format yet."""
        accounts = [account for verdict, _ in self.verdicts for account in verdict.document().accounts]
        for each in self.refused:
            problem = Problem("error", each.reason, "check")
            heading = f"{each.quantity} of {self.robot}: can't be read" + (f" (line {each.line})" if each.line else "")
            why = (Sentence(each.reason),)
            accounts.append(Account(self.robot, heading, lines=why, cases=(Case(each.quantity, problem),)))
        notes: list[str] = []
        if self.blank:
            notes.append(f"not filled in: {', '.join(self.blank)}")
        if self.passed:
            names = ", ".join(brief(name, 40) for name in self.passed[:10])
            notes.append(f"of no quantity that is known here: {names}{', …' * (len(self.passed) > 10)}")
        counted = f"{self.count(True)} right, {self.count(False)} wrong, {self.count(None)} not read"
        lines = tuple(Sentence(note, "note") for note in notes)
        accounts.append(Account(self.file, f"{self.file}: {counted}", lines=lines))
        return Document("pinscrew check", bool(self.right), tuple(accounts), data=self.data())

    def marked(self) -> str:
        """The answers as a part of a page in HTML, with the wrong entries marked."""
        accounts = self.document().accounts[len(self.verdicts) :]
        rest = [marked_matrix(each.heading, (), (), (), (), [line.text for line in each.lines]) for each in accounts]
        return "".join([*(verdict.marked() for verdict, _ in self.verdicts), *rest])

    def to_html(self) -> str:
        """The report as a page."""
        return marked_page(f"{self.file}: {self.robot}", [self.marked()])

    def _repr_html_(self) -> str:
        return self.marked()

    def data(self) -> dict[str, Any]:
        """The verdicts as JSON has them, schema ``pinscrew.check/1``."""
        answers: list[dict[str, Any]] = []
        for verdict, line in self.verdicts:
            answers += [{**answer, "line": line} for answer in verdict.data()["answers"]]
        for each in self.refused:
            unread = [{"entry": None, "reason": each.reason}]
            left = {"entries": [], "unread": unread, "slips": [], "given": [], "expected": [], "line": each.line}
            answers.append({"quantity": each.quantity, "right": None, **left})
        rest = {"answers": answers, "blank": list(self.blank), "passed": list(self.passed)}
        return {"schema": "pinscrew.check/1", "robot": self.robot, "file": self.file, **rest}
