"""Reports as a neutral document: an account for each, the checks as cases, the blame as findings at its lines."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

from pinscrew.ground.errors import PinscrewError, PinscrewWarning
from pinscrew.ground.version import version_of
from pinscrew.ground.words import one_line
from pinscrew.reporting.document import Account, Case, Document, Problem, ResultTable, Sentence, Strong
from pinscrew.reporting.findings import Finding
from pinscrew.reporting.troubles import from_error, from_warning
from pinscrew.verification.outcome import Check, ReportData
from pinscrew.verification.wording import details, failures, largest_at, place, summary

__all__ = ["SCHEMA", "TASK", "Attempt", "document", "table"]

SCHEMA: Final = "pinscrew.verify/1"
TASK: Final = "pinscrew verify"

_WITNESSES: Final = {"MuJoCo": "mujoco", "roboticstoolbox": "roboticstoolbox-python"}
"""The packages of engines that are optional."""


@dataclass(frozen=True, slots=True)
class Attempt:
    """What came of verifying one robot.

    Attributes:
        robot: the robot, as it was asked for.
        reports: on each pair of engines that could be compared.
        errors: why others could not.
        warnings: what there was to remark about its file.
    """

    robot: str
    reports: tuple[ReportData, ...] = ()
    errors: tuple[PinscrewError, ...] = ()
    warnings: tuple[PinscrewWarning, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether all engines could be compared and agree."""
        return not self.errors and all(report.ok for report in self.reports)


def document(attempts: Sequence[Attempt]) -> Document:
    """The attempts as a document: the accounts of all reports, then those of what could not be verified."""
    accounts = [_account(report) for attempt in attempts for report in attempt.reports]
    accounts += [_unverified(attempt.robot, error) for attempt in attempts for error in attempt.errors]
    return Document(
        task=TASK,
        ok=all(attempt.ok for attempt in attempts),
        accounts=tuple(accounts),
        findings=tuple(finding for attempt in attempts for finding in _findings(attempt)),
        data=_data(attempts),
    )


def table(report: ReportData) -> ResultTable:
    """A row for each check."""
    rows = [
        (c.name, f"{c.error:.1e}", f"{c.tolerance:.1e}", "ok" if c.ok else Strong("FAIL"), place(c))
        for c in report.checks
    ]
    return ResultTable(("check", "error", "tolerance", "", "largest at"), tuple(rows))


def _account(report: ReportData) -> Account:
    robot, engines = report.robot, " and ".join(report.engines)
    return Account(
        # The engines are named where they are not those that `verify` compares unless told otherwise.
        title=robot if engines == "PoE and Pinocchio" else f"{robot} ({engines})",
        heading=summary(report),
        table=table(report),
        lines=tuple(Sentence(text) for text in details(report)),
        cases=tuple(_case(report, check) for check in report.checks),
    )


def _unverified(robot: str, error: PinscrewError) -> Account:
    return Account(
        title=robot,
        heading=f"{robot}: could not be verified",
        lines=(Sentence(str(error), "paragraph"),),
        cases=(Case("verify", Problem("error", str(error), error.code)),),
        tried=False,
    )


def _case(report: ReportData, check: Check) -> Case:
    if check.ok:
        return Case(check.name)
    message = f"error {check.error:.3e} above {check.tolerance:.3e}{largest_at(check)}"
    lines = dict.fromkeys((*check.remarks, *report.diagnosis, f"q = {list(check.place.q)}"))
    return Case(check.name, Problem("failure", message, "disagreement", "\n".join(lines)))


def _findings(attempt: Attempt) -> Iterator[Finding]:
    yield from (from_warning(warning, attempt.robot) for warning in attempt.warnings)
    for report in attempt.reports:
        yield from _disagreements(report)
    yield from (from_error(error, attempt.robot) for error in attempt.errors)


def _disagreements(report: ReportData) -> Iterator[Finding]:
    """A finding for each line of a report's diagnosis; none if the engines agree."""
    if report.ok:
        return
    worst = failures(report)[0]
    count = len(report.diagnosis)
    blame = zip(report.diagnosis, report.files or [report.file] * count, report.lines or [None] * count, strict=True)
    for words, file, line in list(blame) or [("the engines disagree", report.file, None)]:
        yield Finding("disagreement", "error", f"{one_line(words)} ({worst})", file, line, report.robot)


def _data(attempts: Sequence[Attempt]) -> dict[str, Any]:
    reports = [report for attempt in attempts for report in attempt.reports]
    packages = ["pinscrew", "pin", "yourdfpy", "numpy"]
    packages += sorted({_WITNESSES[name] for report in reports for name in report.engines if name in _WITNESSES})
    return {
        "schema": SCHEMA,
        "versions": {name: version_of(name) for name in packages},
        "ok": all(attempt.ok for attempt in attempts),
        "robots": [_report_data(report) for report in reports],
        "errors": [
            {"robot": attempt.robot, "code": error.code, "message": str(error)}
            for attempt in attempts
            for error in attempt.errors
        ],
    }


def _report_data(report: ReportData) -> dict[str, Any]:
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
        "checks": [_check_data(check) for check in report.checks],
        "diagnosis": list(report.diagnosis),
    }


def _check_data(check: Check) -> dict[str, Any]:
    return {
        "name": check.name,
        "ok": check.ok,
        "error": check.error if check.error < float("inf") else "inf",  # NaN in an answer, too
        "tolerance": check.tolerance,
        "frame": check.place.frame,
        "joint": check.place.joint,
        "configuration": check.place.configuration,
        "q": list(check.place.q),
        "remarks": list(check.remarks),
    }
