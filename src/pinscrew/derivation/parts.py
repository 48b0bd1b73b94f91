"""The sections of a report by key, letter and name, and which of them are wanted."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from pinscrew.ground.errors import InputError

__all__ = ["PARTS", "wanted"]

PARTS: Final = {
    "home": "a",
    "twists": "b",
    "exponentials": "c",
    "pose": "d",
    "rate": "e",
    "inverse": "f",
    "velocity-matrix": "g",
    "velocity": "h",
    "body-jacobian": "i",
    "velocity-check": "j",
    "hybrid-velocity": "k",
    "spatial-jacobian": "l",
    "hybrid-jacobian": "m",
    "singularities": "n",
    "screws": "o",
    "spatial-velocity": "p",
    "general-column": "q",
    "geometric": "r",
}
"""The keys of sections, and their letters."""

_NAMES: Final = {
    "T": "pose",
    "M": "home",
    "Js": "spatial-jacobian",
    "Jb": "body-jacobian",
    "Jh": "hybrid-jacobian",
    "Ad": "hybrid-jacobian",
    "Vb": "velocity-check",
    "Vs": "spatial-velocity",
    "Vh": "hybrid-velocity",
}
"""What people call a section by."""
_ON_REQUEST: Final = {"singularities", "screws", "spatial-velocity", "general-column", "geometric"}
_SMALL_ONLY: Final = {"rate", "inverse", "velocity-matrix", "velocity", "velocity-check", "hybrid-velocity"}


def wanted(parts: Iterable[str], *, large: bool) -> list[str]:
    """The keys of the sections that are asked for; by default those that fit the robot's size.

    Args:
        parts: keys (``"pose"``), letters (``"d"``) or names (``"T"``, ``"Js"``); several with commas between.
        large: whether the robot has too many joints for velocities term by term.

    Raises:
        InputError: if one does not exist.
    """
    known = {**_NAMES, **{letter: key for key, letter in PARTS.items()}}
    asked = [known.get(part.strip(), part.strip()) for several in parts for part in several.split(",")]
    for part in asked:
        if part not in PARTS:
            listed = ", ".join(f"{key} ({letter})" for key, letter in PARTS.items())
            remedy = f"the parts are: {listed}; and by name {', '.join(_NAMES)}"
            raise InputError("derive-part", f"there is no part {part!r}", remedy=remedy)
    default = [key for key in PARTS if key not in _ON_REQUEST and not (large and key in _SMALL_ONLY)]
    return [key for key in PARTS if key in asked] if asked else default
