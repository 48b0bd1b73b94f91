"""Small rules of derivations, at their boundaries: what is exact, refuted or long, and who is cited."""

from __future__ import annotations

import math
import re

import pytest
import sympy as sp

import pinscrew as ps
from pinscrew.derivation import exact, reports
from pinscrew.derivation.errata import Verdict, errata
from pinscrew.derivation.factoring import operations
from pinscrew.derivation.proof import Proof

NOT_PROVED = Proof(0, 0, 0, (), None)
a, b, c = sp.symbols("a b c")


@pytest.mark.parametrize("twelfths", [*range(-24, 25, 2), *range(-24, 25, 3)])
def test_angles_up_to_a_turn_are_exact(twelfths: int) -> None:
    """Multiples of 30 and of 45 degrees as doubles print them."""
    value = sp.Rational(twelfths, 12) * sp.pi
    assert exact.angle(repr(float(value)), "here", exact.Snaps()) == value


@pytest.mark.parametrize("value", [2.5 * math.pi, -9.0 * math.pi / 4.0, 15.0 * math.pi])
def test_angles_beyond_are_the_numbers_they_are(value: float) -> None:
    assert isinstance(exact.angle(repr(value), "here", exact.Snaps()), sp.Float)


@pytest.mark.parametrize(
    ("printed", "right", "ok"),
    [(1e-3, 1e-14, True), (1e-3, 1e-3, False), (0.0, 1e-14, False), (0.0, 1e-3, False), (math.nan, 0.0, False)],
)
def test_an_erratum_holds_if_the_printed_is_wrong_and_the_other_right(printed: float, right: float, ok: bool) -> None:
    assert Verdict(errata()[0], "PoE", printed, right).ok == ok


@pytest.mark.parametrize(
    ("expression", "count"),
    [
        *((a, 0), (sp.Rational(1, 2), 0), (-a, 0), (2 * a, 1), (a * b + c, 2), (-a * b, 1), (-2 * a * b, 2)),
        *((a + b + c, 2), (a**3, 2), (1 / a, 0), ((a + b) ** 2, 2), (a - b, 1)),
    ],
)
def test_operations_are_those_that_are_written(expression: sp.Expr, count: int) -> None:
    assert operations(expression) == count


def test_rates_stand_behind_the_sums_they_are_multiplied_with() -> None:
    """As in (l1 s1 + l2 s12) θ̇1, for every arm."""
    for name in ("stanford", "anthropomorphic", "planar_rrr"):
        text = reports.write(reports.report(ps.derive(name), NOT_PROVED, ["e", "k"]), "markdown")
        assert re.search(r"\) \\dot\{\\theta\}", text)
        assert re.search(r"\\dot\{\\theta\}_\{\d\} \([^)]*[sc]_", text) is None


@pytest.mark.parametrize(("convention", "book", "other"), [("mls", "MLS, ", "LP, "), ("lynch-park", "LP, ", "MLS, ")])
def test_the_book_of_the_convention_is_cited(convention: str, book: str, other: str) -> None:
    d = ps.derive("spherical", convention=convention)  # type: ignore[call-overload]
    text = reports.write(reports.report(d, NOT_PROVED), "markdown")
    assert book in text
    assert other not in text
