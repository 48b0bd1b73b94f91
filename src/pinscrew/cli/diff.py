"""``pinscrew diff``: what an edit to a robot's description changed."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import replace
from os.path import relpath
from pathlib import Path
from typing import TYPE_CHECKING

import click

from pinscrew.cli import arguments
from pinscrew.cli.reports import Wanted, fail_on_option, report_options
from pinscrew.ground.errors import PinscrewError

if TYPE_CHECKING:
    from pinscrew.reporting.document import Document
    from pinscrew.robot.robot import Robot

__all__ = ["command"]


@click.command(name="diff", short_help="Say what an edit changed in a robot's motion.")
@arguments.robot_argument()
@click.option(
    "--tolerance-mm",
    "length",
    default="1e-6",
    show_default=True,
    metavar="LENGTH",
    callback=arguments.amount("m", plain=1e-3),
    help="Largest displacement that counts as none: a number of mm, or such as 0.01mm.",
)
@click.option(
    "--tolerance-deg",
    "angle",
    metavar="ANGLE",
    callback=arguments.amount("rad", plain=math.pi / 180.0),
    help="Largest angle that counts as none: a number of degrees, or such as 0.01rad; by default 1e-9rad.",
)
@fail_on_option
@report_options
def command(
    words: tuple[str, ...],
    length: float,
    angle: float | None,
    fail_on: frozenset[str] | None,
    wanted: Wanted,
) -> None:
    """Compare the motion of two robots: screws, limits, mimics and the poses of tip frames.

    Each is a robot, a lock file (.lock), or a file in a git revision. What moves neither joints nor tips is a note:
    frames chosen anew, names, order; --fail-on, or fail_on in [tool.pinscrew] of pyproject.toml, lets notes fail. Exit
    status: 0 if the motion is the same, 1 if it changed or a note fails, 2 for an error.

    \b
      pinscrew diff HEAD~1:arm.urdf arm.urdf
      pinscrew diff main:./arm.urdf.xacro arm.urdf.xacro --tolerance-mm 0.01
      pinscrew diff scara scara l1:=0.4
    """
    from pinscrew.changes import gates
    from pinscrew.changes.run import TOLERANCE, diff

    named = arguments.robots(words)
    if len(named) != 2:
        raise click.UsageError(f"expected two robots, but got {len(named)}")
    try:
        a, b = (_load(robot) for robot in named)
    except PinscrewError as error:
        wanted.write(_failed(named, error))
        raise
    to_fail = gates.fail_on(Path.cwd()) if fail_on is None else fail_on
    changes = diff(a, b, length=length, angle=TOLERANCE if angle is None else angle, fail_on=to_fail)
    changes = replace(changes, a=_called(named[0]), b=_called(named[1]), file=_file(named[1], changes.file))
    wanted.write(changes.document())
    click.echo(changes.to_json() if wanted.as_json else str(changes))
    if not changes.passes:
        sys.exit(1)


def _called(named: arguments.Named) -> str:
    """A robot as the command line has it."""
    return " ".join([named.source, *(f"{name}:={value}" for name, value in named.arguments.items())])


def _failed(named: Sequence[arguments.Named], error: PinscrewError) -> Document:
    """What the reports tell where the two could not be compared."""
    from pinscrew.changes.document import failure

    return failure(" → ".join(map(_called, named)), error)


def _file(named: arguments.Named, file: str) -> str:
    """The file that findings are about: for one of a revision, that of the working tree."""
    from pinscrew.changes import revision

    return revision.working_file(named.source) if revision.is_revision(named.source) else file


def _load(named: arguments.Named) -> Robot:
    """The robot of a name, a file, a lock file or a file in a revision."""
    from pinscrew.changes import revision

    if not revision.is_revision(named.source):
        return _read(named.source, named)
    with revision.taken_out(named.source) as path:
        robot = _read(str(path), named)
    # The files that it includes were in a temporary folder, which is of no use to anyone.
    joints = [
        replace(joint, file=joint.file and relpath(joint.file, path.parent)) for joint in robot.description.joints
    ]
    return replace(robot, description=replace(robot.description, joints=tuple(joints)))


def _read(source: str, named: arguments.Named) -> Robot:
    if not source.endswith(".lock"):
        return replace(named, source=source).load()
    from pinscrew.lockfile import read

    if named.arguments:
        raise click.UsageError(f"the lock file {named.source} takes no arguments")
    return read(Path(source))
