"""Printing: machine output to standard output as it is, tables through rich, words to standard error."""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from pinscrew.ground import files
from pinscrew.ground.escaping import json_text, terminal

if TYPE_CHECKING:
    from rich.console import Console

    from pinscrew.cli.tables import TerminalTable
    from pinscrew.ground.typing import FloatArray

__all__ = ["FILE", "console", "matrix_lines", "plain", "print_json", "say", "table", "write_file"]

UNSEEN_WIDTH: Final = 160
"""Columns of a table that goes to a file or a pipe."""


class _Output(click.Path):
    """A file to write: one that can't be written is refused before any work."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:  # noqa: ARG002
        path = Path(os.fsdecode(value))
        files.check(path)
        return path


FILE: Final = _Output()
"""The type of an option that names a file to write."""


def console(*, stderr: bool = False) -> Console:
    """A console for tables on standard output, or for progress on standard error."""
    from rich.console import Console

    class OurConsole(Console):
        def on_broken_pipe(self) -> None:
            raise BrokenPipeError(errno.EPIPE, os.strerror(errno.EPIPE))  # for `main`; rich would end with status 1

    stream = sys.stderr if stderr else sys.stdout
    width = None if stream.isatty() else UNSEEN_WIDTH
    return OurConsole(file=stream, width=width, highlight=False, markup=False, emoji=False)


def table(*headings: str) -> TerminalTable:
    """A table with these headings; see `tables.TerminalTable` for what it does in a narrow terminal."""
    from pinscrew.cli.tables import TerminalTable

    return TerminalTable(*headings)


def print_json(document: Any) -> None:
    """Print a document of plain data as JSON."""
    click.echo(json_text(document))


def say(*lines: str, err: bool = False) -> None:
    """Print lines for a person; what a name from a file would do to a terminal or a log is shown, and not done."""
    for line in lines:
        click.echo(terminal(line), err=err)


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
