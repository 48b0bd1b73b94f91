"""``pinscrew verify``: do the two engines agree?"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from pinscrew.cli import arguments, output
from pinscrew.errors import PinscrewError

if TYPE_CHECKING:
    from pinscrew.verification.report import Report

__all__ = ["command"]


@click.command(name="verify", short_help="Compare the answers of both engines on every frame.")
@arguments.robot_argument(required=False)
@click.option("--samples", default=1000, show_default=True, type=click.IntRange(0), help="Random configurations.")
@click.option("--seed", default=0, show_default=True, type=click.IntRange(0), help="Of the random configurations.")
@click.option("--frame", "frames", multiple=True, metavar="FRAME", help="Compare this frame only; may be repeated.")
@arguments.json_option
@click.option("--junit", type=click.Path(dir_okay=False, path_type=Path), help="Write JUnit XML to this file.")
@click.option("--markdown", type=click.Path(dir_okay=False, path_type=Path), help="Write Markdown to this file.")
def command(
    words: tuple[str, ...],
    samples: int,
    seed: int,
    frames: tuple[str, ...],
    as_json: bool,
    junit: Path | None,
    markdown: Path | None,
) -> None:
    """Ask two engines the same questions about each ROBOT, on every frame, and compare the answers.

    Without ROBOT, all robots that come with pinscrew are verified. Exit status: 0 if the engines agree, 1 if
    they disagree, 2 if a robot could not be verified.

    \b
      pinscrew verify
      pinscrew verify scara l1:=0.5 path/to/arm.urdf --samples 100 --junit report.xml
    """
    from pinscrew.description.catalogue import bundled
    from pinscrew.verification import formats

    named = arguments.robots(words) or [arguments.Named(entry.name) for entry in bundled()]
    reports: list[Report] = []
    errors: list[formats.Unverified] = []
    with _progress(len(named)) as advance:
        for one in named:
            try:
                reports.append(_verify(one, samples, seed, frames))
            except PinscrewError as error:
                errors.append(formats.Unverified(one.source, error))
            advance(one.source)
    if as_json:
        click.echo(formats.to_json(reports, errors))
    elif len(named) == 1 and reports:
        _print_checks(reports[0])
    elif reports:
        _print_summary(reports, len(named), "compared frame" if frames else "frame")
    for unverified in errors:
        click.echo(f"pinscrew: {unverified.error}", err=True)
    if junit is not None:
        output.write_file(junit, formats.to_junit(reports, errors))
    if markdown is not None:
        output.write_file(markdown, formats.to_markdown(reports, errors))
    if not all(report.ok for report in reports):
        sys.exit(1)
    if errors:
        sys.exit(2)


def _verify(named: arguments.Named, samples: int, seed: int, frames: tuple[str, ...]) -> Report:
    from pinscrew.verification.run import verify

    return verify(named.load(), samples, seed, frames=frames or None)


@contextmanager
def _progress(total: int) -> Iterator[Callable[[str], None]]:
    """A progress bar on standard error, where a person sees it; yields what to call with each robot done."""
    if total < 2 or not sys.stderr.isatty():
        yield lambda _: None
        return
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=output.console(stderr=True), transient=True) as progress:
        task = progress.add_task("verifying", total=total)
        yield lambda name: progress.update(task, advance=1, description=name)


def _print_checks(report: Report) -> None:
    """One robot: a line for each check."""
    from rich.table import Column, Table
    from rich.text import Text

    from pinscrew.verification import formats

    table = Table(Column("check", no_wrap=True), "error", "tolerance", "", "largest at", box=None, pad_edge=False)
    for check in report.checks:
        mark = Text("ok", "green") if check.ok else Text("FAIL", "bold red")
        where = Text(formats.place(check))
        table.add_row(check.name, f"{check.error:.1e}", f"{check.tolerance:.1e}", mark, where)
    output.console().print(table)
    for line in (*formats.details(report), formats.summary(report)):
        click.echo(line)


def _print_summary(reports: Sequence[Report], asked: int, frame: str) -> None:
    """Several robots: a line for each, and what the failed ones have to say."""
    from rich.table import Table
    from rich.text import Text

    from pinscrew.verification import formats

    table = Table("robot", "engines", "largest error", "frames", "configurations", box=None, pad_edge=False)
    for report in reports:
        mark = Text("agree", "green") if report.ok else Text("DISAGREE", "bold red")
        numbers = (f"{report.largest_difference:.1e}", str(report.frames), str(report.configurations))
        table.add_row(Text(report.robot), mark, *numbers)
    output.console().print(table)
    for report in reports:
        if not report.ok:
            click.echo("\n".join((formats.summary(report), *formats.failures(report), *formats.details(report))))
    agreeing = sum(report.ok for report in reports)
    click.echo(f"{agreeing} of {asked} robots: both engines agree to rounding error on every {frame}")
