"""A checked URDF, read by yourdfpy (parse only), as a `Description`."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Final
from xml.etree import ElementTree as ET

import numpy as np

from pinscrew.description import markup, orientation, structure
from pinscrew.description.model import Description, Joint, Limits, Mimic

if TYPE_CHECKING:
    import yourdfpy

__all__ = ["parse"]

_KINEMATIC: Final[Mapping[str, frozenset[str]]] = {
    "joint": frozenset(("name", "type")),
    "parent": frozenset(("link",)),
    "child": frozenset(("link",)),
    "origin": frozenset(("xyz", "rpy")),  # and quat_xyzw, which yourdfpy does not know
    "axis": frozenset(("xyz",)),
    "limit": frozenset(("lower", "upper", "effort", "velocity")),
    "mimic": frozenset(("joint", "multiplier", "offset")),
}
"""The elements of a joint, and their attributes, that kinematics depends on."""
_WITHOUT: Final[Mapping[str, tuple[str, ...]]] = {
    "axis": ("fixed", "floating"),
    "limit": ("fixed", "floating", "planar"),
    "mimic": ("fixed",),
}
"""The types of joint that take no notice of an element, which then was not checked."""


def parse(
    text: str,
    file: str | Path,
    arguments: Mapping[str, str] | None = None,
    places: Sequence[markup.Place] = (),
    *,
    strict: bool = False,
) -> Description:
    """Read the URDF in ``text``.

    Args:
        text: the URDF; a xacro file must have been expanded.
        file: what to call it in messages.
        arguments: the xacro arguments it was expanded with, for the record.
        places: where its elements come from, where it was expanded; see `markup.parse`.
        strict: whether what looks wrong is an error.

    Raises:
        DescriptionError: if it does not describe one tree of links; see `structure.check`.
    """
    checked = structure.check(markup.parse(text, file, places), file, strict=strict)
    parsed = {joint.name: joint for joint in _parse_kinematics(checked).joints}
    joints = tuple(_joint(parsed[e.attributes["name"]], e, str(file)) for e in checked.joints)
    return Description(
        name=checked.name,
        file=str(file),
        text=text,
        links=checked.links,
        joints=joints,
        arguments=MappingProxyType(dict(arguments or {})),
    )


def _parse_kinematics(checked: structure.Checked) -> yourdfpy.Robot:
    """What yourdfpy reads of links and joints.

    It is given these alone: it refuses geometry that it does not know, reads no link at all where an ``xmlns`` is
    declared, and fails on the axis of a fixed joint if that is none.
    """
    from pinscrew.description._yourdfpy import parser  # here, since no error should wait for it

    robot = ET.Element("robot", name=checked.name)
    for link in checked.links:
        ET.SubElement(robot, "link", name=link)
    for joint in checked.joints:
        copy, kind = _copy(joint, robot), joint.attributes["type"]
        for child in joint.children:
            if child.tag in _KINEMATIC and kind not in _WITHOUT.get(child.tag, ()):
                _copy(child, copy)
    stream = io.BytesIO(ET.tostring(robot, encoding="utf-8"))
    return parser().load(stream, load_meshes=False, build_scene_graph=False).robot


def _copy(element: markup.Element, parent: ET.Element) -> ET.Element:
    known = _KINEMATIC[element.tag]
    return ET.SubElement(parent, element.tag, {k: v for k, v in element.attributes.items() if k in known})


def _joint(joint: yourdfpy.Joint, element: markup.Element, file: str) -> Joint:
    origin = np.eye(4) if joint.origin is None else joint.origin
    for child in element.all("origin"):
        if "quat_xyzw" in child.attributes:
            origin[:3, :3] = orientation.of_origin(child.attributes)
    limit = joint.limit
    limits = Limits()
    if limit is not None:
        bounded = joint.type in ("revolute", "prismatic")
        # URDF takes an absent bound as 0; a continuous joint has none, and reversed ones are none.
        lower, upper = limit.lower or 0.0, limit.upper or 0.0
        bounded &= lower <= upper
        limits = Limits(
            lower=lower if bounded else -np.inf,
            upper=upper if bounded else np.inf,
            velocity=limit.velocity,
            effort=limit.effort,
        )
    mimic = None
    if joint.mimic is not None and joint.type != "fixed":
        mimic = Mimic(joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset)
    axis = np.zeros(3)
    if joint.type not in ("fixed", "floating"):
        axis = joint.axis / np.linalg.norm(joint.axis)
    return Joint(
        name=joint.name,
        type=joint.type,
        parent=joint.parent,
        child=joint.child,
        T_parent_joint=origin,
        axis=axis,
        limits=limits,
        mimic=mimic,
        line=element.line,
        file="" if element.file == file else element.file,
    )
