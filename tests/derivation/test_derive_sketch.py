"""The drawing of the arm: where things stand in it, and that every format carries it."""

from __future__ import annotations

import base64
import json
import re
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import pinscrew as ps
import urdfs
from pinscrew.derivation import proof, reports
from pinscrew.derivation.sketch import sketch
from pinscrew.derivation.sketch_formats import sketch_latex, sketch_svg
from pinscrew.description import catalogue

SPHERICAL = ps.derive(ps.load("spherical_rrp"))


@pytest.mark.parametrize("name", [entry.name for entry in catalogue.bundled()])
def test_everything_is_inside(name: str) -> None:
    drawing = sketch(ps.derive(ps.load(name)))
    points = np.array([p for line in drawing.lines for p in line.points] + [label.at for label in drawing.labels])
    assert (points >= 0).all()
    assert (points <= np.array(drawing.size) + 16).all()
    assert {label.text for label in drawing.labels} >= {"base", "tool", "x", "y", "z", r"\xi_{1}"}
    ET.fromstring(sketch_svg(drawing))  # noqa: S314 (our own)


def test_where_things_stand() -> None:
    """The spherical arm goes up along z, then to the right along y; joint 1 is above the base."""
    drawing = sketch(SPHERICAL)
    link = next(line for line in drawing.lines if line.width > 3)
    base, first, _, third, tool = link.points
    assert base[0] == pytest.approx(first[0])
    assert first[1] > base[1]
    assert tool[0] > third[0]
    ratio = np.hypot(*np.subtract(tool, first)) / (first[1] - base[1])
    assert ratio == pytest.approx(
        0.8 / 0.5 * np.hypot(np.cos(0.4887), np.sin(0.4887) * np.sin(0.384)) / np.cos(0.384), 1e-3
    )
    at = {label.text: label.at for label in drawing.labels}
    assert at[r"\xi_{1}"][0] == pytest.approx(base[0])
    assert at[r"\xi_{1}"][1] > first[1]


def test_every_format_carries_it() -> None:
    whole = reports.report(SPHERICAL, proof.Proof(0, 0, 0, (), None))
    svg = sketch_svg(sketch(SPHERICAL))
    assert sketch_svg(sketch(SPHERICAL), in_page=True) in reports.write(whole, "html")
    assert sketch_latex(sketch(SPHERICAL)) in reports.write(whole, "latex")
    cells = json.loads(reports.write(whole, "notebook"))["cells"]
    text = "".join("".join(cell["source"]) for cell in cells)
    data = re.search(r"data:image/svg\+xml;base64,([\w+/=]+)", text)
    assert data
    assert base64.b64decode(data[1]).decode() == svg
    assert "svg" not in reports.write(whole, "markdown")


def test_names_are_text() -> None:
    joint = urdfs.joint("j", "revolute", "base", "&lt;b&gt;_$", xyz="0 0 1")
    d = ps.derive(urdfs.load(f'<robot name="r"><link name="base"/><link name="&lt;b&gt;_$"/>{joint}</robot>'))
    root = ET.fromstring(sketch_svg(sketch(d)))  # noqa: S314 (our own)
    texts = [e.text for e in root.iter("{http://www.w3.org/2000/svg}text")]
    assert "<b>_$" in texts
    assert r"\texttt{\textless{}b\textgreater{}\_\$}" in sketch_latex(sketch(d)).replace(
        "<b>", r"\textless{}b\textgreater{}"
    )


@pytest.mark.parametrize("name", ["spherical_rrp", "gear_pair", "lead_screw", "scara"])
def test_no_curve_of_latex_is_a_point(name: str) -> None:
    """TeX divides by how far a curve goes: a line that is seen end-on is a dot."""
    drawn = sketch_latex(sketch(ps.derive(name)))
    ends = re.findall(r"\\qbezier\((.*?)\)\(.*?\)\((.*?)\)", drawn)
    assert ends
    for pair in ends:
        (ax, ay), (bx, by) = (map(float, end.split(",")) for end in pair)
        assert max(abs(ax - bx), abs(ay - by)) > 0.2
    assert r"\circle*" in drawn or name == "scara"
