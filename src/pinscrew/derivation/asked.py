"""What a report is asked about beside its parts: a point that moves with the frame, or a frame on the way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
import sympy as sp

from pinscrew.derivation import exact
from pinscrew.derivation.forms import ClosedForms
from pinscrew.ground.errors import UnknownNameError
from pinscrew.ground.typing import FloatArray

__all__ = ["NOTHING", "ReportQuestion", "asked"]


@dataclass(frozen=True, slots=True)
class ReportQuestion:
    """A point and joint values, or three frames.

    Attributes:
        point: x, y, z in the frame (m), shape (3, 1); None if there is no question of one.
        at: exact values of some coordinates, by their symbols; the others stay free.
        frames: the frames that the letters A, B, C stand for.
    """

    point: sp.ImmutableMatrix | None = None
    at: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    frames: Mapping[str, str] = field(default_factory=dict)

    @property
    def numbers(self) -> FloatArray | None:
        """The point, shape (3,)."""
        return None if self.point is None else np.array([float(x) for x in self.point])


NOTHING: Final = ReportQuestion()
"""Only the parts."""


def asked(derivation: ClosedForms, point: tuple[float, float, float], at: Mapping[str, float]) -> ReportQuestion:
    """A question about a point of the derivation's frame.

    Args:
        derivation: the closed forms.
        point: x, y, z in the frame (m).
        at: values (rad or m) of some of the coordinates that move it, by their names; angles near a multiple of 30°
            or 45° are exact.

    Raises:
        UnknownNameError: no such coordinate moves the frame.
    """
    by_name = {variable.joint: variable.symbol for variable in derivation.coordinates}
    turning = {joint.variable.symbol for joint in derivation.chain.joints if joint.revolute}
    values: dict[sp.Symbol, sp.Expr] = {}
    for name, value in at.items():
        if name not in by_name:
            where = derivation.robot.name
            raise UnknownNameError("unknown-coordinate", "coordinate", name, tuple(by_name), where=where)
        symbol = by_name[name]
        angle = exact.angle(repr(value), name, exact.Snaps(0.0)) if symbol in turning else None
        values[symbol] = _length(value) if angle is None or angle.has(sp.Float) else angle
    return ReportQuestion(sp.ImmutableMatrix([_length(x) for x in point]), values)


def _length(value: float) -> Any:
    return exact.length(repr(value))
