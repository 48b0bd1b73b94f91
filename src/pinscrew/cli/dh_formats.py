"""DH tables as JSON, CSV, Markdown, LaTeX, Python and MATLAB."""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING, Final

from pinscrew.cli.output import plain
from pinscrew.ground.escaping import csv_row, json_text, latex, markdown
from pinscrew.ground.escaping_code import matlab_comment, python_comment

if TYPE_CHECKING:
    from pinscrew.dh.table import DHRow, DHTable

__all__ = ["DH_FORMATS", "dh_cells"]


def dh_cells(row: DHRow, index: int) -> tuple[str, str, str, str, str]:
    """θ, d, a, α and β of a row for reading: q where the joint's value is added, angles in parts of π."""
    factor = "" if row.multiplier == 1.0 else f"{row.multiplier:.12g}·"
    variable = f"{factor}q{index}"
    theta, d = _pi(row.theta), f"{row.d:.12g}"
    if row.prismatic:
        d = variable if row.d == 0.0 else f"{variable} {'+' if row.d > 0 else '-'} {abs(row.d):.12g}"
    else:
        theta = variable if row.theta == 0.0 else f"{variable} {'+' if row.theta > 0 else '-'} {_pi(abs(row.theta))}"
    return theta, d, f"{row.a:.12g}", _pi(row.alpha), _pi(row.beta)


def _pi(value: float) -> str:
    part = Fraction(round(value * 12.0 / math.pi), 12)
    if part == 0 or abs(value - float(part) * math.pi) > 1e-15 * math.pi:
        return f"{value:.12g}"
    top = {1: "π", -1: "-π"}.get(part.numerator, f"{part.numerator}π")
    return top if part.denominator == 1 else f"{top}/{part.denominator}"


def _headings(table: DHTable) -> tuple[str, str, str, str, str]:
    return ("θ", "d", "a", "α", "β") if table.convention == "standard" else ("θ", "d", "a (i-1)", "α (i-1)", "β (i-1)")


def _json(table: DHTable, differences: dict[str, float]) -> str:
    rows = [
        {
            "joint": row.joint,
            "type": "prismatic" if row.prismatic else "revolute",
            "multiplier": row.multiplier,
            "theta": row.theta,
            "d": row.d,
            "a": row.a,
            "alpha": row.alpha,
            "beta": row.beta,
        }
        for row in table.rows
    ]
    return json_text(
        {
            "schema": "pinscrew.dh/1",
            "robot": table.robot,
            "base": table.base,
            "tip": table.tip,
            "convention": table.convention,
            "rows": rows,
            "T_base_0": plain(table.T_base_0),
            "T_n_tool": plain(table.T_n_tool),
            "differences": differences,
        }
    )


def _csv(table: DHTable, _: dict[str, float]) -> str:
    heading = ("joint", "type", "multiplier", "theta_rad", "d_m", "a_m", "alpha_rad", "beta_rad")
    rows = (
        (r.joint, "prismatic" if r.prismatic else "revolute", r.multiplier, r.theta, r.d, r.a, r.alpha, r.beta)
        for r in table.rows
    )
    return "\n".join(map(csv_row, (heading, *rows)))


def _markdown(table: DHTable, differences: dict[str, float]) -> str:
    lines = ["| joint | " + " | ".join(_headings(table)) + " |", "|---|---|---|---|---|---|"]
    for i, row in enumerate(table.rows, 1):
        lines.append(f"| {markdown(row.joint)} | " + " | ".join(dh_cells(row, i)) + " |")
    proved = ", ".join(f"{name} {error:.1e}" for name, error in differences.items())
    return "\n".join((*lines, "", f"{table.convention} DH; m, rad; largest difference: {proved}"))


def _latex(table: DHTable, _: dict[str, float]) -> str:
    index = "i" if table.convention == "standard" else "i-1"
    heads = (r"\theta_i", "d_i", f"a_{{{index}}}", rf"\alpha_{{{index}}}", rf"\beta_{{{index}}}")
    lines = [r"\begin{tabular}{lccccc}", " & ".join(("joint", *(f"${h}$" for h in heads))) + r" \\ \hline"]
    for i, row in enumerate(table.rows, 1):
        cells = (c.replace(f"q{i}", f"q_{{{i}}}").replace("π", r"\pi").replace("·", r"\,") for c in dh_cells(row, i))
        lines.append(" & ".join((latex(row.joint), *(f"${c}$" for c in cells))) + r" \\")
    return "\n".join((*lines, r"\end{tabular}"))


def _numbers(table: DHTable) -> list[list[float]]:
    return [[r.theta, r.d, r.a, r.alpha, r.beta] for r in table.rows]


def _about(table: DHTable) -> str:
    joints = ", ".join(row.joint for row in table.rows)
    return f"{table.convention} DH of {table.tip} in {table.base}; theta, d, a, alpha, beta (m, rad); rows {joints}"


def _python(table: DHTable, _: dict[str, float]) -> str:
    lines = ["import numpy as np", "", f"# {python_comment(_about(table))}"]
    for name, rows in (
        ("dh", _numbers(table)),
        ("T_base_0", plain(table.T_base_0)),
        ("T_n_tool", plain(table.T_n_tool)),
    ):
        lines += [f"{name} = np.array([", *(f"    {row!r}," for row in rows), "])"]
    return "\n".join((*lines, f"prismatic = {[row.prismatic for row in table.rows]!r}"))


def _matlab(table: DHTable, _: dict[str, float]) -> str:
    lines = [f"% {matlab_comment(_about(table))}"]
    for name, rows in (
        ("dh", _numbers(table)),
        ("T_base_0", plain(table.T_base_0)),
        ("T_n_tool", plain(table.T_n_tool)),
    ):
        lines += [f"{name} = [", *(f"    {' '.join(map(repr, row))}" for row in rows), "];"]
    return "\n".join((*lines, f"prismatic = [{' '.join(str(int(row.prismatic)) for row in table.rows)}];"))


DH_FORMATS: Final[dict[str, Callable[[DHTable, dict[str, float]], str]]] = {
    "csv": _csv,
    "markdown": _markdown,
    "latex": _latex,
    "python": _python,
    "matlab": _matlab,
    "json": _json,
}
