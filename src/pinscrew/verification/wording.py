"""What a report says, in lines."""

from __future__ import annotations

from pinscrew.ground.words import one_line
from pinscrew.verification.outcome import Check, ReportData

__all__ = ["details", "failures", "largest_at", "place", "summary"]


def summary(report: ReportData) -> str:
    """One line: what was compared, and the outcome."""
    outcome = "agree" if report.ok else "DISAGREE"
    return (
        f"{one_line(report.robot)}: {report.engines[0]} and {report.engines[1]} {outcome} on {report.frames} frames "
        f"at {report.configurations} configurations (seed {report.seed})"
    )


def place(check: Check) -> str:
    """Where the largest error of a check is, in a few words; ``""`` where it is nowhere."""
    at = check.place
    parts = (at.frame and f"frame {at.frame}", at.joint and f"joint {at.joint}", at.configuration)
    return one_line(", ".join(part for part in parts if part))


def largest_at(check: Check) -> str:
    """`place`, as it is added to a sentence."""
    return f", largest at {place(check)}" if place(check) else ""


def details(report: ReportData) -> list[str]:
    """What a failed report has to say beside its table."""
    lines = [*(remark for check in report.failed for remark in check.remarks), *report.diagnosis]
    lines += [f"{c.name}: largest at q = {list(c.place.q)}" for c in report.failed if c.place.q][:1]
    return list(dict.fromkeys(lines))  # remarks that explain a failure are in the diagnosis too


def failures(report: ReportData) -> list[str]:
    """One line for each failed check."""
    return [f"{c.name}: error {c.error:.1e} above {c.tolerance:.1e}{largest_at(c)}" for c in report.failed]
