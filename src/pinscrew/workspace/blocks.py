"""Blocks of random configurations and their reduction to voxels, by whichever process.

The numbers of a block come from a random stream of its own, fixed by the seed and the block's number.
"""

from __future__ import annotations

import pickle
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.engines.compiled.batch import Batch
from pinscrew.engines.measures import manipulability
from pinscrew.ground.typing import FloatArray
from pinscrew.workspace.axes import Axis, spread
from pinscrew.workspace.voxels import Voxels, direction_bits, voxel_keys

__all__ = ["BLOCK", "MapTask", "block_count", "run_pickled"]

BLOCK: Final = 2**16
"""Configurations of a block: a tenth of a second's work, whose result is a few hundred kilobytes."""


@dataclass(frozen=True, eq=False, slots=True)
class MapTask:
    """What is done for every block.

    Attributes:
        engine: whom to ask.
        frame: about which frame.
        axes: the coordinates that move it, with their ranges.
        rank: generic rank of its translation.
        samples: configurations of all blocks together.
        seed: of the random streams.
        voxel: edge of a voxel, m.
    """

    engine: Engine
    frame: str
    axes: tuple[Axis, ...]
    rank: int
    samples: int
    seed: int
    voxel: float

    def run(self, block: int) -> Voxels:
        """The voxels of one block."""
        count = min(BLOCK, self.samples - block * BLOCK)
        rng = np.random.default_rng([self.seed, block])
        q = np.tile(self.engine.robot.neutral, (count, 1))
        q[:, [axis.index for axis in self.axes]] = spread(self.axes, rng.random((count, len(self.axes))))
        if isinstance(self.engine, Batch):  # which has poses and Jacobians made and reduced within the cache
            return Voxels.reduced(self.engine.reduce(q, self.frame, "hybrid", self._and_voxels, []))
        return Voxels.reduced(self._and_voxels([], slice(0, count), *self.engine.fk_jacobian(q, self.frame, "hybrid")))

    def _and_voxels(self, found: list[Voxels], _: slice, poses: FloatArray, J: FloatArray) -> list[Voxels]:
        """The voxels found before, and those of some configurations."""
        samples = Voxels(
            voxel_keys(poses[:, :3, 3], self.voxel),
            np.ones(len(poses), np.int64),
            manipulability(J[:, :3], self.rank),
            direction_bits(poses[:, :3, 2]),
        )
        return [*found, samples]


def block_count(samples: int) -> int:
    """How many blocks so many samples are."""
    return -(-samples // BLOCK)


def run_pickled(task: bytes, block: int) -> Voxels:
    """`MapTask.run` of a pickled task, which each process loads once."""
    return _loaded(task).run(block)


@lru_cache(maxsize=1)
def _loaded(task: bytes) -> MapTask:
    loaded: MapTask = pickle.loads(task)  # noqa: S301 (from the process that sends the block)
    return loaded
