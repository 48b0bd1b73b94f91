"""A progress bar on standard error, where a person sees it."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

from pinscrew.cli import output

__all__ = ["Advance", "progress"]


class Advance(Protocol):
    """What moves a bar on."""

    def __call__(self, steps: int = 1, description: str | None = None, /) -> None:
        """So many steps are done; the description, if given, replaces the one before."""


@contextmanager
def progress(description: str, total: int) -> Iterator[Advance]:
    """Show a bar on standard error if that is a terminal and there is more than one step.

    Args:
        description: what is being done.
        total: how many steps there are.

    Yields:
        what to call as steps are done.
    """
    if total < 2 or not sys.stderr.isatty():
        yield _nothing
        return
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}", markup=False), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=output.console(stderr=True), transient=True) as shown:
        task = shown.add_task(description, total=total)
        yield lambda steps=1, text=None, /: shown.update(task, advance=steps, description=text)


def _nothing(steps: int = 1, description: str | None = None, /) -> None:
    """Without a bar."""
