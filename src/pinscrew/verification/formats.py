"""Reports for people and programs: text, JSON, JUnit XML, Markdown."""

from __future__ import annotations

import importlib.metadata
import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from pinscrew.ground.errors import PinscrewError
from pinscrew.ground.words import one_line
from pinscrew.reporting import junit
from pinscrew.reporting.markdown import cell
from pinscrew.verification.outcome import Check, ReportData

__all__ = [
    "SCHEMA",
    "Unverified",
    "details",
    "failures",
    "place",
    "summary",
    "to_json",
    "to_junit",
    "to_markdown",
    "to_text",
]

SCHEMA: Final = "pinscrew.verify/1"

_WITNESSES: Final = {"MuJoCo": "mujoco", "roboticstoolbox": "roboticstoolbox-python"}
"""The packages of engines that are optional."""


@dataclass(frozen=True, slots=True)
class Unverified:
    """A robot that could not be verified, and why."""

    robot: str
    error: PinscrewError


def summary(report: ReportData) -> str:
    """One line: what was compared, and the outcome."""
    outcome = "agree" if report.ok else "DISAGREE"
    return (
        f"{one_line(report.robot)}: {report.engines[0]} and {report.engines[1]} {outcome} on {report.frames} frames "
        f"at {report.configurations} configurations (seed {report.seed})"
    )


def place(check: Check) -> str:
    """Where the largest error is, in a few words."""
    found = check.place
    parts = (
        found.frame and f"frame {found.frame}",
        found.joint and f"joint {found.joint}",
        found.configuration,
    )
    return one_line(", ".join(part for part in parts if part))


def to_text(report: ReportData) -> str:
    """A table, with the diagnosis below it."""
    rows = [("check", "error", "tolerance", "", "largest at")]
    rows += [
        (c.name, f"{c.error:.1e}", f"{c.tolerance:.1e}", "ok" if c.ok else "FAIL", place(c)) for c in report.checks
    ]
    widths = [max(len(row[i]) for row in rows) for i in range(5)]
    lines = [summary(report)]
    lines += ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    lines += details(report)
    return "\n".join(lines)


def details(report: ReportData) -> list[str]:
    """What a failed report has to say beside its table."""
    lines = [*(remark for check in report.failed for remark in check.remarks), *report.diagnosis]
    lines += [f"{c.name}: largest at q = {list(c.place.q)}" for c in report.failed if c.place.q][:1]
    return list(dict.fromkeys(lines))  # remarks that explain a failure are in the diagnosis too


def failures(report: ReportData) -> list[str]:
    """One line for each failed check."""
    return [f"{c.name}: error {c.error:.1e} above {c.tolerance:.1e}{_largest_at(c)}" for c in report.failed]


def _largest_at(check: Check) -> str:
    return f", largest at {place(check)}" if place(check) else ""


def to_json(reports: Sequence[ReportData], errors: Sequence[Unverified] = ()) -> str:
    """The reports as JSON, schema `SCHEMA`. An infinite error (NaN in an answer) is the string ``"inf"``."""
    packages = ["pinscrew", "pin", "yourdfpy", "numpy"]
    packages += sorted({_WITNESSES[name] for report in reports for name in report.engines if name in _WITNESSES})
    versions = {name: importlib.metadata.version(name) for name in packages}
    document = {
        "schema": SCHEMA,
        "versions": versions,
        "ok": not errors and all(report.ok for report in reports),
        "robots": [_as_data(report) for report in reports],
        "errors": [{"robot": e.robot, "code": e.error.code, "message": str(e.error)} for e in errors],
    }
    return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False)


def _as_data(report: ReportData) -> dict[str, Any]:
    return {
        "robot": report.robot,
        "file": report.file,
        "arguments": dict(report.arguments),
        "engines": list(report.engines),
        "ok": report.ok,
        "frames": report.frames,
        "samples": report.samples,
        "configurations": report.configurations,
        "seed": report.seed,
        "tolerance": report.tolerance,
        "reach": report.reach,
        "worst": report.worst.name,
        "checks": [
            {
                "name": check.name,
                "ok": check.ok,
                "error": check.error if check.error < float("inf") else "inf",
                "tolerance": check.tolerance,
                "frame": check.place.frame,
                "joint": check.place.joint,
                "configuration": check.place.configuration,
                "q": list(check.place.q),
                "remarks": list(check.remarks),
            }
            for check in report.checks
        ],
        "diagnosis": list(report.diagnosis),
    }


def to_junit(reports: Sequence[ReportData], errors: Sequence[Unverified] = ()) -> str:
    """The reports as JUnit XML: a suite for each robot, a case for each check."""
    suites = [junit.Suite(_title(report), [_case(report, check) for check in report.checks]) for report in reports]
    for one in errors:
        problem = junit.Problem("error", str(one.error), one.error.code)
        suites.append(junit.Suite(one.robot, [junit.Case("verify", problem)]))
    return junit.document("pinscrew verify", suites)


def _title(report: ReportData) -> str:
    """The robot, and the engines where they are not those that `verify` compares unless told otherwise."""
    robot, engines = report.robot, " and ".join(report.engines)
    return robot if engines == "PoE and Pinocchio" else f"{robot} ({engines})"


def _case(report: ReportData, check: Check) -> junit.Case:
    if check.ok:
        return junit.Case(check.name)
    message = f"error {check.error:.3e} above {check.tolerance:.3e}{_largest_at(check)}"
    lines = dict.fromkeys((*check.remarks, *report.diagnosis, f"q = {list(check.place.q)}"))
    return junit.Case(check.name, junit.Problem("failure", message, "disagreement", "\n".join(lines)))


def to_markdown(reports: Sequence[ReportData], errors: Sequence[Unverified] = ()) -> str:
    """The reports as Markdown: a line and a table for each."""
    lines: list[str] = []
    for report in reports:
        lines += [f"### {cell(summary(report))}", "", "| check | error | tolerance | | largest at |"]
        lines += ["|---|---|---|---|---|"]
        for check in report.checks:
            mark = "ok" if check.ok else "**FAIL**"
            where = cell(place(check))
            lines.append(f"| {cell(check.name)} | {check.error:.1e} | {check.tolerance:.1e} | {mark} | {where} |")
        lines.append("")
        if not report.ok:
            lines += [*(f"- {cell(line)}" for line in details(report)), ""]
    for unverified in errors:
        lines += [
            f"### {cell(unverified.robot)}: could not be verified",
            "",
            cell(str(unverified.error)),
            "",
        ]
    return "\n".join(lines)
