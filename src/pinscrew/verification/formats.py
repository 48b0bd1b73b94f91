"""Reports for people and programs: text, JSON, JUnit XML, Markdown."""

from __future__ import annotations

import importlib.metadata
import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final
from xml.etree import ElementTree as ET

from pinscrew.errors import PinscrewError
from pinscrew.verification.report import Check, Report

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

_NOT_XML: Final = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""What XML 1.0 has no way to write; a file's name may hold it."""


@dataclass(frozen=True, slots=True)
class Unverified:
    """A robot that could not be verified, and why."""

    robot: str
    error: PinscrewError


def summary(report: Report) -> str:
    """One line: what was compared, and the outcome."""
    outcome = "agree" if report.ok else "DISAGREE"
    return (
        f"{_line(report.robot)}: {report.engines[0]} and {report.engines[1]} {outcome} on {report.frames} frames "
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
    return _line(", ".join(part for part in parts if part))


def _line(text: str) -> str:
    """Text without line breaks; names may hold them."""
    return " ".join(text.split())


def to_text(report: Report) -> str:
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


def details(report: Report) -> list[str]:
    """What a failed report has to say beside its table."""
    lines = [*(remark for check in report.failed for remark in check.remarks), *report.diagnosis]
    lines += [f"{c.name}: largest at q = {list(c.place.q)}" for c in report.failed if c.place.q][:1]
    return list(dict.fromkeys(lines))  # remarks that explain a failure are in the diagnosis too


def failures(report: Report) -> list[str]:
    """One line for each failed check."""
    return [f"{c.name}: error {c.error:.1e} above {c.tolerance:.1e}, largest at {place(c)}" for c in report.failed]


def to_json(reports: Sequence[Report], errors: Sequence[Unverified] = ()) -> str:
    """The reports as JSON, schema `SCHEMA`. An infinite error (NaN in an answer) is the string ``"inf"``."""
    versions = {name: importlib.metadata.version(name) for name in ("pinscrew", "pin", "yourdfpy", "numpy")}
    document = {
        "schema": SCHEMA,
        "versions": versions,
        "ok": not errors and all(report.ok for report in reports),
        "robots": [_as_data(report) for report in reports],
        "errors": [{"robot": e.robot, "code": e.error.code, "message": str(e.error)} for e in errors],
    }
    return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False)


def _as_data(report: Report) -> dict[str, Any]:
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


def to_junit(reports: Sequence[Report], errors: Sequence[Unverified] = ()) -> str:
    """The reports as JUnit XML: a suite for each robot, a case for each check."""
    root = ET.Element("testsuites", name="pinscrew verify")
    for report in reports:
        suite = _suite(root, report.robot, tests=len(report.checks), failures=len(report.failed), errors=0)
        for check in report.checks:
            case = _case(suite, check.name)
            if not check.ok:
                message = f"error {check.error:.3e} above {check.tolerance:.3e}, largest at {place(check)}"
                failure = ET.SubElement(case, "failure", message=message, type="disagreement")
                lines = dict.fromkeys((*check.remarks, *report.diagnosis, f"q = {list(check.place.q)}"))
                failure.text = "\n".join(lines)
    for unverified in errors:
        case = _case(_suite(root, unverified.robot, tests=1, failures=0, errors=1), "verify")
        ET.SubElement(case, "error", message=str(unverified.error), type=unverified.error.code)
    for name in ("tests", "failures", "errors"):
        root.set(name, str(sum(int(suite.get(name, "0")) for suite in root)))
    ET.indent(root)
    document = '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"
    return _NOT_XML.sub("\N{REPLACEMENT CHARACTER}", document)


def _suite(root: ET.Element, robot: str, **counts: int) -> ET.Element:
    suite = ET.SubElement(root, "testsuite", name=robot, skipped="0")
    for name, count in counts.items():
        suite.set(name, str(count))
    return suite


def _case(suite: ET.Element, name: str) -> ET.Element:
    return ET.SubElement(suite, "testcase", classname=f"pinscrew.{suite.get('name')}", name=name)


def to_markdown(reports: Sequence[Report], errors: Sequence[Unverified] = ()) -> str:
    """The reports as Markdown: a line and a table for each."""
    lines: list[str] = []
    for report in reports:
        lines += [f"### {_cell(summary(report))}", "", "| check | error | tolerance | | largest at |"]
        lines += ["|---|---|---|---|---|"]
        for check in report.checks:
            mark = "ok" if check.ok else "**FAIL**"
            where = _cell(place(check))
            lines.append(f"| {_cell(check.name)} | {check.error:.1e} | {check.tolerance:.1e} | {mark} | {where} |")
        lines.append("")
        if not report.ok:
            lines += [*(f"- {_cell(line)}" for line in details(report)), ""]
    for unverified in errors:
        lines += [
            f"### {_cell(unverified.robot)}: could not be verified",
            "",
            _cell(str(unverified.error)),
            "",
        ]
    return "\n".join(lines)


def _cell(text: str) -> str:
    """Text on one line, with what Markdown would take as markup made plain."""
    text = _line(text)
    for mark in "\\`*_|<>[]":
        text = text.replace(mark, f"\\{mark}")
    return text
