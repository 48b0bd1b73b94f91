"""The arms of the coursework: both engines and the robots themselves against its closed forms.

The closed forms are in closed_forms.py, the checks in assignment_checks.py.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from math import cos, sin
from typing import Any

import numpy as np
import pytest

import assignment_checks as ac
import closed_forms as cf
import pinscrew as ps
from assignment_checks import Case, cases, load, make, motions
from pinscrew.lie import se3

ENGINES = (ps.PoE, ps.Pinocchio)


@pytest.mark.parametrize("check", [ac.check_zero, ac.check_poses, ac.check_jacobians])
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("arm", cf.ARMS, ids=lambda arm: type(arm).__name__)
def test_arm(arm: cf.Arm, engine: Any, check: Callable[[Case], None]) -> None:
    for case in cases(arm, engine):
        check(case)


@pytest.mark.parametrize("arm", cf.ARMS, ids=lambda arm: type(arm).__name__)
def test_defaults(arm: cf.Arm) -> None:
    """The table's default arguments, by leaving them out."""
    defaults = {
        "spherical_rrp": {"L0": 0.5, "L3": 0.8},
        "scara_rrp": {"l1": 0.4, "l2": 0.3},
        "stanford_rrp": {"l1": 0.6, "l2": 0.2},
        "planar_rrr": {"l1": 0.5, "l2": 0.4, "l3": 0.3},
        "anthropomorphic_rrr": {"l1": 1, "l2": 0.5, "l3": 0.5},
        "one_joint": {"l1": 0.5, "l2": 0.7},
        "two_joint": {"l0": 0.2, "l1": 0.5, "l2": 0.4},
        "gear_pair": {"N1": 20, "N2": 60},
        "bevel_pair": {"N1": 20, "N2": 60},
        "lead_screw": {"lead": 0.005},
    }
    robot = load(arm.robot, ())
    ac.check_zero(Case(arm, make(ps.PoE, robot), defaults.get(arm.robot, {}), *motions(arm.joints)))
    assert robot.base == "base"
    assert robot.tip == "tool"
    assert robot.joint_names == tuple(f"joint{i + 1}" for i in range(arm.joints))


@pytest.mark.parametrize("engine", ENGINES)
def test_planar_2r_workspace(engine: Any) -> None:
    """Part f: the two choices of frame 0 mark the same 1036 points."""
    base, tip = cf.Planar2RBase(), cf.Planar2RTip()
    robot = load("planar_2r", ())
    grid = base.workspace_grid()
    assert grid.shape == (1036, 2)
    np.testing.assert_allclose(robot.limits, base.limits, atol=1e-15, rtol=0)
    np.testing.assert_allclose([grid.min(axis=0), grid.max(axis=0)], robot.limits.T, atol=1e-15, rtol=0)

    xi = robot.screws("tool", reference="frame0")
    in_frame0 = se3.exp(grid[:, :1] * xi[:, 0]) @ se3.exp(grid[:, 1:] * xi[:, 1])
    carried = robot.home("frame0") @ in_frame0 @ robot.home("tool", reference="frame0")
    found = make(engine, robot).fk(grid)
    assert np.abs(found - carried).max() <= 1e-12
    assert np.abs(found - [base.fk(q, {}) for q in grid]).max() <= 1e-12
    assert np.abs(carried - [tip.base_from_frame0() @ tip.fk(q, {}) for q in grid]).max() <= 1e-12


OWN: list[tuple[cf.Arm, Callable[[Case], None]]] = [
    (cf.SphericalRRP(), ac.check_a1),
    (cf.Planar2RBase(), ac.check_screw_parameters),
    (cf.Planar2RTip(), ac.check_screw_parameters),
    (cf.ScaraRRP(), ac.check_links),
    (cf.StanfordRRP(), ac.check_links),
    (cf.PlanarRRR(), ac.check_links),
    (cf.Drone(), ac.check_obstacle),
    (cf.AnthropomorphicRRR(), ac.check_a8),
    (cf.OneJoint(), ac.check_a9),
    (cf.TwoJoint(), ac.check_a10),
    (cf.TwoJoint(), ac.check_a10_points),
    (cf.GearPair(), ac.check_gears),
    (cf.BevelPair(), ac.check_gears),
    (cf.LeadScrew(), ac.check_lead_screw),
]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("arm", "check"), OWN, ids=lambda x: getattr(x, "__name__", type(x).__name__))
def test_own(arm: cf.Arm, check: Callable[[Case], None], engine: Any) -> None:
    for case in cases(arm, engine):
        check(case)


# ----------------------------------------------------------------------- a check must be seen to fail: errata


def printed(arm: Any, form: str, change: Callable[..., None]) -> Any:
    """The arm with one closed form as printed: ``change`` alters the right value in place."""
    wrong = copy.copy(arm)
    right = getattr(arm, form)

    def changed(*args: Any) -> Any:
        value = copy.deepcopy(right(*args))
        change(value, *args)
        return value

    setattr(wrong, form, changed)
    return wrong


def entry(at: Any, value: Callable[..., Any]) -> Callable[..., None]:
    """One entry, or several, as a function of the right value and of what the form takes."""

    def change(right: Any, *args: Any) -> None:
        right[at] = value(right[at], *args)

    return change


def negate(at: Any) -> Callable[..., None]:
    return entry(at, lambda x, *_: -x)


SPHERICAL, BASE, TIP, A8 = (
    cf.SphericalRRP(),
    cf.Planar2RBase(),
    cf.Planar2RTip(),
    cf.AnthropomorphicRRR(),
)
LOWER, UPPER = slice(3, None), slice(0, 3)

ERRATA: dict[str, tuple[Any, str, Callable[..., None], Callable[[Case], None], str]] = {
    "A1 e 4,4": (SPHERICAL, "pose_rate", entry((3, 3), lambda *_: 1.0), ac.check_a1, "part e"),
    "A1 f 2,1": (SPHERICAL, "inverse", negate((1, 0)), ac.check_a1, "part f"),
    "A1 f 3,1": (SPHERICAL, "inverse", negate((2, 0)), ac.check_a1, "part f"),
    "A1 g 1,2": (SPHERICAL, "body_velocity_hat", negate((0, 1)), ac.check_a1, "part g"),
    "A1 g 3,2": (SPHERICAL, "body_velocity_hat", negate((2, 1)), ac.check_a1, "part g"),
    "A1 h": (
        SPHERICAL,
        "pose_rate",
        entry((1, 3), lambda x, q, qd, _: x - 2 * cos(q[0]) * cos(q[1]) * qd[2]),
        ac.check_a1,
        "part e",
    ),
    "A1 i": (
        SPHERICAL,
        "jacobian_body",
        entry((5, 0), lambda _, q, __: cos(q[0]) * sin(q[1])),
        ac.check_a1,
        "part i",
    ),
    "A1 k": (
        SPHERICAL,
        "hybrid_velocity",
        entry(2, lambda x, q, qd, _: x + (sin(q[1]) - sin(q[0])) * qd[2]),
        ac.check_a1,
        "part k",
    ),
    "A2 base, twist 1": (BASE, "twists", negate((UPPER, 0)), ac.check_zero, "twists"),
    "A2 base, twist 2": (BASE, "twists", negate((UPPER, 1)), ac.check_zero, "twists"),
    "A2 tip, twist 1": (TIP, "twists", negate((UPPER, 0)), ac.check_zero, "twists"),
    "A2 home": (BASE, "home", entry((2, 2), lambda *_: 1.0), ac.check_zero, r"g\(0\)"),
    "A2 frame 0 in the base": (TIP, "fk", negate(slice(0, 2)), ac.check_poses, "g: off"),
    "A3 sign of axis 3": (cf.ScaraRRP(), "jacobian_hybrid", negate((2, 2)), ac.check_jacobians, "Jacobian"),
    "A4 second rotation": (
        cf.StanfordRRP(),
        "link_transforms",
        lambda links, q, _: links[1].__setitem__((UPPER, UPPER), cf.Rx(q[1])),
        ac.check_links,
        "link 2",
    ),
    "A5 column 1": (
        cf.PlanarRRR(),
        "jacobian_hybrid",
        entry((slice(0, 2), 0), lambda x, *_: [x[1], 0]),
        ac.check_jacobians,
        "Jacobian",
    ),
    "A5 column 2": (cf.PlanarRRR(), "jacobian_hybrid", negate((0, 1)), ac.check_jacobians, "Jacobian"),
    "A6 roll": (cf.Drone(), "obstacle", negate(1), ac.check_obstacle, "obstacle"),
    "A8 J(3,2)": (
        A8,
        "jacobian_hybrid",
        entry((2, 1), lambda _, q, L: -L["l2"] * sin(q[1]) - L["l3"] * sin(q[1] - q[2])),
        ac.check_jacobians,
        "hybrid",
    ),
    "A8 column 2": (A8, "jacobian_hybrid", entry((LOWER, 1), lambda *_: 0), ac.check_jacobians, "hybrid"),
    "A8 ω_z": (A8, "jacobian_hybrid", entry(5, lambda *_: [0, 0, 1]), ac.check_jacobians, "hybrid"),
    "A10 V^b(2,4)": (
        cf.TwoJoint(),
        "body_velocities",
        lambda V, q, qd, L: V["WC"].__setitem__(1, -L["l1"] * sin(q[1]) * qd[0]),
        ac.check_a10,
        r"V_WC\^b",
    ),
    "A10 last point": (
        cf.TwoJoint(),
        "tip_velocity_in_tip",
        negate(1),
        ac.check_a10_points,
        "tip, in C",
    ),
    "A10 ξ2†": (
        cf.TwoJoint(),
        "jacobian_body",
        lambda J, *_: J.__setitem__((slice(None), 1), J[:, 0]),
        ac.check_jacobians,
        "body",
    ),
}


@pytest.mark.parametrize("name", ERRATA)
def test_erratum_is_caught(name: str) -> None:
    arm, form, change, check, words = ERRATA[name]
    for case in cases(printed(arm, form, change), ps.PoE):
        with pytest.raises(AssertionError, match=words):
            check(case)


def test_wrong_pitch_and_ratio_are_caught() -> None:
    """One lead per radian; gears that turn the same way; a pitch over ‖ω‖ instead of ‖ω‖²."""
    screw, gears = copy.copy(cf.LeadScrew()), copy.copy(cf.GearPair())
    screw.pitch = lambda L: L["lead"]  # type: ignore[method-assign]
    gears.ratio = lambda L: L["N1"] / L["N2"]  # type: ignore[method-assign]
    for wrong, check, words in ((screw, ac.check_lead_screw, "pitch"), (gears, ac.check_poses, "g: off")):
        for case in cases(wrong, ps.PoE):
            with pytest.raises(AssertionError, match=words):
                check(case)
    twist = 3.0 * load("lead_screw", ()).screws()[:, 0]
    printed_pitch = twist[:3] @ twist[3:] / np.linalg.norm(twist[3:])
    assert ps.Screw.from_twist(twist).pitch == pytest.approx(printed_pitch / 3.0, rel=1e-15)


def test_nan_is_caught() -> None:
    with pytest.raises(AssertionError, match="off by nan"):
        ac.same(np.full((2, 3), np.nan), np.zeros((2, 3)), "NaN")


def test_shape_is_caught() -> None:
    with pytest.raises(AssertionError, match="shape"):
        ac.same(np.zeros((1, 3)), np.zeros((2, 3)), "shape")
