"""`ps.diff` on its own: sentences, formats, floating joints, robots that have little in common."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from diff_edits import Edited, pose, turn

import pinscrew as ps
import urdfs
from pinscrew.changes import walk
from pinscrew.description.catalogue import bundled
from pinscrew.ground.errors import InputError
from pinscrew.robot.robot import Robot

ARM = urdfs.robot(
    urdfs.joint("j1", "revolute", "base", "l1", xyz="0 0 0.3"),
    urdfs.joint("j2", "revolute", "l1", "l2", xyz="0 0 0.2", axis="0 1 0"),
    urdfs.joint("slide", "prismatic", "l2", "l3", xyz="0.4 0 0", axis="1 0 0", limits=(0.0, 0.5)),
    urdfs.joint("j4", "revolute", "l3", "l4", xyz="0.2 0 0", axis="0 1 0"),
    urdfs.joint("mount", "fixed", "l4", "tool", xyz="0.1 0 0"),
    links="base l1 l2 l3 l4 tool",
)


def edited(*edits: tuple[str, ...], text: str = ARM) -> Robot:
    """The arm with parts of its text replaced."""
    for old, new in edits:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return urdfs.load(text)


def said(b: Robot) -> list[str]:
    return [change.words for change in ps.diff(urdfs.load(ARM), b).changes]


@pytest.mark.parametrize("name", [entry.name for entry in bundled()])
def test_a_robot_is_the_same_as_itself(name: str) -> None:
    robot = ps.load(name)
    found = ps.diff(robot, robot)
    assert (found.same, found.changes, found.notes) == (True, (), ())
    assert found.displacement is not None
    assert found.displacement.length == found.displacement.angle == 0.0


# ------------------------------------------------------------------------------------------- sentences


def test_the_sentences() -> None:
    moved = edited(('xyz="0 0 0.2" rpy="0 0 0"', 'xyz="0.004 0 0.2" rpy="0 0 0"'))
    assert said(moved) == [
        "joint 'j2': its axis is moved by 4 mm along x, in the frame of 'l1'; what follows goes along"
    ]
    turned = edited(('xyz="0 0 0.2" rpy="0 0 0"', f'xyz="0 0 0.2" rpy="{math.radians(-0.5)} 0 0"'))
    assert said(turned) == [
        "joint 'j2': its axis is turned by -0.5° about x, in the frame of 'l1'; what follows goes along"
    ]
    axis = edited(('xyz="0 0 0.2" rpy="0 0 0"/><axis xyz="0 1 0"/>', 'xyz="0 0 0.2" rpy="0 0 0"/><axis xyz="1 0 0"/>'))
    assert said(axis) == ["joint 'j2': its axis is turned by -90° about z, in the frame of 'l1'; what follows stays"]
    zero = edited(('xyz="0 0 0.3" rpy="0 0 0"', f'xyz="0 0 0.3" rpy="0 0 {math.radians(0.5)}"'))
    assert said(zero) == ["joint 'j1': its zero is shifted by 0.5° about its axis"]
    limits = edited(('lower="0.0" upper="0.5"', 'lower="-0.1" upper="0.5"'))
    assert said(limits) == ["joint 'slide': its limits are widened from [0, 500] mm to [-100, 500] mm"]
    tool = edited(('xyz="0.1 0 0" rpy="0 0 0"', f'xyz="0.103 0 0.004" rpy="0 0 {math.pi / 2}"'))
    assert said(tool) == [
        "fixed joint 'mount': tip frame 'tool' is turned by 90° about z and moved by (3, 0, 4) mm, in the frame of 'l4'"
    ]
    back = edited(('xyz="0 0 0.2" rpy="0 0 0"/><axis xyz="0 1 0"/>', 'xyz="0 0 0.2" rpy="0 0 0"/><axis xyz="0 -1 0"/>'))
    assert said(back) == ["joint 'j2': its axis is reversed: its coordinate has the other sign; what follows stays"]
    slide = edited(('name="slide" type="prismatic"', 'name="slide" type="revolute"'))
    assert said(slide) == ["joint 'slide': it is revolute instead of prismatic"]


def test_every_change_has_its_line_in_b() -> None:
    text = ARM.replace("<joint", "\n<joint")
    after = text.replace('xyz="0.4 0 0" rpy="0 0 0"', 'xyz="0.4 0 0.1" rpy="0 0 0"')
    (change,) = ps.diff(urdfs.load(text), urdfs.load(after)).changes
    assert (change.kind, change.joint, change.link, change.line) == ("link-moved", "slide", "l3", 4)
    assert (change.length, change.angle) == pytest.approx((0.1, 0.0))
    gone = ps.diff(urdfs.load(text), edited(text=single(text, "mount", "tool")))
    assert [(c.kind, c.joint, c.line) for c in gone.changes] == [("tip-removed", "mount", None)]


def single(text: str, joint: str, link: str) -> str:
    """The text without a joint and its link."""
    e = Edited(text)
    e.remove(joint)
    assert link not in e.text
    return e.text


def test_a_displacement_is_told_with_its_place() -> None:
    b = edited(('xyz="0.1 0 0" rpy="0 0 0"', 'xyz="0.1 0 0.007" rpy="0 0 0"'))
    found = ps.diff(urdfs.load(ARM), b).displacement
    assert found is not None
    assert found.length == pytest.approx(0.007)
    assert found.length_at.frame == "tool"
    a, place = urdfs.load(ARM), found.length_at
    shift = [ps.PoE(robot).fk(robot.configuration(place.q), place.frame)[:3, 3] for robot in (a, b)]
    assert np.linalg.norm(shift[0] - shift[1]) == pytest.approx(found.length)


def test_the_largest_displacement_is_that_of_the_workspace() -> None:
    """An axis turned about itself by δ moves the tip by 2 sin(δ/2) times its distance, at most drawn out."""
    b = edited(('xyz="0 0 0.3" rpy="0 0 0"', 'xyz="0 0 0.3" rpy="0 0 0.01"'))
    found = ps.diff(urdfs.load(ARM), b).displacement
    assert found is not None
    most = 2 * math.sin(0.005) * (0.4 + 0.5 + 0.2 + 0.1)
    assert 0.95 * most < found.length <= most
    assert found.angle == pytest.approx(0.01)


def test_without_common_coordinates_there_is_no_displacement() -> None:
    for change in (
        ('name="j4" type="revolute"', 'name="j4" type="fixed"'),
        ('"slide" type="prismatic"', '"slide" type="revolute"'),
    ):
        assert ps.diff(urdfs.load(ARM), edited(change)).displacement is None


# ------------------------------------------------------------------------------------------- tolerances


def test_tolerances() -> None:
    a, b = urdfs.load(ARM), edited(('xyz="0 0 0.2" rpy="0 0 0"', 'xyz="0.001 0 0.2" rpy="1e-4 0 0"'))
    assert not ps.diff(a, b).same
    assert not ps.diff(a, b, length=2e-3).same
    assert ps.diff(a, b, length=2e-3, angle=2e-4).same
    assert not ps.diff(a, b, length=0.9e-3, angle=1.1e-4).same


def test_no_angle_within_its_tolerance_hides_a_tip_beyond_that_of_lengths() -> None:
    """An axis that is turned alone leaves all tips where they are at zero, and displaces them elsewhere."""
    turned = 'name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0 0 0.2" rpy="0 0 0"/><axis'
    a, b = (
        urdfs.load(ARM),
        edited((f'{turned} xyz="0 1 0"/>', f'{turned} xyz="{math.sin(0.015)} {math.cos(0.015)} 0"/>')),
    )
    changes = ps.diff(a, b, angle=0.02)
    assert [(change.kind, change.joint, change.link) for change in changes.changes] == [("tip-moved", "", "tool")]
    assert changes.displacement is not None
    assert changes.changes[0].length == changes.displacement.length > 0.015
    assert not ps.diff(a, b, length=0.015, angle=0.02).same
    (change,) = ps.diff(a, b, length=1.0, angle=0.02).changes
    assert change.angle > 0.02
    assert ps.diff(a, b, length=0.1, angle=0.04).same


def follower(kind: str, multiplier: float, offset: float, limits: tuple[float, float] = (-2.0, 2.0)) -> Robot:
    drive = urdfs.joint("drive", "revolute", "base", "wheel", limits=limits)
    rail = urdfs.joint("follow", kind, "base", "tool", mimic=("drive", multiplier, offset), axis="1 0 0")
    return urdfs.load(urdfs.robot(drive, rail, links="base wheel tool"))


def test_the_offset_of_a_slide_is_in_metres_and_that_of_a_turning_joint_in_radians() -> None:
    """15 mm are not within 1°, nor 0.01 rad within 15 mm."""
    slides = follower("prismatic", 0.1, 0.0), follower("prismatic", 0.1, 0.015)
    (change,) = ps.diff(*slides, angle=math.radians(1)).changes
    assert (change.kind, change.joint, change.length, change.angle) == ("mimic", "follow", 0.015, 0.0)
    assert not ps.diff(*slides, length=0.0149).same
    assert ps.diff(*slides, length=0.0151).same
    turns = follower("revolute", 0.1, 0.0), follower("revolute", 0.1, 0.01)
    (change,) = ps.diff(*turns, length=0.015).changes
    assert (change.kind, change.joint, change.length, change.angle) == ("mimic", "follow", 0.0, 0.01)
    assert ps.diff(*turns, angle=0.0101).same


@pytest.mark.parametrize(("kind", "unit"), [("prismatic", "length"), ("revolute", "angle")])
def test_a_multiplier_counts_by_what_it_does_within_the_limits(kind: str, unit: str) -> None:
    """0.01 more per radian is 0.02 at the limit of 2 rad, and 0.03 where the drive turns to 3 rad."""
    for end in (2.0, 3.0):
        a, b = (follower(kind, multiplier, 0.0, (-end, 0.5)) for multiplier in (0.1, 0.11))
        assert not ps.diff(a, b, **{unit: 0.0099 * end}).same
        assert ps.diff(a, b, **{unit: 0.0101 * end}).same


# ------------------------------------------------------------------------------ what is told, and how precisely


def told_numbers(words: str) -> list[str]:
    """The two things that a sentence tells apart, such as limits ``from A to B`` or a rate ``B instead of A``."""
    found = re.search(r"from (.*) to (.*)$", words) or re.search(r"is (\S+) instead of (\S+)$", words)
    assert found is not None, words
    return list(found.groups())


@pytest.mark.parametrize(("kind", "unit", "scale"), [("revolute", "°", math.radians(1)), ("prismatic", " mm", 1e-3)])
@pytest.mark.parametrize("far", [3.0, 1e-3, 1e-5])
def test_numbers_that_differ_read_differently(kind: str, unit: str, scale: float, far: float) -> None:
    """Limits of ±150 that become ±(150 + δ); a joint's own tolerance is below δ."""

    def robot(end: float) -> Robot:
        ends = (-150.0 * scale, end * scale)
        return urdfs.load(urdfs.robot(urdfs.joint("j", kind, "base", "tool", limits=ends), links="base tool"))

    (change,) = ps.diff(robot(150.0), robot(150.0 + far)).changes
    before, after = told_numbers(change.words)
    assert before in (f"[-150{unit}, 150{unit}]", f"[-150, 150]{unit}")
    lower, upper = (float(end) for end in re.findall(r"-?[\d.]+", after))
    assert (lower, upper) == (-150.0, pytest.approx(150.0 + far, rel=far / 1000))
    assert "widened" in change.words
    assert max(change.length, change.angle) == pytest.approx(far * scale, rel=1e-6)


def test_an_end_within_the_tolerance_is_not_told() -> None:
    """One limit differs by the last bit, the other one by 1 mm: the last bit is not there, not even as digits."""
    b = edited(('lower="0.0" upper="0.5"', 'lower="1e-12" upper="0.501"'))
    assert said(b) == ["joint 'slide': its limits are widened from [0, 500] mm to [0, 501] mm"]
    assert said(edited(('lower="0.0" upper="0.5"', 'lower="1e-12" upper="0.5000000000001"'))) == []


@pytest.mark.parametrize("attribute", ["velocity", "effort"])
def test_rates_that_differ_read_differently(attribute: str) -> None:
    joint = urdfs.joint("j", "revolute", "base", "tool")
    a = urdfs.load(urdfs.robot(joint, links="base tool"))
    for written, there in (("1.0000001", True), ("1.0000000000000002", False), ("1.5", True)):
        text = joint.replace(f'{attribute}="1"', f'{attribute}="{written}"')
        changes = ps.diff(a, urdfs.load(urdfs.robot(text, links="base tool")))
        assert changes.same
        assert [note.kind for note in changes.notes] == [attribute] * there
        assert [told_numbers(note.words) for note in changes.notes] == [[written, "1"]] * there


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        ((0.5, 0.1), (0.5, 0.10000001), ["0.5 × 'drive' + 100 mm", "0.5 × 'drive' + 100.00001 mm"]),
        ((0.5, 0.1), (0.50000001, 0.1), ["0.5 × 'drive' + 100 mm", "0.50000001 × 'drive' + 100 mm"]),
        ((0.5, 0.1), (0.5000000000001, 0.2), ["0.5 × 'drive' + 100 mm", "0.5 × 'drive' + 200 mm"]),
        ((0.5, 0.1), (0.6, 0.1000000000001), ["0.5 × 'drive' + 100 mm", "0.6 × 'drive' + 100 mm"]),
    ],
)
def test_mimics_that_differ_read_differently(
    before: tuple[float, float], after: tuple[float, float], told: list[str]
) -> None:
    (change,) = ps.diff(follower("prismatic", *before), follower("prismatic", *after)).changes
    assert told_numbers(change.words) == told


def test_no_distance_is_told_that_only_rounding_made() -> None:
    """A tip that is turned about itself does not come apart, though its computed place does in the last digits."""
    e = Edited(ARM)
    e.move("mount", pose(R=turn("x", 0.3) @ turn("y", 1.2)))
    changes = ps.diff(urdfs.load(ARM), urdfs.load(e.text))
    assert changes.displacement is not None
    assert not changes.same
    assert "come apart" not in str(changes)
    assert "tips are turned by" in str(changes)
    text = edited(('xyz="0.1 0 0" rpy="0 0 0"', f'xyz="0.1000001 0 0" rpy="0 0 {math.pi / 2}"'))
    coarse = ps.diff(urdfs.load(ARM), text, length=1e-6)
    assert " mm" not in str(coarse)
    assert "90°" in str(coarse)
    assert "0.0001 mm" in str(ps.diff(urdfs.load(ARM), text))
    limits = ps.diff(urdfs.load(ARM), edited(('upper="0.5"', 'upper="0.4"')))
    assert "at equal coordinates the tips stand where they stood" in str(limits)


def test_an_angle_within_the_tolerance_is_told_where_it_moves_a_tip_by_more() -> None:
    """j2 turned by 1e-4 rad in its origin moves the tool, 0.7 m away, by 70 µm."""
    a, b = urdfs.load(ARM), edited(('xyz="0 0 0.2" rpy="0 0 0"', 'xyz="0 0 0.2" rpy="0 0 1e-4"'))
    (change,) = ps.diff(a, b, length=1e-5, angle=1e-3).changes
    assert (change.kind, change.joint, change.length) == ("link-moved", "j2", 0.0)
    assert change.angle == pytest.approx(1e-4)
    assert "displaces what is farther out by more than the tolerance" in change.words
    (change,) = ps.diff(a, b, length=1e-5, angle=1e-5).changes
    assert change.kind == "axis-turned"
    assert "tolerance" not in change.words


@pytest.mark.parametrize("bad", [-1.0, math.nan, math.inf])
def test_bad_tolerances(bad: float) -> None:
    with pytest.raises(InputError, match="is no tolerance; give 0 or a positive number"):
        ps.diff(urdfs.load(ARM), urdfs.load(ARM), length=bad)


# ---------------------------------------------------------------------------- planar and floating joints


@pytest.mark.parametrize(("text", "joint"), [(urdfs.planar(), "table"), (urdfs.floating_middle(), "free")])
def test_planar_and_floating_joints_have_a_frame(text: str, joint: str) -> None:
    for size in (1e-6, 0.1):
        e = Edited(text)
        e.move(joint, pose(R=turn("z", size)))
        (change,) = ps.diff(urdfs.load(text), urdfs.load(e.text)).changes
        assert (change.kind, change.joint) == ("frame-moved", joint)
        assert change.angle == pytest.approx(size)
        e.compensate(joint, pose(R=turn("z", size)))
        (change,) = ps.diff(urdfs.load(text), urdfs.load(e.text)).changes
        assert (change.kind, change.joint) == ("frame-moved", joint)
    assert ps.diff(urdfs.load(text), urdfs.load(text)).same


def test_floating_base() -> None:
    a, b = urdfs.load(ARM, floating_base=True), urdfs.load(ARM)
    assert ps.diff(a, a).same
    assert [(c.kind, c.joint) for c in ps.diff(b, a).changes] == [("joint-added", "root_joint")]
    assert [(c.kind, c.joint) for c in ps.diff(a, b).changes] == [("joint-removed", "root_joint")]


# ------------------------------------------------------------------------------------ little in common


def test_any_two_robots() -> None:
    texts = (ARM, urdfs.no_joints(), urdfs.only_fixed(), urdfs.tree(), urdfs.mimic_chain())
    robots = [urdfs.load(text) for text in texts]
    for i, a in enumerate(robots):
        for j, b in enumerate(robots):
            found = ps.diff(a, b)
            assert found.same == (i == j or (i, j) == (1, 2)), "a fixed frame more moves nothing"
            assert json.loads(found.to_json())["same"] == found.same
            assert str(found).count("\n") >= len(found.changes)


def test_long_chains() -> None:
    def chain(n: int, rpy: str = "0 0 0") -> Robot:
        joints = [urdfs.joint(f"j{i}", "revolute", f"l{i}", f"l{i + 1}", xyz="0.1 0 0", rpy=rpy) for i in range(n)]
        return urdfs.load(urdfs.robot(*joints, links=" ".join(f"l{i}" for i in range(n + 1))))

    long = chain(300)
    assert ps.diff(long, long).same
    assert {c.kind for c in ps.diff(chain(1), long).changes} == {"joint-added"}
    assert {c.kind for c in ps.diff(long, chain(1)).changes} == {"joint-removed"}
    assert len(ps.diff(long, chain(300, "0.01 0.02 0.03")).changes) == 300


# --------------------------------------------------------------------------------------------- formats


def test_json_and_markdown() -> None:
    b = edited(('xyz="0.1 0 0" rpy="0 0 0"', 'xyz="0.1 0 0.007" rpy="0 0 0"'), ('name="small"', 'name="sm|all"'))
    found = ps.diff(urdfs.load(ARM), b)
    document = json.loads(found.to_json(), parse_constant=pytest.fail)
    assert document["schema"] == "pinscrew.diff/1"
    parts = {"schema", "a", "b", "same", "fail_on", "passes", "changes", "notes", "displacement"}
    assert set(document) == parts
    assert set(document["changes"][0]) == {"kind", "joint", "link", "words", "length", "angle", "line"}
    assert document["displacement"]["length_at"]["frame"] == "tool"
    assert document["notes"][0]["kind"] == "robot-renamed"
    assert json.loads(ps.diff(b, b).to_json())["displacement"]["length"] == 0.0
    lines = found.to_markdown().splitlines()
    assert lines[0] == "### small → sm\\|all: 1 change, 1 note"
    assert lines[2].startswith("- **tip-moved**: fixed joint 'mount'")
    text = str(found).splitlines()
    assert text[0] == "small → sm|all: 1 change, 1 note"
    assert text[2] == "  note: the robot is called 'sm|all' instead of 'small'"
    assert text[3].startswith("  tips come apart by 7 mm at most: 'tool' at j1=")


# ---------------------------------------------------------------------------------- the check can fail


def test_without_the_displacement_other_joints_are_blamed(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the way down is for: if it carried nothing, everything below an edit would be called changed."""
    b = edited(('xyz="0 0 0.3" rpy="0 0 0"', 'xyz="0.01 0 0.3" rpy="0 0 0"'))
    assert [c.joint for c in ps.diff(urdfs.load(ARM), b).changes] == ["j1"]
    monkeypatch.setattr(walk._Edits, "behind", lambda _self, _i, above: above)
    assert len(ps.diff(urdfs.load(ARM), b).changes) > 1


def test_files(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(ARM)
    assert ps.diff(ps.load(file), ps.load(file)).same
