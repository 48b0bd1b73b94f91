"""Printing: machine output to standard output as it is, tables through rich, words to standard error."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from pinscrew.ground import files

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from pinscrew.ground.typing import FloatArray

__all__ = ["NARROW", "console", "matrix_lines", "plain", "print_json", "table", "write_file"]

UNSEEN_WIDTH: Final = 160
"""Columns of a table that goes to a file or a pipe."""
NARROW: Final = 100
"""Columns below which a table shows less."""


def console(*, stderr: bool = False) -> Console:
    """A console for tables on standard output, or for progress on standard error."""
    from rich.console import Console

    stream = sys.stderr if stderr else sys.stdout
    width = None if stream.isatty() else UNSEEN_WIDTH
    return Console(file=stream, width=width, highlight=False, markup=False, emoji=False)


def table(first: str, *others: str) -> Table:
    """A table with these headings; in a narrow terminal names in its first column stay whole the longest."""
    from rich.table import Column, Table

    columns = (Column(first, no_wrap=True), *(Column(name, overflow="fold") for name in others))
    return Table(*columns, box=None, pad_edge=False)


def print_json(document: Any) -> None:
    """Print a document of plain data as JSON."""
    click.echo(json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False))


def plain(values: FloatArray) -> Any:
    """An array as nested lists of numbers, zeros without a sign."""
    return (values + 0.0).tolist()


def write_file(path: Path, text: str) -> None:
    """Write a file whole or not at all.

    Raises:
        InputError: if it can't be written.
    """
    files.write(path, text.encode("utf-8", errors="backslashreplace"))


def matrix_lines(values: FloatArray, digits: int = 6) -> list[str]:
    """A matrix as lines with aligned columns, for reading."""
    from numpy import round as rounded

    rows = [[f"{x:.{digits}f}" for x in row] for row in rounded(values, digits) + 0.0]
    width = max((len(cell) for row in rows for cell in row), default=0)
    return ["  ".join(cell.rjust(width) for cell in row) for row in rows]
