"""Tables that hide nothing, however narrow the terminal: what has no room in a row goes below it, with its heading."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import zip_longest
from typing import TYPE_CHECKING, Final

from rich.text import Text

from pinscrew.ground.escaping import terminal

if TYPE_CHECKING:
    from rich.console import Console, ConsoleOptions

__all__ = ["TerminalTable"]

GAP: Final = 2
"""Spaces between columns, and before what stands below its row."""
LEAST: Final = 24
"""Columns of the terminal in which a long cell may be wrapped; with less, it goes below its row."""


class TerminalTable:
    """Rows of cells under headings, for `rich.console.Console.print`.

    Where the terminal is too narrow, the last column is wrapped if it has some room, or goes below its row, and then
    the one before it. The first column, which names the row, and those that have a style, which are verdicts, go last:
    they stay in the row at any width.

    Cells are escaped here: a name in them comes from a file.
    """

    def __init__(self, *headings: str) -> None:
        self._headings = [Text(heading, "bold") for heading in headings]
        self._rows: list[list[Text]] = []

    def add_row(self, *cells: str | Text) -> None:
        """Add a row, with as many cells as there are headings."""
        self._rows.append([_safe(cell) for cell in cells])

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> Iterator[Text]:
        width = max(options.max_width, 1)
        columns, widths = self._layout(width)
        below = [i for i in range(len(self._headings)) if i not in columns]
        for row in (self._headings, *self._rows):
            yield from _side_by_side(console, [row[i] for i in columns], widths)
            if row is not self._headings:
                pieces = [_piece(self._headings[i].plain, row[i]) for i in below if row[i].plain]
                yield from _filled(console, pieces, width)

    def _layout(self, width: int) -> tuple[list[int], list[int]]:
        """The columns that stay in the rows, and how wide they are."""
        natural = [max(row[i].cell_len for row in (self._headings, *self._rows)) for i in range(len(self._headings))]
        columns = list(range(len(natural)))
        while True:
            room = width - sum(natural[i] for i in columns) - GAP * (len(columns) - 1)
            if room >= 0:
                break
            loose = [i for i in columns[1:] if not any(row[i].style for row in self._rows)]
            last = loose[-1] if loose else columns[0]
            if natural[last] + room >= LEAST or not loose:
                natural[last] = max(natural[last] + room, 1)
                break
            columns.remove(last)
        return columns, [natural[i] for i in columns]


def _safe(cell: str | Text) -> Text:
    return Text(terminal(cell)) if isinstance(cell, str) else Text(terminal(cell.plain), cell.style)


def _piece(heading: str, cell: Text) -> Text:
    return Text.assemble((f"{heading}: " if heading else "", "dim"), cell)


def _side_by_side(console: Console, cells: Sequence[Text], widths: Sequence[int]) -> Iterator[Text]:
    """Lines of a row, each cell wrapped in its column."""
    wrapped = [cell.wrap(console, width, overflow="fold") for cell, width in zip(cells, widths, strict=True)]
    for parts in zip_longest(*wrapped):
        line = Text(no_wrap=True, overflow="ignore")
        for part, width in zip(parts, widths, strict=True):
            shown = part or Text()
            line.append_text(shown)
            line.append(" " * (width - shown.cell_len + GAP))
        line.rstrip()
        yield line


def _filled(console: Console, pieces: Sequence[Text], width: int) -> Iterator[Text]:
    """Pieces one after the other in indented lines, none of them broken unless it is wider than a line."""
    lines: list[Text] = []
    for piece in pieces:
        if lines and lines[-1].cell_len + GAP + piece.cell_len <= width - GAP:
            lines[-1].append(" " * GAP).append_text(piece)
        else:
            lines.append(piece)
    for line in lines:
        for part in line.wrap(console, max(width - GAP, 1), overflow="fold"):
            part.rstrip()
            yield Text.assemble(" " * GAP, part, no_wrap=True, overflow="ignore")
