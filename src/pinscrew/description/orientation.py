"""The two ways in which URDF writes a rotation: roll, pitch and yaw, and since 1.2 a quaternion."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from pinscrew.ground.typing import FloatArray

__all__ = ["of_origin", "of_quaternion", "of_rpy", "to_rpy"]


def of_rpy(roll: float, pitch: float, yaw: float) -> FloatArray:
    """Rz(yaw) Ry(pitch) Rx(roll), URDF's meaning of rpy (rad): shape (3, 3)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def of_quaternion(quaternion: Sequence[float]) -> FloatArray:
    """The rotation of a quaternion x, y, z, w that need not be of unit length, but not zero: shape (3, 3).

    ``R = I + 2 w [u] + 2 [u]²`` of a unit quaternion (u, w): MLS eq. 2.17 with u = ω sin(θ/2), w = cos(θ/2).
    """
    x, y, z, w = np.asarray(quaternion, dtype=np.float64) / math.hypot(*quaternion)
    u = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    R: FloatArray = np.eye(3) + 2.0 * w * u + 2.0 * u @ u
    return R


def to_rpy(R: FloatArray) -> tuple[float, float, float]:
    """Roll, pitch in [-π/2, π/2] and yaw (rad) of a rotation, shape (3, 3); the yaw is 0 where only a sum counts.

    The last row of `of_rpy` is (-sin p, cos p sin r, cos p cos r) and its first column (cos y cos p, sin y cos p,
    -sin p). Rz(yaw)ᵀ R = Ry(pitch) Rx(roll) has (0, cos r, -sin r) as its second row: pitch and roll are read off it,
    so that they fit the yaw even where cos p is small and the yaw has few digits.
    """
    cosine = math.hypot(R[0, 0], R[1, 0])
    yaw = math.atan2(R[1, 0], R[0, 0]) if cosine >= 1e-12 else 0.0
    c, s = math.cos(yaw), math.sin(yaw)
    roll = math.atan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1])
    return roll, math.atan2(-R[2, 0], c * R[0, 0] + s * R[1, 0]), yaw


def of_origin(attributes: Mapping[str, str]) -> FloatArray:
    """The rotation of a checked ``<origin>``, from its ``quat_xyzw`` or its ``rpy``: shape (3, 3)."""
    if "quat_xyzw" in attributes:
        return of_quaternion([float(word) for word in attributes["quat_xyzw"].split()])
    roll, pitch, yaw = (float(word) for word in attributes.get("rpy", "0 0 0").split())
    return of_rpy(roll, pitch, yaw)
