"""Orientations as quaternions, of URDF 1.2: read alike by both engines, and by whatever else reads the file."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import pinscrew as ps
import urdfs
from command_line import run
from pinscrew.description import orientation, visuals
from pinscrew.description.packages import Packages
from pinscrew.ground.errors import PinscrewWarning
from pinscrew.robot.robot import Robot

ANGLES = st.floats(-10.0, 10.0)
NEAR_LOCK = st.sampled_from([math.pi / 2, -math.pi / 2, math.pi / 2 - 1e-9, 0.0, math.pi])


def text(origin: str, version: str = "1.2", inner: str = "") -> str:
    arm = urdfs.joint("j1", "revolute", "base", "mid", axis="0 0.6 0.8", xyz="0.1 0.2 0.3").replace(
        'xyz="0.1 0.2 0.3" rpy="0 0 0"', origin
    )
    mount = urdfs.joint("j2", "prismatic", "mid", "tool", xyz="0 0 0.4")
    found = urdfs.robot(arm, mount, links="base mid tool").replace("<robot ", f'<robot version="{version}" ')
    return found.replace('<link name="mid"/>', f'<link name="mid">{inner}</link>')


def robot(origin: str) -> Robot:
    return urdfs.load(text(origin))


@given(st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.1))
def test_rotations_are_scipys(quaternion: list[float]) -> None:
    R = Rotation.from_quat(quaternion).as_matrix()
    np.testing.assert_allclose(orientation.of_quaternion(quaternion), R, rtol=0, atol=1e-15)
    np.testing.assert_allclose(orientation.of_rpy(*orientation.to_rpy(R)), R, rtol=0, atol=2e-15)


@given(ANGLES, ANGLES | NEAR_LOCK, ANGLES)
def test_rpy_is_scipys_and_comes_back(roll: float, pitch: float, yaw: float) -> None:
    """Fixed axes x, y, z in this order; at a pitch of ±π/2 another roll and yaw are the same rotation."""
    R = orientation.of_rpy(roll, pitch, yaw)
    np.testing.assert_allclose(R, Rotation.from_euler("xyz", [roll, pitch, yaw]).as_matrix(), rtol=0, atol=2e-15)
    back = orientation.to_rpy(R)
    assert abs(back[1]) <= math.pi / 2
    np.testing.assert_allclose(orientation.of_rpy(*back), R, rtol=0, atol=2e-12)


def test_both_engines_read_it() -> None:
    q = Rotation.from_euler("xyz", [0.3, -0.7, 1.9]).as_quat()
    found = robot(f'xyz="0.1 0.2 0.3" quat_xyzw="{" ".join(map(repr, q.tolist()))}"')
    expected = robot('xyz="0.1 0.2 0.3" rpy="0.3 -0.7 1.9"')
    assert ps.verify(found, samples=20).ok
    model = pin.buildModelFromXML(found.description.text)
    np.testing.assert_allclose(model.jointPlacements[1].rotation, found.home("mid")[:3, :3], atol=1e-15)
    np.testing.assert_allclose(found.screws(), expected.screws(), atol=1e-15)
    assert ps.diff(found, expected, length=1e-12, angle=1e-12).same
    assert not ps.diff(found, robot('xyz="0.1 0.2 0.3" rpy="0.3 -0.7 1.9001"')).same


def test_the_derivation_reads_it() -> None:
    turned = robot('xyz="0.1 0.2 0.3" quat_xyzw="0.5 0.5 0.5 0.5"')
    assert ps.derive(turned).prove(samples=3).ok
    assert ps.derive(turned).pose == ps.derive(robot(f'xyz="0.1 0.2 0.3" rpy="{math.pi / 2!r} 0 {math.pi / 2!r}"')).pose


def test_another_length_is_normalised_and_said() -> None:
    with pytest.warns(PinscrewWarning) as caught:
        longer = robot('xyz="0.1 0.2 0.3" quat_xyzw="1 1 1 1"')
    assert [w.message.code for w in caught if isinstance(w.message, PinscrewWarning)] == ["quaternion-normalised"]
    assert ps.diff(longer, robot('xyz="0.1 0.2 0.3" quat_xyzw="0.5 0.5 0.5 0.5"')).same
    assert ps.verify(longer, samples=3).ok


def test_a_dropped_quaternion_is_caught() -> None:
    """A reader that passes over it sees another robot."""
    turned = text('xyz="0.1 0.2 0.3" quat_xyzw="0.5 0.5 0.5 0.5"')
    dropped = urdfs.load(turned.replace(' quat_xyzw="0.5 0.5 0.5 0.5"', ""))
    report = ps.verify(urdfs.load(turned), samples=3, engines=(ps.PoE(urdfs.load(turned)), ps.Pinocchio(dropped)))
    assert not report.ok


def test_looks_are_turned_too(tmp_path: Path) -> None:
    box = '<visual><origin quat_xyzw="0.5 0.5 0.5 0.5"/><geometry><box size="1 2 3"/></geometry></visual>'
    file = tmp_path / "a.urdf"
    file.write_text(text('xyz="0 0 0"', inner=box))
    (found,) = visuals.read(ps.load(file).description, Packages(file)).visuals
    np.testing.assert_allclose(found.T_link_visual[:3, :3], Rotation.from_quat([0.5] * 4).as_matrix(), atol=1e-16)


def test_a_lock_holds_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    turned = text('xyz="0.1 0.2 0.3" quat_xyzw="0.5 0.5 0.5 0.5"')
    file = Path("a.urdf")
    for lower, upper in (("-2.0", "2.0"), ("2.0", "-2.0")):  # reversed limits are none, in the lock too
        limited = turned.replace('lower="-2.0" upper="2.0"', f'lower="{lower}" upper="{upper}"')
        file.write_text(limited)
        assert run("lock", "a.urdf").status == 0
        assert run("lock", "a.urdf", "--check").status == 0
        file.write_text(limited.replace("0.5 0.5 0.5 0.5", "0.5 0.5 0.5 -0.5"))
        assert run("lock", "a.urdf", "--check").status == 1
