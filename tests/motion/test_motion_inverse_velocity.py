"""Rates for a twist: against numpy's least squares, formulas by hand and the coursework's arms."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import closed_forms as cf
import pinscrew as ps
import urdfs
from pinscrew.ground.errors import InputError
from pinscrew.motion.inverse_velocity import rate_bounds

Array = npt.NDArray[np.float64]

A5 = cf.PlanarRRR()
L5 = {"l1": 0.5, "l2": 0.4, "l3": 0.3}
PLANE = [1.0, 1.0, 0.0, 0.0, 0.0, 0.0]
"""Weights of the tool's position in the plane alone: three joints for two numbers."""


def random(n: int, batch: tuple[int, ...] = (), seed: int = 0) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    return rng.normal(size=(*batch, 6, n)), rng.normal(size=(*batch, 6))


# ------------------------------------------------------------------------------------------- least squares


@pytest.mark.parametrize("n", [1, 3, 6, 7, 9])
def test_as_numpy_does(n: int) -> None:
    J, V = random(n, (20,))
    found = ps.inverse_velocity(J, V)
    for i in range(20):
        qd, _, rank, sigma = np.linalg.lstsq(J[i], V[i], rcond=None)
        np.testing.assert_allclose(found.qd[i], qd, atol=1e-11)
        np.testing.assert_allclose(found.singular_values[i], sigma, rtol=1e-12)
        np.testing.assert_allclose(found.residual[i], J[i] @ qd - V[i], atol=1e-11)
        assert found.rank[i] == rank
    np.testing.assert_allclose(found.condition, np.linalg.cond(J), rtol=1e-11)
    np.testing.assert_array_equal(found.linear_error, np.linalg.norm(found.residual[:, :3], axis=1))
    np.testing.assert_array_equal(found.angular_error, np.linalg.norm(found.residual[:, 3:], axis=1))


@pytest.mark.parametrize("n", [1, 3, 6])
def test_normal_equations_are_the_printed_ones(n: int) -> None:
    J, V = random(n, (20,), seed=1)
    printed = [np.linalg.inv(A.T @ A) @ A.T @ b for A, b in zip(J, V, strict=True)]
    np.testing.assert_allclose(ps.inverse_velocity(J, V, "normal").qd, printed, rtol=1e-9)


def test_batches_broadcast() -> None:
    J, V = random(3, (4, 1))[0], random(3, (5,), seed=2)[1]
    found = ps.inverse_velocity(J, V, "damped", null=np.ones((2, 1, 1, 3)), bounds=(-np.ones(3), np.ones(3)))
    assert found.qd.shape == (2, 4, 5, 3)
    for values in (found.rank, found.damping, found.scale, found.condition, found.manipulability, found.linear_error):
        assert values.shape == (2, 4, 5)
    one = ps.inverse_velocity(J[2, 0], V[3], "damped", null=np.ones(3), bounds=(-np.ones(3), np.ones(3)))
    np.testing.assert_allclose(found.qd[1, 2, 3], one.qd, atol=1e-14)


def test_manipulability_is_the_determinant() -> None:
    J, V = random(3, (10,))
    expected = np.sqrt(np.linalg.det(np.swapaxes(J, 1, 2) @ J))
    np.testing.assert_allclose(ps.inverse_velocity(J, V).manipulability, expected, rtol=1e-12)


def test_rank_is_counted() -> None:
    J = np.zeros((6, 3))
    J[0, 0] = J[1, 1] = 1.0
    found = ps.inverse_velocity(J, [1.0, 2.0, 3.0, 0.0, 0.0, 4.0])
    assert (found.rank, found.condition) == (2, np.inf)
    np.testing.assert_array_equal(found.qd, [1.0, 2.0, 0.0])
    assert (found.linear_error, found.angular_error) == (3.0, 4.0)


# --------------------------------------------------------------------------- a redundant arm, by hand (A5)


def plane(q: Array) -> Array:
    """The two rows of the position in the plane."""
    return A5.jacobian_hybrid(q, L5)[:2]


Q5 = np.array([0.3, 0.9, -0.5])
V5 = np.array([0.2, -0.1, 0.0, 0.0, 0.0, 0.0])


def test_least_rates_of_a_redundant_arm() -> None:
    A = plane(Q5)
    by_hand = A.T @ np.linalg.inv(A @ A.T) @ V5[:2]
    found = ps.inverse_velocity(A5.jacobian_hybrid(Q5, L5), V5, task_weights=PLANE)
    np.testing.assert_allclose(found.qd, by_hand, atol=1e-14)
    assert found.linear_error < 1e-15
    assert found.angular_error == pytest.approx(abs(by_hand.sum()))  # the tool may turn
    assert (found.rank, found.singular_values.shape) == (2, (2,))


def test_weights_of_joints() -> None:
    A, W = plane(Q5), np.diag([10.0, 1.0, 0.1])
    by_hand = np.linalg.inv(W) @ A.T @ np.linalg.inv(A @ np.linalg.inv(W) @ A.T) @ V5[:2]
    J = A5.jacobian_hybrid(Q5, L5)
    found = ps.inverse_velocity(J, V5, task_weights=PLANE, joint_weights=np.diag(W))
    np.testing.assert_allclose(found.qd, by_hand, atol=1e-14)
    plain = ps.inverse_velocity(J, V5, task_weights=PLANE)
    assert abs(found.qd[0]) < abs(plain.qd[0])
    assert found.linear_error < 1e-15


def test_weights_of_the_task() -> None:
    """Six equations for three rates: weighted least squares, (JᵀWJ)⁻¹JᵀW V."""
    J, V = random(3, seed=4)
    w = np.array([4.0, 0.5, 1.0, 2.0, 0.0, 9.0])
    by_hand = np.linalg.inv(J.T @ np.diag(w) @ J) @ J.T @ np.diag(w) @ V
    for method in ("pinv", "normal"):
        np.testing.assert_allclose(ps.inverse_velocity(J, V, method, task_weights=w).qd, by_hand, atol=1e-13)


def test_null_space_of_a_redundant_arm() -> None:
    """Its one direction is the cross product of the two rows; only z's part along it is added."""
    A, z = plane(Q5), np.array([0.7, -0.2, 0.4])
    n = np.cross(A[0], A[1])
    J = A5.jacobian_hybrid(Q5, L5)
    plain = ps.inverse_velocity(J, V5, task_weights=PLANE)
    for method in ("pinv", "damped"):
        found = ps.inverse_velocity(J, V5, method, task_weights=PLANE, null=z)
        np.testing.assert_allclose(found.qd - plain.qd, n * (n @ z) / (n @ n), atol=1e-14)
        np.testing.assert_allclose(A @ found.qd, V5[:2], atol=1e-15)


def test_null_space_with_weights_of_joints() -> None:
    """The projector is I - J⁺J of the weighted pseudo-inverse: still nothing of the task changes."""
    A, w = plane(Q5), np.array([3.0, 1.0, 0.2])
    inverse = np.diag(1 / w) @ A.T @ np.linalg.inv(A @ np.diag(1 / w) @ A.T)
    z = np.array([0.7, -0.2, 0.4])
    J = A5.jacobian_hybrid(Q5, L5)
    found = ps.inverse_velocity(J, V5, task_weights=PLANE, joint_weights=w, null=z)
    np.testing.assert_allclose(found.qd, inverse @ V5[:2] + (np.eye(3) - inverse @ A) @ z, atol=1e-14)


# ------------------------------------------------------------------------------------------------- damping


def stretched(angle: float) -> Array:
    """The position rows of a planar arm of two unit links, singular at angle 0, as a 6 by 2 Jacobian."""
    J = np.zeros((6, 2))
    J[:2] = [[-np.sin(angle), -np.sin(angle)], [1 + np.cos(angle), np.cos(angle)]]
    return J


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-4, 0.01, 0.03])
def test_damping_near_a_singularity(angle: float) -> None:
    J, V = stretched(angle), np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])  # straight along the arm
    found = ps.inverse_velocity(J, V, "damped", damping=0.1, threshold=0.02)
    sigma = np.linalg.svd(J[:2], compute_uv=False)[-1]
    assert sigma < 0.02
    squared = 0.01 * (1 - (sigma / 0.02) ** 2)
    by_hand = J.T @ np.linalg.inv(J @ J.T + squared * np.eye(6)) @ V
    assert found.damping == pytest.approx(np.sqrt(squared), rel=1e-9)
    np.testing.assert_allclose(found.qd, by_hand, atol=1e-9)
    assert np.linalg.norm(found.qd) <= 1 / (2 * np.sqrt(squared)) + 1e-12
    if 0 < angle < 1e-3:
        assert np.linalg.norm(ps.inverse_velocity(J, V, rcond=1e-12).qd) > 1e3


def test_no_damping_away_from_singularities() -> None:
    J, V = random(3, (20,))
    found = ps.inverse_velocity(J, V, "damped")
    assert (found.damping == 0.0).all()
    np.testing.assert_allclose(found.qd, ps.inverse_velocity(J, V).qd, atol=1e-13)


def test_damping_is_continuous() -> None:
    """It sets in at the threshold from 0: rates just above and just below it are the same."""
    J = np.zeros((6, 1))
    V = np.eye(6)[0]
    above, below = (
        ps.inverse_velocity(J + s * np.eye(6, 1), V, "damped", threshold=0.05) for s in (0.05, 0.05 * (1 - 1e-12))
    )
    assert above.damping == 0.0
    assert below.qd[0] == pytest.approx(above.qd[0], rel=1e-8)


def test_damping_of_a_zero_jacobian() -> None:
    found = ps.inverse_velocity(np.zeros((6, 2)), np.ones(6), "damped")
    np.testing.assert_array_equal(found.qd, [0.0, 0.0])


# --------------------------------------------------------------------------------------------------- units


def test_length_makes_units_equal() -> None:
    """A robot in millimetres, a millimetre counted as a thousandth: same rates, same condition."""
    J, V = random(3, seed=7)
    metre = np.repeat([1.0, 0.0], 3) * 999 + 1
    a = ps.inverse_velocity(J, V, length=0.3)
    b = ps.inverse_velocity(metre[:, None] * J, metre * V, length=300.0)
    np.testing.assert_allclose(a.qd, b.qd, rtol=1e-12)
    np.testing.assert_allclose(a.singular_values, b.singular_values, rtol=1e-12)
    assert abs(a.qd - ps.inverse_velocity(J, V).qd).max() > 1e-3, "it matters where V can't be reached"


# -------------------------------------------------------------------------------------------------- bounds


def test_bounds_keep_the_direction() -> None:
    J, V = random(6, (50,), seed=8)
    free, high = ps.inverse_velocity(J, V), np.array([0.5, 1.0, 2.0, 0.1, 3.0, 1.0])
    found = ps.inverse_velocity(J, V, bounds=(-0.5 * high, high))
    assert ((found.qd <= high * (1 + 1e-15)) & (found.qd >= -0.5 * high * (1 + 1e-15))).all()
    np.testing.assert_allclose(found.qd, found.scale[:, None] * free.qd, rtol=1e-14)
    np.testing.assert_allclose((J @ found.qd[..., None])[..., 0], found.scale[:, None] * V, atol=1e-9)
    limits = np.where(free.qd > 0, high, 0.5 * high)
    np.testing.assert_allclose(found.scale, np.minimum(1.0, (limits / abs(free.qd)).min(axis=1)), rtol=1e-14)
    assert (found.scale < 1).any()
    np.testing.assert_allclose(found.residual, (found.scale - 1)[:, None] * V, atol=1e-9)


def test_a_joint_that_must_not_move_stops_all() -> None:
    J, V = random(3, seed=9)
    found = ps.inverse_velocity(J, V, bounds=(np.zeros(3), np.full(3, np.inf)))
    assert (found.scale, abs(found.qd).max()) == (0.0, 0.0)
    wide = ps.inverse_velocity(J, V, bounds=(np.full(3, -np.inf), np.full(3, np.inf)))
    assert wide.scale == 1.0


def test_bounds_from_limits() -> None:
    robot = ps.load("planar_2r")
    lower, upper = robot.limits.T
    speeds = np.array([joint.limits.velocity for joint in robot.description.joints if joint.type == "revolute"])
    low, high = rate_bounds(robot, [upper[0] - 1e-3, lower[1] - 0.2], 0.1)
    np.testing.assert_allclose(high, [0.01, speeds[1]], rtol=1e-9)
    np.testing.assert_allclose(low, [-speeds[0], 0.0])  # beyond its limit it may only come back
    q = np.stack([lower + 1e-3, upper - 1e-3])
    low, high = rate_bounds(robot, q, 0.1)
    assert (q + 0.1 * low >= lower - 1e-15).all()
    assert (q + 0.1 * high <= upper + 1e-15).all()


@pytest.mark.parametrize(
    ("multiplier", "limit", "allowed"),
    [(2.0, 1.0, 0.5), (-4.0, 1.0, 0.25), (0.5, 1.0, 1.0), (2.0, 5.0, 1.0), (0, 1, 1)],
)
def test_bounds_of_joints_that_others_follow(multiplier: float, limit: float, allowed: float) -> None:
    """|m| |θ̇| may be no more than the follower's limit of speed, nor |θ̇| than the joint's own, which is 1."""
    follower = urdfs.joint("b", "revolute", "one", "two", mimic=("a", multiplier, 0.3))
    follower = follower.replace('velocity="1"', f'velocity="{limit}"')
    robot = urdfs.load(urdfs.robot(urdfs.joint("a", "revolute", "base", "one"), follower, links="base one two"))
    np.testing.assert_allclose(rate_bounds(robot, [0.0], 1e-3), [[-allowed], [allowed]])


# ---------------------------------------------------------------------------------------------- bad inputs

J0, V0 = random(3)
RANK2 = np.zeros((6, 3))
RANK2[0, 0] = RANK2[1, 1] = 1.0
NARROW = np.zeros((6, 2))
NARROW[0] = [1.0, 1.0]
NARROW[1, 1] = 1e-8
BAD: dict[str, tuple[dict[str, Any], str, str]] = {
    "method": ({"method": "transpose"}, "method", "no method 'transpose'; use normal, pinv, damped"),
    "J rows": ({"J": np.ones((3, 3))}, "shape", "J has shape (3, 3)"),
    "J vector": ({"J": np.ones(6)}, "shape", "J has shape (6,)"),
    "no columns": ({"J": np.ones((6, 0))}, "shape", "n at least 1"),
    "V": ({"V": np.ones(3)}, "shape", "V has (3,)"),
    "batch": ({"J": np.ones((2, 6, 3)), "V": np.ones((3, 6))}, "shape", "the batch axes (2,), (3,) do not broadcast"),
    "NaN": ({"V": [0, 0, np.nan, 0, 0, 0]}, "not-finite", "V holds NaN or infinity"),
    "text": ({"J": "J"}, "not-numbers", "J is no array of numbers"),
    "rank": (
        {"J": RANK2, "method": "normal"},
        "singular",
        "rank 2 and 3 columns, so JᵀJ has no inverse; use the method",
    ),
    "nearly": ({"J": NARROW, "method": "normal"}, "singular", "rank 1 and 2 columns"),
    "weights count": ({"task_weights": [1, 1]}, "shape", "task_weights has shape (2,)"),
    "weights negative": ({"task_weights": [1, 1, 1, 1, 1, -1]}, "weights", "expected 6 numbers, none negative"),
    "weights zero": ({"task_weights": np.zeros(6)}, "weights", "all task_weights are 0"),
    "joint weight 0": ({"joint_weights": [1, 0, 1]}, "weights", "expected 3 numbers, all positive"),
    "length": ({"length": 0.0}, "not-positive", "length = 0"),
    "rcond": ({"rcond": -1.0}, "not-positive", "rcond = -1"),
    "damping": ({"method": "damped", "damping": 0.0}, "not-positive", "damping = 0"),
    "threshold": ({"method": "damped", "threshold": np.inf}, "not-finite", "threshold holds"),
    "null": ({"null": [1.0, 2.0]}, "shape", "null has shape (2,)"),
    "bounds": ({"bounds": (np.ones(3), 2 * np.ones(3))}, "bounds", "0 is not between the bounds"),
    "bounds NaN": ({"bounds": (-np.ones(3), [1, np.nan, 1])}, "bounds", "0 is not between the bounds"),
    "bounds shape": ({"bounds": (-np.ones(2), np.ones(2))}, "shape", "bounds have shapes (2,) and (2,)"),
    "one bound": ({"bounds": [np.ones(3)]}, "bounds", "bounds are no two arrays"),
}


@pytest.mark.parametrize(("given", "code", "words"), BAD.values(), ids=BAD)
def test_bad_inputs(given: dict[str, Any], code: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        ps.inverse_velocity(**{"J": J0, "V": V0, **given})
    assert caught.value.code == code
    assert words in str(caught.value)


def test_bad_bounds_of_robots() -> None:
    arm = ps.load("planar_2r")
    for q, dt, code in (
        (np.zeros(3), 0.1, "shape"),
        (np.zeros(2), 0.0, "not-positive"),
        ([0, np.inf], 1, "not-finite"),
    ):
        with pytest.raises(InputError) as caught:
            rate_bounds(arm, q, dt)
        assert caught.value.code == code
    with pytest.raises(InputError, match="it has floating or planar joints"):
        rate_bounds(ps.load("planar_2r", floating_base=True), np.zeros(9), 0.1)
