r"""LaTeX read as formulas: values by hand, what is refused and where, and texts that mean harm."""

from __future__ import annotations

import math

import numpy as np
import pytest

from pinscrew.ground.errors import InputError
from pinscrew.mathtext import evaluate, read_latex, read_latex_matrix, symbols

X, Y, A = 0.7, -1.3, 0.4
VALUES = {"x": X, "y": Y, "theta_1": A, "dot theta_1": 2.5, "c_12": 0.25, "L_0": 3.0, "s_theta_1": 0.5, "arm_len": 7.0}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2", 2.0),
        (".5 x", 0.5 * X),
        ("1.25x", 1.25 * X),
        ("x - y + 1", X - Y + 1),
        ("x - y - 1", X - Y - 1),
        ("-x y", -X * Y),
        ("-x^2", -(X**2)),
        ("+x", X),
        ("xy", X * Y),
        ("x(y + 1)", X * (Y + 1)),
        ("x - (y - 1)", X - (Y - 1)),
        (r"\left(x + y\right)\left[x - y\right]", (X + Y) * (X - Y)),
        (r"\frac{x}{y} + \tfrac{1}{2} \cdot 3", X / Y + 1.5),
        (r"x / y", X / Y),
        ("x y / 2", X * Y / 2),
        (r"\sqrt{x^{2} + y^2}", math.hypot(X, Y)),
        (r"\cos\theta_1 x", math.cos(A) * X),
        (r"\sin \theta_{1}", math.sin(A)),
        (r"\tan(\theta_1 + x)", math.tan(A + X)),
        (r"\cos^2 \theta_1 + \sin^{2}(\theta_1)", 1.0),
        (r"\dot{\theta}_{1} x", 2.5 * X),
        (r"\dot\theta_1", 2.5),
        (r"\dot{\theta_1}", 2.5),
        ("c_{12} L_0", 0.75),
        (r"s_{\theta_1}", 0.5),
        (r"\mathrm{arm\_len}", 7.0),
        (r"2 \cdot 10^{3} \times x * y", 2000 * X * Y),
        (r"\pi x\, y\quad", math.pi * X * Y),
    ],
)
def test_values(text: str, value: float) -> None:
    read = read_latex(text)
    assert evaluate(read, {name: VALUES.get(name, math.nan) for name in symbols(read)}) == pytest.approx(value, 1e-15)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("", 1),
        ("x +", 4),
        ("(x", 3),
        ("x)", 2),
        ("(x]", 3),
        ("x @ y", 3),
        (r"\frac1", 7),
        (r"\frac123", 8),
        ("x^12", 3),
        ("x_12", 3),
        (r"\foo x", 1),
        (r"\cos 2 x", 6),
        (r"\cos x^2", 7),
        (r"\cos^{-1} x", 11),
        ("x 2", 3),
        ("x / y z", 7),
        ("x / y / z", 7),
        (r"\frac x", 8),
        (r"\sqrt[3]{x}", 6),
        (r"\dot{\dot{x}}", 6),
        ("x_", 3),
        ("x_{}", 5),
        ("x_{1", 5),
        ("x^", 3),
        ("x - - y", 5),
        (r"\def\a{\a\a}\a", 1),
    ],
)
def test_what_cannot_be_read_is_refused_with_its_place(text: str, place: int) -> None:
    with pytest.raises(InputError) as refused:
        read_latex(text)
    assert refused.value.code == "formula"
    assert refused.value.where == f"character {place} of the formula"


@pytest.mark.parametrize("unit", ["(", "{", r"\sqrt{", r"\frac{", "x^{", r"\dot", "x_{", "-", "\\"])
def test_endless_texts_end_in_one_error(unit: str) -> None:
    for times in (10_000, 100_000):
        with pytest.raises(InputError):
            read_latex(unit * times)


def test_depth_is_bounded_and_length_is_not_depth() -> None:
    assert evaluate(read_latex("(" * 60 + "x" + ")" * 60), VALUES) == X
    with pytest.raises(InputError, match="60 parentheses"):
        read_latex("(" * 61 + "x" + ")" * 61)
    assert evaluate(read_latex("(x)" + "+ (x)" * 9_999), VALUES) == pytest.approx(10_000 * X)


@pytest.mark.parametrize("text", ["9^{9^{9}}", r"\frac{x}{0}", r"\sqrt{0 - x}", "9" * 500])
def test_what_has_no_finite_value(text: str) -> None:
    with pytest.raises(InputError, match="no finite value"):
        evaluate(read_latex(text), VALUES)


def test_symbols_without_a_value_are_named() -> None:
    with pytest.raises(InputError, match="'z' has no value"):
        evaluate(read_latex("x + z"), VALUES)


def test_values_broadcast() -> None:
    grid = np.linspace(0.0, 1.0, 5)
    np.testing.assert_allclose(
        evaluate(read_latex("x y + 1"), {"x": grid, "y": grid[:, None]}), np.outer(grid, grid) + 1
    )


def test_matrices() -> None:
    rows = read_latex_matrix(r" \begin{bmatrix} x & -y \\ 0 & \frac{1}{2} \\ \end{bmatrix} ")
    assert [[float(evaluate(node, VALUES)) for node in row] for row in rows] == [[X, -Y], [0.0, 0.5]]


@pytest.mark.parametrize(
    "text",
    [
        "x",
        r"\begin{bmatrix} x & y \\ x \end{bmatrix}",
        r"\begin{bmatrix} x \end{pmatrix}",
        r"\begin{bmatrix} \end{bmatrix}",
        r"\begin{bmatrix} x & \end{bmatrix}",
    ],
)
def test_what_is_no_matrix(text: str) -> None:
    with pytest.raises(InputError):
        read_latex_matrix(text)


def test_places_in_a_matrix_are_of_the_whole_text() -> None:
    text = r"\begin{bmatrix} x & y \\ x & @ \end{bmatrix}"
    with pytest.raises(InputError) as refused:
        read_latex_matrix(text)
    assert refused.value.where == f"character {text.index('@') + 1} of the formula"
