"""Manipulability, of the position (m) and of the rotation (rad) apart, since no number mixes metres and radians.

w = σ1 ⋯ σr of the three rows of each (Yoshikawa, Int. J. Robotics Research 4:2, 1985,
doi:10.1177/027836498500400201), in the directions in which the arm can move at all: r is the rank that these rows have
almost everywhere. For r = 3 that is √det(J Jᵀ); the tip of an arm in a plane has r = 2, and w = 0 where it is stretched
out, not everywhere. One definition for sweeps and maps, `Batch`, and the page (`manipulability` in kinematics.js).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.ground.typing import FloatArray

__all__ = ["generic_ranks", "manipulability"]

TRIALS: Final = 64
"""Random configurations that tell a generic rank; all of them are singular with probability 0."""
ZERO: Final = 1e-9
"""Singular values below this part of the largest one, or of the robot's size, are none: rounding leaves 1e-15."""


def generic_ranks(engine: Engine, frame: str) -> tuple[int, int]:
    """Ranks of the translation's and of the rotation's rows at almost all configurations, in or out of the ranges."""
    robot = engine.robot
    rng = np.random.default_rng(0)
    q = np.tile(robot.neutral, (TRIALS, 1))
    for index, unit in enumerate(robot.coordinate_units):
        most = max(1.0, robot.reach) if unit == "m" else np.pi
        if unit:  # a quaternion keeps its value: it changes no rank
            q[:, index] = rng.uniform(-most, most, TRIALS)
    J = engine.jacobian(q, frame, "hybrid")
    # Where nothing moves, rounding leaves a part of the robot's size, or of a radian.
    return _rank(J[:, :3], robot.reach), _rank(J[:, 3:], 1.0)


def _rank(rows: FloatArray, size: float) -> int:
    """The largest rank of matrices, shape (N, 3, n), in which sizes of rounding are a part of ``size``."""
    values = np.linalg.svd(rows, compute_uv=False)
    return int((values > ZERO * max(size, float(values.max()))).sum(axis=1).max())


def manipulability(J: FloatArray, rank: int) -> FloatArray:
    """Yoshikawa's measure without singular values, where 1e-8 of the largest one is near enough.

    The r-th elementary symmetric function of the eigenvalues of J Jᵀ, from its principal minors, is (σ1 ⋯ σr)²,
    since σi = 0 for i > r.

    Args:
        J: three rows of Jacobians, shape (N, 3, n).
        rank: the generic rank r, 0 to 3.

    Returns:
        shape (N,).
    """
    if rank == 0:
        return np.full(len(J), np.nan)
    rows = np.ascontiguousarray(J.transpose(1, 2, 0))
    xx, yy, zz = ((row * row).sum(axis=0) for row in rows)
    square: FloatArray = xx + yy + zz
    xy, xz, yz = ((rows[i] * rows[j]).sum(axis=0) for i, j in ((0, 1), (0, 2), (1, 2)))
    if rank == 2:
        square = xx * yy - xy * xy + xx * zz - xz * xz + yy * zz - yz * yz
    elif rank == 3:
        square = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
    product: FloatArray = np.sqrt(np.maximum(square, 0.0))
    return product
