"""Manipulability of arms that can't move in all directions, such as those in a plane, where a kernel's is 0."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, cast

import numpy as np

from pinscrew.engines.compiled.chain import Part
from pinscrew.engines.measures import generic_ranks, manipulability
from pinscrew.engines.poe import PoE
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.robot.robot import Robot

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["in_fewer_directions"]

BLOCK: Final = 8192
"""Configurations whose Jacobians are stored at once."""


def in_fewer_directions(
    engine: PoE, q: ArrayLike, frames: str | Sequence[str] | None, part: Part, measures: FloatArray
) -> FloatArray:
    """The measures that a kernel made of the first min(3, n) singular values, those of lower rank computed anew.

    Args:
        engine: of the robot.
        q: coordinates, shape (..., nq).
        frames: a frame's name, several, or None for the tip.
        part: ``"translation"`` or ``"rotation"``.
        measures: shape (..., [F]); written over for frames of lower rank.
    """
    robot = engine.robot
    one = frames is None or isinstance(frames, str)
    names = [robot.frame(frame) for frame in ([cast("str | None", frames)] if one else cast("Sequence[str]", frames))]
    rows, which = (slice(0, 3), 0) if part == "translation" else (slice(3, 6), 1)
    for i, name in enumerate(names):
        rank = generic_ranks(engine, name)[which]
        if rank in (0, min(3, _moving(robot, name))):
            continue  # the kernel's is right; or nothing moves, and it is 0
        flat = np.asarray(q, dtype=np.float64).reshape(-1, robot.nq)
        target = (measures if one else measures[..., i]).reshape(-1)
        for start in range(0, len(flat), BLOCK):
            J = engine.jacobian(flat[start : start + BLOCK], name, "hybrid")
            target[start : start + BLOCK] = manipulability(J[:, rows], rank)
        if one:
            measures[...] = target.reshape(measures.shape)
        else:
            measures[..., i] = target.reshape(measures.shape[:-1])
    return measures


def _moving(robot: Robot, frame: str) -> int:
    """How many velocities move a frame."""
    motions = [robot.mechanism.motions[index] for index in robot.motions_above(frame)]
    return len({i for motion in motions for i in range(motion.velocities.start, motion.velocities.stop)})
