"""Reports on a terminal: what is shown reads as the LaTeX does, and fits."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import unicodedata
from functools import cache

import numpy as np
import pytest

import pinscrew as ps
from pinscrew.derivation import proof, reports, unicode_math
from pinscrew.description import catalogue
from pinscrew.mathtext import evaluate, read_latex, read_plain, symbols
from pinscrew.mathtext.equations import Grid, read_equations
from pinscrew.mathtext.pages import formulas

NAMES = [entry.name for entry in catalogue.bundled()]
LOW = dict(zip("₀₁₂₃₄₅₆₇₈₉", "0123456789", strict=True))


@cache
def report(name: str) -> reports.Writeup:
    return reports.report(ps.derive(ps.load(name)), proof.Proof(0, 0, 0, (), None))


def plain(shown: str) -> str:
    """What is shown, as `read_plain` reads it; another reader than that of LaTeX, and no writer."""
    text = unicodedata.normalize("NFD", shown)
    text = re.sub("θ\u0307([₀-₉]+)", r"dtheta\1", text).replace("θ", "theta")
    text = re.sub("([²³])", lambda m: f"^{ {'²': 2, '³': 3}[m[1]] }", text)
    text = re.sub("√([0-9]+)", r"sqrt(\1)", text).replace("√", "sqrt").replace("π", "pi")
    return "".join(LOW.get(c, c) for c in text)


def value(text: str, *, latex: bool) -> float:
    node = read_latex(text) if latex else read_plain(plain(text))
    known = {}
    for name in symbols(node):
        key = name.replace("dot ", "d").replace("_", "")
        known[name] = 0.3 + sum(ord(c) * (i + 2) for i, c in enumerate(key)) % 97 / 31
    return float(evaluate(node, known))


@pytest.mark.parametrize("name", NAMES)
def test_every_entry_reads_as_the_latex_does(name: str) -> None:
    seen = set()
    for formula in formulas(reports.write(report(name), "markdown"), "markdown"):
        for side in (side for equation in read_equations(formula) for side in equation):
            for grid in (piece for piece in side if isinstance(piece, Grid)):
                seen |= {cell for row in grid.cells for cell in row if not re.search(r"R|p|v|hat|xi|omega", cell)}
    assert len(seen) > 10
    for cell in seen:
        assert value(unicode_math.one_line(cell), latex=False) == pytest.approx(value(cell, latex=True), 1e-12)


@pytest.mark.parametrize(
    ("latex", "shown"),
    [
        (r"-\frac{N_{1} \theta_{1}}{N_{2}}", "-N₁ θ₁/N₂"),
        (r"\frac{a + b}{2 c}", "(a + b)/(2 c)"),
        (r"\frac{1}{2} x", "(1/2) x"),
        (r"\cos \frac{a}{b}", "cos(a/b)"),
        (r"\sin\theta", "sin θ"),
        (r"\frac{\partial g}{\partial \theta_{1}} \dot{\theta}_{1}", "∂g/∂θ₁ θ̇₁"),
        (r"e^{\hat{\xi}_{1} \theta_{1}} g(0)", "e^(ξ̂₁ θ₁) g(0)"),
        (r"\mathrm{Ad}^{-1}_{\left(g(0)\right)} \xi'_{12}", "Ad⁻¹_(g(0)) ξ′₁₂"),
        (r"J^{b} \mathcal{S}_{2} \sqrt{2} \sqrt{x + 1}", "Jᵇ 𝒮₂ √2 √(x + 1)"),
        (r"\mathrm{arm\_len}^{2} c_{1-2}", "arm_len² c₁₋₂"),
        (r"x^{a b}", "x^(a b)"),
    ],
)
def test_on_one_line(latex: str, shown: str) -> None:
    assert unicode_math.one_line(latex) == shown


def test_a_matrix_beside_its_name() -> None:
    assert unicode_math.lines(r"g = \begin{bmatrix} c_1 & -s_1 \\ 0 & 10 \end{bmatrix} , \quad h = 2", 80) == [
        "    ⎡ c₁   -s₁ ⎤",
        "g = ⎣  0    10 ⎦  ,  h = 2",
    ]


def test_what_is_too_wide_is_broken_and_numbered() -> None:
    long = " + ".join(["x_{1} y_{2}"] * 6)
    shown = unicode_math.lines(rf"A = B = \begin{{bmatrix}} {long} & 1 \\ {long} & 2 \end{{bmatrix}}", 40)
    assert shown[0] == "        ⎡ ⟨1⟩   1 ⎤"
    assert shown[2].startswith("    ⟨1⟩ = x₁ y₂ + x₁ y₂")
    assert unicode_math.lines(r"A = \begin{bmatrix} a \end{bmatrix} \begin{bmatrix} b \end{bmatrix} = c", 14) == [
        "A = [ a ]",
        "    [ b ] = c",
    ]


@pytest.mark.parametrize("name", NAMES)
def test_reports_fit(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for columns in (80, 120):
        monkeypatch.setenv("COLUMNS", str(columns))
        text = reports.write(report(name), "terminal")
        wide = [line for line in text.splitlines() if unicode_math.width(line) > columns]
        assert all("⟨" in line for line in wide), wide
        assert "\\" not in text
        assert "$" not in text


def test_a_terminal_gets_it() -> None:
    pty = pytest.importorskip("pty")
    command = [sys.executable, "-m", "pinscrew", "derive", "one_joint", "--part", "T", "--samples", "1"]
    ours, theirs = pty.openpty()
    done = subprocess.run(command, stdout=theirs, env={**os.environ, "COLUMNS": "80"}, check=False, timeout=60)
    os.close(theirs)
    shown = os.read(ours, 60_000).decode()
    os.close(ours)
    assert done.returncode == 0
    assert "⎡ c₁   -s₁   0" in shown
    assert "The LaTeX of this text was read back" in " ".join(shown.split())
    assert np.all(["\\begin" not in line for line in shown.splitlines()])
