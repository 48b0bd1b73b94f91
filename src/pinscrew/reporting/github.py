"""Annotations of GitHub Actions: workflow commands, a line each, which GitHub shows beside the line of a file.

Source: GitHub's documentation, "Workflow commands for GitHub Actions".
"""

from __future__ import annotations

from typing import Final

from pinscrew.ground.escaping import github_data, github_property
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
    written = ",".join(f"{name}={github_property(value)}" for name, value in properties.items())
    return f"::{_COMMANDS[finding.level]} {written}::{github_data(finding.text)}"
