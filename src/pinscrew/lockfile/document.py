"""Checked locks as a neutral document: a section for each, and what moved at the line of its joint."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from pinscrew.changes.document import as_data, findings
from pinscrew.ground.errors import PinscrewError
from pinscrew.lockfile.outcome import LockCheckData
from pinscrew.reporting.document import Document, Line, Section, cases_of
from pinscrew.reporting.findings import Finding
from pinscrew.reporting.troubles import from_error

__all__ = ["SCHEMA", "TASK", "document"]

SCHEMA: Final = "pinscrew.lock-check/1"
TASK: Final = "pinscrew lock"


def document(checked: Sequence[LockCheckData], errors: Sequence[tuple[Path, PinscrewError]] = ()) -> Document:
    """The checks as a document, with the locks that could not be checked, and why."""
    asked, same = len(checked) + len(errors), sum(check.same for check in checked)
    moved = [str(check.lock) for check in checked if not check.same]
    if moved:
        closing = f"{len(moved)} of {asked} mechanisms moved; if that is meant: pinscrew lock {' '.join(moved)}"
    else:
        closing = f"{same} of {asked} mechanisms are those of their locks"
    failures = [(path, from_error(error, str(path))) for path, error in errors]
    told = [finding for check in checked for finding in _findings(check)]
    return Document(
        task=TASK,
        ok=not errors and not moved,
        sections=(*map(_section, checked), *(_unchecked(path, finding) for path, finding in failures)),
        findings=(*told, *(finding for _, finding in failures)),
        data=_data(checked, errors),
        overview=f"pinscrew lock: {same} of {asked} mechanisms are those of their locks",
        closing=closing,
    )


def _findings(check: LockCheckData) -> tuple[Finding, ...]:
    if check.changes is None:
        return ()
    return findings(check.changes, str(check.lock), changed="moved", kept="placed-anew")


def _section(check: LockCheckData) -> Section:
    changes = () if check.changes is None else check.changes.changes
    notes = () if check.changes is None else check.changes.notes
    return Section(
        title=str(check.lock),
        heading=f"{check.lock}: {'the same' if check.same else 'MOVED'}",
        lines=(
            *(Line(change.words, "fault", change.kind) for change in changes),
            *(Line(note.words, "note", note.kind) for note in notes),
        ),
        cases=cases_of(_findings(check)),
    )


def _unchecked(path: Path, finding: Finding) -> Section:
    return Section(
        title=str(path),
        heading=f"{path}: could not be checked",
        lines=(Line(finding.message, "paragraph"),),
        cases=cases_of([finding]),
        tried=False,
    )


def _data(checked: Sequence[LockCheckData], errors: Sequence[tuple[Path, PinscrewError]]) -> dict[str, Any]:
    rows = [
        {
            "lock": str(check.lock),
            "file": check.robot.description.file,
            "same": check.same,
            "changes": [] if check.changes is None else [as_data(change) for change in check.changes.changes],
            "notes": [] if check.changes is None else [as_data(note) for note in check.changes.notes],
        }
        for check in checked
    ]
    failed = [{"lock": str(path), "code": error.code, "message": str(error)} for path, error in errors]
    return {
        "schema": SCHEMA,
        "ok": not errors and all(check.same for check in checked),
        "locks": rows,
        "errors": failed,
    }
