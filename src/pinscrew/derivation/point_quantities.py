"""Names about a point that moves with the frame, and what an engine says of each; see `named_quantities`."""

from __future__ import annotations

import numpy as np

from pinscrew.derivation.truth import Truth
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.mathtext import evaluate, read_latex

__all__ = ["point_quantity"]


def point_quantity(truth: Truth, point: FloatArray, base: str, sub: str, argument: str) -> FloatArray | None:
    r"""q_a or q_b, shape (N, 4, 1), or their velocities, where ``argument`` may list values of the coordinates.

    Args:
        truth: the engine's answers.
        point: x, y, z in the frame (m), shape (3,).
        base: ``q`` or ``v``.
        sub: ``a`` or ``b``, or ``q_{a}`` or ``q_{b}``.
        argument: such as ``\frac{\pi}{2},\cdot``, or nothing.
    """
    frame = sub.replace("{", "").replace("}", "").removeprefix("q_")
    if frame not in ("a", "b") or (base == "v") != sub.startswith("q"):
        return None
    if argument:
        truth = truth.at([None if x.strip() == r"\cdot" else _number(x) for x in argument.split(",")])
    place = np.broadcast_to(np.append(point, 1.0)[:, None], (len(truth.pose), 4, 1))
    place = truth.pose @ place if frame == "a" else place
    if base == "q":
        return place
    kind = "spatial" if frame == "a" else "body"
    return np.asarray(se3.hat(truth.velocity(kind)[:, :, 0]) @ place)


def _number(text: str) -> float:
    found = evaluate(read_latex(text), {})
    if np.ndim(found):
        raise InputError("formula", f"{text!r} is no number")
    return float(found)
