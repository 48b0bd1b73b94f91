"""Reports as Markdown, LaTeX and notebooks; `page` has HTML."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Callable
from typing import Any, Final, TypeAlias

from pinscrew.derivation.blocks import Block, Formula, Paragraph, Section, Sketch, Table, Writeup
from pinscrew.derivation.sketch_formats import sketch_latex, sketch_svg
from pinscrew.ground.escaping import latex, markdown

__all__ = ["to_latex", "to_markdown", "to_notebook"]

_LONG: Final = 90
"""Characters of a formula, roughly as seen, above which its parts go on lines of their own."""
_PIECES: Final = re.compile("[\ue000\ue002][^\ue001]*\ue001|" r"\$[^$]*\$|`[^`]*`")
_SIMPLE: Final = re.compile(r"\w[\w./ -]*\w|\w")


def is_long(formula: Formula) -> bool:
    """Whether the parts of a formula are better on lines of their own."""
    widest = sum(max((len(row) for row in part.split(r"\\")), default=0) for part in formula.parts)
    return len(formula.parts) > 2 and widest > 2 * _LONG


def aligned(formula: Formula) -> str:
    """A formula in LaTeX, on several lines where it is long."""
    if not is_long(formula):
        return formula.latex
    first, *rest = formula.parts
    return rf"\begin{{aligned}} {first} &= " + r" \\ &= ".join(rest) + r" \end{aligned}"


def to_markdown(report: Writeup) -> str:
    """The report as Markdown with LaTeX between dollars, as GitHub and Jupyter read it."""
    lines = [f"# {_markdown_text(report.title)}", ""]
    for section in report.sections:
        lines += [f"## {section.heading}", ""]
        for block in section.blocks:
            lines += [] if isinstance(block, Sketch) else [_markdown(block), ""]
    return "\n".join(lines)


def _markdown(block: Paragraph | Formula | Table) -> str:
    if isinstance(block, Formula):
        return f"$$\n{aligned(block)}\n$$"
    if isinstance(block, Paragraph):
        return _markdown_text(block.text)
    rows = [block.head, tuple("---" for _ in block.head), *block.rows]
    return "\n".join("| " + " | ".join(_markdown_text(cell, in_table=True) for cell in row) + " |" for row in rows)


def _markdown_text(text: str, *, in_table: bool = False) -> str:
    """Our own text as it is, names escaped."""

    def own(piece: str) -> str:
        return piece.replace("|", r"\|") if in_table else piece

    def code(name: str) -> str:
        return f"`{name}`" if _SIMPLE.fullmatch(name) else f"<code>{markdown(name)}</code>"

    return split_text(text, own, lambda math: own(f"${math}$"), code, markdown)


_PREAMBLE: Final = r"""\documentclass[11pt]{article}
\usepackage[utf8]{inputenc}
\usepackage{amsmath,amssymb,graphicx,color}
\IfFileExists{pict2e.sty}{\usepackage{pict2e}}{}
\usepackage[a4paper,margin=22mm]{geometry}
\DeclareUnicodeCharacter{03C9}{\ensuremath{\omega}}
\DeclareUnicodeCharacter{03B8}{\ensuremath{\theta}}
\DeclareUnicodeCharacter{03BE}{\ensuremath{\xi}}
\DeclareUnicodeCharacter{0121}{\.{g}}
\DeclareUnicodeCharacter{207B}{\ensuremath{^{-}}}
\DeclareUnicodeCharacter{00B9}{\ensuremath{^{1}}}
\DeclareUnicodeCharacter{00D7}{\ensuremath{\times}}
\setlength{\parindent}{0pt}
\setlength{\parskip}{5pt}
\newsavebox{\formulabox}
% A formula that is wider than the page is made to fit it.
\newcommand{\fitted}[1]{\sbox{\formulabox}{$\displaystyle #1$}%
  \[\ifdim\wd\formulabox>\linewidth\resizebox{\linewidth}{!}{\usebox{\formulabox}}\else\usebox{\formulabox}\fi\]}
\begin{document}
"""


def to_latex(report: Writeup) -> str:
    """The report as a LaTeX document that compiles by itself."""
    lines = [_PREAMBLE + rf"\section*{{{_text(report.title)}}}"]
    for section in report.sections:
        lines.append(rf"\subsection*{{{_text(section.heading)}}}")
        lines += [_latex(block) for block in section.blocks]
    return "\n".join((*lines, r"\end{document}", ""))


def _latex(block: Block) -> str:
    if isinstance(block, Formula):
        return rf"\fitted{{{aligned(block)}}}"
    if isinstance(block, Paragraph):
        return _text(block.text) + "\n"
    if isinstance(block, Sketch):
        return sketch_latex(block)
    columns = "l" * len(block.head)
    rows = [" & ".join(map(_text, row)) + r" \\" for row in (block.head, *block.rows)]
    rows.insert(1, r"\hline")
    return "\n".join((r"\begin{center}", rf"\begin{{tabular}}{{{columns}}}", *rows, r"\end{tabular}", r"\end{center}"))


def _text(text: str) -> str:
    return split_text(text, latex, lambda math: f"${math}$", lambda code: rf"\texttt{{{latex(code)}}}", latex)


Way: TypeAlias = Callable[[str], str]


def split_text(text: str, plain: Way, math: Way, code: Way, from_file: Way) -> str:
    """A paragraph's text with plain pieces, mathematics, code and names, and texts from files, each in its own way."""
    found, end = [], 0
    for match in _PIECES.finditer(text):
        found.append(plain(text[end : match.start()]))
        found.append({"$": math, "\ue002": from_file}.get(match[0][0], code)(match[0][1:-1]))
        end = match.end()
    return "".join((*found, plain(text[end:])))


def to_notebook(report: Writeup) -> str:
    """The report as a Jupyter notebook: its first cell makes the derivation, its last proves it again."""
    cells = [_cell("markdown", f"# {_markdown_text(report.title)}"), _cell("code", report.code)]
    for section in report.sections:
        if section.key == "proof":
            cells += [_cell("markdown", _section(section)), _cell("code", "proof = d.prove()\nproof.ok, proof.largest")]
        else:
            cells.append(_cell("markdown", _section(section)))
            cells += [_cell("code", line) for line in _SHOWN.get(section.key, ())]
    numbered = [{"id": f"cell{i}", **cell} for i, cell in enumerate(cells)]
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    notebook = {
        "nbformat": 4,
        "nbformat_minor": 5,
        "metadata": {"kernelspec": kernel, "language_info": {"name": "python"}},
        "cells": numbered,
    }
    return json.dumps(notebook, indent=1, ensure_ascii=False) + "\n"


_SHOWN: Final = {
    "pose": ("d.pose",),
    "body-jacobian": ('d.jacobian("body")',),
    "spatial-jacobian": ('d.jacobian("spatial")',),
    "velocity-check": ("d.velocities_agree",),
}


def _section(section: Section) -> str:
    return "\n\n".join((f"## {section.heading}", *map(_notebook_block, section.blocks)))


def _notebook_block(block: Block) -> str:
    """As in Markdown, with drawings as pictures in the cell itself."""
    if not isinstance(block, Sketch):
        return _markdown(block)
    data = base64.b64encode(sketch_svg(block).encode("utf-8")).decode("ascii")
    return f"![The arm at zero: links, joint axes and frames](data:image/svg+xml;base64,{data})"


def _cell(kind: str, source: str) -> dict[str, Any]:
    cell: dict[str, Any] = {"cell_type": kind, "metadata": {}, "source": source.splitlines(keepends=True)}
    return cell | {"execution_count": None, "outputs": []} if kind == "code" else cell
