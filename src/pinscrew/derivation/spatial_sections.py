"""The sections on the spatial velocity: V̂^s = ġ g⁻¹, and why its columns are what they are."""

from __future__ import annotations

from collections.abc import Iterable

from pinscrew.derivation.blocks import Block, Formula, Paragraph
from pinscrew.derivation.normal_forms import derivative, hat
from pinscrew.derivation.writer import Writer

__all__ = ["general_column", "spatial_velocity"]


def spatial_velocity(w: Writer) -> Iterable[Block]:
    """V̂^s = ġ g⁻¹, MLS eq. 2.53, and V^s."""
    d, n = w.d, w.n
    if w.steps:
        yield Paragraph(f"The rate of the pose times its inverse ({w.cite('spatial-velocity')}):")
    head = (n.spatial_velocity_hat, f"{n.pose_rate} {w.pose_name}^{{-1}}")
    if w.steps:
        yield from w.product(*head, factors=(d.pose_rate, d.inverse), matrix=d.spatial_hat, name=r"\hat{v}")
    else:
        yield from w.result(*head, matrix=d.spatial_hat, name=r"\hat{v}")
    velocity = n.rows(d.spatial_velocity)
    yield from w.result(n.spatial_velocity, rf"{n.spatial} \dot{{\theta}}", matrix=velocity, name="V")


def general_column(w: Writer) -> Iterable[Block]:
    """(∂g/∂θ_i) g⁻¹ = (Ad_h ξ_i)^ with h = e^{ξ̂_1 θ_1} … e^{ξ̂_{i-1} θ_{i-1}}: MLS §3.4.1, lemmas 2.3 and 2.13."""
    d, n = w.d, w.n
    if w.steps:
        yield from _proof(w)
    for i, joint in enumerate(d.chain.joints, 1):
        partial = d.write(derivative(d.normal.pose, joint))
        column = d.write(hat(d.chain.algebra, d.normal.spatial[:, i - 1]))
        moved = f"[{n.spatial_column.format(i)}]" if n.angular_first else rf"\hat{{\xi}}'_{{{i}}}"
        head = (moved, rf"\frac{{\partial {w.pose_name}}}{{\partial {w.values[i - 1]}}} {w.pose_name}^{{-1}}")
        if w.steps:
            yield from w.product(*head, factors=(partial, d.inverse), matrix=column, name="x")
        else:
            yield from w.result(*head, matrix=column, name="x")


def _proof(w: Writer) -> Iterable[Block]:
    n, g = w.n, w.pose_name
    twist, omega, p = n.twist_hat.format("i"), w.hat(r"\omega"), w.hat("p")
    own = n.exponential(0, r"\theta").replace("_{0}", "_{i}").replace(r"\theta", r"\theta_{i}")
    first = n.exponential(1, r"\theta_{1}")
    last = n.exponential(0, r"\theta").replace("_{0}", "_{i-1}").replace(r"\theta", r"\theta_{i-1}")
    yield Paragraph(
        rf"Only the factor ${own}$ of ${g}$ has $\theta_{{i}}$ in it, and its derivative is ${twist} {own}$. With the "
        rf"product $h = {first} \cdots {last}$ of those before it, and with what comes after it cancelled,"
    )
    after = rf"{own} \cdots {n.home} {g}^{{-1}}"
    derived = rf"\frac{{\partial {g}}}{{\partial \theta_{{i}}}} {g}^{{-1}}"
    yield Formula((derived, f"h {twist} {after}", f"h {twist} h^{{-1}}"))
    yield Paragraph("With $R$ and $p$ of $h$, and $v$ and $\\omega$ of the twist, this is")
    pose = r"\begin{bmatrix} R & p \\ 0 & 1 \end{bmatrix}"
    inner = rf"\begin{{bmatrix}} {omega} & v \\ 0 & 0 \end{{bmatrix}}"
    back = r"\begin{bmatrix} R^{T} & -R^{T} p \\ 0 & 1 \end{bmatrix}"
    product = rf"\begin{{bmatrix}} R {omega} R^{{T}} & R v - R {omega} R^{{T}} p \\ 0 & 0 \end{{bmatrix}}"
    yield Formula((f"h {twist} h^{{-1}}", f"{pose} {inner} {back}", product))
    yield Paragraph(
        rf"Now $R {omega} R^{{T}}$ is the matrix of $R \omega$, and $-(R \omega) \times p = {p} R \omega$: this is "
        rf"the matrix of the twist with the parts $R v + {p} R \omega$ and $R \omega$, $\mathrm{{Ad}}_{{h}}$ times the "
        "twist. So each column is a joint's twist as the joints before it have moved it:"
    )
