"""Robots and engines can be pickled, copied, and shared between threads."""

import copy
import pickle
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import pinscrew as ps
import urdfs
from pinscrew.ground.errors import DescriptionError, InputError

ENGINES = [ps.PoE, ps.Pinocchio]
COPIES = {"pickle": lambda value: pickle.loads(pickle.dumps(value)), "deepcopy": copy.deepcopy}  # noqa: S301


@pytest.mark.parametrize("way", COPIES)
def test_a_copied_robot_is_alike_and_still_read_only(way: str) -> None:
    robot = ps.load("scara", l1=0.7, tip="link2")
    twin = COPIES[way](robot)
    assert (twin.name, twin.tip, twin.joint_names) == (robot.name, robot.tip, robot.joint_names)
    assert twin.description.arguments == {"l1": "0.7"}
    np.testing.assert_array_equal(twin.screws(), robot.screws())
    for array in (twin.limits, twin.neutral, twin.description.joints[0].T_parent_joint):
        assert not array.flags.writeable
    with pytest.raises(TypeError):
        twin.description.arguments["l1"] = "1"


@pytest.mark.parametrize("way", COPIES)
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("floating_base", [False, True])
def test_a_copied_engine_answers_alike(engine: type, way: str, floating_base: bool) -> None:
    original = engine(urdfs.load(urdfs.mimic_chain(), floating_base=floating_base))
    twin = COPIES[way](original)
    q, _ = urdfs.sample(original.robot, 5)
    tip = original.robot.frame_names[-1]
    np.testing.assert_array_equal(twin.fk(q, tip), original.fk(q, tip))


@pytest.fixture
def hasty_threads() -> Iterator[None]:
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


@pytest.mark.usefixtures("hasty_threads")
@pytest.mark.parametrize("engine", ENGINES)
def test_threads_may_share_an_engine(engine: type) -> None:
    robot = urdfs.load(urdfs.rotated())
    shared, tip = engine(robot), robot.frame_names[-1]
    q, _ = urdfs.sample(robot, 500)
    expected = {sign: engine(robot).fk(sign * q, tip) for sign in (1.0, -1.0)}
    with ThreadPoolExecutor(2) as pool:
        for _ in range(10):
            answers = {sign: pool.submit(shared.fk, sign * q, tip) for sign in expected}
            for sign, answer in answers.items():
                np.testing.assert_array_equal(answer.result(), expected[sign])


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    "q", [["0.1"], [True], [1j], np.array([1j]), np.array(["2026-01-01"], "M8[D]"), [[0.1], [0.1, 0.2]], [None]]
)
def test_only_real_numbers_are_coordinates(engine: type, q: object) -> None:
    with pytest.raises(InputError) as caught:
        engine(urdfs.load(urdfs.single_revolute())).fk(q)
    assert caught.value.code == "not-numbers"


@pytest.mark.parametrize("engine", ENGINES)
def test_answers_takes_one_flat_batch(engine: type) -> None:
    robot = urdfs.load(urdfs.single_revolute())
    with pytest.raises(InputError, match="one axis of N configurations"):
        engine(robot).answers(np.zeros((2, 3, 1)), np.zeros((2, 3, 1)), robot.frame_names)


def test_coordinates_have_names_of_their_own() -> None:
    flat = urdfs.joint("flat", "planar", "base", "plate")
    clash = urdfs.joint("flat.x", "revolute", "plate", "tool")
    with pytest.raises(DescriptionError, match=r"two coordinates would be called 'flat\.x'"):
        urdfs.load(urdfs.robot(flat, clash, links="base plate tool"))
