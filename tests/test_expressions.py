"""Arithmetic as people write it: its values, with numbers and arrays, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest

from pinscrew.ground.errors import InputError
from pinscrew.ground.expressions import Expression, number


def test_variables_are_numbers_or_arrays() -> None:
    expression = Expression.parse("0.3 - 0.1*(t - 5)/2 + 2pi", ("t",))
    assert expression.value({"t": 7.0}) == 0.3 - 0.1 * (7.0 - 5) / 2 + 2 * np.pi
    t = np.linspace(0.0, 9.0, 10)
    np.testing.assert_array_equal(expression.value({"t": t}), 0.3 - 0.1 * (t - 5) / 2 + 2 * np.pi)
    assert expression.text == "0.3 - 0.1*(t - 5)/2 + 2pi"


@pytest.mark.parametrize(
    "text", ["t", "x", "t()", "t.real", "t**2", "t if t else 1", "[t]", "lambda: t", "True", "'t'", ""]
)
def test_what_is_refused(text: str) -> None:
    with pytest.raises(InputError) as caught:
        Expression.parse(text)
    assert caught.value.code == "expression"
    assert str(caught.value).startswith(
        f"{text!r} is no arithmetic; use numbers, pi, deg, rad, m, cm, mm, brackets and + - * /"
    )
    if text != "t":
        with pytest.raises(InputError, match="is no arithmetic of t"):
            Expression.parse(text, ("t",))


@pytest.mark.parametrize("text", ["1/0", "1e308*10", "1e999", "(" * 99, "1" * 101, f"1{'+1' * 60}"])
def test_numbers_are_finite(text: str) -> None:
    with pytest.raises(InputError) as caught:
        number(text)
    assert caught.value.code == "expression"


def test_long_texts_are_cut() -> None:
    with pytest.raises(InputError) as caught:
        number("1+" * 1000)
    assert len(str(caught.value)) < 250
