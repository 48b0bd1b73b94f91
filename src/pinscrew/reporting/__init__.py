"""What is to be told about files, in the formats of other people's tools."""

from __future__ import annotations

from pinscrew.reporting.github import to_annotations
from pinscrew.reporting.junit import to_junit
from pinscrew.reporting.markdown import to_markdown
from pinscrew.reporting.model import RULES, Finding, Level
from pinscrew.reporting.sarif import to_sarif
from pinscrew.reporting.troubles import from_error, from_warning

__all__ = [
    "RULES",
    "Finding",
    "Level",
    "from_error",
    "from_warning",
    "to_annotations",
    "to_junit",
    "to_markdown",
    "to_sarif",
]
