"""Identities of all rotations, with their proofs; each is checked by sympy, entry for entry, when it is written.

A rotation is here what it is in general: a turn by θ about a unit axis ω, and a product of three elementary turns. An
equation holds where the difference of its sides is in the ideal of ‖ω‖² = 1 and c² + s² = 1: where its remainder is 0.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Final

import sympy as sp

from pinscrew.derivation.blocks import Block, Formula, Paragraph, Section, Table, Writeup
from pinscrew.ground.errors import InputError
from pinscrew.lie import so3

__all__ = ["IDENTITIES", "identities"]

_OMEGA: Final = sp.Matrix(sp.symbols("omega1:4"))
_A: Final = sp.Matrix(sp.symbols("a1:4"))
_B: Final = sp.Matrix(sp.symbols("b1:4"))
_C, _S, _V = sp.symbols("c_theta s_theta v_theta")
_COSINES, _SINES = sp.symbols("c1:4"), sp.symbols("s1:4")
_EYE: Final = sp.eye(3)
_MIRROR: Final = sp.diag(1, 1, -1)


@dataclass(frozen=True, slots=True)
class _Rotation:
    """A rotation in symbols, and the polynomials that are zero."""

    name: str
    matrix: sp.Matrix
    relations: tuple[sp.Expr, ...]

    def zero(self, value: Any) -> bool:
        """Whether a matrix or an expression is zero identically.

        The leading terms of the relations have no symbol in common, so they are a Gröbner basis, and the remainder by
        them is unique.
        """
        symbols = sorted({s for relation in self.relations for s in relation.free_symbols}, key=str, reverse=True)
        entries = (sp.expand(x) for x in sp.Matrix([value]))
        return all(sp.reduced(x, self.relations, *symbols)[1] == 0 for x in entries if x != 0)


def identities(name: str = "rotation") -> Writeup:
    """The identities of rotations, as a report: `reports.write` writes it.

    R Rᵀ = I, det R = 1 with the argument for its sign, and R â Rᵀ = (Ra)^.

    Args:
        name: ``"rotation"``.

    Raises:
        InputError: if there are no such identities.
    """
    if name not in IDENTITIES:
        raise InputError("derive-option", f"identity={name!r}", remedy=f"use one of {', '.join(IDENTITIES)}")
    return IDENTITIES[name]()


def _axis_angle() -> _Rotation:
    K = so3.hat(_OMEGA)
    R = (_EYE + _S * K + _V * K * K).applyfunc(sp.expand)
    # The squares of ω in the diagonal: ω1² stands for 1 - ω2² - ω3², as MLS eq. 2.16 has it.
    diagonal = sp.diag(*(_C + _V * x**2 - R[i, i] for i, x in enumerate(_OMEGA)))
    relations = (_OMEGA.dot(_OMEGA) - 1, _V + _C - 1, _C**2 + _S**2 - 1)
    return _Rotation("axis and angle", R + diagonal, relations)


def _three_turns() -> _Rotation:
    R = _elementary(0) * _elementary(1) * _elementary(2)
    relations = tuple(c**2 + s**2 - 1 for c, s in zip(_COSINES, _SINES, strict=True))
    return _Rotation("three turns", R.applyfunc(sp.expand), relations)


def _elementary(i: int) -> sp.Matrix:
    """The i-th of Rz(θ1), Ry(θ2), Rx(θ3)."""
    c, s = _COSINES[i], _SINES[i]
    return sp.Matrix(
        ([[c, -s, 0], [s, c, 0], [0, 0, 1]], [[c, 0, s], [0, 1, 0], [-s, 0, c]], [[1, 0, 0], [0, c, -s], [0, s, c]])[i]
    )


def _matrix(matrix: sp.Matrix) -> str:
    rows = (" & ".join(_entry(x) for x in matrix.row(i)) for i in range(matrix.rows))
    return r"\begin{bmatrix} " + r" \\ ".join(rows) + r" \end{bmatrix}"


def _entry(expression: sp.Expr) -> str:
    names = {_C: r"c_{\theta}", _S: r"s_{\theta}", _V: r"v_{\theta}"}
    return str(sp.latex(expression, symbol_names=names))


class _Checks:
    """Statements, and of which rotations they hold."""

    def __init__(self) -> None:
        self.rotations = (_axis_angle(), _three_turns())
        self.rows: list[tuple[str, ...]] = []
        self.ok = True

    def __call__(self, statement: str, difference: Callable[[_Rotation], Any], only: int | None = None) -> Formula:
        """Check that a difference is zero for every rotation, or for the ``only`` one it is about; the statement."""
        cells = []
        for i, rotation in enumerate(self.rotations):
            asked = only is None or i == only
            holds = not asked or rotation.zero(difference(rotation))
            self.ok = self.ok and holds
            cells.append("FAILS" if not holds else "holds" if asked else "")
        self.rows.append((f"${statement}$", *cells))
        return Formula(tuple(statement.split(" = ")))


def _rotation() -> Writeup:
    check = _Checks()
    sections = [
        Section("", "rotation", "A rotation in general", tuple(_general(check))),
        Section("", "transpose", "The inverse of a rotation is its transpose", tuple(_transpose(check))),
        Section("", "determinant", "Its determinant is 1", tuple(_determinant(check))),
        Section("", "conjugation", "It carries a cross product along", tuple(_conjugation(check))),
    ]
    words = (
        "Each equation was checked by sympy for both matrices: all entries of the difference of its two sides have the "
        "remainder 0 by $c^{2} + s^{2} - 1$ of each angle and by $\\omega_{1}^{2} + \\omega_{2}^{2} + \\omega_{3}^{2} "
        "- 1$."
    )
    verdict = "Everything holds." if check.ok else "SOMETHING FAILS."
    table = Table(("equation", *(rotation.name for rotation in check.rotations)), tuple(check.rows))
    sections.append(Section("", "checks", "Checked", (Paragraph(f"{words} {verdict}"), table)))
    code = "from pinscrew.derivation.identities import identities\n\nidentities('rotation').ok"
    return Writeup("Identities of rotations", tuple(sections), code, check.ok)


def _general(check: _Checks) -> Iterator[Block]:
    turn, three = check.rotations
    yield Paragraph(
        "Every rotation is a turn by some angle $\\theta$ about some axis $\\omega$ of length 1 (Euler). With "
        "$c_{\\theta} = \\cos\\theta$, $s_{\\theta} = \\sin\\theta$ and $v_{\\theta} = 1 - c_{\\theta}$ it is "
        "(Rodrigues; MLS, eq. 2.14 and 2.16)"
    )
    yield Formula(("R", r"I + s_{\theta} \hat{\omega} + v_{\theta} \hat{\omega}^{2}", _matrix(turn.matrix)))
    yield Paragraph(
        "It is also a product of turns about $z$, $y$ and $x$, with $c_{1} = \\cos\\theta_{1}$, "
        "$s_{1} = \\sin\\theta_{1}$ and so on:"
    )
    factors = " ".join(_matrix(_elementary(i)) for i in range(3))
    yield Formula(("R", r"R_{z}(\theta_{1}) R_{y}(\theta_{2}) R_{x}(\theta_{3})", factors, _matrix(three.matrix)))


def _transpose(check: _Checks) -> Iterator[Block]:
    K = so3.hat(_OMEGA)
    yield Paragraph(
        "The matrix $\\hat{\\omega}$ is skew, so transposing changes its sign. Since $\\omega$ has length 1, crossing "
        "with it three times is crossing once, the other way:"
    )
    yield check(r"\hat{\omega}^{3} = -\hat{\omega}", lambda _: K**3 + K, only=0)
    yield Paragraph("With these, $\\hat{\\omega}^{4} = -\\hat{\\omega}^{2}$, and odd powers cancel in the product:")
    yield Formula(
        (
            "R R^{T}",
            r"(I + s_{\theta} \hat{\omega} + v_{\theta} \hat{\omega}^{2})"
            r" (I - s_{\theta} \hat{\omega} + v_{\theta} \hat{\omega}^{2})",
            r"I + (2 v_{\theta} - v_{\theta}^{2} - s_{\theta}^{2}) \hat{\omega}^{2}",
            r"I + (1 - c_{\theta}^{2} - s_{\theta}^{2}) \hat{\omega}^{2}",
            "I",
        )
    )
    yield Paragraph(
        "For the product of three turns it follows from each of them, from the inside out: "
        "$R_{z} R_{y} R_{x} R_{x}^{T} R_{y}^{T} R_{z}^{T} = I$. So"
    )
    yield check("R R^{T} = I", lambda r: r.matrix * r.matrix.T - _EYE)
    yield check("R^{T} R = I", lambda r: r.matrix.T * r.matrix - _EYE)
    yield Paragraph(
        "and $R^{-1} = R^{T}$. Entry $(i, j)$ of $R^{T} R$ is the inner product of the columns $r_{i}$ and $r_{j}$: "
        "the columns have length 1 and are perpendicular to each other, and of $R R^{T}$ so are the rows."
    )


def _determinant(check: _Checks) -> Iterator[Block]:
    yield Paragraph("A determinant is that of the transpose, and that of a product is the product:")
    yield Formula((r"\det(R)^{2}", r"\det(R) \det(R^{T})", r"\det(R R^{T})", r"\det I", "1"))
    yield Paragraph(
        "That leaves $\\det R = 1$ and $\\det R = -1$; the mirror below has $F F^{T} = I$ too, and $\\det F = -1$. "
        "Either of two arguments settles it."
    )
    yield Formula(("F", _matrix(_MIRROR)))
    yield Paragraph(
        "By continuity: let the angle grow from 0. The determinant is a continuous function of it, at every angle 1 or "
        "$-1$, and $\\det I = 1$ at 0. A continuous function that takes no value between 1 and $-1$ can't get from one "
        "to the other."
    )
    yield Paragraph(
        "By the right hand: the columns of $R$ are the axes of a right-handed frame, the third is the cross product of "
        "the other two, and a determinant is their triple product:"
    )
    yield check(r"r_{1} \times r_{2} = r_{3}", lambda r: r.matrix[:, 0].cross(r.matrix[:, 1]) - r.matrix[:, 2])
    yield Formula((r"\det R", r"(r_{1} \times r_{2})^{T} r_{3}", r"r_{3}^{T} r_{3}", "1"))
    check(r"\det R = 1", lambda r: r.matrix.det(method="berkowitz") - 1)
    check(r"\det F = -1", lambda _: _MIRROR.det() + 1)


def _conjugation(check: _Checks) -> Iterator[Block]:
    yield Paragraph(
        "The matrix $\\hat{a}$ crosses with $a$: $\\hat{a} b = a \\times b$. A rotation turns lengths, angles and the "
        "right hand along, so it turns a cross product along:"
    )
    yield check(
        r"R (a \times b) = (R a) \times (R b)",
        lambda r: r.matrix * _A.cross(_B) - (r.matrix * _A).cross(r.matrix * _B),
    )
    yield Paragraph("Put $R^{T} b$ for $b$. For every $b$")
    yield Formula((r"R \hat{a} R^{T} b", r"R (a \times R^{T} b)", r"(R a) \times (R R^{T} b)", r"(R a) \times b"))
    yield Paragraph("so that the two matrices are one (MLS, lemma 2.1):")
    yield check(r"R \hat{a} R^{T} = (R a)^{\wedge}", lambda r: _conjugated(r.matrix) - so3.hat(r.matrix * _A))
    z = _elementary(0)
    carried = so3.hat(z * _A)
    said = check(r"R_{z} \hat{a} R_{z}^{T} = (R_{z} a)^{\wedge}", lambda _: _conjugated(z) - carried, only=1)
    yield Paragraph("For the turn about $z$:")
    yield Formula((*said.parts, _matrix(carried)))
    yield Paragraph("A mirror changes the hand, and so the sign: $F \\hat{a} F^{T} = -(F a)^{\\wedge}$.")
    check(r"F \hat{a} F^{T} = -(F a)^{\wedge}", lambda _: _conjugated(_MIRROR) + so3.hat(_MIRROR * _A))


def _conjugated(R: sp.Matrix) -> sp.Matrix:
    return R * so3.hat(_A) * R.T


IDENTITIES: Final[dict[str, Callable[[], Writeup]]] = {"rotation": _rotation}
"""What can be asked for."""
