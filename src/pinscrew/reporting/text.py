"""A document as text for a terminal: headings, aligned tables, a line for each sentence."""

from __future__ import annotations

from collections.abc import Iterator

from pinscrew.ground.escaping import terminal
from pinscrew.ground.words import one_line
from pinscrew.reporting.document import Document, ResultTable, Section

__all__ = ["to_text"]


def to_text(document: Document) -> str:
    """The sections one after the other, and the closing line; without a line break at the end."""
    lines = [line for section in document.sections for line in _section(section)]
    return "\n".join([*lines, document.closing] if document.closing else lines)


def _section(section: Section) -> Iterator[str]:
    yield terminal(one_line(section.heading))
    if section.table is not None:
        yield from _table(section.table)
    indent = "" if section.table is not None else "  "
    for line in section.lines:
        yield terminal(f"{indent}{'note: ' * (line.role == 'note')}{one_line(line.text)}")


def _table(table: ResultTable) -> Iterator[str]:
    rows = [[terminal(cell) for cell in row] for row in (table.columns, *table.rows)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(table.columns))]
    for row in rows:
        yield "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
