"""The reports that commands for CI write: JSON, JUnit XML, Markdown, SARIF, and GitHub's annotations and summary."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

from pinscrew.cli import arguments, output
from pinscrew.ground import files

if TYPE_CHECKING:
    from pinscrew.reporting.document import Document

__all__ = ["Wanted", "fail_on_option", "report_options"]

_F = TypeVar("_F", bound=Callable[..., Any])

_SUMMARY: Final = "GITHUB_STEP_SUMMARY"
"""Names the file that GitHub shows as the summary of a job."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """Which reports are wanted.

    Attributes:
        as_json: whether standard output is to be JSON.
        junit, markdown, sarif: the files for these, or None.
        github: whether GitHub is to be told.
    """

    as_json: bool
    junit: Path | None
    markdown: Path | None
    sarif: Path | None
    github: bool

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that are to be written."""
        return tuple(file for file in (self.junit, self.markdown, self.sarif) if file is not None)

    def write(self, document: Document) -> None:
        """Write those that are wanted, but for JSON, which each command prints where it prints its table.

        Annotations go to standard error, which GitHub reads as well as standard output, so that ``--json`` has the
        latter for itself. They come first: a file that can't be written must not silence them.

        Raises:
            InputError: if a file can't be written.
        """
        from pinscrew.reporting import to_annotations, to_junit, to_markdown, to_sarif

        if self.github:
            click.echo(to_annotations(document), err=True, nl=False)
            summary = os.environ.get(_SUMMARY)
            if summary:
                files.append(Path(summary), to_markdown(document).encode("utf-8", errors="backslashreplace") + b"\n")
        for file, writer in ((self.junit, to_junit), (self.markdown, to_markdown), (self.sarif, to_sarif)):
            if file is not None:
                output.write_file(file, writer(document))


def _gates(_ctx: click.Context, _param: click.Parameter, value: str | None) -> frozenset[str] | None:
    from pinscrew.changes.gates import gates
    from pinscrew.ground.errors import InputError

    if value is None:
        return None
    try:
        return gates(name.strip() for name in value.split(",") if name.strip())
    except InputError as error:
        raise click.BadParameter(str(error)) from None


fail_on_option = click.option(
    "--fail-on",
    metavar="NOTES",
    callback=_gates,
    help="Let these notes fail too: names, tips, velocity, effort, limits, order, frames or all, separated by commas.",
)
"""What notes fail, as a set; None where it is not given."""


def _file(name: str, form: str) -> Callable[[_F], _F]:
    return click.option(f"--{name}", type=output.FILE, help=f"Write {form} to this file.")


def report_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options for reports; it gets them as one argument, ``wanted``."""

    @arguments.json_option
    @_file("junit", "JUnit XML")
    @_file("markdown", "Markdown")
    @_file("sarif", "SARIF 2.1.0")
    @click.option("--github", is_flag=True, help="Write annotations to stderr, and Markdown to a GitHub job's summary.")
    @functools.wraps(function)
    def command(
        *positional: Any,
        as_json: bool,
        junit: Path | None,
        markdown: Path | None,
        sarif: Path | None,
        github: bool,
        **others: Any,
    ) -> Any:
        return function(*positional, wanted=Wanted(as_json, junit, markdown, sarif, github), **others)

    return command
