"""`reachability`: maps of where a frame can get, of as many samples as one likes."""

from __future__ import annotations

import math
import pickle
import time
from collections.abc import Callable, Generator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from contextlib import closing, nullcontext
from itertools import islice
from pathlib import Path
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pinscrew.engines.base import Engine
from pinscrew.engines.compiled.batch import for_many
from pinscrew.engines.measures import generic_ranks
from pinscrew.ground import files
from pinscrew.ground.counts import whole
from pinscrew.ground.errors import EngineError, InputError
from pinscrew.ground.processes import job_count, process_pool
from pinscrew.robot.loading import RobotLike, robot_of
from pinscrew.workspace import archive
from pinscrew.workspace.axes import Ranges, axes
from pinscrew.workspace.blocks import BLOCK, MapTask, block_count, run_pickled
from pinscrew.workspace.reachability_map import Done, ReachabilityMap, read_map, unfinished, write_map
from pinscrew.workspace.voxels import Gathering, Voxels

__all__ = ["SAMPLES", "reachability"]

_Results: TypeAlias = Generator[tuple[int, Voxels], None, None]

SAMPLES: Final = 10_000_000
"""Configurations of a map."""
MOST: Final = 10**12
"""The largest number of configurations: a year's work, of which the list of blocks is 15 MB."""
AHEAD: Final = 2
"""Blocks per worker that are asked for before their turn; results don't pile up beyond these."""
INTERVAL: Final = 10.0
"""Seconds between two writings of what is done, at least."""
PART_WRITING: Final = 0.05
"""Part of the time that writing may take."""


def reachability(
    robot: RobotLike,
    *,
    voxel: float = 0.05,
    samples: float = SAMPLES,
    seed: int = 0,
    frame: str | None = None,
    ranges: Ranges | None = None,
    engine: Engine | None = None,
    executor: Executor | None = None,
    jobs: int | None = None,
    path: str | Path | None = None,
    resume: bool = False,
    advance: Callable[[int], object] | None = None,
) -> ReachabilityMap:
    """Where a frame gets with random configurations: voxels, with how often, how well and from which directions.

    Samples are uniform in the coordinates and reduced block by block, so memory follows the voxels. The random
    stream of a block is fixed by its number: on machines of one kind, with one version of numpy, the map has the
    same bits whoever computes it and however often it was interrupted.

    Args:
        robot: a robot, or a name or path that `load` takes.
        voxel: edge of a voxel, m; voxel (i, j, k) is [i a, (i + 1) a) × … in the base frame.
        samples: how many configurations.
        seed: of the random configurations.
        frame: a link's name; by default the robot's tip.
        ranges: lower and upper end by coordinate (rad or m), instead of its limits; see `sweep`.
        engine: whom to ask, which must be fit for pickling; by default `Batch`, or `PoE` where it can't be compiled.
        executor: who computes, such as a process pool or ``distributed.Client(address).get_executor()``; by
            default processes of this machine. Then a script needs its ``if __name__ == "__main__":``.
        jobs: how many workers; by default the number of cores.
        path: a file for the map. What is done is written there every ten seconds or so, and if interrupted.
        resume: go on with the unfinished map in the file, if there is one.
        advance: called with the number of blocks of 65536 configurations done since it was last called.

    Raises:
        InputError: if an argument is out of its range or missing, a voxel is so small that the robot spans more
            than a million, or the file can't be written, or holds an unfinished map (without ``resume``) or another
            (with it).
        EngineError: if a worker ends.
        UnknownNameError, AmbiguousTipError: see `Robot.frame`.
    """
    robot = robot_of(robot)
    frame = robot.frame(frame)
    samples, seed, jobs = whole("samples", samples, 1), whole("seed", seed, 0), job_count(jobs)
    if samples > MOST:
        raise InputError("samples", f"samples={samples}", remedy=f"give at most {MOST}")
    if not 0.0 < voxel < math.inf:
        raise InputError("voxel", f"voxel={voxel}", remedy="give an edge in m, such as 0.05")
    found = axes(robot, frame, ranges)
    engine = engine or for_many(robot, threads=1)
    rank, _ = generic_ranks(engine, frame)
    metadata: archive.Metadata = archive.provenance(robot, engine, frame, found)
    metadata |= {"voxel": voxel, "samples": samples, "seed": seed, "block": BLOCK, "rank": rank}
    file = None if path is None else Path(path)
    if file is not None:
        files.check(file)
    voxels, done = _begun(file, metadata, resume)
    task = MapTask(engine, frame, found, rank, samples, seed, voxel)
    record = _Record(file, metadata, Gathering(voxels), done)
    advance = advance or (lambda _: None)
    given = process_pool(jobs) if executor is None else nullcontext((executor, jobs))
    try:
        advance(int(done.sum()))
        left = np.flatnonzero(~done)
        # Without blocks to do, a pool starts no processes.
        with given as (workers, count), closing(_results(workers, AHEAD * count, task, left)) as results:
            for block, part in results:
                record.see(block, part)
                advance(1)
    except BrokenExecutor:
        kept = f"what is done is in {file}" if file else "nothing was kept: give it a file"
        what = "a worker ended before its block was done; a script that starts processes needs its main guard"
        raise EngineError("worker", f"{what}; {kept}", where=robot.name) from None
    finally:
        record.end()
    return ReachabilityMap(record.gathering.total(), metadata)


class _Record:
    """What is done so far, written to its file from time to time."""

    def __init__(self, file: Path | None, metadata: archive.Metadata, gathering: Gathering, done: Done) -> None:
        self.gathering = gathering
        self._file = file
        self._metadata = metadata
        self._done = done
        self._seen = 0
        self._torn = False
        self._due = time.monotonic() + INTERVAL

    def see(self, block: int, part: Voxels) -> None:
        """Take in the voxels of a block."""
        self._torn = True  # Ctrl-C may come between the two
        self.gathering.add(part)
        self._done[block] = True
        self._torn = False
        self._seen += 1
        if time.monotonic() > self._due:
            self._write()

    def end(self) -> None:
        """Write what is done, if anything is, however the work ended."""
        if self._seen:
            self._write()

    def _write(self) -> None:
        if self._file is None or self._torn:
            return
        begun = time.monotonic()
        write_map(self._file, self._metadata, self.gathering.total(), self._done)
        now = time.monotonic()
        self._due = now + max(INTERVAL, (now - begun) / PART_WRITING)


def _begun(file: Path | None, metadata: archive.Metadata, resume: bool) -> tuple[Voxels, Done]:
    """What of a map is done already, and which blocks that is."""
    blocks = block_count(metadata["samples"])
    nothing = Voxels.none(), np.zeros(blocks, bool)
    if file is None or not file.exists():
        return nothing
    if not resume:
        if unfinished(file):
            what, remedy = "holds an unfinished map", "resume it, or delete it first"
            raise InputError("unfinished", what, where=str(file), remedy=remedy)
        return nothing
    held, voxels, done = read_map(file)
    different = [key for key, value in metadata.items() if held.get(key) != value]
    if different or len(done) != blocks:
        key = different[0] if different else "samples"
        what = f"holds another map: its {key} is {held.get(key)!r}, not {metadata[key]!r}"
        raise InputError("resume", what, where=str(file), remedy="give what it was made with, or another file")
    return voxels, done


def _results(executor: Executor, ahead: int, task: MapTask, blocks: NDArray[np.intp]) -> _Results:
    """The voxels of each block as they come, with at most ``ahead`` asked for at a time."""
    pickled = pickle.dumps(task)
    waiting = iter(blocks.tolist())
    asked: dict[Future[Voxels], int] = {}
    try:
        while True:
            for block in islice(waiting, ahead - len(asked)):
                asked[executor.submit(run_pickled, pickled, block)] = block
            if not asked:
                return
            done = wait(asked, return_when=FIRST_COMPLETED).done
            for future in sorted(done, key=lambda future: future.exception() is not None):  # what is there comes first
                yield asked.pop(future), future.result()
    finally:
        for future in asked:
            future.cancel()
