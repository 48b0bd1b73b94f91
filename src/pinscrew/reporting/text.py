"""A document as text for a terminal: headings, aligned tables, a line for each sentence."""

from __future__ import annotations

from collections.abc import Iterator

from pinscrew.ground.escaping import terminal
from pinscrew.ground.words import one_line
from pinscrew.reporting.document import Account, Document, ResultTable

__all__ = ["to_text"]


def to_text(document: Document) -> str:
    """The accounts one after the other, and the closing line; without a line break at the end."""
    lines = [line for account in document.accounts for line in _account(account)]
    return "\n".join([*lines, document.closing] if document.closing else lines)


def _account(account: Account) -> Iterator[str]:
    yield terminal(one_line(account.heading))
    if account.table is not None:
        yield from _table(account.table)
    indent = "" if account.table is not None else "  "
    for line in account.lines:
        yield terminal(f"{indent}{'note: ' * (line.role == 'note')}{one_line(line.text)}")


def _table(table: ResultTable) -> Iterator[str]:
    rows = [[terminal(cell) for cell in row] for row in (table.columns, *table.rows)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(table.columns))]
    for row in rows:
        yield "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
