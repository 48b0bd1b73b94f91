"""``pinscrew verify``: do the two engines agree?"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final, TypeAlias

import click

from pinscrew.cli import arguments, output
from pinscrew.cli.progress import progress
from pinscrew.cli.reports import Wanted, report_options
from pinscrew.ground.errors import PinscrewError, PinscrewWarning
from pinscrew.ground.processes import job_count, process_pool
from pinscrew.witnesses.witness import WITNESSES, require

if TYPE_CHECKING:
    from pinscrew.robot.robot import Robot
    from pinscrew.verification.document import Attempt
    from pinscrew.verification.outcome import ReportData
    from pinscrew.verification.report import Report

    _Question: TypeAlias = Callable[[arguments.Named], Attempt]

__all__ = ["command"]

MOST_IN_ONE: Final = 20
"""Robots that are verified in this process; for more, starting others pays."""


@click.command(name="verify", short_help="Compare the answers of both engines on every frame.")
@arguments.robot_argument(required=False)
@click.option("--samples", default=1000, show_default=True, type=click.IntRange(0), help="Random configurations.")
@click.option("--seed", default=0, show_default=True, type=click.IntRange(0), help="Of the random configurations.")
@click.option("--frame", "frames", multiple=True, metavar="FRAME", help="Compare this frame only; may be repeated.")
@click.option(
    "--witness", "witnesses", multiple=True, type=click.Choice(list(WITNESSES)), help="Compare this too; repeatable."
)
@click.option("--all", "everything", is_flag=True, help="Verify every robot known by name, example-robot-data's too.")
@click.option("--jobs", type=click.IntRange(1), help="Processes; by default 1, or all cores above 20 robots.")
@report_options
def command(
    words: tuple[str, ...],
    samples: int,
    seed: int,
    frames: tuple[str, ...],
    witnesses: tuple[str, ...],
    everything: bool,
    jobs: int | None,
    wanted: Wanted,
) -> None:
    """Ask two engines the same questions about each ROBOT, on every frame, and compare the answers.

    Without ROBOT, all robots that come with pinscrew are verified. A witness is another library, compared with the
    PoE engine as Pinocchio is. Exit status: 0 if the engines agree, 1 if they disagree, 2 if a robot could not be
    verified.

    \b
      pinscrew verify
      pinscrew verify scara l1:=0.5 path/to/arm.urdf --junit report.xml
      pinscrew verify --all --samples 100
    """
    from pinscrew.reporting import to_json
    from pinscrew.verification.document import document

    if everything and words:
        raise click.UsageError("--all takes no ROBOT")
    named = arguments.robots(words) or _known(everything)
    asked = tuple(dict.fromkeys(witnesses))
    for witness in asked:
        require(witness)
    question = partial(_attempt, samples=samples, seed=seed, frames=frames, witnesses=asked)
    attempts: list[Attempt] = []
    with progress("verifying", len(named)) as advance:
        for attempt in _each(question, named, jobs):
            attempts.append(attempt)
            _warn(attempt.warnings, brief=everything)
            advance(1, attempt.robot)
    outcome = document(attempts)
    reports = [report for attempt in attempts for report in attempt.reports]
    if wanted.as_json:
        click.echo(to_json(outcome))
    elif len(named) == 1:
        for report in reports:
            _print_checks(report)
    elif reports:
        _print_summary(reports, pairs=bool(asked))
        engines, frame = "all engines" if asked else "both engines", "compared frame" if frames else "frame"
        agreeing = sum(attempt.ok for attempt in attempts)
        click.echo(f"{agreeing} of {len(named)} robots: {engines} agree to rounding error on every {frame}")
    for attempt in attempts:
        for error in attempt.errors:
            output.say(f"pinscrew: {error}", err=True)
    wanted.write(outcome)
    if not all(report.ok for report in reports):
        sys.exit(1)
    if not outcome.ok:
        sys.exit(2)


def _known(everything: bool) -> list[arguments.Named]:
    """The robots that come with pinscrew, and with ``everything`` those of example-robot-data."""
    from pinscrew.description.catalogue import bundled, example_robots

    entries = bundled() + (example_robots() if everything else ())
    return [arguments.Named(entry.name) for entry in entries]


def _each(question: _Question, named: Sequence[arguments.Named], jobs: int | None) -> Iterator[Attempt]:
    """The attempt at each robot, in order, as they come."""
    count = 1 if jobs is None and len(named) <= MOST_IN_ONE else job_count(jobs)
    if count == 1:
        yield from map(question, named)
        return
    with process_pool(count) as (pool, _):
        yield from pool.map(question, named)


def _attempt(
    named: arguments.Named, samples: int, seed: int, frames: tuple[str, ...], witnesses: tuple[str, ...]
) -> Attempt:
    """The reports on one robot, why others could not be made, and what was remarked about its file.

    Where our engines could not be compared, no witness is heard.
    """
    from pinscrew.verification.document import Attempt

    reports: list[Report] = []
    errors: list[PinscrewError] = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", PinscrewWarning)
        try:
            robot = named.load()
            reports.append(_verify(robot, samples, seed, frames))
        except PinscrewError as error:
            errors.append(error)
            witnesses = ()
        for witness in witnesses:
            try:
                reports.append(_verify(robot, samples, seed, frames, witness))
            except PinscrewError as error:
                errors.append(error)
    remarks = tuple(warning.message for warning in caught if isinstance(warning.message, PinscrewWarning))
    return Attempt(named.source, tuple(reports), tuple(errors), remarks)


def _warn(remarks: Sequence[PinscrewWarning], *, brief: bool) -> None:
    """Show the remarks about one robot; in brief the first of them and how many more there are."""
    for remark in remarks[:1] if brief else remarks:
        more = f" (and {len(remarks) - 1} more remarks on this file)" if brief and len(remarks) > 1 else ""
        output.say(f"pinscrew: warning: {remark}{more}", err=True)


def _verify(robot: Robot, samples: int, seed: int, frames: tuple[str, ...], against: str | None = None) -> Report:
    """The report on both engines of ours, or on the PoE engine and a witness."""
    from pinscrew.engines.poe import PoE
    from pinscrew.verification.run import verify
    from pinscrew.witnesses.witness import witness

    engines = None if against is None else (PoE(robot), witness(against, robot))
    return verify(robot, samples, seed, frames=frames or None, engines=engines)


def _print_checks(report: ReportData) -> None:
    """One robot: a line for each check."""
    from rich.text import Text

    from pinscrew.reporting.document import Strong
    from pinscrew.verification.document import table
    from pinscrew.verification.wording import details, summary

    checks = table(report)
    shown = output.table(*checks.columns)
    for row in checks.rows:
        *numbers, mark, where = row
        style = "bold red" if isinstance(mark, Strong) else "green"
        shown.add_row(*numbers, Text(mark, style), where)
    output.console().print(shown)
    output.say(*details(report), summary(report))


def _print_summary(reports: Sequence[ReportData], *, pairs: bool) -> None:
    """Several robots: a line for each report, and what the failed ones have to say; ``pairs`` names the engines."""
    from rich.text import Text

    from pinscrew.verification.wording import details, failures, summary

    table = output.table("robot", "engines", *["compared"] * pairs, "largest error", "frames", "configurations")
    for report in reports:
        mark = Text("agree", "green") if report.ok else Text("DISAGREE", "bold red")
        compared = [", ".join(report.engines)] * pairs
        numbers = (f"{report.largest_difference:.1e}", str(report.frames), str(report.configurations))
        table.add_row(report.robot, mark, *compared, *numbers)
    output.console().print(table)
    for report in reports:
        if not report.ok:
            output.say(summary(report), *failures(report), *details(report))
