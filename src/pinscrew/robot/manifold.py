"""Moving a configuration along velocities: addition, but for the angles and quaternions of free joints."""

from __future__ import annotations

import numpy as np

from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.robot.robot import Robot

__all__ = ["integrate", "quaternion_starts"]


def integrate(robot: Robot, q: FloatArray, step: FloatArray) -> FloatArray:
    """The configuration reached from ``q`` by keeping the velocities ``step`` for unit time.

    Exact for constant velocities; Pinocchio's ``integrate``, in our coordinates.

    Args:
        robot: whose coordinates they are.
        q: coordinates, shape (..., nq); rad, m, and unit quaternions.
        step: velocities times time, shape (..., nv); batch axes broadcast.

    Returns:
        shape (..., nq).
    """
    batch = np.broadcast_shapes(q.shape[:-1], step.shape[:-1])
    out = np.broadcast_to(q, (*batch, robot.nq)).copy()
    for motion in robot.mechanism.motions:
        if motion.joint.mimic is not None:
            continue
        velocity = step[..., motion.velocities]
        if motion.joint.type == "planar":
            _move_planar(out[..., motion.coordinates], velocity)
        elif motion.joint.type == "floating":
            _move_floating(out[..., motion.coordinates], velocity)
        else:
            out[..., motion.q] += velocity[..., 0]
    return out


def _move_planar(coordinates: FloatArray, velocity: FloatArray) -> None:
    """(x, y, θ) moved in place by a twist (vx, vy, ωz) in the moving frame."""
    twist = np.zeros((*velocity.shape[:-1], 6))
    twist[..., [0, 1, 5]] = velocity
    moved = se3.exp(twist)[..., :2, 3]
    c, s = np.cos(coordinates[..., 2]), np.sin(coordinates[..., 2])
    coordinates[..., 0] += c * moved[..., 0] - s * moved[..., 1]
    coordinates[..., 1] += s * moved[..., 0] + c * moved[..., 1]
    coordinates[..., 2] += velocity[..., 2]


def _move_floating(coordinates: FloatArray, velocity: FloatArray) -> None:
    """Position and quaternion (x, y, z, w) moved in place by a twist (v, ω) in the moving frame."""
    a, w = coordinates[..., 3:6].copy(), coordinates[..., 6:7].copy()
    moved = se3.exp(velocity)[..., :3, 3]
    # R p = p + 2w(a×p) + 2a×(a×p) for the unit quaternion (a, w).
    crossed = np.cross(a, moved)
    coordinates[..., :3] += moved + 2.0 * (w * crossed + np.cross(a, crossed))
    half = 0.5 * velocity[..., 3:]
    angle = np.linalg.norm(half, axis=-1, keepdims=True)
    b, c = np.sinc(angle / np.pi) * half, np.cos(angle)
    coordinates[..., 3:6] = w * b + c * a + np.cross(a, b)
    coordinates[..., 6:7] = w * c - (a * b).sum(axis=-1, keepdims=True)
    coordinates[..., 3:7] /= np.linalg.norm(coordinates[..., 3:7], axis=-1, keepdims=True)


def quaternion_starts(robot: Robot) -> tuple[int, ...]:
    """Where the quaternions of floating joints start in ``q``."""
    floating = (m for m in robot.mechanism.motions if m.joint.type == "floating")
    return tuple(motion.q + 3 for motion in floating)
