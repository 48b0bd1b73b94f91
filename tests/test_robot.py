"""What a robot says of itself: names, limits, tips, screws and home poses, and what it refuses."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import pinscrew as ps
import urdfs
from pinscrew.ground.errors import AmbiguousTipError, DescriptionError, InputError, UnknownNameError
from pinscrew.lie import se3
from pinscrew.robot.robot import FLOATING_JOINT, UNIVERSE


def robot(name: str, **options: Any) -> ps.Robot:
    return urdfs.load(urdfs.ROBOTS[name], **options)


# ---------------------------------------------------------------------------------------------------- names


def test_names_are_in_tree_order() -> None:
    """Depth first, parents before children, siblings as in the file, whatever the order of the links in it."""
    small = robot("unsorted_siblings")
    assert small.base == "base"
    assert small.frame_names == ("base", "link_z", "tool", "link_a", "link_m")
    assert small.joint_names == ("z", "b", "a", "m")
    assert small.coordinate_names == small.velocity_names == small.joint_names
    assert (small.nq, small.nv) == (4, 4)
    assert repr(small) == "<Robot 'small': 4 coordinates, 5 frames, base 'base'>"


def test_mimic_joints_have_no_coordinates() -> None:
    assert robot("mimic_chain").joint_names == ("c",)
    assert robot("mimic_continuous").joint_names == ("r", "d")


def test_free_joints_have_several_coordinates() -> None:
    plane, free = robot("planar"), robot("floating_middle")
    assert plane.coordinate_names == ("arm", "table.x", "table.y", "table.theta", "wrist")
    assert plane.velocity_names == ("arm", "table.vx", "table.vy", "table.wz", "wrist")
    quaternion = ("free.qx", "free.qy", "free.qz", "free.qw")
    assert free.coordinate_names == ("arm", "free.x", "free.y", "free.z", *quaternion, "wrist")
    velocities = ("free.vx", "free.vy", "free.vz", "free.wx", "free.wy", "free.wz")
    assert free.velocity_names == ("arm", *velocities, "wrist")
    assert (plane.nq, plane.nv, free.nq, free.nv) == (5, 5, 9, 8)
    assert free.joint_names == ("arm", "free", "wrist")


def test_no_coordinates() -> None:
    alone = robot("no_joints")
    assert (alone.joint_names, alone.coordinate_names, alone.velocity_names) == ((), (), ())
    assert alone.limits.shape == (0, 2)
    assert alone.neutral.shape == (0,)
    assert alone.screws().shape == (6, 0)
    assert alone.frame_names == ("base",)
    assert alone.tip == alone.base == "base"
    assert alone.reach == 0.0


def test_floating_base() -> None:
    small = robot("rotated", floating_base=True)
    assert (small.base, small.floating_base) == (UNIVERSE, True)
    assert small.frame_names[:2] == ("universe", "base")
    assert small.joint_names == (FLOATING_JOINT, "j1", "j2", "j3")
    assert small.coordinate_names[:7] == tuple(f"root_joint.{part}" for part in ("x", "y", "z", "qx", "qy", "qz", "qw"))
    assert (small.nq, small.nv) == (10, 9)
    np.testing.assert_array_equal(small.neutral, [0, 0, 0, 0, 0, 0, 1, 0, 0, 0])
    np.testing.assert_array_equal(small.home(), robot("rotated").home())
    np.testing.assert_array_equal(small.screws()[:, :6], np.eye(6))
    np.testing.assert_array_equal(small.screws()[:, 6:], robot("rotated").screws())


@pytest.mark.parametrize("name", [UNIVERSE, FLOATING_JOINT])
def test_a_floating_base_needs_its_names(name: str) -> None:
    old = "base" if name == UNIVERSE else "j"
    text = urdfs.single_revolute().replace(f'"{old}"', f'"{name}"')
    assert urdfs.load(text).nq == 1
    with pytest.raises(DescriptionError, match=f"needs the name '{name}', which the file uses; rename") as caught:
        urdfs.load(text, floating_base=True)
    assert caught.value.code == "reserved-name"


# --------------------------------------------------------------------------------------- limits and neutral


def test_limits() -> None:
    text = urdfs.robot(
        urdfs.joint("r", "revolute", "a", "b", limits=(-0.5, 1.25)),
        urdfs.joint("p", "prismatic", "b", "c", limits=(0.125, 0.25)),
        urdfs.joint("c", "continuous", "c", "d"),
        urdfs.joint("m", "revolute", "d", "e", limits=(-9.0, 9.0), mimic=("r", 2.0, 0.0)),
        urdfs.joint("t", "planar", "e", "f"),
        links="a b c d e f",
    )
    small = urdfs.load(text)
    inf = math.inf
    expected = [[-0.5, 1.25], [0.125, 0.25], [-inf, inf], [-inf, inf], [-inf, inf], [-inf, inf]]
    np.testing.assert_array_equal(small.limits, expected)
    np.testing.assert_array_equal(small.neutral, np.zeros(6))
    np.testing.assert_array_equal(robot("floating_middle").neutral, [0, 0, 0, 0, 0, 0, 0, 1, 0])


def test_configuration() -> None:
    small = robot("floating_middle")
    np.testing.assert_array_equal(small.configuration({}), small.neutral)
    found = small.configuration({"wrist": 0.5, "free.qw": -1.0, "arm": 2})
    np.testing.assert_array_equal(found, [2, 0, 0, 0, 0, 0, 0, -1, 0.5])
    found[:] = 7.0
    np.testing.assert_array_equal(small.neutral, [0, 0, 0, 0, 0, 0, 0, 1, 0])


@pytest.mark.parametrize("name", ["free", "body", "", "free.vx"])
def test_configuration_of_unknown_coordinates(name: str) -> None:
    small = robot("floating_middle")
    with pytest.raises(UnknownNameError, match=f"no coordinate '{name}'; known are: arm, free.x, free.y") as caught:
        small.configuration({name: 1.0})
    assert caught.value.known == small.coordinate_names


def test_reach() -> None:
    """The longest way over the joints' origins, fixed ones included."""
    assert robot("rotated").reach == pytest.approx(
        sum(map(math.hypot, (0.1, 0.2, 0, 0.3), (-0.4, 0, 0.3, 0), (0.2, 0.1, 0, 0.2)))
    )
    assert robot("tree").reach == pytest.approx(0.1 + math.hypot(0.2, 0.3) + 0.4, rel=1e-15)
    assert urdfs.load(urdfs.chain(30)).reach == 30.0


# ---------------------------------------------------------------------------------------- tips and what moves


def test_the_tip_is_the_lone_leaf_or_the_one_named() -> None:
    assert robot("rotated").tip == robot("rotated").frame() == "tool"
    assert robot("rotated", tip="l2").tip == "l2"
    assert robot("tree", tip="camera").frame() == "camera"
    np.testing.assert_array_equal(robot("tree", tip="camera").home(), robot("tree").home("camera"))


def test_several_leaves_have_no_tip() -> None:
    small = robot("tree")
    for ask in (lambda: small.tip, small.frame, small.home, small.screws):
        with pytest.raises(AmbiguousTipError) as caught:
            ask()
        assert str(caught.value) == "small: 2 leaves and no default tip; name a frame; the leaves are: l2, camera"
        assert caught.value.leaves == ("l2", "camera")
        assert caught.value.code == "ambiguous-tip"


def test_unknown_frames() -> None:
    small = robot("tree")
    for ask in (small.frame, small.home, small.screws, small.motions_above):
        with pytest.raises(UnknownNameError) as caught:
            ask("left")
        assert str(caught.value) == "small: there is no frame 'left'; known are: base, column, l1, l2, r1, camera"
    with pytest.raises(UnknownNameError, match="no frame 'hand'"):
        robot("tree", tip="hand")
    assert issubclass(UnknownNameError, LookupError)


def test_motions_above() -> None:
    small = robot("tree")
    names = [motion.joint.name for motion in small.mechanism.motions]
    assert names == ["lift", "left", "left2", "right"]
    above = {frame: tuple(names[i] for i in small.motions_above(frame)) for frame in small.frame_names}
    assert above == {
        "base": (),
        "column": ("lift",),
        "l1": ("lift", "left"),
        "l2": ("lift", "left", "left2"),
        "r1": ("lift", "right"),
        "camera": ("lift", "right"),
    }


# ------------------------------------------------------------------------------------------ screws and homes


def test_home_by_hand() -> None:
    """Origins multiplied up, with rpy as rotations about fixed x, y and z."""
    expected = np.eye(4)
    for xyz, rpy in (
        ([0.1, -0.4, 0.2], [0.7, -1.1, 2.9]),
        ([0.2, 0, 0.1], [3, math.pi / 2, -2]),
        ([0, 0.3, 0], [-2, 0.4, 0.3]),
        ([0.3, 0, 0.2], [0, 0, -3]),
    ):
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = Rotation.from_euler("xyz", rpy).as_matrix(), xyz
        expected = expected @ T
    np.testing.assert_allclose(robot("rotated").home(), expected, atol=1e-15, rtol=0)


def test_screws_by_hand() -> None:
    """(-ω × q, ω) for revolute and (v, 0) for prismatic joints; zero for joints that don't move the frame."""
    small = robot("tree")
    lift = [0, 0, 1, 0, 0, 0]
    left = [*-np.cross([1, 0, 0], [0, 0.2, 0.4]), 1, 0, 0]
    left2 = [*-np.cross([0, 1, 0], [0, 0.2, 0.8]), 0, 1, 0]
    right = [*-np.cross([-1, 0, 0], [0, -0.2, 0.4]), -1, 0, 0]
    none = np.zeros(6)
    for frame, columns in (
        ("base", (none, none, none, none)),
        ("column", (lift, none, none, none)),
        ("l2", (lift, left, left2, none)),
        ("camera", (lift, none, none, right)),
    ):
        np.testing.assert_allclose(small.screws(frame), np.stack(columns, axis=1), atol=1e-16, rtol=0)


@pytest.mark.parametrize("name", urdfs.ROBOTS)
@pytest.mark.parametrize("floating_base", [False, True])
def test_screws_are_jacobians_at_neutral(name: str, floating_base: bool) -> None:
    """Of both engines, in the base and in the frame; and homes are the poses there."""
    small = robot(name, floating_base=floating_base)
    for engine in (ps.PoE(small), ps.Pinocchio(small)):
        for frame in small.frame_names:
            for at, kind in (("space", "spatial"), ("body", "body")):
                J = engine.jacobian(small.neutral, frame, kind)
                np.testing.assert_allclose(small.screws(frame, at=at), J, atol=5e-15, rtol=0)
            np.testing.assert_allclose(small.home(frame), engine.fk(small.neutral, frame), atol=5e-15, rtol=0)


def test_mimic_offsets_are_in_the_home_pose() -> None:
    """k = -0.75 j + 0.3: at zero, k is at 0.3 already, and its screw counts -0.75 times."""
    small = robot("mimic")
    turned = se3.exp(0.3 * np.array([0, 0, 0, 0.6, 0, 0.8]))
    at_k = np.eye(4)
    at_k[:3, 3] = 0.5, 0, 0.2
    np.testing.assert_allclose(small.home(), at_k @ turned, atol=1e-16, rtol=0)
    j = [*-np.cross([0, 1, 0], [0.1, 0, 0.2]), 0, 1, 0]
    k = np.array([*-np.cross([0.6, 0, 0.8], [0.5, 0, 0.2]), 0.6, 0, 0.8])
    np.testing.assert_allclose(small.screws()[:, 0], j - 0.75 * k, atol=1e-16, rtol=0)


def test_chains_of_mimics() -> None:
    """b = -2 c + 0.5 and a = 0.25 b - 0.1, so a = -0.5 c + 0.025."""
    a, b, c = robot("mimic_chain").mechanism.motions
    assert [m.multiplier for m in (a, b, c)] == [-0.5, -2.0, 1.0]
    assert (a.q, b.q, c.q) == (0, 0, 0)
    assert a.T_base_child[0, 3] == pytest.approx(0.025, abs=1e-17)
    np.testing.assert_allclose(b.T_base_child[:3, :3], Rotation.from_rotvec([0, 0.5, 0]).as_matrix(), atol=1e-16)


def test_reference() -> None:
    """Poses and space screws in another frame fixed to the base."""
    bench = urdfs.joint("bench", "fixed", "base", "desk", xyz="1 2 3", rpy="0.1 0.2 0.3")
    text = urdfs.rotated().replace("</robot>", f'<link name="desk"/>{bench}</robot>')
    small = urdfs.load(text, tip="tool")
    desk = small.home("desk")
    np.testing.assert_allclose(small.home(reference="desk"), np.linalg.inv(desk) @ small.home(), atol=1e-15, rtol=0)
    carried = se3.adjoint(desk) @ small.screws(reference="desk")
    np.testing.assert_allclose(carried, small.screws(), atol=1e-14, rtol=0)
    np.testing.assert_array_equal(small.home(reference="base"), small.home())
    np.testing.assert_array_equal(small.screws(reference="base"), small.screws())


def test_a_reference_must_not_move() -> None:
    small = robot("rotated")
    for ask in (small.home, small.screws):
        with pytest.raises(InputError) as caught:
            ask("tool", reference="l1")
        assert str(caught.value) == "small: the frame 'l1' moves; the frames fixed to the base are: base"
        assert caught.value.code == "reference"
        with pytest.raises(UnknownNameError, match="no frame 'desk'"):
            ask("tool", reference="desk")
    with pytest.raises(InputError, match="body screw axes are in the tip's own frame; leave reference out"):
        small.screws(at="body", reference="base")


@pytest.mark.parametrize("at", ["spatial", "Body", "", None])
def test_screws_are_in_space_or_body(at: Any) -> None:
    with pytest.raises(InputError, match=f"at={at!r}; use 'space' or 'body'"):
        robot("rotated").screws(at=at)


# --------------------------------------------------------------------------------------------------- frozen


def test_robots_are_frozen() -> None:
    small = robot("rotated")
    for target, attribute in (
        (small, "name"),
        (small, "mechanism"),
        (small.description, "text"),
        (small.mechanism, "reach"),
        (small.mechanism.motions[0], "multiplier"),
        (small.description.joints[0], "axis"),
    ):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(target, attribute, None)


def test_arrays_are_read_only() -> None:
    small = robot("rotated")
    motion, joint = small.mechanism.motions[0], small.description.joints[0]
    homes = small.mechanism.homes
    for array in (
        small.limits,
        small.neutral,
        motion.twists,
        motion.T_base_child,
        joint.T_parent_joint,
        joint.axis,
        *homes.values(),
    ):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0.0
    for mapping in (homes, small.mechanism.motion_above, small.mechanism.coordinates.q):
        with pytest.raises(TypeError, match="does not support item assignment"):
            mapping["tool"] = 0


def test_answers_are_copies() -> None:
    small = robot("rotated")
    for ask in (small.home, small.screws, lambda: small.home(reference="base"), lambda: small.screws(at="body")):
        expected = ask().copy()
        ask()[:] = 7.0
        np.testing.assert_array_equal(ask(), expected)
