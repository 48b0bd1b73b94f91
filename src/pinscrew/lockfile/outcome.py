"""What the check of a lock finds, as plain data."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from pinscrew.changes.run import Changes
from pinscrew.robot.robot import Robot

__all__ = ["LockCheckData"]


@dataclass(frozen=True, slots=True)
class LockCheckData:
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

    @property
    def passes(self) -> bool:
        """Whether the mechanism is that of the lock, and no note is one to fail on."""
        return self.changes is None or self.changes.passes
