"""Maps: against a reduction written down here, by any executor, interrupted and resumed, and within memory."""

from __future__ import annotations

import json
import math
import os
import pickle
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import closed_forms
import pinscrew as ps
from pinscrew.engines.compiled.batch import for_many
from pinscrew.ground.errors import EngineError, InputError, PinscrewError
from pinscrew.ground.processes import process_pool
from pinscrew.workspace import blocks
from pinscrew.workspace import reachability as reachability_module
from pinscrew.workspace.axes import axes
from pinscrew.workspace.blocks import BLOCK, MapTask, run_pickled
from pinscrew.workspace.executors import dask_executor
from pinscrew.workspace.reachability_map import read_map, write_map
from pinscrew.workspace.voxels import Gathering, Voxels, approach_directions, direction_bits, voxel_keys

load = cache(ps.load)

SAMPLES = 2 * BLOCK + 1000  # the last block is short
SEED = 5
VOXEL = 0.05


class Here(Executor):
    """Computes at once, in this thread."""

    def submit(self, function: Callable[..., Any], /, *words: Any, **options: Any) -> Future[Any]:  # type: ignore[override]
        future: Future[Any] = Future()
        future.set_result(function(*words, **options))
        return future


def same(a: ps.ReachabilityMap, b: ps.ReachabilityMap) -> bool:
    """Whether two maps have the same bits."""
    pairs = ((getattr(a.voxels, name), getattr(b.voxels, name)) for name in ("keys", "counts", "best", "directions"))
    return a.metadata == b.metadata and all(x.dtype == y.dtype and x.tobytes() == y.tobytes() for x, y in pairs)


@cache
def whole() -> ps.ReachabilityMap:
    """The spherical arm's map, from blocks in order."""
    return ps.reachability(load("spherical_rrp"), voxel=VOXEL, samples=SAMPLES, seed=SEED, executor=Here())


# ----------------------------------------------------------------------------------------- what is in it


def test_the_map_is_the_reduction_of_all_samples() -> None:
    """With the arm's closed forms: p and the z axis of part (d), and det J_v = ± r² c2 of part (i)."""
    robot, L3, L0 = load("spherical_rrp"), 0.8, 0.5
    lower, upper = robot.limits.T
    directions = approach_directions()
    places, nearest, w = [], [], []
    for block, size in enumerate((BLOCK, BLOCK, 1000)):
        unit = np.random.default_rng([SEED, block]).random((size, 3))
        t1, t2, t3 = (lower + (upper - lower) * unit).T
        c1, s1, c2, s2, r = np.cos(t1), np.sin(t1), np.cos(t2), np.sin(t2), L3 + t3
        p = np.stack([-r * s1 * c2, r * c1 * c2, L0 - r * s2], axis=1)
        places.append(np.floor(p / VOXEL).astype(int))
        nearest.append((np.stack([-s1 * s2, c1 * s2, c2], axis=1) @ directions.T).argmax(axis=1))
        w.append(r**2 * abs(c2))
    voxels, inverse, counts = np.unique(np.concatenate(places), axis=0, return_inverse=True, return_counts=True)
    best, met = np.zeros(len(voxels)), np.zeros((len(voxels), 64), bool)
    np.maximum.at(best, inverse.ravel(), np.concatenate(w))
    met[inverse.ravel(), np.concatenate(nearest)] = True
    found = whole()
    np.testing.assert_array_equal(found.voxels.indices, voxels)
    np.testing.assert_array_equal(found.counts, counts)
    np.testing.assert_allclose(found.manipulability, best, rtol=1e-7, atol=1e-9)
    assert found.directions.tolist() == [sum(1 << int(i) for i in np.flatnonzero(row)) for row in met]
    np.testing.assert_array_equal(found.coverage, met.sum(axis=1) / 64)
    assert found.counts.sum() == SAMPLES


def test_a_task_done_otherwise_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """`same` tells maps apart: of another seed, and with a block lost."""
    robot = load("spherical_rrp")
    other = ps.reachability(robot, voxel=VOXEL, samples=SAMPLES, seed=SEED + 1, executor=Here())
    assert not same(whole(), ps.ReachabilityMap(other.voxels, whole().metadata))
    run = MapTask.run
    monkeypatch.setattr(MapTask, "run", lambda self, block: run(self, block) if block != 1 else Voxels.none())
    lost = ps.reachability(robot, voxel=VOXEL, samples=SAMPLES, seed=SEED, executor=Here())
    assert not same(whole(), lost)


def test_a5_best_manipulability_is_that_of_the_closed_form() -> None:
    arm, L = closed_forms.PlanarRRR(), {"l1": 0.5, "l2": 0.4, "l3": 0.3}
    robot = load("planar_rrr")
    found = ps.reachability(robot, voxel=3.0, samples=500, executor=Here())
    lower, upper = robot.limits.T
    q = lower + (upper - lower) * np.random.default_rng([0, 0]).random((500, 3))
    J = np.array([arm.jacobian_hybrid(each, L)[:2] for each in q])
    w = np.sqrt(np.linalg.det(J @ J.transpose(0, 2, 1)))
    assert len(found) == 4
    np.testing.assert_allclose(found.manipulability.max(), w.max(), rtol=1e-12)
    assert found.volume == 4 * 27.0
    assert found.metadata["rank"] == 2


def test_directions() -> None:
    """64 unit vectors, evenly spread; each is nearest to itself, and ties have one answer."""
    directions = approach_directions()
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0, rtol=0, atol=1e-15)
    cosines = directions @ directions.T - 2.0 * np.eye(64)
    assert 20.0 < np.rad2deg(np.arccos(cosines.max(axis=1))).min() < 30.0
    assert direction_bits(directions).tolist() == [1 << i for i in range(64)]
    rng = np.random.default_rng(0)
    z = rng.normal(size=(1000, 3))
    assert direction_bits(z).tolist() == [1 << int(i) for i in (z @ directions.T).argmax(axis=1)]


def test_voxels_are_half_open_but_for_rounding() -> None:
    """What rounding leaves below a face is on it; what is truly below is below."""
    points = np.array([[0.1, -0.1, 0.0], [0.1 - 1e-16, -0.1 - 1e-17, -1e-18], [0.1 - 1e-6, -0.1 - 1e-6, -1e-6]])
    none = np.zeros(3)
    voxels = Voxels(voxel_keys(points, 0.1), none.astype(np.int64), none, none.astype(np.uint64))
    assert voxels.indices.tolist() == [[1, -1, 0], [1, -1, 0], [0, -2, -1]]


def test_planes_are_not_torn() -> None:
    """The planar arm's tool is at z = 0, give or take rounding: one layer."""
    found = ps.reachability(load("planar_2r"), samples=5000, executor=Here())
    assert np.unique(found.voxels.indices[:, 0]).tolist() == [-20]


def test_gathering_in_any_order() -> None:
    rng = np.random.default_rng(0)
    parts = [
        Voxels.reduced([Voxels(k, np.ones(40, np.int64), rng.random(40), rng.integers(0, 2**63, 40).astype(np.uint64))])
        for k in rng.integers(0, 30, (50, 40))
    ]
    totals = []
    for order in (range(50), reversed(range(50)), rng.permutation(50)):
        gathering = Gathering(Voxels.none())
        for i in order:
            gathering.add(parts[i])
        totals.append(ps.ReachabilityMap(gathering.total(), {}))
    assert same(totals[0], totals[1])
    assert same(totals[0], totals[2])
    assert totals[0].counts.sum() == 50 * 40
    assert len(Voxels.reduced([Voxels.none()])) == 0


# ------------------------------------------------------------------------------------------ who computes


def test_processes_give_the_same_bits() -> None:
    found = ps.reachability(load("spherical_rrp"), voxel=VOXEL, samples=SAMPLES, seed=SEED, jobs=2)
    assert same(found, whole())


def test_threads_give_the_same_bits() -> None:
    with ThreadPoolExecutor(3) as pool:
        found = ps.reachability(load("spherical_rrp"), voxel=VOXEL, samples=SAMPLES, seed=SEED, executor=pool, jobs=3)
    assert same(found, whole())


def test_a_cluster_gives_the_same_bits(cluster: str) -> None:
    with dask_executor(cluster) as (executor, workers):
        assert workers == 2
        found = ps.reachability(
            load("spherical_rrp"), voxel=VOXEL, samples=SAMPLES, seed=SEED, executor=executor, jobs=workers
        )
    assert same(found, whole())


@pytest.mark.slow
def test_a_cluster_of_processes_gives_the_same_bits() -> None:
    distributed = pytest.importorskip("distributed")
    options = {"dashboard_address": ":0", "processes": True}
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, **options) as running,
        dask_executor(running.scheduler_address) as (executor, workers),
    ):
        robot = load("spherical_rrp")
        found = ps.reachability(robot, voxel=VOXEL, samples=SAMPLES, seed=SEED, executor=executor, jobs=workers)
    assert same(found, whole())


def test_few_blocks_are_asked_for_at_a_time() -> None:
    """However many there are, so that memory does not grow with them."""
    waiting: list[Future[Any]] = []
    asked: list[int] = []
    done: list[int] = []
    ahead: list[int] = []

    class Lazy(Here):
        def submit(self, _: Callable[..., Any], /, *words: Any, **__: Any) -> Future[Any]:  # type: ignore[override]
            waiting.append(Future())
            asked.append(words[1])
            ahead.append(len(asked) - sum(done))
            future = waiting[-1]
            if len(waiting) == 6 or len(asked) == 1000:  # all at once, the last first
                while waiting:
                    waiting.pop().set_result(Voxels.none())
            return future

    robot = load("one_joint")
    assert len(ps.reachability(robot, samples=1000 * BLOCK, executor=Lazy(), jobs=3, advance=done.append)) == 0
    assert asked == list(range(1000))
    assert max(ahead) == 6


def test_a_worker_that_ends_is_an_error_that_says_so(tmp_path: Path) -> None:
    class Broken(Here):
        def submit(self, function: Callable[..., Any], /, *words: Any, **_: Any) -> Future[Any]:  # type: ignore[override]
            future: Future[Any] = Future()
            if words[1] == 0:
                future.set_result(function(*words))
            else:
                future.set_exception(BrokenProcessPool("ended"))
            return future

    with pytest.raises(EngineError, match="a worker ended") as caught:
        ps.reachability(load("one_joint"), samples=3 * BLOCK, executor=Broken(), jobs=1, path=tmp_path / "a.npz")
    assert caught.value.code == "worker"
    assert read_map(tmp_path / "a.npz")[2].tolist() == [True, False, False]


# --------------------------------------------------------------------------------------- interruptions

KILLED = """
import os, signal, sys
import pinscrew as ps
from pinscrew.workspace import reachability as module

module.INTERVAL = 0.0  # written after every block
module.PART_WRITING = 1e9
done = 0

def advance(blocks):
    global done
    done += blocks
    if done >= 1:
        os.kill(os.getpid(), signal.SIGKILL)

if __name__ == "__main__":
    options = {"path": sys.argv[1], "samples": int(sys.argv[2]), "seed": 5, "jobs": 2}
    ps.reachability(ps.load("spherical_rrp"), voxel=0.05, advance=advance, **options)
"""


def test_killed_and_resumed_gives_the_same_bits(tmp_path: Path) -> None:
    """What was done is in the file, the workers end with their parent, and the rest is added to it."""
    script, file = tmp_path / "script.py", tmp_path / "map.npz"
    script.write_text(KILLED)
    # The workers hold the pipe: reading it ends when they have ended.
    done = subprocess.run([sys.executable, script, file, str(SAMPLES)], stdout=subprocess.PIPE, timeout=60)
    assert done.returncode == -signal.SIGKILL
    _, voxels, finished = read_map(file)
    assert 1 <= finished.sum() < 3
    assert voxels.counts.sum() == np.array([BLOCK, BLOCK, 1000])[finished].sum()
    with pytest.raises(InputError, match="holds an unfinished map") as caught:
        ps.ReachabilityMap.load(file)
    assert caught.value.code == "unfinished"
    seen: list[int] = []
    resumed = ps.reachability(
        load("spherical_rrp"),
        voxel=VOXEL,
        samples=SAMPLES,
        seed=SEED,
        executor=Here(),
        path=file,
        resume=True,
        advance=seen.append,
    )
    assert seen == [finished.sum(), *[1] * (3 - finished.sum())]
    assert same(resumed, whole())
    assert same(ps.ReachabilityMap.load(file), whole())


def test_interrupted_by_ctrl_c(tmp_path: Path) -> None:
    """Nothing that was finished is lost, even what was not yet to be written."""
    file = tmp_path / "map.npz"
    seen = []

    def advance(blocks: int) -> None:
        seen.append(blocks)
        if sum(seen) == 2:
            raise KeyboardInterrupt

    robot = load("one_joint")
    with pytest.raises(KeyboardInterrupt):
        ps.reachability(robot, samples=3 * BLOCK, executor=Here(), path=file, advance=advance)
    assert read_map(file)[2].sum() == 2
    resumed = ps.reachability(robot, samples=3 * BLOCK, executor=Here(), path=file, resume=True)
    assert same(resumed, ps.reachability(robot, samples=3 * BLOCK, executor=Here()))


def test_interrupted_in_the_middle_of_a_block(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A block that is taken in but not yet listed is not counted twice: the file stays as it was."""
    file = tmp_path / "map.npz"
    add = Gathering.add

    def interrupted(self: Gathering, part: Voxels) -> None:
        add(self, part)
        if len(taken) == 1:
            raise KeyboardInterrupt
        taken.append(part)

    taken: list[Voxels] = []
    robot = load("one_joint")
    monkeypatch.setattr(reachability_module, "INTERVAL", 0.0)
    monkeypatch.setattr(Gathering, "add", interrupted)
    with pytest.raises(KeyboardInterrupt):
        ps.reachability(robot, samples=3 * BLOCK, executor=Here(), path=file)
    monkeypatch.undo()
    _, voxels, finished = read_map(file)
    assert (voxels.counts.sum(), finished.sum()) == (BLOCK, 1)
    resumed = ps.reachability(robot, samples=3 * BLOCK, executor=Here(), path=file, resume=True)
    assert same(resumed, ps.reachability(robot, samples=3 * BLOCK, executor=Here()))


def test_interrupted_before_anything_is_done(tmp_path: Path) -> None:
    """No file is left where there was none, and a finished map stays as it is."""
    file, robot = tmp_path / "map.npz", load("one_joint")

    class Refusing(Here):
        def submit(self, *_: Any, **__: Any) -> Future[Any]:  # type: ignore[override]
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ps.reachability(robot, samples=10, executor=Refusing(), path=file)
    assert list(tmp_path.iterdir()) == []
    ps.reachability(robot, samples=10, executor=Here(), path=file)
    before = file.read_bytes()
    with pytest.raises(KeyboardInterrupt):
        ps.reachability(robot, samples=20, executor=Refusing(), path=file)
    assert file.read_bytes() == before


def test_resuming_what_is_finished_computes_nothing(tmp_path: Path) -> None:
    file = tmp_path / "map.npz"
    robot = load("one_joint")
    first = ps.reachability(robot, samples=100, executor=Here(), path=file, resume=True)  # there is none yet
    again = ps.reachability(robot, samples=100, executor=None, path=file, resume=True)
    assert same(first, again)


@pytest.fixture
def part(tmp_path: Path) -> Path:
    """A file with an unfinished map of the joint."""
    file = tmp_path / "map.npz"
    whole = ps.reachability(load("one_joint"), samples=2 * BLOCK, executor=Here())
    write_map(file, whole.metadata, Voxels.none(), np.array([False, False]))
    return file


def test_an_unfinished_map_is_not_overwritten(part: Path) -> None:
    before = part.read_bytes()
    with pytest.raises(InputError, match="resume it, or delete it first") as caught:
        ps.reachability(load("one_joint"), samples=2 * BLOCK, executor=Here(), path=part)
    assert caught.value.code == "unfinished"
    assert part.read_bytes() == before


@pytest.mark.parametrize(
    ("key", "change"),
    [
        ("seed", {"seed": 1}),
        ("voxel", {"voxel": 0.1}),
        ("samples", {"samples": BLOCK + 1}),
        ("frame", {"frame": "link1"}),
        ("ranges", {"ranges": {"joint1": (0, 1)}}),
        ("engine", {"engine": "Pinocchio"}),
        ("fingerprint", {"robot": {"l2": 0.71}}),
        ("robot", {"robot": "gear_pair"}),
    ],
)
def test_another_map_is_not_resumed(part: Path, key: str, change: dict[str, Any]) -> None:
    robot = load("one_joint")
    if isinstance(change.get("robot"), dict):
        robot = ps.load("one_joint", **change["robot"])
    elif "robot" in change:
        robot = load(change["robot"])
    options: dict[str, Any] = {"samples": 2 * BLOCK, "executor": Here(), "path": part, "resume": True}
    options |= {k: v for k, v in change.items() if k not in {"robot", "engine"}}
    if "engine" in change:
        options["engine"] = ps.Pinocchio(robot)
    before = part.read_bytes()
    with pytest.raises(InputError, match=f"holds another map: its {key} is") as caught:
        ps.reachability(robot, **options)
    assert caught.value.code == "resume"
    assert part.read_bytes() == before


def test_a_file_that_is_no_map_is_not_resumed(tmp_path: Path) -> None:
    file = tmp_path / "map.npz"
    file.write_text("no map")
    with pytest.raises(InputError, match=r"is no pinscrew\.reachability/1 file"):
        ps.reachability(load("one_joint"), samples=10, executor=Here(), path=file, resume=True)
    arrays = {"metadata": np.array(json.dumps({"schema": "pinscrew.reachability/1"})), "indices": np.zeros((0, 3), int)}
    arrays |= {"counts": np.zeros(0, int), "best": np.zeros(0), "directions": np.zeros(0, np.uint64)}
    np.savez(file, **arrays)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="no list of the blocks"):
        ps.ReachabilityMap.load(file)


def test_an_unwritable_file_is_known_before_the_work(tmp_path: Path) -> None:
    def never(_: int) -> None:
        raise AssertionError("the work began")

    protected = tmp_path / "map.npz"
    protected.touch(0o444)
    for file in (protected, tmp_path / "none" / "map.npz"):
        with pytest.raises(InputError, match="can't be written") as caught:
            ps.reachability(load("one_joint"), samples=10, path=file, advance=never)
        assert caught.value.code == "unwritable"


def test_saved_and_loaded(tmp_path: Path) -> None:
    whole().save(tmp_path / "a.npz")
    assert same(ps.ReachabilityMap.load(tmp_path / "a.npz"), whole())
    with np.load(tmp_path / "a.npz") as file:
        centres = (file["indices"] + 0.5) * json.loads(str(file["metadata"]))["voxel"]
    np.testing.assert_allclose(centres, whole().centres, rtol=0, atol=1e-15)


# ---------------------------------------------------------------------------------------- bad arguments


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        ({"voxel": 0.0}, "voxel", "voxel=0"),
        ({"voxel": math.nan}, "voxel", "voxel=nan"),
        ({"voxel": 1e-9}, "voxel", "take larger voxels"),
        ({"samples": 0}, "samples", "samples=0"),
        ({"samples": 1e13}, "samples", "give at most 1000000000000"),
        ({"samples": 10.5}, "samples", "whole number"),
        ({"seed": -1}, "seed", "seed=-1"),
        ({"jobs": 0}, "jobs", "jobs=0"),
        ({"frame": "base"}, "nothing-moves", "no joint moves"),
    ],
)
def test_refused(options: dict[str, Any], code: str, words: str) -> None:
    with pytest.raises(PinscrewError, match=words) as caught:
        ps.reachability(load("one_joint"), **{"samples": 10, "executor": Here(), **options})
    assert caught.value.code == code


def test_refused_pools() -> None:
    with pytest.raises(InputError, match="jobs=0"), process_pool(0):
        pass


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense", "foo://x:1"])
def test_no_scheduler(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("pinscrew.workspace.executors.PATIENCE", 0.3)
    with pytest.raises(EngineError, match="no dask scheduler answers") as caught, dask_executor(address):
        pass
    assert caught.value.code == "scheduler"


def test_a_cluster_without_workers() -> None:
    distributed = pytest.importorskip("distributed")
    options = {"dashboard_address": ":0", "processes": False, "protocol": "tcp://"}
    with distributed.LocalCluster(n_workers=0, **options) as running:
        address = running.scheduler_address
        with pytest.raises(EngineError, match="the cluster has no workers"), dask_executor(address):
            pass


# ----------------------------------------------------------------------------------------------- memory


@pytest.mark.slow
def test_memory_does_not_grow_with_samples() -> None:
    """Six times the samples in the same memory, of the parent and of the worker (kilobytes, on Linux)."""
    code = """
import resource, sys
import pinscrew as ps
if __name__ == "__main__":
    ps.reachability(ps.load("spherical_rrp"), voxel=0.1, samples=int(sys.argv[1]), jobs=1)
    print(*(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))
"""
    few, many = (
        [int(word) for word in subprocess.check_output([sys.executable, "-c", code, str(n * BLOCK)], text=True).split()]
        for n in (4, 24)
    )
    assert all(b < a + 20_000 for a, b in zip(few, many, strict=True)), (few, many)


def test_workers_load_a_task_once() -> None:
    robot = load("one_joint")
    task = pickle.dumps(MapTask(for_many(robot), "tool", axes(robot, "tool"), 1, 10, 0, 0.1))
    before = blocks._loaded.cache_info()
    assert [int(run_pickled(task, 0).counts.sum()) for _ in range(3)] == [10] * 3
    after = blocks._loaded.cache_info()
    assert (after.misses - before.misses, after.hits - before.hits) == (1, 2)


@pytest.mark.parametrize("kind", ["pipe", "zero"])
def test_what_is_no_plain_file_is_not_read(kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"{kind}.npz"
    if kind == "pipe":
        os.mkfifo(path)
    else:
        path.symlink_to("/dev/zero")
    failures: list[InputError] = []

    def attempt() -> None:
        try:
            read_map(path)
        except InputError as error:
            failures.append(error)

    thread = threading.Thread(target=attempt, daemon=True)
    thread.start()
    thread.join(2)
    if thread.is_alive() and kind == "pipe":
        os.close(os.open(path, os.O_WRONLY | os.O_NONBLOCK))  # let it end
    assert [(error.code, "no plain file" in error.what) for error in failures] == [("unreadable", True)]
