"""Rotations by three angles, and by quaternions: what robots' controllers write poses with."""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np

from pinscrew.ground.typing import FloatArray

__all__ = ["SEQUENCES", "from_angles", "from_quaternion", "to_angles", "to_quaternion"]

SEQUENCES: Final = tuple(
    "".join(axes) for axes in product("xyz", repeat=3) if axes[0] != axes[1] and axes[1] != axes[2]
)
"""The twelve, about axes that do not move, in the order of turning; in capitals about axes that move along."""


def from_angles(sequence: str, angles: FloatArray) -> FloatArray:
    """R for angles (rad), shape (N, 3): R₃R₂R₁ about fixed axes, R₁R₂R₃ about moving ones (capitals)."""
    R = np.broadcast_to(np.eye(3), (len(angles), 3, 3))
    for letter, angle in zip(sequence, angles.T, strict=True):
        one = _about("xyz".index(letter.lower()), angle)
        R = R @ one if sequence.isupper() else one @ R
    return np.asarray(R)


def to_angles(sequence: str, R: FloatArray) -> FloatArray:
    """Angles (rad) that give R, shape (N, 3). Where the first and the last axis fall into one, the last angle is 0.

    With R = R_i(a) R_j(b) R_k(c) and s = ±1, the parity of (i, j, and the third axis l). For k = l: R_ik = s sin b,
    tan a = -s R_jk / R_kk and tan c = -s R_ij / R_ii. For k = i: R_ii = cos b, tan a = R_ji / (-s R_li) and
    tan c = R_ij / (s R_il). (Diebel 2006, sec. 8.)
    """
    moving = sequence.lower() if sequence.isupper() else sequence[::-1]
    i, j, k = ("xyz".index(letter) for letter in moving)
    third = 3 - i - j
    s = 1.0 if (i, j) in ((0, 1), (1, 2), (2, 0)) else -1.0
    if k == i:
        first = np.arctan2(R[:, j, i], -s * R[:, third, i])
        b = np.arctan2(np.hypot(R[:, j, i], R[:, third, i]), R[:, i, i])
        locked = np.hypot(R[:, j, i], R[:, third, i]) < 1e-9
    else:
        first = np.arctan2(-s * R[:, j, k], R[:, k, k])
        b = np.arctan2(s * R[:, i, k], np.hypot(R[:, i, i], R[:, i, j]))
        locked = np.hypot(R[:, i, i], R[:, i, j]) < 1e-9
    # What is left once a and b are undone is R_k(c); where the axes fall into one, c is 0 and a is all of it.
    alone = np.arctan2(s * R[:, third, j], R[:, j, j])
    a = np.where(locked, alone, first)
    rest = np.swapaxes(_about(i, a) @ _about(j, b), -1, -2) @ R
    up, over = (k + 1) % 3, (k + 2) % 3
    c = np.where(locked, 0.0, np.arctan2(rest[:, over, up], rest[:, up, up]))
    found = np.stack([a, b, c], axis=-1)
    return found if sequence.isupper() else found[:, ::-1]


def from_quaternion(xyzw: FloatArray) -> FloatArray:
    """R for unit quaternions x, y, z, w, shape (N, 4): 1 + 2w[v]× + 2[v]×² (MLS eq. 2.21, with θ halved)."""
    v, w = xyzw[:, :3], xyzw[:, 3]
    hat = np.zeros((len(v), 3, 3))
    for i in range(3):
        hat[:, (i + 1) % 3, (i + 2) % 3], hat[:, (i + 2) % 3, (i + 1) % 3] = -v[:, i], v[:, i]
    return np.asarray(np.eye(3) + 2.0 * w[:, None, None] * hat + 2.0 * hat @ hat)


def to_quaternion(rotation_vectors: FloatArray) -> FloatArray:
    """Unit quaternions x, y, z, w of rotation vectors, shape (N, 3): (sin(θ/2) n, cos(θ/2))."""
    half = np.linalg.norm(rotation_vectors, axis=-1, keepdims=True) / 2.0
    return np.concatenate([np.sinc(half / np.pi) / 2.0 * rotation_vectors, np.cos(half)], axis=-1)


def _about(axis: int, angle: FloatArray) -> FloatArray:
    R = np.zeros((len(angle), 3, 3))
    after, last = (axis + 1) % 3, (axis + 2) % 3
    R[:, axis, axis] = 1.0
    R[:, after, after] = R[:, last, last] = np.cos(angle)
    R[:, last, after] = np.sin(angle)
    R[:, after, last] = -R[:, last, after]
    return R
