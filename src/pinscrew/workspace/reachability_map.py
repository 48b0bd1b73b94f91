"""`ReachabilityMap`: what is known of each voxel that a frame reaches, and its file."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.workspace import archive
from pinscrew.workspace.blocks import block_count
from pinscrew.workspace.voxels import DIRECTIONS, Voxels, approach_directions

__all__ = ["Done", "ReachabilityMap", "read_map", "unfinished", "write_map"]

Done: TypeAlias = NDArray[np.bool_]
"""For each block of samples whether it is in a map."""

SCHEMA: Final = "pinscrew.reachability/1"
_SHAPES: Final = {"indices": ("i", (3,)), "counts": ("i", ()), "best": ("f", ()), "directions": ("u", ())}


@dataclass(frozen=True, eq=False)
class ReachabilityMap:
    """The M voxels that a frame's origin was found in.

    Attributes:
        voxels: indices, counts, best manipulability and approach directions of each.
        metadata: where they come from: robot and fingerprint, frame, ranges, voxel, samples, seed, engine,
            versions. Plain data.
    """

    voxels: Voxels = field(repr=False)
    metadata: archive.Metadata

    def __len__(self) -> int:
        return len(self.voxels)

    @property
    def voxel(self) -> float:
        """Edge of a voxel, m."""
        return float(self.metadata["voxel"])

    @property
    def centres(self) -> FloatArray:
        """Centres of the voxels in the base frame, shape (M, 3), m."""
        centres: FloatArray = self.voxel * (self.voxels.indices + 0.5).astype(np.float64)
        return centres

    @property
    def counts(self) -> NDArray[np.int64]:
        """Samples in each voxel, shape (M,)."""
        return self.voxels.counts

    @property
    def manipulability(self) -> FloatArray:
        """The largest translational manipulability met in each voxel, shape (M,); see `Measures`."""
        return self.voxels.best

    @property
    def directions(self) -> NDArray[np.uint64]:
        """Bit i is set where the frame's z axis came nearest to row i of `approach_directions`, shape (M,)."""
        return self.voxels.directions

    @property
    def coverage(self) -> FloatArray:
        """The part of the 64 approach directions that was met in each voxel, 0 to 1, shape (M,)."""
        bits = np.unpackbits(self.directions.astype("<u8").view(np.uint8).reshape(-1, 8), axis=1)
        part: FloatArray = bits.sum(axis=1) / DIRECTIONS
        return part

    @property
    def approach_directions(self) -> FloatArray:
        """The unit vectors in the base frame that the bits of `directions` stand for, shape (64, 3)."""
        return approach_directions()

    @property
    def volume(self) -> float:
        """Volume of the voxels, m³: for a planar arm that of a layer one voxel thick."""
        return len(self) * self.voxel**3

    def save(self, path: str | Path) -> None:
        """Write everything to an npz file, whole or not at all; ``numpy.load(path)`` reads it without pickle.

        Raises:
            InputError: if it can't be written.
        """
        write_map(Path(path), self.metadata, self.voxels, np.ones(block_count(self.metadata["samples"]), bool))

    @classmethod
    def load(cls, path: str | Path) -> ReachabilityMap:
        """Read a finished map.

        Raises:
            InputError: if there is no such file, or it is no map, or an unfinished or broken one.
        """
        metadata, voxels, done = read_map(Path(path))
        if not done.all():
            what = f"holds an unfinished map: {int(done.sum())} of {len(done)} blocks"
            raise InputError("unfinished", what, where=str(path), remedy="resume it")
        return cls(voxels, metadata)


def write_map(path: Path, metadata: archive.Metadata, voxels: Voxels, done: Done) -> None:
    """Write a map, finished or not, whole or not at all.

    Raises:
        InputError: if it can't be written.
    """
    arrays: archive.Arrays = {"indices": voxels.indices.astype(np.int32), "counts": voxels.counts}
    arrays |= {"best": voxels.best, "directions": voxels.directions, "done": done}
    archive.save(path, SCHEMA, metadata, arrays)


def read_map(path: Path) -> tuple[archive.Metadata, Voxels, Done]:
    """What `write_map` wrote.

    Raises:
        InputError: if there is no such file, or it is no map or a broken one.
    """
    metadata, found = archive.load(path, SCHEMA, _SHAPES)
    done = found.get("done")
    if done is None or done.dtype != bool or done.ndim != 1:
        raise InputError("workspace-file", "has no list of the blocks that are done", where=str(path))
    voxels = Voxels.at(found["indices"], found["counts"], found["best"], found["directions"])
    return metadata, voxels, done


def unfinished(path: Path) -> bool:
    """Whether a file holds an unfinished map: hours of work, maybe."""
    try:
        return not read_map(path)[2].all()
    except InputError:
        return False
