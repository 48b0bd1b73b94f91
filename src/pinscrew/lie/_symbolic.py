"""The Lie-group functions of sympy matrices, exactly. Loaded only when one is given.

‖ω‖ needs no sign: R and p are even functions of it, so any square root of ωᵀω will do, and e^ω̂θ of a unit ω comes out
in θ rather than in |θ|. Where ωᵀω is zero identically, ξ is a translation; otherwise symbols stand for values at which
it is not.
"""

from __future__ import annotations

from typing import Any

import sympy as sp
from sympy.functions.elementary.trigonometric import TrigonometricFunction

from pinscrew.ground.errors import InputError

__all__ = [
    "pose",
    "pose_adjoint",
    "pose_inverse",
    "read",
    "rotation",
    "skew",
    "twist",
    "twist_ad",
    "twist_matrix",
    "unskew",
]


def read(value: Any, shape: tuple[int, int], where: str, name: str) -> sp.ImmutableMatrix:
    """The value as a matrix, refused unless it is one of sympy's of that shape."""
    expected = f"expected a sympy matrix of shape {shape}"
    if not isinstance(value, sp.MatrixBase):
        raise InputError("shape", f"{name} is a {type(value).__name__} of sympy", where=where, remedy=expected)
    if value.shape != shape:
        raise InputError("shape", f"{name} has shape {value.shape}", where=where, remedy=expected)
    return sp.ImmutableMatrix(value)


def skew(a: sp.ImmutableMatrix) -> sp.ImmutableMatrix:
    """â, with â b = a × b."""
    x, y, z = a
    return sp.ImmutableMatrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def unskew(X: sp.ImmutableMatrix) -> sp.ImmutableMatrix:
    """The a of the skew part of X."""
    twice = X - X.T
    return sp.ImmutableMatrix([twice[2, 1], twice[0, 2], twice[1, 0]]) / 2


def rotation(omega: sp.ImmutableMatrix) -> sp.ImmutableMatrix:
    """I + sin θ û + (1 - cos θ) û²; MLS eq. 2.14."""
    angle = _root(omega)
    if angle == 0:
        return sp.ImmutableMatrix(sp.eye(3))
    U = skew(_over(omega, angle))
    return sp.ImmutableMatrix(sp.eye(3) + sp.sin(angle) * U + (1 - sp.cos(angle)) * U * U)


def pose(xi: sp.ImmutableMatrix) -> sp.ImmutableMatrix:
    """[[R, (I - R)(u × w) + u uᵀ w θ], [0, 1]] with v = θw, ω = θu; MLS eq. 2.36. [[I, v], [0, 1]] where ω = 0."""
    v, omega = xi[:3, :], xi[3:, :]
    R, angle = rotation(omega), _root(omega)
    if angle == 0:
        return _affine(R, v, 1)
    w, u = _over(v, angle), _over(omega, angle)
    return _affine(R, (sp.eye(3) - R) * u.cross(w) + u * (u.dot(w) * angle), 1)


def twist_matrix(xi: sp.ImmutableMatrix) -> sp.ImmutableMatrix:
    """[[ω̂, v], [0, 0]]."""
    return _affine(skew(xi[3:, :]), xi[:3, :], 0)


def twist(X: sp.ImmutableMatrix) -> sp.ImmutableMatrix:
    """ξ = (v, ω) of a matrix ξ̂."""
    return sp.ImmutableMatrix.vstack(X[:3, 3], unskew(X[:3, :3]))


def pose_inverse(T: sp.ImmutableMatrix) -> sp.ImmutableMatrix:
    """[[Rᵀ, -Rᵀp], [0, 1]]."""
    R = T[:3, :3]
    return _affine(R.T, -R.T * T[:3, 3], 1)


def pose_adjoint(T: sp.ImmutableMatrix) -> sp.ImmutableMatrix:
    """[[R, p̂R], [0, R]]; MLS eq. 2.58."""
    R = T[:3, :3]
    return _dual(R, skew(T[:3, 3]) * R)


def twist_ad(xi: sp.ImmutableMatrix) -> sp.ImmutableMatrix:
    """[[ω̂, v̂], [0, ω̂]]."""
    return _dual(skew(xi[3:, :]), skew(xi[:3, :]))


def _root(omega: sp.ImmutableMatrix) -> sp.Expr:
    """A square root of ωᵀω, without one wherever a factor of it is a square."""
    square = sp.factor(omega.dot(omega))
    if square.has(TrigonometricFunction):
        square = sp.factor(sp.trigsimp(square))
    number, factors = square.as_coeff_Mul()
    powers = ((base, power / 2) for base, power in factors.as_powers_dict().items())
    return sp.sqrt(number) * sp.Mul(*(base**power for base, power in powers))


def _over(vector: sp.ImmutableMatrix, divisor: sp.Expr) -> sp.ImmutableMatrix:
    """A vector divided, with what is common to both cancelled."""
    return vector.applyfunc(lambda x: sp.factor(x) / divisor)


def _affine(A: Any, b: Any, corner: int) -> sp.ImmutableMatrix:
    return sp.ImmutableMatrix(sp.Matrix.vstack(sp.Matrix.hstack(A, b), sp.Matrix([[0, 0, 0, corner]])))


def _dual(A: sp.ImmutableMatrix, B: sp.ImmutableMatrix) -> sp.ImmutableMatrix:
    return sp.ImmutableMatrix(sp.Matrix.vstack(sp.Matrix.hstack(A, B), sp.Matrix.hstack(sp.zeros(3), A)))
