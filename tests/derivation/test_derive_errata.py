"""Each printed mistake disagrees with both engines, and what is right agrees with both."""

from dataclasses import replace
from functools import cache
from typing import get_args

import numpy as np
import pytest

import pinscrew as ps
from pinscrew.derivation import errata, errata_entries
from pinscrew.derivation.errata_truth import truth
from pinscrew.ground.errors import InputError
from pinscrew.mathtext import evaluate, read_plain

ALL = errata.errata()
bundled = cache(ps.load)


@pytest.mark.parametrize("erratum", ALL, ids=lambda e: e.where)
def test_printed_is_wrong_and_right_is_right(erratum: errata.Erratum) -> None:
    robot = bundled(erratum.robot)
    for verdict in errata.verdicts(erratum, robot):
        assert verdict.printed_error > errata.WRONG
        assert verdict.right_error <= errata.TOLERANCE
        assert verdict.ok
    swapped = replace(erratum, printed=erratum.right, right=erratum.printed)
    assert not any(verdict.ok for verdict in errata.verdicts(swapped, robot))


def test_every_arm_with_errata_has_them() -> None:
    assert {e.arm for e in ALL} == {"A1", "A2", "A3", "A4", "A5", "A7", "A8", "A10"}
    assert {e.part for e in ALL if e.arm == "A1"} == set("defghik")
    assert len(ALL) == 96
    assert {e.slip for e in ALL} == set(errata_entries.SLIPS) == set(get_args(errata_entries.Slip))
    assert sum(e.scan for e in ALL) == 23
    places = [(e.where, e.quantity, e.index) for e in ALL]
    assert len(places) == len(set(places))


def test_the_printouts_place_is_not_on_the_printed_profile() -> None:
    """θ2 where θ1 is 1.5475, by adding up the rates of the printed profile in small steps."""
    entry = next(e for e in ALL if e.slip == "copied" and e.arm == "A8")

    def rates(t: float) -> tuple[float, float]:
        if t <= 1:
            return 0.0, 0.0
        if t <= 5:
            return 0.1 * t, 0.1
        return (0.3 if t <= 6 else 0.3 - 0.1 * (t - 5)), 0.1 - 0.01 * (t - 5)

    theta, dt = np.zeros(2), 1e-3
    passed = []
    for step in range(16_000):
        theta += dt * np.array(rates((step + 0.5) * dt))
        passed.append(tuple(theta))
    nearest = min(passed[:7_000], key=lambda at: abs(at[0] - float(entry.at["joint1"])))
    assert nearest[1] == pytest.approx(float(evaluate(read_plain(entry.at["joint2"]), {})), abs=1e-3)
    assert min(np.hypot(a - 1.5475, b - 0.05495) for a, b in passed) > 0.3


def test_quantities_against_closed_forms() -> None:
    """Those of the table that no engine has by name, for the spherical arm (A1) and the planar one (A2)."""
    robot = ps.load("spherical_rrp")
    engine = ps.PoE(robot)
    q, qd = np.array([[0.3, -0.8, 0.45]]), np.array([[0.7, -0.2, 0.9]])
    L0, r, c2, s2 = 0.5, 0.8 + 0.45, np.cos(-0.8), np.sin(-0.8)

    def ask(quantity: str, joint: int = 0, **more: str) -> np.ndarray:
        entry = errata.Erratum("", robot.name, "", "", quantity, (1, 1), "", "", "sign", joint=joint, **more)
        return truth(engine, entry, q[:, : engine.robot.nq], qd, np.array([0.1]))[0]

    # g2 = e^{ξ2θ2} e^{ξ3θ3} g(0) has p = (0, r c2, L0 - r s2), R = Rx(-θ2)
    corner = [[0, L0 - r * s2, -r * c2], [-L0 * c2, 0, 0], [r - L0 * s2, 0, 0]]
    np.testing.assert_allclose(ask("corner of the adjoint inverse", 2), corner, atol=1e-15)
    np.testing.assert_allclose(ask("position", 3).T, [[0, r, L0]], atol=1e-15)
    np.testing.assert_allclose(ask("position hat", 3), [[0, -L0, r], [L0, 0, 0], [-r, 0, 0]], atol=1e-15)
    assert ask("rows of body Jacobian") == 6
    assert ask("columns of body Jacobian") == 3
    assert ask("mirrored determinant") == pytest.approx(-1.0)
    np.testing.assert_allclose(ask("axis", 2).T, [[-np.cos(0.3), -np.sin(0.3), 0]], atol=1e-15)
    np.testing.assert_allclose(
        ask("lever", 3, frame="base").T, [[-r * c2 * np.sin(0.3), r * c2 * np.cos(0.3), L0 - r * s2]]
    )
    robot = ps.load("planar_2r")
    engine = ps.Pinocchio(robot)
    np.testing.assert_allclose(ask("axis point", 2).T, [[0, 1, 1]], atol=1e-15)
    np.testing.assert_allclose(ask("axis point", 1, reference="frame0").T, [[-1, -1, 0]], atol=1e-15)


def test_report() -> None:
    report = errata.report(ps.load("two_joint"))
    assert report.ok
    assert len(report.sections) == len(errata.errata("two_joint")) + 1
    with pytest.raises(InputError, match="no printed mistakes"):
        errata.report(ps.load("gear_pair"))
