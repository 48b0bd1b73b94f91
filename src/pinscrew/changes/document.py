"""Changes as a neutral document: a line for each, and each at the line of its joint in b's file."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any, Final

from pinscrew.changes.gates import failing_gate, let_pass
from pinscrew.changes.outcome import Change, ChangesData, TipPlace
from pinscrew.changes.wording import degrees, millimetres, number
from pinscrew.ground.errors import PinscrewError
from pinscrew.ground.words import one_line
from pinscrew.reporting.document import Account, Document, Role, Sentence, cases_of
from pinscrew.reporting.findings import Finding, Level
from pinscrew.reporting.troubles import from_error

__all__ = [
    "SCHEMA",
    "TASK",
    "as_data",
    "document",
    "failing",
    "failure",
    "findings",
    "passes",
    "sentences",
]

SCHEMA: Final = "pinscrew.diff/1"
TASK: Final = "pinscrew diff"


def document(changes: ChangesData) -> Document:
    """The changes as a document of one account."""
    title = f"{changes.a} → {changes.b}"
    listed = findings(changes, title, changed="motion-changed", kept="motion-kept")
    account = Account(
        title=title,
        heading=_summary(changes),
        lines=_lines(changes),
        notes_heading="Without a change of the motion:",
        cases=cases_of(listed),
    )
    return Document(TASK, passes(changes), (account,), listed, _data(changes))


def failure(title: str, error: PinscrewError) -> Document:
    """The document of a comparison that an error kept from being made."""
    finding = from_error(error, title)
    heading, line = f"{title}: could not be compared", Sentence(finding.message, "paragraph")
    account = Account(title, heading, lines=(line,), cases=cases_of([finding]), tried=False)
    return Document(TASK, ok=False, accounts=(account,), findings=(finding,))


def passes(changes: ChangesData) -> bool:
    """Whether there is no change, and no note to fail on."""
    return not failing(changes)


def failing(changes: ChangesData) -> tuple[Change, ...]:
    """The changes, and the notes to fail on."""
    return (*changes.changes, *(note for note in changes.notes if failing_gate(note, changes.fail_on)))


def _summary(changes: ChangesData) -> str:
    """One line: what was compared, and the outcome."""
    count = len(changes.changes)
    outcome = "the motion is the same" if changes.same else f"{count} change{'s' * (count > 1)}"
    notes = len(changes.notes)
    remarked = f", {notes} note{'s' * (notes > 1)}" if notes else ""
    to_fail = len(failing(changes)) - len(changes.changes)
    remarked += f" ({to_fail} to fail on)" if to_fail else ""
    return f"{one_line(changes.a)} → {one_line(changes.b)}: {outcome}{remarked}"


def _lines(changes: ChangesData) -> tuple[Sentence, ...]:
    """The changes, the notes (first those to fail on), how far the tips come apart, and what was let pass."""
    passed = let_pass(changes.notes, changes.fail_on)
    return (
        *sentences(changes, placed=True),
        *(Sentence(text) for text in _apart(changes)),
        *([Sentence(passed)] if passed else []),
    )


def sentences(changes: ChangesData, *, placed: bool) -> tuple[Sentence, ...]:
    """A line for each change and note, first those that fail; ``placed`` adds the lines of b's file."""

    def line(change: Change, role: Role, why: str = "") -> Sentence:
        return Sentence(f"{change.words}{why}{_place_of(change) if placed else ''}", role, change.kind)

    gates = {id(note): failing_gate(note, changes.fail_on) for note in changes.notes}
    return (
        *(line(change, "fault") for change in changes.changes),
        *(line(note, "fault", f"; fails on {gates[id(note)]}") for note in changes.notes if gates[id(note)]),
        *(line(note, "note") for note in changes.notes if not gates[id(note)]),
    )


def findings(changes: ChangesData, robot: str, *, changed: str, kept: str) -> tuple[Finding, ...]:
    """An error for each change of the motion and each note to fail on, a note for each other edit, by these rules."""

    def finding(change: Change, rule: str, level: Level) -> Finding:
        return Finding(rule, level, one_line(change.words), change.file or changes.file, change.line, robot)

    return (
        *(finding(change, changed, "error") for change in changes.changes),
        *(finding(note, kept, "error" if failing_gate(note, changes.fail_on) else "note") for note in changes.notes),
    )


def as_data(change: Change) -> dict[str, Any]:
    """A change as JSON has it; its file only where that is not b's."""
    return {key: value for key, value in asdict(change).items() if key != "tip" and (key != "file" or value)}


def _data(changes: ChangesData) -> dict[str, Any]:
    apart = changes.displacement
    return {
        "schema": SCHEMA,
        "a": changes.a,
        "b": changes.b,
        "same": changes.same,
        "fail_on": sorted(changes.fail_on),
        "passes": passes(changes),
        "changes": [as_data(change) for change in changes.changes],
        "notes": [as_data(note) for note in changes.notes],
        "displacement": apart
        and {
            "length": apart.length,
            "length_at": {"frame": apart.length_at.frame, "q": dict(apart.length_at.q)},
            "angle": apart.angle,
            "angle_at": {"frame": apart.angle_at.frame, "q": dict(apart.angle_at.q)},
        },
    }


def _place_of(change: Change) -> str:
    if change.line is None:
        return ""
    return f" ({f'{change.file}:' if change.file else 'line '}{change.line})"


def _apart(changes: ChangesData) -> list[str]:
    """How far apart the tips come, if anything changed."""
    apart = changes.displacement
    if changes.same:
        return []
    if apart is None:
        return ["the two do not have the same coordinates and tips, so displacements can't be given"]
    lines = []
    if apart.length > changes.tolerance.length:
        lines.append(f"tips come apart by {millimetres(apart.length)} at most: {_place(apart.length_at)}")
    if apart.angle > changes.tolerance.angle:
        lines.append(f"tips are turned by {degrees(apart.angle)} at most: {_place(apart.angle_at)}")
    return lines or ["at equal coordinates the tips stand where they stood"]


def _place(place: TipPlace) -> str:
    q = ", ".join(f"{name}={number(value)}" for name, value in place.q.items())
    return f"{place.frame!r} at {q}" if q else repr(place.frame)
