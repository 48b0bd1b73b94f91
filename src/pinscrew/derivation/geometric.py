"""The section on the geometric method: link transforms, axes and origins, and the Jacobian's columns from these."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
import sympy as sp

from pinscrew.derivation.blocks import Block, Paragraph, named
from pinscrew.derivation.chain import Elements, cross
from pinscrew.derivation.forms import ClosedForms
from pinscrew.derivation.normal_forms import inverse
from pinscrew.derivation.writer import Writer
from pinscrew.lie import so3

__all__ = ["geometric"]


def geometric(w: Writer) -> Iterable[Block]:
    """Columns (z_i × (o_n - o_i), z_i), or (z_i, 0) of a joint that slides; beside those of the twists.

    Frame i is that of the link that joint i moves, and the axis z_i goes through its origin o_i. Source: Spong,
    Hutchinson and Vidyasagar, *Robot Modeling and Control*, 2006, §4.6, where frame i-1 has the axis of joint i.
    """
    d, joints = w.d, w.d.chain.joints
    if not joints or not _outwards(d):
        yield Paragraph("The geometric method is for joints that lead outwards, none of which follows another.")
        return
    each = zip(_frames(d), d.normal.exponentials, joints, strict=True)
    links = [inverse(before) @ e @ joint.frame for before, e, joint in each]
    poses = [partial @ joint.frame for partial, joint in zip(d.normal.partial, joints, strict=True)]
    labels = list(map(str, range(len(joints) + 1)))
    last = inverse(joints[-1].frame) @ d.chain.home
    if (last - d.normal.before[0]).any():  # the frame is not that of the last link
        links, poses, labels = [*links, last], [*poses, d.normal.pose], [*labels, "e"]
    yield Paragraph(
        f"Frame $i$ is that of the link that joint $i$ moves, 0 is {named(d.reference)} and {labels[-1]} is "
        f"{named(d.tip)}. The transforms between them:"
    )
    for (a, b), H in zip(pairwise(labels), links, strict=True):
        yield from w.result(f"H_{{{a}}}^{{{b}}}", matrix=d.write(H), name="H")
    yield Paragraph(
        "Their products have the origins $o_{i}$ in the last column; $z_{i}$ is the axis of joint $i$ there:"
    )
    for number, pose in enumerate(poses[1:], 2):
        product = " ".join(f"H_{{{a}}}^{{{b}}}" for a, b in pairwise(labels[: number + 1]))
        head = (f"H_{{0}}^{{{labels[number]}}}", product)
        yield from w.result(*(head if w.steps else head[:1]), matrix=d.write(pose), name="H")
    origins = {label: pose[:3, 3] for label, pose in zip(labels[1:], poses, strict=True)}
    axes = [partial[:3, :3] @ joint.axis for partial, joint in zip(d.normal.partial, joints, strict=True)]
    for i, z in enumerate(axes, 1):
        yield from w.result(f"z_{{{i}}}", matrix=_column(d, z), name="z")
        yield from w.result(f"o_{{{i}}}", matrix=_column(d, origins[str(i)]), name="o")
    if labels[-1] == "e":
        yield from w.result("o_{e}", matrix=_column(d, origins["e"]), name="o")
    yield from _columns(w, labels[-1], axes, list(origins.values()))


def _columns(w: Writer, end: str, axes: list[Elements], origins: list[Elements]) -> Iterable[Block]:
    d, columns = w.d, []
    zero = np.array([d.chain.algebra.constant(0)] * 3, dtype=object)
    arm = rf"z_{{i}} \times (o_{{{end}}} - o_{{i}})"
    yield Paragraph(
        rf"The column of a joint that turns is ${arm}$ above $z_{{i}}$, that of one that slides $z_{{i}}$ above zeros "
        r"(books that number by Denavit and Hartenberg call the same axis $z_{i-1}$):"
    )
    for i, (joint, z, o) in enumerate(zip(d.chain.joints, axes, origins[: len(axes)], strict=True), 1):
        lever = origins[-1] - o
        linear = cross(z, lever) if joint.revolute else z
        columns.append(np.concatenate([linear, z if joint.revolute else zero]))
        if joint.revolute:
            if w.full:
                yield from w.result(w.hat("z", str(i)), matrix=so3.hat(_column(d, z)), name="z")
            head = [rf"z_{{{i}}} \times (o_{{{end}}} - o_{{{i}}})"]
            shown = _column(d, z), _column(d, lever)
            if w.steps and not any(map(w.set.is_wide, shown)):
                head.append(rf"{w.set.matrix(shown[0])} \times {w.set.matrix(shown[1])}")
            yield from w.result(*head, matrix=_column(d, linear), name="v")
        name = f"J_{{h{i}}}" if w.n.angular_first else f"J^{{h}}_{{{i}}}"
        yield from w.result(name, matrix=w.n.rows(_column(d, columns[-1])), name="J")
    J = np.stack(columns, axis=1)
    same = not (J - d.normal.hybrid).any()
    verdict = "are one expression" if same else "are NOT one expression"
    yield Paragraph(f"Beside it the Jacobian from the twists, part (m): the two {verdict}, entry for entry.")
    yield from w.result(w.n.hybrid, matrix=w.n.rows(d.jacobian("hybrid")), name="H")
    yield from _downwards(w)


def _downwards(w: Writer) -> Iterable[Block]:
    """Why a column is -1 where a text has 1."""
    for i, screw in enumerate(w.d.screws, 1):
        if not screw.revolute and all(x.is_number and x <= 0 for x in screw.v):
            axis = ", ".join(map(w.set, screw.v))
            yield Paragraph(
                f"Joint {i} slides along its axis, which is $({axis})$ at zero: as ${w.values[i - 1]}$ grows, the "
                "frame goes that way, so its column has the minus of the axis. A text that counts the other way, with "
                f"$q_{{{i}}} = -{w.values[i - 1]}$, has a plus there: a convention, and no mistake."
            )


def _outwards(d: ClosedForms) -> bool:
    names = [joint.variable.joint for joint in d.chain.joints]
    path = {joint.name for joint in d.robot.description.path(d.tip)}
    return not d.follows and set(names) <= path


def _frames(d: ClosedForms) -> list[Elements]:
    """The frames before each joint, at zero; the first is the one in which all is."""
    return [d.normal.before[0], *(joint.frame for joint in d.chain.joints[:-1])]


def _column(d: ClosedForms, vector: Elements) -> sp.ImmutableMatrix:
    return d.write(vector.reshape(-1, 1))
