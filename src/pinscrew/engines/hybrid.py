"""Engines made of other people's kinematics: poses and hybrid Jacobians are theirs, the rest follows from these.

A library in general answers with the pose of a body and the velocity of a point of it in the axes of the world: the
hybrid Jacobian. The other two kinds follow by its definition and by where the point is, with the library's own pose,
and nothing here uses our screws:

    J_b = diag(Rᵀ, Rᵀ) J_h,    J_s = [v_h + p × ω; ω],    and their derivatives by the product rule.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from pinscrew.description import markup
from pinscrew.engines.base import Answers, CheckedEngine
from pinscrew.ground.errors import UnsupportedError
from pinscrew.ground.typing import KINDS, FloatArray, JacobianKind
from pinscrew.robot.robot import FLOATING_JOINT, Robot

__all__ = ["MAX_LINKS", "Drive", "HybridEngine", "Told", "drive", "joint_names"]

MAX_LINKS: Final = 1000
"""MuJoCo's compiler takes 5 s for a chain of 1000 links and minutes for 3000; roboticstoolbox recurses."""


@dataclass(frozen=True, slots=True)
class Told:
    """What a library says of F frames at N configurations, per unit of our velocities.

    Attributes:
        poses: shape (N, F, 4, 4).
        J: hybrid Jacobians, shape (N, F, 6, nv).
        J_rate: their time derivatives along ``qd``, shape (N, F, 6, nv).
        qd: shape (N, nv).
    """

    poses: FloatArray
    J: FloatArray
    J_rate: FloatArray
    qd: FloatArray

    def jacobian(self, kind: JacobianKind) -> FloatArray:
        """The Jacobians of a kind, shape (N, F, 6, nv)."""
        if kind == "hybrid":
            return self.J
        return self._turned_back(self.J) if kind == "body" else self._at_origin(self.J)

    def derivative(self, kind: JacobianKind) -> FloatArray:
        """The time derivatives of the Jacobians of a kind, shape (N, F, 6, nv)."""
        if kind == "hybrid":
            return self.J_rate
        v, w = np.split(self.J @ self.qd[:, None, :, None], 2, axis=-2)
        if kind == "body":  # d(Rᵀ x) = Rᵀ (dx - ω × x)
            parts = np.split(self.J, 2, axis=-2)
            turning = np.concatenate([np.cross(w, part, axis=-2) for part in parts], axis=-2)
            return self._turned_back(self.J_rate - turning)
        out = self._at_origin(self.J_rate)
        out[..., :3, :] += np.cross(v, self.J[..., 3:, :], axis=-2)
        return out

    def _turned_back(self, J: FloatArray) -> FloatArray:
        R_transposed = np.swapaxes(self.poses[..., :3, :3], -1, -2)
        return np.concatenate([R_transposed @ J[..., :3, :], R_transposed @ J[..., 3:, :]], axis=-2)

    def _at_origin(self, J: FloatArray) -> FloatArray:
        out = J.copy()
        out[..., :3, :] += np.cross(self.poses[..., :3, 3, None], J[..., 3:, :], axis=-2)
        return out


class HybridEngine(CheckedEngine):
    """A `CheckedEngine` whose subclass asks a library for poses and hybrid Jacobians."""

    def __init__(self, robot: Robot) -> None:
        """Check that the library will not choke on the robot.

        Raises:
            UnsupportedError: if it has more than `MAX_LINKS` links.
        """
        super().__init__(robot)
        if len(robot.frame_names) > MAX_LINKS:
            what = f"{len(robot.frame_names)} links are more than the {MAX_LINKS} that a witness is asked to take"
            raise UnsupportedError("witness-size", what, file=robot.description.file, remedy="do without")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._robot,)

    def answers(self, q: FloatArray, qd: FloatArray, frames: Sequence[str]) -> Answers:
        """Everything about ``frames`` at a flat batch, in one pass of the library; see the base class."""
        q, qd, names = self._asked(q, qd, frames)
        told = self._told(q, qd, names)
        return Answers(
            told.poses, {kind: told.jacobian(kind) for kind in KINDS}, {kind: told.derivative(kind) for kind in KINDS}
        )

    @abstractmethod
    def _told(self, q: FloatArray, qd: FloatArray | None, frames: Sequence[str]) -> Told:
        """What the library says at ``q`` (N, nq) along ``qd`` (N, nv); without ``qd``, no derivatives."""

    def _poses(self, q: FloatArray, frame: str) -> FloatArray:
        return self._still(q, frame).poses[:, 0]

    def _jacobians(self, q: FloatArray, frame: str, kind: JacobianKind) -> FloatArray:
        return self._still(q, frame).jacobian(kind)[:, 0]

    def _poses_and_jacobians(self, q: FloatArray, frame: str, kind: JacobianKind) -> tuple[FloatArray, FloatArray]:
        told = self._still(q, frame)
        return told.poses[:, 0], told.jacobian(kind)[:, 0]

    def _derivatives(self, q: FloatArray, qd: FloatArray, frame: str, kind: JacobianKind) -> FloatArray:
        return self._told(q, qd, [frame]).derivative(kind)[:, 0]

    def _still(self, q: FloatArray, frame: str) -> Told:
        return self._told(q, None, [frame])


@dataclass(frozen=True, slots=True)
class Drive:
    """How a joint of the library's gets its value from ours: ``multiplier * q[q] + offset``, and qd[v] likewise."""

    q: int
    v: int
    multiplier: float = 1.0
    offset: float = 0.0


def drive(robot: Robot, joint: str, mimics: Mapping[str, tuple[str, float, float]]) -> Drive | None:
    """What drives a joint, if ``mimics`` is what the library knows of joints that follow others.

    None for a joint that is independent to the library and has no coordinate of ours: it stays at zero.
    """
    multiplier, offset = 1.0, 0.0
    while joint in mimics:
        joint, factor, shift = mimics[joint]
        multiplier, offset = multiplier * factor, offset + multiplier * shift
    coordinates = robot.mechanism.coordinates
    if joint not in coordinates.q:
        return None
    return Drive(coordinates.q[joint], coordinates.v[joint], multiplier, offset)


def joint_names(robot: Robot) -> dict[str, str]:
    """The name of the joint that leads to each link, as the file has it: libraries may forget those of fixed joints."""
    root = markup.parse(robot.description.text, robot.description.file)
    names = {
        child.attributes["link"]: joint.attributes["name"]
        for joint in root.all("joint")
        for child in joint.all("child")
    }
    if robot.floating_base:
        names[robot.description.joints[0].child] = FLOATING_JOINT
    return names
