"""Determinants factored, and zero where and only where the engines' Jacobians lose rank."""

import numpy as np
import pytest
import sympy as sp

import pinscrew as ps
from pinscrew.derivation.numeric import evaluate

FACTORS = {
    "spherical_rrp": {"c2", "L3 + theta3"},
    "stanford_rrp": {"c2", "theta3"},
    "scara_rrp": {"s2"},
    "anthropomorphic_rrr": {"s3", "l2*s2 + l3*s23"},
}


@pytest.mark.parametrize("robot", FACTORS)
def test_factors_of_the_position_s_determinant(robot: str) -> None:
    d = ps.derive(ps.load(robot))
    measure = d.singularities.measures[-1]
    assert {str(factor) for factor in measure.factors} == FACTORS[robot]


@pytest.mark.parametrize("robot", ["spherical_rrp", "planar_rrr", "anthropomorphic_rrr", "two_joint", "drone"])
def test_gram_determinant_is_the_engines(robot: str) -> None:
    d = ps.derive(ps.load(robot))
    q = np.random.default_rng(0).uniform(-2, 2, (20, len(d.coordinates)))
    lengths = {s: np.full(20, float(v)) for s, v in d.lengths.items()}
    value = sp.Matrix([[d.singularities.measures[0].value]])
    (mine,) = evaluate(d, [value], q, q, lengths)
    for engine in (ps.PoE(d.robot), ps.Pinocchio(d.robot)):
        J = engine.jacobian(q, d.tip, "body")
        assert abs(mine[:, 0, 0] - np.linalg.det(J.transpose(0, 2, 1) @ J)).max() < 1e-11


def test_ur5() -> None:
    """det J = ± a2 a3 s3 s5 (a2 c2 + a3 c23 + d5 s234), as the literature has it."""
    d = ps.derive(ps.load("ur5_robot"), "tool0", symbols=True)
    (measure,) = d.singularities.measures
    assert [str(factor) for factor in measure.factors[:2]] == ["s3", "s5"]
    assert len(measure.factors) == 3
    q = np.random.default_rng(0).uniform(-2, 2, (20, 6))
    lengths = {s: np.full(20, float(v)) for s, v in d.lengths.items()}
    (mine,) = evaluate(d, [sp.Matrix([[measure.value]])], q, q, lengths)
    J = ps.PoE(d.robot).jacobian(q, "tool0", "body")
    assert abs(mine[:, 0, 0] - np.linalg.det(J)).max() < 1e-10


def test_what_is_not_offered_is_said() -> None:
    assert "follow" in ps.derive(ps.load("lead_screw")).singularities.words
    assert "more than six" in ps.derive(ps.load("panda"), "panda_hand_tcp").singularities.words


SQUARES = {
    "spherical_rrp": "(1 + (L3 + theta3)**2)*(1 + (L3 + theta3)**2*c2**2)",
    "planar_2r": "1 + c2**2",
    "anthropomorphic_rrr": "l2**2*(1 + l3**2*s3**2)*(1 + (l2*s2 + l3*s23)**2)",
    "scara_rrp": "l1**2*(1 + l2**2*s2**2)",
}


@pytest.mark.parametrize("robot", SQUARES)
def test_sums_of_squares_that_vanish_nowhere(robot: str) -> None:
    """1 + r² is not taken for a condition, and is written so that it is seen."""
    d = ps.derive(ps.load(robot))
    measure = d.singularities.measures[0]
    assert measure.factors == ()
    assert measure.value == sp.sympify(SQUARES[robot], locals=dict(d.symbols))
