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
    from pinscrew.reporting.model import Finding
    from pinscrew.robot.robot import Robot
    from pinscrew.verification.report import Report

    _Outcome: TypeAlias = tuple[list[Report], list[PinscrewError], list[PinscrewWarning], list[Finding]]
    _Question: TypeAlias = Callable[[arguments.Named], _Outcome]

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
    from pinscrew.verification import formats

    if everything and words:
        raise click.UsageError("--all takes no ROBOT")
    named = arguments.robots(words) or _known(everything)
    asked = tuple(dict.fromkeys(witnesses))
    for witness in asked:
        require(witness)
    question = partial(_outcome, samples=samples, seed=seed, frames=frames, witnesses=asked)
    agreeing = 0
    reports: list[Report] = []
    errors: list[formats.Unverified] = []
    findings: list[Finding] = []
    with progress("verifying", len(named)) as advance:
        for one, (compared, failed, remarks, found) in zip(named, _each(question, named, jobs), strict=True):
            reports += compared
            errors += [formats.Unverified(one.source, error) for error in failed]
            agreeing += not failed and all(report.ok for report in compared)
            findings += found
            _warn(remarks, brief=everything)
            advance(1, one.source)
    if wanted.as_json:
        click.echo(formats.to_json(reports, errors))
    elif len(named) == 1:
        for report in reports:
            _print_checks(report)
    elif reports:
        _print_summary(reports, pairs=bool(asked))
        engines, frame = "all engines" if asked else "both engines", "compared frame" if frames else "frame"
        click.echo(f"{agreeing} of {len(named)} robots: {engines} agree to rounding error on every {frame}")
    for unverified in errors:
        click.echo(f"pinscrew: {unverified.error}", err=True)
    wanted.write(
        "pinscrew verify",
        findings,
        junit=lambda: formats.to_junit(reports, errors),
        markdown=lambda: formats.to_markdown(reports, errors),
    )
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
    count = 1 if jobs is None and len(named) <= MOST_IN_ONE else job_count(jobs)
    if count == 1:
        yield from map(question, named)
        return
    with process_pool(count) as (pool, _):
        yield from pool.map(question, named)


def _outcome(
    named: arguments.Named, samples: int, seed: int, frames: tuple[str, ...], witnesses: tuple[str, ...]
) -> _Outcome:
    """The reports on one robot, why others could not be made, what was remarked about its file, all of it as findings.

    Where our engines could not be compared, no witness is heard.
    """
    from pinscrew.reporting.troubles import from_error, from_warning
    from pinscrew.verification.findings import from_report

    reports: list[Report] = []
    errors: list[PinscrewError] = []
    findings: list[Finding] = []
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
    remarks = [one.message for one in caught if isinstance(one.message, PinscrewWarning)]
    findings += (from_warning(remark, named.source) for remark in remarks)
    findings += (found for report in reports for found in from_report(report, robot.description))
    findings += (from_error(error, named.source) for error in errors)
    return reports, errors, remarks, findings


def _warn(remarks: Sequence[PinscrewWarning], *, brief: bool) -> None:
    """Show the remarks about one robot; in brief the first of them and how many more there are."""
    for remark in remarks[:1] if brief else remarks:
        more = f" (and {len(remarks) - 1} more remarks on this file)" if brief and len(remarks) > 1 else ""
        click.echo(f"pinscrew: warning: {remark}{more}", err=True)


def _verify(robot: Robot, samples: int, seed: int, frames: tuple[str, ...], against: str | None = None) -> Report:
    """The report on both engines of ours, or on the PoE engine and a witness."""
    from pinscrew.engines.poe import PoE
    from pinscrew.verification.run import verify
    from pinscrew.witnesses.witness import witness

    engines = None if against is None else (PoE(robot), witness(against, robot))
    return verify(robot, samples, seed, frames=frames or None, engines=engines)


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


def _print_summary(reports: Sequence[Report], *, pairs: bool) -> None:
    """Several robots: a line for each report, and what the failed ones have to say; ``pairs`` names the engines."""
    from rich.text import Text

    from pinscrew.verification import formats

    table = output.table("robot", "engines", *["compared"] * pairs, "largest error", "frames", "configurations")
    for report in reports:
        mark = Text("agree", "green") if report.ok else Text("DISAGREE", "bold red")
        compared = [Text(", ".join(report.engines))] * pairs
        numbers = (f"{report.largest_difference:.1e}", str(report.frames), str(report.configurations))
        table.add_row(Text(report.robot), mark, *compared, *numbers)
    output.console().print(table)
    for report in reports:
        if not report.ok:
            click.echo("\n".join((formats.summary(report), *formats.failures(report), *formats.details(report))))
