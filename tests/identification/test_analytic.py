"""Analytic Jacobians: rates of angles, rotation vectors and quaternions in place of ω."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import pinscrew as ps
from pinscrew.identification.encodings import Encoding
from pinscrew.identification.rates import rated, rates_of
from pinscrew.identification.turns import SEQUENCES

BOTH = (*SEQUENCES, *map(str.upper, SEQUENCES))
Q = np.random.default_rng(11).uniform(-1.0, 1.0, (2, 6))
H = 1e-6


def written(form: str, R: Any) -> Any:
    """By scipy: angles in radians, a rotation vector, or a quaternion with w ≥ 0."""
    turn = Rotation.from_matrix(R)
    if form == "rotation vector":
        return turn.as_rotvec()
    if form.startswith("quaternion"):
        return turn.as_quat(canonical=True, scalar_first=form.endswith("wxyz"))
    return turn.as_euler(form.removeprefix("angles "))


@pytest.mark.parametrize("rows", [6, 7])
def test_rates_are_derivatives_of_scipy_s(rows: int) -> None:
    """Central differences along R(t) = exp(ω̂ t) R."""
    R, omega = Rotation.random(5, rng=np.random.default_rng(0)).as_matrix(), np.eye(3)
    seen = 0
    for encoding in rated(rows):
        form = f"{encoding.form} {encoding.sequence}".strip()
        per = 180.0 / np.pi if encoding.angle == "deg" else 1.0
        for k in range(3):
            ahead, behind = (Rotation.from_rotvec(sign * H * omega[k]).as_matrix() @ R for sign in (1.0, -1.0))
            numeric = per * (written(form, ahead) - written(form, behind)) / (2.0 * H)
            assert np.allclose(rates_of(encoding, R)[:, :, k], numeric, rtol=1e-6, atol=1e-6 * per)
            seen += 1
    assert seen == (3 * 2 * 25 if rows == 6 else 3 * 2)


def test_locked_angles_have_no_rates() -> None:
    R = Rotation.from_euler("xyz", [[0.3, np.pi / 2, 0.0]]).as_matrix()
    assert np.isnan(rates_of(Encoding("angles", "xyz"), R)).all()
    assert np.isfinite(rates_of(Encoding("angles", "ZYZ"), R)).all()


def analytic(robot: ps.Robot, form: str) -> Any:
    """By central differences of Pinocchio's poses."""
    pin, columns = ps.Pinocchio(robot), []
    for step in np.eye(6):
        ahead, behind = (pin.fk(Q + sign * 1e-5 * step, "tool0") for sign in (1.0, -1.0))
        rows = [np.hstack([T[:, :3, 3], written(form, T[:, :3, :3])]) for T in (ahead, behind)]
        columns.append((rows[0] - rows[1]) / 2e-5)
    return np.round(np.stack(columns, axis=-1), 7)


@pytest.mark.parametrize(
    "form",
    [
        *("angles xyz", "angles ZYX", "angles ZYZ", "rotation vector", "quaternion wxyz", "quaternion xyzw"),
        *(pytest.param(f"angles {each}", marks=pytest.mark.slow) for each in BOTH if each not in ("xyz", "ZYX", "ZYZ")),
    ],
)
def test_analytic_jacobians(form: str) -> None:
    robot = ps.load("ur5_robot")
    J = analytic(robot, form)
    found = ps.identify(robot, Q, J)
    assert found.verdict == "unique", str(found)
    names = (found.candidates[0].words, *found.candidates[0].aliases)
    assert any(f"the analytic Jacobian of tool0, rates of its position and {form}" in each for each in names)
    assert np.array_equal(found.convert(J), J)
    other = np.round(np.concatenate([J[:, 3:], 1000.0 * J[:, :3]], axis=1)[:, :, ::-1], 4)  # as J is: to 1e-7 m
    found = ps.identify(robot, Q, np.swapaxes(other, 1, 2))
    assert found.verdict == "unique", str(found)
    assert np.allclose(found.convert(np.swapaxes(other, 1, 2)), J, atol=1e-4)
    scope: dict[str, Any] = {"np": np, "J": np.swapaxes(other, 1, 2)}
    exec(found.code, scope)  # noqa: S102 (what it is for)
    assert np.allclose(scope["ours"], J, atol=1e-4)
    fields = found.to_document()["candidates"][0]
    assert (fields["kind"], fields["order"], fields["layout"]) == ("analytic", "w,v", "transposed")
    # Of the sequence any of two: ZYZ and ZXZ differ by constant angles, and so not in their rates.
    assert f"{fields['encoding']} {fields['sequence'] or ''}".strip()[:6] == form[:6]
    J[1, 4, 2] += 1e-5
    assert ps.identify(robot, Q, J).verdict == "none"


def test_where_rates_are_omega_both_are_said() -> None:
    """Where the tool stands as the base does, rates about fixed axes are ω; elsewhere they are not."""
    robot = ps.load("spherical_rrp")
    J = ps.Pinocchio(robot).jacobian(np.zeros((1, 3)), "tool", "hybrid")
    found = ps.identify(robot, np.zeros((1, 3)), J)
    assert found.verdict == "ambiguous"
    kinds = {each.observer.kind for each in found.candidates if each.observer is not None}
    assert {"hybrid", "analytic"} <= kinds


def test_twists_with_rates() -> None:
    robot = ps.load("ur5_robot")
    qd = np.random.default_rng(1).normal(size=(2, 6))
    V = (analytic(robot, "angles xyz") @ qd[:, :, None])[:, :, 0]
    V[:, 3:] = np.degrees(V[:, 3:])
    found = ps.identify(robot, Q, qd, np.round(V, 4))
    assert found.verdict == "unique", str(found)
    assert "the analytic twist of tool0, rates of its position and angles xyz" in found.candidates[0].words
    assert found.candidates[0].words.endswith("in degrees")


@pytest.mark.parametrize("rows", [6, 7])
def test_seven_of_something_is_nobody_s(rows: int) -> None:
    robot = ps.load("ur5_robot")
    noise = np.random.default_rng(0).normal(size=(2, rows, 13 - rows))
    assert ps.identify(robot, Q, noise).verdict == "none"
