"""Where links and joints stand, and what of one robot a rigid displacement D carries onto the other.

All poses are in the base frame, with every joint at zero. The offsets of mimic joints are left out: they are
compared as what they are, and a joint below would show them too.
"""

from __future__ import annotations

from collections.abc import Container, Sequence

import numpy as np
from numpy.typing import NDArray

from pinscrew.changes.matching import Matching, Step
from pinscrew.changes.outcome import Near
from pinscrew.description.model import Description, Joint
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3, so3

__all__ = ["Features", "Poses", "apart", "between", "displaced", "kind", "link_steps", "motion_of", "turned"]


class Poses:
    """The poses of a description's links and joints at zero."""

    def __init__(self, description: Description) -> None:
        self.links: dict[str, FloatArray] = {description.root: np.eye(4)}
        self.joints: dict[str, FloatArray] = {}
        for joint in description.joints:
            T_base_joint = self.links[joint.parent] @ joint.T_parent_joint
            self.links[joint.child] = self.joints[joint.name] = T_base_joint

    @property
    def size(self) -> float:
        """Distance (m) of the farthest link from the base; at least 1."""
        return max(1.0, *(float(np.linalg.norm(T[:3, 3])) for T in self.links.values()))

    def direction(self, joint: Joint) -> FloatArray:
        """The axis of a joint in the base frame, shape (3,)."""
        return self.joints[joint.name][:3, :3] @ joint.axis


def kind(joint: Joint | None) -> str:
    """What of a joint's placement its motion depends on: its ``"line"``, ``"direction"``, ``"pose"``, or ``""``."""
    if joint is None:
        return ""
    kinds = {"revolute": "line", "continuous": "line", "prismatic": "direction", "fixed": ""}
    return kinds.get(joint.type, "pose")


def motion_of(step: Step) -> str:
    """What of the placement of a step's joint has to be the same in both robots; ``""`` where nothing has."""
    return kind(step.a) if kind(step.a) == kind(step.b) else ""


def link_steps(a: Description, b: Description, matching: Matching) -> list[tuple[str, str, int]]:
    """Each pair of links, and the last step that leads to either, or -1."""
    last_a, last_b = {a.root: -1}, {b.root: -1}
    for i, step in enumerate(matching.steps):
        if step.a:
            last_a[step.link_a] = i
        if step.b:
            last_b[step.link_b] = i
    return [(x, y, max(last_a[x], last_b[y])) for x, y in matching.links.items()]


def apart(T_a: FloatArray, T_b: FloatArray) -> tuple[float, float]:
    """Distance (m) and angle (rad) between two poses, shape (4, 4)."""
    return float(np.linalg.norm(T_b[:3, 3] - T_a[:3, 3])), float(turned(T_a[:3, :3], T_b[:3, :3]))


def turned(R: FloatArray, S: FloatArray) -> FloatArray:
    """Angle between rotations (..., 3, 3), exact for small ones too: ‖R - S‖ = 2√2 sin(θ/2)."""
    chord = np.sqrt(((R - S) ** 2).sum(axis=(-1, -2))) / np.sqrt(8.0)
    angle: FloatArray = 2.0 * np.arcsin(np.minimum(chord, 1.0))
    return angle


class Features:
    """All by which the two robots' motions are told apart: the n screws of joints and poses of tips, at zero.

    Attributes:
        own: for steps whose joint has a screw in both robots, its index among the features.
        tips: for steps that lead to tips, their indices among the features.
    """

    def __init__(
        self,
        a: Poses,
        b: Poses,
        steps: Sequence[Step],
        tips: Sequence[tuple[str, str, int]],
        either: Container[int],
        near: Near,
    ) -> None:
        """Take the steps' joints, and ``tips`` with the steps that lead to them; see `link_steps`.

        Steps in ``either`` have joints whose screws may be opposite.
        """
        self._near = near
        self._below: dict[int, list[int]] = {}
        for i, step in enumerate(steps):
            self._below.setdefault(step.above, []).append(i)
        matched = [(i, step.a, step.b) for i, step in enumerate(steps) if step.a and step.b and motion_of(step)]
        self.own = {i: n for n, (i, _, _) in enumerate(matched)}
        self.tips: dict[int, list[int]] = {}
        for n, (_, _, index) in enumerate(tips, len(matched)):
            self.tips.setdefault(index, []).append(n)
        kinds = [motion_of(steps[i]) for i in self.own] + ["pose"] * len(tips)
        poses = [(a.joints[x.name], b.joints[y.name]) for _, x, y in matched]
        poses += [(a.links[x], b.links[y]) for x, y, _ in tips]
        axes = [(a.direction(x), b.direction(y)) for _, x, y in matched] + [(np.zeros(3), np.zeros(3))] * len(tips)
        self._kinds = np.array(kinds, dtype=str)
        self._a, self._b = np.array(poses).reshape(-1, 2, 4, 4).swapaxes(0, 1)
        self._u, self._w = np.array(axes).reshape(-1, 2, 3).swapaxes(0, 1)
        self._either = np.array([i in either for i in self.own] + [False] * len(tips), dtype=bool)

    def nearest(self, step: int, most: int) -> list[int]:
        """Some steps below one, the nearest first."""
        found = list(self._below.get(step, []))
        for index in found:
            if len(found) >= most:
                break
            found += self._below.get(index, [])
        return found[:most]

    def explained(self, D: FloatArray) -> NDArray[np.bool_]:
        """Which features of b are those of a, displaced by D: shape (n,)."""
        R = D[:3, :3]
        shift = self._a[:, :3, 3] @ R.T + D[:3, 3] - self._b[:, :3, 3]
        u = self._u @ R.T
        cosine = (u * self._w).sum(axis=1)
        sine = np.linalg.norm(np.cross(u, self._w), axis=1)
        angles = np.arctan2(sine, np.where(self._either, abs(cosine), cosine))
        angles = np.where(self._kinds == "pose", turned(R @ self._a[:, :3, :3], self._b[:, :3, :3]), angles)
        off_line = np.linalg.norm(np.cross(self._w, shift), axis=1)
        free = np.where(self._kinds == "line", off_line, 0.0)
        lengths = np.where(self._kinds == "pose", np.linalg.norm(shift, axis=1), free)
        same: NDArray[np.bool_] = (angles <= self._near.angle) & (lengths <= self._near.length)
        return same


def displaced(X: FloatArray, T_base_frame: FloatArray, point: FloatArray) -> tuple[FloatArray, FloatArray]:
    """A displacement X as seen from a frame: that of a point of the base frame, and the rotation vector."""
    R = T_base_frame[:3, :3]
    shift = R.T @ (X[:3, :3] @ point + X[:3, 3] - point)
    turn = R.T @ so3.log(so3.project(X[:3, :3]))
    return shift, turn


def between(T_a: FloatArray, T_b: FloatArray) -> FloatArray:
    """The displacement that carries one pose onto another: T_b T_a⁻¹, both in the base frame."""
    return T_b @ se3.inverse(T_a)
