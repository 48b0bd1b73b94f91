"""Other libraries as witnesses: they agree with our engines, and where one of them is wrong it is shown and named."""

from __future__ import annotations

import json
import pickle
import re
import sys
import warnings
from functools import cache
from pathlib import Path
from typing import Any, Final
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import pinscrew as ps
import urdfs
from broken import ROBOT, TEXT, Altered, edited
from command_line import ok, refused, run
from layering import MODULES, imports, kinematics_used, reachable
from pinscrew.description import catalogue
from pinscrew.engines import hybrid
from pinscrew.engines.base import Engine
from pinscrew.engines.plain import plain_urdf
from pinscrew.ground.errors import EngineError, MissingExtraError, PinscrewWarning, UnknownNameError, UnsupportedError
from pinscrew.ground.typing import KINDS
from pinscrew.verification.report import Report
from pinscrew.witnesses import witness

BOTH: Final = ("mujoco", "roboticstoolbox")
NAMES: Final = [entry.name for entry in catalogue.bundled()]
GEARED: Final = {"gear_pair", "bevel_pair", "lead_screw"}
FEW: Final = ("--samples", "2")
load: Final = cache(ps.load)


@pytest.fixture
def mujoco() -> Any:
    return pytest.importorskip("mujoco")


@pytest.fixture
def rtb() -> Any:
    return pytest.importorskip("roboticstoolbox")


@pytest.fixture(params=BOTH)
def name(request: pytest.FixtureRequest) -> str:
    """The name of each witness that is installed."""
    pytest.importorskip(request.param)
    return str(request.param)


def compare(name: str, robot: ps.Robot, samples: int = 3, seen: ps.Robot | None = None) -> Report:
    """The PoE engine against a witness, which may be shown another robot."""
    return ps.verify(robot, samples, engines=(ps.PoE(robot), ps.witness(name, seen or robot)))


def assert_agree(report: Report) -> None:
    assert report.ok, str(report)
    assert report.largest_difference < 1e-13


def failed(report: Report) -> set[str]:
    return {check.name for check in report.failed}


# ---------------------------------------------------------------------------------------------- agreement


@pytest.mark.parametrize("robot", NAMES)
def test_assignment_arms(name: str, robot: str) -> None:
    report = compare(name, load(robot), samples=10)
    if name == "roboticstoolbox" and robot in GEARED:
        assert not report.ok
    else:
        assert_agree(report)


@pytest.mark.usefixtures("mujoco")
@pytest.mark.parametrize("floating_base", [False, True])
@pytest.mark.parametrize("small", sorted(set(urdfs.ROBOTS) - {"floating_middle"}))
def test_mujoco_agrees_on_small_robots(small: str, floating_base: bool) -> None:
    """Trees, mimics in chains, planar joints, and a base that floats."""
    assert_agree(compare("mujoco", urdfs.load(urdfs.ROBOTS[small], floating_base=floating_base)))


@pytest.mark.usefixtures("mujoco")
def test_mujoco_takes_floating_joints_at_the_top() -> None:
    """Below a root called ``world``, whose joint has an origin that MuJoCo keeps in its coordinates."""
    free = urdfs.joint("free", "floating", "world", "body", xyz="1 2 3", rpy="0.1 0.2 0.3")
    arm = urdfs.joint("arm", "revolute", "body", "tool", xyz="0.3 0 0", rpy="0.4 0 0", axis="0 0.6 0.8")
    assert_agree(compare("mujoco", urdfs.load(urdfs.robot(free, arm, links="world body tool"))))


@pytest.mark.usefixtures("rtb")
@pytest.mark.parametrize("small", ["single_revolute", "tree", "no_joints", "only_fixed", "same_names"])
def test_roboticstoolbox_agrees_where_it_is_right(small: str) -> None:
    assert_agree(compare("roboticstoolbox", urdfs.load(urdfs.ROBOTS[small])))


def test_the_interface(name: str) -> None:
    """Batches, kinds, velocities and derivatives as Pinocchio has them; the default frame is the tip."""
    robot = ps.load("stanford_rrp")
    engine, pin = ps.witness(name, robot), ps.Pinocchio(robot)
    rng = np.random.default_rng(0)
    q, qd = rng.uniform(-1.0, 1.0, (2, 4, robot.nq)), rng.uniform(-1.0, 1.0, (4, robot.nv))
    near: dict[str, Any] = {"rtol": 0.0, "atol": 1e-14}
    np.testing.assert_allclose(engine.fk(q), pin.fk(q), **near)
    np.testing.assert_allclose(engine.fk(q[0, 0], "link2"), pin.fk(q[0, 0], "link2"), **near)
    for kind in KINDS:
        np.testing.assert_allclose(engine.jacobian(q, None, kind), pin.jacobian(q, None, kind), **near)
        np.testing.assert_allclose(engine.fk_jacobian(q, None, kind)[1], pin.jacobian(q, None, kind), **near)
        np.testing.assert_allclose(engine.velocity(q, qd, None, kind), pin.velocity(q, qd, None, kind), **near)
        rates = [e.jacobian_derivative(q, qd, None, kind) for e in (engine, pin)]
        np.testing.assert_allclose(*rates, **near)
    assert repr(engine) == f"<{engine.name} of 'stanford_rrp'>"


def test_pickling(name: str) -> None:
    robot = ps.load("scara")
    engine = ps.witness(name, robot)
    copy = pickle.loads(pickle.dumps(engine))  # noqa: S301 (our own bytes)
    np.testing.assert_array_equal(copy.fk([0.1, 0.2, 0.3]), engine.fk([0.1, 0.2, 0.3]))


# -------------------------------------------------------------------------- what the libraries get wrong


@pytest.mark.usefixtures("rtb")
@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
def test_roboticstoolbox_turns_skew_axes(kind: str) -> None:
    """It turns such a joint's frame by 1 rad about the axis, where it should turn z onto the axis."""
    arm = urdfs.joint("skew", kind, "base", "tool", axis="0.7071067811865476 0.7071067811865476 0")
    report = compare("roboticstoolbox", urdfs.load(urdfs.robot(arm, links="base tool")))
    assert {"home poses", "screw axes", "forward kinematics", "spatial Jacobian"} <= failed(report)
    against = "in roboticstoolbox, compared with PoE"
    assert report.diagnosis == (
        f"joint 'skew': its frame is turned by 57.2958° (1 rad) about [0.707107, 0.707107, 0] {against}",
        f"joint 'skew': its axis is turned by 90° (1.5708 rad) {against}",
    )


@pytest.mark.usefixtures("mujoco")
def test_mujoco_confirms_the_skew_axis() -> None:
    """A third reader says which of the two is wrong."""
    arm = urdfs.joint("skew", "revolute", "base", "tool", axis="0.7071067811865476 0.7071067811865476 0")
    assert_agree(compare("mujoco", urdfs.load(urdfs.robot(arm, links="base tool"))))


@pytest.mark.usefixtures("rtb")
@pytest.mark.parametrize("robot", sorted(GEARED))
def test_roboticstoolbox_ignores_mimics(robot: str) -> None:
    report = compare("roboticstoolbox", load(robot))
    assert {"structure", "screw axes", "forward kinematics"} <= failed(report)
    (words,) = report.diagnosis
    assert words.startswith("roboticstoolbox treats joint 'joint2' as independent; to PoE it is ")
    assert words.endswith(" times 'joint1' plus 0.0")


@pytest.mark.usefixtures("rtb")
@pytest.mark.parametrize(
    ("small", "joint", "kind"), [("planar", "table", "planar"), ("floating_middle", "free", "floating")]
)
def test_roboticstoolbox_fixes_what_it_cannot_move(small: str, joint: str, kind: str) -> None:
    report = compare("roboticstoolbox", urdfs.load(urdfs.ROBOTS[small]))
    assert f"joint {joint!r}: its type is {kind!r} to PoE, 'fixed' to roboticstoolbox" in report.diagnosis


@pytest.mark.usefixtures("rtb")
def test_roboticstoolbox_limits_continuous_joints() -> None:
    limited = urdfs.joint("j", "revolute", "base", "tool").replace("revolute", "continuous")
    report = compare("roboticstoolbox", urdfs.load(urdfs.robot(limited, links="base tool")))
    assert failed(report) == {"structure"}
    assert report.diagnosis == ("joint 'j': its limits are none to PoE, (-2.0, 2.0) to roboticstoolbox",)


@pytest.mark.usefixtures("mujoco")
def test_mujoco_drops_equal_limits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: Any) -> None:
    """It warns of them, which must not leave its log file behind."""
    monkeypatch.chdir(tmp_path)
    stuck = urdfs.joint("j", "revolute", "base", "tool", limits=(0.0, 0.0))
    with pytest.warns(PinscrewWarning, match="drops the limits of 'j'") as caught:
        report = compare("mujoco", urdfs.load(urdfs.robot(stuck, links="base tool")))
    assert report.ok, "a locked joint is no other mechanism"
    assert [w.message.code for w in caught if isinstance(w.message, PinscrewWarning)] == ["witness-limits"]
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr() == ("", "")


# ------------------------------------------------------------------------------- a wrong witness is caught

AXIS_ALIGNED: Final = (
    ("0 0.6 0.8", "0 0 1"),
    ('<mimic joint="j2" multiplier="0.5" offset="0.25"/>', ""),
)
"""What `broken.TEXT` has that roboticstoolbox gets wrong, made right for it."""


def simple(*changes: tuple[str, str]) -> ps.Robot:
    text = TEXT
    for old, new in AXIS_ALIGNED:
        text = text.replace(old, new)
    return edited(*changes, text=text)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("0.4 0 0", "0.400001 0 0"), "joint 'j2': its origin is moved by [0.001, 0, 0] mm (0.001 mm) in"),
        (("0 1 0", "0 -1 0"), "joint 'j2': its axis is flipped in"),
        (("0 0.4 0", "0 0.400001 0"), "joint 'mount': its frame is turned by 5.72958e-05° (1e-06 rad) about"),
        (('name="j2" type="revolute"', 'name="j2" type="prismatic"'), "joint 'j2': its type is 'revolute' to PoE,"),
        (('<parent link="l4"', '<parent link="l3"'), "joint 'mount': its parent is 'l4' to PoE, 'l3' to"),
    ],
)  # fmt: skip
def test_a_witness_of_another_robot_is_caught(name: str, change: tuple[str, str], words: str) -> None:
    robot = simple()
    assert_agree(compare(name, robot))
    report = compare(name, robot, seen=simple(change))
    assert not report.ok
    assert any(words in line for line in report.diagnosis), str(report)


@pytest.mark.usefixtures("mujoco")
def test_another_gear_is_caught() -> None:
    report = compare("mujoco", ROBOT, seen=edited(('multiplier="0.5"', 'multiplier="0.6"')))
    words = "joint 'j4': its mimic is 0.5 times 'j2' plus 0.25 to PoE, 0.6 times 'j2' plus 0.25 to MuJoCo"
    assert words in report.diagnosis


@pytest.mark.parametrize("part", ["poses", "jacobians", "derivatives"])
def test_a_broken_witness_is_caught(name: str, part: str) -> None:
    """Each part of its answers counts."""

    def alter(answers: Any, frames: Any, _: Any) -> None:
        at = list(frames).index("tool")
        if part == "poses":
            answers.poses[:, at, 0, 3] += 1e-9
        else:
            getattr(answers, part)["body"][:, at, 4, 0] += 1e-9

    robot = simple()
    engines = ps.PoE(robot), Altered(ps.witness(name, robot), alter)
    assert not ps.verify(robot, 1, engines=engines, frames=["tool"]).ok  # type: ignore[arg-type]


def test_derivatives_come_from_the_library(name: str) -> None:
    """Against central differences of its own Jacobians, whose error is h² + ε/h, for h = 1e-5."""
    robot = simple()
    engine = ps.witness(name, robot)
    q, qd = urdfs.sample(robot, 3)
    h = 1e-5
    for kind in KINDS:
        ahead, behind = (engine.jacobian(q + step * qd, "tool", kind) for step in (h, -h))
        rates = engine.jacobian_derivative(q, qd, "tool", kind)
        np.testing.assert_allclose(rates, (ahead - behind) / (2 * h), rtol=0.0, atol=1e-9)


# ------------------------------------------------------------------------------------ what they are given


def test_only_kinematics_are_shown() -> None:
    """Names and joints as written; meshes, masses and other programs' elements are left out."""
    text = TEXT.replace(
        '<link name="l1"/>', '<link name="l1"><visual><geometry><mesh filename="x"/></geometry></visual></link>'
    )
    text = text.replace("</robot>", '<mujoco><compiler angle="degree"/></mujoco><gazebo/></robot>')
    text = text.replace("<axis", '<dynamics damping="1"/><axis', 1)
    shown, plain = (plain_urdf(urdfs.load(each)) for each in (text, TEXT))
    assert ET.tostring(shown) == ET.tostring(plain)
    assert [joint.get("name") for joint in shown.iter("joint")] == ["j1", "j2", "j3", "j4", "mount"]
    joint = ET.tostring(shown.findall("joint")[1]).decode()
    assert re.sub(r' (effort|velocity)="[^"]*"', "", joint) in re.sub(
        r' (effort|velocity)="[^"]*"', "", TEXT.replace('"/>', '" />')
    )


def test_quaternions_are_shown_as_rpy(name: str) -> None:
    """Of URDF 1.2, which neither library reads; limits that are reversed are none."""
    turned = urdfs.joint("j", "revolute", "base", "tool", limits=(1.0, -1.0)).replace(
        'rpy="0 0 0"', 'quat_xyzw="0.6 0 0 0.8"'
    )
    text = urdfs.robot(turned, links="base tool").replace("<robot ", '<robot version="1.2" ')
    with pytest.warns(PinscrewWarning, match="is above its upper limit"):
        robot = urdfs.load(text)
    assert_agree(compare(name, robot))


def test_names_are_names(name: str) -> None:
    """Not paths, not expressions, not English."""
    arm = urdfs.joint("j ${1/0} $(find x)", "revolute", "base/x", "X", axis="0 1 0")
    text = urdfs.robot(arm, links="base/x X").replace('"X"', '"a:ü &amp; ${1/0}"')
    robot = urdfs.load(text)
    assert "a:ü & ${1/0}" in robot.frame_names
    assert_agree(compare(name, robot))


def test_independence() -> None:
    """They use neither our screws nor our other engines, and each library is in its own module."""
    for module in ("engines.hybrid", "witnesses.mujoco", "witnesses.roboticstoolbox"):
        assert kinematics_used(MODULES[module]) == set()
        assert not any(one.target.startswith("pinscrew.lie") for one in imports(MODULES[module]))
        assert not {"pinscrew.engines.poe", "pinscrew.engines.pinocchio", "pinocchio"} & reachable(module)
    assert "mujoco" in reachable("witnesses.mujoco")
    assert "roboticstoolbox" in reachable("witnesses.roboticstoolbox")


# ------------------------------------------------------------------------------------------- refusals


@pytest.mark.usefixtures("mujoco")
def test_mujoco_refuses_floating_joints_in_mid_tree() -> None:
    with pytest.raises(EngineError, match="MuJoCo refuses the file: Error: free joint can only be used") as caught:
        ps.witness("mujoco", urdfs.load(urdfs.floating_middle()))
    assert caught.value.code == "witness-refuses"


@pytest.mark.usefixtures("mujoco")
def test_mujoco_may_say_why_it_refuses_a_file() -> None:
    arm = urdfs.robot(urdfs.joint("j", "revolute", "base", "world"), links="base world")
    with pytest.raises(EngineError, match=r"MuJoCo refuses the file: .*world body"):
        ps.witness("mujoco", urdfs.load(arm))


@pytest.mark.usefixtures("rtb")
def test_roboticstoolbox_has_no_floating_base() -> None:
    with pytest.raises(
        UnsupportedError, match="roboticstoolbox has no floating bases; load it with its base"
    ) as caught:
        ps.witness("roboticstoolbox", urdfs.load(TEXT, floating_base=True))
    assert caught.value.code == "witness-floating"


def test_large_robots_are_refused(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hybrid, "MAX_LINKS", 5)
    with pytest.raises(UnsupportedError, match="6 links are more than the 5 that a witness is asked to take") as caught:
        ps.witness(name, ROBOT)
    assert caught.value.code == "witness-size"


@pytest.mark.usefixtures("rtb")
def test_long_chains_end_in_a_message() -> None:
    with pytest.raises(EngineError, match="roboticstoolbox refuses the file: maximum recursion depth"):
        ps.witness("roboticstoolbox", urdfs.load(urdfs.chain(hybrid.MAX_LINKS - 1)))


def test_unknown_witness() -> None:
    with pytest.raises(UnknownNameError, match="there is no witness 'drake'; known are: mujoco, roboticstoolbox"):
        ps.witness("drake", ROBOT)
    assert "'drake' is not one of 'mujoco', 'roboticstoolbox'" in refused("verify", "drone", "--witness", "drake")


@pytest.mark.parametrize(
    ("which", "title", "extra"), [("mujoco", "MuJoCo", "mujoco"), ("roboticstoolbox", "roboticstoolbox", "rtb")]
)
def test_missing_package(which: str, title: str, extra: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is verified before it is said."""
    monkeypatch.setitem(sys.modules, which, None)
    words = f'{title} is not installed; install it with: pip install "pinscrew[{extra}]"'
    with pytest.raises(MissingExtraError) as caught:
        ps.witness(which, ROBOT)
    assert (str(caught.value), caught.value.extra) == (words, extra)
    assert refused("verify", "drone", "scara", "--witness", which) == words


# --------------------------------------------------------------------------------------- command line


@pytest.mark.usefixtures("mujoco")
def test_verify_one_robot() -> None:
    lines = ok("verify", "gear_pair", *FEW, "--witness", "mujoco", "--witness", "mujoco").out.splitlines()
    outcomes = [line.partition(" on ")[0] for line in lines if line.startswith("gear_pair: ")]
    assert outcomes == ["gear_pair: PoE and Pinocchio agree", "gear_pair: PoE and MuJoCo agree"]


@pytest.mark.usefixtures("mujoco", "rtb")
def test_verify_several_robots(tmp_path: Path) -> None:
    both = ("--witness", "mujoco", "--witness", "roboticstoolbox")
    report = tmp_path / "report.xml"
    done = run("verify", "gear_pair", "scara", *FEW, *both, "--junit", report)
    assert (done.status, done.err) == (1, "")
    lines = done.out.splitlines()
    assert lines[0].split()[:3] == ["robot", "engines", "compared"]
    assert [line.split()[:4] for line in lines[1:7]] == [
        [robot, "DISAGREE" if (robot, other) == ("gear_pair", "roboticstoolbox") else "agree", "PoE,", other]
        for robot in ("gear_pair", "scara_rrp")
        for other in ("Pinocchio", "MuJoCo", "roboticstoolbox")
    ]
    assert any(line.startswith("roboticstoolbox treats joint 'joint2' as independent; ") for line in lines)
    assert lines[-1] == "1 of 2 robots: all engines agree to rounding error on every frame"
    suites = [suite.get("name") for suite in ET.fromstring(report.read_bytes())]  # noqa: S314 (our own)
    assert suites[:3] == ["gear_pair", "gear_pair (PoE and MuJoCo)", "gear_pair (PoE and roboticstoolbox)"]


@pytest.mark.usefixtures("mujoco")
def test_verify_json() -> None:
    document = json.loads(ok("verify", "drone", *FEW, "--witness", "mujoco", "--json").out)
    assert [robot["engines"] for robot in document["robots"]] == [["PoE", "Pinocchio"], ["PoE", "MuJoCo"]]
    assert "mujoco" in document["versions"]
    assert "mujoco" not in json.loads(ok("verify", "drone", *FEW, "--json").out)["versions"]


@pytest.mark.usefixtures("mujoco")
def test_a_witness_that_refuses_is_an_error(tmp_path: Path) -> None:
    """What our engines have to say is said all the same."""
    file = tmp_path / "arm.urdf"
    file.write_text(urdfs.floating_middle())
    done = run("verify", file, *FEW, "--witness", "mujoco")
    assert done.status == 2
    assert done.out.splitlines()[-1].startswith("arm: PoE and Pinocchio agree")
    (line,) = done.err.splitlines()
    assert line.startswith(f"pinscrew: {file}: MuJoCo refuses the file: Error: free joint")
    done = run("verify", tmp_path / "nowhere.urdf", *FEW, "--witness", "mujoco")
    assert (done.status, len(done.err.splitlines())) == (2, 1)


# ------------------------------------------------------------------------------------------ many robots

EQUAL_LIMITS: Final = {"centauro", "double_pendulum", "double_pendulum_simple", "quadruped"}
"""Robots with limits that MuJoCo drops."""


def examples() -> list[catalogue.Entry]:
    try:
        return list(catalogue.example_robots())
    except MissingExtraError:
        return []


@pytest.mark.slow
@pytest.mark.parametrize("entry", examples(), ids=lambda entry: entry.name)
def test_example_robots(entry: catalogue.Entry, name: str) -> None:
    """MuJoCo agrees on all but limits; roboticstoolbox where no joint mimics and no axis is skew."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PinscrewWarning)
        try:
            robot = ps.load(entry.name)
        except ps.PinscrewError:
            pytest.skip("the file is broken")
    report = compare(name, robot)
    joints = robot.description.joints
    moving = [joint for joint in joints if joint.type != "fixed"]
    wrong = any(joint.mimic or np.count_nonzero(joint.axis) > 1 for joint in moving)
    if name == "mujoco" or not wrong:
        assert report.largest_difference < 5e-14
        assert failed(report) <= {"structure"}
        assert all("limits" in line or "more differences" in line for line in report.diagnosis)
        assert name != "mujoco" or report.ok == (entry.name not in EQUAL_LIMITS)
    else:
        assert failed(report) > {"forward kinematics"}


def test_witnesses_are_engines(name: str) -> None:
    engine: Engine = witness.witness(name, ROBOT)
    assert engine.robot is ROBOT
    assert set(engine.joints()) == {joint.name for joint in ROBOT.description.joints}
