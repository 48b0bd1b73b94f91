"""The twist of a frame and the velocity of a point that moves with it, by one engine."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.ground.typing import KINDS, ArrayLike, FloatArray, JacobianKind
from pinscrew.lie import se3

__all__ = ["FrameVelocity", "difference", "frame_velocity"]


@dataclass(frozen=True, slots=True)
class FrameVelocity:
    """How a frame and a point fixed in it move.

    Attributes:
        twists: V^s, V^b and V^h, each (v, ω) of shape (6,), m/s and rad/s.
        pose: T_base_frame, shape (4, 4).
        point: the point in the frame, shape (3,), m.
        point_base: the point in the base, shape (3,), m.
        point_velocity: its velocity in the axes of the base, v = V̂^s q, shape (3,), m/s.
        point_velocity_body: the same in the axes of the frame, v = V̂^b q, shape (3,), m/s.
    """

    twists: dict[JacobianKind, FloatArray]
    pose: FloatArray
    point: FloatArray
    point_base: FloatArray
    point_velocity: FloatArray
    point_velocity_body: FloatArray


def frame_velocity(
    engine: Engine, q: ArrayLike, qd: ArrayLike, frame: str | None = None, point: ArrayLike = (0.0, 0.0, 0.0)
) -> FrameVelocity:
    """The twist of a frame, and the velocity of a point fixed in it: MLS eq. 2.52 and 2.54.

    The engine gives each twist by itself; the velocity in the base's axes is from the spatial twist and the place of
    the point in the base, that in the frame's from the body twist and its place in the frame.

    Args:
        engine: whom to ask.
        q: coordinates, shape (nq,), rad and m.
        qd: their velocities, shape (nv,), rad/s and m/s.
        frame: a link's name; None for the robot's tip.
        point: in the frame, shape (3,), m; its origin by default.

    Raises:
        InputError, UnknownNameError, AmbiguousTipError: see `Engine.velocity`.
    """
    pose = engine.fk(q, frame)
    twists = {kind: engine.velocity(q, qd, frame, kind) for kind in KINDS}
    in_frame = np.asarray(point, dtype=np.float64)
    in_base = pose[:3, :3] @ in_frame + pose[:3, 3]
    # v = V̂ q̄ with q̄ = (q, 1): the last entry of a velocity is 0, as that of the difference of two points is.
    moving = np.asarray(se3.hat(twists["spatial"]) @ np.append(in_base, 1.0))[:3]
    moving_body = np.asarray(se3.hat(twists["body"]) @ np.append(in_frame, 1.0))[:3]
    return FrameVelocity(twists, pose, in_frame, in_base, moving, moving_body)


def difference(a: FrameVelocity, b: FrameVelocity, size: float) -> float:
    """The largest difference of two engines' answers, metres divided by ``size``; infinite where one is NaN."""
    angular = [abs(a.twists[kind][3:] - b.twists[kind][3:]) for kind in KINDS]
    linear = [abs(a.twists[kind][:3] - b.twists[kind][:3]) / size for kind in KINDS]
    points = [
        abs(a.point_base - b.point_base) / size,
        abs(a.point_velocity - b.point_velocity) / size,
        abs(a.point_velocity_body - b.point_velocity_body) / size,
    ]
    largest = float(np.max([*angular, *linear, *points]))
    return largest if np.isfinite(largest) else np.inf
