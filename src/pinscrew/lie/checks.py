"""Reading arguments of the Lie-group functions, and refusing what they can't use."""

from __future__ import annotations

from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from pinscrew.ground.arrays import numbers
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray

__all__ = [
    "SymbolicMatrix",
    "is_symbolic",
    "read",
    "require_bottom_row",
    "require_finite",
    "require_invertible",
    "require_rotation",
    "svd_rotation",
]

EPSILON: Final = float(np.finfo(np.float64).eps)
RIGID_TOLERANCE: Final = 1e-6
"""How far a matrix may be from a rotation or pose to be taken for one: above the rounding of float32, and far
below anything that is wrong on purpose or by mistake."""


class SymbolicMatrix(Protocol):
    """A matrix of sympy's."""

    @property
    def free_symbols(self) -> Any:
        """Its unknowns."""


def is_symbolic(value: object) -> bool:
    """Whether a value is sympy's: known by what it has, so that sympy need not be imported."""
    return type(value) is not np.ndarray and hasattr(value, "free_symbols")


def read(value: ArrayLike, trailing: tuple[int, ...], where: str, name: str) -> FloatArray:
    """The value as float64, refused unless its last axes are the given ones."""
    expected = f"expected (..., {', '.join(map(str, trailing))})"
    array = numbers(value, name, where, expected)
    if array.shape[-len(trailing) :] != trailing:
        raise InputError("shape", f"{name} has shape {array.shape}", where=where, remedy=expected)
    return array


def require_finite(array: FloatArray, axes: int, where: str, name: str) -> None:
    """Refuse NaN and infinity; ``axes`` is the number of trailing axes of one element."""
    index = _first(~np.isfinite(array).all(axis=tuple(range(-axes, 0))))
    if index is not None:
        raise InputError("not-finite", f"{_at(name, index)} is not finite", where=where)


def require_rotation(R: FloatArray, where: str, name: str) -> None:
    """Refuse matrices that are not orthonormal with determinant +1."""
    with np.errstate(over="ignore", invalid="ignore"):
        defect = np.abs(np.swapaxes(R, -1, -2) @ R - np.eye(3)).max(axis=(-2, -1))
        determinant = np.asarray(np.linalg.det(R))
    # A comparison with NaN is false, so the good ones are asked for.
    index = _first(~((defect <= RIGID_TOLERANCE) & (determinant > 0.0)))
    if index is not None:
        raise InputError(
            "not-a-rotation",
            f"{_at(name, index)} is no rotation: the largest entry of |RᵀR - I| is {defect[index]:.3g}, "
            f"det R is {determinant[index]:.6g}",
            where=where,
            remedy=f"expected at most {RIGID_TOLERANCE:g}, and +1; project gives the nearest rotation where det R > 0",
        )


def require_bottom_row(T: FloatArray, where: str, name: str) -> None:
    """Refuse 4 by 4 matrices that are not of the form [[M, p], [0, 1]]."""
    index = _first(~(np.abs(T[..., 3, :] - np.eye(4)[3]).max(axis=-1) <= RIGID_TOLERANCE))
    if index is not None:
        raise InputError(
            "not-a-pose",
            f"{_at(name, index)} has the bottom row {T[index][3].tolist()}",
            where=where,
            remedy="expected [0, 0, 0, 1]",
        )


def require_invertible(angle: FloatArray, where: str, name: str) -> None:
    """Refuse angles at which the left Jacobian is singular."""
    # |sin(θ/2)| is half the distance of θ from the multiple. θ itself is known to 2 ε θ (two hypots), and a
    # caller's 2πk times a unit axis to as much again.
    half = 0.5 * angle
    index = _first((half > 1.0) & (np.abs(np.sin(half)) <= 4.0 * EPSILON * half))
    if index is not None:
        raise InputError(
            "singular",
            f"{_at(name, index)} has the angle {angle[index]:.17g} rad, a multiple of 2π to rounding: "
            "the left Jacobian has no inverse there",
            where=where,
            remedy="use an angle below 2π",
        )


def svd_rotation(M: FloatArray, where: str, name: str) -> FloatArray:
    """The rotation nearest to M, which is refused when improper, singular or not finite."""
    require_finite(M, 2, where, name)
    U, sigma, Vt = np.linalg.svd(M)
    # Rounding M moves its singular values by ε σ₁: below a few of these, the sign of det M means nothing.
    singular = sigma[..., 2] <= 4.0 * EPSILON * sigma[..., 0]
    # The product is ±1, while det M itself underflows for small M.
    index = _first(singular | (np.linalg.det(U) * np.linalg.det(Vt) < 0.0))
    if index is not None:
        kind = "singular" if singular[index] else "improper"
        with np.errstate(over="ignore", invalid="ignore"):
            determinant = float(np.linalg.det(M[index]))
        raise InputError(
            kind,
            f"{_at(name, index)} is {kind}: its determinant is {determinant:.6g}",
            where=where,
            remedy="expected a matrix near a rotation, of determinant near +1",
        )
    return np.asarray(U @ Vt)


def _first(bad: NDArray[np.bool_] | np.bool_) -> tuple[int, ...] | None:
    """The batch index of the first bad element, or ``None``."""
    return tuple(int(i) for i in np.argwhere(bad)[0]) if np.any(bad) else None


def _at(name: str, index: tuple[int, ...]) -> str:
    return f"{name}[{', '.join(map(str, index))}]" if index else name
