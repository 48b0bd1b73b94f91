r"""Drawings as SVG, and as LaTeX's own ``picture``, which needs no package; pict2e makes it smoother where it is."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import hypot
from typing import Final

from pinscrew.derivation.blocks import Sketch, SketchLine
from pinscrew.derivation.unicode_math import one_line
from pinscrew.ground.escaping import latex, visible, xml

__all__ = ["sketch_latex", "sketch_svg"]

DASH, GAP = 4.0, 3.0
"""Of dashed lines, in points."""
_TEXT: Final = 'font-family="STIX Two Text, Charter, Georgia, serif" font-size="12" text-anchor="middle"'


def sketch_svg(drawing: Sketch, *, in_page: bool = False) -> str:
    """The drawing as one ``<svg>`` element, without script, style sheet, link or font; a file, or ``in_page``."""
    namespace = "" if in_page else 'xmlns="http://www.w3.org/2000/svg" '
    width, height = drawing.size
    parts = [
        f'<svg {namespace}width="{width:.0f}" height="{height:.0f}" viewBox="0 0 {width:.1f} {height:.1f}" role="img">',
        "<title>The arm at zero: links, joint axes and frames</title>",
    ]
    for line in drawing.lines:
        points = " ".join(f"{x:.1f},{height - y:.1f}" for x, y in line.points)
        dashes = f' stroke-dasharray="{DASH:g} {GAP:g}"' if line.dashed else ""
        parts.append(
            f'<polyline points="{points}" fill="none" stroke="{line.color}" stroke-width="{line.width:g}" '
            f'stroke-linecap="round" stroke-linejoin="round"{dashes}/>'
        )
    for label in drawing.labels:
        text = one_line(label.text) if label.formula else visible(label.text)
        slanted = ' font-style="italic"' if label.formula else ""
        x, y = label.at[0], height - label.at[1] + 4.0
        # A white rim keeps the letters readable on lines.
        parts.append(
            f'<text x="{x:.1f}" y="{y:.1f}" {_TEXT}{slanted} fill="{label.color}" stroke="#ffffff" '
            f'stroke-width="3" paint-order="stroke">{xml(text)}</text>'
        )
    return "".join((*parts, "</svg>"))


def sketch_latex(drawing: Sketch) -> str:
    """The drawing as a ``picture``; straight lines of any slope are Bézier curves through their own middle."""
    width, height = drawing.size
    found = [r"\begin{center}\setlength{\unitlength}{1pt}", rf"\begin{{picture}}({width:.0f},{height:.0f})"]
    for line in drawing.lines:
        found.append(rf"{_color(line.color)}\linethickness{{{line.width:g}pt}}")
        for (ax, ay), (bx, by) in _dashes(line):
            if max(abs(ax - bx), abs(ay - by)) <= line.width:  # seen end-on: TeX divides by the length of a curve
                found.append(rf"\put({ax:.1f},{ay:.1f}){{\circle*{{{line.width:g}}}}}")
                continue
            middle = f"({(ax + bx) / 2:.1f},{(ay + by) / 2:.1f})"
            found.append(rf"\qbezier({ax:.1f},{ay:.1f}){middle}({bx:.1f},{by:.1f})")
    for label in drawing.labels:
        text = f"${label.text}$" if label.formula else rf"\texttt{{{latex(label.text)}}}"
        place = f"({label.at[0]:.1f},{label.at[1]:.1f})"
        found.append(rf"\put{place}{{\makebox(0,0){{{_color(label.color)}\small {text}}}}}")
    return "\n".join((*found, r"\end{picture}", r"\end{center}"))


def _color(color: str) -> str:
    """``#rrggbb`` for the package color, which comes with every LaTeX."""
    red, green, blue = (int(color[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return rf"\color[rgb]{{{red:.2f},{green:.2f},{blue:.2f}}}"


def _dashes(line: SketchLine) -> Iterator[tuple[tuple[float, float], tuple[float, float]]]:
    for (ax, ay), (bx, by) in pairwise(line.points):
        length = hypot(bx - ax, by - ay)
        if not line.dashed or length == 0.0:
            yield (ax, ay), (bx, by)
            continue
        start = 0.0
        while start < length:
            end = min(start + DASH, length)
            yield tuple((ax + t / length * (bx - ax), ay + t / length * (by - ay)) for t in (start, end))  # type: ignore[misc]
            start += DASH + GAP
