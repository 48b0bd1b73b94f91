"""From a twist back to rates: `pinscrew.inverse_velocity`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt

from pinscrew.ground.arrays import numbers
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.robot.robot import Robot

__all__ = ["InverseVelocity", "Method", "inverse_velocity", "rate_bounds"]

Method: TypeAlias = Literal["normal", "pinv", "damped"]

METHODS: Final[tuple[Method, ...]] = get_args(Method)
RCOND: Final = 1e-10
"""Singular values below this times the largest count as zero: far above rounding, far below what a robot uses."""
NORMAL_RCOND: Final = 1e-7
"""The same for the normal equations, which square the condition number."""
_WHERE: Final = "inverse_velocity"


@dataclass(frozen=True, eq=False)
class InverseVelocity:
    """Rates for a twist, and how well they could be found. Batch axes ``...`` are those of the question.

    Attributes:
        qd: the rates (rad/s and m/s), shape (..., n).
        residual: J θ̇ - V, shape (..., 6), m/s and rad/s.
        singular_values: of the Jacobian with its rows and columns weighted, largest first, shape (..., k), where k is
            the smaller of n and the number of rows with a weight.
        rank: how many of them exceed ``rcond`` times the largest, shape (...).
        damping: the λ that was used, shape (...); 0 but for ``"damped"``.
        scale: what the rates were multiplied by to stay within bounds, shape (...); 1 where they were.
    """

    qd: FloatArray
    residual: FloatArray
    singular_values: FloatArray
    rank: npt.NDArray[np.intp]
    damping: FloatArray
    scale: FloatArray

    @property
    def linear_error(self) -> FloatArray:
        """Norm of the residual's linear part (m/s), shape (...)."""
        return np.asarray(np.linalg.norm(self.residual[..., :3], axis=-1))

    @property
    def angular_error(self) -> FloatArray:
        """Norm of the residual's angular part (rad/s), shape (...)."""
        return np.asarray(np.linalg.norm(self.residual[..., 3:], axis=-1))

    @property
    def condition(self) -> FloatArray:
        """Largest over smallest singular value, shape (...); infinite where the smallest is 0."""
        largest, smallest = self.singular_values[..., 0], self.singular_values[..., -1]
        return np.asarray(np.divide(largest, smallest, out=np.full(largest.shape, np.inf), where=smallest > 0.0))

    @property
    def manipulability(self) -> FloatArray:
        """Product of the singular values, √det(JᵀJ) for n ≤ 6, shape (...).

        Yoshikawa, "Manipulability of Robotic Mechanisms", IJRR 4(2), 1985, doi:10.1177/027836498500400201.
        """
        return np.asarray(np.prod(self.singular_values, axis=-1))


def inverse_velocity(
    J: ArrayLike,
    V: ArrayLike,
    method: Method = "pinv",
    *,
    task_weights: ArrayLike | None = None,
    joint_weights: ArrayLike | None = None,
    length: float = 1.0,
    null: ArrayLike | None = None,
    rcond: float | None = None,
    damping: float = 0.05,
    threshold: float = 0.05,
    bounds: tuple[ArrayLike, ArrayLike] | None = None,
) -> InverseVelocity:
    """The rates θ̇ whose twist J θ̇ comes nearest to V.

    ==========  ===================================================================================================
    method      rates
    ==========  ===================================================================================================
    normal      (JᵀJ)⁻¹ Jᵀ V, as the velocity kinematics assignment prints it; J must have full column rank
    pinv        J⁺ V by singular values: of the rates with the least ‖J θ̇ - V‖ those with the least ‖θ̇‖
    damped      Jᵀ(JJᵀ + λ²I)⁻¹ V, the least ‖J θ̇ - V‖² + λ²‖θ̇‖²: bounded near singularities, not exact there
    ==========  ===================================================================================================

    J and V stand for W_x^½ S J W_q^-½ and W_x^½ S V in all of them, and the rates for W_q^-½ times theirs, so that
    the weighted sums ‖W_x^½ S (Jθ̇ - V)‖ and ‖W_q^½ θ̇‖ are least. S divides metres by ``length``. Without it, a
    metre and a radian count the same, as in the assignment. None of this matters where V can be reached in one way.

    Damping is λ² = λ₀² (1 - (σ/ε)²) where the smallest singular value σ is below ε, and 0 elsewhere: Chiaverini,
    Siciliano and Egeland, IEEE Trans. Control Systems Technology 2(2), 1994, doi:10.1109/87.294335; damped least
    squares are Nakamura and Hanafusa's, J. Dyn. Sys. Meas. Control 108(3), 1986, doi:10.1115/1.3143764.

    Args:
        J: Jacobian, shape (..., 6, n), rows (v, ω).
        V: twist (v, ω) of the same kind, shape (..., 6), m/s and rad/s; batch axes broadcast.
        method: see the table.
        task_weights: diagonal of W_x, shape (6,), not negative; 0 leaves a component of the twist free.
        joint_weights: diagonal of W_q, shape (n,), positive; the larger, the less a joint is used.
        length: metres that count as much as a radian.
        null: rates z that a redundant robot would like, shape (..., n). Their part in the null space is added,
            (I - J⁺J) z, which does not change the twist.
        rcond: singular values below this times the largest count as zero; by default 1e-10, and 1e-7 for ``normal``.
        damping: λ₀, the damping at a singularity, for ``damped``.
        threshold: ε, below which singular values are damped, for ``damped``.
        bounds: lower and upper bounds of the rates, shapes (..., n), with 0 between them; see `rate_bounds`. All
            rates are scaled down together until they are within, so that the twist keeps its direction, and a joint
            that must not move stops all. ``scale`` says by how much.

    Raises:
        InputError: if shapes don't match, a number is not finite or out of range, there is no such method, or J has no
            full column rank for ``normal``.
    """
    if method not in METHODS:
        raise InputError("method", f"there is no method {method!r}", where=_WHERE, remedy=f"use {', '.join(METHODS)}")
    jacobian, twist = _read(J, "J", 2), _read(V, "V", 1)
    n = jacobian.shape[-1]
    if jacobian.shape[-2] != 6 or twist.shape[-1] != 6 or n == 0:
        what = f"J has shape {jacobian.shape} and V has {twist.shape}"
        raise InputError("shape", what, where=_WHERE, remedy="expected (..., 6, n) with n at least 1, and (..., 6)")
    wish = None if null is None else _vector(null, "null", n)
    low_high = None if bounds is None else _bounds(bounds, n)
    batch = _batch(jacobian.shape[:-2], twist, wish, *(low_high or ()))
    rows = _weights(task_weights, "task_weights", 6) * np.repeat([1.0 / _positive(length, "length") ** 2, 1.0], 3)
    rows = np.sqrt(rows)
    columns = 1.0 / np.sqrt(_weights(joint_weights, "joint_weights", n, zero=False))
    # A row without weight asks for nothing, and would count as a lost direction: it is left out.
    active = rows > 0.0
    if not active.any():
        raise InputError("weights", "all task_weights are 0", where=_WHERE, remedy="give one of them a weight")
    # With y = W_q^½ θ̇, the least ‖W_x^½ S (J θ̇ - V)‖ and ‖W_q^½ θ̇‖ are the least ‖A y - b‖ and ‖y‖.
    A = (rows[:, None] * jacobian * columns)[..., active, :]
    b = np.broadcast_to((rows * twist)[..., active], (*batch, int(active.sum())))
    limit = (NORMAL_RCOND if method == "normal" else RCOND) if rcond is None else _positive(rcond, "rcond")
    U, sigma, Vt = np.linalg.svd(A, full_matrices=False)
    kept = sigma > limit * sigma[..., :1]
    damped = np.zeros(sigma.shape[:-1])
    if method == "normal":
        _require_full_rank(kept, n)
        At = np.swapaxes(A, -1, -2)
        y = np.linalg.solve(At @ A, At @ b[..., None])[..., 0]
    else:
        if method == "damped":
            damped = _damping(sigma[..., -1], _positive(damping, "damping"), _positive(threshold, "threshold"))
        # A = U Σ Vᵀ: Jᵀ(JJᵀ + λ²I)⁻¹ = V diag(σ / (σ² + λ²)) Uᵀ, which for λ = 0 is J⁺ = V diag(1/σ) Uᵀ.
        power = sigma**2 + damped[..., None] ** 2
        # With damping, small singular values are tamed and none is cut off but where nothing is left of it.
        wanted = kept if method == "pinv" else power > 0.0
        inverse = np.divide(sigma, power, out=np.zeros_like(sigma), where=wanted)
        y = _apply(np.swapaxes(Vt, -1, -2), inverse * _apply(np.swapaxes(U, -1, -2), b))
    if wish is not None:
        # (I - A⁺A) z = z - V Vᵀz over the σ that count: no twist of the weighted task comes of it.
        z = wish / columns
        y = y + z - _apply(np.swapaxes(Vt, -1, -2), kept * _apply(Vt, z))
    qd = columns * y
    scale = np.ones(batch) if low_high is None else _scale(qd, *low_high)
    qd = np.broadcast_to(qd, (*batch, n)) * scale[..., None]
    rank = np.broadcast_to(kept.sum(axis=-1), batch)
    values = np.broadcast_to(sigma, (*batch, sigma.shape[-1]))
    return InverseVelocity(qd, _apply(jacobian, qd) - twist, values, rank, np.broadcast_to(damped, batch), scale)


def rate_bounds(robot: Robot, q: ArrayLike, dt: float) -> tuple[FloatArray, FloatArray]:
    """Bounds of the rates that keep a robot within its limits over the next step, for `inverse_velocity`.

    Both the joints' velocity limits, those of joints that follow others among them, and, over ``dt``, those of the
    coordinates. A coordinate outside its limits may stay or come back.

    Args:
        robot: a robot without floating and planar joints.
        q: coordinates, shape (..., nq).
        dt: the step (s).

    Returns:
        lower and upper bounds, each of shape (..., nv), rad/s and m/s; infinite where there are none.

    Raises:
        InputError: if the robot has floating or planar joints, ``q`` has another shape or is not finite, or ``dt`` is
            not positive.
    """
    if robot.nq != robot.nv or any(motion.freedoms > 1 for motion in robot.mechanism.motions):
        what = "it has floating or planar joints, whose rates are no rates of coordinates"
        raise InputError("bounds", what, where=robot.name)
    values = _vector(q, "q", robot.nq)
    step = _positive(dt, "dt")
    speeds = np.full(robot.nv, np.inf)
    for motion in robot.mechanism.motions:
        if motion.multiplier != 0.0:
            # A follower moves at m θ̇, and its own limit holds too: |m| |θ̇| ≤ limit.
            own = motion.joint.limits.velocity / abs(motion.multiplier)
            speeds[motion.v] = min(speeds[motion.v], own)
    lower, upper = robot.limits.T
    # q + θ̇ dt stays within [lower, upper]; 0 stays allowed for a coordinate that is outside already.
    return (
        np.minimum(np.maximum(-speeds, (lower - values) / step), 0.0),
        np.maximum(np.minimum(speeds, (upper - values) / step), 0.0),
    )


def _damping(smallest: FloatArray, largest: float, threshold: float) -> FloatArray:
    """λ where the smallest singular value is below the threshold, else 0."""
    return np.asarray(largest * np.sqrt(np.maximum(0.0, 1.0 - (smallest / threshold) ** 2)))


def _scale(qd: FloatArray, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """The largest factor up to 1 with which all rates are within their bounds."""
    # One factor for all, since J (s θ̇) = s J θ̇: the twist keeps its direction. Example: rates (2, 1) with bounds
    # of ±1 become (1, ½), and not (1, 1), which is another motion.
    bound = np.where(qd > 0.0, upper, lower)
    outside = (qd > upper) | (qd < lower)
    factors = np.divide(bound, qd, out=np.ones(outside.shape), where=outside)
    return np.asarray(factors.min(axis=-1))


def _require_full_rank(kept: npt.NDArray[np.bool_], n: int) -> None:
    rank = kept.sum(axis=-1)
    if (rank < n).any():
        what = f"J has rank {int(rank.min())} and {n} columns, so JᵀJ has no inverse"
        raise InputError("singular", what, where=_WHERE, remedy="use the method 'pinv' or 'damped'")


def _apply(A: FloatArray, x: FloatArray) -> FloatArray:
    return np.asarray((A @ x[..., None])[..., 0])


def _read(values: ArrayLike, name: str, axes: int) -> FloatArray:
    array = numbers(values, name, _WHERE)
    if array.ndim < axes:
        what = f"{name} has shape {array.shape}"
        raise InputError("shape", what, where=_WHERE, remedy=f"expected {axes} axes or more")
    if not np.isfinite(array).all():
        raise InputError("not-finite", f"{name} holds NaN or infinity", where=_WHERE, remedy="give finite numbers")
    return array


def _vector(values: ArrayLike, name: str, n: int) -> FloatArray:
    array = _read(values, name, 1)
    if array.shape[-1] != n:
        raise InputError("shape", f"{name} has shape {array.shape}", where=_WHERE, remedy=f"expected (..., {n})")
    return array


def _weights(values: ArrayLike | None, name: str, n: int, *, zero: bool = True) -> FloatArray:
    if values is None:
        return np.ones(n)
    array = _vector(values, name, n)
    if array.ndim != 1 or not ((array >= 0.0) & (zero | (array > 0.0))).all():
        remedy = f"expected {n} numbers, {'none negative' if zero else 'all positive'}"
        raise InputError("weights", f"{name} = {np.array2string(array)}", where=_WHERE, remedy=remedy)
    return array


def _bounds(bounds: tuple[ArrayLike, ArrayLike], n: int) -> tuple[FloatArray, FloatArray]:
    try:
        low, high = bounds
    except (TypeError, ValueError):
        raise InputError("bounds", "bounds are no two arrays", where=_WHERE, remedy="give lower, upper") from None
    lower, upper = numbers(low, "the lower bound", _WHERE), numbers(high, "the upper bound", _WHERE)
    if lower.shape[-1:] != (n,) or upper.shape[-1:] != (n,):
        what = f"bounds have shapes {lower.shape} and {upper.shape}"
        raise InputError("shape", what, where=_WHERE, remedy=f"expected (..., {n}) twice")
    if not ((lower <= 0.0).all() and (upper >= 0.0).all()):
        raise InputError("bounds", "0 is not between the bounds", where=_WHERE, remedy="standing still must be allowed")
    return lower, upper


def _positive(value: float, name: str) -> float:
    number = float(_read(value, name, 0))
    if not number > 0.0:
        raise InputError("not-positive", f"{name} = {number:g}", where=_WHERE, remedy="expected a positive number")
    return number


def _batch(first: tuple[int, ...], *others: FloatArray | None) -> tuple[int, ...]:
    """The common batch axes of a Jacobian and of vectors."""
    shapes = [first, *(other.shape[:-1] for other in others if other is not None)]
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError:
        listed = ", ".join(map(str, shapes))
        raise InputError("shape", f"the batch axes {listed} do not broadcast", where=_WHERE) from None
