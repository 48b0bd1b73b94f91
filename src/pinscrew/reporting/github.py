"""Annotations of GitHub Actions: workflow commands, a line each, which GitHub shows beside the line of a file.

Source: GitHub's documentation, "Workflow commands for GitHub Actions"; the escapes are those of ``@actions/core``.
"""

from __future__ import annotations

from typing import Final

from pinscrew.reporting.document import Document
from pinscrew.reporting.findings import Finding, Level
from pinscrew.reporting.paths import below

__all__ = ["to_annotations"]

_COMMANDS: Final[dict[Level, str]] = {"error": "error", "warning": "warning", "note": "notice"}


def to_annotations(document: Document) -> str:
    """A workflow command for each finding of a document, each on a line of its own."""
    return "".join(f"{_command(finding)}\n" for finding in document.findings)


def _command(finding: Finding) -> str:
    properties = {}
    if finding.file:
        properties["file"] = below(finding.file) or finding.file
        if finding.line is not None:
            properties["line"] = str(finding.line)
    properties["title"] = f"pinscrew: {finding.rule}"
    written = ",".join(f"{name}={_property(value)}" for name, value in properties.items())
    return f"::{_COMMANDS[finding.level]} {written}::{_data(finding.text)}"


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
