"""What `pinscrew.verify` answers: the outcome, which can be printed and written in every format."""

from __future__ import annotations

from dataclasses import dataclass

from pinscrew.reporting.document import Document
from pinscrew.reporting.documented import Documented
from pinscrew.verification.document import Attempt, document
from pinscrew.verification.outcome import ReportData

__all__ = ["Report"]


@dataclass(frozen=True)
class Report(Documented, ReportData):
    """The outcome of `verify` for one robot; `ReportData` lists what it holds. ``print`` shows it as a table.

    Its JSON has the schema ``pinscrew.verify/1``, its JUnit a test case per check.
    """

    def document(self) -> Document:
        """The report in no format yet."""
        return document([Attempt(self.robot, (self,))])
