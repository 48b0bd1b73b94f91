"""The reporting room: reports as neutral documents, and one writer for each format that takes any of them.

`Document` is what rooms hand in. ``to_text``, ``to_json``, ``to_markdown``, ``to_junit``, ``to_sarif`` and
``to_annotations`` (GitHub) write it; `Documented` gives an answer these as methods. A new format is a module here with
one such function.
"""

from __future__ import annotations

from pinscrew.reporting.document import Account, Case, Document, Problem, ResultTable, Sentence, Strong, cases_of
from pinscrew.reporting.documented import Documented
from pinscrew.reporting.findings import RULES, Finding, Level
from pinscrew.reporting.github import to_annotations
from pinscrew.reporting.json_text import to_json
from pinscrew.reporting.junit import to_junit
from pinscrew.reporting.markdown import to_markdown
from pinscrew.reporting.sarif import to_sarif
from pinscrew.reporting.text import to_text
from pinscrew.reporting.troubles import from_error, from_warning

__all__ = [
    "RULES",
    "Account",
    "Case",
    "Document",
    "Documented",
    "Finding",
    "Level",
    "Problem",
    "ResultTable",
    "Sentence",
    "Strong",
    "cases_of",
    "from_error",
    "from_warning",
    "to_annotations",
    "to_json",
    "to_junit",
    "to_markdown",
    "to_sarif",
    "to_text",
]
