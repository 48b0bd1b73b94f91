"""SO(3): rotations R, shape ``(..., 3, 3)``, and rotation vectors ω, shape ``(..., 3)``, in radians.

``R_a_b`` takes the coordinates of a vector from frame b to frame a. ω = θu has the angle θ ≥ 0 and the unit
axis u.

Accuracy, with ε = 2.2e-16: :func:`exp` is right to a few ε for angles up to 2π, and to about ε θ beyond,
since rounding the components of ω turns by that much; ‖RᵀR - I‖ stays below 18 ε at every angle.
:func:`left_jacobian`, and :func:`log` up to its largest angle π, are right to a few ε.

A NaN gives NaN in its own matrix of the batch, and an infinite ω does too. :func:`log` and :func:`project`
check their argument and refuse both.

Sources: Murray, Li, Sastry, *A Mathematical Introduction to Robotic Manipulation*, CRC 1994 (MLS), §2.2;
Barfoot, *State Estimation for Robotics*, Cambridge 2017, §7.1; Shepperd, "Quaternion from Rotation Matrix",
J. Guidance and Control 1(3), 1978, doi:10.2514/3.55767b.
"""

from __future__ import annotations

from typing import Any, overload

import numpy as np

from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.lie import _series, checks

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
def hat(omega: checks.SymbolicMatrix) -> Any: ...
@overload
def hat(omega: ArrayLike) -> FloatArray: ...
def hat(omega: Any) -> Any:
    """The skew matrix ω̂ with ω̂ a = ω × a; MLS §2.2.

    Args:
        omega: ω, shape ``(..., 3)``.

    Returns:
        Shape ``(..., 3, 3)``.

    Raises:
        InputError: if the last axis is not 3 long.
    """
    if checks.is_symbolic(omega):
        from pinscrew.lie import _symbolic

        return _symbolic.skew(_symbolic.read(omega, (3, 1), "so3.hat", "omega"))
    return _series.skew(checks.read(omega, (3,), "so3.hat", "omega"))


@overload
def vee(X: checks.SymbolicMatrix) -> Any: ...
@overload
def vee(X: ArrayLike) -> FloatArray: ...
def vee(X: Any) -> Any:
    """The ω of a skew matrix: the inverse of :func:`hat`.

    Only the skew part (X - Xᵀ)/2 is read; a symmetric part is ignored without an error.

    Args:
        X: shape ``(..., 3, 3)``.

    Returns:
        ω, shape ``(..., 3)``.

    Raises:
        InputError: if the last two axes are not 3 by 3.
    """
    if checks.is_symbolic(X):
        from pinscrew.lie import _symbolic

        return _symbolic.unskew(_symbolic.read(X, (3, 3), "so3.vee", "X"))
    X = checks.read(X, (3, 3), "so3.vee", "X")
    twice = X - np.swapaxes(X, -1, -2)
    return 0.5 * np.stack([twice[..., 2, 1], twice[..., 0, 2], twice[..., 1, 0]], axis=-1)


@overload
def exp(omega: checks.SymbolicMatrix) -> Any: ...
@overload
def exp(omega: ArrayLike) -> FloatArray: ...
def exp(omega: Any) -> Any:
    """The rotation R = e^ω̂ = I + sin θ û + (1 - cos θ) û² (Rodrigues); MLS eq. 2.14.

    Args:
        omega: ω, shape ``(..., 3)``, rad.

    Returns:
        R, shape ``(..., 3, 3)``.

    Raises:
        InputError: if the last axis is not 3 long.
    """
    if checks.is_symbolic(omega):
        from pinscrew.lie import _symbolic

        return _symbolic.rotation(_symbolic.read(omega, (3, 1), "so3.exp", "omega"))
    axis, angle = _series.axis_angle(checks.read(omega, (3,), "so3.exp", "omega"))
    return _series.exp(axis, angle)


def log(R: ArrayLike) -> FloatArray:
    """The rotation vector ω with e^ω̂ = R and ‖ω‖ ≤ π, by the unit quaternion (Shepperd) and atan2.

    At a half-turn both signs of the axis are right. When R is exactly symmetric, the component of ω that is
    largest in magnitude (the first of equals) is positive; otherwise the skew part of R decides, however
    small.

    Args:
        R: shape ``(..., 3, 3)``, a rotation.

    Returns:
        ω, shape ``(..., 3)``, rad.

    Raises:
        InputError: if the last two axes are not 3 by 3, if an entry of RᵀR - I exceeds 1e-6, or if det R < 0.
    """
    R = checks.read(R, (3, 3), "so3.log", "R")
    checks.require_rotation(R, "so3.log", "R")
    return _log(R)


@overload
def inverse(R: checks.SymbolicMatrix) -> Any: ...
@overload
def inverse(R: ArrayLike) -> FloatArray: ...
def inverse(R: Any) -> Any:
    """Rᵀ, the inverse of a rotation. R is not checked.

    Args:
        R: R_a_b, shape ``(..., 3, 3)``.

    Returns:
        R_b_a, shape ``(..., 3, 3)``.

    Raises:
        InputError: if the last two axes are not 3 by 3.
    """
    if checks.is_symbolic(R):
        from pinscrew.lie import _symbolic

        return _symbolic.read(R, (3, 3), "so3.inverse", "R").T
    return np.swapaxes(checks.read(R, (3, 3), "so3.inverse", "R"), -1, -2).copy()


@overload
def adjoint(R: checks.SymbolicMatrix) -> Any: ...
@overload
def adjoint(R: ArrayLike) -> FloatArray: ...
def adjoint(R: Any) -> Any:
    """Ad_R, which is R itself: R ω̂ Rᵀ is the hat of R ω; MLS lemma 2.1. R is not checked.

    Args:
        R: R_a_b, shape ``(..., 3, 3)``.

    Returns:
        A copy of R, shape ``(..., 3, 3)``.

    Raises:
        InputError: if the last two axes are not 3 by 3.
    """
    if checks.is_symbolic(R):
        from pinscrew.lie import _symbolic

        return _symbolic.read(R, (3, 3), "so3.adjoint", "R")
    return checks.read(R, (3, 3), "so3.adjoint", "R").copy()


@overload
def ad(omega: checks.SymbolicMatrix) -> Any: ...
@overload
def ad(omega: ArrayLike) -> FloatArray: ...
def ad(omega: Any) -> Any:
    """ad_ω, which is ω̂: the bracket [ω̂, â] = ω̂ â - â ω̂ is the hat of ω × a.

    Args:
        omega: ω, shape ``(..., 3)``.

    Returns:
        Shape ``(..., 3, 3)``.

    Raises:
        InputError: if the last axis is not 3 long.
    """
    if checks.is_symbolic(omega):
        from pinscrew.lie import _symbolic

        return _symbolic.skew(_symbolic.read(omega, (3, 1), "so3.ad", "omega"))
    return _series.skew(checks.read(omega, (3,), "so3.ad", "omega"))


def left_jacobian(omega: ArrayLike) -> FloatArray:
    """J = Σ ω̂ⁿ/(n+1)! = I + (1 - cos θ)/θ û + (θ - sin θ)/θ û²; Barfoot §7.1.

    When ω changes at the rate ω', R = e^ω̂ turns with the angular velocity J ω', in the frame a of R_a_b.

    Args:
        omega: ω, shape ``(..., 3)``, rad.

    Returns:
        J, shape ``(..., 3, 3)``.

    Raises:
        InputError: if the last axis is not 3 long.
    """
    axis, angle = _series.axis_angle(checks.read(omega, (3,), "so3.left_jacobian", "omega"))
    return _series.left_jacobian(axis, angle)


def left_jacobian_inverse(omega: ArrayLike) -> FloatArray:
    """J⁻¹ = I - θ/2 û + (1 - (θ/2) cot(θ/2)) û²; Barfoot §7.1.

    J is singular at θ = 2π, 4π, …: near such an angle the relative error is about ε θ / abs(θ - 2πk).

    Args:
        omega: ω, shape ``(..., 3)``, rad.

    Returns:
        J⁻¹, shape ``(..., 3, 3)``.

    Raises:
        InputError: if the last axis is not 3 long, or if θ is a non-zero multiple of 2π as far as a double
            can tell: abs(θ - 2πk) ≤ 4 ε θ.
    """
    axis, angle = _series.axis_angle(checks.read(omega, (3,), "so3.left_jacobian_inverse", "omega"))
    checks.require_invertible(angle, "so3.left_jacobian_inverse", "omega")
    return _series.left_jacobian_inverse(axis, angle)


def project(M: ArrayLike) -> FloatArray:
    """The rotation nearest to M in the Frobenius norm: U Vᵀ of the singular value decomposition U Σ Vᵀ.

    Args:
        M: shape ``(..., 3, 3)``, with det M > 0. Its scale does not matter.

    Returns:
        R, shape ``(..., 3, 3)``.

    Raises:
        InputError: if the last two axes are not 3 by 3, or if M is improper (det < 0), singular to rounding
            or not finite.
    """
    return checks.svd_rotation(checks.read(M, (3, 3), "so3.project", "M"), "so3.project", "M")


def _log(R: FloatArray) -> FloatArray:
    """log of what is known to be a rotation."""
    # 4 q qᵀ for the quaternion q = (w, x, y, z). Its rows are parallel to q; the row of the largest diagonal
    # entry (at least 1) has lost nothing to cancellation (Shepperd). Only ratios are used, so it is not
    # normalised.
    trace = np.trace(R, axis1=-2, axis2=-1)
    outer = np.empty((*R.shape[:-2], 4, 4))
    outer[..., 0, 0] = 1.0 + trace
    outer[..., 0, 1:] = outer[..., 1:, 0] = 2.0 * vee(R)
    outer[..., 1:, 1:] = R + np.swapaxes(R, -1, -2) + (1.0 - trace)[..., None, None] * np.eye(3)
    pivot = np.argmax(np.diagonal(outer, axis1=-2, axis2=-1), axis=-1)
    row = np.take_along_axis(outer, pivot[..., None, None], axis=-2)[..., 0, :]
    w, vector = row[..., 0], row[..., 1:]
    axis, length = _series.axis_angle(vector)
    angle = 2.0 * np.arctan2(length, np.abs(w))
    return np.asarray(np.where(w < 0.0, -angle, angle)[..., None] * axis)
