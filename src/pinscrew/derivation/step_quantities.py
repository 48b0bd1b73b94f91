"""Names of the matrices on the way to the results, and what an engine says of each; see `named_quantities`."""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from pinscrew.derivation.truth import Truth
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3, so3

__all__ = ["step_quantity"]

_OF_TAIL: Final = re.compile(r"[gT]_\{?(\d+)\}?")
_BRACKETS: Final = re.compile(r"\[(\\?[A-Za-z]+)(?:_\{?(.*?)\}?)?\]")


def step_quantity(truth: Truth, base: str, sub: str, sup: str) -> FloatArray | None:  # noqa: PLR0911 (one for each)
    r"""The value (N, rows, columns) of a name in the notation of either book, or None if it is none of these.

    Args:
        truth: the engine's answers.
        base: the name without its scripts, such as ``R``, ``\hat{p}`` or ``[\omega_{1}]``.
        sub: its subscript.
        sup: its superscript.
    """
    if base == "H" and sub.isdecimal() and (sup.isdecimal() or sup == "e"):
        return np.asarray(se3.inverse(truth.link(sub)) @ truth.link(sup))
    if base == r"\hat{\xi}" and sub.isdecimal() and sup == "'":
        return np.asarray(se3.hat(truth.column("spatial", int(sub))[:, :, 0]))
    if sup == "T":
        found = step_quantity(truth, base, sub, "")
        return None if found is None else np.swapaxes(found, 1, 2)
    if sup == "2" and base != "I":
        found = step_quantity(truth, base, sub, "")
        return None if found is None or found.shape[1] != found.shape[2] else found @ found
    if sup:
        return None
    if base.startswith((r"\hat{", "[")):
        return _hat(truth, base, sub)
    return _plain(truth, base, sub)


def _hat(truth: Truth, base: str, sub: str) -> FloatArray | None:
    brackets = _BRACKETS.fullmatch(base)
    if brackets and brackets[1] == "J" and (brackets[2] or "")[:1] == "s" and brackets[2][1:].isdecimal():
        return np.asarray(se3.hat(truth.column("spatial", int(brackets[2][1:]))[:, :, 0]))
    letter, sub = (brackets[1], brackets[2] or "") if brackets else (base.removeprefix(r"\hat{")[:-1], sub)
    vector = _plain(truth, letter, sub) if letter in (r"\omega", "p", "z") else None
    return None if vector is None else np.asarray(so3.hat(vector[:, :, 0]))


def _plain(truth: Truth, base: str, sub: str) -> FloatArray | None:  # noqa: PLR0911 (one for each name)
    if base in ("v", r"\omega") and sub.isdecimal():
        return truth.twist(int(sub))[:, :3] if base == "v" else truth.twist(int(sub))[:, 3:]
    if base in ("g", "T") and sub.isdecimal():
        return truth.tail(int(sub))
    if base == "z" and sub.isdecimal():
        column = truth.column("hybrid", int(sub))
        return column[:, 3:] if column[:, 3:].any() else column[:, :3]
    if base == "o" and (sub.isdecimal() or sub == "e"):
        return truth.link(sub)[:, :3, 3:]
    if base == "I" and not sub:
        return np.broadcast_to(np.eye(3), (len(truth.pose), 3, 3))
    pose: FloatArray | None = None
    if base in ("R", "p"):
        tail = _OF_TAIL.fullmatch(sub)
        pose = truth.tail(int(tail[1])) if tail else truth.pose if not sub else None
    elif base in (r"\dot{R}", r"\dot{p}") and not sub:
        pose = truth.rate
    if pose is None:
        return None
    return pose[:, :3, :3] if "R" in base else pose[:, :3, 3:]
