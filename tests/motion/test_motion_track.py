"""The experiment of the velocity kinematics assignment, in Python and on the command line."""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import closed_forms as cf
import pinscrew as ps
import urdfs
from command_line import ok, refused
from pinscrew.ground.errors import InputError, MissingExtraError
from pinscrew.motion import formats
from pinscrew.motion.track import STAGES

Array = npt.NDArray[np.float64]

A8 = cf.AnthropomorphicRRR()
L = {"l1": 1.0, "l2": 0.5, "l3": 0.5}
DIFFERENT = ps.Profile.pieces({"joint1": [("0 <= t <= 2", "0.3")], "joint2": "0.1*t", "joint3": "-0.7 + t"})
"""Rates that differ, so that a wrong column shows."""
COARSE = ("track", "anthropomorphic", "--dt", "0.1")


@pytest.fixture(scope="module")
def arm() -> ps.Robot:
    return ps.load("anthropomorphic_rrr")


@pytest.fixture(scope="module")
def assignment(arm: ps.Robot) -> ps.Track:
    return ps.track(arm)


# ------------------------------------------------------------------------------------------------ in Python


def test_the_rates_come_back(assignment: ps.Track) -> None:
    """At each of the times, by the printed formula, to 1e-10 and in fact to rounding."""
    t = np.arange(1601) / 100
    given = np.array([A8.given_rates(time) for time in t])
    np.testing.assert_array_equal(assignment.trajectory.t, t)
    np.testing.assert_array_equal(assignment.trajectory.qd, given)
    assert abs(assignment.recovered.qd - given).max() < 1e-10
    assert assignment.rate_error < 1e-14


def test_the_angles_are_eulers(assignment: ps.Track) -> None:
    """θ(t) = Σ θ̇ δt, and near the integral by hand: θ1 goes through 1.2, 1.5 and ends at -1.5."""
    t = np.arange(1601) / 100
    rates = np.array([A8.given_rates(time) for time in t])
    q = np.zeros(3)
    for k in range(1600):
        np.testing.assert_allclose(assignment.trajectory.q[k], q, atol=1e-12)
        q = q + rates[k] * 0.01
    np.testing.assert_allclose(assignment.trajectory.q[[500, 600, 1600], 0], [1.2, 1.5, -1.5], atol=0.01)


def test_jacobians_and_twists_are_the_closed_forms(assignment: ps.Track) -> None:
    trajectory = assignment.trajectory
    for k in range(0, 1601, 40):
        J = A8.jacobian_hybrid(trajectory.q[k], L)
        np.testing.assert_allclose(assignment.jacobians[k], J, atol=1e-14)
        np.testing.assert_allclose(trajectory.twists[k], J @ A8.given_rates(k / 100), atol=1e-14)


@pytest.mark.parametrize("method", ["normal", "pinv", "damped"])
def test_methods(arm: ps.Robot, method: str) -> None:
    found = ps.track(arm, DIFFERENT, 0.05, method=method, q0=[0.1, 0.2, 0.3])
    assert found.rate_error < 1e-13
    assert found.method == method


def test_a_printed_mistake_is_seen(arm: ps.Robot) -> None:
    """With θ̇1 ≠ θ̇3, the printed ω_z = θ̇3 and the printed angular rows of column 2 are wrong; ours are right."""
    found = ps.track(arm, DIFFERENT, 0.05, q0=[0.1, 0.2, 0.3])
    twists, rates = found.trajectory.twists, found.trajectory.qd
    np.testing.assert_allclose(twists[:, 5], rates[:, 0], atol=1e-15)
    assert abs(twists[:, 5] - rates[:, 2]).max() > 0.5
    printed = found.jacobians.copy()
    printed[:, 3:5, 1] = 0.0
    wrong = ps.inverse_velocity(printed, twists, "normal")
    assert abs(wrong.qd - rates).max() > 1e-3
    assert wrong.angular_error.max() > 1e-3


def test_functions_and_files(arm: ps.Robot, tmp_path: Path) -> None:
    file = tmp_path / "rates.csv"
    file.write_text("t,joint1,joint3,joint2\n0,0,1,2\n1,1,1,2\n")
    a = ps.track(arm, file, 0.25, "rk4")
    b = ps.track(arm, lambda t: [t, 2.0, 1.0], 0.25, "rk4", duration=1.0)
    np.testing.assert_array_equal(a.trajectory.q, b.trajectory.q)
    held = ps.track(arm, str(file), 0.25, between="hold")
    np.testing.assert_array_equal(held.trajectory.qd[:-1, 0], np.zeros(4))
    assert (a.profile, b.profile) == (str(file), "<lambda>")
    assert repr(b).startswith("<Track along <lambda>: <Trajectory of 'tool'")


def test_stages_are_told(arm: ps.Robot) -> None:
    told: list[str] = []
    ps.track(arm, DIFFERENT, 0.5, advance=told.append)
    assert tuple(told) == STAGES


def test_times(assignment: ps.Track) -> None:
    assert assignment.index(5.0) == 500
    for t in (5.005, -0.01, 16.01, np.nan):
        with pytest.raises(InputError, match="is none of the times; they go from 0 to 16 s"):
            assignment.index(t)


def test_a_singular_jacobian_is_refused_or_damped() -> None:
    """Two joints on one axis can't be told apart: the normal equations say so, and the others share the rate."""
    text = """<robot name="r"><link name="a"/><link name="b"/><link name="tool"/>
    <joint name="j" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
    <joint name="k" type="continuous"><parent link="b"/><child link="tool"/><axis xyz="0 0 1"/></joint></robot>"""
    robot = urdfs.load(text)
    with pytest.raises(InputError, match="J has rank 1 and 2 columns"):
        ps.track(robot, lambda _: [1.0, 0.0], 0.1, duration=1.0)
    found = ps.track(robot, lambda _: [1.0, 0.0], 0.1, duration=1.0, method="pinv")
    np.testing.assert_allclose(found.recovered.qd, 0.5, atol=1e-14)
    assert found.recovered.condition.min() > 1e15
    condition = formats.document(found, 0)["at"]["condition"]
    assert condition is None or condition > 1e15


# --------------------------------------------------------------------------------------- on the command line


def at(*words: str) -> Any:
    return json.loads(ok("track", "anthropomorphic", "--json", *words).out, parse_constant=pytest.fail)


def test_json_is_the_closed_form() -> None:
    document = at("--at", "5", "--scheme", "coursework")
    assert (document["schema"], document["steps"], document["dt"]) == ("pinscrew.track/1", 1600, 0.01)
    here = document["at"]
    q = np.array(list(here["q"].values()))
    rates = A8.given_rates(5.0)
    J = A8.jacobian_hybrid(q, L)
    np.testing.assert_allclose(here["jacobian"]["values"], J, atol=1e-14)
    np.testing.assert_allclose([*here["linear_velocity"], *here["angular_velocity"]], J @ rates, atol=1e-14)
    np.testing.assert_allclose([*here["dx"], *here["dphi"]], J @ rates * 0.01, atol=1e-16)
    np.testing.assert_allclose(list(here["recovered"].values()), rates, atol=1e-13)
    assert list(here["qd"].values()) == rates.tolist()
    A, dx, (x, y, z) = np.array(here["pose"]), np.array(here["dx"]), here["dphi"]
    R = np.array([[1, -z, y], [z, 1, -x], [-y, x, 1]])
    printed = cf.pose(R @ A[:3, :3], R @ A[:3, 3] + dx)
    np.testing.assert_allclose(here["updated_pose"], printed, atol=1e-15)


def test_json_at_the_end() -> None:
    document = at("--at", "16", "--dt", "0.1")
    assert document["at"]["t"] == 16.0
    assert document["at"]["updated_pose"] is None
    assert at("--dt", "0.1")["at"]["t"] == 15.9
    drift = document["drift"]
    assert drift["orthogonality"]["largest"] < 1e-13
    assert 0.0 < drift["position"]["last"] <= drift["position"]["largest"]


def test_words() -> None:
    done = ok(*COARSE, "--at", "5")
    lines = done.out.splitlines()
    assert lines[0] == "anthropomorphic_rrr: tool in base, 160 steps of 0.1 s, scheme exponential"
    rates = [line.split()[1:] for line in lines if line.startswith("joint")]
    assert rates == [["0.50000000"] * 2, ["0.10000000"] * 2, ["0.50000000"] * 2]
    for words in ("at t = 5 s", "linear velocity v (m/s)", "A(5.1 s), the pose after the step:", "at all of the 161"):
        assert words in done.out
    assert done.err == ""


def test_files(tmp_path: Path) -> None:
    table, arrays = tmp_path / "run.csv", tmp_path / "run.npz"
    ok(*COARSE, "--csv", table, "--npz", arrays)
    with table.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 161
    found = np.load(arrays)
    np.testing.assert_array_equal([float(row["t"]) for row in rows], found["t"])
    for column, name in (("qd.joint2", "qd"), ("recovered.joint2", "recovered"), ("q.joint2", "q"), ("vy", "twists")):
        np.testing.assert_array_equal([float(row[column]) for row in rows], found[name][:, 1] + 0.0)
    np.testing.assert_array_equal([float(row["T24"]) for row in rows], found["poses"][:, 1, 3] + 0.0)
    assert found["jacobians"].shape == (161, 6, 3)
    first = (table.read_bytes(), arrays.read_bytes())
    ok(*COARSE, "--csv", table, "--npz", arrays)
    assert (table.read_bytes(), arrays.read_bytes()) == first
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run.csv", "run.npz"]


def test_plot(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    file = tmp_path / "run.svg"
    ok(*COARSE, "--plot", file)
    text = file.read_text(encoding="utf-8")
    words = ("scheme exponential", "given", "recovered", "joint3", "distance from SO(3)", "manipulability", "t (s)")
    assert all(word in text for word in words)


def test_plots_have_the_curves_of_the_run(assignment: ps.Track) -> None:
    pytest.importorskip("matplotlib")
    from pinscrew.view.plot_track import plot_track

    figure = plot_track(assignment)
    assert len(figure.get_axes()) == 6
    for i, axes in enumerate(figure.get_axes()[:3]):
        given, recovered = axes.get_lines()
        np.testing.assert_array_equal(given.get_ydata(), assignment.trajectory.qd[:, i])
        np.testing.assert_array_equal(recovered.get_ydata(), assignment.recovered.qd[:, i])
        assert axes.get_ylabel() == f"joint{i + 1}\n(rad/s)"


def test_plots_of_other_robots() -> None:
    """Units of sliding and floating joints, and many velocities in one panel."""
    pytest.importorskip("matplotlib")
    from pinscrew.view.plot_track import plot_track

    scara = plot_track(ps.track(ps.load("scara"), lambda t: [t, 1, 0.1], 0.1, duration=1.0))
    assert scara.get_axes()[2].get_ylabel() == "joint3\n(m/s)"
    free = ps.load("drone", floating_base=True)
    many = plot_track(ps.track(free, lambda t: np.full(9, t), 0.1, duration=1.0, method="pinv"))
    assert len(many.get_axes()) == 4
    assert len(many.get_axes()[0].get_lines()) == 18


BAD = {
    "profile": (
        ["--profile", "homework"],
        "there is no profile 'homework'; known are: assignment (for anthropomorphic",
    ),
    "file": (["--profile", "none.yaml"], "none.yaml: there is no such file"),
    "dt": (["--dt", "0"], "dt = 0 s; expected a positive time"),
    "dt text": (["--dt", "short"], "Invalid value for --dt: 'short' is not a number"),
    "multiple": (["--dt", "0.3"], "the duration 16 s is no multiple of dt = 0.3 s; use a duration of 15.9 s"),
    "duration": (["--duration", "17"], "there are no rates at t = 16.01 s; the profile is from 0 to 16 s"),
    "at": (["--at", "5.005"], "t = 5.005 s is none of the times"),
    "at text": (["--at", "end"], "Invalid value for --at: 'end' is not a number"),
    "scheme": (["--scheme", "verlet"], "Invalid value for '--scheme': 'verlet' is not one of"),
    "tip": (["--tip", "tol"], "there is no frame 'tol'"),
    "q": (["-q", "1,2"], "Invalid value for -q: 2 values, but anthropomorphic_rrr takes 3"),
    "suffix": (
        ["--plot", "run.gif"],
        "run.gif: a figure can't be written with the suffix '.gif'; use .png, .svg, .pdf",
    ),
    "folder": (["--csv", "none/run.csv"], "none/run.csv: can't be written"),
}


@pytest.mark.parametrize(("words", "message"), BAD.values(), ids=BAD)
def test_bad_words(words: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert message in refused("track", "anthropomorphic", *words)
    assert list(tmp_path.iterdir()) == []


def test_another_robot_needs_a_profile(tmp_path: Path) -> None:
    assert refused("track", "scara").startswith("scara_rrp: there is no profile 'assignment'; known are:")
    file = tmp_path / "rates.yaml"
    file.write_text("rates:\n  joint1: [{when: 0 <= t <= 1, rate: t}]\n  joint2: 0\n")
    words = f"{file}: there are no rates of joint3, which scara_rrp has; give them, if only as 0"
    assert refused("track", "scara", "--profile", file) == words


def test_without_matplotlib(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is said before the work, and nothing is written."""
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    words = 'matplotlib is not installed; install it with: pip install "pinscrew[plot]"'
    assert refused(*COARSE, "--csv", tmp_path / "run.csv", "--plot", tmp_path / "run.png") == words
    assert list(tmp_path.iterdir()) == []
    from pinscrew.view import figures

    with pytest.raises(MissingExtraError):
        figures.figure()
