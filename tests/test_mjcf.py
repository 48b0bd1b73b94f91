"""MJCF as descriptions, against MuJoCo's own kinematics, closed forms and hand-written URDF."""

from __future__ import annotations

import math
import pickle
import subprocess
import sys
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pinscrew as ps
from command_line import ok, refusal, run
from pinscrew.description import expand
from pinscrew.ground.errors import EngineError, MissingExtraError, PinscrewWarning
from pinscrew.verification.run import check_names
from pinscrew.witnesses.mjcf import MuJoCoFile

mujoco = pytest.importorskip("mujoco")

RICH = """<?xml version="1.0"?>
<!-- <robot> -->
<mujoco model="rich">
  <compiler angle="degree" eulerseq="zyx" meshdir="/nowhere" autolimits="true"/>
  <option timestep="0.001"/>
  <asset><mesh name="m" file="not_there.stl"/><texture name="t" type="2d" file="/nor/this.png"/></asset>
  <default>
    <geom type="mesh" mesh="m"/><joint damping="1" range="-90 45"/><site rgba="1 0 0 1"/>
    <default class="across"><joint axis="0 1 0"/><motor gear="3"/></default>
  </default>
  <worldbody>
    <light pos="0 0 1"/>
    <frame pos="0 0 1" euler="0 0 20">
      <body name="arm" pos="0.5 0.2 0.1" euler="10 20 30" childclass="across">
        <geom/>
        <joint name="j1" pos="0.1 0 0.2" ref="10"/>
        <joint name="j2" pos="0.3 0.2 0" ref="-5" axis="1 2 0" actuatorfrcrange="-3 2"/>
        <site name="arm" pos="0.1 0 0" zaxis="1 1 0"/>
        <replicate count="2" euler="0 0 90">
          <body name="finger" pos="0.2 0 0"><joint name="slide" type="slide" limited="false" ref="0.1"/></body>
        </replicate>
        <body pos="0 0 0.1"><joint pos="0 0 0.1" limited="false"/><body name="held"><joint name="h"/></body></body>
      </body>
    </frame>
    <body name="drone" pos="1 2 3" quat="1 1 0 0"><freejoint/><site name="rotor" pos="0.1 0 0"/></body>
  </worldbody>
  <equality>
    <joint joint1="j2" joint2="j1" polycoef="0.3 -2 0 0 0" solref="0.01 1"/>
    <joint joint1="h" polycoef="0.2 0 0 0 0"/>
    <joint joint1="slide0" joint2="j1" active="false"/>
  </equality>
  <actuator><motor joint="j1"/></actuator>
  <keyframe><key qpos="0"/></keyframe>
</mujoco>
"""


@pytest.fixture(autouse=True)
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let MuJoCo compile here, which takes a hundredth of what a child does."""
    from pinscrew.description import _mjcf_worker

    whole = expand.ask

    def ask(worker: Path, asked: dict[str, Any], *rest: Any) -> dict[str, Any]:
        return _mjcf_worker.answered(asked["text"]) if "mjcf" in worker.name else whole(worker, asked, *rest)

    monkeypatch.setattr(expand, "ask", ask)


def written(folder: Path, text: str, name: str = "robot.xml") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def body(inside: str, after: str = "") -> str:
    return f'<mujoco>\n<worldbody><body name="a">\n{inside}</body></worldbody>{after}</mujoco>'


def test_every_body_and_site_is_where_mujoco_has_it(tmp_path: Path) -> None:
    robot = ps.load(written(tmp_path, RICH))
    report = ps.verify(robot, 20)
    assert report.ok, str(report)
    assert report.engines == ("PoE", "MuJoCo")
    assert report.largest_difference < 1e-13
    own = {"world", "arm", "arm_site", "finger0", "finger1", "body4", "held", "drone", "rotor"}
    assert set(robot.frame_names) - own == {"j1_frame", "j2_frame", "joint4_frame"}
    assert report.frames == len(robot.frame_names)
    assert robot.joint_names == ("j1", "slide0", "slide1", "joint4", "joint6")
    pin = ps.Pinocchio(robot)  # which reads the URDF that was written
    q = robot.neutral + 0.0
    np.testing.assert_allclose(pin.fk(q, "finger1"), ps.PoE(robot).fk(q, "finger1"), rtol=0, atol=1e-14)
    again = pickle.loads(pickle.dumps(robot))  # noqa: S301 (our own)
    assert again.description.mjcf == robot.description.mjcf


def test_coordinates_are_qpos(tmp_path: Path) -> None:
    """MuJoCo's own data of the original text, without its assets, at its own ``qpos``."""
    path = written(tmp_path, RICH)
    robot = ps.load(path)
    spec = mujoco.MjSpec.from_string(RICH)
    for element in (*spec.geoms, *spec.meshes, *spec.textures):
        spec.delete(element)
    spec.compiler.boundmass = spec.compiler.boundinertia = 1.0
    model = spec.compile()
    data = mujoco.MjData(model)
    turn = np.array([0.5, -0.1, 0.7, 0.5]) / np.linalg.norm([0.5, -0.1, 0.7, 0.5])
    data.qpos[:] = [0.2, 0.0, 0.05, -0.06, 0.7, 0.0, 0.1, 0.2, 0.3, *turn]
    j1, ten, five = 0.2, math.radians(10), math.radians(-5)
    data.qpos[1] = five + 0.3 - 2.0 * (j1 - ten)  # the coupling, as MuJoCo's documentation has it
    data.qpos[5] = 0.2
    mujoco.mj_kinematics(model, data)
    x, y, z = data.qpos[6:9]
    q = np.array([j1, 0.05, -0.06, 0.7, x, y, z, *turn[1:], turn[0]])
    engine = ps.PoE(robot)
    for name in ("arm", "finger0", "finger1", "held", "drone"):
        T = engine.fk(q, name)
        np.testing.assert_allclose(T[:3, 3], data.body(name).xpos, rtol=0, atol=1e-14)
        np.testing.assert_allclose(T[:3, :3].ravel(), data.body(name).xmat, rtol=0, atol=1e-14)
    np.testing.assert_allclose(engine.fk(q, "rotor")[:3, 3], data.site("rotor").xpos, rtol=0, atol=1e-14)
    np.testing.assert_allclose(engine.fk(q, "arm_site")[:3, :3].ravel(), data.site("arm").xmat, rtol=0, atol=1e-14)


def test_what_the_file_says_of_joints(tmp_path: Path) -> None:
    robot = ps.load(written(tmp_path, RICH))
    joints = {joint.name: joint for joint in robot.description.joints}
    assert joints["j1"].limits.lower == -math.pi / 2
    assert joints["j1"].limits.upper == pytest.approx(math.pi / 4, abs=1e-15)
    assert joints["j1"].limits.effort == joints["j1"].limits.velocity == math.inf
    assert joints["j2"].limits.effort == 3.0
    mimic = joints["j2"].mimic
    assert mimic is not None
    assert (mimic.joint, mimic.multiplier) == ("j1", -2.0)
    assert joints["h"].type == "fixed"
    assert joints["joint4"].type == "continuous"
    assert joints["slide0"].limits.upper == math.inf
    assert (joints["j1"].line, joints["slide0"].line) == (16, None)
    assert joints["arm_fixed"].parent == "j2_frame"


def test_a_planar_arm_has_its_closed_form(tmp_path: Path) -> None:
    text = """<mujoco><compiler angle="radian"/><worldbody><body name="one"><joint name="q1" axis="0 0 1"/>
    <body name="two" pos="0.4 0 0"><joint name="q2" axis="0 0 2"/><site name="tip" pos="0.3 0 0"/></body>
    </body></worldbody></mujoco>"""
    robot = ps.load(written(tmp_path, text))
    assert (robot.name, robot.base, robot.tip) == ("robot", "world", "tip")
    a, b = 0.3, -1.1
    for engine in (ps.PoE(robot), MuJoCoFile(robot)):
        x = engine.fk([a, b])[:3, 3]
        expected = [0.4 * math.cos(a) + 0.3 * math.cos(a + b), 0.4 * math.sin(a) + 0.3 * math.sin(a + b), 0.0]
        np.testing.assert_allclose(x, expected, rtol=0, atol=1e-15)


def test_verify_finds_what_is_wrong(tmp_path: Path) -> None:
    """One side's joint moved by a micrometre, its limit by a microradian, and its coupling."""
    robot = ps.load(written(tmp_path, RICH))
    mine = MuJoCoFile(robot)

    def failed(**changes: Any) -> set[str]:
        moved = (replace(j, **changes) if j.name in ("j1", "j2") else j for j in robot.description.joints)
        other = ps.Robot.from_description(replace(robot.description, joints=tuple(moved)))
        report = ps.verify(other, 2, engines=(ps.PoE(other), mine))
        return {check.name for check in report.failed}

    j1 = next(joint for joint in robot.description.joints if joint.name == "j1")
    T = j1.T_parent_joint.copy()
    T[0, 3] += 1e-6
    assert "home poses" in failed(T_parent_joint=T)
    assert "structure" in failed(limits=replace(j1.limits, upper=j1.limits.upper + 1e-6))
    assert "structure" in failed(mimic=None)


def test_includes_are_put_in_place(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    main = '<mujoco><include file="parts/arm.xml"/><worldbody><body><include file="j.xml"/></body>'
    written(tmp_path, '<mujocoinclude>\n<joint name="j"/></mujocoinclude>', "j.xml")
    inner = '<mujoco><include file="deeper.xml"/></mujoco>'
    written(tmp_path / "parts", inner, "arm.xml")
    written(tmp_path / "parts", '<mujoco><worldbody><body name="deep"/></worldbody></mujoco>', "deeper.xml")
    robot = ps.load(written(tmp_path, f"{main}</worldbody></mujoco>"))
    assert robot.frame_names == ("world", "deep", "body2")
    assert (robot.description.joints[-1].line, Path(robot.description.joints[-1].file).name) == (2, "j.xml")


def test_what_is_left_out_is_said(tmp_path: Path) -> None:
    loops = "<equality><connect body1='a' anchor='0 0 0'/></equality>"
    loops += "<tendon><fixed><joint joint='j' coef='1'/></fixed></tendon>"
    path = written(tmp_path, body("<joint name='j'/>", loops))
    with pytest.warns(PinscrewWarning, match="1 connect, 1 tendon"):
        ps.load(path)
    assert refusal("fk", path, "--strict").code == "mjcf-left-out"
    free = written(tmp_path, "<mujoco><worldbody><body><freejoint align='true'/></body></worldbody></mujoco>")
    with pytest.warns(PinscrewWarning, match="inertia"):
        ps.load(free)


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        ('<mujoco><include file="robot.xml"/></mujoco>', "mjcf-include", "takes a file once"),
        ('<mujoco><include file="/etc/passwd"/></mujoco>', "outside", "/etc/passwd"),
        ('<mujoco><include file="none.xml"/></mujoco>', "mjcf-include", "is not there"),
        ("<mujoco><include/></mujoco>", "mjcf-include", "names no file"),
        (f"<mujoco>{'<default>' * 20_000}{'</default>' * 20_000}</mujoco>", "too-large", "deeper than 400"),
        (body('<replicate count="100000000000000"><geom/></replicate>'), "too-large", "10000"),
        (body('<replicate count="200"><replicate count="200"><body/></replicate></replicate>'), "too-large", "10000"),
        (body('<replicate count="many"><body/></replicate>'), "mjcf", ":3: MuJoCo refuses it: bad format"),
        (body("<plugin plugin='x'/>"), "mjcf-unsupported", ":3: <plugin>"),
        (body("<composite/>"), "mjcf-unsupported", "<composite>"),
        (body("<joint axsi='1 0 0'/>"), "mjcf", ":3: MuJoCo refuses it: Schema violation"),
        (body("<joint axis='0 0 0'/>"), "mjcf", ":3: MuJoCo refuses it: axis too small"),
        (body("<joint name='b' type='ball'/>"), "mjcf-unsupported", "joint 'b'"),
        (body("<joint name='universe'/>"), "reserved-name", "universe"),
        (
            body(
                "<joint name='b'/><joint name='c'/>",
                "<equality><joint joint1='b' joint2='c' polycoef='0 1 0 2 0'/></equality>",
            ),
            "mjcf-coupling",
            "joint 'b' to 'c' is not linear: polycoef='0 1 0 2 0'",
        ),
    ],
)
def test_refusals(tmp_path: Path, text: str, code: str, words: str) -> None:
    error = refusal("fk", written(tmp_path, text))
    assert error.code == code
    assert words in str(error)


def test_an_mjcf_has_no_arguments_and_says_what_floats(tmp_path: Path) -> None:
    path = written(tmp_path, body("<joint name='j'/>"))
    assert refusal("fk", path, "l1:=2").code == "xacro-argument"
    assert refusal("fk", path, "--floating-base").code == "mjcf-floating"
    with pytest.raises(EngineError, match="was not read from an MJCF"):
        MuJoCoFile(ps.load("scara"))


def test_without_mujoco(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(MissingExtraError, match="mujoco"):
        ps.load(written(tmp_path, body("")))


def test_commands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    written(tmp_path, body("<joint name='j' range='-10 10'/><site name='tip' pos='0.1 0 0'/>"), "arm.xml")
    assert "PoE and MuJoCo agree" in ok("verify", "arm.xml", "--samples", "2").out
    assert "PoE and Pinocchio differ" in ok("fk", "arm.xml", "-q", "5deg").err
    assert ok("expand", "arm.xml").out.startswith('<robot name="arm">')
    ok("lock", "arm.xml")
    ok("lock", "--check")
    assert run("diff", "arm.xml", "arm.xml").status == 0
    assert len(ok("screws", "arm.xml", "--format", "csv").out.splitlines()) == 2


def test_a_child_compiles_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.undo()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert ps.load(written(tmp_path, RICH)).nq == 11
    assert check_names(0)[:2] == ("structure", "home poses")


@pytest.mark.slow
def test_a_bomb_ends_in_one_line(tmp_path: Path) -> None:
    path = written(tmp_path, "<mujoco><worldbody>" + "<body><joint/></body>" * 4999 + "</worldbody></mujoco>")
    words = [sys.executable, "-m", "pinscrew", "verify", path, "--samples", "1"]
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
