"""How close together points lie."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from pinscrew.ground.errors import MissingExtraError
from pinscrew.ground.typing import FloatArray

__all__ = ["density", "dimensions"]

RADIUS: Final = 0.04
"""Radius of the ball in which points are counted, as a part of the points' extent."""
FLAT: Final = 1e-9
"""Extent, as a part of the largest one, that is none."""


def dimensions(points: FloatArray) -> int:
    """In how many directions points spread: 0 to 3.

    Args:
        points: shape (N, 3).
    """
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    scale = math.sqrt(len(points)) * max(1.0, float(abs(points).max()))
    return int((spread > FLAT * scale).sum())


def density(points: FloatArray) -> tuple[FloatArray, int]:
    """Points per m, m² or m³ about each point, counted in a ball of 4 % of their extent.

    Args:
        points: shape (N, 3), m.

    Returns:
        shape (N,), and the number of dimensions k, so that the unit is 1/mᵏ.

    Raises:
        MissingExtraError: if scipy is not installed.
    """
    try:
        from scipy.spatial import cKDTree
    except ModuleNotFoundError:
        raise MissingExtraError("scipy is not installed", "workspace") from None
    k = dimensions(points)
    extent = float(np.ptp(points, axis=0).max())
    if k == 0:
        return np.full(len(points), float(len(points))), 0
    radius = RADIUS * extent
    counts = cKDTree(points).query_ball_point(points, radius, return_length=True)
    ball = {1: 2.0, 2: math.pi, 3: 4.0 / 3.0 * math.pi}[k] * radius**k
    return np.asarray(counts / ball, dtype=np.float64), k
