"""Integration of rates: against closed forms, scipy's tight solutions and Pinocchio; orders, drift, bad inputs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import solve_ivp

import closed_forms as cf
import pinscrew as ps
import urdfs
from pinscrew.ground.errors import InputError, PinscrewError
from pinscrew.motion.schemes import SCHEMES

Array = npt.NDArray[np.float64]

A8 = cf.AnthropomorphicRRR()
L = {"l1": 1.0, "l2": 0.5, "l3": 0.5}
Q0 = np.array([0.3, -0.4, 0.7])
TIGHT = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-14}
TWISTED = ("exponential", "exponential-body")


@pytest.fixture(scope="module")
def arm() -> ps.Robot:
    return ps.load("anthropomorphic_rrr")


def smooth(t: float) -> list[float]:
    """Rates of three joints, all different, without jumps."""
    return [0.4 + 0.3 * np.sin(t), 0.5 * np.cos(2 * t), 0.2 - 0.1 * t]


def smooth_angles(t: float) -> Array:
    """The angles that they lead to from Q0."""
    turned = np.array([0.4 * t + 0.3 * (1 - np.cos(t)), 0.25 * np.sin(2 * t), 0.2 * t - 0.05 * t * t])
    return Q0 + turned


def skew(w: Array) -> Array:
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def pose_difference(a: Array, b: Array) -> tuple[float, float]:
    """Largest difference of rotations, and of positions (m)."""
    return float(abs(a[:3, :3] - b[:3, :3]).max()), float(abs(a[:3, 3] - b[:3, 3]).max())


def order(error: Callable[[float], float], coarse: float = 0.05) -> float:
    """By how many powers of the step an error goes down when the step is halved, twice."""
    return float(np.log2(error(coarse) / error(coarse / 4)) / 2)


# ------------------------------------------------------------------------------------------ truth and order


@pytest.mark.parametrize(("scheme", "expected"), [("euler", 1), ("rk4", 4), *((name, 1) for name in TWISTED)])
def test_orders_against_closed_forms(arm: ps.Robot, scheme: str, expected: int) -> None:
    """The pose at the end of 2 s, against the closed form at the exact angles."""
    truth = A8.fk(smooth_angles(2.0), L)

    def error(dt: float) -> float:
        return max(pose_difference(ps.integrate(arm, Q0, smooth, dt, scheme, duration=2.0).poses[-1], truth))

    assert order(error) == pytest.approx(expected, abs=0.1)
    assert error(0.01) < {1: 2e-2, 4: 1e-9}[expected]


def test_the_coordinates_have_their_order_too(arm: ps.Robot) -> None:
    def error(scheme: str) -> Callable[[float], float]:
        return lambda dt: abs(ps.integrate(arm, Q0, smooth, dt, scheme, duration=2.0).q[-1] - smooth_angles(2.0)).max()

    assert order(error("rk4")) == pytest.approx(4, abs=0.1)
    for scheme in set(SCHEMES) - {"rk4"}:
        assert order(error(scheme)) == pytest.approx(1, abs=0.1)


def test_what_the_coursework_solves(arm: ps.Robot) -> None:
    """Its update converges, with order 1, to R' = ω̂R and p' = v + ω×p: the rotation is right, the position is not."""

    def rate(t: float, y: Array) -> Array:
        twist = A8.jacobian_hybrid(smooth_angles(t), L) @ smooth(t)
        R, p = y[:9].reshape(3, 3), y[9:]
        return np.concatenate([(skew(twist[3:]) @ R).ravel(), twist[:3] + np.cross(twist[3:], p)])

    first = A8.fk(Q0, L)
    solved = solve_ivp(rate, (0.0, 2.0), np.concatenate([first[:3, :3].ravel(), first[:3, 3]]), **TIGHT).y[:, -1]
    limit = cf.pose(solved[:9].reshape(3, 3), solved[9:])
    truth = A8.fk(smooth_angles(2.0), L)
    assert pose_difference(limit, truth)[0] < 1e-11
    assert pose_difference(limit, truth)[1] > 0.1
    for part in (0, 1):
        assert order(
            lambda dt, part=part: pose_difference(
                ps.integrate(arm, Q0, smooth, dt, "coursework", duration=2.0).poses[-1], limit
            )[part],
            0.02,
        ) == pytest.approx(1, abs=0.1)


@pytest.mark.parametrize("name", ["planar", "floating_middle"])
def test_order_of_free_joints(name: str) -> None:
    """Planar and floating joints: T' = T V̂ᵇ(t), solved by scipy; rk4 has order 4, Euler 1."""
    robot = urdfs.load(getattr(urdfs, name)())
    (motion,) = (m for m in robot.mechanism.motions if m.freedoms > 1)
    q0 = robot.neutral.copy()
    entries = [0, 1, 5] if motion.freedoms == 3 else [0, 1, 2, 3, 4, 5]
    rng = np.random.default_rng(5)
    a, b = rng.uniform(-1, 1, (2, robot.nv))

    def rates(t: float) -> Array:
        return a * np.cos(1.3 * t) + b * np.sin(0.7 * t)

    def rate(t: float, y: Array) -> Array:
        V = np.zeros(6)
        V[entries] = rates(t)[motion.velocities]
        X = np.zeros((4, 4))
        X[:3, :3], X[:3, 3] = skew(V[3:]), V[:3]
        return (y.reshape(4, 4) @ X).ravel()

    solved = solve_ivp(rate, (0.0, 2.0), np.eye(4).ravel(), **TIGHT).y[:, -1].reshape(4, 4)
    child = motion.joint.child

    def error(scheme: str) -> Callable[[float], float]:
        def of(dt: float) -> float:
            q = ps.integrate(robot, q0, rates, dt, scheme, duration=2.0).q[-1]
            above = q0.copy()  # the pose in the joint's own frame: the others back at zero
            above[motion.q : motion.q + motion.freedoms + (motion.freedoms == 6)] = q[
                motion.q : motion.q + motion.freedoms + (motion.freedoms == 6)
            ]
            X = np.linalg.inv(motion.T_base_child) @ ps.Pinocchio(robot).fk(above, child)
            return max(pose_difference(X, solved))

        return of

    assert order(error("rk4"), 0.1) == pytest.approx(4, abs=0.2)
    assert order(error("euler"), 0.02) == pytest.approx(1, abs=0.1)


def test_pinocchio_gives_the_same(arm: ps.Robot) -> None:
    for scheme in SCHEMES:
        ours = ps.integrate(arm, Q0, smooth, 0.01, scheme, steps=200)
        theirs = ps.integrate(arm, Q0, smooth, 0.01, scheme, steps=200, engine=ps.Pinocchio(arm))
        np.testing.assert_allclose(ours.poses, theirs.poses, atol=1e-12)
        np.testing.assert_allclose(ours.twists, theirs.twists, atol=1e-12)


# ---------------------------------------------------------------------------------------------------- exact


@pytest.mark.parametrize("scheme", TWISTED)
@pytest.mark.parametrize("joint", range(3))
def test_exponentials_are_exact_for_constant_twists(arm: ps.Robot, scheme: str, joint: int) -> None:
    """One joint at a constant rate, in steps of a whole radian."""
    run = ps.integrate(arm, Q0, lambda _: np.eye(3)[joint], 1.0, scheme, steps=20)
    truth = np.array([A8.fk(Q0 + t * np.eye(3)[joint], L) for t in run.t])
    np.testing.assert_allclose(run.poses, truth, atol=1e-12)
    assert max(run.drift.position.max(), run.drift.angle.max()) < 1e-12


def test_constant_body_twist_of_a_floating_base() -> None:
    robot = ps.load("drone", floating_base=True)
    twist = np.array([0.3, -0.2, 0.5, 0.4, 0.9, -0.6])
    rates = np.concatenate([twist, np.zeros(3)])
    for scheme in ("euler", "rk4", "exponential-body", "exponential"):
        run = ps.integrate(robot, None, lambda _: rates, 0.25, scheme, steps=8, frame="base")
        np.testing.assert_allclose(run.poses[-1], ps.lie.se3.exp(2.0 * twist), atol=1e-13)


@pytest.mark.parametrize("scheme", TWISTED)
def test_exponentials_stay_rotations(arm: ps.Robot, scheme: str) -> None:
    run = ps.track(arm, scheme=scheme).trajectory
    assert run.steps == 1600
    assert run.drift.orthogonality.max() < 1e-13
    assert abs(run.drift.column_lengths - 1.0).max() < 1e-13
    gram = np.swapaxes(run.poses[:, :3, :3], 1, 2) @ run.poses[:, :3, :3]
    np.testing.assert_array_equal(run.drift.orthogonality, np.sqrt(((gram - np.eye(3)) ** 2).sum(axis=(1, 2))))


# --------------------------------------------------------------------------------------------------- drift


def test_coursework_stretches_columns_as_it_must() -> None:
    """About a fixed axis, I + [δφ]× makes what is across it longer by √(1 + δφ²) a step, and turns by atan δφ."""
    robot = ps.load("one_joint")
    run = ps.integrate(robot, None, lambda _: [2.0], 0.05, "coursework", steps=100)
    k = np.arange(101)
    grown = (1.0 + 0.1**2) ** (k / 2)
    np.testing.assert_allclose(run.drift.column_lengths, np.stack([grown, grown, np.ones(101)], axis=1), rtol=1e-13)
    np.testing.assert_allclose(run.drift.orthogonality, np.sqrt(2) * (grown**2 - 1), rtol=1e-12, atol=1e-15)
    behind = k * (0.1 - np.arctan(0.1))
    np.testing.assert_allclose(run.drift.angle, behind, atol=1e-13)


def test_coursework_step_is_the_printed_one(arm: ps.Robot) -> None:
    """The errata's entries of T(dx) R(δφ) A, for a step δ of joint 1."""
    step = 0.03
    run = ps.integrate(arm, Q0, lambda _: [1.0, 0.0, 0.0], step, "coursework", steps=1)
    c1, s1 = np.cos(Q0[0]), np.sin(Q0[0])
    u = 0.5 * np.sin(Q0[1]) + 0.5 * np.sin(Q0[1] + Q0[2])
    assert run.poses[1, 0, 3] == pytest.approx(u * s1 + 2 * u * c1 * step, abs=1e-15)
    assert run.poses[1, 0, 2] == pytest.approx(c1 - s1 * step, abs=1e-15)
    assert run.drift.position[1] > 0.9 * abs(u) * step


def test_coursework_on_its_own_profile(arm: ps.Robot) -> None:
    """How far the printed update drifts. It never shortens a column: the printed 0.94 has another cause."""
    run = ps.track(arm, scheme="coursework").trajectory
    assert (np.diff(run.drift.column_lengths, axis=0) >= -1e-15).all()
    np.testing.assert_allclose(run.drift.column_lengths[-1], [1.0185, 1.0185, 1.0112], atol=5e-5)
    assert run.drift.position.max() == pytest.approx(3.70, abs=0.005)
    assert run.drift.angle.max() < 0.01


@pytest.mark.parametrize("scheme", ["euler", "rk4"])
def test_coordinate_schemes_do_not_drift(arm: ps.Robot, scheme: str) -> None:
    run = ps.integrate(arm, Q0, smooth, 0.01, scheme, steps=50)
    assert run.drift.position.max() == 0.0
    assert run.drift.angle.max() < 2e-15
    np.testing.assert_allclose(run.poses, [A8.fk(q, L) for q in run.q], atol=1e-14)


def test_a_wrong_pose_is_seen(arm: ps.Robot) -> None:
    run = ps.integrate(arm, Q0, smooth, 0.01, "euler", steps=5)
    wrong = run.poses.copy()
    wrong[3] = wrong[3] @ ps.lie.se3.exp([0.003, 0.004, 0, 0, 0, 0.02])
    drift = type(run.drift).of(wrong, run.poses)
    assert drift.angle[3] == pytest.approx(0.02, abs=1e-14)
    assert drift.position[3] == pytest.approx(0.005, rel=1e-3)
    assert drift.orthogonality.max() < 1e-14


# ------------------------------------------------------------------------------------------------- answers


def test_answers(arm: ps.Robot) -> None:
    run = ps.integrate(arm, Q0, smooth, 0.1, steps=3, start=1.0)
    np.testing.assert_allclose(run.t, [1.0, 1.1, 1.2, 1.3], atol=1e-15)
    np.testing.assert_array_equal(run.qd, [smooth(t) for t in run.t])
    np.testing.assert_allclose(
        run.twists, [A8.jacobian_hybrid(q, L) @ qd for q, qd in zip(run.q, run.qd, strict=True)], atol=1e-15
    )
    np.testing.assert_array_equal(run.increments, run.twists * 0.1)
    assert (run.frame, run.scheme, run.dt, run.steps, run.robot) == ("tool", "exponential", 0.1, 3, arm)
    assert "exponential, 3 steps, 1 to 1.3 s" in repr(run)
    assert ps.integrate(arm, Q0, smooth, 0.1, steps=3, frame="base").drift.position.max() == 0.0


@pytest.mark.parametrize("how", [{"steps": 3}, {"duration": 0.3}])
def test_times_are_the_decimals_that_were_written(arm: ps.Robot, how: dict[str, Any]) -> None:
    """3 * 0.1 is not 0.3; a profile that ends at 0.3 must not be missed."""
    rates = ps.Profile.pieces({"joint1": [("0 <= t <= 0.3", 1)], "joint2": 0, "joint3": "2*t"})
    run = ps.integrate(arm, None, rates, 0.1, **how)
    assert run.t.tolist() == [0.0, 0.1, 0.2, 0.3]
    np.testing.assert_array_equal(run.qd, [[1, 0, 2 * t] for t in run.t])


def test_stages_are_told(arm: ps.Robot) -> None:
    told: list[str] = []
    ps.integrate(arm, None, smooth, 0.1, steps=2, advance=told.append)
    assert told == ["coordinates", "poses"]


# ---------------------------------------------------------------------------------------------- bad inputs


def wrong(**changes: Any) -> dict[str, Any]:
    return {"q0": Q0, "qd": smooth, "dt": 0.1, "steps": 10, **changes}


HALF = ps.Profile.pieces({"joint1": [("0 <= t <= 1", "t")], "joint2": 0, "joint3": 0})
BAD: dict[str, tuple[dict[str, Any], str, str]] = {
    "dt zero": (wrong(dt=0.0), "dt", "dt = 0 s; expected a positive time"),
    "dt negative": (wrong(dt=-0.1), "dt", "dt = -0.1 s"),
    "dt NaN": (wrong(dt=np.nan), "not-finite", "dt is nan"),
    "dt infinite": (wrong(dt=np.inf), "not-finite", "dt is inf"),
    "dt text": (wrong(dt="short"), "not-finite", "dt is 'short'"),
    "steps zero": (wrong(steps=0), "steps", "steps=0; give a whole number, 1 or more"),
    "steps half": (wrong(steps=1.5), "steps", "steps=1.5"),
    "steps many": (wrong(steps=10**9), "steps", "at most 1000000"),
    "steps and duration": (wrong(duration=1.0), "duration", "both steps and a duration"),
    "neither": (wrong(steps=None), "duration", "neither steps nor a duration"),
    "no multiple": (
        wrong(steps=None, duration=1.05),
        "duration",
        "1.05 s is no multiple of dt = 0.1 s; use a duration",
    ),
    "negative": (wrong(steps=None, duration=-1.0), "duration", "-1 s is no multiple"),
    "NaN long": (wrong(steps=None, duration=np.nan), "not-finite", "duration is nan"),
    "too short": (wrong(steps=None, duration=1e-3), "duration", "is no multiple"),
    "too fine": (wrong(steps=None, duration=1.0, dt=1e-12), "steps", "1e+12 steps"),
    "start": (wrong(start=np.inf), "not-finite", "start is inf"),
    "far start": (wrong(start=1e20), "dt", "vanishes beside the time 1e+20 s"),
    "scheme": (wrong(scheme="verlet"), "scheme", "no scheme 'verlet'; use coursework, euler, rk4"),
    "q0 long": (wrong(q0=[0.0] * 4), "shape", "q has shape (4,)"),
    "q0 batch": (wrong(q0=np.zeros((2, 3))), "shape", "q0 has shape (2, 3); expected (3,)"),
    "q0 NaN": (wrong(q0=[0.0, np.nan, 0.0]), "not-finite", "q holds nan"),
    "rates long": (wrong(qd=lambda _: [0.0] * 4), "shape", "at t = 0 s have shape (4,); expected (3,): joint1"),
    "rates NaN": (wrong(qd=lambda t: [0.0, 0.0, np.nan if t > 0.5 else 0.0]), "not-finite", "at t = 0.6 s hold NaN"),
    "rates text": (wrong(qd=lambda _: "abc"), "not-numbers", "what the rates are at t = 0 s is no array of numbers"),
    "rates list": (wrong(qd=[0.0, 0.0, 0.0]), "profile-format", "give a Profile or a function of the time"),
    "frame": (wrong(frame="tol"), "unknown-frame", "no frame 'tol'"),
    "beyond a profile": (
        wrong(qd=HALF, steps=11),
        "profile-range",
        "no rates at t = 1.1 s; the profile is from 0 to 1",
    ),
    "before a profile": (wrong(qd=HALF, start=-0.5, steps=2), "profile-range", "no rates at t = -0.5 s"),
    "overflow": (
        wrong(qd=lambda _: [1e200, 0.0, 0.0], dt=1.0, scheme="coursework"),
        "overflow",
        "the pose overflows at t = 2 s; use smaller rates",
    ),
}


@pytest.mark.parametrize(("given", "code", "words"), BAD.values(), ids=BAD)
def test_bad_inputs(arm: ps.Robot, given: dict[str, Any], code: str, words: str) -> None:
    with pytest.raises(PinscrewError) as caught:
        ps.integrate(arm, **given)
    assert caught.value.code == code
    assert words in str(caught.value)


def test_a_bad_quaternion_is_refused() -> None:
    robot = ps.load("drone", floating_base=True)
    with pytest.raises(InputError, match=r"has norm 0\.5"):
        ps.integrate(robot, [0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0], lambda _: np.zeros(9), 0.1, steps=1)
