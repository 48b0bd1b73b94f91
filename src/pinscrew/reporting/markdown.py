"""A document as Markdown, for the summary of a CI job or a comment on a merge request."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pinscrew.ground.words import one_line
from pinscrew.reporting.document import Document, Line, ResultTable, Section, Strong
from pinscrew.reporting.findings import Finding
from pinscrew.reporting.paths import below

__all__ = ["cell", "to_markdown"]


def to_markdown(document: Document) -> str:
    """A heading for each section with its table and sentences; or the overview, and a table of the findings."""
    if document.overview:
        return "\n".join([f"### {cell(document.overview)}", "", *_findings(document.findings)])
    return "\n".join(line for section in document.sections for line in _section(section))


def _section(section: Section) -> Iterator[str]:
    yield from (f"### {cell(section.heading)}", "")
    if section.table is not None:
        yield from (*_table(section.table), "")
    notes = [line for line in section.lines if line.role == "note" and section.notes_heading]
    others = [line for line in section.lines if line not in notes]
    if others:
        yield from (*map(_line, others), "")
    if notes:
        yield from (section.notes_heading, "", *map(_line, notes), "")


def _line(line: Line) -> str:
    if line.role == "paragraph":
        return cell(line.text)
    label = f"**{line.label}**" if line.role == "fault" else line.label
    return f"- {label}: {cell(line.text)}" if line.label else f"- {cell(line.text)}"


def _table(table: ResultTable) -> Iterator[str]:
    yield f"| {' | '.join(table.columns)} |".replace("|  |", "| |")
    yield "|" + "---|" * len(table.columns)
    for row in table.rows:
        yield f"| {' | '.join(f'**{cell(text)}**' if isinstance(text, Strong) else cell(text) for text in row)} |"


def _findings(findings: Sequence[Finding]) -> list[str]:
    """A table with a row for each finding; nothing if there are none."""
    if not findings:
        return []
    rows = []
    for finding in findings:
        place = below(finding.file) or finding.file
        if finding.line is not None:
            place += f":{finding.line}"
        rows.append((finding.level, finding.robot, place, finding.message, finding.rule))
    return [*_table(ResultTable(("level", "robot", "place", "what", "rule"), tuple(rows))), ""]


def cell(text: str) -> str:
    """Text on one line, with what Markdown would take as markup made plain."""
    text = one_line(text)
    for mark in "\\`*_|<>[]":
        text = text.replace(mark, f"\\{mark}")
    return text
