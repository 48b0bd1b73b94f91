"""Screw parameters, the spatial velocity, the general column and the geometric method, against closed forms by hand."""

from __future__ import annotations

import re

import pytest
import sympy as sp
from test_derive_details import of, shown

import pinscrew as ps
from pinscrew.derivation import read_back
from pinscrew.derivation.forms import Convention
from pinscrew.derivation.parts import PARTS, wanted

ADDED = ("screws", "spatial-velocity", "general-column", "geometric")


@pytest.mark.parametrize(
    ("name", "convention", "form"),
    [
        ("spherical_rrp", "lynch-park", "latex"),
        ("stanford_rrp", "mls", "html"),
        ("lead_screw", "mls", "markdown"),
        ("anthropomorphic_rrr", "mls", "notebook"),
    ],
)
def test_all_is_read_back(name: str, convention: Convention, form: str) -> None:
    d = ps.derive(ps.load(name), convention=convention)
    found = read_back.read_back(d, shown(d, "full", form, ("a", "b", *ADDED)), form)
    assert found.alone == 0
    assert found.general <= 6
    assert found.largest < 1e-11


def test_only_where_asked_for() -> None:
    assert not set(ADDED) & set(wanted((), large=False))
    assert wanted(("Vs", "o"), large=False) == ["screws", "spatial-velocity"]
    assert [PARTS[key] for key in ADDED] == ["o", "p", "q", "r"]


def test_geometric_method_of_the_scara() -> None:
    """Its link transforms, axes and origins (assignments: A3); the printed +1 is a convention."""
    text = shown(ps.derive(ps.load("scara_rrp")), "steps", parts=("geometric",))
    l1, l2, c1, s1, c2, s2, c12, s12, d3 = sp.symbols("l1 l2 c1 s1 c2 s2 c12 s12 theta3")
    second = [[c2, -s2, 0, l1], [s2, c2, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    assert of(text, "H_{1}^{2}") == sp.Matrix(second)
    assert of(text, "H_{2}^{3}") == sp.Matrix([[1, 0, 0, l2], [0, 1, 0, 0], [0, 0, 1, -d3], [0, 0, 0, 1]])
    assert of(text, "z_{3}") == sp.Matrix([0, 0, -1])
    assert of(text, "o_{2}") == sp.Matrix([l1 * c1, l1 * s1, 0])
    assert of(text, "o_{3}") == sp.Matrix([l1 * c1 + l2 * c12, l1 * s1 + l2 * s12, -d3])
    crossed = of(text, r"z_{2} \times (o_{3} - o_{2})")
    assert crossed == sp.Matrix([-l2 * s12, l2 * c12, 0])
    assert of(text, "J^{h}_{3}") == sp.Matrix([0, 0, -1, 0, 0, 0])
    assert "are one expression" in text
    assert r"$q_{3} = -\theta_{3}$" in text
    assert "(0, 0, -1)" in text


def test_geometric_method_of_the_stanford_arm() -> None:
    """Rz(q1); (Rx(90°) Rz(q2), [0, -l2, l1]); (Ry(90°), [d3, 0, 0]) (A4); it slides forwards."""
    text = shown(ps.derive(ps.load("stanford_rrp")), "steps", parts=("geometric",))
    l1, l2, c2, s2, d3 = sp.symbols("l1 l2 c2 s2 theta3")
    second = [[c2, -s2, 0, 0], [0, 0, -1, -l2], [s2, c2, 0, l1], [0, 0, 0, 1]]
    assert of(text, "H_{1}^{2}") == sp.Matrix(second)
    assert of(text, "H_{2}^{3}")[:3, 3] == sp.Matrix([d3, 0, 0])
    assert "a convention" not in text


def test_a_tool_beyond_the_last_link_and_no_chain_outwards() -> None:
    text = shown(ps.derive(ps.load("planar_rrr")), "steps", parts=("geometric",))
    assert of(text, "H_{3}^{e}")[0, 3] == sp.Symbol("l3")
    assert "(o_{e} - o_{1})" in text
    for robot, tip, reference in (("planar_rrr", "base", "tool"), ("gear_pair", None, None)):
        d = ps.derive(ps.load(robot), tip, reference=reference)
        assert "lead outwards" in shown(d, "steps", parts=("geometric",))


@pytest.mark.parametrize(
    ("reference", "points"), [(None, [[0, 0, 1], [0, 1, 1]]), ("frame0", [[-1, -1, 0], [-1, 0, 0]])]
)
def test_screws_of_both_choices_of_frame_0(reference: str | None, points: list[list[int]]) -> None:
    """(A2) pitch 0, magnitude 1, and the axes through these points."""
    text = shown(ps.derive(ps.load("planar_2r"), reference=reference), "steps", parts=("screws",))
    for i, point in enumerate(points, 1):
        head = rf"\frac{{\omega_{{{i}}} \times v_{{{i}}}}}{{\|\omega_{{{i}}}\|^{{2}}}}"
        line = next(line for line in text.splitlines() if line.startswith(head))
        cells = r" \\ ".join(map(str, point))
        assert rf"= \begin{{bmatrix}} {cells} \end{{bmatrix}} , \quad \omega" in line
        for letter, value in (("h", 0), ("M", 1)):
            assert re.search(rf"^{letter}_.{i}. = .* = {value}$", text, re.MULTILINE)


def test_screw_of_a_slide() -> None:
    text = shown(ps.derive(ps.load("spherical_rrp")), "result", parts=("screws",))
    assert "$h_{3}$ is infinite" in text
    assert r"v_{3} = \begin{bmatrix} 0 \\ 1 \\ 0 \end{bmatrix}" in text


def test_spatial_velocity_of_two_joints() -> None:
    """V^s = J^s θ̇ with J^s of A10."""
    d = ps.derive(ps.load("two_joint"))
    text = shown(d, "steps", parts=("p", "q"))
    l0, l1, c1, s1, d1, d2 = sp.symbols("l0 l1 c1 s1 dtheta1 dtheta2")
    expected = sp.Matrix([l0 * d1 + (l0 + l1 * c1) * d2, l1 * s1 * d2, 0, 0, 0, d1 + d2])
    assert sp.expand(of(text, "V^{s}") - expected) == sp.zeros(6, 1)
    hat = of(text, r"\hat{V}^{s}")
    assert sp.expand(hat[:3, 3] - expected[:3, 0]) == sp.zeros(3, 1)
    assert hat[1, 0] == d1 + d2
    second = of(text, r"\hat{\xi}'_{2}")
    assert sp.expand(second[:3, 3] - sp.Matrix([l0 + l1 * c1, l1 * s1, 0])) == sp.zeros(3, 1)
    assert d.equal(d.spatial_hat, d.pose_rate * d.inverse)


@pytest.mark.parametrize(
    ("head", "old", "new"),
    [
        ("h_{2}", r"L_{0} \\ 0", r"0 \\ L_{0}"),
        (r"\frac{\omega_{2}", r"L_{0}", r"L_{3}"),
        ("M_{1}", "= 1", "= 2"),
        (r"\hat{V}^{s}", r"\dot{\theta}_{2}", r"\theta_{2}"),
        ("V^{s}", "c_{1}", "s_{1}"),
        (r"\hat{\xi}'_{2}", "s_{2}", "c_{2}"),
        ("H_{1}^{2}", "c_{2}", "s_{2}"),
        ("o_{3}", "s_{1}", "c_{1}"),
        ("z_{2}", "s_{1}", "c_{1}"),
        (r"z_{1} \times", "s_{1}", "c_{1}"),
        ("J^{h}_{2}", "s_{1}", "-s_{1}"),
    ],
)
def test_a_slip_is_seen(head: str, old: str, new: str) -> None:
    d = ps.derive(ps.load("spherical_rrp"))
    lines = shown(d, "steps", parts=ADDED).splitlines()
    at = next(i for i, x in enumerate(lines) if x.removeprefix(r"\begin{aligned} ").startswith(head))
    assert old in lines[at]
    lines[at] = lines[at].replace(old, new, 1)
    with pytest.raises(read_back.ReadBackError):
        read_back.read_back(d, "\n".join(lines), "markdown")


@pytest.mark.parametrize(
    ("convention", "hat", "omega"),
    [("mls", r"\hat{\xi}_{%s}", r"\hat{\omega}"), ("lynch-park", r"[\mathcal{S}_{%s}]", r"[\omega]")],
)
def test_the_proof_of_the_general_column(convention: Convention, hat: str, omega: str) -> None:
    """The words, and the product of its three matrices for general R, p, v and ω."""
    d = ps.derive(ps.load("two_joint"), convention=convention)
    text = shown(d, "steps", parts=("q",))
    twist, own = hat % "i", rf"e^{{{hat % 'i'} \theta_{{i}}}}"
    assert f"Only the factor ${own}$ of" in text
    assert f"its derivative is ${twist} {own}$" in text
    last = rf"e^{{{hat % 'i-1'} \theta_{{i-1}}}}"
    assert rf"$h = e^{{{hat % '1'} \theta_{{1}}}} \cdots {last}$" in text
    assert rf"= h {twist} {own} \cdots" in text
    assert text.count(rf"= h {twist} h^{{-1}}") == 1
    assert rf"R {omega} R^{{T}} & R v - R {omega} R^{{T}} p \\ 0 & 0" in text
    assert "Only the factor" not in shown(d, "result", parts=("q",))
    entries = sp.symbols("r:9"), sp.symbols("p:3"), sp.symbols("v:3"), sp.symbols("w:3")
    R, (p, v, w) = sp.Matrix(3, 3, entries[0]), map(sp.Matrix, entries[1:])
    W = ps.lie.so3.hat(w)
    row = sp.Matrix([[0, 0, 0, 1]])
    h, back = R.row_join(p).col_join(row), R.T.row_join(-R.T * p).col_join(row)
    whole = h * W.row_join(v).col_join(0 * row) * back
    assert sp.expand(whole - (R * W * R.T).row_join(R * v - R * W * R.T * p).col_join(0 * row)) == sp.zeros(4, 4)


def test_steps_of_the_spatial_velocity() -> None:
    d = ps.derive(ps.load("one_joint"))
    for detail, factors in (("result", 1), ("steps", 3)):
        text = shown(d, detail, parts=("p", "q"))  # type: ignore[arg-type]
        assert ("The rate of the pose times its inverse (MLS, eq. 2.53):" in text) == (factors == 3)
        for head in (r"\hat{V}^{s}", r"\hat{\xi}'_{1}"):
            line = next(x for x in text.splitlines() if x.removeprefix(r"\begin{aligned} ").startswith(head))
            assert line.count(r"\begin{bmatrix}") == factors
