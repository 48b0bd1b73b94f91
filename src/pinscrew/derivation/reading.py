"""From a robot's file to the exact geometry of the joints that move a frame."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import sympy as sp

from pinscrew.derivation import exact
from pinscrew.description import markup, orientation
from pinscrew.description.model import SCALAR_TYPES, Description
from pinscrew.ground.errors import UnsupportedError
from pinscrew.robot.robot import Robot

__all__ = ["MOST_JOINTS", "JointGeometry", "Printed", "geometry", "printed"]

MOST_JOINTS: Final = 8
"""Moving joints to the tip above which closed forms are of no use to anyone."""

Texts: TypeAlias = tuple[str, str, str]


@dataclass(frozen=True, slots=True)
class Printed:
    """A joint on the way to the tip, in the file's own digits.

    Attributes:
        xyz: its origin's position in the parent link.
        rpy: its origin's roll, pitch and yaw.
        axis: its axis, of any length.
        mimic: joint followed, multiplier and offset, or None.
    """

    name: str
    type: str
    xyz: Texts
    rpy: Texts
    axis: Texts
    mimic: tuple[str, str, str] | None

    @property
    def scalars(self) -> dict[str, str]:
        """The numbers that may depend on lengths, by what they are."""
        found = {f"xyz{i}": text for i, text in enumerate(self.xyz)}
        if self.mimic is not None:
            found |= {"multiplier": self.mimic[1], "offset": self.mimic[2]}
        return found


@dataclass(frozen=True, slots=True)
class JointGeometry:
    """A joint on the way to the tip, in exact numbers and symbols.

    Attributes:
        rpy: roll, pitch and yaw of its origin.
        R: rotation of its origin, shape (3, 3).
        p: position of its origin in the parent link (m), shape (3, 1).
        axis: unit vector in the joint's frame, shape (3, 1).
        master: the joint at the end of its mimics, or its own name.
        multiplier: its value per unit of its master's.
        offset: its value where its master's is zero.
    """

    name: str
    type: str
    rpy: tuple[sp.Expr, ...]
    R: sp.Matrix
    p: sp.Matrix
    axis: sp.Matrix
    master: str
    multiplier: sp.Expr
    offset: sp.Expr


def printed(robot: Robot, frames: Sequence[str]) -> dict[str, Printed]:
    """The joints between base and ``frames`` and the masters they mimic, in tree order, as the file prints them.

    Raises:
        UnsupportedError: if a floating or planar joint, or more than `MOST_JOINTS` moving ones, are among them.
    """
    description = robot.description
    above = {joint.name for frame in frames for joint in description.path(frame)}
    path = [joint for joint in description.joints if joint.name in above]
    moving = [joint for joint in path if joint.type != "fixed"]
    for joint in moving:
        if joint.type not in SCALAR_TYPES:
            what = f"joint {joint.name!r} is {joint.type}: closed forms are for revolute and prismatic joints"
            raise _unsupported("derive-joint", description, what, "name a tip that no such joint moves")
    if len(moving) > MOST_JOINTS:
        ends = " and ".join(map(repr, frames))
        what = f"{len(moving)} moving joints lead to {ends}: closed forms of more than {MOST_JOINTS} help nobody"
        raise _unsupported("derive-size", description, what, "name a tip nearer to the base")
    elements = {
        element.attributes["name"]: element for element in markup.parse(description.text, description.file).all("joint")
    }
    names = [joint.name for joint in path if joint.name in elements]
    by_name = {joint.name: joint for joint in description.joints}
    for joint in path:  # the loop goes on over the masters that it finds
        master = joint
        while master.mimic is not None:
            master = by_name[master.mimic.joint]
            if master.name not in names:
                names.append(master.name)
    return {name: _printed(elements[name], joint.type) for name, joint in by_name.items() if name in names}


def _unsupported(code: str, description: Description, what: str, remedy: str) -> UnsupportedError:
    return UnsupportedError(code, what, file=description.file, remedy=remedy)


def _rpy(origin: Mapping[str, str]) -> str:
    """Roll, pitch and yaw as the file has them, or those of its quaternion."""
    if "quat_xyzw" not in origin:
        return origin.get("rpy", "0 0 0")
    return " ".join(f"{angle!r}" for angle in orientation.to_rpy(orientation.of_origin(origin)))


def _printed(element: markup.Element, kind: str) -> Printed:
    attributes = {child.tag: child.attributes for child in element.children}
    origin, mimic = attributes.get("origin", {}), attributes.get("mimic")
    return Printed(
        name=element.attributes["name"],
        type=kind,
        xyz=_three(origin.get("xyz", "0 0 0")),
        rpy=_three(_rpy(origin)),
        axis=_three(attributes.get("axis", {}).get("xyz", "1 0 0")),
        mimic=None
        if mimic is None or kind == "fixed"
        else (mimic["joint"], exact.bounded(mimic.get("multiplier", "1")), exact.bounded(mimic.get("offset", "0"))),
    )


def _three(text: str) -> Texts:
    x, y, z = map(exact.bounded, text.split())
    return x, y, z


def geometry(
    joints: Mapping[str, Printed],
    value: Callable[[str, str, str], sp.Expr],
    snaps: exact.Snaps,
) -> tuple[JointGeometry, ...]:
    """The joints in exact numbers.

    Args:
        joints: from `printed`.
        value: what a scalar stands for, from the joint's name, the scalar's (see `Printed.scalars`) and its text.
        snaps: takes what was snapped.
    """
    return tuple(_geometry(joint, joints, value, snaps) for joint in joints.values())


def _geometry(
    joint: Printed,
    joints: Mapping[str, Printed],
    value: Callable[[str, str, str], sp.Expr],
    snaps: exact.Snaps,
) -> JointGeometry:
    where = f"joint {joint.name!r}"
    master, multiplier, offset = joint, sp.Integer(1), sp.Integer(0)
    while master.mimic is not None:
        offset += multiplier * value(master.name, "offset", master.mimic[2])
        multiplier *= value(master.name, "multiplier", master.mimic[1])
        master = joints[master.mimic[0]]
    if offset and joint.type != "prismatic":
        offset = exact.angle(str(offset.n(20)), f"{where}, offset", snaps) if offset.is_number else offset
    moves = joint.type != "fixed"
    rpy = tuple(exact.angle(text, f"{where}, rpy", snaps) for text in joint.rpy)
    return JointGeometry(
        name=joint.name,
        type=joint.type,
        rpy=rpy,
        R=exact.rotation(rpy),
        p=sp.Matrix([value(joint.name, f"xyz{i}", text) for i, text in enumerate(joint.xyz)]),
        axis=exact.direction(joint.axis, f"{where}, axis", snaps) if moves else sp.zeros(3, 1),
        master=master.name,
        multiplier=multiplier,
        offset=offset,
    )
