"""SO(3) against power series at 60 digits, in all regimes of the angle."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest
import scipy.linalg
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import lie_strategies as ls
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import _series, so3

EPSILON, SPACING = ls.EPSILON, ls.SPACING
Function = Callable[[Any], FloatArray]

# ---------------------------------------------------------------------------------------------------- checks
# Each check takes the function to check, so that the tests at the end can hand it a wrong one.


def check_exp(exp: Function, omega: FloatArray) -> None:
    """R is right to 16 ε + 2 ε θ.

    Entries are at most 1. sin and 1 - cos are right to 1 ε, the axis to 2 ε and its products to 4 ε, with 3
    roundings: below 16 ε together. θ itself is right to 2 ε θ (two hypots).
    """
    angle = ls.angle_of(omega)
    expected, _ = ls.truth(ls.hat3(ls.exact(omega)), angle)
    assert ls.error(exp(omega), expected) <= (16 + 2 * angle) * EPSILON


def check_left_jacobian(left_jacobian: Function, omega: FloatArray) -> None:
    """J is right to 16 ε at every angle.

    Its coefficients (1 - cos θ)/θ and 1 - sin θ/θ move by less than 4 ε when θ moves by 2 ε θ; the rest is as
    in :func:`check_exp`.
    """
    _, expected = ls.truth(ls.hat3(ls.exact(omega)), ls.angle_of(omega))
    assert ls.error(left_jacobian(omega), expected) <= 16 * EPSILON


def check_log(log: Function, omega: FloatArray) -> None:
    """ω is right to 8 ε θ.

    The true R is rounded, which turns it by up to ε θ: entries that θ makes small are rounded at their own
    size. The quotients and the arctangent add about 4 ε θ. Subnormals add their spacing.
    """
    angle = ls.angle_of(omega)
    R, _ = ls.truth(ls.hat3(ls.exact(omega)), angle)
    assert ls.error(log(R.astype(float)), ls.exact(omega)) <= 8 * EPSILON * angle + 2 * SPACING


# ---------------------------------------------------------------------------------------------- exp and log


@given(ls.rotation_vectors())
def test_exp(omega: FloatArray) -> None:
    check_exp(so3.exp, omega)


@given(ls.rotation_vectors(st.one_of(ls.ZERO, ls.TINY, ls.SMALL)))
def test_exp_up_to_one_radian_is_right_to_1e_15(omega: FloatArray) -> None:
    expected, _ = ls.truth(ls.hat3(ls.exact(omega)), ls.angle_of(omega))
    assert ls.error(so3.exp(omega), expected) <= 1e-15


@given(ls.rotation_vectors(st.one_of(ls.SMALL, st.floats(0, 10))))
def test_exp_agrees_with_scipy(omega: FloatArray) -> None:
    # scipy's expm, by squarings, is wrong by up to 2e-13 at 10 rad.
    np.testing.assert_allclose(so3.exp(omega), scipy.linalg.expm(so3.hat(omega)), rtol=0, atol=1e-12)
    np.testing.assert_allclose(so3.exp(omega), Rotation.from_rotvec(omega).as_matrix(), rtol=0, atol=1e-14)


def test_exp_is_orthogonal_at_every_angle() -> None:
    rng = np.random.default_rng(0)
    axes = rng.normal(size=(200_000, 3))
    axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
    exponents = np.concatenate([rng.uniform(-12, 6, 150_000), rng.uniform(-300, 300, 50_000)])
    R = so3.exp(axes * 10.0 ** exponents[:, None])
    defect = np.linalg.norm(np.swapaxes(R, -1, -2) @ R - np.eye(3), axis=(-2, -1))
    # ‖u‖² is off by 3 ε, which shows as √2 sin² θ times that; rounding R's entries adds twice 3 ε, and the
    # product here 2 ε: 12 ε. Without the division by ‖u‖², 3.2e-15 is seen.
    assert defect.max() <= 2.8e-15
    np.testing.assert_allclose(np.linalg.det(R), 1.0, rtol=0, atol=4e-15)


@given(ls.log_uniform(-150, 0))
def test_exp_keeps_the_second_order(angle: float) -> None:
    """About (1, 1, 0)/√2, R[0, 1] is (1 - cos θ)/2 alone, and right to the ulps of itself."""
    omega = angle * np.array([1.0, 1.0, 0.0])
    with mpmath.workdps(400):
        expected = (1 - mpmath.cos(mpmath.sqrt(2) * mpmath.mpf(angle))) / 2
    assert abs(so3.exp(omega)[0, 1] - expected) <= 16 * EPSILON * expected


def test_exp_of_quarter_turns() -> None:
    quarter = math.pi / 2
    np.testing.assert_allclose(
        so3.exp(quarter * np.eye(3)),
        [
            [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
            [[0, 0, 1], [0, 1, 0], [-1, 0, 0]],
            [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
        ],
        rtol=0,
        atol=2 * EPSILON,
    )


@given(ls.rotation_vectors(st.one_of(ls.ZERO, ls.TINY, ls.SMALL, ls.MEETING, st.floats(1.0, math.pi - 1e-14))))
def test_log(omega: FloatArray) -> None:
    assume(ls.angle_of(omega) < math.pi - 1e-14)
    check_log(so3.log, omega)


@given(ls.rotation_vectors(ls.log_uniform(-14, -9).map(lambda x: math.pi - x)))
def test_log_near_a_half_turn(omega: FloatArray) -> None:
    """At 1e-14 from π the skew part of R, of that size, still tells the sign of the axis."""
    assume(ls.angle_of(omega) < math.pi - 1e-14)
    check_log(so3.log, omega)


@given(ls.rotation_vectors(ls.HALF_TURN))
def test_log_through_the_half_turn(omega: FloatArray) -> None:
    """Either sign, and either side of π: the answer must rotate as R does, by at most π."""
    R, _ = ls.truth(ls.hat3(ls.exact(omega)), ls.angle_of(omega))
    actual = so3.log(R.astype(float))
    assert ls.angle_of(actual) <= math.pi * (1 + 2 * EPSILON)
    again, _ = ls.truth(ls.hat3(ls.exact(actual)), math.pi)
    # 8 ε π in ω as in check_log, and the rounding of R.
    assert np.max(np.abs(again - R)) <= (8 * math.pi + 1) * EPSILON


@pytest.mark.parametrize(
    ("axis", "expected"),
    [
        ([1, 0, 0], [1, 0, 0]),
        ([0, -1, 0], [0, 1, 0]),
        ([0, 0, -1], [0, 0, 1]),
        ([-1, -1, 0], [1, 1, 0]),
        ([1, -1, 0], [1, -1, 0]),
        ([-1, 1, 0], [1, -1, 0]),
        ([1, 2, -3], [-1, -2, 3]),
        ([3, -2, -1], [3, -2, -1]),
    ],
)
def test_log_of_a_symmetric_rotation_has_its_largest_component_positive(axis: list[int], expected: list[int]) -> None:
    u = np.array(axis) / np.linalg.norm(axis)
    R = 2 * np.outer(u, u) - np.eye(3)
    want = math.pi * np.array(expected) / np.linalg.norm(expected)
    np.testing.assert_allclose(so3.log(R), want, rtol=0, atol=8 * math.pi * EPSILON)


def test_log_of_the_identity_is_zero() -> None:
    np.testing.assert_array_equal(so3.log(np.eye(3)), np.zeros(3))


# ----------------------------------------------------------------------------------------- left Jacobian


@given(ls.rotation_vectors())
def test_left_jacobian(omega: FloatArray) -> None:
    check_left_jacobian(so3.left_jacobian, omega)


@settings(max_examples=40)
@given(ls.rotation_vectors(st.one_of(ls.ZERO, ls.SMALL, ls.MEETING, st.floats(0, 30))), ls.DIRECTIONS)
def test_left_jacobian_turns_rates_into_angular_velocity(omega: FloatArray, rate: FloatArray) -> None:
    """d/dt e^(ω + t ω')^ at t = 0 is (J ω')^ R; central differences at 60 digits are right to h² = 1e-40."""
    step = mpmath.mpf(10) ** -20
    exact, exact_rate, angle = ls.exact(omega), ls.exact(rate), ls.angle_of(omega) + 1
    forward, _ = ls.truth(ls.hat3(exact + step * exact_rate), angle)
    backward, _ = ls.truth(ls.hat3(exact - step * exact_rate), angle)
    R, _ = ls.truth(ls.hat3(exact), angle)
    velocity = (forward - backward) @ R.T / (2 * step)
    # 3 products with entries of J, each right to 16 ε, and 3 roundings.
    assert ls.error(so3.hat(so3.left_jacobian(omega) @ rate), velocity) <= 54 * EPSILON


@given(ls.rotation_vectors())
def test_left_jacobian_inverse(omega: FloatArray) -> None:
    angle = ls.angle_of(omega)
    distance = ls.distance_to_full_turn(angle)
    assume(distance > 8 * EPSILON * angle)
    _, J = ls.truth(ls.hat3(ls.exact(omega)), angle)
    expected = ls.solve(J)
    # θ is right to 2 ε θ, and (θ/2) cot(θ/2) moves by the share θ/distance of itself; the rest as for exp.
    size = max(1.0, float(np.max(np.abs(expected))))
    assert ls.error(so3.left_jacobian_inverse(omega), expected) <= (16 + 4 * angle / distance) * size * EPSILON


@pytest.mark.parametrize("turns", [1, 2, 3, 1000])
@pytest.mark.parametrize("axis", [[0, 0, 1], [1, 2, 3], [-1, 0.1, 0]])
def test_left_jacobian_inverse_is_refused_at_full_turns(turns: int, axis: list[float]) -> None:
    omega = 2 * math.pi * turns * np.array(axis) / np.linalg.norm(axis)
    with pytest.raises(InputError, match="multiple of 2π") as caught:
        so3.left_jacobian_inverse(omega)
    assert caught.value.code == "singular"
    assert np.isfinite(so3.left_jacobian_inverse(omega * (1 + 1e-13))).all()
    with pytest.raises(InputError, match=r"omega\[1\] has the angle"):
        so3.left_jacobian_inverse([np.zeros(3), omega])


# ------------------------------------------------------------------------------------------- coefficients


@pytest.mark.parametrize(
    ("coefficients", "function"),
    [
        (_series._SINE_DEFICIT, lambda x: (x - sympy.sin(x)) / x**3),
        (_series._COTANGENT_DEFICIT, lambda x: (sympy.sin(x) - x * sympy.cos(x)) / x**3),
    ],
)
def test_series_coefficients_are_those_of_sympy(
    coefficients: tuple[float, ...], function: Callable[[sympy.Symbol], sympy.Expr]
) -> None:
    x = sympy.Symbol("x")
    expected = sympy.Poly(sympy.series(function(x), x, 0, 2 * len(coefficients)).removeO(), x).all_coeffs()
    assert expected[::-2] == pytest.approx(coefficients, rel=EPSILON)


@given(st.one_of(ls.TINY, ls.SMALL, ls.MEETING, st.floats(1.0, 5.0)))
def test_coefficients_to_a_few_ulps_on_both_sides_of_the_meeting_angle(angle: float) -> None:
    """At θ = 1 the closed formulas subtract 0.84 from 1 and 1.83 from 2: 1 ε becomes 6 ε and 12 ε."""
    x = mpmath.mpf(angle)
    with mpmath.workdps(700):  # the difference is of the third order
        sine = (x - mpmath.sin(x)) / x**2
        cotangent = (1 - x / 2 * mpmath.cot(x / 2)) / x
    scalar = np.float64(angle)
    assert abs(_series._sine_deficit(scalar) - sine) <= 8 * EPSILON * sine + SPACING
    assert abs(_series._cotangent_deficit(scalar) - cotangent) <= 16 * EPSILON * cotangent + SPACING


# ------------------------------------------------------------------------------------- algebra and group


@given(ls.rotation_vectors(), ls.LINEAR)
def test_hat_is_the_cross_product(omega: FloatArray, a: FloatArray) -> None:
    # Two products and their difference, rounded: their sizes are bounded by ‖ω‖ ‖a‖.
    tolerance = 2 * EPSILON * (ls.angle_of(omega) * ls.angle_of(a)) + 2 * SPACING
    np.testing.assert_allclose(so3.hat(omega) @ a, np.cross(omega, a), rtol=0, atol=tolerance)
    np.testing.assert_array_equal(so3.hat(omega), -so3.hat(omega).T)
    np.testing.assert_array_equal(so3.vee(so3.hat(omega)), omega)
    np.testing.assert_array_equal(so3.ad(omega), so3.hat(omega))


def test_hat_makes_no_minus_zeros() -> None:
    assert not np.signbit(so3.hat([0.0, 0.0, 0.0])).any()


def test_vee_reads_the_skew_part() -> None:
    symmetric = np.array([[1.0, 2, 3], [2, 4, 5], [3, 5, 6]])
    np.testing.assert_array_equal(so3.vee(so3.hat([1, 2, 3]) + symmetric), [1, 2, 3])


@given(ls.batches(ls.rotation_vectors()), st.data())
def test_group_axioms(omega: FloatArray, data: st.DataObject) -> None:
    shape = omega.shape[:-1]
    other, third = (
        np.array([data.draw(ls.rotation_vectors()) for _ in range(math.prod(shape))]).reshape(omega.shape)
        for _ in range(2)
    )
    A, B, C = so3.exp(omega), so3.exp(other), so3.exp(third)
    # Products of two and three orthogonal matrices with entries right to 4 ε.
    tolerance = {"rtol": 0, "atol": 32 * EPSILON}
    identity = np.broadcast_to(np.eye(3), A.shape)
    assert A.shape == (*shape, 3, 3)
    np.testing.assert_array_equal(so3.inverse(A), np.swapaxes(A, -1, -2))
    np.testing.assert_allclose(A @ so3.inverse(A), identity, **tolerance)
    np.testing.assert_allclose(so3.inverse(A) @ A, identity, **tolerance)
    np.testing.assert_allclose((A @ B) @ C, A @ (B @ C), **tolerance)
    np.testing.assert_allclose(so3.inverse(A @ B), so3.inverse(B) @ so3.inverse(A), **tolerance)
    np.testing.assert_allclose(np.linalg.det(A @ B), np.ones(shape), **tolerance)
    np.testing.assert_allclose(so3.exp(-omega), so3.inverse(A), **tolerance)
    np.testing.assert_array_equal(so3.adjoint(A), A)


@given(ls.rotation_vectors(), ls.LINEAR)
def test_rotations_carry_cross_products(omega: FloatArray, a: FloatArray) -> None:
    """R â Rᵀ = (R a)^ and Ad_R a = vee(R â Rᵀ); the angle of R does not matter, its orthogonality does."""
    R = so3.exp(omega)
    tolerance = 32 * EPSILON * ls.angle_of(a) + 8 * SPACING
    np.testing.assert_allclose(R @ so3.hat(a) @ R.T, so3.hat(R @ a), rtol=0, atol=tolerance)
    np.testing.assert_allclose(so3.vee(R @ so3.hat(a) @ R.T), so3.adjoint(R) @ a, rtol=0, atol=tolerance)


@pytest.mark.parametrize("shape", ls.BATCHES)
@pytest.mark.parametrize(
    "name",
    [
        "hat",
        "ad",
        "exp",
        "left_jacobian",
        "left_jacobian_inverse",
        "vee",
        "log",
        "inverse",
        "adjoint",
        "project",
    ],
)
def test_batches_are_their_elements(name: str, shape: tuple[int, ...]) -> None:
    function = getattr(so3, name)
    argument = np.random.default_rng(1).normal(size=(*shape, 3))
    if name in {"vee", "log", "inverse", "adjoint", "project"}:
        argument = so3.exp(argument)
    result = function(argument)
    assert result.dtype == np.float64
    assert result.shape[: len(shape)] == shape
    for index in np.ndindex(shape):
        one = function(argument[index].tolist())
        np.testing.assert_allclose(result[index], one, rtol=0, atol=16 * EPSILON)  # SIMD and FMA differ


# ------------------------------------------------------------------------------------------------ project


@given(ls.rotation_vectors(), st.integers(0, 10**6), st.sampled_from([1e-200, 1e-3, 1.0, 1e200]))
def test_project_is_the_polar_factor(omega: FloatArray, seed: int, scale: float) -> None:
    M = so3.exp(omega) + 0.1 * np.random.default_rng(seed).uniform(-1, 1, (3, 3))
    R = so3.project(scale * M)
    np.testing.assert_allclose(R.T @ R, np.eye(3), rtol=0, atol=32 * EPSILON)
    assert np.linalg.det(R) > 0
    # scipy's polar uses the same decomposition, so the defining property is asked for too: Rᵀ M is symmetric
    # positive definite. LAPACK promises a modest multiple of ε: 52 were seen in 20 000.
    stretch = R.T @ M
    np.testing.assert_allclose(stretch, stretch.T, rtol=0, atol=128 * EPSILON)
    assert (np.linalg.eigvalsh(stretch) > 0).all()
    for step in 1e-3 * np.vstack([np.eye(3), -np.eye(3)]):
        assert np.linalg.norm(M - so3.exp(step) @ R) > np.linalg.norm(M - R)


@pytest.mark.parametrize(
    ("M", "code", "message"),
    [
        (-np.eye(3), "improper", "M is improper: its determinant is -1"),
        (np.diag([1.0, 1.0, -1.0]), "improper", "its determinant is -1"),
        (np.zeros((2, 3, 3)), "singular", r"M\[0\] is singular: its determinant is 0"),
        (np.diag([1.0, 1.0, 0.0]), "singular", "its determinant is 0"),
        (np.diag([1.0, 1.0, 1e-17]), "singular", "its determinant is 1e-17"),
        (np.full((3, 3), np.nan), "not-finite", "not finite"),
    ],
)
def test_project_refuses(M: FloatArray, code: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        so3.project(M)
    assert caught.value.code == code


# ---------------------------------------------------------------------------------------------- arguments


@pytest.mark.parametrize(
    ("R", "message"),
    [
        (np.diag([1.0, 1.0, -1.0]), "R is no rotation: .* det R is -1"),  # Pinocchio's log3 gives 0
        (-np.eye(3), "det R is -1"),
        (1.00001 * np.eye(3), r"entry of \|RᵀR - I\| is 2e-05"),
        (np.zeros((3, 3)), "is 1, det R is 0"),
        (np.full((3, 3), np.nan), "nan"),
        (np.full((3, 3), 1e200), "inf"),
        (np.stack([np.eye(3), 2 * np.eye(3)]), r"R\[1\] is no rotation"),
        (np.array([[[np.eye(3), np.eye(3), -np.eye(3)]]]), r"R\[0, 0, 2\] is no rotation"),
    ],
)
def test_log_refuses_what_is_no_rotation(R: FloatArray, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        so3.log(R)
    assert caught.value.code == "not-a-rotation"


def test_log_takes_single_precision() -> None:
    omega = np.array([0.1, -2.0, 0.3])
    np.testing.assert_allclose(so3.log(so3.exp(omega).astype(np.float32)), omega, rtol=0, atol=1e-6)


@pytest.mark.parametrize("name", ["hat", "ad", "exp", "left_jacobian", "left_jacobian_inverse"])
@pytest.mark.parametrize("value", [1.0, [1, 2], np.zeros((3, 4)), []])
def test_vectors_of_wrong_shape_are_refused(name: str, value: Any) -> None:
    with pytest.raises(InputError, match=rf"so3\.{name}: omega has shape .*expected \(\.\.\., 3\)") as caught:
        getattr(so3, name)(value)
    assert caught.value.code == "shape"
    assert str(np.shape(value)) in str(caught.value)


@pytest.mark.parametrize("name", ["vee", "log", "inverse", "adjoint", "project"])
@pytest.mark.parametrize("value", [1.0, [1, 2, 3], np.zeros((3, 4)), np.eye(4)])
def test_matrices_of_wrong_shape_are_refused(name: str, value: Any) -> None:
    with pytest.raises(InputError, match=rf"so3\.{name}: \w has shape .*expected \(\.\.\., 3, 3\)") as caught:
        getattr(so3, name)(value)
    assert caught.value.code == "shape"


@pytest.mark.parametrize("value", ["abc", [1j, 0, 0], np.array([1j, 0, 0]), [[1], [2, 3]], None, [object()] * 3])
def test_what_is_no_array_of_numbers_is_refused(value: Any) -> None:
    with pytest.raises(InputError, match=r"so3\.exp: omega"):
        so3.exp(value)


@pytest.mark.parametrize("name", ["hat", "exp", "left_jacobian", "left_jacobian_inverse"])
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_nan_stays_in_its_own_matrix(name: str, bad: float) -> None:
    function = getattr(so3, name)
    good = [0.1, 0.2, 0.3]
    result = function([good, [0.0, bad, 1.0]])
    np.testing.assert_array_equal(result[0], function(good))
    assert not np.isfinite(result[1]).all()
    assert np.isnan(result[1]).all() or name == "hat"


@pytest.mark.parametrize("name", ["exp", "left_jacobian", "left_jacobian_inverse"])
@pytest.mark.parametrize("size", [0.0, 5e-324, 1e-310, 1e-160])
def test_tiny_angles_are_first_order(name: str, size: float) -> None:
    """Squares of these underflow. A warning would be an error here."""
    omega = size * np.array([1.0, -2.0, 4.0])
    factor = {"exp": 1.0, "left_jacobian": 0.5, "left_jacobian_inverse": -0.5}[name]
    tolerance = 4 * EPSILON * size + 2 * SPACING
    np.testing.assert_allclose(
        getattr(so3, name)(omega) - np.eye(3), factor * so3.hat(omega), rtol=0, atol=max(tolerance, 1e-300)
    )


# --------------------------------------------------------------------------------- the checks can fail


def _textbook_left_jacobian(omega: FloatArray) -> FloatArray:
    angle, K = ls.angle_of(omega), so3.hat(omega)
    return np.eye(3) + (1 - math.cos(angle)) / angle**2 * K + (angle - math.sin(angle)) / angle**3 * K @ K


def _trace_log(R: FloatArray) -> FloatArray:
    angle = math.acos((np.trace(R) - 1) / 2)
    return angle / math.sin(angle) * so3.vee(R)


@pytest.mark.parametrize(
    ("check", "wrong", "omega"),
    [
        (check_exp, lambda omega: so3.exp(omega).T, [1e-8, 0, 0]),
        (check_exp, lambda omega: np.eye(3) + so3.hat(omega), [1e-4, 0, 0]),
        (check_exp, lambda omega: so3.exp(omega * (1 + 1e-14)), [0, 0, 2.0]),
        (check_left_jacobian, _textbook_left_jacobian, [1e-8, 0, 0]),
        (check_left_jacobian, so3.exp, [1e-8, 0, 0]),
        (check_left_jacobian, lambda _: np.eye(3), [1e-8, 0, 0]),
        (check_left_jacobian, lambda omega: so3.left_jacobian(-omega), [1e-8, 0, 0]),
        (check_log, so3.vee, [1e-6, 0, 0]),
        (check_log, _trace_log, [0, math.pi - 1e-6, 0]),
        (check_log, lambda R: -so3.log(R), [0, 1e-8, 0]),
    ],
)
def test_wrong_formulas_are_caught(check: Callable[[Function, FloatArray], None], wrong: Function, omega: Any) -> None:
    with pytest.raises(AssertionError):
        check(wrong, np.array(omega, dtype=float))


def test_the_textbook_formula_passes_where_it_is_right() -> None:
    """So the failure above is the cancellation's, not the check's."""
    check_left_jacobian(_textbook_left_jacobian, np.array([1.0, 2.0, -1.0]))


def test_the_truth_is_that_of_mpmath_and_scipy() -> None:
    A = ls.hat3(ls.exact([0.3, -1.0, 2.0]))
    exponential, integral = ls.truth(A, 3.0)
    np.testing.assert_allclose(exponential.astype(float), scipy.linalg.expm(A.astype(float)), rtol=0, atol=1e-14)
    with mpmath.workdps(60):
        other = np.array(mpmath.expm(mpmath.matrix(A.tolist()), method="taylor").tolist(), dtype=object)
    assert np.max(np.abs(exponential - other)) < mpmath.mpf(10) ** -45
    # A Σ Aⁿ/(n+1)! = Σ Aⁿ/n! - I
    assert np.max(np.abs(A @ integral - exponential + ls.exact(np.eye(3)))) < mpmath.mpf(10) ** -50
