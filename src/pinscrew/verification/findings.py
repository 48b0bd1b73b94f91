"""A report as findings, at the lines of the joints that it blames."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pinscrew.ground.words import one_line
from pinscrew.reporting.model import Finding
from pinscrew.reporting.troubles import expanded
from pinscrew.verification.formats import failures

if TYPE_CHECKING:
    from pinscrew.description.model import Description
    from pinscrew.verification.outcome import ReportData

__all__ = ["from_report"]


def from_report(report: ReportData, description: Description) -> list[Finding]:
    """A finding for each line of a report's diagnosis; none if the engines agree.

    Args:
        report: the report.
        description: of the robot that was verified; it knows the lines of its joints.
    """
    if report.ok:
        return []
    lines = {joint.name: joint.line for joint in description.joints}
    what = [(one_line(words), lines.get(joint)) for words, joint in zip(report.diagnosis, report.blamed, strict=True)]
    worst = failures(report)[0]
    found = []
    for words, line in what or [("the engines disagree", None)]:
        place, at = expanded(report.file, line)
        found.append(Finding("disagreement", "error", f"{words}{at} ({worst})", report.file, place, report.robot))
    return found
