"""Velocities of points: against the lecture's closed forms, both engines, and slips."""

from __future__ import annotations

import math

import numpy as np
import pytest
import sympy as sp
from test_derive_cli import run
from test_derive_details import of

import pinscrew as ps
from pinscrew.derivation import proof, read_back, reports
from pinscrew.derivation.asked import ReportQuestion, asked
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.points import at_values, point_section
from pinscrew.ground.errors import UnknownNameError

PARTS = ("pose", "velocity-matrix", "spatial-velocity")


def written(d: Derivation, about: ReportQuestion, form: str = "markdown") -> str:
    return reports.write(reports.report(d, proof.Proof(0, 0, 0, (), None), PARTS, [point_section(d, about)]), form)


def test_the_lectures_points() -> None:
    """(A10) The tip at (0, 0) and (π/2, 0) in W, and at (·, π/2) in C."""
    d = ps.derive(ps.load("two_joint"))
    l1, l2, d1, d2, s2, c2 = sp.symbols("l1 l2 dtheta1 dtheta2 s2 c2")
    up = math.pi / 2
    for at, head, expected in (
        ({"joint1": 0.0, "joint2": 0.0}, r"v_{q_{a}}(0, 0)", [-(l1 + l2) * d1 - l2 * d2, 0]),
        ({"joint1": up, "joint2": 0.0}, r"v_{q_{a}}(\frac{\pi}{2}, 0)", [0, -(l1 + l2) * d1 - l2 * d2]),
        ({"joint2": up}, r"v_{q_{b}}(\cdot, \frac{\pi}{2})", [-l2 * (d1 + d2), l1 * d1]),
        ({"joint1": up}, r"v_{q_{b}}(\frac{\pi}{2}, \cdot)", [-l2 * (d1 + d2) - l1 * c2 * d1, l1 * s2 * d1]),
    ):
        text = written(d, asked(d, (0, 0, 0), at))
        found = of(text, head)
        assert sp.expand(found - sp.Matrix([*expected, 0, 0])) == sp.zeros(4, 1)


@pytest.mark.parametrize(
    ("name", "at", "form"),
    [
        ("spherical_rrp", {"joint2": 0.7, "joint3": 0.25}, "html"),
        ("anthropomorphic_rrr", {"joint2": math.pi / 6}, "latex"),
        ("lead_screw", {}, "notebook"),
    ],
)
def test_read_back_and_both_engines(name: str, at: dict[str, float], form: str) -> None:
    d = ps.derive(ps.load(name))
    about = asked(d, (0.1, -0.2, 0.3), at)
    found = read_back.read_back(d, written(d, about, form), form, asked=about)
    assert found.alone == 0
    assert found.largest < 1e-11
    # The velocity of the point by finite differences of the engines' poses.
    robot = d.robot
    q = np.array([at.get(joint, 0.4) for joint in robot.joint_names])
    qd = np.linspace(0.5, 1.1, robot.nv)
    section = {s: float(v) for s, v in d.lengths.items()}
    section |= {v.symbol: x for v, x in zip(d.variables, q, strict=False)}
    for engine in (ps.PoE(robot), ps.Pinocchio(robot)):
        place = [engine.fk(q + h * qd, d.tip) @ [0.1, -0.2, 0.3, 1.0] for h in (1e-6, -1e-6)]
        difference = (place[0] - place[1]) / 2e-6
        exact = at_values(d, d.pose_rate * sp.Matrix([*about.point, 1]), about)  # type: ignore[misc]
        rates = {v.rate: x for v, x in zip(d.coordinates, qd, strict=True)}
        value = d.in_coordinates(exact).subs({**section, **rates})
        np.testing.assert_allclose(np.array(value, dtype=float)[:, 0], difference, atol=1e-8)


@pytest.mark.parametrize(
    ("head", "old", "new"),
    [
        ("q_{b}", r"\tfrac{3}{10}", r"\tfrac{3}{11}"),
        ("q_{a}", "s_{1}", "c_{1}"),
        (r"v_{q_{a}} &", r"\dot{\theta}_{1}", r"\theta_{1}"),
        (r"v_{q_{b}} ", "c_{2}", "s_{2}"),
        (r"v_{q_{a}}(", r"\frac{\pi}{2}", r"\frac{\pi}{3}"),
        (r"v_{q_{a}}(", r"l_{2} s_{2}", r"l_{1} s_{2}"),
        (r"v_{q_{b}}(", r"s_{2}", r"-s_{2}"),
        (r"v_{q_{b}}(", r", \cdot)", ")"),
    ],
)
def test_a_slip_is_seen(head: str, old: str, new: str) -> None:
    d = ps.derive(ps.load("two_joint"))
    about = asked(d, (0, 0, 0.3), {"joint1": math.pi / 2})
    lines = written(d, about).splitlines()
    at = next(i for i, x in enumerate(lines) if x.removeprefix(r"\begin{aligned} ").startswith(head))
    assert old in lines[at]
    lines[at] = lines[at].replace(old, new, 1)
    with pytest.raises(read_back.ReadBackError):
        read_back.read_back(d, "\n".join(lines), "markdown", asked=about)


def test_command() -> None:
    done = run("two_joint", "--point", "0,0,30cm@tool", "--at", "joint1=90deg", "--samples", "2")
    assert done.exit_code == 0
    assert "Velocity of a point" in done.stdout
    assert r"(\frac{\pi}{2}, \cdot)" in done.stdout
    assert "(i) " not in done.stdout
    assert "(i) " in run("two_joint", "--point", "0,0,0", "--part", "i", "--samples", "2").stdout
    assert "give --point too" in run("two_joint", "--at", "joint1=1").output
    assert "has no place for --point" in run("two_joint", "--point", "0,0,0", "--code", "c").output
    assert "is not x,y,z" in run("two_joint", "--point", "0,0").output
    with pytest.raises(UnknownNameError, match="joint9"):
        asked(ps.derive(ps.load("two_joint")), (0, 0, 0), {"joint9": 1.0})
