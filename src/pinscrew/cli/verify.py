"""``pinscrew verify``: do the two engines agree?"""

from __future__ import annotations

import multiprocessing
import os
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeAlias

import click

from pinscrew.cli import arguments, output
from pinscrew.errors import PinscrewError, PinscrewWarning

if TYPE_CHECKING:
    from pinscrew.verification.report import Report

    _Outcome: TypeAlias = tuple[Report | PinscrewError, list[PinscrewWarning]]
    _Question: TypeAlias = Callable[[arguments.Named], _Outcome]

__all__ = ["command"]

MOST_IN_ONE: Final = 20
"""Robots that are verified in this process; for more, starting others pays."""


@click.command(name="verify", short_help="Compare the answers of both engines on every frame.")
@arguments.robot_argument(required=False)
@click.option("--samples", default=1000, show_default=True, type=click.IntRange(0), help="Random configurations.")
@click.option("--seed", default=0, show_default=True, type=click.IntRange(0), help="Of the random configurations.")
@click.option("--frame", "frames", multiple=True, metavar="FRAME", help="Compare this frame only; may be repeated.")
@click.option("--all", "everything", is_flag=True, help="Verify every robot known by name, example-robot-data's too.")
@click.option("--jobs", type=click.IntRange(1), help="Processes; by default 1, or all cores above 20 robots.")
@arguments.json_option
@click.option("--junit", type=click.Path(dir_okay=False, path_type=Path), help="Write JUnit XML to this file.")
@click.option("--markdown", type=click.Path(dir_okay=False, path_type=Path), help="Write Markdown to this file.")
def command(
    words: tuple[str, ...],
    samples: int,
    seed: int,
    frames: tuple[str, ...],
    everything: bool,
    jobs: int | None,
    as_json: bool,
    junit: Path | None,
    markdown: Path | None,
) -> None:
    """Ask two engines the same questions about each ROBOT, on every frame, and compare the answers.

    Without ROBOT, all robots that come with pinscrew are verified. Exit status: 0 if the engines agree, 1 if
    they disagree, 2 if a robot could not be verified.

    \b
      pinscrew verify
      pinscrew verify scara l1:=0.5 path/to/arm.urdf --junit report.xml
      pinscrew verify --all --samples 100
    """
    from pinscrew.verification import formats

    if everything and words:
        raise click.UsageError("--all takes no ROBOT")
    named = arguments.robots(words) or _known(everything)
    question = partial(_outcome, samples=samples, seed=seed, frames=frames)
    reports: list[Report] = []
    errors: list[formats.Unverified] = []
    with _progress(len(named)) as advance:
        for one, (outcome, remarks) in zip(named, _each(question, named, jobs), strict=True):
            if isinstance(outcome, PinscrewError):
                errors.append(formats.Unverified(one.source, outcome))
            else:
                reports.append(outcome)
            _warn(remarks, brief=everything)
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


def _known(everything: bool) -> list[arguments.Named]:
    """The robots that come with pinscrew, and with ``everything`` those of example-robot-data."""
    from pinscrew.description.catalogue import bundled, example_robots

    entries = bundled() + (example_robots() if everything else ())
    return [arguments.Named(entry.name) for entry in entries]


def _each(question: _Question, named: Sequence[arguments.Named], jobs: int | None) -> Iterator[_Outcome]:
    """The outcome for each robot, in order, as they come."""
    processes = jobs or (1 if len(named) <= MOST_IN_ONE else os.cpu_count() or 1)
    if processes == 1:
        yield from map(question, named)
        return
    # Workers are spawned, not forked: numpy's and Pinocchio's threads may hold locks.
    with ProcessPoolExecutor(processes, multiprocessing.get_context("spawn")) as pool:
        yield from pool.map(question, named)


def _outcome(named: arguments.Named, samples: int, seed: int, frames: tuple[str, ...]) -> _Outcome:
    """The report on one robot, or why there is none, and what was remarked about its file."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", PinscrewWarning)
        try:
            outcome: Report | PinscrewError = _verify(named, samples, seed, frames)
        except PinscrewError as error:
            outcome = error
    return outcome, [one.message for one in caught if isinstance(one.message, PinscrewWarning)]


def _warn(remarks: Sequence[PinscrewWarning], *, brief: bool) -> None:
    """Show the remarks about one robot; in brief the first of them and how many more there are."""
    for remark in remarks[:1] if brief else remarks:
        more = f" (and {len(remarks) - 1} more remarks on this file)" if brief and len(remarks) > 1 else ""
        click.echo(f"pinscrew: warning: {remark}{more}", err=True)


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
    from rich.text import Text

    from pinscrew.verification import formats

    console = output.console()
    wide = console.width >= output.NARROW
    table = output.table("check", "error", "tolerance", "", *["largest at"] * wide)
    for check in report.checks:
        mark = Text("ok", "green") if check.ok else Text("FAIL", "bold red")
        where = [Text(formats.place(check))] * wide
        table.add_row(check.name, f"{check.error:.1e}", f"{check.tolerance:.1e}", mark, *where)
    console.print(table)
    failures = [] if wide else formats.failures(report)
    for line in (*failures, *formats.details(report), formats.summary(report)):
        click.echo(line)


def _print_summary(reports: Sequence[Report], asked: int, frame: str) -> None:
    """Several robots: a line for each, and what the failed ones have to say."""
    from rich.text import Text

    from pinscrew.verification import formats

    table = output.table("robot", "engines", "largest error", "frames", "configurations")
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
