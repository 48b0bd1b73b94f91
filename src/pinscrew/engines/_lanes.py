"""Small matrices over a block of B configurations, the batch axis last: one numpy loop per entry."""

from __future__ import annotations

import numpy as np

from pinscrew.ground.typing import FloatArray

__all__ = [
    "apply",
    "cross",
    "matmul",
    "rodrigues_basis",
    "rotation",
    "rotation_of_quaternion",
    "store",
    "times",
    "turned_back",
]


def store(out: FloatArray, values: FloatArray) -> None:
    """Write values (m, n, B) into ``out`` (B, m, n): row by row, three times as fast as all at once."""
    for i, row in enumerate(values):
        out[:, i] = row.T


def times(R: FloatArray, A: FloatArray) -> FloatArray:
    """R (3, 3, B) times a constant (3,) or (3, k): (3, B) or (3, k, B)."""
    product: FloatArray = np.matmul(A.T, R)
    return product


def apply(R: FloatArray, x: FloatArray) -> FloatArray:
    """R (3, 3, B) times x (3, B)."""
    product: FloatArray = R[:, 0] * x[0] + R[:, 1] * x[1] + R[:, 2] * x[2]
    return product


def matmul(A: FloatArray, B: FloatArray) -> FloatArray:
    """(3, 3, B) times (3, 3, B)."""
    out: FloatArray = A[:, 0, None] * B[0]
    term = np.empty_like(out)
    for k in (1, 2):
        out += np.multiply(A[:, k, None], B[k], out=term)
    return out


def turned_back(R: FloatArray, J: FloatArray) -> FloatArray:
    """Rᵀ (3, 3, B) on both halves of J (6, n, B)."""
    out = np.empty_like(J)
    term = np.empty_like(J[0])
    for half in (0, 3):
        for i in range(3):
            row = out[half + i]
            np.multiply(R[0, i], J[half], out=row)
            row += np.multiply(R[1, i], J[half + 1], out=term)
            row += np.multiply(R[2, i], J[half + 2], out=term)
    return out


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Cross product along the first axis."""
    out = np.empty((3, *np.broadcast_shapes(a.shape[1:], b.shape[1:])))
    term = np.empty_like(out[0])
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        np.multiply(a[j], b[k], out=out[i])
        out[i] -= np.multiply(a[k], b[j], out=term)
    return out


def rodrigues_basis(w: FloatArray) -> FloatArray:
    """I, ŵ and ŵ² of a unit vector as the columns of a (9, 3) matrix, for `rotation`."""
    x, y, z = w
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.stack([np.eye(3), K, K @ K], axis=-1).reshape(9, 3)


def rotation(basis: FloatArray, theta: FloatArray) -> FloatArray:
    """Rotation (3, 3, B) by θ (B,) about a fixed axis: Rodrigues' formula, MLS eq. 2.14."""
    weights = np.empty((3, len(theta)))
    weights[0] = 1.0
    np.sin(theta, out=weights[1])
    half = np.sin(0.5 * theta)
    np.multiply(half, 2.0 * half, out=weights[2])  # 1 - cos θ without its cancellation at small angles
    return (basis @ weights).reshape(3, 3, -1)


def rotation_of_quaternion(quaternion: FloatArray) -> FloatArray:
    """Rotation (3, 3, B) of unit quaternions x, y, z, w (4, B)."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
