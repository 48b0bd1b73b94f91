"""Screws against their definition: pitch, point and magnitude of a twist, and the motion that it makes."""

from __future__ import annotations

import math
from dataclasses import FrozenInstanceError
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import lie_strategies as ls
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.lie.screw import Screw

EPSILON = ls.EPSILON

REVOLUTE = [0, -0.4, 0, 0, 0, 1]  # a turn about z, 0.4 m along x


def exact_screw(xi: FloatArray) -> tuple[Any, Any, Any, Any]:
    """Point, direction, pitch and magnitude by the formulas of MLS §2.3.3, at 60 digits."""
    v, omega = ls.exact(xi[:3]), ls.exact(xi[3:])
    square = omega @ omega
    size = mpmath.sqrt(square)
    return ls.hat3(omega) @ v / square, omega / size, omega @ v / square, size


@given(ls.twists(st.one_of(ls.SMALL, ls.LARGE, st.just(1e-160))))
def test_from_twist(xi: FloatArray) -> None:
    screw = Screw.from_twist(xi)
    point, direction, pitch, magnitude = exact_screw(xi)
    # Each of the few operations on a scalar rounds to ε; point and pitch cancel against ‖v‖/‖ω‖.
    scale = 8 * EPSILON * ls.angle_of(xi[:3]) / ls.angle_of(xi)
    assert ls.error(screw.point, point) <= scale
    assert ls.error(screw.direction, direction) <= 2 * EPSILON
    assert abs(screw.pitch - pitch) <= scale
    assert abs(screw.magnitude - magnitude) <= 2 * EPSILON * magnitude


@given(ls.twists(st.one_of(ls.ZERO, ls.SMALL, ls.LARGE)))
def test_twist_gives_the_twist_back(xi: FloatArray) -> None:
    assume(xi.any())
    again = Screw.from_twist(xi).twist()
    assert (np.abs(again[:3] - xi[:3]) <= 16 * EPSILON * ls.angle_of(xi[:3])).all()
    assert (np.abs(again[3:] - xi[3:]) <= 4 * EPSILON * ls.angle_of(xi)).all()


@given(ls.DIRECTIONS, ls.DIRECTIONS, st.floats(-2, 2), ls.log_uniform(-6, 1), st.floats(-3, 3))
def test_a_screw_moves_its_own_points_along_itself(
    point: FloatArray, direction: FloatArray, pitch: float, magnitude: float, along: float
) -> None:
    """Under e^ξ̂ the points of the line move by h M u, and vectors along it stay."""
    screw = Screw.through(point, direction, pitch, magnitude)
    T = se3.exp(screw.twist())
    q = point + along * direction
    # se3.exp is right to 51 ε ‖v‖ and 16 ε + 2 ε θ; ‖v‖ ≤ 3 M and ‖q‖ ≤ 4.
    tolerance = (51 * 3 * magnitude + (16 + 2 * magnitude) * 3 * 4 + 8) * EPSILON
    np.testing.assert_allclose((T @ [*q, 1])[:3], q + pitch * magnitude * direction, rtol=0, atol=tolerance)
    np.testing.assert_allclose(T[:3, :3] @ direction, direction, rtol=0, atol=tolerance)


@given(ls.twists(st.one_of(ls.SMALL, ls.LARGE)))
def test_the_point_is_the_one_nearest_to_the_origin(xi: FloatArray) -> None:
    screw = Screw.from_twist(xi)
    assert abs(screw.point @ screw.direction) <= 8 * EPSILON * ls.angle_of(xi[:3]) / ls.angle_of(xi)


def test_a_revolute_axis() -> None:
    screw = Screw.from_twist(REVOLUTE)
    np.testing.assert_array_equal(screw.point, [0.4, 0, 0])
    np.testing.assert_array_equal(screw.direction, [0, 0, 1])
    assert (screw.pitch, screw.magnitude) == (0.0, 1.0)
    np.testing.assert_array_equal(screw.twist(), REVOLUTE)


def test_a_prismatic_axis() -> None:
    screw = Screw.from_twist([0, 3, 4, 0, 0, 0])
    np.testing.assert_array_equal(screw.point, [0, 0, 0])
    np.testing.assert_array_equal(screw.direction, [0, 0.6, 0.8])
    assert (screw.pitch, screw.magnitude) == (math.inf, 5.0)
    np.testing.assert_array_equal(screw.twist(), [0, 3, 4, 0, 0, 0])


def test_only_an_exact_zero_is_a_translation() -> None:
    assert Screw.from_twist([1, 0, 0, 0, 0, 0]).pitch == math.inf
    faint = Screw.from_twist([1, 0, 0, 0, 0, 1e-300])
    assert faint.pitch == 0.0
    np.testing.assert_allclose(faint.point, [0, 1e300, 0], rtol=2 * EPSILON)
    np.testing.assert_allclose(faint.twist(), [1, 0, 0, 0, 0, 1e-300], rtol=2 * EPSILON)
    assert Screw.from_twist([0, 0, 1e-200, 0, 0, 5e-324]).pitch == pytest.approx(1e-200 / 5e-324)


@pytest.mark.parametrize("size", [5e-324, 1e-310, 1e-160, 1e300])
def test_directions_are_unit_at_every_scale(size: float) -> None:
    for xi in ([0, 0, 0, size, size, -size], [size, size, -size, 0, 0, 0]):
        np.testing.assert_allclose(Screw.from_twist(xi).direction, np.array([1, 1, -1]) / math.sqrt(3), rtol=4e-16)


def test_through_normalises() -> None:
    screw = Screw.through([0.4, 0, 7], [0, 0, -20])
    np.testing.assert_array_equal(screw.direction, [0, 0, -1])
    np.testing.assert_array_equal(screw.point, [0.4, 0, 7])
    np.testing.assert_array_equal(screw.twist(), [0, 0.4, 0, 0, 0, -1])
    assert not np.signbit(screw.twist()[[0, 2, 3, 4]]).any()


def test_isclose_compares_motions_and_not_points() -> None:
    screw = Screw.from_twist(REVOLUTE)
    assert screw.isclose(screw)
    assert screw.isclose(Screw.through([0.4, 0, 7], [0, 0, 2]))
    assert Screw.through([1, 2, 3], [0, 1, 0], math.inf).isclose(Screw.through([0, 0, 0], [0, 1, 0], math.inf))
    for other in (
        Screw.through([0.4, 1e-8, 0], [0, 0, 1]),
        Screw.through([0.4, 0, 0], [0, 0, -1]),
        Screw.through([0.4, 0, 0], [0, 1e-8, 1]),
        Screw.through([0.4, 0, 0], [0, 0, 1], 1e-8),
        Screw.through([0.4, 0, 0], [0, 0, 1], math.inf),
        Screw.through([0.4, 0, 0], [0, 0, 1], 0.0, 1 + 1e-8),
    ):
        assert not screw.isclose(other)
        assert not other.isclose(screw)
    assert screw.isclose(Screw.through([0.4, 1e-8, 0], [0, 0, 1]), atol=1e-7)


def test_isclose_sees_far_lines_with_their_own_rounding() -> None:
    xi = [1, 0, 0, 0, 0, 1e-9]
    assert Screw.from_twist(xi).isclose(Screw.from_twist(Screw.from_twist(xi).twist()))
    assert not Screw.from_twist(xi).isclose(Screw.from_twist([1 + 1e-8, 0, 0, 0, 0, 1e-9]))


def test_screws_are_values() -> None:
    point = np.zeros(3)
    screw = Screw.through(point, [0, 0, 1])
    point[0] = 1
    assert screw.point[0] == 0
    with pytest.raises(ValueError, match="read-only"):
        screw.point[0] = 1
    with pytest.raises(FrozenInstanceError):
        screw.pitch = 1.0  # type: ignore[misc]
    assert screw != Screw.through([0, 0, 0], [0, 0, 1])
    assert len({screw, screw}) == 1


@pytest.mark.parametrize(
    ("screw", "words"),
    [
        (
            Screw.from_twist(REVOLUTE),
            "rotation about the line through (0.4, 0, 0) m along (0, 0, 1), magnitude 1 rad",
        ),
        (Screw.from_twist([0, 0, 2, 0, 0, 0]), "translation along (0, 0, 1), magnitude 2 m"),
        (
            Screw.through([0, 0, 0], [1, 0, 0], 0.25, 2),
            "screw of pitch 0.25 m/rad about the line through (0, 0, 0) m along (1, 0, 0), magnitude 2 rad",
        ),
    ],
)
def test_str_says_what_it_is(screw: Screw, words: str) -> None:
    assert str(screw) == words


def test_repr_can_be_evaluated() -> None:
    for xi in (REVOLUTE, [1, 2, 3, 0.1, 0.2, 0.3], [0, 0, 2, 0, 0, 0]):
        screw = Screw.from_twist(xi)
        again = eval(repr(screw), {"Screw": Screw, "inf": math.inf})  # noqa: S307
        np.testing.assert_array_equal(again.twist(), screw.twist())


@pytest.mark.parametrize(
    ("make", "code", "message"),
    [
        (lambda: Screw.from_twist(np.zeros(6)), "zero-twist", "xi is zero"),
        (lambda: Screw.from_twist([0, 0, np.nan, 0, 0, 1]), "not-finite", "xi is not finite"),
        (lambda: Screw.from_twist([0, 0, 1, 0, 0, np.inf]), "not-finite", "xi is not finite"),
        (lambda: Screw.from_twist([1, 2, 3]), "shape", r"xi has shape \(3,\).*6"),
        (lambda: Screw.from_twist(np.ones((2, 6))), "shape", r"xi has shape \(2, 6\); expected \(6,\)"),
        (lambda: Screw.from_twist([1e300, 0, 0, 0, 0, 1e-300]), "overflow", "set it to zero if"),
        (lambda: Screw.from_twist([0, 0, 1e300, 0, 0, 1e-300]), "overflow", "ω has the length 1e-300"),
        (lambda: Screw.through([0, 0, 0], [0, 0, 0]), "zero-direction", "direction is zero"),
        (lambda: Screw.through([0, 0], [0, 0, 1]), "shape", "point has shape"),
        (lambda: Screw.through([0, 0, np.inf], [0, 0, 1]), "not-finite", "point is not finite"),
        (lambda: Screw.through([0, 0, 0], [0, 0, 1], math.nan), "pitch", "pitch is nan"),
        (lambda: Screw.through([0, 0, 0], [0, 0, 1], -math.inf), "pitch", "reverse the direction"),
        (
            lambda: Screw.through([0, 0, 0], [0, 0, 1], 0.0, 0.0),
            "magnitude",
            "magnitude is 0.0; expected a positive",
        ),
        (lambda: Screw.through([0, 0, 0], [0, 0, 1], 0.0, -1.0), "magnitude", "reverse the direction"),
        (lambda: Screw.through([0, 0, 0], [0, 0, 1], 0.0, math.nan), "magnitude", "nan"),
        (lambda: Screw(np.zeros(3), np.array([0, 0, 2.0])), "not-unit", r"length 2; .*Screw.through"),
    ],
)
def test_refusals(make: Any, code: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        make()
    assert caught.value.code == code


@pytest.mark.parametrize(
    "wrong",
    [
        lambda screw: Screw.through(-screw.point, screw.direction, screw.pitch),
        lambda screw: Screw.through(screw.point, -screw.direction, screw.pitch),
        lambda screw: Screw.through(screw.point, screw.direction, -screw.pitch),
    ],
)
def test_the_geometry_catches_flipped_signs(wrong: Any) -> None:
    """What test_a_screw_moves_its_own_points_along_itself looks at is far off for a wrong screw."""
    screw = Screw.through([1, 0, 0], [0, 0, 1], 0.5)
    moved = se3.exp(wrong(screw).twist()) @ [*screw.point, 1]
    assert np.abs(moved[:3] - screw.point - screw.pitch * screw.direction).max() > 0.1
