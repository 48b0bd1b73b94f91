"""Where links and joints stand, and rigid displacements between places.

All poses are in the base frame, with every joint at zero. The offsets of mimic joints are left out: they are
compared as what they are, and a joint below would show them too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pinscrew.changes.matching import JointPair
from pinscrew.changes.outcome import Tolerance
from pinscrew.description.model import Description, Joint
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3, so3

__all__ = ["Move", "Poses", "common_locus", "displacement", "locus", "seen_from", "turned"]


@dataclass(frozen=True)
class Move:
    """A rigid displacement, as seen from the frame of a link.

    Attributes:
        shift: how far the point that it is about is moved, along the frame's axes, shape (3,), m.
        turn: rotation vector in that frame, shape (3,), rad.
        frame: the link, by its name in b.
    """

    shift: FloatArray
    turn: FloatArray
    frame: str

    @property
    def length(self) -> float:
        """How far, m."""
        return float(np.linalg.norm(self.shift))

    @property
    def angle(self) -> float:
        """By what angle, rad."""
        return float(np.linalg.norm(self.turn))

    def within(self, tolerance: Tolerance) -> bool:
        """Whether it is none, to a tolerance. Farther out, a small angle may all the same move things far."""
        return self.length <= tolerance.length and self.angle <= tolerance.angle


class Poses:
    """The poses of a description's links and joints at zero, shapes (4, 4), and its tips."""

    def __init__(self, description: Description) -> None:
        self.links: dict[str, FloatArray] = {description.root: np.eye(4)}
        self.joints: dict[str, FloatArray] = {}
        for joint in description.joints:
            T_base_joint = self.links[joint.parent] @ joint.T_parent_joint
            self.links[joint.child] = self.joints[joint.name] = T_base_joint
        self.tips = frozenset(description.leaves)

    @property
    def size(self) -> float:
        """Distance (m) of the farthest link from the base; at least 1."""
        return max(1.0, *(float(np.linalg.norm(T[:3, 3])) for T in self.links.values()))

    def direction(self, joint: Joint) -> FloatArray:
        """The axis of a joint in the base frame, shape (3,)."""
        return self.joints[joint.name][:3, :3] @ joint.axis


def locus(joint: Joint | None) -> str:
    """What of a joint's placement its motion depends on: its ``"line"``, ``"direction"``, ``"pose"``, or ``""``."""
    if joint is None:
        return ""
    loci = {"revolute": "line", "continuous": "line", "prismatic": "direction", "fixed": ""}
    return loci.get(joint.type, "pose")


def common_locus(pair: JointPair) -> str:
    """What of the placement of a pair's joint has to be the same in both robots; ``""`` where nothing has."""
    return locus(pair.a) if locus(pair.a) == locus(pair.b) else ""


def displacement(T_a: FloatArray, T_b: FloatArray) -> FloatArray:
    """The X that carries one pose onto another: ``X T_a = T_b``, so ``X = T_b T_a⁻¹``, in the base frame."""
    return T_b @ se3.inverse(T_a)


def seen_from(T_base_frame: FloatArray, X: FloatArray, point: FloatArray, frame: str) -> Move:
    """A displacement X of the base frame as seen from another frame.

    A point p goes to ``R_X p + p_X``: in the frame, whose rotation is R, it is shifted by ``Rᵀ (R_X p + p_X - p)``, and
    the rotation vector ``log R_X`` reads ``Rᵀ log R_X`` there (``R exp(u^) Rᵀ = exp((R u)^)``, MLS eq. 2.14 and lemma
    2.1).

    Args:
        T_base_frame: the frame, shape (4, 4).
        X: the displacement, shape (4, 4).
        point: the point whose displacement is told, in the base frame, shape (3,).
        frame: what to call the frame.
    """
    R = T_base_frame[:3, :3]
    shift = R.T @ (X[:3, :3] @ point + X[:3, 3] - point)
    return Move(shift, R.T @ so3.log(so3.project(X[:3, :3])), frame)


def turned(R: FloatArray, S: FloatArray) -> FloatArray:
    """Angle between rotations (..., 3, 3), exact for small ones too.

    ``‖R - S‖² = ‖1 - Rᵀ S‖² = 2 (3 - tr Rᵀ S) = 4 (1 - cos θ) = 8 sin²(θ/2)`` in the Frobenius norm.
    """
    chord = np.sqrt(((R - S) ** 2).sum(axis=(-1, -2))) / np.sqrt(8.0)
    angle: FloatArray = 2.0 * np.arcsin(np.minimum(chord, 1.0))
    return angle
