"""Samples reduced to voxels: counts, best manipulability, and from which directions the frame comes.

A reduction of reductions is the reduction of all: counts are added, manipulabilities maximised, directions united.
These don't depend on their order, so whoever computes the parts, the whole has the same bits.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray

__all__ = ["DIRECTIONS", "Gathering", "Voxels", "approach_directions", "direction_bits", "voxel_keys"]

DIRECTIONS: Final = 64
"""Directions that are told apart: one bit of a uint64 each, some 27° from the next."""
BITS: Final = 21
"""Bits of a voxel's index along each axis in its key."""
FARTHEST: Final = 2 ** (BITS - 1) - 1
"""The largest index of a voxel along an axis."""
FACE: Final = 1e-9
"""What is nearer than this part of a voxel below a face is on it: a plane on faces is not torn by rounding."""
AT_ONCE: Final = 1024
"""Vectors whose nearest directions are looked for at a time."""
BUFFERED: Final = 250_000
"""Rows that wait to be reduced, at least; the more, the fewer reductions."""


@dataclass(frozen=True, eq=False, slots=True)
class Voxels:
    """M voxels that samples fell into, in the order of their keys.

    Attributes:
        keys: one number for the three indices of each, shape (M,), int64.
        counts: samples in each, shape (M,), int64.
        best: largest manipulability among them, shape (M,).
        directions: bits of the approach directions among them, shape (M,), uint64.
    """

    keys: NDArray[np.int64]
    counts: NDArray[np.int64]
    best: FloatArray
    directions: NDArray[np.uint64]

    def __len__(self) -> int:
        return len(self.keys)

    @property
    def indices(self) -> NDArray[np.int64]:
        """Of each voxel along x, y and z, shape (M, 3): voxel i of edge a is [i a, (i + 1) a)."""
        mask = (1 << BITS) - 1
        parts = [(self.keys >> shift) & mask for shift in (2 * BITS, BITS, 0)]
        return np.stack(parts, axis=1) - (FARTHEST + 1)

    @classmethod
    def none(cls) -> Voxels:
        """No voxels."""
        return cls(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0), np.zeros(0, np.uint64))

    @classmethod
    def at(
        cls,
        indices: NDArray[np.integer],
        counts: NDArray[np.int64],
        best: FloatArray,
        directions: NDArray[np.uint64],
    ) -> Voxels:
        """Voxels by their `indices`."""
        return cls(_keys(indices.astype(np.int64)), counts, best, directions)

    @classmethod
    def reduced(cls, parts: list[Voxels]) -> Voxels:
        """The voxels of several reductions, or of samples with keys that may repeat, in one."""
        keys = np.concatenate([part.keys for part in parts])
        order = np.argsort(keys, kind="stable")
        keys = keys[order]
        if not len(keys):
            return cls.none()
        starts = np.flatnonzero(np.concatenate([[True], keys[1:] != keys[:-1]]))
        counts = np.concatenate([part.counts for part in parts])[order]
        best = np.concatenate([part.best for part in parts])[order]
        directions = np.concatenate([part.directions for part in parts])[order]
        return cls(
            keys[starts],
            np.add.reduceat(counts, starts),
            np.fmax.reduceat(best, starts),
            np.bitwise_or.reduceat(directions, starts),
        )


class Gathering:
    """Reductions as they come, reduced when enough wait: memory follows the voxels, not the samples."""

    def __init__(self, begun: Voxels) -> None:
        """Go on from ``begun``."""
        self._parts = [begun]
        self._waiting = 0

    def add(self, part: Voxels) -> None:
        """Take one in."""
        self._parts.append(part)
        self._waiting += len(part)
        if self._waiting > max(BUFFERED, len(self._parts[0])):
            self.total()

    def total(self) -> Voxels:
        """All that came so far."""
        if len(self._parts) > 1:
            self._parts, self._waiting = [Voxels.reduced(self._parts)], 0
        return self._parts[0]


def approach_directions() -> FloatArray:
    """The 64 directions: a Fibonacci lattice on the sphere, whose points stand for equal areas; unit, shape (64, 3).

    González, "Measurement of Areas on a Sphere Using Fibonacci and Latitude–Longitude Lattices", Mathematical
    Geosciences 42 (2010).
    """
    i = np.arange(DIRECTIONS) + 0.5
    z = 1.0 - 2.0 * i / DIRECTIONS
    radius, angle = np.sqrt(1.0 - z * z), np.pi * (1.0 + np.sqrt(5.0)) * i
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)


def direction_bits(z: FloatArray) -> NDArray[np.uint64]:
    """The bit of the approach direction nearest to each unit vector: shape (N, 3) to (N,).

    By plain sums, and the first of equally near ones: a matrix product may round differently from one number of
    threads to the next. In parts, whose cosines stay in the cache.
    """
    dx, dy, dz = approach_directions().T
    nearest = np.empty(len(z), np.uint64)
    for start in range(0, len(z), AT_ONCE):
        part = z[start : start + AT_ONCE]
        cosines = part[:, :1] * dx + part[:, 1:2] * dy + part[:, 2:] * dz
        nearest[start : start + AT_ONCE] = cosines.argmax(axis=1)
    return np.uint64(1) << nearest


def voxel_keys(positions: FloatArray, edge: float) -> NDArray[np.int64]:
    """The key of the voxel that each position is in: shape (N, 3) to (N,).

    Raises:
        InputError: if one is more than 2²⁰ voxels from the base.
    """
    indices = np.floor(positions / edge + FACE)
    if not (abs(indices) <= FARTHEST).all():
        what = f"a position is {abs(positions).max():g} m from the base, {abs(indices).max():.3g} voxels of {edge:g} m"
        raise InputError("voxel", what, remedy="take larger voxels")
    return _keys(indices.astype(np.int64))


def _keys(indices: NDArray[np.int64]) -> NDArray[np.int64]:
    """One number for the three indices of each voxel, in their order: shape (M, 3) to (M,)."""
    x, y, z = (indices + (FARTHEST + 1)).T
    keys: NDArray[np.int64] = (x << 2 * BITS) | (y << BITS) | z
    return keys
