"""`diff`: what changed between two robots, as `Changes`, which can be printed and written in every format."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from pinscrew.changes.document import document, failing, passes
from pinscrew.changes.gates import gates
from pinscrew.changes.measuring import measure
from pinscrew.changes.outcome import Change, ChangesData, Tolerance
from pinscrew.changes.wording import worded
from pinscrew.ground.errors import InputError
from pinscrew.reporting.document import Document
from pinscrew.reporting.documented import Documented
from pinscrew.robot.loading import RobotLike, robot_of

__all__ = ["TOLERANCE", "Changes", "diff"]

TOLERANCE: Final = 1e-9
"""Metres, and radians, that count as no change unless told otherwise."""


@dataclass(frozen=True)
class Changes(Documented, ChangesData):
    """What `diff` found between two robots; `ChangesData` lists what it holds. ``print`` shows it as text.

    Its JSON has the schema ``pinscrew.diff/1``, its Markdown a heading and lists.
    """

    @property
    def passes(self) -> bool:
        """Whether the motion is the same, and no note is one to fail on."""
        return passes(self)

    @property
    def failing(self) -> tuple[Change, ...]:
        """The changes, and the notes to fail on."""
        return failing(self)

    def document(self) -> Document:
        """The changes in no format yet."""
        return document(self)


def diff(
    a: RobotLike, b: RobotLike, *, length: float = TOLERANCE, angle: float = TOLERANCE, fail_on: Iterable[str] = ()
) -> Changes:
    """What an edit changed: from robot ``a`` to robot ``b``.

    Two robots are the same if joints of one name (or, where names changed, of one place in the tree) have the same
    screws and are driven by the same coordinates within the same limits, and the leaf frames have the same home
    poses. Origins slid along axes, frames chosen anew, names, order and format are notes. An edit of a joint moves
    everything below it; only that joint is named.

    Args:
        a: the robot before: a robot, or a name or path that `load` takes.
        b: likewise the robot after.
        length: largest displacement of an axis or tip frame, or change of a limit, that counts as none (m).
        angle: likewise largest angle (rad).
        fail_on: what of the notes is to fail `Changes.passes`, such as ``["names", "velocity"]``; docs/diff.md lists
            them.

    Raises:
        InputError: if a tolerance is negative or not finite, or there is no such thing to fail on.
    """
    a, b = robot_of(a), robot_of(b)
    for name, value in (("length", length), ("angle", angle)):
        if not 0.0 <= value < math.inf:
            raise InputError("tolerance", f"{name} = {value} is no tolerance", remedy="give 0 or a positive number")
    measured = measure(a, b, Tolerance(length, angle))
    words = [(difference.kept, worded(difference, measured.tolerance)) for difference in measured.differences]
    return Changes(
        a.name,
        b.name,
        changes=tuple(change for kept, change in words if not kept),
        notes=tuple(change for kept, change in words if kept),
        displacement=measured.displacement,
        file=b.description.file,
        fail_on=gates(fail_on),
        tolerance=measured.tolerance,
    )
