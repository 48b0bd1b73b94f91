"""A check must be seen to fail: each robot or engine here is wrong in one way, which `verify` catches and names."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import pinscrew as ps
import urdfs
from broken import ROBOT, edited, motion, pair, with_motions
from pinscrew.ground.typing import KINDS, FloatArray
from pinscrew.verification import structure
from pinscrew.verification.report import Report
from pinscrew.verification.run import verify

SIDES = pytest.mark.parametrize("side", [0, 1], ids=["PoE", "Pinocchio"])
STRUCTURE = {"structure"}
JACOBIANS = {f"{kind} Jacobian" for kind in KINDS}
DERIVATIVES = {f"{kind} Jacobian derivative" for kind in KINDS}
MOVED = {"screw axes", "forward kinematics"} | JACOBIANS | DERIVATIVES
PLACED = {"home poses", "forward kinematics"}
BODY = {f"{kind} Jacobian{rate}" for kind in ("body", "hybrid") for rate in ("", " derivative")}


def run(engines: tuple[Any, Any], samples: int = 3, **options: Any) -> Report:
    return verify(ROBOT, samples, engines=engines, **options)


def failed(report: Report) -> set[str]:
    return {check.name for check in report.failed}


# ------------------------------------------------------------------------------------ wrong files


@dataclass(frozen=True)
class Fault:
    """An edit of the file, what it must fail, and what must be said of it."""

    joint: str
    edits: tuple[tuple[str, str], ...]
    fails: set[str]
    words: tuple[str, str]
    """The end of the diagnosis when PoE has the wrong file, and when Pinocchio has."""


def seen(words: str) -> tuple[str, str]:
    """PoE is the measure, so the sign ± depends on the side."""
    minus, plus = (f"{words} in Pinocchio, compared with PoE".replace("±", sign) for sign in ("-", ""))
    return minus, plus


def to(what: str, wrong: str, right: str) -> tuple[str, str]:
    return f"its {what} {wrong} to PoE, {right} to Pinocchio", f"its {what} {right} to PoE, {wrong} to Pinocchio"


FAULTS = {
    "axis flipped": Fault("j2", (("0 1 0", "0 -1 0"),), MOVED, seen("its axis is flipped")),
    "slide flipped": Fault("j3", (("0 0.6 0.8", "0 -0.6 -0.8"),), MOVED, seen("its axis is flipped")),
    "axis tilted by 1e-6 rad": Fault(
        "j2", (("0 1 0", "1e-6 1 0"),), MOVED, seen("its axis is turned by 5.72958e-05° (1e-06 rad)")
    ),
    "axis tilted by 1e-9 rad": Fault(
        "j2", (("0 1 0", "0 1 1e-9"),), MOVED, seen("its axis is turned by 5.72958e-08° (1e-09 rad)")
    ),
    "slide tilted by 1e-9 rad": Fault(
        "j3", (("0 0.6 0.8", "1e-9 0.6 0.8"),), MOVED, seen("its axis is turned by 5.72958e-08° (1e-09 rad)")
    ),
    "origin moved by 1e-6 m": Fault(
        "j2",
        (("0.4 0 0", "0.400001 0 0"),),
        MOVED | PLACED,
        seen("its origin is moved by [±0.001, 0, 0] mm (0.001 mm)"),
    ),
    "origin moved by 1e-9 m": Fault(
        "j2",
        (("0.4 0 0", "0.4 1e-9 0"),),
        MOVED | PLACED,
        seen("its origin is moved by [0, ±1e-06, 0] mm (1e-06 mm)"),
    ),
    "fixed origin moved by 1e-9 m": Fault(
        "mount",
        (('0.2 0.1 0" rpy="0 0.4', '0.2 0.100000001 0" rpy="0 0.4'),),
        PLACED | BODY,
        seen("its origin is moved by [0, ±1e-06, 0] mm (1e-06 mm)"),
    ),
    "origin turned by 1e-9 rad": Fault(
        "mount",
        (('"0 0.4 0"', '"0 0.400000001 0"'),),
        PLACED | {"body Jacobian", "body Jacobian derivative"},
        seen("its frame is turned by 5.72958e-08° (1e-09 rad) about [0, ±1, 0]"),
    ),
    "mimic multiplier": Fault(
        "j4",
        (('multiplier="0.5"', 'multiplier="0.4"'),),
        STRUCTURE | MOVED,
        to("mimic is", "0.4 times 'j2' plus 0.25", "0.5 times 'j2' plus 0.25"),
    ),
    "mimic offset": Fault(
        "j4",
        (('offset="0.25"', 'offset="-0.25"'),),
        STRUCTURE | PLACED | BODY,
        to("mimic is", "0.5 times 'j2' plus -0.25", "0.5 times 'j2' plus 0.25"),
    ),
    "mimic of another joint": Fault(
        "j4",
        (('mimic joint="j2"', 'mimic joint="j1"'),),
        STRUCTURE | MOVED,
        to("mimic is", "0.5 times 'j1' plus 0.25", "0.5 times 'j2' plus 0.25"),
    ),
    "wrong parent": Fault(
        "j3",
        (('parent link="l2"', 'parent link="l1"'),),
        STRUCTURE | MOVED | PLACED,
        to("parent is", "'l1'", "'l2'"),
    ),
    "other type": Fault(
        "j2",
        (('name="j2" type="revolute"', 'name="j2" type="prismatic"'),),
        STRUCTURE | MOVED,
        to("type is", "'prismatic'", "'revolute'"),
    ),
    "continuous": Fault(
        "j2",
        (('name="j2" type="revolute"', 'name="j2" type="continuous"'),),
        STRUCTURE,
        to("limits are", "none", "(-2.0, 2.0)"),
    ),
    "limits": Fault(
        "j3",
        (('0.6 0.8"/><limit lower="-2.0"', '0.6 0.8"/><limit lower="-2.5"'),),
        STRUCTURE,
        to("limits are", "(-2.5, 2.0)", "(-2.0, 2.0)"),
    ),
}


@SIDES
@pytest.mark.parametrize("fault", FAULTS.values(), ids=FAULTS)
def test_wrong_file(fault: Fault, side: int) -> None:
    """The faulty joint is named, how it is wrong and by how much, and no joint below it is blamed."""
    report = run(pair(side, edited(*fault.edits)))
    assert failed(report) == fault.fails
    assert report.diagnosis == (f"joint {fault.joint!r}: {fault.words[side]}",)


@SIDES
def test_limits_are_compared_to_rounding(side: int) -> None:
    """The parsers read one text, so nothing but the last bit may differ."""
    for written, same in (("-2.0000000000000004", True), ("-2.000000000001", False), ("-2.001", False)):
        text = ('0.6 0.8"/><limit lower="-2.0"', f'0.6 0.8"/><limit lower="{written}"')
        assert (structure.compare(*pair(side, edited(text))) == ()) is same, written


def hundredfold(shift: str = "30 0 0", axis: str = "0 1 0") -> ps.Robot:
    joints = (
        urdfs.joint("j1", "revolute", "base", "l1", xyz="0 0 20"),
        urdfs.joint("j2", "revolute", "l1", "l2", xyz=shift, axis=axis),
        urdfs.joint("m", "fixed", "l2", "tool", xyz="50 0 0"),
    )
    return urdfs.load(urdfs.robot(*joints, links="base l1 l2 tool"))


def test_metres_and_radians_have_tolerances_of_their_own() -> None:
    """In a robot of 100 m, 5e-11 m are rounding and 1e-11 rad are not."""
    engines = ps.PoE(hundredfold()), ps.PoE(hundredfold("30 0 5e-11", axis="1e-11 1 0"))
    assert [line.split(" in PoE")[0] for line in ps.verify(hundredfold(), 20, engines=engines).diagnosis] == [
        "joint 'j2': its axis is turned by 5.72958e-10° (1e-11 rad)"
    ]
    engines = ps.PoE(hundredfold()), ps.PoE(hundredfold("30 1e-9 5e-11"))
    (line,) = ps.verify(hundredfold(), 20, engines=engines).diagnosis
    assert line.startswith("joint 'j2': its origin is moved by [0, 1e-06, 0] mm (1.00125e-06 mm)")


@SIDES
def test_joints_swapped(side: int) -> None:
    """The names of two joints are exchanged: each engine then drives the other's joint."""
    robot = edited(('name="j1"', 'name="?"'), ('name="j2"', 'name="j1"'), ('name="?"', 'name="j2"'))
    report = run(pair(side, robot))
    assert failed(report) == STRUCTURE
    parents = ("'l1' to PoE, 'base' to Pinocchio", "'base' to PoE, 'l1' to Pinocchio")
    assert f"joint 'j1': its parent is {parents[side]}" in report.diagnosis
    swapped = ["coordinate names are ['j2', 'j1', 'j3'] in PoE, ['j1', 'j2', 'j3'] in Pinocchio"]
    swapped.append("coordinate names are ['j1', 'j2', 'j3'] in PoE, ['j2', 'j1', 'j3'] in Pinocchio")
    assert swapped[side] in report.failed[0].remarks


@SIDES
@pytest.mark.parametrize(
    ("joint", "tail", "coordinates"),
    [
        ("more", '<joint name="more" type="fixed"><parent link="tool"/><child link="more"/></joint>', True),
        ("more", '<joint name="more" type="floating"><parent link="tool"/><child link="more"/></joint>', False),
    ],
)
def test_joint_missing(joint: str, tail: str, coordinates: bool, side: int) -> None:
    report = run(pair(side, edited(("</robot>", f'<link name="more"/>{tail}</robot>'))))
    engine = ("PoE", "Pinocchio")[side]
    assert failed(report) == STRUCTURE
    assert report.diagnosis == (f"joint {joint!r} is seen by {engine} only",)
    assert f"link 'more' is seen by {engine} only" in report.checks[0].remarks
    assert report.frames == len(ROBOT.frame_names)
    assert (len(report.checks) > 1) == coordinates  # with other coordinates there is nothing to compare


def test_other_link() -> None:
    """Without joints, only the links tell."""
    one, other = (urdfs.load(urdfs.robot(links=name)) for name in ("base", "root"))
    report = verify(one, 0, engines=(ps.PoE(one), ps.Pinocchio(other)))
    remarks = ("link 'base' is seen by PoE only", "link 'root' is seen by Pinocchio only")
    assert [(check.name, check.remarks) for check in report.checks] == [("structure", remarks)]
    assert not report.ok
    assert report.frames == 0


def test_several_faults_come_in_tree_order() -> None:
    report = run(pair(1, edited(("0 0 0.3", "0 0 0.4"), ("0 0.6 0.8", "0 -0.6 -0.8"), ("0 0.4 0", "0 0.5 0"))))
    said = [line.removesuffix(" in Pinocchio, compared with PoE") for line in report.diagnosis]
    assert said == [
        "joint 'j1': its origin is moved by [0, 0, 100] mm (100 mm)",
        "joint 'j3': its axis is flipped",
        "joint 'mount': its frame is turned by 5.72958° (0.1 rad) about [0, 1, 0]",
    ]


def test_a_mimic_is_not_blamed_for_its_master() -> None:
    text = urdfs.ROBOTS["mimic_chain"]  # a follows b, which follows c; a is nearest to the base
    right, wrong = urdfs.load(text), urdfs.load(text.replace('multiplier="-2.0"', 'multiplier="-2.5"'))
    report = verify(right, 2, engines=(ps.PoE(right), ps.Pinocchio(wrong)))
    words = "its mimic is -2.0 times 'c' plus 0.5 to PoE, -2.5 times 'c' plus 0.5 to Pinocchio"
    assert report.diagnosis == (f"joint 'b': {words}",)


def test_a_long_diagnosis_is_cut() -> None:
    text = urdfs.chain(9)
    right, wrong = urdfs.load(text), urdfs.load(text.replace("1 0 0", "1 0 0.5"))
    diagnosis = verify(right, 0, engines=(ps.PoE(right), ps.PoE(wrong))).diagnosis
    assert [line[:10] for line in diagnosis[:4]] == [f"joint 'j{i}'" for i in (1, 2, 3, 4)]
    assert diagnosis[4:] == ("… and 5 more differences",)


# ------------------------------------------------------------------------------------ wrong screws


def moved(joint: str, row: int, by: float) -> FloatArray:
    twists = motion(joint).twists.copy()
    twists[row] += by
    return twists


TILT = "0.572958° (0.01 rad)"
SCREWS = {
    "axis not normalised": (
        {"j2": {"twists": 1.5 * motion("j2").twists}},
        ("its axis is 1 long instead of 1.5", "its axis is 1.5 long instead of 1"),
    ),
    "slide not normalised": (
        {"j3": {"twists": 2.0 * motion("j3").twists}},
        ("its axis is 1 long instead of 2", "its axis is 2 long instead of 1"),
    ),
    "mimic's multiplier": (
        {"j4": {"multiplier": 0.4}},
        ("it moves 0.5 times its coordinate instead of 0.4", "it moves 0.4 times its coordinate instead of 0.5"),
    ),
    "mimic's sign": (
        {"j4": {"multiplier": -0.75}},
        (
            "it moves 0.5 times its coordinate instead of 0.75, the other way",
            "it moves 0.75 times its coordinate instead of 0.5, the other way",
        ),
    ),
    "another line": (
        {"j1": {"twists": moved("j1", 1, 1e-9)}},
        (
            "its axis is moved by [1e-06, 0, 0] mm in the child's frame",
            "its axis is moved by [-1e-06, 0, 0] mm in the child's frame",
        ),
    ),
    "another direction and line": (
        {"j1": {"twists": np.array([[0.0], [1e-3], [0.0], [math.sin(0.01)], [0.0], [math.cos(0.01)]])}},
        (f"its axis is turned by {TILT}", f"its axis is turned by {TILT}"),
    ),
    "nearly the other way": (
        {"j1": {"twists": np.array([[0.0], [0.0], [0.0], [math.sin(2.5)], [0.0], [math.cos(2.5)]])}},
        ("its axis is turned by 143.239° (2.5 rad)", "its axis is turned by 143.239° (2.5 rad)"),
    ),
    "a pitch": (
        {"j1": {"twists": moved("j1", 2, 1e-3)}},
        ("its pitch is 0 m/rad instead of 0.001", "its pitch is 0.001 m/rad instead of 0"),
    ),
    "a slide instead of a turn": (
        {"j2": {"twists": np.roll(motion("j2").twists * [[0], [0], [0], [1], [1], [1]], 3, axis=0)}},
        ("it is revolute instead of prismatic", "it is prismatic instead of revolute"),
    ),
}


@SIDES
@pytest.mark.parametrize(("changes", "words"), SCREWS.values(), ids=SCREWS)
def test_wrong_screws(changes: dict[str, Any], words: tuple[str, str], side: int) -> None:
    """The file is read well, and what is made of it is not. ``side`` is the place of the wrong engine."""
    engines = [ps.Pinocchio(ROBOT), ps.Pinocchio(ROBOT)]
    engines[side] = ps.PoE(with_motions(**changes))
    report = run((engines[0], engines[1]))
    (joint,) = changes
    end = f"in {engines[1].name}, compared with {engines[0].name}"
    assert {"screw axes"} | JACOBIANS <= failed(report)
    assert "structure" not in failed(report)
    assert report.diagnosis == (f"joint {joint!r}: {words[side]} {end}",)
    assert (report.blamed, report.files) == ((joint,), (ROBOT.description.file,))


def test_coordinates_exchanged() -> None:
    one, two = ({"q": motion(joint).q, "v": motion(joint).v} for joint in ("j1", "j2"))
    report = run((ps.Pinocchio(ROBOT), ps.PoE(with_motions(j1=two, j2=one))))
    assert failed(report) == MOVED
    assert report.diagnosis == (
        "joint 'j1': it is moved by j2 instead of j1 in PoE, compared with Pinocchio",
        "joint 'j2': it is moved by j1 instead of j2 in PoE, compared with Pinocchio",
    )
