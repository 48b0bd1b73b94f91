"""SE(3): poses T, shape ``(..., 4, 4)``, and twists ξ = (v, ω), shape ``(..., 6)``: linear part first.

``T_a_b = [[R, p], [0, 1]]`` takes the coordinates of a point from frame b to frame a. Lengths are in metres,
angles in radians. Murray–Li–Sastry, Barfoot and Pinocchio have the order (v, ω); Lynch–Park have (ω, v).

Accuracy: rotations as in :mod:`so3`. The p of :func:`exp`, the corner of :func:`left_jacobian` and the v of
:func:`log` are right to a few ε = 2.2e-16 of ‖v‖, at every angle and whatever the scale of v beside ω.

The 6 by 6 functions follow from SO(3) by the principle of transference: ad_ξ = [[ω̂, v̂], [0, ω̂]] is the matrix
ω̂ + δv̂ of dual numbers, δ² = 0, so a power series f of it has f(ω̂) on the diagonal, and in the corner the
derivative of f(ω̂) along v.

NaN stays in its own matrix of the batch, and infinity in :func:`exp` and the Jacobians gives NaN. :func:`log`
and :func:`project` check their argument and refuse both.

Sources: Murray, Li, Sastry, *A Mathematical Introduction to Robotic Manipulation*, CRC 1994 (MLS), §2.3–2.4;
Barfoot, *State Estimation for Robotics*, Cambridge 2017, §7.1.
"""

from __future__ import annotations

from typing import Any, overload

import numpy as np

from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.lie import _series, checks, so3

__all__ = [
    "ad",
    "adjoint",
    "exp",
    "hat",
    "inverse",
    "left_jacobian",
    "left_jacobian_inverse",
    "log",
    "project",
    "vee",
]


@overload
def hat(xi: checks.SymbolicMatrix) -> Any: ...
@overload
def hat(xi: ArrayLike) -> FloatArray: ...
def hat(xi: Any) -> Any:
    """The matrix ξ̂ = [[ω̂, v], [0, 0]]; MLS §2.3.

    Args:
        xi: ξ = (v, ω), shape ``(..., 6)``.

    Returns:
        Shape ``(..., 4, 4)``.

    Raises:
        InputError: if the last axis is not 6 long.
    """
    if checks.is_symbolic(xi):
        from pinscrew.lie import _symbolic

        return _symbolic.twist_matrix(_symbolic.read(xi, (6, 1), "se3.hat", "xi"))
    xi = checks.read(xi, (6,), "se3.hat", "xi")
    return _affine(_series.skew(xi[..., 3:]), xi[..., :3], 0.0)


@overload
def vee(X: checks.SymbolicMatrix) -> Any: ...
@overload
def vee(X: ArrayLike) -> FloatArray: ...
def vee(X: Any) -> Any:
    """The ξ = (v, ω) of a matrix ξ̂: the inverse of :func:`hat`; MLS §2.3.

    Only the last column and the skew part of the rest are read, without the bottom row.

    Args:
        X: shape ``(..., 4, 4)``.

    Returns:
        ξ, shape ``(..., 6)``.

    Raises:
        InputError: if the last two axes are not 4 by 4.
    """
    if checks.is_symbolic(X):
        from pinscrew.lie import _symbolic

        return _symbolic.twist(_symbolic.read(X, (4, 4), "se3.vee", "X"))
    X = checks.read(X, (4, 4), "se3.vee", "X")
    return np.concatenate([X[..., :3, 3], so3.vee(X[..., :3, :3])], axis=-1)


@overload
def exp(xi: checks.SymbolicMatrix) -> Any: ...
@overload
def exp(xi: ArrayLike) -> FloatArray: ...
def exp(xi: Any) -> Any:
    """The pose e^ξ̂ = [[e^ω̂, J v], [0, 1]], with the left Jacobian J of SO(3); MLS eq. 2.36.

    Args:
        xi: ξ = (v, ω), shape ``(..., 6)``, m and rad.

    Returns:
        T, shape ``(..., 4, 4)``.

    Raises:
        InputError: if the last axis is not 6 long.
    """
    if checks.is_symbolic(xi):
        from pinscrew.lie import _symbolic

        return _symbolic.pose(_symbolic.read(xi, (6, 1), "se3.exp", "xi"))
    v, axis, angle = _split(checks.read(xi, (6,), "se3.exp", "xi"))
    return _affine(_series.exp(axis, angle), _times(_series.left_jacobian(axis, angle), v), 1.0)


def log(T: ArrayLike) -> FloatArray:
    """The twist ξ = (v, ω) with e^ξ̂ = T and ‖ω‖ ≤ π: ω by :func:`so3.log`, v = J⁻¹(ω) p; MLS prop. 2.9.

    At a half-turn, ω has the sign that :func:`so3.log` gives it.

    Args:
        T: shape ``(..., 4, 4)``, a pose.

    Returns:
        ξ, shape ``(..., 6)``, m and rad.

    Raises:
        InputError: if the last two axes are not 4 by 4, if :func:`so3.log` refuses the rotation part, if the
            bottom row differs from (0, 0, 0, 1) by more than 1e-6, or if p is not finite.
    """
    T = checks.read(T, (4, 4), "se3.log", "T")
    R, p = T[..., :3, :3], T[..., :3, 3]
    checks.require_rotation(R, "se3.log", "the rotation part of T")
    checks.require_bottom_row(T, "se3.log", "T")
    checks.require_finite(p, 1, "se3.log", "the position in T")
    omega = so3._log(R)
    v = _times(_series.left_jacobian_inverse(*_series.axis_angle(omega)), p)
    return np.concatenate([v, omega], axis=-1)


@overload
def inverse(T: checks.SymbolicMatrix) -> Any: ...
@overload
def inverse(T: ArrayLike) -> FloatArray: ...
def inverse(T: Any) -> Any:
    """The inverse pose [[Rᵀ, -Rᵀp], [0, 1]]. T is not checked.

    Args:
        T: T_a_b, shape ``(..., 4, 4)``.

    Returns:
        T_b_a, shape ``(..., 4, 4)``.

    Raises:
        InputError: if the last two axes are not 4 by 4.
    """
    if checks.is_symbolic(T):
        from pinscrew.lie import _symbolic

        return _symbolic.pose_inverse(_symbolic.read(T, (4, 4), "se3.inverse", "T"))
    T = checks.read(T, (4, 4), "se3.inverse", "T")
    R_transposed = np.swapaxes(T[..., :3, :3], -1, -2)
    return _affine(R_transposed, 0.0 - _times(R_transposed, T[..., :3, 3]), 1.0)


@overload
def adjoint(T: checks.SymbolicMatrix) -> Any: ...
@overload
def adjoint(T: ArrayLike) -> FloatArray: ...
def adjoint(T: Any) -> Any:
    """Ad_T = [[R, p̂R], [0, R]]; MLS eq. 2.58. It takes a twist from frame b to frame a: T ξ̂ T⁻¹ = (Ad_T ξ)^.

    Args:
        T: T_a_b, shape ``(..., 4, 4)``; it is not checked.

    Returns:
        Shape ``(..., 6, 6)``, for twists (v, ω).

    Raises:
        InputError: if the last two axes are not 4 by 4.
    """
    if checks.is_symbolic(T):
        from pinscrew.lie import _symbolic

        return _symbolic.pose_adjoint(_symbolic.read(T, (4, 4), "se3.adjoint", "T"))
    T = checks.read(T, (4, 4), "se3.adjoint", "T")
    R = T[..., :3, :3]
    return _dual(R, _series.skew(T[..., :3, 3]) @ R)


@overload
def ad(xi: checks.SymbolicMatrix) -> Any: ...
@overload
def ad(xi: ArrayLike) -> FloatArray: ...
def ad(xi: Any) -> Any:
    """ad_ξ = [[ω̂, v̂], [0, ω̂]]: the bracket [ξ̂, η̂] = ξ̂ η̂ - η̂ ξ̂ is the hat of ad_ξ η.

    Args:
        xi: ξ = (v, ω), shape ``(..., 6)``.

    Returns:
        Shape ``(..., 6, 6)``, for twists (v, ω).

    Raises:
        InputError: if the last axis is not 6 long.
    """
    if checks.is_symbolic(xi):
        from pinscrew.lie import _symbolic

        return _symbolic.twist_ad(_symbolic.read(xi, (6, 1), "se3.ad", "xi"))
    xi = checks.read(xi, (6,), "se3.ad", "xi")
    return _dual(_series.skew(xi[..., 3:]), _series.skew(xi[..., :3]))


def left_jacobian(xi: ArrayLike) -> FloatArray:
    """𝒥 = Σ ad_ξⁿ/(n+1)! = [[J, Q], [0, J]]; Barfoot §7.1, whose Q is the derivative of J(ω) along v.

    When ξ changes at the rate ξ', T = e^ξ̂ moves with the spatial velocity 𝒥 ξ', that is, (𝒥 ξ')^ = T' T⁻¹.

    Args:
        xi: ξ = (v, ω), shape ``(..., 6)``, m and rad.

    Returns:
        𝒥, shape ``(..., 6, 6)``, for twists (v, ω).

    Raises:
        InputError: if the last axis is not 6 long.
    """
    v, axis, angle = _split(checks.read(xi, (6,), "se3.left_jacobian", "xi"))
    return _dual(_series.left_jacobian(axis, angle), _series.left_jacobian_derivative(axis, angle, v))


def left_jacobian_inverse(xi: ArrayLike) -> FloatArray:
    """𝒥⁻¹ = [[J⁻¹, -J⁻¹QJ⁻¹], [0, J⁻¹]]; Barfoot §7.1. The corner is the derivative of J⁻¹(ω) along v.

    𝒥 is singular at θ = 2π, 4π, …: near such an angle the relative error of J⁻¹ is about ε θ / abs(θ - 2πk), and
    that of the corner is twice that.

    Args:
        xi: ξ = (v, ω), shape ``(..., 6)``, m and rad.

    Returns:
        𝒥⁻¹, shape ``(..., 6, 6)``, for twists (v, ω).

    Raises:
        InputError: if the last axis is not 6 long, or if θ is a non-zero multiple of 2π as far as a double
            can tell: abs(θ - 2πk) ≤ 4 ε θ.
    """
    v, axis, angle = _split(checks.read(xi, (6,), "se3.left_jacobian_inverse", "xi"))
    checks.require_invertible(angle, "se3.left_jacobian_inverse", "xi")
    corner = _series.left_jacobian_inverse_derivative(axis, angle, v)
    return _dual(_series.left_jacobian_inverse(axis, angle), corner)


def project(M: ArrayLike) -> FloatArray:
    """The pose nearest to a nearly rigid matrix, in the Frobenius norm.

    The rotation part goes through :func:`so3.project`, the position is kept, and the bottom row becomes
    (0, 0, 0, 1).

    Args:
        M: shape ``(..., 4, 4)``.

    Returns:
        T, shape ``(..., 4, 4)``.

    Raises:
        InputError: if the last two axes are not 4 by 4, if :func:`so3.project` refuses the rotation part, if
            the bottom row differs from (0, 0, 0, 1) by more than 1e-6, or if M is not finite.
    """
    M = checks.read(M, (4, 4), "se3.project", "M")
    checks.require_finite(M, 2, "se3.project", "M")
    checks.require_bottom_row(M, "se3.project", "M")
    return _affine(checks.svd_rotation(M[..., :3, :3], "se3.project", "the rotation part of M"), M[..., :3, 3], 1.0)


def _split(xi: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """v (NaN where infinite), unit axis and angle."""
    v = xi[..., :3]
    return np.where(np.isfinite(v), v, np.nan), *_series.axis_angle(xi[..., 3:])


def _times(A: FloatArray, x: FloatArray) -> FloatArray:
    return np.asarray((A @ x[..., None])[..., 0])


def _affine(A: FloatArray, b: FloatArray, corner: float) -> FloatArray:
    """[[A, b], [0, corner]], 4 by 4."""
    X = np.zeros((*b.shape[:-1], 4, 4))
    X[..., :3, :3], X[..., :3, 3], X[..., 3, 3] = A, b, corner
    return X


def _dual(A: FloatArray, B: FloatArray) -> FloatArray:
    """[[A, B], [0, A]], 6 by 6: the dual-number matrix A + δB."""
    X = np.zeros((*A.shape[:-2], 6, 6))
    X[..., :3, :3], X[..., :3, 3:], X[..., 3:, 3:] = A, B, A
    return X
