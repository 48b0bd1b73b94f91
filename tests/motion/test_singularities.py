"""Singular configurations against the closed forms of the arms, and Pinocchio's Jacobians."""

from __future__ import annotations

import copy
import warnings
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest

import pinscrew as ps
import urdfs
from pinscrew.ground.errors import InputError, UnknownNameError
from pinscrew.ground.typing import FloatArray

FRAMES = {"ur5_robot": "tool0", "panda": "panda_hand_tcp"}


@cache
def load(name: str) -> ps.Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ps.load(name)


def u(q: FloatArray) -> float:
    """Distance of the anthropomorphic arm's tool from its first axis, l2 = l3 = 1/2: assignments, A8."""
    return float(0.5 * np.sin(q[1]) + 0.5 * np.sin(q[1] + q[2]))


DETERMINANTS: dict[str, tuple[str, list[Callable[[FloatArray], float]]]] = {
    # det of the planar task of 3R: l1 l2 s2; of the positions of 2R: c2 here, as its links are at right angles at zero
    # (J^b rows -c2 and 1 + s2, 1); of SCARA: l1 l2 s2; of the anthropomorphic arm: l2 l3 s3 u; of the spherical one:
    # r² c2, r > 0; of the Stanford-type one: d3² c2.
    "planar_rrr": ("pose", [lambda q: np.sin(q[1])]),
    "planar_2r": ("position", [lambda q: np.cos(q[1])]),
    "scara": ("position", [lambda q: np.sin(q[1])]),
    "anthropomorphic": ("position", [lambda q: np.sin(q[2]), u]),
    "spherical": ("position", [lambda q: np.cos(q[1])]),
    "stanford": ("position", [lambda q: np.cos(q[1]), lambda q: q[2]]),
}
"""The task and the factors of its determinant, of which one must vanish; each must be found."""


def smallest(robot: ps.Robot, one: ps.Singularity) -> float:
    """The last of the singular values that Pinocchio's Jacobian has almost everywhere, in m and rad as they are."""
    J = ps.Pinocchio(robot).jacobian(one.q, one.frame, "hybrid")
    rows = 6 if one.task == "pose" else 3
    return float(np.linalg.svd(J[:rows], compute_uv=False)[one.freedoms - 1])


def assert_consistent(robot: ps.Robot, one: ps.Singularity) -> None:
    """Pinocchio's Jacobian does no more than the result says: its kernel, and what it loses."""
    J = ps.Pinocchio(robot).jacobian(one.q, one.frame, "hybrid")[: 6 if one.task == "pose" else 3]
    assert abs(J @ one.self_motions).max(initial=0.0) < 1e-8
    assert abs(one.wrenches[: len(J)].T @ J).max(initial=0.0) < 1e-8
    assert one.self_motions.shape[1] == len(moving(robot, one.frame)) - one.rank
    scaled = one.lost / np.array([one.length] * 3 + [1.0] * 3)[:, None]
    weights = np.array([1.0 / one.length] * 3 + [1.0] * 3)[: len(J)]
    assert abs(scaled[: len(J)].T @ (weights[:, None] * J)).max(initial=0.0) < 1e-8


def moving(robot: ps.Robot, frame: str) -> list[str]:
    """The velocities of the joints that move a frame."""
    columns = np.any(ps.PoE(robot).jacobian(urdfs.sample(robot, 5)[0], frame, "spatial"), axis=(0, 1))
    return [name for name, moves in zip(robot.velocity_names, columns, strict=True) if moves]


# -------------------------------------------------------------------------------------------- known arms


@pytest.mark.parametrize("name", DETERMINANTS)
def test_known(name: str) -> None:
    """What is found is singular by the closed form, and every factor of it is found to vanish."""
    robot = load(name)
    task, factors = DETERMINANTS[name]
    found = ps.find_singularities(robot, task=task)  # type: ignore[arg-type]
    zeros = np.array([[abs(factor(one.q)) < 1e-6 for factor in factors] for one in found])
    assert zeros.any(axis=1).all()
    assert zeros.any(axis=0).all()
    for one in found:
        assert one.singular
        assert one.rank < one.freedoms
        assert smallest(robot, one) < 1e-9
        assert_consistent(robot, one)
        lower, upper = robot.limits.T
        assert ((one.q >= lower) & (one.q <= upper)).all()


@pytest.mark.parametrize("name", ["planar_2r", "scara", "anthropomorphic", "spherical", "stanford"])
def test_never_singular(name: str) -> None:
    """The twists of these arms are always independent: there is no singularity of the whole motion."""
    assert ps.find_singularities(load(name), task="pose", starts=30) == ()


TASKS = {
    "scara": ("position", {("joint2",)}),
    "planar_2r": ("position", {("joint2",)}),
    "ur5_robot": ("pose", None),
    "one_joint": ("position", set()),
}


@pytest.mark.parametrize("name", TASKS)
def test_the_task_that_a_person_means(name: str) -> None:
    """The position of an arm of few joints, which is lost where a SCARA is stretched out; the pose of one of six."""
    task, joints = TASKS[name]
    found = ps.find_singularities(name, "tool0" if name == "ur5_robot" else None, starts=40)
    assert (found.task, {one.task for one in found}) == (task, {task} if found else set())
    assert f"{task} of {found.frame}" in str(found).splitlines()[0]
    if joints is not None:
        assert {one.joints for one in found} == joints
    assert copy.copy(found).task == copy.deepcopy(found).task == task


def test_families_of_planar_3r() -> None:
    """Stretched and folded; what is lost is the direction of the arm, the self-motion that of a parallelogram."""
    robot = ps.load("planar_rrr", l1=0.5, l2=0.4, l3=0.3)
    found = ps.find_singularities(robot, task="pose")
    assert {one.joints for one in found} == {("joint2",)}
    assert sorted(abs(float(one.q[1])) for one in found) == pytest.approx([0.0, np.pi], abs=1e-9)
    one = ps.classify_singularity(robot, [0.3, 0.0, 0.5])
    (screw,) = one.wrench_screws
    assert screw.pitch == 0.0
    assert abs(np.cross(screw.direction, [np.cos(0.3), np.sin(0.3), 0.0])).max() < 1e-12
    assert abs(screw.point).max() < 1e-12
    # The three parallel axes are in one plane, at 0, 0.5 and 0.9: rates 0.4, -0.9, 0.5 cancel.
    motion = one.self_motions[:, 0] / one.self_motions[0, 0]
    assert motion == pytest.approx([1.0, -0.9 / 0.4, 0.5 / 0.4], abs=1e-12)
    assert str(one) == (
        "planar_rrr, pose of tool: singular, rank 2 of 3, by joint2 = 0\n"
        "lost: translation of the points on the line through (0, 0, 0) m along (0.9553, 0.2955, 0), along it\n"
        "moves without moving tool: joint1 -0.362, joint2 +0.815, joint3 -0.453"
    )


def test_regular() -> None:
    one = ps.classify_singularity(load("planar_rrr"), [0.3, 0.4, 0.5])
    assert (one.singular, one.rank, one.freedoms, one.joints) == (False, 3, 3, ())
    assert one.lost.shape == one.wrenches.shape == (6, 0)
    assert one.self_motions.shape == (3, 0)
    assert str(one) == "planar_rrr, pose of tool: regular, rank 3 of 3"


def test_anthropomorphic_shoulder() -> None:
    """Where the tool is on the first axis, turning about it does nothing, and sideways is lost."""
    theta2, theta1 = 0.7, 0.4
    one = ps.classify_singularity(load("anthropomorphic"), [theta1, theta2, -2.0 * theta2], task="position")
    assert one.joints == ("joint2", "joint3")
    assert abs(one.self_motions[:, 0] - [1.0, 0.0, 0.0]).max() < 1e-12
    sideways = np.array([np.cos(theta1), np.sin(theta1), 0.0])  # the direction of the axes of joints 2 and 3
    assert one.lost[:3, 0] == pytest.approx(sideways, abs=1e-12)
    assert not one.lost[3:].any()


# ----------------------------------------------------------------------------------------- UR5 and Panda


def test_ur5() -> None:
    """Elbow, wrist and shoulder: θ3 or θ5 a multiple of π, or the wrist's centre over the base's axis."""
    robot = load("ur5_robot")
    found = ps.find_singularities(robot, "tool0")
    by = {one.joints for one in found}
    assert {("elbow_joint",), ("wrist_2_joint",)} < by
    for one in found:
        assert smallest(robot, one) < 1e-9
        assert_consistent(robot, one)
        assert one.rank == 5
        if one.joints == ("elbow_joint",):
            assert abs(np.sin(one.q[2])) < 1e-9
        elif one.joints == ("wrist_2_joint",):
            assert abs(np.sin(one.q[4])) < 1e-9
        else:
            # Axes 5 and 6 meet on the first axis, or over it: axes of shoulder and wrist then have a common normal.
            assert one.joints == ("shoulder_lift_joint", "elbow_joint", "wrist_1_joint")
            a = ps.Pinocchio(robot).fk(one.q, "wrist_3_link")[:2, 3]
            axis4 = ps.Pinocchio(robot).fk(one.q, "wrist_1_link")[:2, 1]  # joint 4 turns about y
            assert abs(a - (a @ axis4) * axis4).max() < 1e-9
    assert any(len(one.joints) == 3 for one in found)


def test_panda() -> None:
    robot = load("panda")
    found = ps.find_singularities(robot, "panda_hand_tcp", starts=40)
    assert found
    for one in found:
        assert one.self_motions.shape == (robot.nv, 2)  # one of seven joints for six, and one more
        assert not one.self_motions[7].any()  # the fingers
        assert smallest(robot, one) < 1e-9
        assert_consistent(robot, one)


def test_kernel_of_a_redundant_arm() -> None:
    """A regular 7-joint arm has one self-motion and has lost nothing."""
    robot = load("panda")
    one = ps.classify_singularity(robot, [0.1, 0.2, 0.3, -1.2, 0.5, 1.6, 0.7, 0.0], "panda_hand_tcp")
    assert (one.singular, one.rank, one.freedoms) == (False, 6, 6)
    assert one.self_motions.shape == (robot.nv, 1)
    assert_consistent(robot, one)


def test_kernel_with_a_slide() -> None:
    """Rates of angles and of slides, in rad/s and m/s, whatever the length: two of them hold the tool's origin."""
    text = urdfs.robot(
        urdfs.joint("turn", "revolute", "base", "a"),
        urdfs.joint("slide", "prismatic", "a", "b", axis="1 0 0", limits=(0.2, 0.8)),
        urdfs.joint("wrist", "revolute", "b", "c"),
        urdfs.joint("hand", "fixed", "c", "tool", xyz="0.3 0.1 0"),
        links="base a b c tool",
    )
    robot = urdfs.load(text)
    for length in (0.1, 1.0, 10.0):
        one = ps.classify_singularity(robot, [0.4, 0.5, 0.6], task="position", length=length)
        assert (one.singular, one.rank, one.freedoms) == (False, 2, 2)
        assert_consistent(robot, one)


# -------------------------------------------------------------------------------------------- the measure


def test_first_order() -> None:
    """`joints` are those along which the singular value grows: by finite differences of Pinocchio's."""
    robot = load("ur5_robot")
    pin = ps.Pinocchio(robot)
    for one in ps.find_singularities(robot, "tool0", starts=30):
        weights = np.array([1.0 / one.length] * 3 + [1.0] * 3)
        step = 1e-7
        growth = np.array(
            [
                np.linalg.svd(weights[:, None] * pin.jacobian(one.q + e, "tool0", "body"), compute_uv=False)[5]
                for e in step * np.eye(6)
            ]
        )
        # Along the others it stays zero, but for σ'' step² / 2.
        assert {name for name, g in zip(robot.joint_names, growth / step, strict=True) if g > 1e-6} == set(one.joints)


def test_length_does_not_matter() -> None:
    """Rank, wrenches and joints are the same whatever a metre is worth."""
    robot, q = load("ur5_robot"), [0.3, -0.8, 0.0, 0.4, 1.1, -0.2]
    short, long = (ps.classify_singularity(robot, q, "tool0", length=x) for x in (0.1, 10.0))
    assert (short.rank, short.joints) == (long.rank, long.joints) == (5, ("elbow_joint",))
    assert abs(abs(short.wrenches) - abs(long.wrenches)).max() < 1e-9
    assert abs(short.lost - long.lost).max() > 0.1


def test_engines_agree() -> None:
    robot = load("ur5_robot")
    q = [0.3, -0.8, 0.0, 0.4, 1.1, -0.2]
    a, b = (ps.classify_singularity(robot, q, "tool0", engine=make(robot)) for make in (ps.PoE, ps.Pinocchio))
    assert abs(a.singular_values - b.singular_values).max() < 1e-13
    assert abs(a.lost - b.lost).max() < 1e-9


def test_deterministic() -> None:
    robot = load("planar_rrr")
    first, again = (ps.find_singularities(robot, seed=4, starts=20) for _ in range(2))
    assert [one.q.tolist() for one in first] == [one.q.tolist() for one in again]


def test_mimics() -> None:
    """A pair of gears has one freedom and no singularity; what mimics is folded."""
    for name in ("gear_pair", "lead_screw"):
        one = ps.classify_singularity(load(name), [0.3])
        assert (one.singular, one.rank, one.freedoms) == (False, 1, 1)
        assert ps.find_singularities(load(name), starts=5) == ()


def test_no_freedom_in_the_task() -> None:
    """A joint through its own tool's origin never moves it: nothing is lost, as nothing was there."""
    robot = urdfs.load(urdfs.robot(urdfs.joint("j", "revolute", "base", "tool"), links="base tool"))
    assert ps.find_singularities(robot, task="position", starts=5) == ()
    one = ps.classify_singularity(robot, [0.1], task="position")
    assert (one.singular, one.rank, one.freedoms) == (False, 0, 0)


@pytest.mark.parametrize(
    ("ask", "code", "words"),
    [
        (lambda r: ps.classify_singularity(r, [0.0]), "shape", r"q has shape \(1,\)"),
        (lambda r: ps.classify_singularity(r, np.zeros((2, 3))), "shape", r"q has shape \(2, 3\)"),
        (lambda r: ps.classify_singularity(r, [0.0, np.nan, 0.0]), "not-finite", "q is not finite"),
        (lambda r: ps.classify_singularity(r, np.zeros(3), task="x"), "task", "task='x'"),
        (lambda r: ps.classify_singularity(r, np.zeros(3), tolerance=0.0), "tolerance", "tolerance=0.0"),
        (lambda r: ps.classify_singularity(r, np.zeros(3), length=-1.0), "length", "length=-1.0"),
        (lambda r: ps.classify_singularity(r, np.zeros(3), "base"), "nothing-moves", "no joint moves"),
        (lambda r: ps.find_singularities(r, starts=0), "starts", "starts=0"),
        (lambda r: ps.find_singularities(r, seed=-1), "seed", "seed=-1"),
        (lambda r: ps.find_singularities(r, limits=[(-np.inf, np.inf)] * 3), "limits", "'joint3' has no limits"),
    ],
)
def test_bad_input(ask: Callable[[ps.Robot], Any], code: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        ask(load("scara"))
    assert caught.value.code == code


def test_unknown_frame() -> None:
    with pytest.raises(UnknownNameError, match="there is no frame 'hand'"):
        ps.classify_singularity(load("scara"), np.zeros(3), "hand")


def test_a_joint_that_moves_nothing_is_a_self_motion_by_itself() -> None:
    """Not mixed with others: the last joint of UR5 turns the tool about an axis that its origin is on."""
    (first, *_) = ps.find_singularities("ur5_robot", "tool0", task="position", starts=10)
    last = first.velocity_names.index("wrist_3_joint")
    alone = np.zeros(6)
    alone[last] = 1.0
    np.testing.assert_array_equal(first.self_motions[:, 0], alone)
    assert (first.self_motions[last, 1:] == 0.0).all()
    J = ps.Pinocchio("ur5_robot").jacobian(first.q, "tool0", "hybrid")[:3]
    assert abs(J @ first.self_motions).max() < 1e-8


def test_what_is_outside_the_limits_is_said() -> None:
    robot = ps.load("scara")
    upper = robot.limits[1, 1]
    for value, outside in ((upper, ()), (upper + 1e-6, (robot.coordinate_names[1],))):
        found = ps.classify_singularity(robot, [0.0, value, 0.0], task="position")
        assert found.outside == outside
        assert ("outside" in str(found)) == bool(outside)
