"""Changes for people and programs: text, JSON, Markdown."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Final

from pinscrew.changes.outcome import Change, ChangesData, TipPlace
from pinscrew.changes.wording import degrees, millimetres, number
from pinscrew.ground.words import one_line
from pinscrew.reporting.markdown import cell

__all__ = ["SCHEMA", "summary", "to_json", "to_markdown", "to_text"]

SCHEMA: Final = "pinscrew.diff/1"
ROUNDING: Final = 1e-11
"""A displacement (m or rad) of tips that is told as none: what is left of the 12 digits in a lock, say."""


def summary(changes: ChangesData) -> str:
    """One line: what was compared, and the outcome."""
    count = len(changes.changes)
    outcome = "the motion is the same" if changes.same else f"{count} change{'s' * (count > 1)}"
    notes = len(changes.notes)
    remarked = f", {notes} note{'s' * (notes > 1)}" if notes else ""
    return f"{one_line(changes.a)} → {one_line(changes.b)}: {outcome}{remarked}"


def to_text(changes: ChangesData) -> str:
    """The summary, and a line for each change and note."""
    lines = [summary(changes)]
    lines += [f"  {_told(change)}" for change in changes.changes]
    lines += [f"  note: {_told(note)}" for note in changes.notes]
    return "\n".join([*lines, *(f"  {line}" for line in _apart(changes))])


def to_json(changes: ChangesData) -> str:
    """The changes as JSON, schema `SCHEMA`."""
    found = changes.displacement
    document = {
        "schema": SCHEMA,
        "a": changes.a,
        "b": changes.b,
        "same": changes.same,
        "changes": [asdict(change) for change in changes.changes],
        "notes": [asdict(note) for note in changes.notes],
        "displacement": found
        and {
            "length": found.length,
            "length_at": {"frame": found.length_at.frame, "q": dict(found.length_at.q)},
            "angle": found.angle,
            "angle_at": {"frame": found.angle_at.frame, "q": dict(found.angle_at.q)},
        },
    }
    return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False)


def to_markdown(changes: ChangesData) -> str:
    """The changes as Markdown: a heading, and a list of changes and one of notes."""
    lines = [f"### {cell(summary(changes))}", ""]
    lines += [f"- **{change.kind}**: {cell(_told(change))}" for change in changes.changes]
    lines += [f"- {cell(line)}" for line in _apart(changes)]
    if changes.notes:
        lines += ["", "Without a change of the motion:", ""]
        lines += [f"- {note.kind}: {cell(_told(note))}" for note in changes.notes]
    return "\n".join([*lines, ""])


def _told(change: Change) -> str:
    where = "" if change.line is None else f" (line {change.line})"
    return f"{one_line(change.words)}{where}"


def _apart(changes: ChangesData) -> list[str]:
    """How far apart the tips come, if anything changed."""
    found = changes.displacement
    if changes.same:
        return []
    if found is None:
        return ["the two do not have the same coordinates and tips, so displacements can't be given"]
    if found.length <= ROUNDING and found.angle <= ROUNDING:
        return ["at equal coordinates the tips stand where they stood"]
    lines = [f"tips come apart by {millimetres(found.length)} at most: {_place(found.length_at)}"]
    if found.angle > ROUNDING:
        lines.append(f"tips are turned by {degrees(found.angle)} at most: {_place(found.angle_at)}")
    return lines


def _place(place: TipPlace) -> str:
    q = ", ".join(f"{name}={number(value)}" for name, value in place.q.items())
    return one_line(f"{place.frame!r} at {q}" if q else repr(place.frame))
