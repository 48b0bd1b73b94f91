"""Where the engines are compared: zero, the limits, and at random within and far outside them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from pinscrew.ground.typing import FloatArray
from pinscrew.robot.robot import Robot

__all__ = ["Configurations", "angles", "configurations", "effective_limits", "sizes", "speeds"]

FAR_ANGLE: Final = 20 * np.pi
"""Ten turns (rad): far outside any limits, yet rounding of the angle itself stays below 1e-14."""
FAR_DISTANCE: Final = 10.0
"""Displacements far outside, as a multiple of the robot's size."""
CORNERS: Final = 16


@dataclass(frozen=True, slots=True)
class Configurations:
    """N labelled configurations with velocities.

    Attributes:
        labels: what each is, such as ``"zero"`` or ``"random 17"``.
        q: shape (N, nq).
        qd: shape (N, nv), of norm 1.
        scales: shape (N,): max(1, length in metres of the longest way through the robot).
        inside: how many of them, from the first, are within the limits.
    """

    labels: tuple[str, ...]
    q: FloatArray
    qd: FloatArray
    scales: FloatArray
    inside: int

    def blocks(self, size: int) -> Iterator[slice]:
        """Slices of at most ``size`` configurations."""
        return (slice(start, start + size) for start in range(0, len(self.q), size))

    def take(self, indices: npt.NDArray[np.intp]) -> Configurations:
        """Some of them."""
        labels = tuple(self.labels[i] for i in indices)
        inside = int((indices < self.inside).sum())
        return Configurations(labels, self.q[indices], self.qd[indices], self.scales[indices], inside)


def effective_limits(robot: Robot) -> FloatArray:
    """The robot's limits with something finite where there is none: shape (nq, 2).

    Unlimited angles get ±π, unlimited displacements ± the robot's size, and no limit is farther than what
    counts as far outside.
    """
    size = max(1.0, robot.reach)
    limits = robot.limits.copy()
    turning = angles(robot)
    wide = np.where(turning, np.pi, size)
    far = np.where(turning, FAR_ANGLE, FAR_DISTANCE * size)
    limits[:, 0] = np.where(np.isfinite(limits[:, 0]), limits[:, 0], -wide)
    limits[:, 1] = np.where(np.isfinite(limits[:, 1]), limits[:, 1], wide)
    return np.clip(limits, -far[:, None], far[:, None])


def configurations(robot: Robot, samples: int, seed: int) -> Configurations:
    """Zero, the limits' corners and midpoint, ``samples`` random within limits, a quarter as many far outside."""
    rng = np.random.default_rng(seed)
    limits = effective_limits(robot)
    lower, upper = limits.T
    size = max(1.0, robot.reach)
    # As far that no mimic turns its joint farther than this: what is left of an angle is off by its size times 2⁻⁵³.
    far = np.where(angles(robot), FAR_ANGLE, FAR_DISTANCE * size)
    for motion in robot.mechanism.motions:
        if motion.joint.mimic is not None:
            far[motion.q] = min(far[motion.q], FAR_ANGLE / max(1.0, abs(motion.multiplier)))
    far = np.maximum(far, abs(limits).max(axis=1))
    outside = max(1, samples // 4)
    corners = rng.integers(0, 2, (CORNERS, robot.nq)).astype(bool)
    groups = {
        "zero": robot.neutral[None],
        "lower limits": lower[None],
        "upper limits": upper[None],
        "middle": 0.5 * (lower + upper)[None],
        "corner": np.where(corners, lower, upper),
        "random": rng.uniform(lower, upper, (samples, robot.nq)),
        "far outside": rng.uniform(-far, far, (outside, robot.nq)),
    }
    q = np.concatenate(list(groups.values()))
    for motion in robot.mechanism.motions:
        if motion.joint.type == "floating":
            quaternions = rng.normal(size=(len(q) - 1, 4))
            quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
            q[1:, motion.q + 3 : motion.q + 7] = quaternions
    qd = rng.uniform(-1.0, 1.0, (len(q), robot.nv))
    if robot.nv:
        qd /= np.linalg.norm(qd, axis=1, keepdims=True)
    labels = [f"{name} {i}" if len(group) > 1 else name for name, group in groups.items() for i in range(len(group))]
    return Configurations(tuple(labels), q, qd, sizes(robot, q), len(q) - outside)


def angles(robot: Robot) -> npt.NDArray[np.bool_]:
    """Which coordinates are angles (or quaternions', whose range does not matter), shape (nq,)."""
    return ~robot.mechanism.coordinates.slides


def speeds(robot: Robot) -> FloatArray:
    """How many times faster than its own velocity each of them moves a joint, at the most and at least 1: shape (nv,).

    The columns of a Jacobian, and with them their rounding, grow with the multipliers of mimics: ``J_i = Σ m_k ξ_k``
    over the joints k that coordinate i drives. So errors in them are divided by the largest ``|m_k|``.
    """
    fastest = np.ones(robot.nv)
    for motion in robot.mechanism.motions:
        if motion.joint.mimic is not None:
            fastest[motion.v] = max(fastest[motion.v], abs(motion.multiplier))
    return fastest


def sizes(robot: Robot, q: FloatArray) -> FloatArray:
    """What errors in metres are divided by: max(1, longest way through the robot, its joints drawn out), (N,)."""
    length: FloatArray = np.full(len(q), robot.reach)
    for motion in robot.mechanism.motions:
        if motion.joint.type == "prismatic":
            length += abs(motion.multiplier * q[:, motion.q])
        elif motion.joint.type in ("floating", "planar"):
            count = 3 if motion.joint.type == "floating" else 2
            length += np.linalg.norm(q[:, motion.q : motion.q + count], axis=1)
    return np.maximum(1.0, length)
