"""The sections of a report: each with the formula in general, the numbers put in, and the result.

Letters (a) to (k) are those of the coursework that is the model of all this; (l) to (r) go on from there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

import sympy as sp

from pinscrew.derivation import steps
from pinscrew.derivation.blocks import Block, Formula, Paragraph, Section, named
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.geometric import geometric
from pinscrew.derivation.parts import PARTS, wanted
from pinscrew.derivation.screw_section import screws
from pinscrew.derivation.spatial_sections import general_column, spatial_velocity
from pinscrew.derivation.writer import Detail, Writer

__all__ = ["sections"]


def sections(derivation: Derivation, parts: Iterable[str] = (), detail: Detail = "steps") -> list[Section]:
    """The sections that are asked for, in order, and how much of each; see `wanted` and `writer`."""
    writer = _Sections(derivation, detail)
    makers: dict[str, tuple[str, Callable[[], Iterable[Block]]]] = {
        "home": ("Home pose and axes", writer.home),
        "twists": ("Twists", writer.twists),
        "exponentials": ("Exponentials", writer.exponentials),
        "pose": ("Pose by the product of exponentials", writer.pose),
        "rate": ("Rate of the pose, term by term", writer.rate),
        "inverse": ("Inverse of the pose", writer.inverse),
        "velocity-matrix": ("Body velocity as a matrix", writer.velocity_matrix),
        "velocity": ("Body velocity, read off the matrix", writer.velocity),
        "body-jacobian": ("Body Jacobian, column by column", writer.body_jacobian),
        "velocity-check": ("Body velocity by the Jacobian", writer.velocity_check),
        "hybrid-velocity": ("Hybrid velocity", writer.hybrid_velocity),
        "spatial-jacobian": ("Spatial Jacobian, column by column", writer.spatial_jacobian),
        "hybrid-jacobian": ("Hybrid Jacobian and the adjoint", writer.hybrid_jacobian),
        "singularities": ("Manipulability and singular configurations", writer.singularities),
        "screws": ("Pitch, axis and magnitude of each twist", partial(screws, writer)),
        "spatial-velocity": ("Spatial velocity", partial(spatial_velocity, writer)),
        "general-column": ("Why the columns of the spatial Jacobian are these", partial(general_column, writer)),
        "geometric": ("Hybrid Jacobian by the geometric method", partial(geometric, writer)),
    }
    listed = []
    for key in wanted(parts, large=derivation.large):
        title, make = makers[key]
        blocks = tuple(make())
        listed.append(Section(PARTS[key], key, title, (*writer.short_forms(), *blocks)))
    return listed


class _Sections(Writer):
    """Writes the sections of one derivation."""

    def home(self) -> Iterable[Block]:
        d, n = self.d, self.n
        yield Paragraph(f"At zero the frame {named(d.tip)} stands in {named(d.reference)} at")
        yield Formula((n.home, self.set.matrix(d.home)))
        if d.screws:
            yield Paragraph("and the joints that move it have these axes, each through a point $q$:")
        for i, screw in enumerate(d.screws, 1):
            if screw.revolute:
                omega, q = self.set.matrix(screw.omega), self.set.matrix(screw.q)
                yield Formula((rf"\omega_{{{i}}}", rf"{omega} , \quad q_{{{i}}}", q))
            else:
                yield Formula((rf"\omega_{{{i}}}", rf"0 , \quad v_{{{i}}}", self.set.matrix(screw.v)))

    def twists(self) -> Iterable[Block]:
        if self.steps:
            yield from self._general_twist()
        for i, screw in enumerate(self.d.screws, 1):
            if screw.revolute and self.steps:
                product = f"-{self.set.matrix(screw.omega)} \\times {self.set.matrix(screw.q)}"
                head = (rf"-\omega_{{{i}}} \times q_{{{i}}}", product, self.set.matrix(screw.v))
                yield Formula(head)
            yield Formula((self.twist(i), self.column(screw.twist)))
        yield from self._followers()

    def _general_twist(self) -> Iterable[Block]:
        turning = (
            r"\begin{bmatrix} \omega \\ -\omega \times q \end{bmatrix}"
            if self.n.angular_first
            else r"\begin{bmatrix} -\omega \times q \\ \omega \end{bmatrix}"
        )
        yield Paragraph(
            f"A joint that turns about $\\omega$ through $q$ has the twist below ({self.cite('twist')}; the order is "
            f"{self.n.order}), one that slides along $v$ has $\\omega = 0$."
        )
        yield Formula((self.twist(0).replace("_{0}", ""), turning))

    def _followers(self) -> Iterable[Block]:
        if not self.d.follows:
            return
        yield Paragraph("Joints that follow others have the values (their offsets are in the home pose)")
        for symbol, value in self.d.follows.items():
            yield Formula((self.set(symbol), self.set(value)))
        for k, variable in enumerate(self.d.coordinates):
            at_zero = {symbol: sp.Integer(0) for symbol in self.d.joint_values}
            column = self.d.explicit(self.d.jacobian("spatial")[:, k]).subs(at_zero)
            v, w = column[:3, 0], column[3:, 0]
            text = f"At zero, a unit of ${self.set(variable.symbol)}$ is the twist"
            if w.dot(w):
                h = sp.simplify(w.dot(v) / w.dot(w))
                text += f" of pitch $h = {self.set(h)}$ (m/rad)"
            yield Paragraph(text)
            yield Formula(
                (
                    f"{self.n.spatial}(0) e_{{{k + 1}}}" if len(self.d.coordinates) > 1 else f"{self.n.spatial}(0)",
                    self.column(column),
                )
            )

    def exponentials(self) -> Iterable[Block]:
        if self.steps:
            yield from self._general_exponential()
        for i, matrix in enumerate(self.d.exponentials, 1):
            if self.full:
                yield from steps.exponential(self, i)
            yield from self.result(self.exponential(i), matrix=matrix, name=f"e{i}")

    def _general_exponential(self) -> Iterable[Block]:
        hat = self.n.hat.format(r"\omega")
        yield Paragraph(f"With $R$ by Rodrigues' formula ({self.cite('exponential')}):")
        matrix = r"\begin{bmatrix} R & (I - R) q \\ 0 & 1 \end{bmatrix}"
        rodrigues = rf"I + {hat} \sin\theta + {hat}^{{2}} (1 - \cos\theta)"
        yield Formula((self.n.exponential(0, r"\theta").replace("_{0}", ""), rf"{matrix} , \quad R", rodrigues))

    def pose(self) -> Iterable[Block]:
        if self.steps:
            yield from self._pose_steps()
        yield from self.result(self.n.pose, matrix=self.d.pose, name="g")

    def _pose_steps(self) -> Iterable[Block]:
        d, n = self.d, self.n
        yield Paragraph(f"The pose is the product of the exponentials and the home pose ({self.cite('pose')}):")
        yield Formula((n.pose, " ".join((*map(self.exponential, self.numbers), n.home))))
        for i, product in enumerate(d.partial_products, 1):
            if i > 1 and self.small:
                so_far = " ".join(self.exponential(k) for k in range(1, i + 1))
                yield from self.result(so_far, matrix=product, name="P")
        if self.small and d.screws and d.home != sp.eye(4) and not self.set.is_wide(d.partial_products[-1]):
            yield Formula((n.pose, f"{self.set.matrix(d.partial_products[-1])} {self.set.matrix(d.home)}"))

    def rate(self) -> Iterable[Block]:
        if self.steps:
            yield from self._rate_steps()
        yield from self.result(self.n.pose_rate, matrix=self.d.pose_rate, name=r"\dot{g}")

    def _rate_steps(self) -> Iterable[Block]:
        rates = [self.set(joint.variable.rate) for joint in self.d.chain.joints]
        pose = self.pose_name
        terms = [rf"\frac{{\partial {pose}}}{{\partial {v}}} {r}" for v, r in zip(self.values, rates, strict=True)]
        yield Formula((self.n.pose_rate, " + ".join(terms) or "0"))
        yield from self._following_rates()
        for term, matrix in zip(terms, self.d.pose_rates, strict=True):
            yield from self.result(term, matrix=matrix, name="t")

    def _following_rates(self) -> Iterable[Block]:
        following = [joint for joint in self.d.chain.joints if joint.master is not joint.variable]
        if following:
            yield Paragraph("The rates of joints that follow others are put in terms of the coordinates':")
        for joint in following:
            yield Formula((self.set(joint.variable.rate), self.set(joint.multiplier * joint.master.rate)))

    def inverse(self) -> Iterable[Block]:
        general = r"\begin{bmatrix} R^{T} & -R^{T} p \\ 0 & 1 \end{bmatrix}"
        if self.steps:
            yield Paragraph(f"With $R$ and $p$ of the pose ({self.cite('inverse')}):")
        head = (f"{self.pose_name}^{{-1}}", general) if self.steps else (f"{self.pose_name}^{{-1}}",)
        yield from self.result(*head, matrix=self.d.inverse, name="i")

    def velocity_matrix(self) -> Iterable[Block]:
        head = (self.n.body_velocity_hat, f"{self.pose_name}^{{-1}} {self.n.pose_rate}")
        if self.steps:
            yield Paragraph(f"The product of (f) and (e) ({self.cite('velocity')}):")
            if self.small and not self.set.is_wide(self.d.pose_rate) and not self.set.is_wide(self.d.inverse):
                yield Formula((*head, f"{self.set.matrix(self.d.inverse)} {self.set.matrix(self.d.pose_rate)}"))
        yield from self.result(*head, matrix=self.d.body_hat, name=r"\hat{v}")

    def velocity(self) -> Iterable[Block]:
        if self.steps:
            v = r"\begin{bmatrix} \hat{\omega} & v \\ 0 & 0 \end{bmatrix}"
            yield Paragraph("The matrix has the two parts of the twist in it:")
            yield Formula((self.n.body_velocity_hat, v.replace(r"\hat{\omega}", self.n.hat.format(r"\omega"))))
        if self.full:
            yield from steps.velocity(self)
        yield from self.result(self.n.body_velocity, matrix=self.n.rows(self.d.body_velocity), name="v")

    def body_jacobian(self) -> Iterable[Block]:
        if self.steps:
            yield Paragraph(f"Column by column, each twist as the tool sees it ({self.cite('body')}):")
        if self.full:
            corner = f"-R^{{T}} {self.hat('p')}"
            yield Paragraph(f"The inverse adjoint of ${self.pose_name}_{{i}}$ has $R^{{T}}$ and ${corner}$ in it.")
        for i in self.numbers if self.steps else ():
            if self.full:
                yield from steps.suffix(self, i)
            product = " ".join(self.exponential(k) for k in range(i, len(self.values) + 1))
            head = rf"\mathrm{{Ad}}^{{-1}}_{{\left({product} {self.n.home}\right)}} {self.twist(i)}"
            yield from self._jacobian_column("body", self.n.body_column.format(i), head, i)
        yield from self._jacobian("body", self.n.body)

    def spatial_jacobian(self) -> Iterable[Block]:
        if self.steps:
            seen = "each twist as the joints before it have moved it"
            yield Paragraph(f"Column by column, {seen} ({self.cite('spatial')}):")
        for i in self.numbers if self.steps else ():
            product = " ".join(self.exponential(k) for k in range(1, i))
            head = rf"\mathrm{{Ad}}_{{\left({product}\right)}} {self.twist(i)}" if product else self.twist(i)
            yield from self._jacobian_column("spatial", self.n.spatial_column.format(i), head, i)
        yield from self._jacobian("spatial", self.n.spatial)

    def _jacobian_column(self, kind: str, name: str, general: str, i: int) -> list[Block]:
        d = self.d
        parts = [name, general]
        if self.small:
            adjoint = (d.body_adjoints if kind == "body" else d.spatial_adjoints)[i - 1]
            inserted = f"{self.set.matrix(self.n.both(adjoint))} {self.column(d.screws[i - 1].twist)}"
            if not self.set.is_wide(adjoint) and adjoint != sp.eye(6):
                parts.append(inserted)
        column = d.columns(kind)[:, i - 1]
        return self.result(*parts, matrix=self.n.rows(column), name=f"({name})")

    def _jacobian(self, kind: str, name: str) -> Iterable[Block]:
        d = self.d
        column = self.n.body_column if kind == "body" else self.n.spatial_column
        if d.follows and self.steps:
            yield Paragraph("A coordinate's column is the sum of its joints', each times its multiplier:")
        if d.follows or not self.steps:
            yield from self.result(name, matrix=self.n.rows(d.jacobian(kind)), name="J")
            return
        columns = " & ".join(column.format(i) for i in self.numbers)
        general = rf"\begin{{bmatrix}} {columns} \end{{bmatrix}}"
        yield from self.result(name, general, matrix=self.n.rows(d.jacobian(kind)), name="J")

    def velocity_check(self) -> Iterable[Block]:
        d = self.d
        jacobian = d.jacobian("body")
        rates = sp.Matrix([variable.rate for variable in d.coordinates])
        head: tuple[str, ...] = (self.n.body_velocity, rf"{self.n.body} \dot{{\theta}}")
        if self.steps and not self.set.is_wide(jacobian):
            head = (*head, f"{self.column(jacobian)} {self.set.matrix(rates)}")
        yield from self.result(*head, matrix=self.n.rows(d.body_velocity), name="V")
        yield Paragraph("It is (h), entry for entry." if d.velocities_agree else "It is NOT (h): one of them is wrong.")

    def hybrid_velocity(self) -> Iterable[Block]:
        turn = r"\begin{bmatrix} R & 0 \\ 0 & R \end{bmatrix}"
        yield Paragraph("The velocity of the tool's origin and its angular velocity, both in the axes of the base:")
        head = (self.n.hybrid_velocity, f"{turn} {self.n.body_velocity}")
        yield from self.result(*head, matrix=self.n.rows(self.d.hybrid_velocity), name="V")

    def hybrid_jacobian(self) -> Iterable[Block]:
        turn = r"\begin{bmatrix} R & 0 \\ 0 & R \end{bmatrix}"
        yield Paragraph("The rows of the tool's origin are the partial derivatives of its position:")
        hybrid = self.n.rows(self.d.jacobian("hybrid"))
        yield from self.result(self.n.hybrid, f"{turn} {self.n.body}", matrix=hybrid, name="H")
        if self.small:
            carries = "The adjoint of the pose carries the body Jacobian to the spatial one"
            yield Paragraph(f"{carries} ({self.cite('adjoint')}):")
            name = rf"\mathrm{{Ad}}_{{{self.pose_name}}}"
            if self.full:
                yield from steps.adjoint(self)
            yield Formula((self.n.spatial, f"{name} {self.n.body}"))
            yield from self.result(name, self.n.adjoint, matrix=self.n.both(self.d.adjoint), name="a")

    def singularities(self) -> Iterable[Block]:
        found = self.d.singularities
        yield Paragraph(found.words)
        for measure in found.measures:
            yield Formula((measure.name, self.set(measure.value)))
            if measure.factors:
                shown = ", or ".join(f"${self.set(factor)} = 0$" for factor in measure.factors)
                yield Paragraph(f"It vanishes only where {shown}.")
            elif measure.value == 0:
                yield Paragraph("It is zero everywhere: such motions are never all possible.")
            else:
                yield Paragraph("It vanishes nowhere.")
