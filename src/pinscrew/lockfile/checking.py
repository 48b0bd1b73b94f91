"""Whether a robot's file still describes the mechanism that its lock holds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from pinscrew.changes.gates import gates
from pinscrew.changes.run import diff
from pinscrew.description.packages import is_file
from pinscrew.ground.errors import DescriptionError
from pinscrew.lockfile.document import document
from pinscrew.lockfile.outcome import LockCheckData
from pinscrew.lockfile.places import check_source
from pinscrew.lockfile.reading import Lock, read_lock
from pinscrew.lockfile.writing import fingerprint
from pinscrew.reporting.document import Document
from pinscrew.reporting.documented import Documented
from pinscrew.robot.loading import load
from pinscrew.robot.robot import Robot

__all__ = ["TOLERANCE", "LockCheck", "check", "reload"]

TOLERANCE: Final = 1e-9
"""Radians, and metres in a robot of up to 1 m, that are no change: far above the rounding to 12 digits."""


@dataclass(frozen=True)
class LockCheck(Documented, LockCheckData):
    """A lock compared with its robot's file; `LockCheckData` lists what it holds. ``print`` shows it as text.

    Its JSON has the schema ``pinscrew.lock-check/1``.
    """

    def document(self) -> Document:
        """The check in no format yet."""
        return document([self])


def check(
    path: str | Path,
    *,
    source: str | Path | None = None,
    packages: Mapping[str, str | Path] | None = None,
    allow_outside: bool = False,
    strict: bool = False,
    fail_on: Iterable[str] | None = None,
    otherwise: Iterable[str] = (),
) -> LockCheck:
    """Compare a lock with the robot's file, read anew with the arguments that the lock names.

    Where the fingerprints are equal, so are the mechanisms; else they are compared with a tolerance of 1e-9 rad and
    1e-9 · max(1, size of the robot) m, which is far above the lock's rounding.

    Args:
        path: the lock file.
        source: the robot's file that it must have been made from; by default the one that it stands beside, if any.
        packages: roots of ROS packages, as for `pinscrew.load`.
        allow_outside: let the robot's file be outside the lock's folder, and a xacro file read files outside its own,
            as for `pinscrew.load`.
        strict: refuse what is warned of otherwise, as for `pinscrew.load`.
        fail_on: what of the notes is to fail, such as ``["names", "velocity"]``; by default what the lock says.
        otherwise: that, where the lock does not say either.

    Raises:
        DescriptionError: if the lock or the robot's file can't be used, the latter is not there, is another file, or is
            outside the lock's folder.
        InputError: if there is no such thing to fail on.
        UnknownNameError: if the robot has no longer the frame that was its tip.
    """
    lock = read_lock(path)
    kept = lock.content.fail_on
    asked = gates(fail_on if fail_on is not None else kept if kept is not None else otherwise)
    robot = reload(lock, source=source, packages=packages, allow_outside=allow_outside, strict=strict)
    if fingerprint(robot) == lock.content.hash and robot.description.name == lock.content.robot:
        return LockCheck(lock.path, robot, None)
    locked = lock.robot()
    length = TOLERANCE * max(1.0, locked.reach, robot.reach)
    return LockCheck(
        lock.path,
        robot,
        diff(locked, robot, length=length, angle=TOLERANCE, fail_on=asked),
    )


def reload(
    lock: Lock,
    *,
    source: str | Path | None = None,
    packages: Mapping[str, str | Path] | None,
    allow_outside: bool,
    strict: bool,
) -> Robot:
    """The robot of a lock, read from its file as that is now; see `check`."""
    content = lock.content
    named = None if source is None else Path(source)
    check_source(lock.path, content.source, named=named, allow_outside=allow_outside)
    if not is_file(lock.source):
        what = f"there is no {content.source!r}, from which it was made"
        remedy = "put the file back, or remove the lock"
        raise DescriptionError("lock-source", what, file=lock.path, remedy=remedy)
    return load(
        lock.source,
        floating_base=content.floating_base,
        tip=content.tip,
        arguments=content.arguments,
        packages=packages,
        allow_outside=allow_outside,
        strict=strict,
    )
