"""The identities of rotations: the matrices are rotations by scipy, and what is wrong is not said to hold."""

import re
from typing import Any

import numpy as np
import pytest
import sympy as sp
from scipy.spatial.transform import Rotation
from test_derive_cli import run

from pinscrew.derivation import identities, reports
from pinscrew.derivation.blocks import Table
from pinscrew.errors import InputError
from pinscrew.lie import so3
from pinscrew.mathtext import evaluate, read_latex
from pinscrew.mathtext.equations import Grid, read_equations
from pinscrew.mathtext.pages import formulas


def matrices(text: str, form: str, values: dict[str, Any]) -> list[Any]:
    """The value of each matrix of entries."""
    found = []
    for formula in formulas(text, form):
        for equation in read_equations(formula):
            grids = [piece for side in equation for piece in side if isinstance(piece, Grid)]
            found += [np.array([[evaluate(read_latex(x), values) for x in row] for row in g.cells]) for g in grids]
    return found


@pytest.mark.parametrize("form", ["markdown", "latex", "html", "notebook"])
def test_the_matrices_that_are_written_are_rotations(form: str) -> None:
    rng = np.random.default_rng(2)
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    theta, angles, a = 0.7, rng.uniform(-2, 2, 3), rng.normal(size=3)
    values = {"c_theta": np.cos(theta), "s_theta": np.sin(theta), "v_theta": 1 - np.cos(theta)}
    for i in range(3):
        values |= {f"omega_{i + 1}": axis[i], f"a_{i + 1}": a[i]}
        values |= {f"c_{i + 1}": np.cos(angles[i]), f"s_{i + 1}": np.sin(angles[i])}
    found = matrices(reports.write(identities.identities(), form), form, values)
    turn, z, y, x, three, mirror, carried = found
    np.testing.assert_allclose(turn, Rotation.from_rotvec(theta * axis).as_matrix(), atol=1e-15)
    for matrix, letter, angle in zip((z, y, x), "zyx", angles, strict=True):
        np.testing.assert_allclose(matrix, Rotation.from_euler(letter, angle).as_matrix(), atol=1e-15)
    np.testing.assert_allclose(three, Rotation.from_euler("ZYX", angles).as_matrix(), atol=1e-15)
    np.testing.assert_allclose(carried, so3.hat(z @ a), atol=1e-15)
    assert np.linalg.det(mirror) == -1.0


def test_every_equation_that_is_displayed_is_checked() -> None:
    report = identities.identities()
    (table,) = (block for block in report.sections[-1].blocks if isinstance(block, Table))
    cells = [cell for row in table.rows for cell in row[1:]]
    assert report.ok
    assert set(cells) == {"holds", ""}
    assert cells.count("holds") == 18
    assert len(table.rows) == 10
    shown = re.sub(r"\s", "", reports.write(report, "markdown")).split("##Checked")[0]
    for row in table.rows:
        assert re.sub(r"\s", "", row[0][1:-1]) in shown


@pytest.mark.parametrize("which", ["_axis_angle", "_three_turns"])
def test_what_is_no_rotation_fails(which: str, monkeypatch: pytest.MonkeyPatch) -> None:
    right = getattr(identities, which)()
    wrong = type(right)(right.name, sp.Matrix(right.matrix) * identities._MIRROR, right.relations)
    monkeypatch.setattr(identities, which, lambda: wrong)
    report = identities.identities()
    text = reports.write(report, "markdown")
    assert not report.ok
    assert "SOMETHING FAILS" in text
    failed = [line for line in text.splitlines() if "FAILS |" in line]
    assert len(failed) == 4  # r1 x r2 = r3, det R = 1, R (a x b) and R hat(a) R^T; it is still orthogonal
    done = run("--identity", "rotation")
    assert done.exit_code == 1
    assert "an identity does not hold" in done.stderr


def test_it_is_of_no_robot() -> None:
    done = run("scara", "--identity", "rotation")
    assert done.exit_code == 2
    assert "--identity is of no robot" in done.stderr
    assert "Missing argument 'ROBOT [ARG:=VALUE]...'" in run().stderr
    with pytest.raises(InputError, match=r"identity='pose'.*rotation"):
        identities.identities("pose")
