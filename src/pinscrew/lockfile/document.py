"""Checked locks as a neutral document: an account for each, and what moved at the line of its joint."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from pinscrew.changes.document import as_data, findings, sentences
from pinscrew.changes.gates import failing_gate, let_pass
from pinscrew.ground.errors import PinscrewError
from pinscrew.lockfile.outcome import LockCheckData
from pinscrew.reporting.document import Account, Document, Sentence, cases_of
from pinscrew.reporting.findings import Finding
from pinscrew.reporting.troubles import from_error

__all__ = ["SCHEMA", "TASK", "document"]

SCHEMA: Final = "pinscrew.lock-check/1"
TASK: Final = "pinscrew lock"


def document(checked: Sequence[LockCheckData], errors: Sequence[tuple[Path, PinscrewError]] = ()) -> Document:
    """The checks as a document, with the locks that could not be checked, and why."""
    asked, same = len(checked) + len(errors), sum(check.passes for check in checked)
    failed = [check for check in checked if not check.passes]
    if failed:
        how = "moved" if not any(check.same for check in failed) else "moved, or differ in what is to fail"
        again = shlex.join(["pinscrew", "lock", *(str(check.lock) for check in failed)])
        closing = f"{len(failed)} of {asked} mechanisms {how}; if that is meant: {again}"
    else:
        closing = f"{same} of {asked} mechanisms are those of their locks"
    failures = [(path, from_error(error, str(path))) for path, error in errors]
    findings = [finding for check in checked for finding in _findings(check)]
    return Document(
        task=TASK,
        ok=not errors and not failed,
        accounts=(*map(_account, checked), *(_unchecked(path, finding) for path, finding in failures)),
        findings=(*findings, *(finding for _, finding in failures)),
        data=_data(checked, errors),
        overview=f"pinscrew lock: {same} of {asked} mechanisms are those of their locks",
        closing=closing + _let_pass(checked),
    )


def _let_pass(checked: Sequence[LockCheckData]) -> str:
    """What the checks let pass, as the end of a line."""
    compared = [check.changes for check in checked if check.changes is not None]
    notes = [note for changes in compared for note in changes.notes if not failing_gate(note, changes.fail_on)]
    passed = let_pass(notes, frozenset())
    return f"; {passed}" if passed else ""


def _findings(check: LockCheckData) -> tuple[Finding, ...]:
    if check.changes is None:
        return ()
    return findings(check.changes, str(check.lock), changed="moved", kept="placed-anew")


def _account(check: LockCheckData) -> Account:
    outcome = "the same" if check.passes else "CHANGED" if check.same else "MOVED"
    return Account(
        title=str(check.lock),
        heading=f"{check.lock}: {outcome}",
        lines=() if check.changes is None else sentences(check.changes, placed=False),
        cases=cases_of(_findings(check)),
    )


def _unchecked(path: Path, finding: Finding) -> Account:
    return Account(
        title=str(path),
        heading=f"{path}: could not be checked",
        lines=(Sentence(finding.message, "paragraph"),),
        cases=cases_of([finding]),
        tried=False,
    )


def _data(checked: Sequence[LockCheckData], errors: Sequence[tuple[Path, PinscrewError]]) -> dict[str, Any]:
    rows = [
        {
            "lock": str(check.lock),
            "file": check.robot.description.file,
            "same": check.same,
            "fail_on": [] if check.changes is None else sorted(check.changes.fail_on),
            "passes": check.passes,
            "changes": [] if check.changes is None else [as_data(change) for change in check.changes.changes],
            "notes": [] if check.changes is None else [as_data(note) for note in check.changes.notes],
        }
        for check in checked
    ]
    failed = [{"lock": str(path), "code": error.code, "message": str(error)} for path, error in errors]
    return {
        "schema": SCHEMA,
        "ok": not errors and all(check.passes for check in checked),
        "locks": rows,
        "errors": failed,
    }
