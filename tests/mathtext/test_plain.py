"""Formulas as people type them and programs have them: values by hand, and what is refused and where."""

from __future__ import annotations

import math

import pytest

from pinscrew.ground.errors import InputError
from pinscrew.mathtext import evaluate, read_plain, symbols

X, Y, A = 0.7, -1.3, 0.4
VALUES = {"x": X, "y": Y, "theta1": A, "q[0]": 5.0, "q(1)": 6.0, "arm_len": 7.0, "η": 8.0}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("x - (y - 1)", X - (Y - 1)),
        ("x - y - 1", X - Y - 1),
        ("-x**2", -(X**2)),
        ("x^-2", X**-2),
        ("x.^2.*y./arm_len", X**2 * Y / 7),
        ("x/y*theta1", X / Y * A),
        ("x/y/theta1", X / Y / A),
        ("x*y/theta1", X * Y / A),
        ("x / (2*y)", X / (2 * Y)),
        ("2 x (y + 1)", 2 * X * (Y + 1)),
        ("2x(y + 1)x", 2 * X * (Y + 1) * X),
        ("2.0*x + .5e1", 2 * X + 5),
        ("1e-3x", 1e-3 * X),
        ("2.*x", 2 * X),
        ("cos(x)**2 + math.sin(x)**2", 1.0),
        ("np.tan(theta1)*sympy.pi", math.tan(A) * math.pi),
        ("pow(x, 2) + sqrt(x*x) + M_PI", X**2 + X + math.pi),
        ("q[0] - q(1)*η", 5.0 - 48.0),
        ("+x", X),
    ],
)
def test_values(text: str, value: float) -> None:
    read = read_plain(text, ("q",))
    assert evaluate(read, {name: VALUES[name] for name in symbols(read)}) == pytest.approx(value, 1e-15)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("", 1),
        ("x +", 4),
        ("(x", 3),
        ("x)", 2),
        ("(x]", 3),
        ("x @ y", 3),
        ("x 2", 3),
        ("x / y x", 7),
        ("x**y**2", 5),
        ("x - - y", 5),
        ("x * -y", 5),
        ("x -* y", 4),
        ("cos x", 5),
        ("pow(x)", 6),
        ("pow(x, y", 9),
        ("os.name", 1),
        ("q", 2),
        ("q[i]", 2),
        ("q(1", 2),
        ("q[1)", 2),
        ("x[1]", 2),
        ("__import__('os')", 12),
        ("x;y", 2),
        ("1.2.3", 4),
    ],
)
def test_what_cannot_be_read_is_refused_with_its_place(text: str, place: int) -> None:
    with pytest.raises(InputError) as refused:
        read_plain(text, ("q",))
    assert refused.value.code == "formula"
    assert refused.value.where == f"character {place} of the formula"


@pytest.mark.parametrize("text", ["2 x", "x (y)", "2(x)"])
def test_programs_need_a_sign(text: str) -> None:
    with pytest.raises(InputError, match="a sign is missing"):
        read_plain(text, side_by_side=False)


def test_length_is_not_depth_and_depth_is_bounded() -> None:
    for sign in ("*", "+", "-"):
        evaluate(read_plain("x" + f"{sign}x" * 9_999), {"x": 1.0})
    assert evaluate(read_plain("(" * 60 + "x" + ")" * 60), {"x": X}) == X
    for text in ("(" * 61 + "x" + ")" * 61, "x" + "/x" * 61, "(" * 100_001, "cos(" * 9_999, "x**" * 9_999, "-" * 99):
        with pytest.raises(InputError):
            read_plain(text)
