"""What names in formulas are read against: an engine's answers, the book, the joints and what was read before."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from pinscrew.derivation.truth import Truth
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.mathtext import Symbol, read_latex
from pinscrew.mathtext.equations import Grid

__all__ = ["SWAPPED", "Names", "NotUnderstoodError"]

SWAPPED: Final = [3, 4, 5, 0, 1, 2]
"""(v, ω) as (ω, v)."""


class NotUnderstoodError(Exception):
    """A side of an equation has something in it that has no value here; it is passed over."""


@dataclass(frozen=True, slots=True)
class Names:
    """What the names in the formulas of one report stand for.

    Attributes:
        truth: an engine's answers, with twists (v, ω).
        angular_first: whether the book has (ω, v).
        joints: the names of the values of the joints that move the frame, without underscores.
        rates: of the coordinates, shape (N, m).
        grid: the value of a matrix of entries, or None where it is a general form.
        scalar: the value (N,) of a symbol, such as a joint's rate; raises `NotUnderstoodError`.
        points: points q_i of axes that were read before.
        point: the point that the report is about, x, y, z in the frame (m), shape (3,).
        frames: the frames that letters stand for.
    """

    truth: Truth
    angular_first: bool
    joints: tuple[str, ...]
    rates: FloatArray
    grid: Callable[[Grid], FloatArray | None]
    scalar: Callable[[str], FloatArray]
    points: Mapping[int, FloatArray]
    point: FloatArray | None = None
    frames: Mapping[str, str] = field(default_factory=dict)

    def twist(self, matrix: FloatArray) -> FloatArray:
        """Twists or a Jacobian with its rows in the book's order."""
        return matrix[:, SWAPPED] if self.angular_first else matrix

    def adjoint(self, pose: FloatArray) -> FloatArray:
        """Ad of a pose in the book's order."""
        matrix = np.asarray(se3.adjoint(pose))
        return matrix[:, SWAPPED][:, :, SWAPPED] if self.angular_first else matrix

    def leg(self, base: str, sub: str, sup: str) -> FloatArray | None:
        """The pose or velocity of one frame in another, such as V^s with AC below, or None."""
        if len(sub) != 2 or not set(sub) <= set(self.frames):
            return None
        pose, velocities = self.truth.leg(self.frames[sub[1]], self.frames[sub[0]])
        if base in ("g", "T"):
            return pose if not sup else None
        kind = {"s": "spatial", "b": "body"}.get(sup, "")
        return self.twist(velocities[kind]) if base in ("V", r"\mathcal{V}") and kind else None

    def joint(self, symbol: str) -> int:
        """The number of the joint whose value a symbol is."""
        try:
            node = read_latex(symbol)
        except InputError:
            raise NotUnderstoodError from None
        name = node.name.replace("_", "") if isinstance(node, Symbol) else ""
        if name not in self.joints:
            raise NotUnderstoodError
        return self.joints.index(name) + 1
