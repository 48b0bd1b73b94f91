"""``pinscrew lock``: keep a robot's mechanism beside its file, and tell when an edit moves it."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from pinscrew.cli import arguments, output
from pinscrew.cli.progress import progress
from pinscrew.cli.reports import Wanted, fail_on_option, report_options
from pinscrew.ground import files
from pinscrew.ground.errors import DescriptionError, PinscrewError

if TYPE_CHECKING:
    from pinscrew.lockfile.checking import LockCheck
    from pinscrew.robot.robot import Robot

__all__ = ["command"]


@click.command(name="lock", short_help="Keep mechanisms in lock files; check that edits don't move them.")
@arguments.robot_argument(required=False)
@click.option("--check", "checking", is_flag=True, help="Compare the robots with their locks; write nothing.")
@click.option("--output", "written", metavar="FILE", help="The lock of one robot; its name ends in .urdf.lock, say.")
@arguments.tip_option
@fail_on_option
@report_options
def command(
    words: tuple[str, ...],
    checking: bool,
    written: str | None,
    tip: str | None,
    fail_on: frozenset[str] | None,
    wanted: Wanted,
) -> None:
    """Write the mechanism of each ROBOT, a file, to a lock beside it: arm.urdf.lock.

    A lock holds names, types, home poses, screw axes, limits and mimics as text that can be read and compared line by
    line. With --check, the robots' files are held against their locks, or against the locks that are named, or,
    without either, against every .urdf.lock and .xacro.lock below the current folder. Frames of links that move
    with their parent may be placed anew; a joint, a screw or a tip may not.

    The lock of a xacro file holds the arguments that were given; name the lock itself to write it anew with them.
    With --fail-on a lock also holds what of the notes fails its check; given to --check, it comes before that. Where
    neither says anything, fail_on in [tool.pinscrew] of pyproject.toml does. Exit status: 0 if no mechanism moved, 1 if
    one did or a note fails, 2 if a lock is missing or anything could not be read.

    \b
      pinscrew lock path/to/arm.urdf
      pinscrew lock path/to/arm.urdf --check
      pinscrew lock path/to/arm.urdf.lock
    """
    if not checking:
        if wanted.files or wanted.github:
            raise click.UsageError("there is something to report with --check only")
        _write(words, written, tip, fail_on, as_json=wanted.as_json)
        return
    if written is not None or tip is not None or arguments.options()["floating_base"]:
        raise click.UsageError("--check takes output, tip and floating base from the locks")
    _check(words, fail_on, wanted)


# ------------------------------------------------------------------------------------------------- writing


def _write(
    words: Sequence[str], written: str | None, tip: str | None, fail_on: frozenset[str] | None, *, as_json: bool
) -> None:
    from pinscrew.lockfile.writing import text

    named = arguments.robots(words)
    if not named:
        raise click.UsageError("name the robots' files, or --check the locks that there are")
    if written is not None and len(named) > 1:
        raise click.UsageError("--output takes one robot")
    texts: dict[Path, str] = {}
    with progress("reading", len(named)) as advance:
        for asked in named:
            path, robot = _robot(asked, written, tip)
            if path in texts:
                raise click.UsageError(f"two robots for the lock {path}; name one of them with --output")
            texts[path] = text(robot, path, fail_on=_kept(path) if fail_on is None else fail_on)
            advance(1, asked.source)
    changed = [path for path, content in texts.items() if not _holds(path, content)]
    for path in changed:
        files.check(path)  # all are written, or none
    for path in changed:
        output.write_file(path, texts[path])
    if as_json:
        rows = [{"lock": str(path), "written": path in changed} for path in texts]
        output.print_json({"schema": "pinscrew.locked/1", "locks": rows})
        return
    for path in texts:
        click.echo(f"{path}: {'written' if path in changed else 'unchanged'}")


def _robot(named: arguments.Named, written: str | None, tip: str | None) -> tuple[Path, Robot]:
    """Where a robot's lock goes, and the robot."""
    from pinscrew.lockfile.checking import reload
    from pinscrew.lockfile.places import beside, check_source, is_lock
    from pinscrew.lockfile.reading import read_lock
    from pinscrew.lockfile.writing import content

    if is_lock(named.source):
        if named.arguments or written is not None or tip is not None or named.options["floating_base"]:
            raise click.UsageError(f"{named.source} has arguments, tip and base of its own; name the robot's file")
        lock = read_lock(Path(named.source))
        options = {name: value for name, value in named.options.items() if name != "floating_base"}
        return lock.path, reload(lock, **options)
    if written is None:
        path = beside(named.source)
    elif is_lock(written):
        path = Path(written)
    else:
        what = "the lock's name ends in none of .urdf.lock, .xacro.lock and .xml.lock, so --check would not find it"
        raise DescriptionError("lock-name", what, file=written, remedy=f"call it {written}.urdf.lock, say")
    named.options = {**named.options, "tip": tip}
    robot = named.load()
    check_source(path, content(robot, path).source, allow_outside=named.options["allow_outside"])
    _keep_arguments(path, robot)
    return path, robot


def _keep_arguments(path: Path, robot: Robot) -> None:
    """Refuse to write over a lock that was made in another way, so that no argument is lost unnoticed."""
    from pinscrew.lockfile.reading import read_lock

    try:
        held = read_lock(path).content
    except DescriptionError:  # there is none, or none that could be of use
        return
    ways = (held.arguments, held.floating_base, held.tip)
    if ways != (robot.description.arguments, robot.floating_base, robot.default_tip):
        made = [f"{name}:={value}" for name, value in held.arguments.items()]
        made += ["--floating-base"] * held.floating_base + [f"--tip {held.tip}"] * (held.tip is not None)
        what = f"it was made with {' '.join(made) or 'no arguments'}, and not as this one would be"
        remedy = "name the lock to write it anew as it is, another one with --output, or remove it"
        raise DescriptionError("lock-arguments", what, file=path, remedy=remedy)


def _kept(path: Path) -> frozenset[str] | None:
    """What a lock that is to be written anew says of what fails."""
    from pinscrew.lockfile.reading import read_lock

    try:
        return read_lock(path).content.fail_on
    except DescriptionError:
        return None


def _holds(path: Path, content: str) -> bool:
    """Whether a file has this content already."""
    try:
        with files.open_plain(path) as stream:
            wanted = content.encode("utf-8")
            return stream.read(len(wanted) + 1) == wanted
    except OSError:
        return False


# ------------------------------------------------------------------------------------------------ checking


def _check(words: Sequence[str], fail_on: frozenset[str] | None, wanted: Wanted) -> None:
    from pinscrew.changes import gates
    from pinscrew.lockfile.checking import check
    from pinscrew.lockfile.document import document
    from pinscrew.reporting import to_json, to_text

    options = {name: value for name, value in arguments.options().items() if name != "floating_base"}
    paths = _locks(words)
    otherwise = gates.fail_on(Path.cwd())
    checked: list[LockCheck] = []
    errors: list[tuple[Path, PinscrewError]] = []
    with progress("checking", len(paths)) as advance:
        for path, source in paths:
            try:
                checked.append(check(path, source=source, fail_on=fail_on, otherwise=otherwise, **options))
            except PinscrewError as error:
                errors.append((path, error))
            advance(1, str(path))
    outcome = document(checked, errors)
    tried = tuple(account for account in outcome.accounts if account.tried)  # errors go to standard error
    click.echo(to_json(outcome) if wanted.as_json else to_text(replace(outcome, accounts=tried)))
    for _, failure in errors:
        click.echo(f"pinscrew: {failure}", err=True)
    wanted.write(outcome)
    if not all(lock.passes for lock in checked):
        sys.exit(1)
    if errors:
        sys.exit(2)


def _locks(words: Sequence[str]) -> list[tuple[Path, Path | None]]:
    """The locks that are named, or belong to the files that are, with these, or else all below the current folder."""
    from pinscrew.lockfile.places import below, beside, is_lock

    paths: list[tuple[Path, Path | None]] = []
    for asked in arguments.robots(words):
        if asked.arguments:
            raise click.UsageError("--check takes the xacro arguments from the locks")
        file = Path(asked.source)
        paths.append((file, None) if is_lock(file) else (beside(asked.source), file))
    if not words:
        paths = [(path, None) for path in below(Path())]
    if not paths:
        what = "there is no .urdf.lock and no .xacro.lock here or below"
        raise DescriptionError("not-locked", what, file=os.curdir, remedy="write some with pinscrew lock FILE")
    return paths
