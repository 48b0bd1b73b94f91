"""What is printed means what was derived: signs, numbers and sums inside products keep their parentheses."""

from __future__ import annotations

from functools import cache

import pytest
import sympy as sp

import pinscrew as ps
from pinscrew.derivation import reports, typeset
from pinscrew.derivation.derivation import Derivation

a, b, c = sp.symbols("a b c", positive=True)


@cache
def derived(name: str) -> Derivation:
    return ps.derive(ps.load(name))


PRINTED = [
    (a / 2, r"\frac{a}{2}"),
    (-a / 3, r"-\frac{a}{3}"),
    (sp.Rational(-1, 3), r"-\frac{1}{3}"),
    (sp.Rational(-333, 1000) * a, "-0.333 a"),
    (-a - b, "-(a + b)"),
    ((a + b) / 2, r"\tfrac{1}{2} (a + b)"),
    (-a / 1000 - b / 1000, "-0.001 (a + b)"),
    (a - b, "a - b"),
    (b - 2 * a, "b - 2 a"),
    (c * (-a - b), "-c (a + b)"),
    (1 + a * (-b - c), "1 - a (b + c)"),
    (a - b * (-a - c), "a + b (a + c)"),
    (-a * (b - c) * (-a - c), "a (a + c) (b - c)"),
    (-a * (-a / 1000 - b / 1000) / b, r"\frac{0.001 a (a + b)}{b}"),
    (-1 / (a + b), r"-\frac{1}{a + b}"),
    ((-a - b) ** 2, r"\left(-(a + b)\right)^{2}"),
    ((2 * a + 2 * b) / (a - b), r"\frac{2 (a + b)}{a - b}"),
    (sp.Float("-0.3", 20) * a, "-0.3 a"),
    (sp.sqrt(3) / 2, r"\frac{\sqrt{3}}{2}"),
]


@pytest.mark.parametrize(("expression", "text"), PRINTED, ids=[text for _, text in PRINTED])
def test_products(expression: sp.Expr, text: str) -> None:
    assert typeset.Typesetter(derived("gear_pair"))(expression) == text


def test_a_factor_keeps_its_parentheses() -> None:
    """V^s of the driven gear, about an axis at 0.001 (N1 + N2): its v_y is -ω_z x, by hand."""
    d = derived("gear_pair")
    assert typeset.Typesetter(d)(d.jacobian("spatial")[1, 0]) == r"\frac{0.001 N_{1} (N_{1} + N_{2})}{N_{2}}"


def formulas(name: str, *parts: str) -> str:
    d = derived(name)
    return reports.write(reports.report(d, d.prove(2), parts), "markdown")


@pytest.mark.parametrize("name", ["gear_pair", "bevel_pair", "lead_screw"])
def test_coupled_joints_have_one_body_jacobian(name: str) -> None:
    """Rows of J^b have one entry in (i) and in (j), and V^b is in the rate of the coordinate."""
    d = derived(name)
    printed = typeset.Typesetter(d).matrix(d.jacobian("body"))
    text = formulas(name, "body-jacobian", "velocity-check")
    assert f"J^{{b}} = {printed}" in text
    assert rf"J^{{b}} \dot{{\theta}} = {printed}" in text
    rate = {variable.rate for variable in d.coordinates}
    for velocity in (d.body_velocity, d.spatial_velocity, d.hybrid_velocity, d.body_hat, d.pose_rate):
        assert velocity.free_symbols & {variable.rate for variable in d.variables} <= rate
    assert all(x == 0 for x in (d.jacobian("body") * sp.Matrix(list(rate)) - d.body_velocity).applyfunc(sp.expand))


@pytest.mark.parametrize("name", ["spherical_rrp", "anthropomorphic_rrr", "planar_rrr", "lead_screw"])
def test_short_forms_are_explained_before_they_are_used(name: str) -> None:
    d = derived(name)
    text = formulas(name)
    body = text[text.index("## (c)") :]
    for symbol, meaning in d.atoms.explicit.items():
        shown = d.atoms.latex[symbol]
        explained = f"${shown} = {typeset.Typesetter(d)(meaning)}"
        assert body.index(shown) == body.index(explained) + 1
        assert text.count(explained) == 1


def test_a_home_pose_that_is_nothing_is_not_multiplied_by() -> None:
    eye = typeset.Typesetter(derived("scara")).matrix(sp.eye(4))
    assert derived("lead_screw").home == sp.eye(4)
    assert f"\\end{{bmatrix}} {eye}" not in formulas("lead_screw", "pose")
