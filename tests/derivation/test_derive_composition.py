"""Velocities through a frame: V_AC = V_AB + Ad V_BC, against the lecture, both engines, and slips."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
from test_derive_cli import run
from test_derive_details import of

import pinscrew as ps
from pinscrew.derivation import proof, read_back, reports
from pinscrew.derivation.asked import ReportQuestion
from pinscrew.derivation.composition import composition_section
from pinscrew.derivation.run import derive

BRANCHES = """<robot name="branches">
  <link name="base"/><link name="stem"/><link name="side"/><link name="tool"/>
  <joint name="j0" type="revolute"><parent link="base"/><child link="stem"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j1" type="revolute"><parent link="stem"/><child link="side"/><origin xyz="0.3 0 0.1"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j2" type="prismatic"><parent link="stem"/><child link="tool"/><origin xyz="0 0.2 0"/><axis xyz="1 0 0"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j3" type="revolute"><parent link="side"/><child link="finger"/><axis xyz="0 0 1"/>
    <mimic joint="j2" multiplier="2"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <link name="finger"/>
</robot>"""


def three(robot: Any, a: str, b: str, c: str, **options: Any) -> tuple[Any, Any, Any, ReportQuestion]:
    whole = derive(robot, c, reference=a, also=(b,), **options)
    first = derive(robot, b, reference=a, also=(c,), **options)
    second = derive(robot, c, reference=b, also=(a,), **options)
    return whole, first, second, ReportQuestion(frames={"A": a, "B": b, "C": c})


@cache
def lecture() -> tuple[Any, Any, Any, ReportQuestion]:
    return three(ps.load("two_joint"), "base", "A", "tool")


def written(whole: Any, first: Any, second: Any, form: str = "markdown") -> str:
    section = composition_section(whole, (first, second))
    return reports.write(reports.report(whole, proof.Proof(0, 0, 0, (), None), ("pose",), [section]), form)


def test_the_lectures_joints() -> None:
    """(A10) With B for the first joint's link: V^s of joint 1, and that of joint 2 as joint 1 has moved it."""
    *legs, _ = lecture()
    text = written(*legs)
    l0, l1, l2, c1, s1, c2, s2, d1, d2 = sp.symbols("l0 l1 l2 c1 s1 c2 s2 dtheta1 dtheta2")
    expected = {
        "V^{s}_{AB}": [l0 * d1, 0, d1],
        "V^{s}_{BC}": [l1 * d2, 0, d2],
        "V^{s}_{AC}": [l0 * d1 + (l0 + l1 * c1) * d2, l1 * s1 * d2, d1 + d2],
        "V^{b}_{BC}": [-l2 * d2, 0, d2],
        "V^{b}_{AC}": [-l2 * (d1 + d2) - l1 * c2 * d1, l1 * s2 * d1, d1 + d2],
    }
    for head, (x, y, turn) in expected.items():
        assert sp.expand(of(text, head) - sp.Matrix([x, y, 0, 0, 0, turn])) == sp.zeros(6, 1), head


@pytest.mark.parametrize("frames", [("base", "side", "tool"), ("tool", "base", "finger"), ("side", "tool", "finger")])
@pytest.mark.parametrize(("convention", "form"), [("mls", "html"), ("lynch-park", "latex")])
def test_any_three_frames(frames: tuple[str, str, str], convention: str, form: str, tmp_path: Path) -> None:
    """Also where the frame between is on another branch, with joints that the others know nothing of."""
    file = tmp_path / "branches.urdf"
    file.write_text(BRANCHES)
    whole, first, second, about = three(ps.load(file, tip="tool"), *frames, convention=convention)
    assert [v.symbol for v in whole.variables] == [v.symbol for v in first.variables]
    found = read_back.read_back(whole, written(whole, first, second, form), form, asked=about)
    assert found.alone == 0
    assert found.largest < 1e-11
    assert first.prove(3).ok
    assert second.prove(3).ok


def test_the_choice_of_frame_0_carried_to_the_base() -> None:
    """(A2, e) The tip's choice, carried to the base, is the same pose."""
    *legs, about = three(ps.load("planar_2r"), "base", "frame0", "tool")
    text = written(*legs)
    s12, c12, c1, s1 = sp.symbols("s12 c12 c1 s1")
    pose = [[0, 0, 1, -1], [s12, c12, 0, c1 + s12], [-c12, s12, 0, 1 + s1 - c12], [0, 0, 0, 1]]
    assert sp.expand(of(text, "g_{AC}") - sp.Matrix(pose)) == sp.zeros(4, 4)
    assert read_back.read_back(legs[0], text, "markdown", asked=about).alone == 0


def test_the_sum_is_what_both_engines_say() -> None:
    robot = ps.load("anthropomorphic_rrr")
    whole, first, second, _ = three(robot, "base", "link2", "tool")
    q, qd = np.array([0.3, -0.7, 0.9]), np.array([0.5, 1.1, -0.4])
    values = {s: float(v) for s, v in whole.lengths.items()}
    values |= {v.symbol: x for v, x in zip(whole.variables, q, strict=True)}
    values |= {v.rate: x for v, x in zip(whole.variables, qd, strict=True)}

    def number(d: Any, matrix: Any) -> Any:
        return np.array(d.explicit(matrix).subs(values), dtype=float)

    adjoint = ps.lie.se3.adjoint(number(first, first.pose))
    total = number(first, first.spatial_velocity) + adjoint @ number(second, second.spatial_velocity)
    for engine in (ps.PoE(robot), ps.Pinocchio(robot)):
        np.testing.assert_allclose(total[:, 0], engine.jacobian(q, "tool", "spatial") @ qd, atol=1e-14)


@pytest.mark.parametrize(
    ("head", "old", "new"),
    [
        ("g_{AB}", "l_{0}", "l_{1}"),
        ("g_{AC}", "s_{2}", "c_{2}"),
        ("V^{s}_{AB}", r"l_{0} \dot", r"l_{1} \dot"),
        ("V^{s}_{BC}", r"\dot{\theta}_{2}", r"\dot{\theta}_{1}"),
        ("V^{s}_{AC}", "s_{1}", "c_{1}"),
        ("V^{b}_{AC}", "c_{2}", "s_{2}"),
        ("V^{b}_{AC}", r"V^{b}_{AB} + V^{b}_{BC}", r"V^{b}_{AB} - V^{b}_{BC}"),
        ("V^{s}_{AC}", r"\mathrm{Ad}_{g_{AB}}", r"\mathrm{Ad}_{g_{BC}}"),
    ],
)
def test_a_slip_is_seen(head: str, old: str, new: str) -> None:
    whole, first, second, about = lecture()
    lines = written(whole, first, second).splitlines()
    at = next(i for i, x in enumerate(lines) if x.removeprefix(r"\begin{aligned} ").startswith(head))
    assert old in lines[at]
    lines[at] = lines[at].replace(old, new, 1)
    with pytest.raises(read_back.ReadBackError):
        read_back.read_back(whole, "\n".join(lines), "markdown", asked=about)


def test_command() -> None:
    done = run("two_joint", "--via", "A", "--samples", "2")
    assert done.exit_code == 0
    assert "Composition of velocities" in done.stdout
    assert "A is `base`, B is `A`, C is `tool`" in done.stdout
    assert run("two_joint", "--via", "nowhere").exit_code != 0
