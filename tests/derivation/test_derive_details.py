"""Slips that would be small to see and large to use: orders of adjoints, digits of code, what a proof counts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
import sympy as sp

import pinscrew as ps
from pinscrew.derivation.code import code
from pinscrew.derivation.notation import NOTATIONS


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
