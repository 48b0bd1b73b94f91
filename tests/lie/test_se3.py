"""SE(3) against power series at 60 digits, with v and ω scaled apart."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest
import scipy.linalg
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import lie_strategies as ls
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3, so3

EPSILON, SPACING = ls.EPSILON, ls.SPACING
Function = Callable[[Any], FloatArray]

# The 6 by 6 truth takes 30 ms, a batch of twists as long to draw.
few = settings(max_examples=40)

# ---------------------------------------------------------------------------------------------------- checks
# Each check takes the function to check, so that the tests at the end can hand it a wrong one. The linear
# parts are held against ‖v‖, the angular parts against 1.


def check_exp(exp: Function, xi: FloatArray) -> None:
    """R is right to 16 ε + 2 ε θ, as for SO(3); p = J v to 51 ε ‖v‖ at every angle.

    Entries of J are right to 16 ε (see test_so3), and a row has three; the sum rounds 3 times.
    """
    angle, size = ls.angle_of(xi), ls.angle_of(xi[:3])
    expected, _ = ls.truth(ls.hat4(ls.exact(xi)), angle)
    actual = exp(xi)
    np.testing.assert_array_equal(actual[3], [0, 0, 0, 1])
    assert ls.error(actual[:3, :3], expected[:3, :3]) <= (16 + 2 * angle) * EPSILON
    assert ls.error(actual[:3, 3], expected[:3, 3]) <= 51 * EPSILON * size


def check_left_jacobian(left_jacobian: Function, xi: FloatArray) -> None:
    """The blocks J are right to 16 ε, and Q to 32 ε ‖v‖, at every angle.

    The coefficients of Q are bounded by 1/2 and move by less than 4 ε when θ moves by 2 ε θ; they multiply
    four products, of entries at most ‖v‖ that are right to 4 ε: below 32 ε together.
    """
    size = ls.angle_of(xi[:3])
    _, expected = ls.truth(ls.ad6(ls.exact(xi)), ls.angle_of(xi))
    actual = left_jacobian(xi)
    np.testing.assert_array_equal(actual[3:, :3], np.zeros((3, 3)))
    assert ls.error(actual[:3, :3], expected[:3, :3]) <= 16 * EPSILON
    assert ls.error(actual[3:, 3:], expected[3:, 3:]) <= 16 * EPSILON
    assert ls.error(actual[:3, 3:], expected[:3, 3:]) <= 32 * EPSILON * size


def check_log(log: Function, xi: FloatArray) -> None:
    """ω is right to 8 ε θ as for SO(3), and v to 64 ε ‖v‖.

    p is rounded to ε ‖p‖ and ‖p‖ ≤ ‖v‖. Entries of J⁻¹ are at most π/2 up to θ = π and right to 16 ε, and
    they move by 8 ε θ/2 with ω: below 64 ε for a row of three with p.
    """
    angle, size = ls.angle_of(xi), ls.angle_of(xi[:3])
    T, _ = ls.truth(ls.hat4(ls.exact(xi)), angle)
    actual = log(T.astype(float))
    assert ls.error(actual[3:], ls.exact(xi[3:])) <= 8 * EPSILON * angle + 2 * SPACING
    assert ls.error(actual[:3], ls.exact(xi[:3])) <= 64 * EPSILON * size


# ---------------------------------------------------------------------------------------------- exp and log


@given(ls.twists())
def test_exp(xi: FloatArray) -> None:
    check_exp(se3.exp, xi)


@given(ls.twists(st.one_of(ls.SMALL, st.floats(0, 10))))
def test_exp_agrees_with_scipy(xi: FloatArray) -> None:
    xi[:3] /= max(1.0, ls.angle_of(xi[:3]))  # scipy's errors are relative to the norm of the whole matrix
    np.testing.assert_allclose(se3.exp(xi), scipy.linalg.expm(se3.hat(xi)), rtol=0, atol=1e-12)


def test_exp_keeps_small_turns_of_large_translations() -> None:
    """V = I, or V = R, below a threshold on θ would be wrong by 5 mm here."""
    np.testing.assert_allclose(se3.exp([1e6, 0, 0, 0, 0, 1e-8])[:3, 3], [1e6, 5e-3, 0], rtol=0, atol=51 * EPSILON * 1e6)


@given(ls.twists(st.one_of(ls.ZERO, ls.TINY, ls.SMALL, ls.MEETING, st.floats(1.0, math.pi - 1e-14))))
def test_log(xi: FloatArray) -> None:
    assume(ls.angle_of(xi) < math.pi - 1e-14)
    check_log(se3.log, xi)


@few
@given(ls.twists(ls.HALF_TURN))
def test_log_through_the_half_turn(xi: FloatArray) -> None:
    """Either sign of ω: the answer must move as T does."""
    T, _ = ls.truth(ls.hat4(ls.exact(xi)), ls.angle_of(xi))
    actual = se3.log(T.astype(float))
    assert ls.angle_of(actual) <= math.pi * (1 + 2 * EPSILON)
    again, _ = ls.truth(ls.hat4(ls.exact(actual)), math.pi)
    assert np.max(np.abs(again[:3, :3] - T[:3, :3])) <= (8 * math.pi + 1) * EPSILON
    # v as in check_log, times three entries of J, which are at most 1; ‖v‖ here is at most π/2 of ‖p‖.
    assert np.max(np.abs(again[:3, 3] - T[:3, 3])) <= 3 * 64 * EPSILON * ls.angle_of(xi[:3])


def test_log_of_the_identity_is_zero() -> None:
    np.testing.assert_array_equal(se3.log(np.eye(4)), np.zeros(6))


@given(ls.DIRECTIONS, ls.log_uniform(-9, 9))
def test_log_of_a_translation_is_exact(u: FloatArray, size: float) -> None:
    T = np.eye(4)
    T[:3, 3] = size * u
    np.testing.assert_array_equal(se3.log(T), [*T[:3, 3], 0, 0, 0])


# ----------------------------------------------------------------------------------------- left Jacobian


@few
@given(ls.twists())
def test_left_jacobian(xi: FloatArray) -> None:
    check_left_jacobian(se3.left_jacobian, xi)


@few
@given(ls.twists())
def test_left_jacobian_inverse(xi: FloatArray) -> None:
    angle, size = ls.angle_of(xi), ls.angle_of(xi[:3])
    distance = ls.distance_to_full_turn(angle)
    assume(distance > 8 * EPSILON * angle)
    _, jacobian = ls.truth(ls.ad6(ls.exact(xi)), angle)
    J, Q = jacobian[:3, :3], jacobian[:3, 3:]
    inverse = ls.solve(J)
    actual = se3.left_jacobian_inverse(xi)
    # As in test_so3; the corner is of second order in J⁻¹, whose error it has twice.
    scale = max(1.0, float(np.max(np.abs(inverse))))
    condition = 4 * angle / distance
    np.testing.assert_array_equal(actual[3:, :3], np.zeros((3, 3)))
    assert ls.error(actual[:3, :3], inverse) <= (16 + condition) * scale * EPSILON
    assert ls.error(actual[3:, 3:], inverse) <= (16 + condition) * scale * EPSILON
    assert ls.error(actual[:3, 3:], -inverse @ Q @ inverse) <= (32 + 2 * condition) * scale**2 * size * EPSILON


@few
@given(ls.twists(st.one_of(ls.ZERO, ls.SMALL, ls.MEETING, st.floats(0, 30))), ls.twists(st.floats(0, 1)))
def test_left_jacobian_turns_rates_into_spatial_velocity(xi: FloatArray, rate: FloatArray) -> None:
    """d/dt e^(ξ + t ξ')^ at t = 0 is (𝒥 ξ')^ T; central differences at 60 digits are right to h² = 1e-40."""
    step = mpmath.mpf(10) ** -20
    exact, exact_rate, angle = ls.exact(xi), ls.exact(rate), ls.angle_of(xi) + 1
    forward, _ = ls.truth(ls.hat4(exact + step * exact_rate), angle)
    backward, _ = ls.truth(ls.hat4(exact - step * exact_rate), angle)
    T, _ = ls.truth(ls.hat4(exact), angle)
    velocity = (forward - backward) @ ls.solve(T) / (2 * step)
    size = max(ls.angle_of(rate[:3]), ls.angle_of(xi[:3]))
    actual = se3.hat(se3.left_jacobian(xi) @ rate)
    # Rows of three products with J (16 ε) and three with Q (32 ε ‖v‖), rounded 6 times. ‖ω'‖ ≤ 1.
    assert ls.error(actual[:3, :3], velocity[:3, :3]) <= 54 * EPSILON
    assert ls.error(actual[:3, 3], velocity[:3, 3]) <= 150 * EPSILON * size


@pytest.mark.parametrize("turns", [1, 2, 1000])
def test_left_jacobian_inverse_is_refused_at_full_turns(turns: int) -> None:
    xi = np.array([1.0, 2, 3, 0, 2 * math.pi * turns, 0])
    with pytest.raises(InputError, match=r"se3\.left_jacobian_inverse: xi\[1\] has the angle") as caught:
        se3.left_jacobian_inverse([np.ones(6), xi])
    assert caught.value.code == "singular"


# ------------------------------------------------------------------------------------- algebra and group


@given(ls.twists())
def test_hat_and_vee(xi: FloatArray) -> None:
    X = se3.hat(xi)
    np.testing.assert_array_equal(X[:3, :3], so3.hat(xi[3:]))
    np.testing.assert_array_equal(X[:3, 3], xi[:3])
    np.testing.assert_array_equal(X[3], np.zeros(4))
    np.testing.assert_array_equal(se3.vee(X), xi)


def test_vee_reads_neither_the_symmetric_part_nor_the_bottom_row() -> None:
    X = se3.hat([1, 2, 3, 4, 5, 6])
    X[:3, :3] += np.array([[1.0, 2, 3], [2, 4, 5], [3, 5, 6]])
    X[3] = 7
    np.testing.assert_array_equal(se3.vee(X), [1, 2, 3, 4, 5, 6])


@given(ls.twists(), ls.twists())
def test_ad_is_the_bracket(xi: FloatArray, eta: FloatArray) -> None:
    X, Y = se3.hat(xi), se3.hat(eta)
    angular = ls.angle_of(xi) * ls.angle_of(eta)
    linear = ls.angle_of(xi[:3]) * ls.angle_of(eta) + ls.angle_of(xi) * ls.angle_of(eta[:3])
    # Entries of the bracket have up to four products; both sides round them.
    tolerance = 8 * EPSILON * np.repeat([linear, angular], 3)
    assert (np.abs(se3.ad(xi) @ eta - se3.vee(X @ Y - Y @ X)) <= tolerance + 8 * SPACING).all()


@given(ls.twists(), ls.twists())
def test_adjoint_is_conjugation(xi: FloatArray, eta: FloatArray) -> None:
    """T η̂ T⁻¹ = (Ad_T η)^, at whatever scales."""
    T = se3.exp(xi)
    left = T @ se3.hat(eta) @ se3.inverse(T)
    reach = ls.angle_of(T[:3, 3])
    # R's orthogonality (18 ε), two products with rows of three or four, both sides.
    tolerance = 64 * EPSILON * np.repeat([ls.angle_of(eta[:3]) + reach * ls.angle_of(eta), ls.angle_of(eta)], 3)
    tolerance += 16 * SPACING * np.repeat([1 + reach, 1], 3)  # a subnormal ω is moved along p
    assert (np.abs(se3.adjoint(T) @ eta - se3.vee(left)) <= tolerance).all()
    np.testing.assert_array_equal(left[3], np.zeros(4))


@few
@given(ls.twists(ls.SMALL))
def test_adjoint_of_exp_is_the_exponential_of_ad(xi: FloatArray) -> None:
    expected, _ = ls.truth(ls.ad6(ls.exact(xi)), ls.angle_of(xi))
    actual = se3.adjoint(se3.exp(xi))
    assert ls.error(actual[:3, :3], expected[:3, :3]) <= 18 * EPSILON
    # p̂ R: two products of p (51 ε ‖v‖) with R (18 ε).
    assert ls.error(actual[:3, 3:], expected[:3, 3:]) <= 140 * EPSILON * ls.angle_of(xi[:3])


def test_adjoint_by_hand() -> None:
    """A turn about the z axis of b, 2 m along x of a: the point at the origin of a moves to -y."""
    T = np.eye(4)
    T[0, 3] = 2
    np.testing.assert_array_equal(se3.adjoint(T) @ [0, 0, 0, 0, 0, 1], [0, -2, 0, 0, 0, 1])


@few
@given(ls.batches(ls.twists()), st.data())
def test_group_axioms(xi: FloatArray, data: st.DataObject) -> None:
    shape = xi.shape[:-1]
    other, third = (
        np.array([data.draw(ls.twists()) for _ in range(math.prod(shape))]).reshape(xi.shape) for _ in range(2)
    )
    A, B, C = se3.exp(xi), se3.exp(other), se3.exp(third)
    assert A.shape == (*shape, 4, 4)
    # Products with rows of four, of orthogonal matrices (18 ε). Positions add up, and so do their errors.
    reach = 1.0 + sum(np.linalg.norm(X[..., :3, 3], axis=-1) for X in (A, B, C))

    def assert_close(actual: FloatArray, expected: FloatArray) -> None:
        assert (np.abs(actual - expected)[..., :3, :3] <= 64 * EPSILON).all()
        assert (np.abs(actual - expected)[..., :3, 3] <= 64 * EPSILON * reach[..., None]).all()
        np.testing.assert_array_equal(actual[..., 3, :], expected[..., 3, :])

    identity = np.broadcast_to(np.eye(4), A.shape)
    assert_close(A @ se3.inverse(A), identity)
    assert_close(se3.inverse(A) @ A, identity)
    assert_close(A @ identity, A)
    assert_close((A @ B) @ C, A @ (B @ C))
    assert_close(se3.inverse(A @ B), se3.inverse(B) @ se3.inverse(A))
    assert_close(se3.inverse(se3.inverse(A)), A)
    # p of exp is right to 51 ε ‖v‖, which can be far more than ‖p‖.
    reach += np.linalg.norm(xi[..., :3], axis=-1)
    assert_close(se3.exp(-xi), se3.inverse(A))
    product = se3.adjoint(A) @ se3.adjoint(B)
    difference = np.abs(se3.adjoint(A @ B) - product)
    assert (difference[..., :3, :3] <= 64 * EPSILON).all()
    assert (difference[..., 3:, 3:] <= 64 * EPSILON).all()
    assert (difference[..., :3, 3:] <= 64 * EPSILON * reach[..., None, None]).all()
    assert not difference[..., 3:, :3].any()


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
    function = getattr(se3, name)
    argument = np.random.default_rng(1).normal(size=(*shape, 6))
    if name in {"vee", "log", "inverse", "adjoint", "project"}:
        argument = se3.exp(argument)
    before = argument.copy()
    result = function(argument)
    assert result.dtype == np.float64
    assert result.shape[: len(shape)] == shape
    for index in np.ndindex(shape):
        one = function(argument[index].tolist())
        np.testing.assert_allclose(result[index], one, rtol=0, atol=16 * EPSILON)  # SIMD and FMA differ
    result[...] = np.nan
    np.testing.assert_array_equal(argument, before)


# ------------------------------------------------------------------------------------------------ project


def test_project() -> None:
    rng = np.random.default_rng(2)
    T = se3.exp(rng.normal(size=(5, 6)))
    M = T.copy()
    M[:, :3, :3] += rng.uniform(-1e-3, 1e-3, (5, 3, 3))
    M[:, 3] += 1e-9
    projected = se3.project(M)
    np.testing.assert_array_equal(projected[:, :3, :3], so3.project(M[:, :3, :3]))
    np.testing.assert_array_equal(projected[:, :3, 3], M[:, :3, 3])
    np.testing.assert_array_equal(projected[:, 3], np.broadcast_to([0, 0, 0, 1], (5, 4)))
    # Nearest: T is a pose too, at most 3e-3 from M.
    assert (np.linalg.norm(projected - M, axis=(-2, -1)) <= np.linalg.norm(T - M, axis=(-2, -1))).all()
    assert np.isfinite(se3.log(projected)).all()


def _with(value: Any, *index: Any) -> FloatArray:
    T = np.eye(4)
    T[index] = value
    return T


@pytest.mark.parametrize(
    ("M", "code", "message"),
    [
        (_with(-1.0, 2, 2), "improper", "the rotation part of M is improper: its determinant is -1"),
        (_with(0.0, 2, 2), "singular", "determinant is 0"),
        (_with(2.0, 3, 3), "not-a-pose", r"M has the bottom row \[0.0, 0.0, 0.0, 2.0\]"),
        (
            np.stack([np.eye(4), _with(1.0, 3, 0)]),
            "not-a-pose",
            r"M\[1\] has the bottom row \[1.0, 0.0, 0.0, 1.0\]",
        ),
        (_with(np.nan, 0, 3), "not-finite", "M is not finite"),
    ],
)
def test_project_refuses(M: FloatArray, code: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        se3.project(M)
    assert caught.value.code == code


# ---------------------------------------------------------------------------------------------- arguments


@pytest.mark.parametrize(
    ("T", "code", "message"),
    [
        (_with(-1.0, 2, 2), "not-a-rotation", "the rotation part of T is no rotation: .* det R is -1"),
        (_with(1.1, 0, 0), "not-a-rotation", "is 0.21"),
        (_with(2.0, 3, 3), "not-a-pose", "T has the bottom row"),
        (_with(np.nan, 3, 1), "not-a-pose", "T has the bottom row"),
        (_with(np.inf, 1, 3), "not-finite", "the position in T is not finite"),
        (_with(np.nan, 0, 1), "not-a-rotation", "nan"),
        (np.stack([np.eye(4), _with(np.nan, 0, 3)]), "not-finite", r"the position in T\[1\] is not finite"),
    ],
)
def test_log_refuses_what_is_no_pose(T: FloatArray, code: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        se3.log(T)
    assert caught.value.code == code


@pytest.mark.parametrize("name", ["hat", "ad", "exp", "left_jacobian", "left_jacobian_inverse"])
@pytest.mark.parametrize("value", [1.0, [1, 2, 3], np.zeros((6, 7)), []])
def test_twists_of_wrong_shape_are_refused(name: str, value: Any) -> None:
    with pytest.raises(InputError, match=rf"se3\.{name}: xi has shape .*expected \(\.\.\., 6\)") as caught:
        getattr(se3, name)(value)
    assert caught.value.code == "shape"


@pytest.mark.parametrize("name", ["vee", "log", "inverse", "adjoint", "project"])
@pytest.mark.parametrize("value", [1.0, [1, 2, 3, 4], np.zeros((4, 3)), np.eye(3)])
def test_matrices_of_wrong_shape_are_refused(name: str, value: Any) -> None:
    with pytest.raises(InputError, match=rf"se3\.{name}: \w has shape .*expected \(\.\.\., 4, 4\)") as caught:
        getattr(se3, name)(value)
    assert caught.value.code == "shape"


@pytest.mark.parametrize("name", ["hat", "ad", "exp", "left_jacobian", "left_jacobian_inverse"])
@pytest.mark.parametrize("place", [1, 4])
@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_nan_stays_in_its_own_matrix(name: str, place: int, bad: float) -> None:
    function = getattr(se3, name)
    good = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
    spoilt = good.copy()
    spoilt[place] = bad
    result = function([spoilt, good])
    np.testing.assert_array_equal(result[1], function(good))
    assert not np.isfinite(result[0]).all()


@pytest.mark.parametrize("name", ["inverse", "adjoint"])
def test_nan_in_a_pose_stays_in_its_own_matrix(name: str) -> None:
    function = getattr(se3, name)
    result = function([np.eye(4), _with(np.nan, 0, 3)])
    np.testing.assert_array_equal(result[0], function(np.eye(4)))
    assert np.isnan(result[1]).any()


@pytest.mark.parametrize("size", [0.0, 5e-324, 1e-310, 1e-160])
@pytest.mark.parametrize("reach", [1e-9, 1e9])
def test_tiny_angles_translate(size: float, reach: float) -> None:
    """Squares of these angles underflow. A warning would be an error here."""
    xi = np.array([reach, -2 * reach, 0, size, 0, 4 * size])
    expected = np.eye(4)
    expected[:3, 3] = xi[:3]
    np.testing.assert_allclose(se3.exp(xi), expected, rtol=0, atol=1e-150)
    np.testing.assert_allclose(se3.log(se3.exp(xi))[:3], xi[:3], rtol=EPSILON)
    np.testing.assert_allclose(se3.left_jacobian(xi)[:3, 3:], so3.hat(xi[:3] / 2), rtol=EPSILON, atol=1e-150 * reach)


def test_inverse_makes_no_minus_zeros() -> None:
    assert not np.signbit(se3.inverse(np.eye(4))).any()


# --------------------------------------------------------------------------------- the checks can fail


def _exp_with(V: Function) -> Function:
    def exp(xi: FloatArray) -> FloatArray:
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = so3.exp(xi[3:]), V(xi[3:]) @ xi[:3]
        return T

    return exp


def _textbook_V(omega: FloatArray) -> FloatArray:
    angle, K = ls.angle_of(omega), so3.hat(omega)
    return np.eye(3) + (1 - math.cos(angle)) / angle**2 * K + (angle - math.sin(angle)) / angle**3 * K @ K


def _flipped_Q(xi: FloatArray) -> FloatArray:
    return se3.left_jacobian(np.concatenate([-xi[:3], xi[3:]]))


def _swapped(xi: FloatArray) -> FloatArray:
    order = [3, 4, 5, 0, 1, 2]
    return se3.left_jacobian(xi)[np.ix_(order, order)]


def _short_Q(xi: FloatArray) -> FloatArray:
    """The first two terms of Barfoot's four, each by its textbook formula."""
    angle, W, V = ls.angle_of(xi), so3.hat(xi[3:]), so3.hat(xi[:3])
    jacobian = se3.left_jacobian(xi)
    jacobian[:3, 3:] = V / 2 + (angle - math.sin(angle)) / angle**3 * (W @ V + V @ W + W @ V @ W)
    return jacobian


def _log_without_J(T: FloatArray) -> FloatArray:
    return np.concatenate([T[:3, 3], so3.log(T[:3, :3])])


@pytest.mark.parametrize(
    ("check", "wrong", "xi"),
    [
        (check_exp, _exp_with(so3.exp), [1, 0, 0, 0, 0, 1e-8]),  # V = R
        (check_exp, _exp_with(lambda _: np.eye(3)), [1, 0, 0, 0, 0, 1e-8]),
        (check_exp, _exp_with(_textbook_V), [1, 0, 0, 0, 0, 1e-8]),
        (check_exp, _exp_with(_textbook_V), [1e-9, 0, 0, 0, 0, 1e-8]),
        (check_exp, lambda xi: se3.inverse(se3.exp(xi)), [1, 0, 0, 0, 0, 1e-8]),
        (check_exp, lambda xi: se3.exp(np.roll(xi, 3)), [1, 0, 0, 0, 0, 1e-8]),  # (ω, v)
        (check_left_jacobian, _flipped_Q, [1e-9, 0, 0, 0, 0, 1e-8]),
        (check_left_jacobian, _swapped, [1e-9, 0, 0, 0, 0, 1e-8]),
        (check_left_jacobian, _short_Q, [0, 1, 0, 0, 0, 1e-3]),
        (check_left_jacobian, lambda xi: se3.adjoint(se3.exp(xi)), [1, 0, 0, 0, 0, 1e-8]),
        (check_log, _log_without_J, [1, 0, 0, 0, 0, 1e-8]),
        (check_log, lambda T: -se3.log(T), [1, 0, 0, 0, 0, 1e-8]),
    ],
)
def test_wrong_formulas_are_caught(check: Callable[[Function, FloatArray], None], wrong: Function, xi: Any) -> None:
    with pytest.raises(AssertionError):
        check(wrong, np.array(xi, dtype=float))


def test_the_textbook_formula_passes_where_it_is_right() -> None:
    """So the failures above are the cancellation's, not the check's."""
    check_exp(_exp_with(_textbook_V), np.array([1.0, 2.0, 3.0, 1.0, 2.0, -1.0]))


def test_the_truth_is_the_series_itself() -> None:
    A = ls.ad6(ls.exact([1.0, -2.0, 3.0, 0.3, -1.0, 2.0]))
    exponential, integral = ls.truth(A, 3.0)
    term = total = ls.exact(np.eye(6))
    for n in range(1, 80):
        term = term @ A / n
        total = total + term / (n + 1)
    assert np.max(np.abs(integral - total)) < mpmath.mpf(10) ** -50
    np.testing.assert_allclose(exponential.astype(float), scipy.linalg.expm(A.astype(float)), rtol=0, atol=1e-13)
