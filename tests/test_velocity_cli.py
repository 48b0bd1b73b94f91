"""``pinscrew velocity``: twists and point velocities, against the lecture's closed forms and finite differences."""

from __future__ import annotations

import json

import numpy as np
import pytest

import pinscrew as ps
from command_line import ok, refusal, refused, run
from pinscrew.motion import velocities

L0, L1, L2 = 0.2, 0.5, 0.4
"""Of two_joint."""


def asked(*words: str) -> dict[str, object]:
    document: dict[str, object] = json.loads(ok("velocity", *words, "--json").out)
    assert document["schema"] == "pinscrew.velocity/1"
    return document


@pytest.mark.parametrize(
    ("q", "base"),
    [("0,0", lambda a, b: [-(L1 + L2) * a - L2 * b, 0, 0]), ("pi/2,0", lambda a, b: [0, -(L1 + L2) * a - L2 * b, 0])],
)
def test_the_tip_of_the_lecture(q: str, base: object) -> None:
    found = asked("two_joint", "-q", q, "--qd", "0.7,-0.3")
    assert callable(base)
    np.testing.assert_allclose(found["point_velocity"]["base"], base(0.7, -0.3), atol=1e-12)  # type: ignore[index]


def test_the_tip_in_its_own_frame() -> None:
    """At θ2 = π/2 it is [-l2(θ̇1 + θ̇2), l1 θ̇1, 0], whatever θ1 is."""
    for first in ("0", "0.4", "-2"):
        found = asked("two_joint", "-q", f"{first},pi/2", "--qd", "0.7,-0.3")
        expected = [-L2 * (0.7 - 0.3), L1 * 0.7, 0.0]
        np.testing.assert_allclose(found["point_velocity"]["frame"], expected, atol=1e-12)  # type: ignore[index]


def test_twists_of_the_lecture() -> None:
    """J^s has the columns [l0, 0, 0, 0, 0, 1] and [l0 + l1 c1, l1 s1, 0, 0, 0, 1]; J^b and J^h as there."""
    twists = asked("two_joint", "-q", "0.3,0.6", "--qd", "1,2")["twists"]
    expected = [L0 + 2 * (L0 + L1 * np.cos(0.3)), 2 * L1 * np.sin(0.3), 0, 0, 0, 3]
    np.testing.assert_allclose(twists["spatial"], expected, atol=1e-12)  # type: ignore[index]
    expected = [-L1 * np.cos(0.6) - L2 - 2 * L2, L1 * np.sin(0.6), 0, 0, 0, 3]
    np.testing.assert_allclose(twists["body"], expected, atol=1e-12)  # type: ignore[index]
    assert list(asked("two_joint", "--qd", "1,2", "--kind", "geometric")["twists"]) == ["hybrid"]  # type: ignore[call-overload]


@pytest.mark.parametrize("name", ["spherical", "stanford", "lead_screw", "drone"])
def test_a_point_against_finite_differences(name: str) -> None:
    robot = ps.load(name)
    rng = np.random.default_rng(3)
    q, qd = rng.uniform(-1, 1, robot.nq), rng.uniform(-1, 1, robot.nv)
    words = [",".join(map(repr, map(float, values))) for values in (q, qd)]
    tip = robot.frame()
    found = asked(name, "-q", f"{words[0]}", "--qd", words[1], "--point", f"0.1,-20cm,0.3@{tip}")
    poe, h, point = ps.PoE(robot), 1e-6, np.array([0.1, -0.2, 0.3, 1.0])
    before, here, after = (poe.fk(q + step * qd, tip) for step in (-h, 0.0, h))
    moving = (after @ point - before @ point)[:3] / (2 * h)
    np.testing.assert_allclose(found["point_in_base"], (here @ point)[:3], atol=1e-12)
    np.testing.assert_allclose(found["point_velocity"]["base"], moving, atol=1e-8)  # type: ignore[index]
    np.testing.assert_allclose(found["point_velocity"]["frame"], here[:3, :3].T @ moving, atol=1e-8)  # type: ignore[index]


def test_for_people() -> None:
    lines = ok("velocity", "two_joint", "-q", "pi/2,0", "--qd", "1,1", "--point", "0,0,0@A").out.splitlines()
    assert lines[0] == "twists of A in base (v, ω), m/s and rad/s"
    assert [line.split()[0] for line in lines[2:5]] == ["spatial", "body", "hybrid"]
    assert lines[2].split()[1:] == ["0.200000", "0.000000", "0.000000", "0.000000", "0.000000", "1.000000"]
    assert "the point 0, 0, 0 of A" in lines[6]
    assert "its origin" in ok("velocity", "two_joint", "--qd", "joint2=1").out


def test_a_wrong_engine_is_status_1(monkeypatch: pytest.MonkeyPatch) -> None:
    right = velocities.frame_velocity

    def wrong(engine: ps.PoE | ps.Pinocchio, *arguments: object) -> velocities.FrameVelocity:
        found = right(engine, *arguments)  # type: ignore[arg-type]
        found.point_velocity[1] += 1e-9 * (engine.name == "PoE")
        return found

    monkeypatch.setattr(velocities, "frame_velocity", wrong)
    done = run("velocity", "two_joint", "--qd", "1,1")
    assert done.status == 1
    assert "differ by" in done.err


@pytest.mark.parametrize("where", ["point_base", "point_velocity", "point_velocity_body", "linear", "angular"])
def test_each_difference_is_seen(where: str) -> None:
    robot = ps.load("drone")
    found, other = (velocities.frame_velocity(ps.PoE(robot), [0.1, 0.2, 0.3], [1, 1, 1]) for _ in range(2))
    assert velocities.difference(found, other, 2.0) == 0.0
    if where in ("linear", "angular"):
        other.twists["hybrid"][4 * (where == "angular")] += 0.5
    else:
        getattr(other, where)[0] += 0.5
    assert velocities.difference(found, other, 2.0) == pytest.approx(0.5 if where == "angular" else 0.25)
    other.point_velocity[0] = np.nan
    assert velocities.difference(found, other, 2.0) == np.inf


def test_what_is_refused() -> None:
    assert "2 values" in refused("velocity", "scara", "--qd", "1,2")
    assert "is not x,y,z" in refused("velocity", "two_joint", "--qd", "1,2", "--point", "1,2")
    assert "names no frame" in refused("velocity", "two_joint", "--qd", "1,2", "--point", "1,2,3@")
    assert "but --tip is" in refused("velocity", "two_joint", "--qd", "1,2", "--point", "1,2,3@A", "--tip", "B")
    assert "an angle" in refused("velocity", "two_joint", "--qd", "1,2", "--point", "1,2,3deg")
    assert refusal("velocity", "two_joint", "--qd", "1,2", "--point", "1,2,3@hand").code == "unknown-frame"
    assert refusal("velocity", "two_joint", "--qd", "elbow=1").code == "unknown-velocity"
