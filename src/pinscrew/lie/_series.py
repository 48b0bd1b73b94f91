"""exp and the left Jacobians, as functions of the angle times powers of the unit axis.

Since û³ = -û, every power series of ω̂ = θû that begins with I is I + f(θ) û + g(θ) û². With the *unit* axis,
an error of ε in f or g is an error of ε in a matrix of norm near 1, and θ is never squared outside a
polynomial, so that 1e-160 does not underflow and 1e200 does not overflow. NaN passes through.

Series and closed formulas of the coefficients meet at θ = 1. There the closed formulas have lost about 3 bits
to cancellation; below, their absolute error grows as ε/θ. Each series is cut where the first term left out is
below ε/8 of the first term, at θ = 1, with ε = 2.2e-16 and ε/8 = 2.8e-17.
"""

from __future__ import annotations

from math import factorial
from typing import Final

import numpy as np

from pinscrew.ground.typing import FloatArray

__all__ = [
    "axis_angle",
    "exp",
    "left_jacobian",
    "left_jacobian_derivative",
    "left_jacobian_inverse",
    "left_jacobian_inverse_derivative",
    "skew",
]

_MEETING_ANGLE: Final = 1.0

# (θ - sin θ)/θ³ = Σ (-1)ᵏ θ²ᵏ/(2k+3)!. The first term left out, 1/21!, is 1.2e-19 of 1/3!; with one term
# fewer it would be 5e-17.
_SINE_DEFICIT: Final = tuple((-1) ** k / factorial(2 * k + 3) for k in range(9))

# (sin h - h cos h)/h³ = Σ (-1)ᵏ (2k+2) h²ᵏ/(2k+3)!, with h = θ/2 ≤ 1/2. The first term left out, 16/17!/2¹⁴,
# is 8e-18 of 1/3; with one term fewer it would be 8e-15.
_COTANGENT_DEFICIT: Final = tuple((-1) ** k * (2 * k + 2) / factorial(2 * k + 3) for k in range(7))


def axis_angle(omega: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Unit axis u and angle θ ≥ 0 of ω: u = 0 where θ = 0, and both NaN where ω is not finite."""
    with np.errstate(over="ignore"):
        # Squares would underflow at 1e-160.
        angle = np.hypot(np.hypot(omega[..., 0], omega[..., 1]), omega[..., 2])
    angle = np.where(np.isfinite(angle), angle, np.nan)
    return omega / np.where(angle == 0.0, 1.0, angle)[..., None], angle


def skew(a: FloatArray) -> FloatArray:
    """â, with â b = a × b."""
    half = np.zeros((*a.shape, 3))
    half[..., 2, 1], half[..., 0, 2], half[..., 1, 0] = a[..., 0], a[..., 1], a[..., 2]
    # The difference, rather than -a, makes no minus zeros for the printout.
    return half - np.swapaxes(half, -1, -2)


def exp(axis: FloatArray, angle: FloatArray) -> FloatArray:
    """I + sin θ û + (1 - cos θ) û²/‖u‖², with 2 sin²(θ/2) for 1 - cos θ, which loses all digits at θ = 1e-8.

    ‖u‖² is 1 to 3 ε (two hypots and a quotient). Without the division, RᵀR - I is (1 - cos θ)² times that, up
    to 4 times; with it, sin² θ times. Where u = 0, the maximum avoids 0/0.
    """
    square = np.maximum(np.sum(axis * axis, axis=-1), 0.5)
    return _polynomial(axis, np.sin(angle), 2.0 * np.sin(0.5 * angle) ** 2 / square)


def left_jacobian(axis: FloatArray, angle: FloatArray) -> FloatArray:
    """J = I + (1 - cos θ)/θ û + (θ - sin θ)/θ û²."""
    return _polynomial(axis, 0.5 * angle * _sinc(0.5 * angle) ** 2, angle * _sine_deficit(angle))


def left_jacobian_inverse(axis: FloatArray, angle: FloatArray) -> FloatArray:
    """J⁻¹ = I - θ/2 û + (1 - (θ/2) cot(θ/2)) û²."""
    return _polynomial(axis, -0.5 * angle, angle * _cotangent_deficit(angle))


def left_jacobian_derivative(axis: FloatArray, angle: FloatArray, v: FloatArray) -> FloatArray:
    """The derivative of J(ω) along v."""
    b = 0.5 * _sinc(0.5 * angle) ** 2  # (1 - cos θ)/θ²
    c = _sine_deficit(angle)
    return _derivative(axis, v, (b, c), (_sinc(angle) - 2.0 * b, angle * b - 3.0 * c))


def left_jacobian_inverse_derivative(axis: FloatArray, angle: FloatArray, v: FloatArray) -> FloatArray:
    """The derivative of J⁻¹(ω) along v."""
    d = _cotangent_deficit(angle)
    slope = _sine_deficit(angle) / _sinc(0.5 * angle) / _sinc(0.5 * angle)  # of θd, by θ
    zero = np.zeros_like(angle)
    return _derivative(axis, v, (zero - 0.5, d), (zero, slope - 2.0 * d))


def _polynomial(axis: FloatArray, first: FloatArray, second: FloatArray) -> FloatArray:
    """I + first û + second û²."""
    U = skew(axis)
    return np.asarray(np.eye(3) + first[..., None, None] * U + second[..., None, None] * (U @ U))


def _derivative(
    axis: FloatArray,
    v: FloatArray,
    value: tuple[FloatArray, FloatArray],
    slope: tuple[FloatArray, FloatArray],
) -> FloatArray:
    """The derivative of I + g ω̂ + h ω̂² along v: g v̂ + h (ω̂v̂ + v̂ω̂) + (uᵀv)(g' ω̂ + h' ω̂²).

    With ω̂ = θû, ``value`` is (g, θh) and ``slope`` is (θg', θ²h'): all stay bounded.
    """
    U, V = skew(axis), skew(v)
    along = np.sum(axis * v, axis=-1)
    g, h, g_slope, h_slope = (x[..., None, None] for x in (*value, along * slope[0], along * slope[1]))
    return np.asarray(g * V + h * (U @ V + V @ U) + g_slope * U + h_slope * (U @ U))


def _sinc(angle: FloatArray) -> FloatArray:
    """sin θ / θ, and 1 at θ = 0. No series: the quotient has no cancellation, even for a subnormal θ."""
    zero = angle == 0.0
    return np.where(zero, 1.0, np.sin(angle) / np.where(zero, 1.0, angle))


def _sine_deficit(angle: FloatArray) -> FloatArray:
    """(θ - sin θ)/θ², and 0 at θ = 0."""
    small = angle < _MEETING_ANGLE
    near, far = np.where(small, angle, 0.0), np.where(small, _MEETING_ANGLE, angle)
    series = near * _horner(_SINE_DEFICIT, near * near)
    return np.where(small, series, (1.0 - np.sin(far) / far) / far)


def _cotangent_deficit(angle: FloatArray) -> FloatArray:
    """(1 - (θ/2) cot(θ/2))/θ, and 0 at θ = 0. It has poles at the other multiples of 2π."""
    small = angle < _MEETING_ANGLE
    near, far = np.where(small, 0.5 * angle, 0.0), 0.5 * np.where(small, _MEETING_ANGLE, angle)
    # With h = θ/2: (1 - h cot h)/θ = (sin h - h cos h)/(2h sin h).
    series = 0.5 * near * _horner(_COTANGENT_DEFICIT, near * near) / _sinc(near)
    return np.where(small, series, 0.5 * (1.0 / far - np.cos(far) / np.sin(far)))


def _horner(coefficients: tuple[float, ...], x: FloatArray) -> FloatArray:
    """Σ cₖ xᵏ."""
    total = np.full_like(x, coefficients[-1])
    for coefficient in reversed(coefficients[:-1]):
        total = total * x + coefficient
    return total
