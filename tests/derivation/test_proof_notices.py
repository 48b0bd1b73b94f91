"""The proof is seen to fail: each closed form is changed a little, and so is each engine's answer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pytest

import pinscrew as ps
from pinscrew.derivation import proof
from pinscrew.engines.base import Answers
from pinscrew.ground.typing import FloatArray

FORMS = (
    *("pose g", "spatial Jacobian", "body Jacobian", "hybrid Jacobian", "inverse g⁻¹", "rate ġ"),
    *("spatial velocity", "body velocity", "hybrid velocity"),
)
ENGINES = ("PoE", "Pinocchio")
ROBOT = ps.load("spherical_rrp")
DERIVED = ps.derive(ROBOT)


def broken(form: int, row: int, column: int, by: float, call: int = 0) -> Any:
    """`numeric.evaluate` with one entry of one form off by so much, in the samples of its given or drawn lengths."""
    calls = iter(range(9))

    def evaluate(d: Any, forms: Sequence[Any], q: FloatArray, qd: FloatArray, lengths: Mapping[Any, Any]) -> Any:
        values = [np.array(value) for value in true(d, forms, q, qd, lengths)]
        if next(calls) == call:
            values[form][-1, row, column] += by
        return values

    true = proof.evaluate
    return evaluate


@pytest.mark.parametrize("call", [0, 1], ids=["given lengths", "drawn lengths"])
@pytest.mark.parametrize(("form", "name"), list(enumerate(FORMS)))
def test_a_form_that_is_off(form: int, name: str, call: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """By five times the tolerance, in a translation or a linear part: metres are divided by max(1, size) below 3 m."""
    column = 3 if name in ("pose g", "inverse g⁻¹", "rate ġ") else 0
    monkeypatch.setattr(proof, "evaluate", broken(form, 1, column, 5e-12, call))
    found = DERIVED.prove(1)
    assert not found.ok
    wrong = {(c.what, c.engine, c.given) for c in found.comparisons if not c.ok}
    assert wrong == {(name, engine, call == 0) for engine in ENGINES}
    assert (found.largest > proof.TOLERANCE) == (call == 1), "the largest difference is that of drawn lengths"


@pytest.mark.parametrize(("form", "row", "column"), [(0, 0, 0), (4, 2, 1), (1, 3, 0), (2, 5, 1), (3, 4, 2), (6, 3, 0)])
def test_a_turn_is_not_divided_by_the_size(form: int, row: int, column: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(proof, "evaluate", broken(form, row, column, 1.1e-12))
    assert {c.what for c in DERIVED.prove(1).comparisons if not c.ok} == {FORMS[form]}


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
def test_what_is_no_number(wrong: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(proof, "evaluate", broken(2, 0, 0, wrong))
    assert [c.error for c in DERIVED.prove(1).comparisons if not c.ok] == [np.inf, np.inf]


def test_less_than_the_tolerance_passes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(proof, "evaluate", broken(2, 3, 0, 8e-13))
    found = DERIVED.prove(1)
    assert found.ok
    assert max(c.error for c in found.comparisons) >= 7e-13


@pytest.mark.parametrize("engine", [ps.PoE, ps.Pinocchio])
def test_an_engine_that_is_off(engine: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both are asked: one that is wrong alone is named."""
    true = engine.answers

    def answers(self: Any, *given: Any, **named: Any) -> Answers:
        said: Answers = true(self, *given, **named)
        said.poses[0, 0, 0, 3] += 1e-10
        return said

    monkeypatch.setattr(engine, "answers", answers)
    wrong = {c.engine for c in DERIVED.prove(1).comparisons if not c.ok}
    assert wrong == {engine.__name__}


def test_what_is_counted() -> None:
    """As many samples as asked, each with lengths of its own; the same numbers for the same seed."""
    found, other = DERIVED.prove(4, seed=1), DERIVED.prove(4, seed=2)
    assert (found.samples, found.seed, found.lengths) == (4, 1, 4)
    assert [(c.what, c.engine, c.given) for c in found.comparisons] == [
        (what, engine, given) for given in (True, False) for engine in ENGINES for what in FORMS
    ]
    assert found == DERIVED.prove(4, seed=1)
    assert found.comparisons != other.comparisons
    assert {c.tolerance for c in found.comparisons} == {proof.TOLERANCE}


def test_an_arm_without_lengths_is_held_against_its_own_file_alone() -> None:
    found = ps.derive(ps.load("planar_2r")).prove(3)
    assert (found.lengths, found.largest, len(found.comparisons)) == (0, 0.0, 2 * len(FORMS))
    assert all(c.given for c in found.comparisons)
