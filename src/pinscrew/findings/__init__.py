"""Layer 4: what is to be told about files, in the formats of other people's tools."""

from __future__ import annotations

from pinscrew.findings.github import to_annotations
from pinscrew.findings.junit import to_junit
from pinscrew.findings.markdown import to_markdown
from pinscrew.findings.model import RULES, Finding, Level
from pinscrew.findings.sarif import to_sarif
from pinscrew.findings.troubles import from_error, from_warning

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
