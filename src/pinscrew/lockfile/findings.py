"""A checked lock as findings, at the lines of the joints that were edited."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pinscrew.ground.words import one_line
from pinscrew.reporting.model import Finding, Level
from pinscrew.reporting.troubles import expanded

if TYPE_CHECKING:
    from pinscrew.changes.outcome import Change
    from pinscrew.lockfile.checking import Checked

__all__ = ["from_checked"]


def from_checked(checked: Checked) -> list[Finding]:
    """An error for each change of the mechanism, and a note for each edit that does not change it."""
    if checked.changes is None:
        return []
    moved = [_finding(checked, change, "moved", "error") for change in checked.changes.changes]
    return moved + [_finding(checked, note, "placed-anew", "note") for note in checked.changes.notes]


def _finding(checked: Checked, change: Change, rule: str, level: Level) -> Finding:
    file = checked.robot.description.file
    line, at = expanded(file, change.line)
    return Finding(rule, level, f"{one_line(change.words)}{at}", file, line, str(checked.lock))
