"""The section on the velocity of a point that moves with the frame."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import sympy as sp

from pinscrew.derivation.asked import ReportQuestion
from pinscrew.derivation.blocks import Block, Formula, Paragraph, Section, named
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.forms import ClosedForms
from pinscrew.derivation.writer import Detail, Writer

__all__ = ["at_values", "point_section"]


def point_section(derivation: Derivation, asked: ReportQuestion, detail: Detail = "steps") -> Section:
    """The section: q_a = g q_b, v_a = V̂^s q_a and v_b = V̂^b q_b (MLS §2.4.2), and at the values that are asked for."""
    w = Writer(derivation, detail)
    blocks = tuple(_point(w, asked))
    return Section("", "point", "Velocity of a point", (*w.short_forms(), *blocks))


def _point(w: Writer, asked: ReportQuestion) -> Iterable[Block]:
    d, n = w.d, w.n
    homogeneous = sp.ImmutableMatrix([*(asked.point or sp.zeros(3, 1)), 1])
    yield Paragraph(
        f"A point that moves with {named(d.tip)}. With $a$ for {named(d.reference)} and $b$ for {named(d.tip)}, and a "
        "fourth coordinate that is 1 of points and 0 of velocities:"
    )
    q = np.array([[d.chain.algebra.constant(x)] for x in homogeneous], dtype=object)
    spatial = d.write(d.normal.pose @ q)
    velocity_a = d.in_rates(d.write(d.normal.pose_rate @ q))
    velocity_b = d.in_rates(d.write(d.normal.body_hat @ q))
    yield Formula(("q_{b}", w.set.matrix(homogeneous)))
    head = ("q_{a}", f"{w.pose_name} q_{{b}}")
    yield from w.product(*head, factors=(d.pose, homogeneous), matrix=spatial, name="q")
    head = (r"v_{q_{a}}", f"{n.spatial_velocity_hat} q_{{a}}")
    yield from w.product(*head, factors=(d.spatial_hat, spatial), matrix=velocity_a, name="v")
    head = (r"v_{q_{b}}", f"{n.body_velocity_hat} q_{{b}}")
    yield from w.product(*head, factors=(d.body_hat, homogeneous), matrix=velocity_b, name="v")
    if asked.at:
        values = [w.set(asked.at[v.symbol]) if v.symbol in asked.at else r"\cdot" for v in d.coordinates]
        place = f"({', '.join(values)})"
        yield Paragraph("At these values of the coordinates, a dot for one that is free:")
        yield from w.result(rf"v_{{q_{{a}}}}{place}", matrix=at_values(d, velocity_a, asked), name="v")
        yield from w.result(rf"v_{{q_{{b}}}}{place}", matrix=at_values(d, velocity_b, asked), name="v")


def at_values(d: ClosedForms, matrix: sp.Matrix, asked: ReportQuestion) -> sp.ImmutableMatrix:
    """A matrix with the values of some coordinates put in, in sines and cosines of the others."""
    short = {meaning: symbol for symbol, meaning in d.atoms.explicit.items()}
    for joint in d.chain.joints:
        if joint.revolute:
            algebra, angle = d.chain.algebra, joint.variable.symbol
            c, s = d.write(np.array([[algebra.cosine(angle), algebra.sine(angle)]], dtype=object))
            short |= {sp.cos(angle): c, sp.sin(angle): s}
    put = d.in_coordinates(sp.ImmutableMatrix(matrix)).subs(dict(asked.at))
    return sp.ImmutableMatrix(put.applyfunc(lambda x: sp.factor_terms(sp.expand(_split(x)).xreplace(short))))


def _split(expression: sp.Expr) -> sp.Expr:
    """cos(θ + π/6) as cos θ cos π/6 - sin θ sin π/6."""

    def one(x: sp.Expr) -> sp.Expr:
        fixed, free = x.args[0].as_independent(*x.free_symbols, as_Add=True)
        c, s = sp.cos(fixed), sp.sin(fixed)
        return c * sp.cos(free) - s * sp.sin(free) if x.func is sp.cos else s * sp.cos(free) + c * sp.sin(free)

    return expression.replace(lambda x: isinstance(x, (sp.cos, sp.sin)) and x.free_symbols, one)
