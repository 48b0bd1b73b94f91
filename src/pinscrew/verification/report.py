"""What `pinscrew.verify` answers: the outcome, with the formats that it can be written in."""

from __future__ import annotations

from dataclasses import dataclass

from pinscrew.verification import formats
from pinscrew.verification.outcome import ReportData

__all__ = ["Report"]


@dataclass(frozen=True)
class Report(ReportData):
    """The outcome of `verify` for one robot; `ReportData` lists what it holds. ``print`` shows it as a table."""

    def __str__(self) -> str:
        return formats.to_text(self)

    def to_json(self) -> str:
        """The report as JSON, schema ``pinscrew.verify/1``."""
        return formats.to_json([self])

    def to_junit(self) -> str:
        """The report as JUnit XML: a test suite with a test case per check."""
        return formats.to_junit([self])

    def to_markdown(self) -> str:
        """The report as a Markdown table."""
        return formats.to_markdown([self])
