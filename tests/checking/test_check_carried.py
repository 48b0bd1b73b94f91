"""A wrong step that is carried through rightly is credited, and what is no matrix of its kind is said to be none."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
import sympy as sp

import pinscrew as ps
from pinscrew.checking.sheet import AnswerSheet

SPHERICAL = ps.load("spherical")
D = ps.derive(SPHERICAL)
RATES = sp.Matrix([variable.rate for variable in D.variables])


def inverse(T: Any) -> Any:
    R, p = T[:3, :3], T[:3, 3]
    return sp.Matrix(sp.BlockMatrix([[R.T, -R.T * p], [sp.zeros(1, 3), sp.ones(1, 1)]]))


def hat(w: Any) -> Any:
    return sp.Matrix([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def adjoint(T: Any) -> Any:
    R, p = T[:3, :3], T[:3, 3]
    return sp.Matrix(sp.BlockMatrix([[R, hat(p) * R], [sp.zeros(3), R]]))


def graded(tmp_path: Path, **answers: Any) -> AnswerSheet:
    document = {key: [[str(x) for x in row] for row in sp.Matrix(value).tolist()] for key, value in answers.items()}
    (tmp_path / "answers.json").write_text(json.dumps(document), encoding="utf-8")
    return ps.check_file(SPHERICAL, tmp_path / "answers.json")


def follows(sheet: AnswerSheet) -> dict[str, tuple[str, ...]]:
    return {verdict.quantity: verdict.follows for verdict, _ in sheet.verdicts}


def wrong_pose() -> Any:
    """The pose with the other sign of s2 in its height."""
    T = D.pose.as_mutable()
    T[2, 3] = 2 * next(s for s in D.lengths if str(s) == "L0") - T[2, 3]
    return T


def test_from_the_pose(tmp_path: Path) -> None:
    T = wrong_pose()
    explicit = D.explicit(T)
    rate = sum((explicit.diff(v.symbol) * v.rate for v in D.variables), sp.zeros(4))
    sheet = graded(
        tmp_path,
        T=T,
        R=T[:3, :3],
        p=T[:3, 3],
        Tinv=inverse(T),
        Ad=adjoint(T),
        Tdot=rate,
        Vbhat=inverse(explicit) * rate,
    )
    found = follows(sheet)
    assert (found["T"], found["R"], sheet.verdicts[1][0].right) == ((), (), True)
    for key in ("p", "Tinv", "Ad", "Tdot"):
        assert found[key] == ("T",), key
    assert found["Vbhat"] == ("Tinv", "Tdot")
    assert sheet.right is False
    assert "it follows rightly from your T" in str(sheet)
    assert sheet.data()["answers"][2]["follows"] == ["T"]


def test_from_the_twists(tmp_path: Path) -> None:
    """ξ2 with v = ω × q; then all by the right formulas: e2 about that axis, products, the pose, Jacobians."""
    xi = [sp.Matrix(screw.twist) for screw in D.screws]
    xi[1] = sp.Matrix([*(-x for x in xi[1][:3]), *xi[1][3:]])
    c, s = sp.Symbol("c2"), sp.Symbol("s2")
    w, v = hat(xi[1][3:]), sp.Matrix(xi[1][:3])
    R = sp.eye(3) + w * s + w * w * (1 - c)
    e2 = sp.eye(4)
    e2[:3, :3], e2[:3, 3] = R, (sp.eye(3) - R) * sp.Matrix(xi[1][3:]).cross(v)
    e1, _, e3 = (sp.Matrix(e) for e in D.exponentials)
    T = e1 * e2 * e3 * D.home
    Js = sp.Matrix.hstack(xi[0], adjoint(e1) * xi[1], adjoint(e1 * e2) * xi[2])
    Jb = adjoint(inverse(T)) * Js
    sheet = graded(
        tmp_path,
        xi2=xi[1],
        exp2=e2,
        prod2=e1 * e2,
        tail2=e2 * e3 * D.home,
        T=T,
        Js=Js,
        Vs=Js * RATES,
        Jb=Jb,
        p=-T[:3, 3],
    )
    found = follows(sheet)
    assert found["xi2"] == ()
    assert found["exp2"] == ("xi2",)
    assert found["prod2"] == found["tail2"] == found["T"] == ("exp2",)
    assert found["Js"] == ("xi2", "exp2")
    assert found["Vs"] == ("Js",)
    assert found["Jb"] == ("Js", "T")
    assert found["p"] == ()


@pytest.mark.parametrize(
    ("key", "matrix", "fault"),
    [
        ("R", "[[c1, -s1*c2, -s1*s2], [s1, c1*c2, c1*s2], [0, -s2, 1]]", "RᵀR is not I"),
        ("R", "[[c1, -s1*c2, s1*s2], [s1, c1*c2, -c1*s2], [0, -s2, -c2]]", "its determinant is -1"),
        ("M", "[[1, 0, 0, 0], [0, 1, 0, L3], [0, 0, 1, L0], [0, 0, 0, 0]]", "its last row is not 0 0 0 1"),
        ("exp3", "[[1, 0, 0, 0], [0, 1, 0, q3], [0, 0, 1, 0], [0, 1, 0, 1]]", "its last row is not 0 0 0 1"),
        ("hat(xi1)", "[[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1]]", "its last row is not 0 0 0 0"),
        ("hat(omega1)", "[[0, -1, 0], [-1, 0, 0], [0, 0, 0]]", "skew"),
    ],
)
def test_structure(key: str, matrix: str, fault: str) -> None:
    verdict = ps.check(SPHERICAL, key, matrix)
    assert verdict.right is False
    assert fault in " ".join(verdict.structure)
    assert fault in str(verdict)


def test_what_has_its_structure_is_not_blamed() -> None:
    other = "[[1, 0, 0, L3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"
    verdict = ps.check(SPHERICAL, "M", other)
    assert (verdict.right, verdict.structure) == (False, ())
    adjoint_ = adjoint(D.pose).as_mutable()
    adjoint_[3, 0] = 1
    assert ps.check(SPHERICAL, "Ad", adjoint_).structure == ("it is no adjoint: its lower left block is not 0",)
    adjoint_[3, 0] = 0
    adjoint_[3, 3] = 0
    assert ps.check(SPHERICAL, "Ad", adjoint_).structure == ("it is no adjoint: its blocks on the diagonal differ",)
