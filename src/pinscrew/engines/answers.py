"""What engines give: their view of a joint, all their answers at once, and a question that is bound."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from pinscrew.ground.typing import ArrayLike, FloatArray, JacobianKind

__all__ = ["Answers", "Bound", "JointView"]


@dataclass(frozen=True, slots=True)
class JointView:
    """A joint as an engine's own parser saw it.

    Attributes:
        type: ``"fixed"``, ``"revolute"`` (continuous ones too), ``"prismatic"``, ``"planar"`` or ``"floating"``.
        parent: the link above.
        child: the link below.
        limits: lower and upper limit of its value, or None where it has no single one or no bounds.
        mimic: joint followed, multiplier and offset, or None.
    """

    type: str
    parent: str
    child: str
    limits: tuple[float, float] | None = None
    mimic: tuple[str, float, float] | None = None


@dataclass(frozen=True, slots=True)
class Answers:
    """All answers of an engine about some frames at a batch of configurations.

    Attributes:
        poses: shape (N, F, 4, 4).
        jacobians: by kind, shape (N, F, 6, nv).
        derivatives: time derivatives of the Jacobians, by kind, shape (N, F, 6, nv).
    """

    poses: FloatArray
    jacobians: Mapping[JacobianKind, FloatArray]
    derivatives: Mapping[JacobianKind, FloatArray]


class Bound(Protocol):
    """A question about a frame that has been checked once: ``T, J = ask(q)``."""

    def __call__(
        self, q: ArrayLike, *, out: tuple[FloatArray, FloatArray] | None = None
    ) -> tuple[FloatArray, FloatArray]:
        """Pose and Jacobian of the frame: ``q`` (nq,) to (4, 4) and (6, nv), those of ``out`` if given."""
