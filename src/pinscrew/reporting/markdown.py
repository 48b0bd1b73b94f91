"""Findings as a Markdown table, for the summary of a CI job or a comment on a merge request."""

from __future__ import annotations

from collections.abc import Sequence

from pinscrew.ground.words import one_line
from pinscrew.reporting.model import Finding
from pinscrew.reporting.paths import below

__all__ = ["cell", "to_markdown"]


def to_markdown(findings: Sequence[Finding]) -> str:
    """A table with a row for each finding; empty if there are none."""
    if not findings:
        return ""
    rows = ["| level | robot | place | what | rule |", "|---|---|---|---|---|"]
    for finding in findings:
        place = below(finding.file) or finding.file
        if finding.line is not None:
            place += f":{finding.line}"
        cells = (finding.level, finding.robot, place, finding.message, finding.rule)
        rows.append(f"| {' | '.join(map(cell, cells))} |")
    return "\n".join([*rows, ""])


def cell(text: str) -> str:
    """Text on one line, with what Markdown would take as markup made plain."""
    text = one_line(text)
    for mark in "\\`*_|<>[]":
        text = text.replace(mark, f"\\{mark}")
    return text
