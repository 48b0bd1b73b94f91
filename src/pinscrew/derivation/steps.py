"""The matrices on the way to the results of a report, for ``--detail full``."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import sympy as sp

from pinscrew.derivation.blocks import Block, Formula, Paragraph
from pinscrew.derivation.writer import Writer
from pinscrew.lie import so3

__all__ = ["adjoint", "exponential", "suffix", "velocity"]


def exponential(w: Writer, i: int) -> Iterable[Block]:
    """e^{ω̂θ} term by term, then the position: MLS eq. 2.14 and 2.36, LP eq. 3.51 and 3.88."""
    d, joint, screw = w.d, w.d.chain.joints[i - 1], w.d.screws[i - 1]
    if not screw.revolute:
        v = w.set.matrix(screw.v)
        yield Paragraph(f"Joint {i} slides: $R = I$, and the position is its value times its direction:")
        slid = (rf"v_{{{i}}} {w.values[i - 1]}", f"{v} {w.values[i - 1]}")
        yield from w.result(*slid, matrix=d.exponentials[i - 1][:3, 3], name="p")
        return
    algebra, angle = d.chain.algebra, joint.variable.symbol
    cosine, sine = d.write(np.array([[algebra.cosine(angle), algebra.sine(angle)]], dtype=object))
    omega, rotation = w.hat("\\omega", str(i)), d.exponentials[i - 1][:3, :3]
    shown = w.set.matrix
    W = so3.hat(screw.omega)
    name = rf"e^{{{omega} {w.values[i - 1]}}}"
    position = r"(I - R) (\omega \times v) + \omega \omega^{T} v \theta"
    yield Paragraph(f"Joint {i} turns: $R = {name}$ term by term, and then the position ${position}$.")
    yield Formula((omega, rf"{shown(W)} , \quad {omega}^{{2}}", shown(W * W)))
    sides = (("I", omega, f"{omega}^{{2}}"), tuple(map(shown, (sp.eye(3), W, W * W))))
    terms = [f"{one} + {first} {w.set(sine)} + {second} (1 - {w.set(cosine)})" for one, first, second in sides]
    yield from w.result(name, *terms, matrix=rotation, name="r")
    moment = screw.omega.cross(screw.v)
    crossed = rf"\omega_{{{i}}} \times v_{{{i}}}"
    yield Formula((crossed, rf"{shown(screw.omega)} \times {shown(screw.v)}", shown(moment)))
    along = rf"\omega_{{{i}}} \omega_{{{i}}}^{{T}} v_{{{i}}} {w.values[i - 1]}"
    pitch = f"{shown(screw.omega)} {shown(screw.omega.T)} {shown(screw.v)} {w.values[i - 1]}"
    heads = [f"(I - {name}) ({crossed}) + {along}"]
    if not w.set.is_wide(rotation):
        heads.append(f"{shown(sp.eye(3) - rotation)} {shown(moment)} + {pitch}")
    yield from w.result(*heads, matrix=d.exponentials[i - 1][:3, 3], name="p")


def velocity(w: Writer) -> Iterable[Block]:
    """Rᵀ, ṗ, Rᵀṗ, Ṙ and RᵀṘ apart: v^b = Rᵀṗ and ω̂^b = RᵀṘ, MLS eq. 2.55."""
    d = w.d
    back, p_rate, R_rate = d.pose[:3, :3].T, d.pose_rate[:3, 3], d.pose_rate[:3, :3]
    yield Paragraph(r"The linear part is $R^{T} \dot{p}$, the matrix of the angular part $R^{T} \dot{R}$:")
    yield from w.result("R^{T}", matrix=back, name="r")
    yield from w.result(r"\dot{p}", matrix=p_rate, name=r"\dot{p}")
    yield from w.product(r"R^{T} \dot{p}", factors=(back, p_rate), matrix=d.body_hat[:3, 3], name="v")
    yield from w.result(r"\dot{R}", matrix=R_rate, name=r"\dot{r}")
    yield from w.product(r"R^{T} \dot{R}", factors=(back, R_rate), matrix=d.body_hat[:3, :3], name="w")


def suffix(w: Writer, i: int) -> Iterable[Block]:
    """g_i = e^{ξ̂_i θ_i} … g(0), p̂ and -Rᵀp̂: the blocks of its inverse adjoint, MLS §2.4.2."""
    name = f"{w.pose_name}_{{{i}}}"
    g, inverse = w.d.tails[i - 1], w.d.body_adjoints[i - 1]
    product = " ".join(w.exponential(k) for k in range(i, len(w.values) + 1))
    yield from w.result(name, f"{product} {w.n.home}", matrix=g, name=w.pose_name)
    p_hat = w.hat("p", name)
    yield from w.result(p_hat, matrix=so3.hat(g[:3, 3]), name="p")
    head = f"-R_{{{name}}}^{{T}} {p_hat}"
    if not any(map(w.set.is_wide, (g, so3.hat(g[:3, 3])))):
        inserted = f"-{w.set.matrix(g[:3, :3].T)} {w.set.matrix(so3.hat(g[:3, 3]))}"
        yield from w.result(head, inserted, matrix=inverse[:3, 3:], name="c")
    else:
        yield from w.result(head, matrix=inverse[:3, 3:], name="c")


def adjoint(w: Writer) -> Iterable[Block]:
    """p̂ and p̂R of Ad_g, MLS eq. 2.58."""
    d = w.d
    p_hat = so3.hat(d.pose[:3, 3])
    yield from w.result(w.hat("p"), matrix=p_hat, name="p")
    factors = (p_hat, d.pose[:3, :3])
    yield from w.product(f"{w.hat('p')} R", factors=factors, matrix=d.adjoint[:3, 3:], name="c")
