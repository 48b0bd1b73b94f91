"""Denavit-Hartenberg tables: the makers' and the textbooks' numbers, both conventions, all bundled arms."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

import pinscrew as ps
from command_line import run
from pinscrew.description.catalogue import bundled
from pinscrew.dh.proof import dh_differences
from pinscrew.dh.table import Convention, dh_table
from pinscrew.ground.errors import InputError
from pinscrew.robot.robot import Robot

PI2 = math.pi / 2

# θ, d, a, α at zero, as printed.
TEXTBOOKS: dict[str, tuple[str | None, str | None, Convention, list[tuple[float, float, float, float]]]] = {
    # The velocity assignment's table.
    "anthropomorphic_rrr": (None, None, "standard", [(PI2, 1, 0, PI2), (PI2, 0, 0.5, 0), (0, 0, 0.5, 0)]),
    # Spong, Hutchinson, Vidyasagar, table 3.5, without the wrist's joint.
    "scara_rrp": (None, None, "standard", [(0, 0, 0.4, 0), (0, 0, 0.3, math.pi), (0, 0, 0, 0)]),
    "planar_rrr": (None, None, "standard", [(0, 0, 0.5, 0), (0, 0, 0.4, 0), (0, 0, 0.3, 0)]),
    # Universal Robots' "Parameters for calculations of kinematics and dynamics".
    "ur5_robot": (
        "tool0",
        "base",
        "standard",
        [
            (0, 0.089159, 0, PI2),
            (0, 0, -0.425, 0),
            (0, 0, -0.39225, 0),
            (0, 0.10915, 0, PI2),
            (0, 0.09465, 0, -PI2),
            (0, 0.0823, 0, 0),
        ],
    ),
    # Franka Emika's documentation, "Denavit-Hartenberg parameters" (Craig's convention).
    "panda": (
        "panda_link8",
        None,
        "modified",
        [
            (0, 0.333, 0, 0),
            (0, 0, 0, -PI2),
            (0, 0.316, 0, PI2),
            (0, 0, 0.0825, PI2),
            (0, 0.384, -0.0825, -PI2),
            (0, 0, 0, PI2),
            (0, 0, 0.088, PI2),
        ],
    ),
}


@pytest.mark.parametrize("name", TEXTBOOKS)
def test_tables_are_the_makers(name: str) -> None:
    tip, base, convention, printed = TEXTBOOKS[name]
    table = dh_table(ps.load(name), tip, base=base, convention=convention)
    rows = [(row.theta, row.d, row.a, row.alpha) for row in table.rows]
    np.testing.assert_allclose(rows, printed, rtol=0, atol=0)
    assert not any(row.beta for row in table.rows)


def test_panda_flange_is_its_tool() -> None:
    T = np.eye(4)
    T[2, 3] = 0.107
    table = dh_table(ps.load("panda"), "panda_link8", convention="modified")
    np.testing.assert_allclose(table.T_n_tool, T, atol=1e-15)
    np.testing.assert_allclose(table.T_base_0, np.eye(4), atol=0)


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("name", [entry.name for entry in bundled()])
def test_each_bundled_arm_is_proved(name: str, convention: Convention) -> None:
    robot = ps.load(name)
    tip = robot.frame_names[-1]
    assert max(dh_differences(dh_table(robot, tip, convention=convention), robot, samples=5).values()) < 1e-13


def arm(folder: Path, angle: float, gap: float = 0.0) -> Robot:
    """Two joints whose axes enclose an angle, and a tool."""
    file = folder / "arm.urdf"
    file.write_text(
        f"""<robot name="arm"><link name="base"/><link name="one"/><link name="two"/><link name="tool"/>
        <joint name="j1" type="continuous"><parent link="base"/><child link="one"/><origin xyz="0.2 0.1 0.3"/>
          <axis xyz="0 0 1"/></joint>
        <joint name="j2" type="continuous"><parent link="one"/><child link="two"/>
          <origin xyz="0.5 {gap} 0.1" rpy="{angle} {angle / 2 if angle < 1 else 0} 0.2"/><axis xyz="0 0 1"/></joint>
        <joint name="j3" type="fixed"><parent link="two"/><child link="tool"/><origin xyz="0.1 0.2 0.3"
          rpy="0.4 0.5 0.6"/></joint></robot>"""
    )
    return ps.load(file)


@pytest.mark.parametrize("angle", [0.0, 1e-13, 1e-7, 5e-4, 2e-3, 0.7, math.pi - 1e-5, math.pi])
@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_nearly_parallel_axes_keep_their_table_small_and_exact(
    tmp_path: Path, angle: float, convention: Convention
) -> None:
    robot = arm(tmp_path, angle, gap=0.25)
    table = dh_table(robot, convention=convention)
    assert max(abs(number) for row in table.rows for number in (row.d, row.a)) < 100.0
    assert max(dh_differences(table, robot, samples=5).values()) < 2e-10  # lengths are whole nanometres within 5e-11
    assert any(row.beta for row in table.rows) == (1e-11 < angle < 1e-3 or 1e-11 < math.pi - angle < 1e-3)


def test_a_wrong_table_is_seen(tmp_path: Path) -> None:
    robot = arm(tmp_path, 0.7)
    table = dh_table(robot)
    table.T_base_0[0, 3] += 1e-6
    assert min(dh_differences(table, robot, samples=2).values()) > 1e-7


def test_base_is_another_frame_fixed_to_the_base() -> None:
    robot = ps.load("planar_2r")
    table = dh_table(robot, "tool", base="frame0")
    assert max(dh_differences(table, robot, samples=5).values()) < 1e-14
    np.testing.assert_allclose(table.fk(np.zeros(2)), np.eye(4), atol=1e-15)


def test_joints_without_rows_are_refused() -> None:
    with pytest.raises(InputError, match="floating joint"):
        dh_table(ps.load("planar_2r", floating_base=True), "tool")
    with pytest.raises(InputError, match="no joint moves 'base'"):
        dh_table(ps.load("scara"), "base")
    with pytest.raises(InputError, match="use 'standard' or 'modified'"):
        dh_table(ps.load("scara"), convention="craig")  # type: ignore[arg-type]


@pytest.mark.parametrize("form", ["table", "csv", "markdown", "latex", "python", "matlab", "json"])
def test_formats(form: str) -> None:
    done = run("dh", "anthropomorphic", "--format", form)
    assert done.status == 0
    assert "differs from PoE by" in done.err
    if form == "json":
        assert [row["a"] for row in json.loads(done.out)["rows"]] == [0.0, 0.5, 0.5]
    if form == "python":
        scope: dict[str, object] = {}
        exec(done.out, scope)  # noqa: S102 (our own output)
        np.testing.assert_array_equal(np.asarray(scope["dh"])[:, 0], [PI2, PI2, 0.0])
    if form == "csv":
        assert done.out.splitlines()[2] == f"joint2,revolute,1.0,{PI2!r},0.0,0.5,0.0,0.0"
    if form in ("table", "markdown"):
        assert "q1 + π/2" in done.out
    if form == "latex":
        assert r"$q_{1} + \pi/2$ & $1$ & $0$ & $\pi/2$" in done.out


def test_errors_are_one_line() -> None:
    done = run("dh", "scara", "--tip", "base")
    assert done.status == 2
    assert done.err.count("\n") == 1
