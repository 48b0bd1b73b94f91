"""A robot's URDF with its kinematics alone, for libraries that choke on, or do not believe, what else is in it."""

from __future__ import annotations

from typing import Final
from xml.etree import ElementTree as ET

from pinscrew.description import markup, orientation
from pinscrew.robot.robot import Robot

__all__ = ["NO_LIMIT", "limits_seen", "plain_urdf"]

NO_LIMIT: Final = 1.7976931348623155e308
"""What is written for no limit: the double next to the largest, which a file may have."""
_KINEMATIC: Final = ("origin", "parent", "child", "axis", "limit", "mimic")
_BOUNDED: Final = ("revolute", "prismatic", "continuous")


def plain_urdf(robot: Robot, *, quaternions: bool = False) -> ET.Element:
    """The robot's URDF with its names and kinematics alone, as they are written.

    Meshes, shapes, materials, masses, effort and damping, which a library may not find or not believe, are left out,
    and so is what other programs keep in a URDF.

    Args:
        robot: the robot.
        quaternions: whether the library reads the quaternions of URDF 1.2; else they are written as rpy.
    """
    written = markup.parse(robot.description.text, robot.description.file)
    root = ET.Element("robot", name=written.attributes.get("name", ""))
    if quaternions and "version" in written.attributes:
        root.set("version", written.attributes["version"])
    for link in written.all("link"):
        ET.SubElement(root, "link", name=link.attributes["name"])
    for joint in written.all("joint"):
        copied = ET.SubElement(root, "joint", name=joint.attributes["name"], type=joint.attributes["type"])
        for child in joint.children:
            if child.tag not in _KINEMATIC:
                continue
            own = {name: " ".join(value.split()) for name, value in child.attributes.items() if ":" not in name}
            if child.tag in ("parent", "child", "mimic"):  # names are kept to the letter
                own |= {name: child.attributes[name] for name in ("link", "joint") if name in own}
            if child.tag == "limit":
                _limit(copied, own)
                continue
            if not quaternions and own.pop("quat_xyzw", None) is not None:
                roll, pitch, yaw = orientation.to_rpy(orientation.of_origin(child.attributes))
                own["rpy"] = f"{roll!r} {pitch!r} {yaw!r}"
            ET.SubElement(copied, child.tag, own)
    return root


def _limit(joint: ET.Element, written: dict[str, str]) -> None:
    """Where a joint can be, as it is written; reversed limits are none. Velocity and effort are no kinematics."""
    limit = ET.SubElement(joint, "limit", effort="1", velocity="1")
    if joint.attrib["type"] not in _BOUNDED:
        return
    ends = {name: text for name, text in written.items() if name in ("lower", "upper")}
    if float(ends.get("lower", "0")) > float(ends.get("upper", "0")):
        ends = {"lower": repr(-NO_LIMIT), "upper": repr(NO_LIMIT)}
    limit.attrib.update(ends)


def limits_seen(lower: float, upper: float) -> tuple[float, float] | None:
    """The limits that a library has of a joint, or None where it has what `plain_urdf` writes for none."""
    return None if (lower, upper) == (-NO_LIMIT, NO_LIMIT) else (float(lower), float(upper))
