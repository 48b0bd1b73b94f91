"""All solutions of inverse kinematics: as many as closed forms have, each right by Pinocchio."""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import numpy as np
import pytest

import pinscrew as ps
import urdfs
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray


def sampled(robot: ps.Robot, frame: str, count: int, seed: int) -> tuple[FloatArray, FloatArray]:
    """Configurations, and Pinocchio's poses there."""
    lower, upper = robot.limits.T
    q = np.random.default_rng(seed).uniform(np.maximum(lower, -3.0), np.minimum(upper, 3.0), (count, robot.nq))
    return q, ps.Pinocchio(robot).fk(q, frame)


def assert_right(robot: ps.Robot, T: FloatArray, found: ps.Solution) -> None:
    """Pinocchio puts the frame at the target, within the limits, and no two are the same but for whole turns."""
    lower, upper = robot.limits.T
    for target, q, solved, reason in zip(T, found.q, found.solved, found.reason, strict=True):
        assert solved[0]
        count = int(solved.sum())
        assert solved[:count].all(), "those that there are come first"
        assert set(reason[count:]) <= {"no other"}
        assert np.isnan(q[count:]).all()
        assert ((q[:count] >= lower) & (q[:count] <= upper)).all()
        reached = ps.Pinocchio(robot).fk(q[:count], found.frame)
        rows = slice(3) if found.task == "position" else slice(4)
        np.testing.assert_allclose(reached[:, :3, 3], np.broadcast_to(target[:3, 3], (count, 3)), rtol=0, atol=2e-9)
        if rows.stop == 4:
            np.testing.assert_allclose(reached, np.broadcast_to(target, (count, 4, 4)), rtol=0, atol=2e-9)
        points = np.concatenate([np.cos(q[:count]), np.sin(q[:count])], axis=1)
        apart = np.linalg.norm(points[:, None] - points, axis=2) + 9.0 * np.eye(count)
        assert apart.min(initial=9.0) > 1e-4


TWO_LINKS = urdfs.load(
    urdfs.robot(
        urdfs.joint("shoulder", "revolute", "base", "upper", limits=(-np.pi, np.pi)),
        urdfs.joint("elbow", "revolute", "upper", "fore", limits=(-np.pi, np.pi), xyz="0.5 0 0"),
        urdfs.joint("end", "fixed", "fore", "tool", xyz="0.4 0 0"),
        links="base upper fore tool",
    )
)


def test_two_links() -> None:
    """The lecture's law of cosines: cos q2 = (x² + y² - l1² - l2²) / (2 l1 l2), the elbow on either side."""
    robot = TWO_LINKS
    _, T = sampled(robot, robot.tip, 8, seed=1)
    found = ps.ik(robot, T, task="position", solutions="all")
    assert found.q.shape == (8, 2, 2)
    assert_right(robot, T, found)
    assert found.ok
    l1, l2 = 0.5, 0.4
    x, y = T[:, 0, 3], T[:, 1, 3]
    elbow = np.arccos((x * x + y * y - l1 * l1 - l2 * l2) / (2.0 * l1 * l2))
    np.testing.assert_allclose(np.sort(found.q[:, :, 1], axis=1), np.stack([-elbow, elbow], axis=1), rtol=0, atol=1e-8)


def test_the_first_is_the_nearest_to_where_it_starts() -> None:
    robot = TWO_LINKS
    q, T = sampled(robot, robot.tip, 8, seed=2)
    found = ps.ik(robot, T, q, task="position", solutions="all")
    np.testing.assert_allclose(found.q[:, 0], q, rtol=0, atol=1e-8)


def ur5_ways(T: FloatArray) -> int:
    """In how many ways a UR5 reaches a pose, from its maker's DH parameters.

    The centre of the wrist, where axes 5 and 6 meet, is d4 beside the base's axis, along the axes of joints 2 to 4: two
    shoulders. Axis 5 is perpendicular to these and to axis 6: two wrists of each. From there, upper arm and forearm
    make a triangle with the shoulder, the elbow on either side, or they are too short or too unlike.
    """
    d1, upper, fore, d4, d5, d6 = 0.089159, 0.425, 0.39225, 0.10915, 0.09465, 0.0823
    z6 = T[:3, 2]
    centre = T[:3, 3] - d6 * z6
    heading, beside = math.atan2(centre[1], centre[0]), math.hypot(centre[0], centre[1])
    ways = 0
    for side, turn in product((1.0, -1.0), repeat=2):
        angle = heading + side * math.acos(d4 / beside)
        n = np.array([math.cos(angle), math.sin(angle), 0.0])
        z5 = turn * np.cross(n, z6) / np.linalg.norm(np.cross(n, z6))
        arm = centre - d5 * z5 - [0.0, 0.0, d1]
        ways += 2 * (abs(upper - fore) < np.linalg.norm(arm - n * (n @ arm)) < upper + fore)
    return ways


def test_ur5() -> None:
    robot = ps.load("ur5_robot")
    q, T = sampled(robot, "tool0", 16, seed=3)
    found = ps.ik(robot, T, q, frame="tool0", solutions="all")
    assert found.q.shape == (16, 8, 6)
    assert_right(robot, T, found)
    np.testing.assert_allclose(found.q[:, 0], q, rtol=0, atol=1e-6)
    counts = found.solved.sum(axis=1)
    assert counts.tolist() == [ur5_ways(pose) for pose in T]
    assert set(counts) >= {2, 8}
    few = ps.ik(robot, T, q, frame="tool0", solutions="all", starts=16)
    assert few.solved.sum(axis=1).tolist() == counts.tolist(), "it goes on until each was met twice"


def test_anthropomorphic() -> None:
    """Four ways to a point: shoulder forwards or backwards, elbow up or down (the coursework's arm)."""
    robot = ps.load("anthropomorphic")
    _, T = sampled(robot, robot.tip, 8, seed=4)
    found = ps.ik(robot, T, task="position", solutions="all")
    assert_right(robot, T, found)
    assert found.solved.sum(axis=1).tolist() == [4] * 8


def test_limits_leave_some() -> None:
    robot = ps.load("anthropomorphic")
    _, T = sampled(robot, robot.tip, 8, seed=4)
    limits = robot.limits.copy()
    limits[2] = (0.0, 3.0)
    found = ps.ik(robot, T, task="position", limits=limits, solutions="all")
    assert found.solved.sum(axis=1).tolist() == [2] * 8
    assert (found.q[:, :2, 2] >= 0.0).all()


def test_fewer_and_none() -> None:
    """A target with one solution beside one with two, and one out of reach."""
    robot = TWO_LINKS
    _, T = sampled(robot, robot.tip, 1, seed=5)
    stretched = ps.Pinocchio(robot).fk([0.4, 0.0])
    far = stretched.copy()
    far[:2, 3] *= 2.0
    found = ps.ik(robot, np.stack([T[0], stretched, far]), task="position", solutions="all")
    assert found.solved.tolist() == [[True, True], [True, False], [False, False]]
    assert found.reason.tolist() == [["", ""], ["", "no other"], ["unreachable", "no other"]]
    assert not found.ok
    assert str(found).startswith("small, position of tool: 3 of 4 reached, largest error ")
    assert str(found).endswith("; unreachable: 1")
    np.testing.assert_allclose(found.q[2, 0], [0.4, 0.0], rtol=0, atol=1e-3)


def test_shapes() -> None:
    robot = TWO_LINKS
    _, T = sampled(robot, robot.tip, 6, seed=6)
    assert ps.ik(robot, T[0], task="position", solutions="all").q.shape == (2, 2)
    assert ps.ik(robot, T.reshape(2, 3, 4, 4), task="position", solutions="all").q.shape == (2, 3, 2, 2)
    assert ps.ik(robot, T[:0], task="position", solutions="all").q.shape == (0, 1, 2)


def test_a_second_engine_that_disagrees() -> None:
    class Bent(ps.PoE):
        def fk(self, q: Any, frame: Any = None) -> FloatArray:
            T = super().fk(q, frame)
            T[..., 2, 3] += 1e-6
            return T

    robot = TWO_LINKS
    _, T = sampled(robot, robot.tip, 1, seed=7)
    found = ps.ik(robot, T, task="position", solutions="all", engines=(ps.PoE(robot), Bent(robot)))
    assert found.reason.tolist() == [["unconfirmed", "unconfirmed"]]


def test_infinitely_many() -> None:
    robot = urdfs.load(urdfs.chain(4))
    _, T = sampled(robot, robot.tip, 1, seed=8)
    with pytest.raises(InputError, match="leaves 1 of 4 coordinates free") as caught:
        ps.ik(robot, T, solutions="all")
    assert caught.value.code == "redundant"
    limits = robot.limits.copy()
    limits[0] = (0.2, 0.2)
    q = np.array([0.2, 0.5, -0.7, 0.9])
    found = ps.ik(robot, ps.Pinocchio(robot).fk(q), q, limits=limits, solutions="all")
    np.testing.assert_allclose(found.q[0], q, rtol=0, atol=1e-8)
    assert found.solved.tolist() == [True, True]


def test_what_is_no_choice() -> None:
    with pytest.raises(InputError, match="'one' or 'all'"):
        ps.ik("planar_2r", np.eye(4), solutions="both")  # type: ignore[arg-type]
