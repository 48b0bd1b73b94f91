"""Bound questions: what the engines say of one configuration, asked the short way."""

from __future__ import annotations

import gc
import os
import threading
from typing import Any

import numpy as np
import pytest

import pinscrew as ps
from pinscrew.ground.errors import InputError, UnknownNameError
from pinscrew.ground.typing import KINDS

ENGINES = ["PoE", "Pinocchio", "Batch"]
ROBOTS = {"ur5_robot": "tool0", "panda": "panda_leftfinger", "planar_rrr": None, "scara_rrp": None}
"""Panda has a mimic joint; planar_rrr's and scara_rrp's joints are of several types."""


def engine_of(name: str, robot: ps.Robot) -> Any:
    if name == "Batch":
        pytest.importorskip("llvmlite")
    return getattr(ps, name)(robot)


def sample(robot: ps.Robot, count: int, seed: int = 3) -> Any:
    return np.random.default_rng(seed).uniform(-3.0, 3.0, (count, robot.nq))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("name", ENGINES)
def test_bound_answers_are_the_engines(name: str, robot: str, kind: Any) -> None:
    """Against the other engine, asked the long way and in a batch; into given arrays as well."""
    loaded, frame = ps.load(robot), ROBOTS[robot]
    ask = engine_of(name, loaded).bind(frame, kind)
    other = (ps.PoE if name == "Pinocchio" else ps.Pinocchio)(loaded)
    q = sample(loaded, 10)
    T, J = other.fk_jacobian(q, frame, kind)
    out = np.full((4, 4), np.nan), np.full((6, loaded.nv), np.nan)
    for i, x in enumerate(q):
        given = ask(x, out=out)
        assert given[0] is out[0]
        assert given[1] is out[1]
        for pose, jacobian in (ask(x), out):
            assert abs(pose - T[i]).max() < 1e-13
            assert abs(jacobian - J[i]).max() < 1e-13


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("robot", ["one_joint", "ur5_robot"])
def test_answers_are_ones_own(name: str, robot: str) -> None:
    """An answer does not change when the next is asked, nor does q."""
    loaded = ps.load(robot)
    ask = engine_of(name, loaded).bind(loaded.frame_names[-1], "body")
    first, second = sample(loaded, 2)
    kept = first.copy()
    T, J = ask(first)
    copies = T.copy(), J.copy()
    ask(second)
    assert (copies[0] == T).all()
    assert (copies[1] == J).all()
    assert (first == kept).all()


def forms(x: Any) -> dict[str, Any]:
    """One configuration, of multiples of 1/8, in whatever may hold one."""
    frozen = x.copy()
    frozen.flags.writeable = False
    return {
        "a list": x.tolist(),
        "a tuple": tuple(x.tolist()),
        "float32": x.astype(np.float32),
        "big-endian": x.astype(">f8"),
        "every other": np.repeat(x, 2)[::2],
        "backwards": x[::-1].copy()[::-1],
        "a column": np.array([x, x]).T[:, 1],
        "read-only": frozen,
        "unaligned": np.frombuffer(b"\0" + x.tobytes(), np.uint8)[1:].view(np.float64),
        "a subclass": np.ma.masked_array(x),
    }


@pytest.mark.parametrize("form", forms(np.zeros(2)))
@pytest.mark.parametrize("robot", ["ur5_robot", "panda"])
@pytest.mark.parametrize("name", ENGINES)
def test_whatever_holds_a_configuration(name: str, robot: str, form: str) -> None:
    loaded = ps.load(robot)
    frame = ROBOTS[robot]
    ask = engine_of(name, loaded).bind(frame, "hybrid")
    x = np.arange(loaded.nq) / 8.0 - 0.25
    T, J = ps.PoE(loaded).fk_jacobian(x, frame, "hybrid")
    pose, jacobian = ask(forms(x)[form])
    close = 1e-6 if pose.dtype == np.float32 else 1e-13  # Batch's, for float32 coordinates
    assert pose.dtype == np.float64 or (name, form) == ("Batch", "float32")
    assert abs(pose - T).max() < close
    assert abs(jacobian - J).max() < close


def test_integers_and_large_angles() -> None:
    robot = ps.load("ur5_robot")
    for name in ENGINES:
        ask = engine_of(name, robot).bind("tool0", "body")
        for x in (np.arange(6), np.array([1e7, 2.0, -3e9, 1.0, 0.0, 5.0])):
            assert abs(ask(x)[0] - ps.PoE(robot).fk(x, "tool0")).max() < 1e-9


BAD: dict[str, tuple[Any, str]] = {
    "too long": (np.zeros(7), "shape"),
    "too short": (np.zeros(5), "shape"),
    "one for all": (np.zeros(1), "shape"),
    "a batch": (np.zeros((2, 6)), "shape"),
    "a batch of one": (np.zeros((1, 6)), "shape"),
    "a column": (np.zeros((6, 1)), "shape"),
    "a number": (0.5, "shape"),
    "NaN": (np.array([0.0, 0.0, 0.0, 0.0, 0.0, np.nan]), "not-finite"),
    "infinite": (np.array([np.inf, 0.0, -np.inf, 0.0, 0.0, 0.0]), "not-finite"),
    "complex": (np.zeros(6, complex), "not-numbers"),
    "truths": (np.zeros(6, bool), "not-numbers"),
    "objects": (np.array([0.0] * 6, object), "not-numbers"),
    "words": (["a"] * 6, "not-numbers"),
    "None": (None, "not-numbers"),
}


@pytest.mark.parametrize("bad", BAD)
@pytest.mark.parametrize("name", ENGINES)
def test_what_is_no_configuration(name: str, bad: str) -> None:
    q, code = BAD[bad]
    ask = engine_of(name, ps.load("ur5_robot")).bind("tool0", "body")
    ask(np.zeros(6))
    with pytest.raises(InputError) as caught:
        ask(q)
    assert caught.value.code == code


@pytest.mark.parametrize("name", ENGINES)
def test_longer_than_a_gathered_configuration(name: str) -> None:
    """Panda's coordinates are gathered by Pinocchio's order, which would find them in longer ones too."""
    ask = engine_of(name, ps.load("panda")).bind("panda_hand", "body")
    ask(np.zeros(8))
    with pytest.raises(InputError, match="shape"):
        ask(np.zeros(12))


@pytest.mark.parametrize("name", ENGINES)
def test_what_is_no_place_to_write_to(name: str) -> None:
    ask = engine_of(name, ps.load("ur5_robot")).bind("tool0", "body")
    ask(np.zeros(6))
    frozen = np.zeros((6, 6))
    frozen.flags.writeable = False
    good = np.zeros((4, 4))
    for out in ((good, frozen), (good, np.zeros((6, 7))), (good.astype(np.float32), np.zeros((6, 6))), (good,)):
        with pytest.raises(InputError) as caught:
            ask(np.zeros(6), out=out)
        assert caught.value.code == "out"


@pytest.mark.parametrize("name", ENGINES)
def test_what_is_checked_once(name: str) -> None:
    engine = engine_of(name, ps.load("ur5_robot"))
    with pytest.raises(UnknownNameError):
        engine.bind("nowhere", "body")
    with pytest.raises(InputError):
        engine.bind("tool0", "sideways")
    same = [engine.bind("tool0", kind)(np.zeros(6))[1] for kind in ("LOCAL", "body")]
    assert abs(same[0] - same[1]).max() < 1e-15


@pytest.mark.parametrize("name", ENGINES)
def test_threads(name: str) -> None:
    """Many threads with one question: nobody gets another's answer."""
    robot = ps.load("ur5_robot")
    ask = engine_of(name, robot).bind("tool0", "body")
    q = sample(robot, 40)
    wanted = ps.PoE(robot).fk(q, "tool0")
    wrong: list[int] = []

    def work(seed: int) -> None:
        for i in np.random.default_rng(seed).integers(0, 40, 150):
            if not abs(ask(q[i])[0] - wanted[i]).max() < 1e-12:
                wrong.append(int(i))

    threads = [threading.Thread(target=work, args=(seed,)) for seed in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


@pytest.mark.parametrize("name", ENGINES)
def test_a_fork(name: str) -> None:
    robot = ps.load("ur5_robot")
    ask = engine_of(name, robot).bind("tool0", "body")
    x, y = sample(robot, 2)
    ask(x)
    wanted = ps.PoE(robot).fk(y, "tool0")
    child = os.fork()
    if child == 0:
        os._exit(0 if abs(ask(y)[0] - wanted).max() < 1e-13 else 1)
    assert abs(ask(y)[0] - wanted).max() < 1e-13
    assert os.waitpid(child, 0)[1] == 0


@pytest.mark.parametrize("name", ENGINES)
def test_engines_that_die_first(name: str) -> None:
    """The question lives without its engine, and answers live without either."""
    robot = ps.load("ur5_robot")
    engine = engine_of(name, robot)
    ask = engine.bind("tool0", "body")
    x = sample(robot, 1)[0]
    wanted = ps.PoE(robot).fk(x, "tool0")
    del engine
    gc.collect()
    T, J = ask(x)
    del ask
    gc.collect()
    np.ones((1000, 6, 6))
    assert abs(T - wanted).max() < 1e-13
    assert np.isfinite(J).all()


def test_frames_that_numpy_answers() -> None:
    """A floating base: each engine goes its long way."""
    robot = ps.load("scara_rrp", floating_base=True)
    q = np.concatenate([[0.1, 0.2, 0.3, 0.0, 0.6, 0.0, 0.8], [0.1, 0.2, 0.3]])
    answers = [engine_of(name, robot).bind(robot.tip, "spatial")(q) for name in ENGINES]
    for T, J in answers[1:]:
        assert abs(T - answers[0][0]).max() < 1e-13
        assert abs(J - answers[0][1]).max() < 1e-13
