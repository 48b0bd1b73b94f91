"""The section on screws: pitch, axis and magnitude of each twist, with the numbers put in."""

from __future__ import annotations

from collections.abc import Iterable

from pinscrew.derivation.blocks import Block, Formula, Paragraph
from pinscrew.derivation.chain import cross
from pinscrew.derivation.writer import Writer

__all__ = ["screws"]


def screws(w: Writer) -> Iterable[Block]:
    """h = ωᵀv/‖ω‖², the line through ω × v/‖ω‖² along ω, and M = ‖ω‖; MLS §2.3.3."""
    if w.steps:
        pitch = r"h = \frac{\omega^{T} v}{\|\omega\|^{2}}"
        line = r"\frac{\omega \times v}{\|\omega\|^{2}} + \lambda \omega"
        yield Paragraph(
            rf"A twist with $\omega \neq 0$ is a turn about the line of the points ${line}$, with the pitch ${pitch}$ "
            rf"and the magnitude $M = \|\omega\|$ ({w.cite('twist')}). Where $\omega = 0$ it is a slide along $v$: the "
            r"line goes through the origin, the pitch is infinite, and $M = \|v\|$."
        )
    for i in w.numbers:
        yield from _screw(w, i)


def _screw(w: Writer, i: int) -> Iterable[Block]:
    screw, twist = w.d.screws[i - 1], w.d.chain.joints[i - 1].twist
    omega, v = w.set.matrix(screw.omega), w.set.matrix(screw.v)
    if not screw.revolute:
        yield Paragraph(f"Joint {i} slides: $h_{{{i}}}$ is infinite, and the line goes through the origin along")
        yield Formula((f"v_{{{i}}}", rf"{v} , \quad M_{{{i}}}", rf"\|v_{{{i}}}\|", rf"\|{v}\|", "1"))
        return
    h = w.d.write(twist[None, 3:] @ twist[:3, None])[0]
    point = w.d.write(cross(twist[3:], twist[:3]).reshape(3, 1))
    row = w.set.matrix(screw.omega.T)
    size = rf"\|\omega_{{{i}}}\|^{{2}}"
    along, across = rf"\omega_{{{i}}}^{{T}} v_{{{i}}}", rf"\omega_{{{i}}} \times v_{{{i}}}"
    yield Formula((f"M_{{{i}}}", rf"\|\omega_{{{i}}}\|", rf"\|{omega}\|", "1"))
    yield Formula((f"h_{{{i}}}", rf"\frac{{{along}}}{{{size}}}", f"{row} {v}", w.set(h)))
    end = rf"{w.set.matrix(point)} , \quad \omega_{{{i}}}"
    yield Formula((rf"\frac{{{across}}}{{{size}}}", rf"{omega} \times {v}", end, omega))
