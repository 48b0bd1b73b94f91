"""A joint's screw as sympy has it."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

__all__ = ["JointScrew"]


@dataclass(frozen=True, slots=True)
class JointScrew:
    """A joint's screw at zero, in the base frame or the frame that is taken for it.

    Attributes:
        joint: the joint's name.
        revolute: whether it turns; otherwise it slides.
        omega: ω, unit vector, shape (3, 1); zero if it slides.
        q: a point of the axis (m), shape (3, 1).
        v: -ω × q, or the direction in which it slides; shape (3, 1).
        value: its value (rad or m) in terms of the coordinates.
    """

    joint: str
    revolute: bool
    omega: sp.ImmutableMatrix
    q: sp.ImmutableMatrix
    v: sp.ImmutableMatrix
    value: sp.Expr

    @property
    def twist(self) -> sp.ImmutableMatrix:
        """ξ = (v, ω), shape (6, 1)."""
        return sp.ImmutableMatrix.vstack(self.v, self.omega)
