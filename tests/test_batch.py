"""The compiled engine against the two others, and what a batch call takes."""

from __future__ import annotations

import copy
import math
import pickle
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any

import numpy as np
import pytest

import pinscrew as ps
import urdfs
from pinscrew.description.catalogue import bundled, example_robots
from pinscrew.engines.compiled import chain, kernel, walk
from pinscrew.engines.compiled.batch import BLOCK
from pinscrew.engines.compiled.chain import Question
from pinscrew.engines.compiled.kernel import CHUNK, SLICE
from pinscrew.ground.errors import InputError, UnknownNameError
from pinscrew.ground.typing import KINDS, FloatArray
from pinscrew.verification.configurations import sizes

TOLERANCE = 1e-13
"""Of poses and Jacobians, metres divided by the size of the robot: what the issue's users are promised."""

EXAMPLES = [entry.name for entry in example_robots() if entry.name not in ("ur3", "alex_psyonic_hands")]


@pytest.fixture(scope="module", autouse=True)
def cache_of_its_own(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """What is compiled here is not kept where the user's is."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PINSCREW_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


@cache
def make(name: str) -> ps.Batch:
    return ps.Batch(ps.load(name))


def sample(robot: ps.Robot, count: int, seed: int = 0, most: float = 3.0) -> FloatArray:
    return np.random.default_rng(seed).uniform(-most, most, (count, robot.nq))


def error(found: FloatArray, expected: FloatArray, scales: FloatArray) -> float:
    """The largest difference of poses (N, 4, 4) or Jacobians (N, 6, nv), metres divided by ``scales``."""
    assert found.shape == expected.shape
    difference = abs(found - expected)
    if found.shape[-2:] == (4, 4):
        difference[:, :3, 3] /= scales[:, None]
    else:
        difference[:, :3] /= scales[:, None, None]
    return float(difference.max(initial=0.0))


def agreement(batch: ps.Batch, engine: Any, frame: str, q: FloatArray, kinds: Sequence[str] = KINDS) -> float:
    """The largest difference between a compiled engine and another, of everything about a frame.

    Each kind of Jacobian is a kernel, and compiling it is what takes the time.
    """
    scales = sizes(batch.robot, q)
    worst = 0.0
    for kind in kinds:
        T, J = batch.fk_jacobian(q, frame, kind)
        worst = max(worst, error(T, engine.fk(q, frame), scales), error(J, engine.jacobian(q, frame, kind), scales))
    return worst


# -------------------------------------------------------------------------------------------------- answers


@pytest.mark.parametrize("name", [entry.name for entry in bundled()])
def test_assignment_arms(name: str) -> None:
    batch = make(name)
    q = sample(batch.robot, 53)
    for frame in (batch.robot.tip, batch.robot.frame_names[1]):
        for engine in (ps.PoE(batch.robot), ps.Pinocchio(batch.robot)):
            assert agreement(batch, engine, frame, q) <= TOLERANCE


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=() if name in ("panda", "ur5_robot") else pytest.mark.slow) for name in EXAMPLES],
)
@pytest.mark.filterwarnings("ignore::pinscrew.ground.errors.PinscrewWarning")
def test_example_robots(name: str) -> None:
    """At the deepest frames, trees and mimic joints among them."""
    batch = make(name)
    frames = sorted(batch.robot.frame_names, key=lambda frame: len(batch.robot.motions_above(frame)))[-2:]
    q = sample(batch.robot, 35)
    for frame in frames:
        for engine in (ps.PoE(batch.robot), ps.Pinocchio(batch.robot)):
            assert agreement(batch, engine, frame, q) <= TOLERANCE


@pytest.mark.parametrize(("i", "name"), list(enumerate(name for name in urdfs.ROBOTS if name != "no_joints")))
def test_every_kind_of_joint(i: int, name: str) -> None:
    """Planar and floating joints too, which numpy moves."""
    robot = urdfs.load(urdfs.ROBOTS[name])
    q, _ = urdfs.sample(robot, 21, 0)
    batch = ps.Batch(robot)
    assert agreement(batch, ps.PoE(robot), robot.frame_names[-1], q, [KINDS[i % 3]]) <= TOLERANCE


@pytest.mark.parametrize("count", [0, 1, CHUNK - 1, CHUNK, CHUNK + 1, 5 * CHUNK + 3, SLICE + 7])
def test_lengths(count: int) -> None:
    batch = make("anthropomorphic_rrr")
    q = sample(batch.robot, count)
    T, J = batch.fk_jacobian(q, "tool", "body")
    poe = ps.PoE(batch.robot)
    assert T.shape == (count, 4, 4)
    assert J.shape == (count, 6, 3)
    np.testing.assert_allclose(T, poe.fk(q), rtol=0, atol=TOLERANCE)
    np.testing.assert_allclose(J, poe.jacobian(q, "tool", "body"), rtol=0, atol=TOLERANCE)


def test_several_frames_in_one_pass() -> None:
    batch = make("panda")
    frames = ("panda_link3", "panda_hand", "panda_leftfinger")
    q = sample(batch.robot, 6).reshape(2, 3, -1)
    T, J = batch.fk_jacobian(q, frames, "spatial")
    assert T.shape == (2, 3, 3, 4, 4)
    assert J.shape == (2, 3, 3, 6, batch.robot.nv)
    for i, frame in enumerate(frames):
        np.testing.assert_allclose(T[:, :, i], ps.Pinocchio(batch.robot).fk(q, frame), rtol=0, atol=TOLERANCE)
        expected = ps.Pinocchio(batch.robot).jacobian(q, frame, "spatial")
        np.testing.assert_allclose(J[:, :, i], expected, rtol=0, atol=TOLERANCE)


def test_angles_of_any_size() -> None:
    """Up to 1e5 the kernel's own range reduction is good; beyond, numpy's cosine and sine are asked."""
    batch, poe = make("planar_rrr"), ps.PoE(ps.load("planar_rrr"))
    for most in (10.0, 1e3, 1e5, 1e6, 1e15):
        q = sample(batch.robot, 200, most=most)
        assert agreement(batch, poe, "tool", q) <= TOLERANCE
    q = sample(batch.robot, 40)
    q[7, 1], q[33, 0] = 3e5, -1e300
    assert agreement(batch, poe, "tool", q) <= TOLERANCE


def test_cosine_and_sine() -> None:
    """To about 1 ulp: of one joint's rotation, which is nothing else, at angles near every multiple of π/4 to 1e5."""
    batch = make("one_joint")
    rng = np.random.default_rng(1)
    quarters = np.arange(-127_000, 127_000, 7) * (math.pi / 4)  # 7: of every eighth of a turn
    angles = np.concatenate([quarters, np.nextafter(quarters, np.inf), rng.uniform(-1e5, 1e5, 30_000)])
    T = batch.fk(angles[:, None])
    exact = np.array([[math.cos(angle), math.sin(angle)] for angle in angles])
    assert abs(T[:, :2, 0] - exact).max() <= 2.3e-16


@pytest.mark.parametrize(
    "tilt",
    [
        *(1e-9, 0.09, 0.11),
        *(pytest.param(tilt, marks=pytest.mark.slow) for tilt in (0.0, 1e-16, 1e-3, math.pi - 1e-9, math.pi)),
    ],
)
def test_axes_at_any_angle_to_each_other(tilt: float) -> None:
    """Nearly parallel axes have a common normal that is far away or nowhere: it must not be relied on."""
    robot = urdfs.load(tilted(tilt, np.random.default_rng(2)))
    q, _ = urdfs.sample(robot, 17, 0)
    assert agreement(ps.Batch(robot), ps.PoE(robot), "tool", q) <= TOLERANCE


def tilted(tilt: float, rng: np.random.Generator) -> str:
    """A chain of four revolute joints, each axis tilted against the one before."""
    joints = []
    for i in range(1, 5):
        x, y, z = rng.uniform(-1, 1, 3)
        turn = rng.uniform(-3, 3)
        origin = f'<origin xyz="{x} {y} {z}" rpy="{tilt!r} 0 {turn}"/>'
        limit = '<limit lower="-3" upper="3" effort="1" velocity="1"/>'
        ends = f'<parent link="l{i - 1}"/><child link="{"tool" if i == 4 else f"l{i}"}"/>'
        joints.append(f'<joint name="j{i}" type="revolute">{ends}{origin}<axis xyz="0 0 1"/>{limit}</joint>')
    links = "".join(f'<link name="{name}"/>' for name in ("l0", "l1", "l2", "l3", "tool"))
    return f'<robot name="tilted">{links}{"".join(joints)}</robot>'


# -------------------------------------------------------------------------------------------- manipulability


@pytest.mark.parametrize("name", ["planar_rrr", "stanford_rrp", "panda", "ur5_robot", "lead_screw"])
@pytest.mark.parametrize("part", ["all", "translation", "rotation"])
def test_manipulability(name: str, part: Any) -> None:
    """Against the singular values that numpy finds in Pinocchio's Jacobian."""
    batch = make(name)
    q, frame = sample(batch.robot, 40), {"panda": "panda_hand", "ur5_robot": "tool0"}.get(name, "tool")
    J = ps.Pinocchio(batch.robot).jacobian(q, frame, "hybrid")
    moving = sorted({batch.robot.mechanism.motions[i].v for i in batch.robot.motions_above(frame)})
    rows = {"all": slice(0, 6), "translation": slice(0, 3), "rotation": slice(3, 6)}[part]
    values = np.linalg.svd(J[:, rows][:, :, moving], compute_uv=False)
    if part != "all":  # in the directions that there are: an arm in a plane has two, and one axis
        values = values[:, : max(1, int((values > 1e-9).sum(axis=1).max()))]
    expected = values.prod(axis=-1)
    np.testing.assert_allclose(batch.manipulability(q, frame, part), expected, rtol=1e-10, atol=1e-13)


def test_manipulability_in_closed_form() -> None:
    """A9: one joint of radius l2: V^b = (0, l2, 0, 0, 0, 1)."""
    batch = ps.Batch(ps.load("one_joint", l1=0.5, l2=0.7))
    q = sample(batch.robot, 5)
    np.testing.assert_allclose(batch.manipulability(q, part="all"), math.hypot(0.7, 1.0), rtol=1e-15)
    np.testing.assert_allclose(batch.manipulability(q, part="translation"), 0.7, rtol=1e-15)
    np.testing.assert_array_equal(batch.manipulability(q), batch.manipulability(q, part="translation"))


def test_one_manipulability() -> None:
    """`Batch` and a sweep say the same of a position, also of an arm in a plane, many frames and given arrays."""
    for name in ("scara", "planar_rrr", "panda"):
        swept = ps.sweep(name, samples=32, frame={"panda": "panda_hand"}.get(name))
        batch, frame = ps.Batch(name), swept.metadata["frame"]
        expected = swept.translation.manipulability
        np.testing.assert_allclose(batch.manipulability(swept.q, frame), expected, rtol=1e-9, atol=1e-12)
        assert expected.max() > 0.01
        rotation = batch.manipulability(swept.q, [frame, frame], "rotation", out=np.empty((32, 2)))
        np.testing.assert_allclose(rotation[:, 1], swept.rotation.manipulability, rtol=1e-9, atol=1e-12)


def test_manipulability_where_squares_are_subnormal() -> None:
    """The reciprocal of such a square is infinite: five parallel axes, all but in one line, gave NaN."""
    origins = ["0 0 0", *["0.5 0 0"] * 4]
    links = ["l0", "l1", "l2", "l3", "l4", "tool"]
    pairs = zip(origins, links, links[1:], strict=False)
    joints = [urdfs.joint(f"to_{child}", "revolute", parent, child, xyz=xyz) for xyz, parent, child in pairs]
    batch = ps.Batch(urdfs.load(urdfs.robot(*joints, links=" ".join(links))))
    for angle in (1e-150, 1e-154, 1e-155, 1e-158, 1e-160, 5e-324):
        q = np.full((3, 5), angle)
        np.testing.assert_array_equal(batch.manipulability(q, "tool", "all"), 0.0)
        assert (abs(batch.manipulability(q, "tool")) < 1e-140).all(), "no more than the angle, in the plane"


def test_reduce() -> None:
    """The blocks are all there, in order, with their rows."""
    batch = make("scara_rrp")
    q = sample(batch.robot, 2 * BLOCK + 11)
    T, J = batch.fk_jacobian(q, None, "hybrid")

    def collect(state: list[Any], rows: slice, poses: FloatArray, jacobians: FloatArray) -> list[Any]:
        return [*state, (rows, poses.copy(), jacobians.copy())]

    blocks = batch.reduce(q, None, "hybrid", collect, [])
    assert [rows.stop for rows, _, _ in blocks] == [BLOCK, 2 * BLOCK, 2 * BLOCK + 11]
    np.testing.assert_array_equal(np.concatenate([poses for _, poses, _ in blocks]), T)
    np.testing.assert_array_equal(np.concatenate([jacobians for _, _, jacobians in blocks]), J)
    assert batch.reduce(q[:0], None, "hybrid", collect, []) == []
    with pytest.raises(InputError, match="one axis"):
        batch.reduce(q[0], None, "hybrid", collect, [])
    q[BLOCK + 5, 1] = np.nan
    with pytest.raises(InputError, match=rf"nan at index \({BLOCK + 5}, 1\)"):
        batch.reduce(q, None, "hybrid", collect, [])


# -------------------------------------------------------------------------------------------------- buffers


@pytest.mark.parametrize("offset", range(8))
@pytest.mark.parametrize("stream", [False, True])
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_nothing_is_written_beside_the_results(
    offset: int, stream: bool, dtype: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Wherever in a cache line the results begin, past the cache or through it."""
    monkeypatch.setattr(kernel, "STREAMED", 0 if stream else 2**60)
    batch = make("planar_rrr")
    q = sample(batch.robot, 3 * CHUNK + 5)
    poses, jacobians = len(q) * 16, len(q) * 18
    memory = np.full(poses + jacobians + 64, 7.0, dtype)
    T = memory[offset : offset + poses].reshape(-1, 4, 4)
    J = memory[offset + poses + 8 : offset + poses + 8 + jacobians].reshape(-1, 6, 3)
    found = batch.fk_jacobian(q, "tool", "body", out=(T, J))
    assert found[0] is T
    assert found[1] is J
    close = TOLERANCE if dtype is np.float64 else 1e-6
    np.testing.assert_allclose(T, ps.PoE(batch.robot).fk(q), rtol=0, atol=close)
    np.testing.assert_allclose(J, ps.PoE(batch.robot).jacobian(q, "tool", "body"), rtol=0, atol=close)
    memory[offset : offset + poses] = memory[offset + poses + 8 : offset + poses + 8 + jacobians] = 7.0
    assert (memory == 7.0).all()


def test_float32() -> None:
    batch = make("ur5_robot")
    q = sample(batch.robot, 33).astype(np.float32)
    T, J = batch.fk_jacobian(q, "tool0", "body")
    assert T.dtype == J.dtype == np.float32
    exact = ps.PoE(batch.robot)
    assert abs(T - exact.fk(q, "tool0")).max() <= 1e-6
    assert abs(J - exact.jacobian(q, "tool0", "body")).max() <= 1e-6
    wide = np.empty((33, 4, 4))
    assert abs(batch.fk(q, "tool0", out=wide) - exact.fk(q, "tool0")).max() <= TOLERANCE
    narrow = np.empty((33, 4, 4), np.float32)
    assert abs(batch.fk(q.astype(float), "tool0", out=narrow) - exact.fk(q, "tool0")).max() <= 1e-6


def test_any_memory_of_coordinates() -> None:
    batch = make("planar_rrr")
    q = sample(batch.robot, 70)
    expected = batch.fk(q)
    q.setflags(write=False)
    np.testing.assert_array_equal(batch.fk(q), expected)
    np.testing.assert_array_equal(batch.fk(np.asfortranarray(q)), expected)
    np.testing.assert_array_equal(batch.fk(q[::-2]), expected[::-2])
    np.testing.assert_array_equal(batch.fk(q.tolist()), expected)
    np.testing.assert_array_equal(batch.fk(np.array([[0, 1, 2]])), batch.fk([[0.0, 1.0, 2.0]]))


def test_threads_share_the_work_and_the_engine() -> None:
    batch = make("panda")
    q = sample(batch.robot, 4 * SLICE + 5)
    alone = batch.fk(q, "panda_hand", threads=1)
    np.testing.assert_array_equal(batch.fk(q, "panda_hand"), alone)
    found: dict[int, FloatArray] = {}

    def ask(i: int) -> None:
        found[i] = batch.fk(q[i:], "panda_hand")

    callers = [threading.Thread(target=ask, args=(i,)) for i in range(4)]
    for caller in callers:
        caller.start()
    for caller in callers:
        caller.join()
    for i in range(4):
        np.testing.assert_array_equal(found[i], alone[i:])


def test_threads_that_ask_before_it_is_compiled() -> None:
    """None of them falls back to numpy, whose last bits are others."""
    robot = ps.load("spherical_rrp")
    q = sample(robot, 64)
    expected = ps.Batch(robot).fk_jacobian(q, "tool", "hybrid")
    batch, found, start = ps.Batch(robot), [], threading.Barrier(4)

    def ask() -> None:
        start.wait()
        found.append(batch.fk_jacobian(q, "tool", "hybrid", threads=1))

    callers = [threading.Thread(target=ask) for _ in range(4)]
    for caller in callers:
        caller.start()
    for caller in callers:
        caller.join()
    for T, J in found:
        np.testing.assert_array_equal(T, expected[0])
        np.testing.assert_array_equal(J, expected[1])


def test_an_interrupt_ends_the_helpers_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """Or they would write to arrays that are gone, and end the process with a segmentation fault."""
    batch = make("planar_rrr")
    q = sample(batch.robot, 40 * SLICE)
    expected = batch.fk(q, threads=1)
    compiled = batch._kernels[("tool",), Question(poses=True), (False, False)]
    assert compiled is not None
    right, slices, helper_works = compiled._compiled.call, [], threading.Event()

    def call(*arguments: Any) -> Any:
        if threading.current_thread() is threading.main_thread():
            assert helper_works.wait(60)
            raise KeyboardInterrupt
        slices.append(arguments)
        helper_works.set()
        time.sleep(0.05)
        return right(*arguments)

    monkeypatch.setattr(compiled._compiled, "call", call)
    monkeypatch.setattr("pinscrew.engines.compiled.batch.thread_count", int)
    out = np.zeros_like(expected)
    with pytest.raises(KeyboardInterrupt):
        batch.fk(q, out=out, threads=2)
    done, written = len(slices), out.copy()
    assert done < 5
    time.sleep(0.2)
    assert len(slices) == done
    np.testing.assert_array_equal(out, written)
    monkeypatch.undo()
    np.testing.assert_array_equal(batch.fk(q, out=out), expected)


def test_questions_too_large_to_compile(monkeypatch: pytest.MonkeyPatch) -> None:
    """Some hundred joints and frames would take minutes, and then more stack than there is."""
    batch = ps.Batch(ps.load("planar_rrr"))
    q = sample(batch.robot, 20)
    frames = list(batch.robot.frame_names)
    monkeypatch.setattr("pinscrew.engines.compiled.batch.MOST_NUMBERS", len(frames) * (16 + 6 * 3) - 1)
    T, J = batch.fk_jacobian(q, frames, "body")
    assert list(batch._kernels.values()) == [None]
    for i, frame in enumerate(frames):
        np.testing.assert_allclose(T[:, i], ps.Pinocchio(batch.robot).fk(q, frame), rtol=0, atol=TOLERANCE)
        expected = ps.Pinocchio(batch.robot).jacobian(q, frame, "body")
        np.testing.assert_allclose(J[:, i], expected, rtol=0, atol=TOLERANCE)
    batch.fk_jacobian(q, frames[1:], "body")
    assert None in batch._kernels.values()
    assert any(batch._kernels.values())


def test_copies() -> None:
    batch = make("planar_rrr")
    q = sample(batch.robot, 3)
    for twin in (copy.copy(batch), copy.deepcopy(batch), pickle.loads(pickle.dumps(batch))):  # noqa: S301
        np.testing.assert_array_equal(twin.fk(q), batch.fk(q))


# ------------------------------------------------------------------------------------------------- bad input


def test_bad_input(monkeypatch: pytest.MonkeyPatch) -> None:
    batch = make("planar_rrr")
    q = sample(batch.robot, 40)
    for index, value in (((17, 1), np.nan), ((39, 0), np.inf), ((0, 2), -np.inf)):
        bad = q.copy()
        bad[index] = value
        for ask in (batch.fk, batch.manipulability):
            with pytest.raises(InputError, match=rf"holds .* at index \({index[0]}, {index[1]}\)"):
                ask(bad)
    with pytest.raises(InputError, match="shape"):
        batch.fk(q[:, :2])
    with pytest.raises(InputError, match="not an array of numbers"):
        batch.fk([["a", "b", "c"]])
    with pytest.raises(UnknownNameError, match="no_such"):
        batch.fk(q, ["tool", "no_such"])
    with pytest.raises(UnknownNameError, match="no frame 5"):
        batch.fk(q, 5)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="no frames"):
        batch.fk(q, [])
    with pytest.raises(InputError, match="translation"):
        batch.manipulability(q, part="both")  # type: ignore[arg-type]
    for threads in (0, -1, 10_000, 1.5, "2"):
        with pytest.raises(InputError, match="cores of this machine"):
            batch.fk(q, threads=threads)  # type: ignore[arg-type]
    monkeypatch.setattr("pinscrew.engines.compiled.outputs.SMALL", 0)
    monkeypatch.setattr("pinscrew.engines.compiled.outputs.free_bytes", lambda: 10)
    with pytest.raises(InputError, match="blocks") as caught:
        batch.fk(q)
    assert caught.value.code == "memory"


def test_bad_out() -> None:
    batch = make("planar_rrr")
    q = sample(batch.robot, 4)
    read_only = np.empty((4, 4, 4))
    read_only.setflags(write=False)
    both = np.empty(200)
    q_inside = both[:12].reshape(4, 3)
    q_inside[:] = q
    for out in (
        np.empty((3, 4, 4)),
        np.empty((4, 4, 4), np.float16),
        np.empty((4, 4, 8))[:, :, ::2],
        read_only,
        [[0.0]],
    ):
        with pytest.raises(InputError) as caught:
            batch.fk(q, out=out)  # type: ignore[arg-type]
        assert caught.value.code == "out"
    with pytest.raises(InputError, match="overlaps"):
        batch.fk(q_inside, out=both[8:72].reshape(4, 4, 4))
    with pytest.raises(InputError, match="shape"):
        batch.fk_jacobian(q, None, "body", out=(np.empty((4, 4, 4)), np.empty((4, 6, 3), np.float32)))
    with pytest.raises(InputError, match="overlaps"):
        batch.fk_jacobian(q, None, "body", out=(both[:64].reshape(4, 4, 4), both[60:132].reshape(4, 6, 3)))
    for few in ((), (np.empty((4, 4, 4)),), np.empty((4, 4, 4))):
        with pytest.raises(InputError, match=f"out has {len(few)} arrays; give 2"):
            batch.fk_jacobian(q, None, "body", out=few)  # type: ignore[arg-type]


# ------------------------------------------------------------------------------------------- seen to fail


def round_off(monkeypatch: pytest.MonkeyPatch) -> None:
    """UR5's angles are π/2 to eleven digits in its file: taking them for π/2 moves the tool by 1e-12."""
    monkeypatch.setattr(chain, "ROUNDING", 1e-9)


def flip_axes(monkeypatch: pytest.MonkeyPatch) -> None:
    right = walk._column
    monkeypatch.setattr(walk, "_column", lambda step, z, point: right(step, [-x for x in z], point))


def mistake_quadrants(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pinscrew.engines.compiled.lanes._HALF_PI", (math.pi / 2, 0.0))


@pytest.mark.parametrize("break_it", [round_off, flip_axes, mistake_quadrants])
def test_a_wrong_kernel_is_seen(break_it: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    robot = ps.load("ur5_robot")
    q = sample(robot, 20, most=1e5)
    assert agreement(ps.Batch(robot), ps.PoE(robot), "tool0", q) <= TOLERANCE
    break_it(monkeypatch)
    assert not agreement(ps.Batch(robot), ps.PoE(robot), "tool0", q) <= TOLERANCE


# ------------------------------------------------------------------------------- without a compiler

ASK = """
import sys; sys.modules["llvmlite"] = None
import numpy as np, pinscrew as ps
robot = ps.load("scara_rrp")
q = np.random.default_rng(0).uniform(-3, 3, (50, 3))
assert abs(ps.Batch(robot).fk(q) - ps.PoE(robot).fk(q)).max() < 1e-13
assert abs(ps.Batch(robot).manipulability(q, part="translation")).max() > 0
"""


def test_no_compiler() -> None:
    """Without llvmlite the same answers come from numpy, and that is said once."""
    done = subprocess.run([sys.executable, "-c", ASK], capture_output=True, text=True, check=True)
    assert done.stderr.count('pip install "pinscrew[fast]"') == 1


def test_threads_of_an_engine() -> None:
    assert ps.Batch(ps.load("planar_rrr"), threads=1).fk(np.zeros((2, 3))).shape == (2, 4, 4)
    with pytest.raises(InputError, match="threads=0"):
        ps.Batch(ps.load("planar_rrr"), threads=0)
