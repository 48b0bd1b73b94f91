"""A whole report: what is given, the sections, and the numerical proof."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Final

from pinscrew.derivation import formats, page
from pinscrew.derivation.asked import NOTHING, ReportQuestion
from pinscrew.derivation.blocks import Block, Paragraph, Section, Table, Writeup, from_file, named
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.notation import NOTATIONS
from pinscrew.derivation.proof import Proof
from pinscrew.derivation.read_back import read_back
from pinscrew.derivation.sections import sections
from pinscrew.derivation.sketch import sketch
from pinscrew.derivation.terminal import to_terminal
from pinscrew.derivation.typeset import Typesetter
from pinscrew.derivation.writer import Detail
from pinscrew.ground.errors import InputError

__all__ = ["given", "report", "write", "written"]


def report(
    derivation: Derivation,
    proof: Proof,
    parts: Iterable[str] = (),
    extra: Sequence[Section] = (),
    detail: Detail = "steps",
) -> Writeup:
    """The report of a derivation.

    Args:
        derivation: the closed forms.
        proof: what the engines say of them.
        parts: keys or letters of sections; by default those that fit the robot's size.
        extra: further sections, before the proof.
        detail: ``"result"`` for results alone, ``"full"`` for every matrix on the way.

    Raises:
        InputError: if there is no such part or detail.
    """
    d = derivation
    listed = (given(d), *sections(d, parts, detail), *extra, _proof(proof))
    title = f"Closed-form kinematics of {from_file(d.robot.name)}"
    return Writeup(title, listed, _code(d), proof.ok)


def given(derivation: Derivation) -> Section:
    """What the derivation starts from: the robot, its lengths and joints, and what was taken for what."""
    d = derivation
    t = Typesetter(d)
    n = NOTATIONS[d.convention]
    blocks: list[Block] = [
        Paragraph(
            f"The motion of the frame {named(d.tip)} in {named(d.reference)}. Twists are in the order {n.order}; "
            f"lengths are in metres, angles in radians. Equations are those of {n.book}."
        )
    ]
    rows: list[tuple[str, ...]] = []
    for joint in d.chain.joints:
        kind = "turns" if joint.revolute else "slides"
        value = f"${t(joint.variable.symbol)}$"
        if joint.master is not joint.variable:
            value += f" $= {t(joint.multiplier * joint.master.symbol)}$"
        rows.append((named(joint.variable.joint), kind, value))
    if rows:
        blocks.append(Table(("joint", "", "value"), tuple(rows)))
    if d.screws:
        blocks.append(sketch(d))
    if d.lengths:
        rows = [(f"${t(s)}$", f"{float(value):.9g}") for s, value in d.lengths.items()]
        blocks += [Paragraph("Symbols, and their values in this file:"), Table(("symbol", "value"), tuple(rows))]
    blocks += [Paragraph(from_file(f"{remark[0].upper()}{remark[1:]}.")) for remark in d.remarks]
    if d.snapped:
        blocks.append(Paragraph("Numbers of the file that were taken for exact ones:"))
        rows = [(from_file(s.where), named(s.printed), f"${t(s.value)}$", f"{s.change:.1e}") for s in d.snapped]
        blocks.append(Table(("where", "printed", "taken for", "change"), tuple(rows)))
    if not d.exact:
        blocks.append(Paragraph("Some numbers are not exact: they are kept to 30 decimals and shown to 6 digits."))
    if d.large:
        blocks.append(Paragraph("For an arm of this size, velocities term by term are shown only where asked for."))
    return Section("", "given", "What is given", tuple(blocks))


def _proof(proof: Proof) -> Section:
    verdict = "Everything agrees." if proof.ok else "SOMETHING DISAGREES: do not use these closed forms."
    lengths = f", each with lengths of its own ({proof.lengths} sets)" if proof.lengths else ""
    blocks: list[Block] = [
        Paragraph(
            f"The largest difference of each closed form from both engines, over {proof.samples} random "
            f"configurations (seed {proof.seed}){lengths}, metres divided by max(1, size of the robot). {verdict}"
        )
    ]
    for is_given, words in ((True, "With the file as it is:"), (False, "With random lengths and exact rotations:")):
        found = [c for c in proof.comparisons if c.given == is_given]
        if not found:
            continue
        engines = list(dict.fromkeys(c.engine for c in found))
        rows = []
        for what in dict.fromkeys(c.what for c in found):
            cells = {c.engine: c for c in found if c.what == what}
            marked = [f"{cells[e].error:.1e}" + ("" if cells[e].ok else " FAIL") for e in engines]
            rows.append((what, *marked, f"{found[0].tolerance:.0e}"))
        blocks += [Paragraph(words), Table(("closed form", *engines, "tolerance"), tuple(rows))]
    if proof.symbolic is not None:
        same = "are one expression" if proof.symbolic else "are NOT one expression"
        blocks.append(Paragraph(f"Symbolically, $g^{{-1}}\\dot{{g}}$ and the body Jacobian times the rates {same}."))
    return Section("", "proof", "Numerical proof", tuple(blocks))


def _code(d: Derivation) -> str:
    arguments = "".join(f", {name}={value!r}" for name, value in d.robot.description.arguments.items())
    return f"import pinscrew as ps\n\nrobot = ps.load({d.robot.name!r}{arguments})\nd = ps.derive(robot, {d.tip!r})"


_COUNTED: Final = "MATRICESREADBACK"
"""Stands for their number in the text until that has been read."""


def written(derivation: Derivation, whole: Writeup, form: str, asked: ReportQuestion = NOTHING) -> str:
    """A report as text that was read back, and says so: see `read_back`.

    Args:
        derivation: what the report is of.
        whole: from `report`.
        asked: what else it is about.
        form: as for `write`.

    Raises:
        ReadBackError: the text does not say what was proved: a mistake in pinscrew, and no text is given.
        InputError, MissingExtraError: as for `write`.
    """
    what = "The LaTeX of this text" if form == "terminal" else "This text"
    said = Paragraph(
        f"{what} was read back: {_COUNTED} matrices were parsed from it by a reader that knows nothing of what "
        "wrote them, evaluated at random values, and agree with PoE and Pinocchio."
    )
    text = write(replace(whole, sections=(*whole.sections, Section("", "read-back", "Read back", (said,)))), form)
    latex = write(whole, "markdown") if form == "terminal" else text
    found = read_back(derivation, latex, "markdown" if form == "terminal" else form, asked=asked)
    return text.replace(_COUNTED, str(found.matrices))


def write(report: Writeup, form: str) -> str:
    """A report as text.

    Args:
        report: the report.
        form: ``"markdown"``, ``"latex"``, ``"html"``, ``"notebook"`` or ``"terminal"``.

    Raises:
        InputError: if there is no such format.
        MissingExtraError: if what HTML needs is not installed.
    """
    if form not in _FORMATS:
        raise InputError("derive-option", f"format={form!r}", remedy=f"use one of {', '.join(_FORMATS)}")
    return _FORMATS[form](report)


_FORMATS: Final[dict[str, Callable[[Writeup], str]]] = {
    "markdown": formats.to_markdown,
    "latex": formats.to_latex,
    "notebook": formats.to_notebook,
    "html": page.to_html,
    "terminal": to_terminal,
}
