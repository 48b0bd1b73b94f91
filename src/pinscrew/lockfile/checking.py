"""Whether a robot's file still describes the mechanism that its lock holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from pinscrew.description.packages import is_file
from pinscrew.ground.errors import DescriptionError
from pinscrew.lockfile.reading import Lock, read_lock
from pinscrew.lockfile.writing import fingerprint
from pinscrew.robot.loading import load
from pinscrew.robot.robot import Robot

if TYPE_CHECKING:
    from pinscrew.changes.changes import Changes

__all__ = ["TOLERANCE", "Checked", "check", "reload"]

TOLERANCE: Final = 1e-9
"""Radians, and metres in a robot of up to 1 m, that are no change: far above the rounding to 12 digits."""


@dataclass(frozen=True, slots=True)
class Checked:
    """A lock compared with its robot's file.

    Attributes:
        lock: the lock file.
        robot: the robot as its file has it now.
        changes: what is different, in the sense from the lock to the file; None where the fingerprints are equal.
    """

    lock: Path
    robot: Robot
    changes: Changes | None

    @property
    def same(self) -> bool:
        """Whether the mechanism is the one that the lock holds."""
        return self.changes is None or self.changes.same


def check(
    path: str | Path, *, packages: Mapping[str, str | Path] | None = None, allow_outside: bool = False
) -> Checked:
    """Compare a lock with the robot's file, read anew with the arguments that the lock names.

    Where the fingerprints are equal, so are the mechanisms; else they are compared with a tolerance of 1e-9 rad and
    1e-9 · max(1, size of the robot) m, which is far above the lock's rounding.

    Args:
        path: the lock file.
        packages: roots of ROS packages, as for `pinscrew.load`.
        allow_outside: let a xacro file read files outside its own folder, as for `pinscrew.load`.

    Raises:
        DescriptionError: if the lock or the robot's file can't be used, or the latter is not there.
        UnknownNameError: if the robot has no longer the frame that was its tip.
    """
    lock = read_lock(path)
    robot = reload(lock, packages=packages, allow_outside=allow_outside)
    if fingerprint(robot) == lock.document.hash:
        return Checked(lock.path, robot, None)
    from pinscrew.changes.run import diff

    locked = lock.robot()
    length = TOLERANCE * max(1.0, locked.reach, robot.reach)
    return Checked(lock.path, robot, diff(locked, robot, length=length, angle=TOLERANCE))


def reload(lock: Lock, *, packages: Mapping[str, str | Path] | None = None, allow_outside: bool = False) -> Robot:
    """The robot of a lock, read from its file as that is now; see `check`."""
    held = lock.document
    if not is_file(lock.source):
        what = f"there is no {held.source!r}, from which it was made"
        remedy = "put the file back, or remove the lock"
        raise DescriptionError("lock-source", what, file=lock.path, remedy=remedy)
    return load(
        lock.source,
        floating_base=held.floating_base,
        tip=held.tip,
        arguments=held.arguments,
        packages=packages,
        allow_outside=allow_outside,
    )
