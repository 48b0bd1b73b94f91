"""Checks of an engine and of its robot against the closed forms of the coursework.

Each takes the arm to believe, so that a test can also hand it one with an erratum as printed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import closed_forms as cf
import pinscrew as ps
from pinscrew.ground.typing import KINDS, FloatArray
from pinscrew.lie import se3

TOLERANCE = 1e-13
"""Times max(1, size) of a configuration's matrix: 450 ε for some 30 roundings, and angles up to 40 rad."""


@dataclass(frozen=True)
class Case:
    """An engine's robot with lengths L, and a batch of motions; ``arm`` is what they should be."""

    arm: Any
    engine: Any
    L: cf.Lengths
    q: FloatArray
    qd: FloatArray

    @property
    def robot(self) -> ps.Robot:
        return self.engine.robot

    def fk(self, frame: str | None = None) -> FloatArray:
        return self.engine.fk(self.q, frame)

    def velocity(self, kind: Any, frame: str | None = None) -> FloatArray:
        return self.engine.velocity(self.q, self.qd, frame, kind)

    def still(self, form: Callable[..., Any]) -> FloatArray:
        """A closed form of (q, L) over the batch."""
        return np.array([form(q, self.L) for q in self.q])

    def moving(self, form: Callable[..., Any]) -> FloatArray:
        """A closed form of (q, qd, L) over the batch."""
        return np.array([form(q, qd, self.L) for q, qd in zip(self.q, self.qd, strict=True)])


def same(actual: FloatArray, expected: Any, what: str) -> None:
    """Batches of equal shape, each configuration right to TOLERANCE of its own size."""
    expected = np.asarray(expected)
    assert actual.shape == expected.shape, what
    axes = tuple(range(1, expected.ndim))
    size = np.maximum(1.0, np.abs(expected).max(axis=axes))
    worst = (np.abs(actual - expected).max(axis=axes) / size).max()
    assert worst <= TOLERANCE, f"{what}: off by {worst:.2g} of its size"


def same_one(actual: FloatArray, expected: Any, what: str) -> None:
    same(actual[None], np.asarray(expected)[None], what)


@cache
def load(name: str, lengths: tuple[tuple[str, float], ...]) -> ps.Robot:
    return ps.load(name, **dict(lengths))


@cache
def make(engine: Any, robot: ps.Robot) -> Any:
    return engine(robot)


def lengths_of(arm: cf.Arm) -> list[cf.Lengths]:
    """Two sets of arguments: random, apart by a factor of up to 40."""
    rng = np.random.default_rng(len(arm.robot))

    def draw(name: str) -> float:
        if name in ("N1", "N2"):
            return int(rng.integers(8, 90))
        low, high = (0.001, 0.05) if name == "lead" else (0.05, 2.0)
        return float(rng.uniform(low, high))

    return [{name: draw(name) for name in arm.lengths} for _ in range(2 if arm.lengths else 1)]


def motions(joints: int) -> tuple[FloatArray, FloatArray]:
    """Zero, quarter and half turns, random and large values; and rates."""
    rng = np.random.default_rng(joints)
    quarters = np.pi / 2 * rng.integers(-2, 3, (20, joints))
    q = np.concatenate(
        [
            np.zeros((1, joints)),
            np.full((1, joints), math.pi / 2),
            np.full((1, joints), -math.pi / 2),
            quarters,
            rng.uniform(-math.pi, math.pi, (30, joints)),
            rng.uniform(-40.0, 40.0, (10, joints)),
            rng.uniform(-1e-8, 1e-8, (3, joints)),
        ]
    )
    return q, rng.normal(size=q.shape)


def cases(arm: Any, engine: Any) -> Iterator[Case]:
    for L in lengths_of(arm):
        robot = load(arm.robot, tuple(L.items()))
        yield Case(arm, make(engine, robot), L, *motions(arm.joints))


def hat(xi: FloatArray) -> FloatArray:
    """ξ̂ of a batch of twists, written here to owe nothing to pinscrew."""
    v, w = xi[..., :3], xi[..., 3:]
    X = np.zeros((*xi.shape[:-1], 4, 4))
    X[..., 2, 1], X[..., 0, 2], X[..., 1, 0] = w[..., 0], w[..., 1], w[..., 2]
    X[..., :3, :3] -= np.swapaxes(X[..., :3, :3], -1, -2).copy()
    X[..., :3, 3] = v
    return X


def Ad(g: FloatArray) -> FloatArray:
    R, p = g[..., :3, :3], g[..., :3, 3]
    X = np.zeros((*g.shape[:-2], 6, 6))
    X[..., :3, :3] = X[..., 3:, 3:] = R
    X[..., :3, 3:] = hat(np.concatenate([p, p], axis=-1))[..., :3, :3] @ R
    return X


def times(A: FloatArray, x: FloatArray) -> FloatArray:
    return (A @ x[..., None])[..., 0]


# -------------------------------------------------------------------------------------------------- every arm


def check_zero(case: Case) -> None:
    """g(0) and the twists, from the robot's description alone."""
    reference = {} if case.arm.reference == "base" else {"reference": case.arm.reference}
    g0, xi = case.arm.home(case.L), case.arm.twists(case.L)
    same_one(case.robot.home("tool", **reference), g0, "g(0)")
    same_one(case.robot.screws("tool", **reference), xi, "twists")
    same_one(case.robot.screws("tool", at="body"), Ad(np.linalg.inv(g0)) @ xi, "body twists")


def check_poses(case: Case) -> None:
    carried = case.robot.home(case.arm.reference)
    same(case.fk(), carried @ case.still(case.arm.fk), "g")


def check_jacobians(case: Case) -> None:
    """All three kinds: those printed as they are, the others through the closed form of g."""
    arm = case.arm
    g = case.still(arm.fk)
    turned = g.copy()
    turned[:, :3, 3] = 0.0
    if arm.jacobian_body(case.q[0], case.L) is not None:
        body = case.still(arm.jacobian_body)
    elif arm.jacobian_hybrid(case.q[0], case.L) is not None:
        body = np.linalg.solve(Ad(turned), case.still(arm.jacobian_hybrid))
    else:
        body = np.linalg.solve(Ad(g), case.still(lambda q, L: columns_of(arm.twists(L), q)))
    carried = case.robot.home(arm.reference)
    base_turned = (carried @ g).copy()
    base_turned[:, :3, 3] = 0.0
    expected = {"spatial": Ad(carried @ g) @ body, "body": body, "hybrid": Ad(base_turned) @ body}
    for kind, form in zip(KINDS, (arm.jacobian_spatial, arm.jacobian_body, arm.jacobian_hybrid), strict=True):
        if form(case.q[0], case.L) is not None:
            expected[kind] = case.still(form)
    for kind in KINDS:
        same(case.engine.jacobian(case.q, "tool", kind), expected[kind], f"{kind} Jacobian")


def columns_of(xi: FloatArray, q: FloatArray) -> FloatArray:
    """J^s by its definition: column i is Ad(e^{ξ1 θ1} … e^{ξ(i-1) θ(i-1)}) ξi."""
    g, columns = np.eye(4), []
    for twist, angle in zip(xi.T, q, strict=True):
        columns.append(Ad(g) @ twist)
        g = g @ exponential(twist, angle)
    return np.stack(columns, axis=1)


def exponential(xi: FloatArray, angle: float) -> FloatArray:
    """e^{ξθ} of a revolute joint (‖ω‖ = 1, pitch 0) or a prismatic one (ω = 0)."""
    v, w = xi[:3], xi[3:]
    if not w.any():
        return cf.pose(np.eye(3), v * angle)
    R = Rotation.from_rotvec(w * angle).as_matrix()
    return cf.pose(R, (np.eye(3) - R) @ np.cross(w, v))


# ------------------------------------------------------------------------------------------ A1, spherical RRP


def check_a1(case: Case) -> None:
    arm, g = case.arm, case.fk()
    V_s, V_b = case.velocity("spatial"), case.velocity("body")
    J_s, J_b = (case.engine.jacobian(case.q, "tool", kind) for kind in ("spatial", "body"))
    xi = case.robot.screws()
    for i in range(3):
        exponentials = se3.exp(case.q[:, i, None] * xi[:, i])
        same(exponentials, case.still(lambda q, L, i=i: arm.exponentials(q, L)[i]), "part c")
        rate = hat(J_s[:, :, i] * case.qd[:, i, None]) @ g
        same(rate, case.moving(lambda q, qd, L, i=i: arm.pose_rate_terms(q, qd, L)[i]), "part e, terms")
    same(hat(V_s) @ g, case.moving(arm.pose_rate), "part e")
    same(se3.inverse(g), case.still(arm.inverse), "part f")
    same(hat(V_b), case.moving(arm.body_velocity_hat), "part g")
    same(V_b, case.moving(arm.body_velocity), "part h")
    same(J_b, case.still(arm.jacobian_body), "part i")
    same(times(J_b, case.qd), case.moving(arm.body_velocity), "part j")
    same(case.velocity("hybrid"), case.moving(arm.hybrid_velocity), "part k")


# ---------------------------------------------------------------------------------------------- A2, planar 2R


def check_screw_parameters(case: Case) -> None:
    reference = None if case.arm.reference == "base" else case.arm.reference
    xi = case.robot.screws("tool", reference=reference)
    for i, expected in enumerate(case.arm.screw_parameters()):
        for factor in (1.0, 3.0):
            screw = ps.Screw.from_twist(factor * xi[:, i])
            assert screw.pitch == pytest.approx(expected.pitch, abs=1e-15), "pitch"
            assert screw.magnitude == pytest.approx(factor * expected.magnitude, rel=1e-15), "magnitude"
            assert ps.Screw(*expected[:3], factor * expected.magnitude).isclose(screw, 1e-14, 1e-14), "line"


# ----------------------------------------------------------------------------- A3–A5, link transforms; A6, A8


def check_links(case: Case) -> None:
    """Each link's pose in the one before it."""
    frames = ["base", "link1", "link2", "link3", "tool"]
    poses = [case.fk(frame) for frame in frames]
    count = len(case.arm.link_transforms(case.q[0], case.L))
    for i in range(count):
        link = np.linalg.inv(poses[i]) @ poses[i + 1]
        same(link, case.still(lambda q, L, i=i: case.arm.link_transforms(q, L)[i]), f"link {i + 1}")


def check_obstacle(case: Case) -> None:
    same(case.fk("obstacle")[:, :3, 3], case.still(lambda q, _: case.arm.obstacle(q)), "obstacle")
    q, position = case.arm.printed()
    same_one(case.engine.fk(q, "obstacle")[:3, 3], position, "obstacle as printed")


def check_a8(case: Case) -> None:
    """The product of the Denavit–Hartenberg rows, and the velocities of the given profile."""

    def product(q: FloatArray, L: cf.Lengths) -> FloatArray:
        g = np.eye(4)
        for theta, d, a, alpha in case.arm.denavit_hartenberg(q, L):
            turn = cf.pose(cf.Rz(theta), cf.vector(0, 0, d))
            g = g @ turn @ cf.pose(cf.Rx(alpha), cf.vector(a, 0, 0))
        return g

    same(case.fk(), case.still(product), "Denavit–Hartenberg")
    rates = np.array([case.arm.given_rates(t) for t in np.linspace(0.0, 16.0, len(case.q))])
    velocity = case.engine.velocity(case.q, rates, "tool", "LOCAL_WORLD_ALIGNED")
    same(velocity, times(case.still(case.arm.jacobian_hybrid), rates), "given profile")


# ----------------------------------------------------------------------------- A9 and A10, velocities lecture


def check_a9(case: Case) -> None:
    arm, g = case.arm, case.fk()
    V_s, V_b = case.velocity("spatial"), case.velocity("body")
    same(V_s, case.moving(arm.spatial_velocity), "V^s")
    same(V_b, case.moving(arm.body_velocity), "V^b")
    same(times(se3.adjoint(g), V_b), case.moving(arm.spatial_velocity), "Ad V^b")
    same(se3.adjoint(g)[:, :3, 3:], case.still(arm.adjoint_block), "adjoint block")
    in_base, in_tool = times(hat(V_s), g[:, :, 3])[:, :3], hat(V_b)[:, :3, 3]
    same(in_base, case.moving(arm.tool_velocity_in_base), "v_A")
    same(in_tool, case.moving(arm.tool_velocity_in_tool), "v_B")


def check_a10(case: Case) -> None:
    arm = case.arm
    frames = "WABC"
    pose = {"W" + Y: case.fk(arm.links[Y]) for Y in frames}
    V_s = {"W" + Y: case.velocity("spatial", arm.links[Y]) for Y in frames}
    V_b = {"W" + Y: case.velocity("body", arm.links[Y]) for Y in frames}
    for pair in ("AB", "BC", "AC"):  # solved from the compositions of W, X and Y
        X, Y = pair
        pose[pair] = np.linalg.inv(pose["W" + X]) @ pose["W" + Y]
        V_s[pair] = np.linalg.solve(Ad(pose["W" + X]), (V_s["W" + Y] - V_s["W" + X])[..., None])[..., 0]
        V_b[pair] = V_b["W" + Y] - np.linalg.solve(Ad(pose[pair]), V_b["W" + X][..., None])[..., 0]
    for pair in ("WA", "AB", "BC", "WB", "AC", "WC"):
        same(pose[pair], case.still(lambda q, L, pair=pair: arm.poses(q, L)[pair]), f"g_{pair}")
        spatial = case.moving(lambda q, qd, L, pair=pair: arm.spatial_velocities(q, qd, L)[pair])
        body = case.moving(lambda q, qd, L, pair=pair: arm.body_velocities(q, qd, L)[pair])
        same(V_s[pair], spatial, f"V_{pair}^s")
        same(V_b[pair], body, f"V_{pair}^b")
        same(times(Ad(pose[pair]), body), spatial, f"Ad V_{pair}^b")
    same(V_s["AC"], V_s["AB"] + times(Ad(pose["AB"]), V_s["BC"]), "composition of V_AC^s")
    same(V_b["AC"], times(Ad(np.linalg.inv(pose["BC"])), V_b["AB"]) + V_b["BC"], "composition of V_AC^b")


def check_a10_points(case: Case) -> None:
    arm, qd, zero = case.arm, case.qd, np.zeros(len(case.qd))
    straight, turned = np.zeros_like(qd), np.stack([zero + np.pi / 2, zero], axis=1)
    bent = np.stack([case.q[:, 0], zero + np.pi / 2], axis=1)

    def tip(q: FloatArray, kind: str) -> FloatArray:
        return case.engine.velocity(q, qd, "tool", kind)[:, :3]

    same(tip(straight, "hybrid"), [arm.tip_velocity_straight(x, case.L) for x in qd], "tip, straight")
    same(tip(turned, "hybrid"), [arm.tip_velocity_turned(x, case.L) for x in qd], "tip, turned")
    same(tip(bent, "body"), [arm.tip_velocity_in_tip(x, case.L) for x in qd], "tip, in C")


# -------------------------------------------------------------------------------- A11, gears and a lead screw


def check_gears(case: Case) -> None:
    arm, ratio = case.arm, case.arm.ratio(case.L)
    same(case.fk("gear1"), case.still(arm.driver), "driver")
    driver_twist = case.still(lambda *_: arm.driver_twist())
    same(case.engine.jacobian(case.q, "gear1", "spatial"), driver_twist, "driver's twist")
    driver, driven = (ps.Screw.from_twist(case.robot.screws(frame)[:, 0]) for frame in ("gear1", "tool"))
    assert driven.magnitude / driver.magnitude == pytest.approx(case.L["N1"] / case.L["N2"], rel=1e-15)
    assert driver.pitch == driven.pitch == 0.0
    master, multiplier, offset = case.engine.joints()["joint2"].mimic
    assert (master, offset) == ("joint1", 0.0)
    assert multiplier == pytest.approx(ratio, rel=1e-15)


def check_lead_screw(case: Case) -> None:
    same(case.fk("screw"), case.still(lambda q, _: case.arm.handwheel(q)), "handwheel")
    for at, factor in (("space", 1.0), ("body", 1.0), ("space", 3.0)):
        screw = ps.Screw.from_twist(factor * case.robot.screws("tool", at=at)[:, 0])
        assert screw.pitch == pytest.approx(case.arm.pitch(case.L), rel=1e-15), "pitch"
        assert screw.pitch == pytest.approx(case.L["lead"] / (2 * math.pi), rel=1e-15), "pitch"
        assert screw.isclose(ps.Screw.through([0, 0, 0], [0, 0, 1], screw.pitch, factor), 1e-15, 0), "line"
    turn = case.engine.fk(np.array([[2 * math.pi]]))
    same(turn[:, :3, 3], [[0, 0, case.L["lead"]]], "one turn")
