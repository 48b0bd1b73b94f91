"""A document as Markdown, for the summary of a CI job or a comment on a merge request."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pinscrew.ground.escaping import markdown
from pinscrew.ground.words import one_line
from pinscrew.reporting.document import Account, Document, ResultTable, Sentence, Strong
from pinscrew.reporting.findings import Finding
from pinscrew.reporting.paths import below

__all__ = ["to_markdown"]


def to_markdown(document: Document) -> str:
    """A heading for each account with its table and sentences; or the overview, and a table of the findings."""
    if document.overview:
        return "\n".join([f"### {_plain(document.overview)}", "", *_findings(document.findings)])
    return "\n".join(line for account in document.accounts for line in _account(account))


def _account(account: Account) -> Iterator[str]:
    yield from (f"### {_plain(account.heading)}", "")
    if account.table is not None:
        yield from (*_table(account.table), "")
    notes = [line for line in account.lines if line.role == "note" and account.notes_heading]
    others = [line for line in account.lines if line not in notes]
    if others:
        yield from (*map(_line, others), "")
    if notes:
        yield from (_plain(account.notes_heading), "", *map(_line, notes), "")


def _line(line: Sentence) -> str:
    if line.role == "paragraph":
        return _plain(line.text)
    label = f"**{line.label}**" if line.role == "fault" else line.label
    return f"- {label}: {_plain(line.text)}" if line.label else f"- {_plain(line.text)}"


def _table(table: ResultTable) -> Iterator[str]:
    yield f"| {' | '.join(map(_plain, table.columns))} |".replace("|  |", "| |")
    yield "|" + "---|" * len(table.columns)
    for row in table.rows:
        yield f"| {' | '.join(f'**{_plain(text)}**' if isinstance(text, Strong) else _plain(text) for text in row)} |"


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


def _plain(text: str) -> str:
    """Text as it is read, on one line."""
    return markdown(one_line(text))
