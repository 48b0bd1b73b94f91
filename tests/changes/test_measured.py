"""What `measure` finds, in numbers: displacements, angles and limits that are known beforehand."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from diff_edits import Edited, pose, turn
from scipy.linalg import expm

import pinscrew as ps
import urdfs
from pinscrew.changes import distance, geometry, matching, measuring, walk
from pinscrew.changes.differences import (
    AxisMoved,
    CarriedMoved,
    Followed,
    LimitsChanged,
    Moved,
    Rehung,
    TipsApart,
    ZeroShifted,
)
from pinscrew.changes.outcome import Displacement, TipPlace, Tolerance
from pinscrew.changes.wording import told_apart, worded
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.robot.robot import Robot

NEAR = Tolerance(1e-9, 1e-9)
ARM = urdfs.robot(
    urdfs.joint("j1", "revolute", "base", "l1", xyz="0.1 -0.2 0.3", rpy="0.4 -0.7 1.9", axis="0.6 0 0.8"),
    urdfs.joint("j2", "revolute", "l1", "l2", xyz="0.3 0.1 0.2", rpy="-1.1 0.3 0.5", axis="0 1 0"),
    urdfs.joint("slide", "prismatic", "l2", "l3", xyz="0.2 0.4 0", rpy="0.2 0.9 -0.4", axis="0 0.6 -0.8"),
    urdfs.joint("j4", "continuous", "l3", "l4", xyz="0.1 0.2 0.3", rpy="1.2 -0.3 0.8", axis="1 0 0"),
    urdfs.joint("mount", "fixed", "l4", "tool", xyz="0.1 0 0.05", rpy="0.1 0.2 0.3"),
    links="base l1 l2 l3 l4 tool",
)
SHIFT, TURN = np.array([0.004, -0.007, 0.011]), np.array([0.02, -0.03, 0.01])


def differences(edit: Callable[[Edited], None], text: str = ARM, near: Tolerance = NEAR) -> list[object]:
    e = Edited(text)
    edit(e)
    return list(measuring.measure(urdfs.load(text), urdfs.load(e.text), near).differences)


def displaced(T: FloatArray) -> FloatArray:
    """Where a pose in a parent is after the displacement of `SHIFT` and `TURN` of its origin, seen from the parent."""
    angle = float(np.linalg.norm(TURN))
    return pose(T[:3, 3] + SHIFT, turn(TURN / angle, angle) @ T[:3, :3])


def move_origin(joint: str) -> Callable[[Edited], None]:
    return lambda e: e.set_origin(joint, displaced(e.origin(joint)))


# ------------------------------------------------------------------------ displacements in the parent's frame


@pytest.mark.parametrize("joint", ["j1", "j2", "slide", "j4", "mount"])
def test_an_origin_is_displaced_as_seen_from_the_parent(joint: str) -> None:
    (moved,) = differences(move_origin(joint))
    assert isinstance(moved, Moved)
    assert moved.joint.name == joint
    assert moved.move.frame == Edited(ARM).link(joint, "parent")
    assert moved.move.shift == pytest.approx(SHIFT, abs=1e-12)
    assert moved.move.turn == pytest.approx(TURN, abs=1e-12)
    assert moved.size == pytest.approx((np.linalg.norm(SHIFT), np.linalg.norm(TURN)))
    assert moved.kind == ("tip-moved" if joint == "mount" else "axis-turned")


@pytest.mark.parametrize("joint", ["j1", "j2", "slide"])
@pytest.mark.parametrize("back", [False, True])
def test_an_axis_alone_is_turned_as_seen_from_the_parent(joint: str, back: bool) -> None:
    """The axis w of b is exp(t) u, with t across u; it may point the other way on top of that."""

    def edit(e: Edited) -> None:
        e.set_axis(joint, (-1.0 if back else 1.0) * turn(e.across(joint), 0.03) @ e.axis(joint))

    (moved,) = differences(edit)
    e = Edited(ARM)
    assert isinstance(moved, AxisMoved)
    assert (moved.kind, moved.rigid, moved.follows) == ("axis-reversed" if back else "axis-turned", False, None)
    assert moved.move.turn == pytest.approx(e.origin(joint)[:3, :3] @ (0.03 * e.across(joint)), abs=1e-12)
    assert moved.move.shift == pytest.approx(np.zeros(3), abs=1e-12)


@pytest.mark.parametrize("joint", ["j1", "j2"])
def test_an_axis_alone_is_moved_across_itself(joint: str) -> None:
    """The origin goes 3 mm across and 5 mm along the axis, and what hangs from it stays: only the 3 mm count."""

    def edit(e: Edited) -> None:
        X = pose(3e-3 * e.across(joint) + 5e-3 * e.axis(joint))
        e.move(joint, X)
        e.compensate(joint, X)

    (moved,) = differences(edit)
    e = Edited(ARM)
    assert isinstance(moved, AxisMoved)
    assert (moved.kind, moved.rigid, moved.follows) == ("axis-moved", False, None)
    assert moved.move.shift == pytest.approx(e.origin(joint)[:3, :3] @ (3e-3 * e.across(joint)), abs=1e-12)
    assert moved.size == pytest.approx((3e-3, 0.0), abs=1e-12)


@pytest.mark.parametrize(("kind", "size"), [("revolute", (0.0, 0.02)), ("prismatic", (0.02, 0.0))])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_zero_is_shifted_along_or_about_the_axis(kind: str, size: tuple[float, float], sign: float) -> None:
    """b at q stands where a stands at q + shift: by Pinocchio at random q."""
    joint = urdfs.joint("j", kind, "base", "l", xyz="0.1 0.2 0.3", rpy="0.3 0.4 0.5", axis="0.6 0 0.8")
    text = urdfs.robot(joint, urdfs.joint("m", "fixed", "l", "tool", xyz="0.4 0 0.1"), links="base l tool")

    def edit(e: Edited) -> None:
        axis = e.axis("j")
        e.move("j", pose(sign * 0.02 * axis) if kind == "prismatic" else pose(R=turn(axis, sign * 0.02)))

    (shifted,) = differences(edit, text)
    assert isinstance(shifted, ZeroShifted)
    assert shifted.value == pytest.approx(sign * 0.02)
    assert shifted.size == pytest.approx(size)
    e = Edited(text)
    edit(e)
    a, b = ps.Pinocchio(urdfs.load(text)), ps.Pinocchio(urdfs.load(e.text))
    q = np.linspace(-1.0, 1.0, 7)[:, None]
    assert b.fk(q, "tool") == pytest.approx(a.fk(q + shifted.value, "tool"), abs=1e-12)


def test_what_is_displaced_off_the_axis_is_no_shift_of_the_zero() -> None:
    """Beside the turn about the axis there is one across, or a shift: the link is displaced, its axis stays."""
    for X in (pose(1e-3 * np.eye(3)[2], turn("z", 0.02)), pose(2e-3 * np.eye(3)[2])):
        joint = urdfs.joint("j", "revolute", "base", "l", rpy="0.3 0.4 0.5")
        text = urdfs.robot(joint, urdfs.joint("m", "fixed", "l", "tool", xyz="0.4 0 0.1"), links="base l tool")
        (moved,) = differences(lambda e, X=X: e.move("j", X), text)  # type: ignore[misc]
        assert isinstance(moved, CarriedMoved)
        R = Edited(text).origin("j")[:3, :3]
        assert moved.move.shift == pytest.approx(R @ X[:3, 3], abs=1e-12)


def test_a_planar_joint_has_a_frame() -> None:
    (moved,) = differences(move_origin("table"), urdfs.planar())
    assert isinstance(moved, Moved)
    assert (moved.kind, moved.move.frame) == ("frame-moved", "mid")
    assert moved.move.shift == pytest.approx(SHIFT, abs=1e-12)
    assert moved.move.turn == pytest.approx(TURN, abs=1e-12)


def test_a_link_whose_frame_alone_moved_is_seen_from_itself() -> None:
    """The mount's link has a camera below it that stays; the link, no tip, is re-expressed; a tip is displaced."""
    X = pose(SHIFT, turn(TURN / np.linalg.norm(TURN), float(np.linalg.norm(TURN))))
    text = ARM.replace("</robot>", '<link name="eye"/>' + urdfs.joint("e", "fixed", "tool", "eye") + "</robot>")
    (chosen,) = differences(lambda e: e.reexpress("mount", X), text)
    assert isinstance(chosen, Moved)
    assert (chosen.kind, chosen.kept) == ("frame-re-expressed", True)
    assert chosen.size == pytest.approx((np.linalg.norm(SHIFT), np.linalg.norm(TURN)))
    assert chosen.move.shift == pytest.approx(SHIFT, abs=1e-12)
    assert chosen.move.turn == pytest.approx(TURN, abs=1e-12)


@pytest.mark.parametrize("eye_in", ["a", "b"])
def test_a_tip_of_one_robot_counts_where_the_other_has_something_below(eye_in: str) -> None:
    """The tool is moved by X in its own frame, and the eye, which one of the two has on it, is where it was."""
    X = pose(SHIFT, turn(TURN / np.linalg.norm(TURN), float(np.linalg.norm(TURN))))
    a, b = Edited(ARM), Edited(ARM)
    (a if eye_in == "a" else b).attach("eye_joint", "fixed", "tool", "eye", pose((0.1, 0.0, 0.0)))
    b.move("mount", X)
    b.compensate("mount", X)
    found = measuring.measure(urdfs.load(a.text), urdfs.load(b.text), NEAR)
    (moved,) = (difference for difference in found.differences if difference.kind == "tip-moved")
    assert isinstance(moved, CarriedMoved)
    assert moved.joint.name == "mount"
    R = np.eye(3) if moved.alone else Edited(ARM).origin("mount")[:3, :3]
    assert moved.move.shift == pytest.approx(R @ SHIFT, abs=1e-12)
    assert moved.move.turn == pytest.approx(R @ TURN, abs=1e-12)


def test_the_nearest_joints_below_come_first() -> None:
    """Two chains of three from one column: the column's neighbours, then theirs, and no more than asked for."""
    joints = [urdfs.joint("column", "revolute", "base", "top")]
    for side in "lr":
        parents = ["top", *(f"{side}{i}" for i in range(3))]
        pairs = itertools.pairwise(parents)
        joints += [urdfs.joint(child.upper(), "revolute", parent, child) for parent, child in pairs]
    robot = urdfs.load(urdfs.robot(*joints, links="base top l0 l1 l2 r0 r1 r2"))
    pairs_ = matching.match(robot.description, robot.description).pairs
    poses = geometry.Poses(robot.description)
    features = walk.Features(poses, poses, pairs_, [], frozenset(), NEAR)
    column = next(i for i, pair in enumerate(pairs_) if pair.named.name == "column")
    for most in range(7):
        near = [pairs_[i].named.name for i in features.nearest(column, most)]
        assert len(near) == most
        assert [name[1] for name in near] == list("001122")[:most]
    assert len(features.nearest(column, 12)) == 6


def test_what_follows_another_joint_is_displaced_as_seen_from_its_parent() -> None:
    def bracket(e: Edited) -> None:
        e.insert("bracket", "fixed", "slide", pose(SHIFT, turn(TURN / np.linalg.norm(TURN), np.linalg.norm(TURN))))

    def other(e: Edited) -> None:
        e.joint("slide").set("type", "revolute")
        e.set_origin("slide", displaced(e.origin("slide")))

    for edit, kind in ((bracket, "joint-added"), (other, "type")):
        (follows,) = differences(edit)
        assert isinstance(follows, Followed)
        assert follows.carried is not None
        assert (follows.kind, follows.carried.frame) == (kind, "l2")
        assert follows.carried.turn == pytest.approx(TURN, abs=1e-12)
        assert follows.size == pytest.approx((follows.carried.length, np.linalg.norm(TURN)))


def test_what_follows_a_removed_joint_may_stay_or_fall_back() -> None:
    """Without the slide j4 stays where it was at zero, or keeps its origin, which then is one in l2."""
    (stays,) = differences(lambda e: e.remove("slide"))
    assert isinstance(stays, Followed)
    assert (stays.kind, stays.carried, stays.size) == ("joint-removed", None, (0.0, 0.0))

    def fall(e: Edited) -> None:
        origin, was = e.origin("j4"), e.origin("slide")
        e.remove("slide")
        e.set_origin("j4", origin)
        assert np.linalg.norm(was[:3, 3]) > 0.4

    (falls,) = differences(fall)
    assert isinstance(falls, Followed)
    assert falls.carried is not None
    T = np.linalg.inv(Edited(ARM).origin("slide"))
    assert (falls.kind, falls.carried.frame) == ("joint-removed", "l2")
    assert falls.carried.shift == pytest.approx(T[:3, 3], abs=1e-12)
    assert expm(np.cross(np.eye(3), falls.carried.turn)) == pytest.approx(T[:3, :3], abs=1e-12)


def test_the_words_of_a_move_are_its_numbers() -> None:
    """A turn about no axis by name has its unit vector, a shift its components in mm."""
    (change,) = ps.diff(urdfs.load(ARM), urdfs.load(moved_text("mount"))).changes
    words = re.search(r"turned by (\S+)° about \((.*?)\) and moved by \((.*?)\) mm, in the frame of 'l4'", change.words)
    assert words is not None, change.words
    assert float(words[1]) == pytest.approx(math.degrees(np.linalg.norm(TURN)), rel=1e-5)
    assert numbers(words[2]) == pytest.approx(TURN / np.linalg.norm(TURN), rel=1e-5)
    assert numbers(words[3]) == pytest.approx(SHIFT * 1e3, rel=1e-5)


def stays(e: Edited) -> None:
    """The planar joint's frame is moved along its own x, and what hangs from it stays."""
    e.move("table", pose((0.01, 0.0, 0.0)))
    e.compensate("table", pose((0.01, 0.0, 0.0)))


def limited(e: Edited) -> None:
    """A continuous joint gets limits, with rates beyond which it is not asked for."""
    e.joint("j4").set("type", "revolute")
    e.set_limits("j4", -1.0, 1.0)
    e.joint("j4").find("limit").attrib.update(effort="1e308", velocity="1e308")  # type: ignore[union-attr]


def hung(e: Edited) -> None:
    """j4 hangs from l2 instead of l3, which stands there at zero."""
    e.set_origin("j4", e.origin("slide") @ e.origin("j4"))
    e.joint("j4").find("parent").set("link", "l2")  # type: ignore[union-attr]


def freed(e: Edited) -> None:
    e.joint("k").remove(e.mimic("k"))


def turned_round(e: Edited) -> None:
    e.set_limits("j1", -1.0, 2.0)
    e.reverse("j1")


TURNED_ROUND = "narrowed from [-114.592°, 114.592°] to [-114.592°, 57.2958°]"
GONE_ROUND = "changed from [-57.2958°, 114.592°] to [-114.592°, 57.2958°], as its direction is reversed"
SENTENCES = {
    "slid": (
        ARM,
        lambda e: e.reexpress("j2", pose(0.02 * e.axis("j2"))),
        "its origin is slid by 20 mm along its axis;",
    ),
    "slide slid": (
        ARM,
        lambda e: e.reexpress("slide", pose(0.02 * e.across("slide"))),
        "its origin is slid by 20 mm, which its motion does not depend on;",
    ),
    "limited": (ARM, limited, "joint 'j4': it is revolute instead of continuous, with limits"),
    "hung": (ARM, hung, "joint 'j4': it hangs from link 'l2' instead of 'l3'; at zero, it stands where it stood"),
    "freed": (urdfs.mimic(), freed, "joint 'k': it has a coordinate of its own instead of following 'j'"),
    "frame goes": (urdfs.planar(), lambda e: e.move("table", pose((0.01, 0.0, 0.0))), "; what follows goes along"),
    "frame stays": (urdfs.planar(), stays, "; what follows stays"),
    "reversed": (ARM, lambda e: e.reverse("j1"), "is reversed: its coordinate has the other sign; what follows stays"),
    "reversed and narrowed": (ARM, turned_round, TURNED_ROUND),
}


@pytest.mark.parametrize(("text", "edit", "words"), SENTENCES.values(), ids=SENTENCES)
def test_the_other_sentences(text: str, edit: Callable[[Edited], None], words: str) -> None:
    e = Edited(text)
    edit(e)
    found = ps.diff(urdfs.load(text), urdfs.load(e.text))
    said = [change.words for change in (*found.changes, *found.notes)]
    assert sum(words in one for one in said) == 1, said


def test_a_joint_that_hangs_elsewhere_is_as_far_from_where_it_stood_as_it_moved() -> None:
    def fell(e: Edited) -> None:
        hung(e)
        e.set_origin("j4", displaced(e.origin("j4")))

    (stood,), (moved,) = differences(hung), differences(fell)
    assert isinstance(stood, Rehung)
    assert (stood.kind, stood.size) == ("parent", (0.0, 0.0))
    assert isinstance(moved, Rehung)
    assert moved.size == pytest.approx((np.linalg.norm(SHIFT), np.linalg.norm(TURN)))


def test_tips_apart_are_told_by_what_is_beyond_the_tolerance() -> None:
    apart = TipsApart("tip-moved", None, distance_of(3e-3, 2e-3), turned=True)
    assert worded(apart, NEAR).words.startswith("tip frame 'far' is displaced by up to 0.114592°, though")
    assert worded(replace(apart, turned=False), NEAR).words.startswith("tip frame 'tool' is displaced by up to 3 mm,")
    assert worded(apart, NEAR).link == "far"


def distance_of(length: float, angle: float) -> Displacement:
    return Displacement(length, TipPlace("tool", {}), angle, TipPlace("far", {}))


def test_of_equally_good_explanations_the_literal_one_is_told() -> None:
    """j1's axis is turned and its origin moved; j2 makes up for the move, and is moved itself.

    Either j1 moved what follows, or it stayed: two edits both ways. The former is what was written in j1's origin.
    """
    X, Y = pose((0.0, 0.0, 0.02)), pose((0.0, 0.03, 0.0))

    def edit(e: Edited) -> None:
        axis = turn(e.across("j1"), 0.1) @ e.axis("j1")
        e.move("j1", X)
        e.set_axis("j1", axis)
        e.set_origin("j2", np.linalg.inv(X) @ e.origin("j2") @ Y)

    first, second = differences(edit)
    assert isinstance(first, AxisMoved)
    assert isinstance(second, Moved)
    assert (first.kind, first.joint.name, second.joint.name) == ("axis-turned", "j1", "j2")
    assert first.follows is not None
    assert first.follows.shift == pytest.approx(Edited(ARM).origin("j1")[:3, :3] @ X[:3, 3], abs=1e-12)


def test_limits_that_go_round_with_their_axis_say_so() -> None:
    a, b = Edited(ARM), Edited(ARM)
    a.set_limits("j1", -1.0, 2.0)
    b.set_limits("j1", -1.0, 2.0)
    b.reverse("j1")
    found = ps.diff(urdfs.load(a.text), urdfs.load(b.text))
    assert [change.kind for change in found.changes] == ["axis-reversed", "limits"]
    assert found.changes[1].words.endswith(GONE_ROUND)


def moved_text(joint: str) -> str:
    e = Edited(ARM)
    move_origin(joint)(e)
    return e.text


def numbers(words: str) -> list[float]:
    return [float(number) for number in words.split(",")]


@pytest.mark.parametrize(("along", "words"), [(1e-3, "moved by 1 mm along y"), (-1e-3, "moved by -1 mm along y")])
def test_the_words_of_a_move_along_an_axis_have_its_sign(along: float, words: str) -> None:
    e = Edited(ARM)
    T = e.origin("mount")
    e.set_origin("mount", pose(T[:3, 3] + (0.0, along, 0.0), T[:3, :3]))
    (change,) = ps.diff(urdfs.load(ARM), urdfs.load(e.text)).changes
    assert f"tip frame 'tool' is {words}, in the frame of 'l4'" in change.words


def test_joints_added_and_removed_are_told_with_the_link_that_they_lead_to() -> None:
    e = Edited(ARM)
    e.attach("new", "revolute", "l2", "hand", pose((0.1, 0.0, 0.0)))
    a, b = urdfs.load(ARM), urdfs.load(e.text)
    (added,), (removed,) = ps.diff(a, b).changes, ps.diff(b, a).changes
    assert (added.kind, added.joint, added.link, added.line) == ("joint-added", "new", "hand", 1)
    assert (removed.kind, removed.joint, removed.link, removed.line) == ("joint-removed", "new", "hand", None)
    assert "(revolute) is added between links 'l2' and 'hand'" in added.words
    assert "(revolute) is removed between links 'l2' and 'hand'" in removed.words


@pytest.mark.parametrize(("old", "joint"), [("base", ""), ("l1", "j1"), ("l4", "j4"), ("tool", "mount")])
def test_a_link_that_is_renamed_is_told_once_and_with_its_joint(old: str, joint: str) -> None:
    e = Edited(ARM)
    e.rename_link(old, "other")
    found = ps.diff(urdfs.load(ARM), urdfs.load(e.text))
    assert found.changes == ()
    (note,) = found.notes
    assert (note.kind, note.joint, note.link, note.tip) == ("link-renamed", joint, "other", old == "tool")
    assert note.words.endswith(f"link 'other' was called '{old}'")


def test_a_tip_belongs_to_the_last_joint_that_leads_to_it_in_either_robot() -> None:
    """What is added below a tip, or removed from there, does not lead to it."""
    with_eye = Edited(ARM)
    with_eye.attach("eye_joint", "fixed", "tool", "eye", pose((0.1, 0.0, 0.0)))
    plain, eyed = (urdfs.load(text).description for text in (ARM, with_eye.text))
    for a, b in ((plain, eyed), (eyed, plain), (plain, plain)):
        matched_ = matching.match(a, b)
        ((x, y, index),) = measuring._tips(matched_, geometry.Poses(a), geometry.Poses(b))
        assert (x, y, matched_.pairs[index].named.name) == ("tool", "tool", "mount")


def test_a_frame_is_slid_to_the_tolerance_of_lengths() -> None:
    """The origin of j2 goes 1 cm along its axis and 1 µm off it, which 1 mm allows and a nanometre does not."""

    def edit(e: Edited) -> None:
        e.reexpress("j2", pose(1e-2 * e.axis("j2") + 1e-6 * e.across("j2")))

    e = Edited(ARM)
    edit(e)
    kinds = [
        [difference.kind for difference in measuring.measure(urdfs.load(ARM), urdfs.load(e.text), near).differences]
        for near in (Tolerance(1e-3, 1e-9), Tolerance(1e-9, 1e-3))
    ]
    assert kinds == [["origin-slid"], ["axis-moved"]]


def test_a_name_that_goes_to_another_joint_is_swapped() -> None:
    """Matched by their child links, j1 is called j2, and j2 j3: code for j2 moves another joint."""
    a = urdfs.chain(2)
    b = a.replace('joint name="j2"', 'joint name="j3"').replace('joint name="j1"', 'joint name="j2"')
    found = ps.diff(urdfs.load(a), urdfs.load(b))
    assert [(change.kind, change.joint) for change in found.changes] == [
        ("names-swapped", "j2"),
        ("names-swapped", "j3"),
    ]
    assert ps.diff(urdfs.load(a), urdfs.load(a.replace('joint name="j1"', 'joint name="j9"'))).same


@pytest.mark.parametrize("name", urdfs.ROBOTS)
def test_nothing_differs_from_itself_without_any_tolerance(name: str) -> None:
    robot = urdfs.load(urdfs.ROBOTS[name])
    found = ps.diff(robot, robot, length=0.0, angle=0.0)
    assert (found.changes, found.notes) == ((), ())


# ------------------------------------------------------------------------------------------- limits, numbers


@pytest.mark.parametrize(
    ("new", "word"),
    [
        ((-2.5, 2.0), "widened"),
        ((-2.0, 2.5), "widened"),
        ((-2.5, 2.5), "widened"),
        ((-1.5, 2.0), "narrowed"),
        ((-2.0, 1.5), "narrowed"),
        ((-1.5, 1.5), "narrowed"),
        ((-1.5, 2.5), "changed"),
        ((-2.5, 1.5), "changed"),
    ],
)
def test_limits_widen_narrow_or_change(new: tuple[float, float], word: str) -> None:
    (limits,) = differences(lambda e: e.set_limits("j1", *new))
    assert isinstance(limits, LimitsChanged)
    assert (limits.old, limits.new, limits.size) == ((-2.0, 2.0), new, (0.0, 0.5))
    e = Edited(ARM)
    e.set_limits("j1", *new)
    (change,) = ps.diff(urdfs.load(ARM), urdfs.load(e.text)).changes
    assert f" {word} from " in change.words


@pytest.mark.parametrize(("old", "new"), [(0.1, math.nextafter(0.1, 1.0)), (1.0, 1.0 + 2.0**-52), (1e3, 1e3 + 1e-10)])
def test_any_two_numbers_are_told_apart(old: float, new: float) -> None:
    texts = told_apart(old, new)
    assert texts[0] != texts[1]
    assert told_apart(new, old) == texts[::-1]
    assert told_apart(old, old) == (f"{old:.6g}",) * 2
    assert told_apart(1 / 3, 2.0) == ("0.333333", "2"), "six digits are enough for most"
    assert told_apart(old, 2 * old) == (f"{old:.6g}", f"{2 * old:.6g}")


# --------------------------------------------------------------------------------------- how far tips come apart


def tilted(lower: float, upper: float, tilt: float) -> Robot:
    """A tip 1 m from an axis that is tilted about x; with it, it is displaced by |(exp(R z q) - exp(z q)) x|."""
    joint = urdfs.joint(
        "j", "revolute", "base", "l", axis=f"0 {-math.sin(tilt)} {math.cos(tilt)}", limits=(lower, upper)
    )
    return urdfs.load(urdfs.robot(joint, urdfs.joint("m", "fixed", "l", "tool", xyz="1 0 0"), links="base l tool"))


def apart_at(q: float, tilt: float) -> float:
    """By the matrix exponential."""
    hats = [np.cross(np.eye(3), np.array(w)) for w in ((0.0, 0.0, 1.0), (0.0, -math.sin(tilt), math.cos(tilt)))]
    return float(np.linalg.norm((expm(hats[0] * q) - expm(hats[1] * q))[:, 0]))


@pytest.mark.parametrize(
    ("limits_a", "limits_b", "farthest"),
    [
        ((-2.0, 0.8), (-0.3, 2.0), 0.8),
        ((-0.3, 2.0), (-2.0, 0.8), 0.8),
        ((-0.9, 0.2), (-2.0, 2.0), -0.9),
        ((-2.0, 2.0), (-0.9, 0.2), -0.9),
        ((0.1, 0.6), (0.7, 0.9), 0.6),  # none in common: those of a
    ],
)
def test_tips_are_compared_within_the_limits_of_both(
    limits_a: tuple[float, float], limits_b: tuple[float, float], farthest: float
) -> None:
    """The displacement grows with |q|, up to the end of the range that both robots have."""
    found = ps.diff(tilted(*limits_a, 0.0), tilted(*limits_b, 0.1)).displacement
    assert found is not None
    assert found.length_at.q == pytest.approx({"j": farthest})
    assert found.length == pytest.approx(apart_at(farthest, 0.1))


def test_the_farther_tip_is_told_for_length_and_angle() -> None:
    """Two tips on one base: one is moved by 3 mm, the other one turned by 0.1 rad."""
    joints = [urdfs.joint(name, "revolute", "base", f"tip_{name}", xyz=f"{x} 0 0") for x, name in enumerate("ab")]
    e = Edited(urdfs.robot(*joints, links="base tip_a tip_b"))
    a = urdfs.load(e.text)
    e.move("a", pose((0.0, 0.0, 0.003)))
    e.move("b", pose(R=turn("x", 0.1)))
    found = ps.diff(a, urdfs.load(e.text)).displacement
    assert found is not None
    assert (found.length_at.frame, found.angle_at.frame) == ("tip_a", "tip_b")
    assert (found.length, found.angle) == (pytest.approx(0.003), pytest.approx(0.1))
    assert set(found.length_at.q) == {"a"}
    assert set(found.angle_at.q) == {"b"}


def test_fewer_configurations_for_many_tips(monkeypatch: pytest.MonkeyPatch) -> None:
    counts = []
    original = distance.configurations

    def counted(robot: Robot, samples: int, seed: int) -> object:
        counts.append(samples)
        return original(robot, samples, seed)

    monkeypatch.setattr(distance, "configurations", counted)
    for n in (1, 20, 300):
        joints = (urdfs.joint(f"j{i}", "fixed", "base", f"l{i}") for i in range(n))
        robot = urdfs.load(urdfs.robot(*joints, links=" ".join(["base", *(f"l{i}" for i in range(n))])))
        assert ps.diff(robot, robot).same
    assert counts == [2000, 1000, 100]


# --------------------------------------------------------------------------------------------- large robots


def star(n: int, xyz: str = "0.1 0 0") -> Robot:
    joints = (urdfs.joint(f"j{i}", "revolute", "hub", f"l{i}", xyz=xyz) for i in range(n))
    return urdfs.load(urdfs.robot(*joints, links=" ".join(["hub", *(f"l{i}" for i in range(n))])))


def test_each_robot_is_asked_once_for_all_its_tips(monkeypatch: pytest.MonkeyPatch) -> None:
    """What makes a star of ten thousand links a matter of seconds: no tip is asked for on its own."""
    asked = []
    poses = ps.PoE.poses
    monkeypatch.setattr(ps.PoE, "poses", lambda self, q, frames: asked.append(len(frames)) or poses(self, q, frames))
    monkeypatch.setattr(ps.PoE, "fk", pytest.fail)
    assert not ps.diff(star(60), star(60, "0.1 0 0.1")).same
    assert asked == [60, 60]


@pytest.mark.slow
def test_ten_thousand_links() -> None:
    a = star(9_999)
    assert ps.diff(a, a).same
    assert len(ps.diff(a, star(9_999, "0.2 0 0")).changes) == 9_999
    assert len(ps.diff(a, star(9_000)).changes) == 999


def test_too_many_changes_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ten joints and ten tips, displaced in one way beside none: 40 things to look at."""
    a, b = star(10), star(10, "0.2 0 0")
    monkeypatch.setattr(walk, "MOST", 40)
    assert len(ps.diff(a, b).changes) == 10
    monkeypatch.setattr(walk, "MOST", 39)
    with pytest.raises(InputError) as caught:
        ps.diff(a, b)
    assert caught.value.code == "too-many-changes"
    assert "20 joints and tips are displaced in 2 ways" in str(caught.value)


# ------------------------------------------------------------------------------------------------- matching


def matched(a: str, b: str) -> dict[str, str]:
    return dict(matching.match(urdfs.load(a).description, urdfs.load(b).description).joints)


def test_links_are_matched_by_name_and_by_the_joints_they_hang_on() -> None:
    """The base by its place; no link has two, and a name that both have is one link."""

    def links(a: str, b: str) -> dict[str, str]:
        def chain(names: str) -> str:
            base, arm, hand = names.split()
            joints = [urdfs.joint("j1", "revolute", base, arm), urdfs.joint("j2", "revolute", arm, hand, xyz="1 0 0")]
            return urdfs.robot(*joints, links=names)

        found = matching.match(urdfs.load(chain(a)).description, urdfs.load(chain(b)).description)
        return dict(found.links)

    assert links("base arm hand", "ground arm hand") == {"base": "ground", "arm": "arm", "hand": "hand"}
    assert links("base arm hand", "base lower upper") == {"base": "base", "arm": "lower", "hand": "upper"}
    assert links("base arm hand", "hand arm base") == {"base": "base", "arm": "arm", "hand": "hand"}
    assert links("base arm hand", "arm hand tool") == {"arm": "arm", "hand": "hand"}


def test_joints_are_matched_by_name_child_stand_and_type() -> None:
    def siblings(*names: str, kinds: tuple[str, ...] = ("revolute",) * 3, at: str = "123") -> str:
        joints = [
            urdfs.joint(name, kind, "base", name.upper(), xyz=f"{x} 0 0")
            for name, kind, x in zip(names, kinds, at, strict=True)
        ]
        return urdfs.robot(*joints, links=" ".join(["base", *(name.upper() for name in names)]))

    a = siblings("a", "b", "c")
    assert matched(a, siblings("c", "b", "a")) == {name: name for name in "abc"}, "by name, wherever they stand"
    child = a.replace('joint name="a"', 'joint name="x"')
    assert matched(a, child) == {"a": "x", "b": "b", "c": "c"}, "by the child's name"
    assert matched(a, siblings("x", "y", "z", at="312")) == {"a": "y", "b": "z", "c": "x"}, "by how they stand"
    kinds = ("continuous", "revolute", "prismatic")
    a = siblings("a", "b", "c", kinds=kinds)
    assert matched(a, siblings("x", "y", "z", kinds=kinds[::-1], at="456")) == {"a": "z", "b": "y", "c": "x"}, "by type"
    others = siblings("x", "y", "z", kinds=("continuous", "continuous", "prismatic"), at="456")
    assert matched(a, others) == {}, "not where the types are others"


@pytest.mark.parametrize(("inserted", "seen"), [(1, True), (49, True), (60, False)])
def test_a_joint_is_looked_for_behind_others_in_a_row(inserted: int, seen: bool) -> None:
    """Behind more than fifty it is found all the same, but as one that hangs elsewhere."""
    a = urdfs.chain(2)
    e = Edited(a)
    for i in range(inserted):
        e.insert(f"bracket{i}", "fixed", "j2", pose((0.01, 0.0, 0.0)))
    pairs = matching.match(urdfs.load(a).description, urdfs.load(e.text).description).pairs
    (pair,) = (pair for pair in pairs if pair.b is not None and pair.b.name == "j2")
    assert pair.a is not None
    assert pair.elsewhere is not seen
    e = Edited(e.text)
    pairs = matching.match(urdfs.load(e.text).description, urdfs.load(a).description).pairs
    (pair,) = (pair for pair in pairs if pair.a is not None and pair.a.name == "j2")
    assert pair.b is not None
    assert pair.elsewhere is not seen


def test_no_end_of_looking_through(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where too many joints stand beside added ones, what is behind these is found as hanging elsewhere."""
    e = Edited(urdfs.chain(2))
    a = urdfs.load(e.text).description
    e.insert("bracket", "fixed", "j2", pose((0.01, 0.0, 0.0)))
    b = urdfs.load(e.text).description
    for limit, elsewhere in ((100, False), (0, True)):
        monkeypatch.setattr(matching, "LOOKED_THROUGH", limit)
        (pair,) = (pair for pair in matching.match(a, b).pairs if pair.named.name == "j2")
        assert pair.elsewhere is elsewhere
