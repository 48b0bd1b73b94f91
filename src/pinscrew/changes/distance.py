"""How far apart the tips of two robots come at equal coordinates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from pinscrew.changes.geometry import turned
from pinscrew.changes.outcome import Displacement, TipPlace
from pinscrew.engines.poe import PoE
from pinscrew.ground.typing import FloatArray
from pinscrew.robot.robot import Robot
from pinscrew.verification.configurations import configurations, effective_limits

__all__ = ["columns", "largest"]

CONFIGURATIONS: Final = 2000
POSES: Final = 20000
"""Poses that are computed of each robot, at the most: fewer configurations for many tips."""
FEWEST: Final = 100
TURNING: Final = {"revolute", "continuous"}
"""Types whose coordinates are the same."""


def columns(a: Robot, b: Robot, joints: Mapping[str, str]) -> list[int] | None:
    """Where in b's coordinates each of a's is, or None if the two do not have the same."""
    if len(a.joint_names) != len(b.joint_names) or a.nq != b.nq:
        return None
    mine, theirs = ({m.joint.name: m for m in r.mechanism.motions if m.joint.mimic is None} for r in (a, b))
    places: list[int] = []
    for name, motion in mine.items():
        # Names that were swapped mean other coordinates now.
        other = theirs.get(name) or theirs.get(joints.get(name, ""))
        if other is None:
            return None
        types = {motion.joint.type, other.joint.type}
        if len(types) > 1 and types != TURNING:
            return None
        places += range(b.nq)[other.coordinates]
    return places if len(set(places)) == len(places) else None


def largest(a: Robot, b: Robot, columns: Sequence[int], tips: Sequence[tuple[str, str]]) -> Displacement | None:
    """The largest displacement of the tips over the limits that both robots have in common.

    At zero, the limits' corners and 2000 random configurations (fewer for many tips); always the same ones.

    Args:
        a: the first robot.
        b: the second.
        columns: where in b's coordinates each of a's is.
        tips: names of tip frames, in a and in b.
    """
    if not tips:
        return None
    samples = max(FEWEST, min(CONFIGURATIONS, POSES // len(tips)))
    drawn = configurations(a, samples, seed=0)
    q_a = _common(a, b, columns, drawn.q[: drawn.inside])
    q_b = np.empty_like(q_a)
    q_b[:, list(columns)] = q_a
    T_a, T_b = PoE(a).poses(q_a, [tip for tip, _ in tips]), PoE(b).poses(q_b, [tip for _, tip in tips])
    lengths = np.linalg.norm(T_b[..., :3, 3] - T_a[..., :3, 3], axis=-1)
    angles = turned(T_a[..., :3, :3], T_b[..., :3, :3])
    farthest = []
    for errors in (lengths.T, angles.T):
        tip, at = np.unravel_index(int(errors.argmax()), errors.shape)
        name = tips[int(tip)][0]
        farthest.append((float(errors[tip, at]), TipPlace(name, _q(a, q_a[at], name))))
    return Displacement(*farthest[0], *farthest[1])


def _q(robot: Robot, q: FloatArray, tip: str) -> dict[str, float]:
    """The coordinates that move a tip, by their names."""
    moving: dict[str, float] = {}
    for motion in (robot.mechanism.motions[i] for i in robot.motions_above(tip)):
        names = robot.coordinate_names[motion.coordinates]
        moving.update(zip(names, q[motion.coordinates].tolist(), strict=True))
    return moving


def _common(a: Robot, b: Robot, columns: Sequence[int], q: FloatArray) -> FloatArray:
    """Configurations of a, brought within b's limits too where the two overlap."""
    limits_a, limits_b = effective_limits(a), effective_limits(b)[list(columns)]
    both = np.stack([limits_a, limits_b])
    lower, upper = both[..., 0].max(axis=0), both[..., 1].min(axis=0)
    overlap = lower <= upper
    lower, upper = np.where(overlap, lower, limits_a[:, 0]), np.where(overlap, upper, limits_a[:, 1])
    bounded = np.isfinite(a.limits).any(axis=1)
    return np.where(bounded, np.clip(q, lower, upper), q)
