"""sympy matrices in the Lie-group functions: against sympy's own exponential, scipy's, and the numeric functions."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import numpy as np
import pytest
import scipy.linalg
import sympy as sp

from pinscrew.errors import InputError
from pinscrew.lie import se3, so3

theta, L0, r = sp.symbols("theta L0 r", real=True)
XI = sp.Matrix(sp.symbols("v1:4 w1:4"))
T = sp.Matrix(4, 4, [*sp.symbols("t:12"), 0, 0, 0, 1])
X3, X4 = sp.Matrix(3, 3, sp.symbols("x:9")), sp.Matrix(4, 4, sp.symbols("x:16"))
CASES = [
    (so3, XI[3:, :], ["hat", "exp", "ad"]),
    (so3, X3, ["vee", "inverse", "adjoint"]),
    (se3, XI, ["hat", "exp", "ad"]),
    (se3, X4, ["vee"]),
    (se3, T, ["inverse", "adjoint"]),
]


def number(matrix: Any, values: dict[sp.Symbol, float]) -> Any:
    return np.array(matrix.subs(values).evalf(20), dtype=float)


@pytest.mark.parametrize(
    ("group", "matrix", "name"), [(group, matrix, name) for group, matrix, names in CASES for name in names]
)
def test_symbols_give_what_numbers_give(group: Any, matrix: sp.Matrix, name: str) -> None:
    function = getattr(group, name)
    symbolic = function(matrix)
    assert isinstance(symbolic, sp.ImmutableMatrix)
    rng = np.random.default_rng(4)
    for _ in range(3):
        values = {symbol: float(rng.uniform(-2, 2)) for symbol in sorted(matrix.free_symbols, key=str)}
        given = number(matrix, values)
        expected = function(given[:, 0] if given.shape[1] == 1 else given)
        shown = number(symbolic, values)
        np.testing.assert_allclose(shown[:, 0] if expected.ndim == 1 else shown, expected, atol=1e-14)
        if name == "exp":
            np.testing.assert_allclose(shown, scipy.linalg.expm(number(group.hat(matrix), values)), atol=1e-13)


@pytest.mark.parametrize(
    "xi",
    [
        [0, -L0, 0, -1, 0, 0],  # turns
        [0, 1, 0, 0, 0, 0],  # slides
        [0, 0, sp.Rational(1, 3), 0, 0, 1],  # a screw with a pitch
        [1, r, 0, 0, sp.Rational(3, 5), sp.Rational(4, 5)],
    ],
)
def test_the_exponential_of_a_twist_is_sympys(xi: list[Any]) -> None:
    found = se3.exp(sp.Matrix(xi) * theta)
    truth = (se3.hat(sp.Matrix(xi)) * theta).exp()
    assert (found - truth).applyfunc(lambda x: sp.simplify(sp.expand(x.rewrite(sp.exp)))) == sp.zeros(4)
    assert not found.has(sp.Abs)


def test_exact_numbers_stay_exact() -> None:
    R = so3.exp(sp.Matrix([0, 0, sp.pi / 6]))
    expected = sp.Matrix([[sp.sqrt(3) / 2, -sp.S.Half, 0], [sp.S.Half, sp.sqrt(3) / 2, 0], [0, 0, 1]])
    assert sp.zeros(3) == R - expected
    assert so3.exp(sp.zeros(3, 1)) == sp.eye(3)


def test_the_angle_has_no_root_or_sign_where_the_axis_is_a_unit() -> None:
    a, b = sp.symbols("a b", real=True)
    for axis in ([a, b, sp.sqrt(1 - a**2 - b**2)], [sp.sin(a) * sp.cos(b), sp.sin(a) * sp.sin(b), sp.cos(a)]):
        R = so3.exp(sp.Matrix(axis) * theta)
        assert {f.args[0] for f in R.atoms(sp.sin, sp.cos) if f.has(theta)} == {theta}
        u = sp.Matrix(axis)
        K = so3.hat(u)
        rodrigues = sp.eye(3) + sp.sin(theta) * K + (1 - sp.cos(theta)) * K * K
        values = {a: 0.4, b: -0.3, theta: -2.5}
        np.testing.assert_allclose(number(R, values), number(rodrigues, values), atol=1e-15)


@pytest.mark.parametrize(
    ("function", "value", "words"),
    [
        (so3.hat, sp.Matrix([[1, 2, theta]]), r"so3\.hat: omega has shape \(1, 3\).*\(3, 1\)"),
        (se3.exp, XI[3:, :], r"se3\.exp: xi has shape \(3, 1\).*\(6, 1\)"),
        (se3.adjoint, sp.eye(3), r"se3\.adjoint: T has shape \(3, 3\).*\(4, 4\)"),
        (so3.exp, sp.Array([1, 2, theta]), r"so3\.exp: omega is a ImmutableDenseNDimArray of sympy"),
    ],
)
def test_another_shape_is_refused(function: Any, value: Any, words: str) -> None:
    with pytest.raises(InputError, match=words):
        function(value)


def test_sympy_is_not_loaded_for_arrays() -> None:
    code = "import sys; from pinscrew.lie import se3; se3.exp([0.0] * 6); se3.adjoint(se3.hat([1.0] * 6)); "
    code += "sys.exit('sympy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
