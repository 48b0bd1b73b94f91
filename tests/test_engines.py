"""What every engine promises: shapes, kinds of Jacobian, errors."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

import pinscrew as ps
import urdfs
from pinscrew.ground.errors import AmbiguousTipError, InputError, UnknownNameError
from pinscrew.ground.typing import KINDS, FloatArray

ENGINES = (ps.PoE, ps.Pinocchio, ps.Batch)
BATCHES = ((), (1,), (5,), (2, 3), (0,), (2, 0, 3))
# Numbers of coordinates: 0, 1, 3, and 9 with a quaternion.
SHAPED = ("only_fixed", "single_revolute", "rotated", "floating_middle")

AGREEMENT = 1e-13
"""Times the largest entry, at least 1: 450 ε, for chains of 9 joints of some 20 roundings each."""


@cache
def make(engine: Any, name: str, *, floating_base: bool = False) -> Any:
    return engine(urdfs.load(urdfs.ROBOTS[name], floating_base=floating_base))


def batch(engine: Any, shape: tuple[int, ...], seed: int = 0) -> tuple[FloatArray, FloatArray]:
    robot = engine.robot
    q, qd = urdfs.sample(robot, int(np.prod(shape)), seed)
    return q.reshape(*shape, robot.nq), qd.reshape(*shape, robot.nv)


def assert_equal(actual: FloatArray, expected: FloatArray) -> None:
    """Bit by bit, with the same shape and type."""
    np.testing.assert_array_equal(actual, expected, strict=True)


def assert_close(actual: FloatArray, expected: FloatArray) -> None:
    assert actual.shape == expected.shape
    size = max(1.0, np.abs(expected).max(initial=0.0))
    assert np.abs(actual - expected).max(initial=0.0) <= AGREEMENT * size


# ------------------------------------------------------------------------------------------------- shapes


@pytest.mark.parametrize("name", SHAPED)
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("shape", BATCHES)
def test_shapes(engine: Any, name: str, shape: tuple[int, ...]) -> None:
    """Batch axes are the same in as out, and each configuration is answered as if it were alone."""
    asked = make(engine, name)
    q, qd = batch(asked, shape)
    answers = {
        "pose": (asked.fk(q), (4, 4), lambda q, _: asked.fk(q)),
        **{
            f"{kind} {what}": (ask(q, qd), tail, ask)
            for kind in KINDS
            for what, tail, ask in (
                ("J", (6, asked.robot.nv), lambda q, _, kind=kind: asked.jacobian(q, "tool", kind)),
                ("dJ", (6, asked.robot.nv), lambda q, v, kind=kind: asked.jacobian_derivative(q, v, "tool", kind)),
                ("V", (6,), lambda q, v, kind=kind: asked.velocity(q, v, "tool", kind)),
            )
        },
    }
    for found, tail, ask in answers.values():
        assert found.shape == (*shape, *tail)
        assert found.dtype == np.float64
        for index in np.ndindex(shape):
            assert_close(found[index], ask(q[index], qd[index]))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", SHAPED)
def test_pose_and_jacobian_together(engine: Any, name: str) -> None:
    """As `fk` and `jacobian` answer them apart."""
    asked = make(engine, name)
    for shape in BATCHES:
        q, _ = batch(asked, shape)
        for kind in KINDS:
            T, J = asked.fk_jacobian(q, "tool", kind)
            assert_close(T, asked.fk(q, "tool"))
            assert_close(J, asked.jacobian(q, "tool", kind))


@pytest.mark.parametrize("engine", ENGINES)
def test_what_counts_as_an_array(engine: Any) -> None:
    asked = make(engine, "rotated")
    q, qd = batch(asked, (4,))
    q, qd = np.round(q, 3), np.round(qd, 3)
    expected = asked.fk(q), asked.jacobian_derivative(q, qd, "tool", "body")
    frozen = q.copy()
    frozen.setflags(write=False)
    wide = np.zeros((8, 6))
    wide[::2, ::2] = q
    for given_q in (q.tolist(), tuple(map(tuple, q)), frozen, wide[::2, ::2], np.asfortranarray(q), q[::-1][::-1]):
        assert_equal(asked.fk(given_q), expected[0])
        assert_equal(asked.jacobian_derivative(given_q, qd, "tool", "body"), expected[1])
    assert_equal(asked.fk([1, 0, -2]), asked.fk([1.0, 0.0, -2.0]))
    assert_equal(asked.fk(np.array([1, 0, -2], dtype=np.int8)), asked.fk([1.0, 0.0, -2.0]))
    if engine is not ps.Batch:  # whose results are float32 then
        assert_equal(asked.fk(q.astype(np.float32)), asked.fk(q.astype(np.float32).astype(float)))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", SHAPED)
def test_input_is_left_alone_and_output_is_fresh(engine: Any, name: str) -> None:
    asked = make(engine, name)
    q, qd = batch(asked, (3,))
    kept = q.copy(), qd.copy()
    first = asked.jacobian_derivative(q, qd, "tool", "spatial")
    again = first.copy()
    first[:] = np.nan
    pose = asked.fk(q)
    pose[:] = np.nan
    assert_equal(asked.jacobian_derivative(q, qd, "tool", "spatial"), again)
    assert np.isfinite(asked.fk(q)).all()
    assert_equal(q, kept[0])
    assert_equal(qd, kept[1])


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("q_axes", "qd_axes"), [((), (4,)), ((4,), ()), ((3, 1), (4,)), ((2, 1, 3), (5, 1))])
def test_velocities_broadcast(engine: Any, q_axes: tuple[int, ...], qd_axes: tuple[int, ...]) -> None:
    asked = make(engine, "floating_middle")
    q, qd = batch(asked, q_axes)[0], batch(asked, qd_axes, seed=1)[1]
    axes = np.broadcast_shapes(q_axes, qd_axes)
    full = np.broadcast_to(q, (*axes, asked.robot.nq)), np.broadcast_to(qd, (*axes, asked.robot.nv))
    for ask in (asked.velocity, asked.jacobian_derivative):
        found = ask(q, qd, "tool", "hybrid")
        assert found.shape[: len(axes)] == axes
        assert_equal(found, ask(*full, "tool", "hybrid"))


# -------------------------------------------------------------------------------------------------- kinds


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("kind", "alias"), [("spatial", "WORLD"), ("body", "LOCAL"), ("hybrid", "LOCAL_WORLD_ALIGNED")]
)
def test_names_of_kinds(engine: Any, kind: str, alias: str) -> None:
    asked = make(engine, "rotated")
    q, qd = batch(asked, (2,))
    for name in (alias, getattr(pin.ReferenceFrame, alias), getattr(pin, alias)):
        assert_equal(asked.jacobian(q, "tool", name), asked.jacobian(q, "tool", kind))
        assert_equal(asked.jacobian_derivative(q, qd, "tool", name), asked.jacobian_derivative(q, qd, "tool", kind))
        assert_equal(asked.velocity(q, qd, "tool", name), asked.velocity(q, qd, "tool", kind))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("kind", ["Spatial", "world", "", "geometric", None, 0, ["body"], pin.FrameType.BODY])
def test_no_such_kind(engine: Any, kind: Any) -> None:
    asked = make(engine, "single_revolute")
    for ask in (
        lambda: asked.jacobian([0.0], "tool", kind),
        lambda: asked.jacobian_derivative([0.0], [0.0], "tool", kind),
        lambda: asked.velocity([0.0], [0.0], "tool", kind),
    ):
        with pytest.raises(InputError, match=r"not a kind of Jacobian; use 'spatial' \(Pinocchio's WORLD\)") as caught:
            ask()
        assert caught.value.code == "jacobian-kind"


# ------------------------------------------------------------------------------------------------- errors


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("q", "code", "words"),
    [
        ([0.1, 0.2], "shape", r"q has shape \(2,\); expected \(..., 3\): j1, j2, j3"),
        (0.1, "shape", r"q has shape \(\)"),
        ([], "shape", r"q has shape \(0,\)"),
        (np.zeros((3, 4)), "shape", r"q has shape \(3, 4\)"),
        ([0.0, np.nan, 0.0], "not-finite", r"q holds nan at index \(1,\) \(j2\)"),
        ([[0.0, 0.0, 0.0], [0.0, 0.0, -np.inf]], "not-finite", r"q holds -inf at index \(1, 2\) \(j3\)"),
        ([None, 0.0, 0.0], "not-numbers", "q is not an array of numbers"),
        ([[0.0, 0.0], [0.0]], "not-numbers", "q is not an array of numbers"),
        (["a", "b", "c"], "not-numbers", "q is not an array of numbers"),
        ("text", "not-numbers", "q is not an array of numbers"),
        ([1j, 0.0, 0.0], "not-numbers", "q is not an array of numbers"),
        ([{}, 0.0, 0.0], "not-numbers", "q is not an array of numbers"),
    ],
)
def test_bad_coordinates(engine: Any, q: Any, code: str, words: str) -> None:
    asked = make(engine, "rotated")
    for ask in (
        lambda: asked.fk(q),
        lambda: asked.jacobian(q, "tool", "body"),
        lambda: asked.velocity(q, np.zeros(3), "tool", "body"),
        lambda: asked.answers(q, np.zeros((1, 3)), ["tool"]),
    ):
        with pytest.raises(InputError, match=words) as caught:
            ask()
        assert caught.value.code == code
        assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("qd", "code", "words"),
    [
        ([0.1, 0.2, 0.3], "shape", r"qd has shape \(3,\); expected \(..., 8\): arm, free.vx"),
        ([*[0.0] * 7, np.inf], "not-finite", r"qd holds inf at index \(7,\) \(wrist\)"),
        (np.zeros((3, 8)), "shape", r"batch axes of q \(2,\) and qd \(3,\) do not broadcast"),
    ],
)
def test_bad_velocities(engine: Any, qd: Any, code: str, words: str) -> None:
    asked = make(engine, "floating_middle")
    q = np.tile(asked.robot.neutral, (2, 1))
    for ask in (asked.velocity, asked.jacobian_derivative):
        with pytest.raises(InputError, match=words) as caught:
            ask(q, qd, "tool", "body")
        assert caught.value.code == code


@pytest.mark.parametrize("engine", ENGINES)
def test_unknown_frame(engine: Any) -> None:
    asked = make(engine, "tree")
    words = "small: there is no frame 'hand'; known are: base, column, l1, l2, r1, camera"
    for frame in ("hand", "left", ""):
        with pytest.raises(UnknownNameError) as caught:
            asked.fk(np.zeros(4), frame)
        assert str(caught.value) == words.replace("hand", frame)
        assert caught.value.known == asked.robot.frame_names


@pytest.mark.parametrize("engine", ENGINES)
def test_ambiguous_tip(engine: Any) -> None:
    asked = make(engine, "tree")
    for ask in (asked.fk, lambda q: asked.jacobian(q, None, "body")):
        with pytest.raises(AmbiguousTipError, match="the leaves are: l2, camera") as caught:
            ask(np.zeros(4))
        assert caught.value.leaves == ("l2", "camera")


@pytest.mark.parametrize("engine", ENGINES)
def test_quaternions(engine: Any) -> None:
    """What float32 leaves of a unit quaternion is normalised; anything else is refused, by name and norm."""
    asked = make(engine, "no_joints", floating_base=True)
    q, _ = batch(asked, (20,))
    rough = q.astype(np.float32).astype(float)
    assert np.abs(asked.fk(rough) - asked.fk(q)).max() <= 1e-6
    R = asked.fk(rough)[:, :3, :3]
    assert np.abs(R @ R.swapaxes(1, 2) - np.eye(3)).max() <= 1e-14
    for factor in (1.0 + 1e-5, 0.5, 0.0, 1e100):
        scaled = q.copy()
        scaled[7, 3:] *= factor
        with pytest.raises(InputError, match=r"quaternion \(x, y, z, w\) of 'root_joint' has norm") as caught:
            asked.fk(scaled)
        assert caught.value.code == "quaternion"
    negated = np.concatenate([q[:, :3], -q[:, 3:]], axis=1)
    assert_close(asked.fk(negated), asked.fk(q))
