"""Which notes are to fail: what does not move the robot may all the same break the code that drives it.

A change of the motion always fails. A note fails where its gate is among those to fail on: a joint that is called
otherwise where ``names`` is, a higher limit of speed where ``velocity`` is.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from pinscrew.changes.outcome import Change
from pinscrew.ground.errors import InputError

__all__ = ["GATES", "failing_gate", "gates", "let_pass"]

GATES: Final[dict[str, str]] = {
    "names": "a robot, joint or link is called otherwise",
    "tips": "a tip frame is called otherwise, or there is one more",
    "velocity": "a limit of velocity",
    "effort": "a limit of effort",
    "limits": "any limit: those of the coordinates are changes and fail anyway",
    "order": "coordinates have other places in q",
    "frames": "a frame was chosen anew, or a fixed one is more or less",
    "all": "any note",
}
"""What can be failed on, and what that is."""

_OF_KIND: Final[dict[str, str]] = {
    "robot-renamed": "names",
    "joint-renamed": "names",
    "link-renamed": "names",
    "velocity": "velocity",
    "effort": "effort",
    "order": "order",
}
"""The gates of notes by their kinds; all others are about frames."""


def gates(names: Iterable[str], where: str = "") -> frozenset[str]:
    """Names of gates, checked.

    Args:
        names: such as ``["names", "velocity"]``.
        where: where they stand, for the error.

    Raises:
        InputError: if there is no such gate, or ``names`` is a text.
    """
    wanted = [names] if isinstance(names, str) else list(names)
    for name in wanted:
        if name not in GATES:
            known = ", ".join(GATES)
            raise InputError("fail-on", f"there is no {name!r} to fail on", where=where, remedy=f"known are: {known}")
    return frozenset(wanted)


def failing_gate(note: Change, fail_on: frozenset[str]) -> str:
    """The gate by which a note fails; ``""`` where it does not."""
    return next((gate for gate in _gates_of(note) if gate in fail_on), "")


def _gates_of(note: Change) -> Iterator[str]:
    """The gates that a note falls under, the one by which it is counted first."""
    if note.tip:
        yield "tips"
    own = _OF_KIND.get(note.kind, "frames")
    yield own
    if own in ("velocity", "effort"):
        yield "limits"
    yield "all"


def let_pass(notes: Iterable[Change], fail_on: frozenset[str]) -> str:
    """One line on the notes that do not fail, such as ``let pass: 2 of names (--fail-on names)``; ``""`` for none."""
    passed = [next(_gates_of(note)) for note in notes if not failing_gate(note, fail_on)]
    counts = {gate: passed.count(gate) for gate in GATES if gate in passed}
    if not counts:
        return ""
    listed = ", ".join(f"{count} of {gate}" for gate, count in counts.items())
    return f"let pass: {listed} (--fail-on {','.join(counts)})"
