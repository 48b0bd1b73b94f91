"""Slips that would be small to see and large to use: orders of adjoints, digits of code, what a proof counts."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
import sympy as sp

import pinscrew as ps
from pinscrew.derivation import proof, read_back, reports
from pinscrew.derivation.code import code
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.forms import Convention
from pinscrew.derivation.notation import NOTATIONS
from pinscrew.derivation.parts import PARTS
from pinscrew.derivation.writer import DETAILS, Detail
from pinscrew.ground.errors import InputError


def test_a_proof_counts_the_symbolic_check() -> None:
    proof = ps.derive(ps.load("one_joint")).prove(2)
    assert proof.ok
    assert replace(proof, symbolic=None).ok
    assert not replace(proof, symbolic=False).ok


def test_adjoints_in_the_order_of_lynch_and_park() -> None:
    """[Ad_T] = [[R, 0], [[p]R, R]] (Lynch, Park, definition 3.20)."""
    d = ps.derive(ps.load("one_joint"), convention="lynch-park")
    R, p = d.pose[:3, :3], d.pose[:3, 3]
    hat = sp.Matrix([[0, -p[2], p[1]], [p[2], 0, -p[0]], [-p[1], p[0], 0]])
    found = NOTATIONS["lynch-park"].both(d.adjoint)
    assert d.equal(found, sp.Matrix(sp.BlockMatrix([[R, sp.zeros(3, 3)], [hat * R, R]])))


def test_code_has_all_digits_of_a_double(tmp_path: Path) -> None:
    length = 0.123456789012345
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/>'
    text = f'<robot name="r"><link name="a"/><link name="b"/>{joint}<origin xyz="{length} 0 0"/></joint></robot>'
    (tmp_path / "r.urdf").write_text(text)
    names: dict[str, object] = {}
    exec(code(ps.derive(ps.load(tmp_path / "r.urdf")), "python"), names)  # noqa: S102 (our own text)
    fk = names["fk"]
    assert callable(fk)
    assert fk([])[0][3] == pytest.approx(length, rel=1e-15)


ALL = tuple(PARTS)


def shown(d: Derivation, detail: Detail, form: str = "markdown", parts: tuple[str, ...] = ALL) -> str:
    return reports.write(reports.report(d, proof.Proof(0, 0, 0, (), None), parts, detail=detail), form)


@pytest.mark.parametrize(
    ("name", "convention", "form"),
    [("spherical_rrp", "mls", "html"), ("planar_2r", "lynch-park", "latex"), ("lead_screw", "mls", "notebook")],
)
def test_every_matrix_of_every_detail_is_read_back(name: str, convention: Convention, form: str) -> None:
    d = ps.derive(ps.load(name), convention=convention)
    parts = tuple(part for part in PARTS if part != "singularities") if d.follows else ALL
    counts = []
    for detail in DETAILS:
        found = read_back.read_back(d, shown(d, detail, form, parts), form)
        assert found.alone == 0
        assert found.largest < 1e-11
        counts.append(found.matrices)
    assert counts[0] * 1.5 < counts[1]
    assert counts[1] + 15 < counts[2]


def of(text: str, head: str) -> sp.Matrix:
    """The last matrix of the formula that begins with ``head``."""
    line = next(line for line in text.splitlines() if line.startswith((head + " ", r"\begin{aligned} " + head + " ")))
    cells = line[line.rindex(r"\begin{bmatrix}") + 15 : line.rindex(r"\end{bmatrix}")].split(r"\\")
    return sp.Matrix([[sp.sympify(plain(cell)) for cell in row.split("&")] for row in cells])


def plain(cell: str) -> str:
    cell = cell.replace(r"\left", "").replace(r"\right", "").replace(r"\dot{\theta}", "dtheta").strip()
    cell = re.sub(r"\\?([A-Za-z]+)_\{(\d+)\}", r"\1\2", cell)
    return re.sub(r"(?<=[\w)]) +(?=[\w(])", "*", cell)


def test_steps_of_the_spherical_arm() -> None:
    """By hand: Rodrigues of ω2 = (-1, 0, 0), p̂ and -Rᵀp̂ of g2, Rᵀṗ."""
    text = shown(ps.derive(ps.load("spherical_rrp")), "full")
    c2, s2, L0, L3, th3 = sp.symbols("c2 s2 L0 L3 theta3")
    r = L3 + th3
    turned = [[1, 0, 0], [0, c2, s2], [0, -s2, c2]]
    assert sp.expand(of(text, r"e^{\hat{\omega}_{2} \theta_{2}}") - sp.Matrix(turned)) == sp.zeros(3, 3)
    assert of(text, r"\omega_{2} \times v_{2}") == sp.Matrix([0, 0, L0])
    hat = [[0, -(L0 - r * s2), r * c2], [L0 - r * s2, 0, 0], [-r * c2, 0, 0]]
    assert sp.expand(of(text, r"\hat{p}_{g_{2}}") - sp.Matrix(hat)) == sp.zeros(3, 3)
    corner = [[0, L0 - r * s2, -r * c2], [-L0 * c2, 0, 0], [r - L0 * s2, 0, 0]]
    assert sp.expand(of(text, r"-R_{g_{2}}^{T} \hat{p}_{g_{2}}") - sp.Matrix(corner)) == sp.zeros(3, 3)
    d1, d2, d3 = sp.symbols("dtheta1:4")
    assert sp.expand(of(text, r"R^{T} \dot{p}") - sp.Matrix([-r * c2 * d1, d3, -r * d2])) == sp.zeros(3, 1)
    c1, s1 = sp.symbols("c1 s1")
    p = [-r * s1 * c2, r * c1 * c2, L0 - r * s2]
    hat = [[0, -p[2], p[1]], [p[2], 0, -p[0]], [-p[1], p[0], 0]]
    assert sp.expand(of(text, r"\hat{p}") - sp.Matrix(hat)) == sp.zeros(3, 3)


@pytest.mark.parametrize(
    ("head", "old", "new"),
    [
        (r"\hat{\omega}_{2} =", "-1", "1"),
        (r"\omega_{2} \times v_{2}", r"L_{0} \\ 0 \end", r"-L_{0} \\ 0 \end"),
        (r"e^{\hat{\omega}_{2} \theta_{2}}", "(1 - c_{2})", "(1 - s_{2})"),
        ("(I - e^", "1 - c_{1}", "1 - s_{1}"),
        (r"v_{3} \theta_{3}", r"\begin{bmatrix} 0 \\ 1", r"\begin{bmatrix} 1 \\ 1"),
        (r"\hat{p}_{g_{2}}", "(L_{3}", "(-L_{3}"),
        (r"-R_{g_{2}}^{T}", "c_{2}", "s_{2}"),
        (r"R^{T} =", "s_{1}", "-s_{1}"),
        (r"\dot{p} =", r"\dot{\theta}", r"\theta"),
        (r"R^{T} \dot{R}", r"\dot{\theta}", r"\theta"),
        (r"\hat{p} R", "L_{0}", "L_{3}"),
        (r"g_{3} =", "L_{0}", "L_{3}"),
    ],
)
def test_a_slip_in_a_step_is_seen(head: str, old: str, new: str) -> None:
    d = ps.derive(ps.load("spherical_rrp"))
    lines = shown(d, "full", parts=("b", "c", "h", "i", "m")).splitlines()
    at = next(i for i, x in enumerate(lines) if x.removeprefix(r"\begin{aligned} ").startswith(head))
    assert old in lines[at]
    lines[at] = lines[at].replace(old, new, 1)
    with pytest.raises(read_back.ReadBackError):
        read_back.read_back(d, "\n".join(lines), "markdown")


def test_no_such_detail() -> None:
    with pytest.raises(InputError, match="detail='all'"):
        shown(ps.derive(ps.load("one_joint")), "all")  # type: ignore[arg-type]
