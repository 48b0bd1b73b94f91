"""Reports for a terminal: mathematics in Unicode, in as many columns as there are."""

from __future__ import annotations

import shutil
import textwrap

from pinscrew.derivation import unicode_math
from pinscrew.derivation.blocks import Block, Formula, Paragraph, Sketch, Table, Writeup
from pinscrew.derivation.formats import split_text
from pinscrew.ground.escaping import terminal

__all__ = ["to_terminal"]

LEAST, MOST = 40, 160
"""Columns that are used, whatever the terminal says."""


def to_terminal(report: Writeup) -> str:
    """The report as text for the terminal that it is printed on."""
    columns = min(max(shutil.get_terminal_size().columns, LEAST), MOST)
    title = _text(report.title)
    found = [title, "═" * unicode_math.width(title), ""]
    for section in report.sections:
        heading = _text(section.heading)
        found += [heading, "─" * min(unicode_math.width(heading), columns), ""]
        for block in section.blocks:
            found += [] if isinstance(block, Sketch) else [*_block(block, columns), ""]
    return "\n".join(found)


def _text(text: str) -> str:
    return split_text(text, str, unicode_math.one_line, terminal, terminal)


def _block(block: Block, columns: int) -> list[str]:
    if isinstance(block, Formula):
        return [f"  {line}" for line in unicode_math.lines(block.latex, columns - 2)]
    if isinstance(block, Paragraph):
        return textwrap.wrap(_text(block.text), columns) or [""]
    return _table(block, columns) if isinstance(block, Table) else []


def _table(table: Table, columns: int) -> list[str]:
    rows = [[_text(cell) for cell in row] for row in (table.head, *table.rows)]
    widths = [max(unicode_math.width(row[j]) for row in rows) for j in range(len(rows[0]))]
    shown = ["  ".join(x + " " * (w - unicode_math.width(x)) for x, w in zip(row, widths, strict=True)) for row in rows]
    shown.insert(1, "  ".join("─" * w for w in widths))
    return [part for line in shown for part in _folded(f"  {line.rstrip()}", columns)]


def _folded(line: str, columns: int) -> list[str]:
    if unicode_math.width(line) <= columns:
        return [line]
    return textwrap.wrap(line, columns, initial_indent="", subsequent_indent="      ", drop_whitespace=False)
