"""Reports as one HTML file that needs no network: mathematics as MathML, its font inside, its LaTeX one click away."""

from __future__ import annotations

import base64
import hashlib
import re
from importlib.resources import files
from typing import Final

from pinscrew.derivation.blocks import Block, Formula, Paragraph, Section, Sketch, Table, Writeup
from pinscrew.derivation.formats import is_long, split_text
from pinscrew.derivation.sketch_formats import sketch_svg
from pinscrew.ground.errors import MissingExtraError
from pinscrew.ground.escaping import html as escape

__all__ = ["to_html"]

_STYLE: Final = """
@font-face { font-family: "Writeup Math"; src: url(data:font/woff2;base64,FONT) format("woff2"); }
:root { color-scheme: light; --ink: #1a1a1a; --faint: #6b6b6b; --line: #d9d9d9; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 2.5rem 1.5rem 5rem; max-width: 62rem; color: var(--ink); background: #fff;
  font: 1.06rem/1.6 Charter, "Bitstream Charter", "Source Serif 4", Georgia, "DejaVu Serif", serif; }
math { font-family: "Writeup Math", math; }
h1 { font-size: 1.75rem; line-height: 1.25; font-weight: 600; margin: 0 0 1.2rem; }
h2 { font-size: 1.2rem; font-weight: 600; margin: 2.8rem 0 0.6rem; padding-bottom: 0.25rem;
  border-bottom: 1px solid var(--line); }
p { margin: 0.7rem 0; max-width: 46rem; }
code { font-family: "DejaVu Sans Mono", Menlo, Consolas, monospace; font-size: 0.86em; }
nav { font-size: 0.92rem; columns: 18rem 2; margin: 0 0 1rem; }
nav a { display: block; color: inherit; text-decoration: none; padding: 0.08rem 0; }
nav a:hover { text-decoration: underline; }
.formula { display: flex; align-items: flex-start; gap: 0.8rem; margin: 0.5rem 0; position: relative; }
.lines { overflow-x: auto; overflow-y: hidden; flex: 1 1 auto; padding: 0.35rem 0 0.35rem 1.6rem; min-width: 0; }
.lines > div { margin: 0.3rem 0; width: max-content; }
.lines > div + div { padding-left: 2.2rem; }
mtd { padding: 0.18em 0.55em; }
mtable { math-style: normal; }
details { flex: none; font-size: 0.72rem; color: var(--faint); padding-top: 0.4rem; }
details[open] { flex-basis: 42%; }
summary { cursor: pointer; list-style: none; letter-spacing: 0.02em; opacity: 0.55; }
summary::-webkit-details-marker { display: none; }
summary:hover, summary:focus-visible { opacity: 1; text-decoration: underline; }
details pre { white-space: pre-wrap; overflow-wrap: anywhere; margin: 0.3rem 0 0; padding: 0.5rem; user-select: all;
  background: #f6f6f4; border-radius: 3px; font: 0.95em/1.4 "DejaVu Sans Mono", Menlo, monospace; color: var(--ink); }
table.data { border-collapse: collapse; margin: 0.8rem 0 1rem; font-size: 0.95rem; }
table.data th { text-align: left; font-weight: 600; border-bottom: 1.5px solid var(--ink); }
table.data th, table.data td { padding: 0.22rem 1.4rem 0.22rem 0; }
table.data tbody td { border-bottom: 1px solid #ececec; }
figure.arm { margin: 1rem 0 1.4rem; }
figure.arm svg { max-width: 100%; height: auto; }
.failed { color: #b00020; font-weight: 600; }
@media (max-width: 40rem) { body { padding: 1.2rem 0.9rem 3rem; } .lines { padding-left: 0; } }
@media print { details, nav { display: none; } body { max-width: none; padding: 0; font-size: 10pt; }
  h2 { break-after: avoid; } .formula { break-inside: avoid; } .lines { overflow: visible; } }
"""


# What latex2mathml writes, and what browsers need: a bracket stretches to its own row only, and accents sit tight.
_REPAIRS: Final = (
    ("<mo>&#x0005B;</mo><mtable>", '<mrow><mo stretchy="true">&#x0005B;</mo><mtable>'),
    ("</mtable><mo>&#x0005D;</mo>", '</mtable><mo stretchy="true">&#x0005D;</mo></mrow>'),
    ("<mo>&#x0005E;</mo></mover>", '<mo stretchy="false">&#x002C6;</mo></mover>'),
)
_ACCENT: Final = re.compile(r"<mover>(<mrow>(?:(?!<mover|</mover>).)*</mrow><mo>&#x002D9;</mo></mover>)")

_SCRIPT: Final = """
for (const line of document.querySelectorAll(".lines > div")) {
  const room = line.parentElement.clientWidth - 30;
  if (line.scrollWidth > room) line.style.fontSize = Math.max(0.55, room / line.scrollWidth) + "em";
}
"""
"""Makes formulas that are wider than the page smaller; what is still wider scrolls."""


def to_html(report: Writeup) -> str:
    """The report as one HTML file.

    Raises:
        MissingExtraError: if latex2mathml is not installed.
    """
    links = "".join(f'<a href="#{s.key}">{escape(s.heading)}</a>' for s in report.sections)
    failed = "" if report.ok else '<p class="failed">The numerical proof failed: do not use these closed forms.</p>'
    body = "".join(map(_section, report.sections))
    font = files("pinscrew.derivation").joinpath("fonts", "stix-two-math-subset.woff2").read_bytes()
    style = _STYLE.replace("FONT", base64.b64encode(font).decode("ascii"))
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{escape(_policy())}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(_plain(report.title))}</title>\n<style>{style}</style>\n</head>\n<body>\n"
        f"<h1>{_text(report.title)}</h1>\n<nav>{links}</nav>\n{failed}{body}<script>{_SCRIPT}</script>\n</body>\n</html>\n"
    )


def _policy() -> str:
    """The page runs its own script and loads nothing."""
    digest = base64.b64encode(hashlib.sha256(_SCRIPT.encode()).digest()).decode("ascii")
    return (
        f"default-src 'none'; script-src 'sha256-{digest}'; style-src 'unsafe-inline'; font-src data:; "
        "base-uri 'none'; form-action 'none'"
    )


def _plain(text: str) -> str:
    return split_text(text, str, str, str, str)


def _section(section: Section) -> str:
    blocks = "\n".join(map(_block, section.blocks))
    return f'<section id="{section.key}">\n<h2>{escape(section.heading)}</h2>\n{blocks}\n</section>\n'


def _block(block: Block) -> str:
    if isinstance(block, Formula):
        return _formula(block)
    if isinstance(block, Paragraph):
        return f"<p>{_text(block.text)}</p>"
    if isinstance(block, Sketch):
        return f'<figure class="arm">{sketch_svg(block, in_page=True)}</figure>'
    return _table(block)


def _formula(formula: Formula) -> str:
    first, *rest = formula.parts
    lines = [formula.latex]
    if is_long(formula):
        lines = [f"{first} = {rest[0]}", *(f"= {part}" for part in rest[1:])]
    shown = "".join(f"<div>{_math(line, 'block')}</div>" for line in lines)
    source = f"<details><summary>LaTeX</summary><pre>{escape(formula.latex)}</pre></details>"
    return f'<div class="formula"><div class="lines">{shown}</div>{source}</div>'


def _table(table: Table) -> str:
    head = "".join(f"<th>{_text(cell)}</th>" for cell in table.head)
    rows = "".join("<tr>" + "".join(f"<td>{_text(cell)}</td>" for cell in row) + "</tr>" for row in table.rows)
    return f'<table class="data"><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>'


def _text(text: str) -> str:
    return split_text(
        text, escape, lambda math: _math(math, "inline"), lambda code: f"<code>{escape(code)}</code>", escape
    )


def _math(latex: str, display: str) -> str:
    try:
        from latex2mathml.converter import convert
    except ImportError:
        raise MissingExtraError("latex2mathml is not installed", "derive") from None
    found: str = convert(latex, display=display)
    for made, wanted in _REPAIRS:
        found = found.replace(made, wanted)
    return _ACCENT.sub(r'<mover accent="true">\1', found)
