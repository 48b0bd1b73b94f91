"""Names of the matrices on the way to the results, and what an engine says of each; see `named_quantities`."""

from __future__ import annotations

import re
from typing import Final

import numpy as np

from pinscrew.derivation.truth import Truth
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import so3

__all__ = ["step_quantity"]

_OF_TAIL: Final = re.compile(r"[gT]_\{?(\d+)\}?")
_BRACKETS: Final = re.compile(r"\[(\\?[A-Za-z]+)(?:_\{?(.*?)\}?)?\]")


def step_quantity(truth: Truth, base: str, sub: str, sup: str) -> FloatArray | None:
    r"""The value (N, rows, columns) of a name in the notation of either book, or None if it is none of these.

    Args:
        truth: the engine's answers.
        base: the name without its scripts, such as ``R``, ``\hat{p}`` or ``[\omega_{1}]``.
        sub: its subscript.
        sup: its superscript.
    """
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
    letter, sub = (brackets[1], brackets[2] or "") if brackets else (base.removeprefix(r"\hat{")[:-1], sub)
    vector = _plain(truth, letter, sub) if letter in (r"\omega", "p") else None
    return None if vector is None else np.asarray(so3.hat(vector[:, :, 0]))


def _plain(truth: Truth, base: str, sub: str) -> FloatArray | None:
    if base in ("v", r"\omega") and sub.isdecimal():
        return truth.twist(int(sub))[:, :3] if base == "v" else truth.twist(int(sub))[:, 3:]
    if base in ("g", "T") and sub.isdecimal():
        return truth.tail(int(sub))
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
