"""A robot read back from its lock moves as Pinocchio says that the original file does."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pinscrew as ps
import urdfs
from pinscrew import lockfile
from pinscrew.changes.run import diff
from pinscrew.description import catalogue
from pinscrew.ground.errors import MissingExtraError, PinscrewWarning
from pinscrew.lockfile import writing

BUNDLED = [entry.name for entry in catalogue.bundled()]
EXAMPLES = ("panda", "ur5_robot", "talos_reduced", "romeo", "so100", "tiago", "hyq_no_sensors", "allegro_right_hand")
"""Arms, humanoids with mimics, legs, continuous wheels and hands."""


def load(name: str, *, floating_base: bool = False) -> ps.Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PinscrewWarning)
        return ps.load(name, floating_base=floating_base)


def has(name: str) -> bool:
    try:
        return name in {entry.name for entry in catalogue.example_robots()}
    except MissingExtraError:
        return False


def read_back(robot: ps.Robot, folder: Path) -> ps.Robot:
    path = folder / "arm.urdf.lock"
    path.write_text(lockfile.text(robot), encoding="utf-8")
    return lockfile.read(path)


def assert_moves_alike(robot: ps.Robot, folder: Path) -> None:
    """Names and limits are equal; poses and Jacobians are those of Pinocchio to 1e-11, in metres times the size."""
    locked = read_back(robot, folder)
    assert (locked.name, locked.base, locked.default_tip) == (robot.description.name, robot.base, robot.default_tip)
    assert locked.frame_names == robot.frame_names
    assert locked.coordinate_names == robot.coordinate_names
    assert locked.velocity_names == robot.velocity_names
    np.testing.assert_allclose(locked.limits, robot.limits, rtol=1e-11)
    assert [(j.name, j.type, j.parent, j.child) for j in locked.description.joints] == [
        (j.name, j.type, j.parent, j.child) for j in robot.description.joints
    ]
    q, _ = urdfs.sample(robot, 5)
    size = max(1.0, robot.reach)
    poe, pinocchio = ps.PoE(locked), ps.Pinocchio(robot)
    for frame in robot.frame_names[:: max(1, len(robot.frame_names) // 12)] + robot.frame_names[-1:]:
        error = abs(poe.fk(q, frame) - pinocchio.fk(q, frame))
        assert error[..., :3, :3].max() < 1e-11
        assert error[..., :3, 3].max() < 1e-11 * size
        error = abs(poe.jacobian(q, frame, "spatial") - pinocchio.jacobian(q, frame, "spatial"))
        assert error.max(initial=0.0) < 1e-11 * max(size, abs(q[:, :3]).max(initial=0.0))


@pytest.mark.parametrize("name", BUNDLED)
def test_coursework_arms(name: str, tmp_path: Path) -> None:
    assert_moves_alike(load(name), tmp_path)


@pytest.mark.parametrize("name", urdfs.ROBOTS)
@pytest.mark.parametrize("floating_base", [False, True])
def test_small_robots(name: str, floating_base: bool, tmp_path: Path) -> None:
    assert_moves_alike(urdfs.load(urdfs.ROBOTS[name], floating_base=floating_base), tmp_path)


@pytest.mark.parametrize("name", EXAMPLES)
def test_example_robots(name: str, tmp_path: Path) -> None:
    if not has(name):
        pytest.skip("the extra robots is not installed, or has no such robot")
    assert_moves_alike(load(name), tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("floating_base", [False, True])
def test_every_example_robot(floating_base: bool, tmp_path: Path) -> None:
    """Each is read back with its fingerprint, and rounding is no change of it, nor a note."""
    for entry in catalogue.example_robots():
        if entry.name in {"ur3", "alex_psyonic_hands"}:  # no robots: tests/test_corpus.py
            continue
        robot = load(entry.name, floating_base=floating_base)
        locked = read_back(robot, tmp_path)
        assert lockfile.fingerprint(locked) == lockfile.fingerprint(robot)
        found = diff(locked, robot, length=1e-9 * max(1.0, robot.reach), angle=1e-9)
        assert (found.same, found.notes) == (True, ()), entry.name


def test_the_comparison_sees_a_lock_of_another_robot(tmp_path: Path) -> None:
    """A lock that is off in the 10th digit is caught by what the other tests hold."""
    other = urdfs.load(urdfs.rotated().replace("0.1 -0.4 0.2", "0.1000000002 -0.4 0.2"))
    (tmp_path / "arm.urdf.lock").write_text(lockfile.text(other))
    locked, robot = lockfile.read(tmp_path / "arm.urdf.lock"), urdfs.load(urdfs.rotated())
    error = abs(ps.PoE(locked).fk(robot.neutral) - ps.Pinocchio(robot).fk(robot.neutral)).max()
    assert error == pytest.approx(2e-10, rel=1e-3)


def test_mimic_offsets_come_back(tmp_path: Path) -> None:
    robot = urdfs.load(urdfs.mimic_chain())
    locked = read_back(robot, tmp_path)
    mimics = [joint.mimic for joint in locked.description.joints]
    assert mimics == [joint.mimic for joint in robot.description.joints]
    for joint, original in zip(locked.description.joints, robot.description.joints, strict=True):
        np.testing.assert_allclose(joint.T_parent_joint, original.T_parent_joint, atol=3e-12)
        np.testing.assert_allclose(joint.axis, original.axis, atol=3e-12)


def test_a_robot_that_was_read_has_no_text(tmp_path: Path) -> None:
    locked = read_back(urdfs.load(urdfs.tree()), tmp_path)
    assert (locked.description.text, locked.description.file) == ("", str(tmp_path / "arm.urdf.lock"))
    with pytest.raises(ps.PinscrewError):
        ps.Pinocchio(locked)


# --------------------------------------------------------------------------------------------- fingerprint


@given(urdfs.trees(), st.booleans())
def test_fingerprints_come_back(text: str, floating_base: bool) -> None:
    """A robot read back has the text, and so the fingerprint, of the original."""
    robot = urdfs.load(text, floating_base=floating_base)
    from pinscrew.lockfile import parsing, reading

    path = Path("small.urdf.lock")
    lock = reading.Lock(path, parsing.parse(lockfile.text(robot), path))
    assert lock.content.hash == lockfile.fingerprint(robot)
    again = lock.robot()
    assert lockfile.fingerprint(again) == lockfile.fingerprint(robot)


def test_what_the_fingerprint_covers() -> None:
    text = urdfs.mimic()
    robot = urdfs.load(text)
    same = [
        text.replace('name="small"', 'name="other"'),
        text.replace("0.4 0 0", "0.40 0.0 -0"),
        text.replace("><", ">\n  <!-- a remark --><"),
        text.replace('axis xyz="0.6 0 0.8"', 'axis xyz="0.6 0 0.80000000000000004"'),
        text.replace("0.4 0 0", "0.40000000000000002 0 1e-17"),
    ]
    assert {lockfile.fingerprint(urdfs.load(one)) for one in same} == {lockfile.fingerprint(robot)}
    other = [
        text.replace('"k"', '"k2"'),
        text.replace('"mid"', '"middle"'),
        text.replace('"revolute"', '"continuous"'),
        text.replace("0.4 0 0", "0.400000000001 0 0"),
        text.replace("-0.75", "-0.750000000001"),
        text.replace("0.3", "0.300000000001"),
        text.replace('upper="2.0"', 'upper="2.00000000001"'),
        text.replace('velocity="1"', 'velocity="2"'),
        text.replace('effort="1"', 'effort="2"'),
    ]
    prints = {lockfile.fingerprint(urdfs.load(one)) for one in other}
    prints |= {lockfile.fingerprint(urdfs.load(text, floating_base=True)), lockfile.fingerprint(robot)}
    assert len(prints) == len(other) + 2


def test_noise_does_not_show() -> None:
    """What is zero but for rounding reads zero: the sine of π, a way there and back."""
    turn = urdfs.robot(
        urdfs.joint("a", "fixed", "base", "l1", xyz="0.1 0.2 0.3", rpy=f"{math.pi} {math.pi / 2} {-math.pi}"),
        urdfs.joint("b", "revolute", "l1", "l2", xyz="0.3 0.2 0.7", rpy=f"0 {-math.pi / 2} 0", axis="0 1 0"),
        urdfs.joint("c", "fixed", "l2", "tool", xyz="-0.1 0 0", rpy="0 0 0"),
        links="base l1 l2 tool",
    )
    text = lockfile.text(urdfs.load(turn))
    assert "e-" not in text
    assert "-0," not in text
    assert "-0]" not in text
    assert not [line for line in text.splitlines() if "99999" in line or "00000" in line]


def test_it_does_not_depend_on_the_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    prints, texts = set(), set()
    for folder in ("a", "b/ü ü"):
        file = tmp_path / folder / "arm.urdf"
        file.parent.mkdir(parents=True)
        file.write_text(urdfs.tree())
        monkeypatch.chdir(file.parent)
        for source in (file, Path("arm.urdf")):
            prints.add(lockfile.fingerprint(ps.load(source)))
            texts.add(lockfile.text(ps.load(source)))
    assert (len(prints), len(texts)) == (1, 1)


def test_it_is_the_same_in_every_process_and_needs_no_pinocchio() -> None:
    code = """
import sys
sys.modules["pinocchio"] = None
import pinscrew as ps
from pinscrew import lockfile
print(lockfile.text(ps.load("spherical_rrp")), end="")
"""
    environment = {**os.environ, "PYTHONHASHSEED": "7"}
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
    assert done.stdout == lockfile.text(ps.load("spherical_rrp"))


# -------------------------------------------------------------------------------------------- odd robots


@pytest.mark.filterwarnings("ignore:.*lengths are in metres")
@pytest.mark.parametrize("scale", [1e-9, 1e-3, 1.0, 1e6, 1e9])
def test_any_size(scale: float, tmp_path: Path) -> None:
    """Twelve digits of the size, whatever it is."""
    lengths = [0.123456789123456, 0.3, 0.7]
    joints = [
        urdfs.joint(f"j{i}", "revolute", f"l{i}", f"l{i + 1}", xyz=f"{a * scale!r} 0 {a * scale / 3!r}", rpy="0 1 0.5")
        for i, a in enumerate(lengths)
    ]
    robot = urdfs.load(urdfs.robot(*joints, links="l0 l1 l2 l3"))
    locked = read_back(robot, tmp_path)
    q = np.array([0.3, -0.4, 0.5])
    error = abs(ps.PoE(locked).fk(q) - ps.PoE(robot).fk(q))
    assert error[:3, :3].max() < 1e-11
    assert error[:3, 3].max() < 1e-11 * scale
    assert lockfile.fingerprint(locked) == lockfile.fingerprint(robot)


def test_names_in_any_script(tmp_path: Path) -> None:
    names = ("基座", 'a&quot;b"', "тело\\", "💪", "l&#10;2")
    escaped = [name.replace('"', "&quot;") for name in names]
    joints = [
        urdfs.joint(f"{{θ{i}}}", "revolute", escaped[i], escaped[i + 1], xyz="0.1 0 0") for i in range(len(names) - 1)
    ]
    links = "".join(f'<link name="{name}"/>' for name in escaped)
    robot = urdfs.load(f'<robot name="ρ">{links}{"".join(joints)}</robot>')
    locked = read_back(robot, tmp_path)
    assert locked.frame_names == robot.frame_names
    assert locked.joint_names == ("{θ0}", "{θ1}", "{θ2}", "{θ3}")
    text = lockfile.text(robot)
    assert "基座" in text
    assert text.isprintable() or set(filter(lambda c: not c.isprintable(), text)) == {"\n"}


def test_axes_come_back(tmp_path: Path) -> None:
    """Of every type of joint, also of those that have no screw."""
    for text in urdfs.ROBOTS.values():
        robot = urdfs.load(text)
        for joint, locked in zip(robot.description.joints, read_back(robot, tmp_path).description.joints, strict=True):
            assert locked.axis == pytest.approx(joint.axis, abs=1e-11), joint.type


@pytest.mark.parametrize(("size", "grid"), [(5.0, 1e-12), (50.0, 1e-11), (1.0, 1e-13), (0.2, 1e-13)])
def test_lengths_are_rounded_13_digits_below_the_size(size: float, grid: float) -> None:
    """Less than half a step of the grid is written as zero, more as a step."""
    for part, written in ((0.4, 0.0), (0.6, 1.0)):
        text = urdfs.robot(
            urdfs.joint("j", "revolute", "base", "tool", xyz=f"{size} {part * grid!r} 0"), links="base tool"
        )
        (joint,) = writing.content(urdfs.load(text)).joints
        assert joint.home[1, 3] == pytest.approx(written * grid, rel=1e-9, abs=0.0)
