"""Answers as HTML: each matrix as it was written, with the entries marked that are wrong or not read."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import Final

from pinscrew.ground.escaping import html
from pinscrew.ground.words import brief

__all__ = ["marked_matrix", "marked_page"]

MOST_IN_A_CELL: Final = 200
_CELL: Final = "padding:2px 10px;text-align:center;font-family:monospace"
_WRONG: Final = "background:#fde2e1;color:#8f1d14;font-weight:bold"
_UNREAD: Final = "background:#fff3cd;color:#6b5300"
_BRACKETS: Final = "border-left:2px solid;border-right:2px solid;border-collapse:collapse;margin:6px 0"


def marked_matrix(
    heading: str,
    given: Sequence[Sequence[str]],
    expected: Sequence[Sequence[str]],
    wrong: Collection[tuple[int, int]],
    unread: Collection[tuple[int, int]],
    lines: Iterable[str],
) -> str:
    """A matrix that was given, below its verdict; a wrong entry says below itself what is due there.

    Args:
        heading: the verdict in a line.
        given: the entries as they were written.
        expected: the right ones.
        wrong: rows and columns, from 1.
        unread: the same of entries that can't be read.
        lines: what is said of it.
    """
    rows = []
    for i, row in enumerate(given, 1):
        cells = []
        for j, text in enumerate(row, 1):
            style, due = _CELL, ""
            if (i, j) in wrong:
                style, due = (
                    f"{_CELL};{_WRONG}",
                    f"<br><small>{html(brief(expected[i - 1][j - 1], MOST_IN_A_CELL))}</small>",
                )
            elif (i, j) in unread:
                style = f"{_CELL};{_UNREAD}"
            title = {True: ' title="wrong"'}.get((i, j) in wrong, ' title="not read"' if (i, j) in unread else "")
            cells.append(f'<td style="{style}"{title}>{html(brief(text, MOST_IN_A_CELL))}{due}</td>')
        rows.append(f"<tr>{''.join(cells)}</tr>")
    said = "".join(f"<li>{html(line)}</li>" for line in lines)
    listed = f"<ul>{said}</ul>" if said else ""
    table = f'<table style="{_BRACKETS}">{"".join(rows)}</table>' if rows else ""
    return f"<div><p><strong>{html(heading)}</strong></p>{table}{listed}</div>"


def marked_page(title: str, parts: Iterable[str]) -> str:
    """A whole page with these parts; it needs nothing else."""
    head = f'<meta charset="utf-8"><title>{html(title)}</title>'
    style = "<style>body{font-family:sans-serif;max-width:60em;margin:2em auto;padding:0 1em}</style>"
    return f'<!DOCTYPE html>\n<html lang="en"><head>{head}{style}</head><body>{"".join(parts)}</body></html>\n'
