"""What every answer that is a report can do: be printed, and be written in each format."""

from __future__ import annotations

from pinscrew.reporting.document import Document
from pinscrew.reporting.github import to_annotations
from pinscrew.reporting.json_text import to_json
from pinscrew.reporting.junit import to_junit
from pinscrew.reporting.markdown import to_markdown
from pinscrew.reporting.sarif import to_sarif
from pinscrew.reporting.text import to_text

__all__ = ["Documented"]


class Documented:
    """An answer that is a report. ``print`` shows it as text."""

    __slots__ = ()

    def document(self) -> Document:
        """The report in no format yet, for a format of one's own."""
        raise NotImplementedError

    def __str__(self) -> str:
        return to_text(self.document())

    def to_json(self) -> str:
        """The report as JSON; the key ``schema`` names its form."""
        return to_json(self.document())

    def to_markdown(self) -> str:
        """The report as Markdown: headings, tables and lists."""
        return to_markdown(self.document())

    def to_junit(self) -> str:
        """The report as JUnit XML."""
        return to_junit(self.document())

    def to_sarif(self) -> str:
        """The report as SARIF 2.1.0: what is wrong, at its file and line."""
        return to_sarif(self.document())

    def to_annotations(self) -> str:
        """The report as GitHub's workflow commands, a line each."""
        return to_annotations(self.document())
