"""Which notes are to fail: what does not move the robot may all the same break the code that drives it.

A change of the motion always fails. A note fails where its gate is among those to fail on: a joint that is called
otherwise where ``names`` is, a higher limit of speed where ``velocity`` is. A project names its gates under
``[tool.pinscrew]`` in its pyproject.toml, for commands and for the plugin of pytest.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Final

from pinscrew.changes.outcome import Change
from pinscrew.ground.errors import InputError

__all__ = ["FILE", "GATES", "SECTION", "fail_on", "failing_gate", "gates", "let_pass", "nearest", "section"]

FILE: Final = "pyproject.toml"
SECTION: Final = "tool.pinscrew"
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


# ----------------------------------------------------------------------------------- of a project


def section(file: Path) -> Any:
    """The table of pinscrew in a pyproject.toml; an empty one where there is no such table or file.

    Raises:
        InputError: if the file can't be read.
    """
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib
    if not file.is_file():
        return {}
    try:
        return tomllib.loads(file.read_text(encoding="utf-8")).get("tool", {}).get("pinscrew", {})
    except (OSError, ValueError, AttributeError) as error:  # AttributeError: 'tool' is no table
        raise InputError("settings", f"can't be read: {error}", where=str(file)) from None
    except (RecursionError, MemoryError):
        raise InputError("settings", "can't be read: it is nested too deeply", where=str(file)) from None


def nearest(folder: Path) -> Path | None:
    """The pyproject.toml of a folder, or of the nearest one above it, up to the top of its repository."""
    for place in (folder, *folder.parents):
        if (place / FILE).is_file():
            return place / FILE
        if (place / ".git").exists():
            break
    return None


def fail_on(folder: Path) -> frozenset[str]:
    """What ``fail_on`` of ``[tool.pinscrew]`` says for a folder; nothing where it is not said.

    Raises:
        InputError: if the file can't be read, or ``fail_on`` is no list of what can be failed on.
    """
    file = nearest(folder)
    if file is None:
        return frozenset()
    table = section(file)
    names = table.get("fail_on", []) if isinstance(table, dict) else None
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        what = f"{SECTION}.fail_on is no list of texts"
        raise InputError("settings", what, where=str(file), remedy='write such as fail_on = ["names"]')
    return gates(names, f"{file}: {SECTION}.fail_on")
