"""For the tests of the Lie groups: rotation vectors and twists in all regimes, and the truth from mpmath.

The truth is the power series alone, at 60 digits, with the argument halved until the series converges fast,
and the result doubled back. It shares no formula with pinscrew.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
from hypothesis import strategies as st

from pinscrew.ground.typing import FloatArray

mpmath.mp.dps = 60

EPSILON = float(np.finfo(float).eps)
SPACING = 5e-324  # of subnormal numbers: their products are that much off
BATCHES: tuple[tuple[int, ...], ...] = ((), (3,), (2, 3), (0,))

Series = Callable[[Any], tuple[Any, Any]]

# --------------------------------------------------------------------------------------------------- regimes


def log_uniform(low: float, high: float) -> st.SearchStrategy[float]:
    """10**x with x uniform between the two."""
    return st.floats(low, high).map(lambda x: 10.0**x)


def _near(centre: float, low: float, high: float) -> st.SearchStrategy[float]:
    return st.builds(lambda side, x: centre + side * x, st.sampled_from([-1.0, 1.0]), log_uniform(low, high))


ZERO = st.just(0.0)
TINY = st.sampled_from([5e-324, 1e-310, 1e-160, 1e-30])
SMALL = log_uniform(-12, 0)
MEETING = _near(1.0, -16, -1)  # where series and closed formulas meet
HALF_TURN = st.one_of(st.just(math.pi), _near(math.pi, -16, -9))
FULL_TURN = st.builds(lambda k, x: 2 * math.pi * k * (1 + x), st.integers(1, 100), st.floats(-1e-3, 1e-3))
LARGE = log_uniform(0, 6)

UP_TO_HALF_TURN = st.one_of(
    ZERO,
    TINY,
    SMALL,
    MEETING,
    st.floats(1.0, math.pi),
    st.just(math.pi),
    log_uniform(-15, -9).map(lambda x: math.pi - x),
)
ANGLES = st.one_of(ZERO, TINY, SMALL, MEETING, HALF_TURN, FULL_TURN, LARGE)


def _unit(components: tuple[float, float, float]) -> FloatArray:
    a = np.array(components)
    return a / math.hypot(*a)


_COMPONENT = st.one_of(st.floats(-1, 1), st.sampled_from([0.0, 1.0, -1.0, 1e-8, -1e-16]))
DIRECTIONS = st.tuples(_COMPONENT, _COMPONENT, _COMPONENT).filter(lambda c: math.hypot(*c) > 1e-3).map(_unit)


def rotation_vectors(angles: st.SearchStrategy[float] = ANGLES) -> st.SearchStrategy[FloatArray]:
    return st.builds(lambda angle, u: angle * u, angles, DIRECTIONS)


LINEAR = st.builds(lambda size, u: size * u, st.one_of(ZERO, log_uniform(-9, 9)), DIRECTIONS)


def twists(angles: st.SearchStrategy[float] = ANGLES) -> st.SearchStrategy[FloatArray]:
    """v and ω are drawn apart: neither's scale says anything about the other's."""
    return st.builds(lambda v, omega: np.concatenate([v, omega]), LINEAR, rotation_vectors(angles))


@st.composite
def batches(draw: st.DrawFn, elements: st.SearchStrategy[FloatArray]) -> FloatArray:
    """Elements in one of the batch shapes, the empty one included."""
    shape = draw(st.sampled_from(BATCHES))
    size = draw(elements).shape
    rows = [draw(elements) for _ in range(math.prod(shape))]
    return np.array(rows).reshape(*shape, *size)


# ----------------------------------------------------------------------------------------------------- truth


def exact(array: Any) -> Any:
    """The doubles as mpmath numbers, in an object array."""
    return np.vectorize(mpmath.mpf, otypes=[object])(np.asarray(array, dtype=float))


def hat3(a: Any) -> Any:
    zero = mpmath.mpf(0)
    return np.array([[zero, -a[2], a[1]], [a[2], zero, -a[0]], [-a[1], a[0], zero]], dtype=object)


def hat4(xi: Any) -> Any:
    X = exact(np.zeros((4, 4)))
    X[:3, :3], X[:3, 3] = hat3(xi[3:]), xi[:3]
    return X


def ad6(xi: Any) -> Any:
    X = exact(np.zeros((6, 6)))
    X[:3, :3] = X[3:, 3:] = hat3(xi[3:])
    X[:3, 3:] = hat3(xi[:3])
    return X


def angle_of(xi: Any) -> float:
    return math.hypot(*np.asarray(xi, dtype=float)[-3:])


def truth(A: Any, angle: float) -> tuple[Any, Any]:
    """Σ Aⁿ/n! and Σ Aⁿ/(n+1)!, where ``angle`` is the largest eigenvalue of A in magnitude.

    The eigenvalues of A/2ˢ are below 1/8, and A is a matrix of rotation plus one linear in v whose square
    vanishes; so the terms fall like n 8⁻ⁿ/n!, and the last of 30 is below 1e-57 of the first.
    """
    halvings = max(0, math.ceil(math.log2(angle)) + 3) if angle > 0.0 else 0
    identity = exact(np.eye(len(A)))
    A = A / mpmath.mpf(2) ** halvings
    exponential, integral, term = identity, identity, identity
    for n in range(1, 30):
        term = term @ A / n
        exponential = exponential + term
        integral = integral + term / (n + 1)
    for _ in range(halvings):
        # Σ (2A)ⁿ/(n+1)! is the mean of e^{sA} over 0 ≤ s ≤ 2, in two halves.
        integral = (exponential @ integral + integral) / 2
        exponential = exponential @ exponential
    return exponential, integral


def solve(A: Any) -> Any:
    """The inverse, by mpmath."""
    inverse = mpmath.inverse(mpmath.matrix(A.tolist()))
    return np.array(inverse.tolist(), dtype=object)


def error(actual: FloatArray, expected: Any) -> float:
    """The largest difference of two entries, taken before rounding the truth."""
    return float(np.max(np.abs(exact(actual) - expected)))


def distance_to_full_turn(angle: float) -> float:
    """|θ - 2πk| for the nearest k ≥ 1."""
    turns = max(1, int(mpmath.nint(angle / (2 * mpmath.pi))))
    return float(abs(angle - 2 * mpmath.pi * turns))
