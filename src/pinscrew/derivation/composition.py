"""The section on the composition of velocities through a frame between two others."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import sympy as sp

from pinscrew.derivation.blocks import Block, Formula, Paragraph, Section, named
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.normal_forms import adjoint, adjoint_inverse
from pinscrew.derivation.writer import Detail, Writer

__all__ = ["composition_section"]


def composition_section(whole: Derivation, legs: Sequence[Derivation], detail: Detail = "steps") -> Section:
    """V_AC^s = V_AB^s + Ad(g_AB) V_BC^s and V_AC^b = Ad⁻¹(g_BC) V_AB^b + V_BC^b; MLS propositions 2.14 and 2.15.

    Args:
        whole: of C in A.
        legs: of B in A, and of C in B, with the joints called the same.
        detail: how much of the way is shown.
    """
    writers = [Writer(d, detail) for d in (whole, *legs)]
    for w in writers[1:]:
        w.explained = writers[0].explained
    blocks = tuple(_composition(*writers))
    short = [block for w in writers for block in w.short_forms()]
    return Section("", "composition", "Composition of velocities", (*short, *blocks))


def _composition(w: Writer, first: Writer, second: Writer) -> Iterable[Block]:
    g = w.pose_name
    letters = {"A": w.d.reference, "B": first.d.tip, "C": w.d.tip}
    yield Paragraph(f"{', '.join(f'{letter} is {named(frame)}' for letter, frame in letters.items())}:")
    yield from first.result(f"{g}_{{AB}}", matrix=first.d.pose, name="a")
    yield from second.result(f"{g}_{{BC}}", matrix=second.d.pose, name="b")
    head = [f"{g}_{{AC}}", f"{g}_{{AB}} {g}_{{BC}}"]
    if w.steps and not any(x.set.is_wide(x.d.pose) for x in (first, second)):
        head.append(f"{first.set.matrix(first.d.pose)} {second.set.matrix(second.d.pose)}")
    yield from w.result(*head, matrix=w.d.pose, name="c")
    for kind, title, topic in (("s", "Spatial", "spatial-sum"), ("b", "Body", "body-sum")):
        yield Paragraph(f"{title} velocities ({w.cite(topic)}):")
        names = [_name(w, kind, pair) for pair in ("AB", "BC", "AC")]
        values = [_velocity(x, kind) for x in (first, second, w)]
        for name, x, value in zip(names[:2], (first, second), values, strict=False):
            yield from x.result(name, matrix=x.n.rows(value), name="v")
        carried = adjoint(first.d.normal.pose) if kind == "s" else adjoint_inverse(second.d.normal.pose)
        by = first if kind == "s" else second
        matrix = by.n.both(by.d.write(carried))
        name = rf"\mathrm{{Ad}}_{{{g}_{{AB}}}}" if kind == "s" else rf"\mathrm{{Ad}}^{{-1}}_{{{g}_{{BC}}}}"
        general = f"{names[0]} + {name} {names[1]}" if kind == "s" else f"{name} {names[0]} + {names[1]}"
        shown = f"{by.set.matrix(matrix)}"
        a, b = first.column(values[0]), second.column(values[1])
        inserted = f"{a} + {shown} {b}" if kind == "s" else f"{shown} {a} + {b}"
        wide = by.set.is_wide(matrix) or not w.steps
        if wide:
            yield from by.result(name, matrix=matrix, name="d")
            yield Formula((names[2], general))
        heads = (names[2],) if wide else (names[2], general, inserted)
        yield from w.result(*heads, matrix=w.n.rows(values[2]), name="V")


def _name(w: Writer, kind: str, pair: str) -> str:
    letter = r"\mathcal{V}" if w.n.angular_first else "V"
    return f"{letter}^{{{kind}}}_{{{pair}}}"


def _velocity(w: Writer, kind: str) -> sp.ImmutableMatrix:
    return w.d.spatial_velocity if kind == "s" else w.d.body_velocity
