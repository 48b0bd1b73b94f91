"""Edits of a URDF's text, as a person or a tool makes them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from xml.etree import ElementTree as ET

import numpy as np
from scipy.linalg import expm

from pinscrew.ground.typing import FloatArray


class Edited:
    """A URDF in which joints are moved, turned, renamed, added and removed; all numbers keep all digits."""

    def __init__(self, text: str) -> None:
        self.root = ET.fromstring(text)  # noqa: S314 (files of example-robot-data)

    @property
    def text(self) -> str:
        return ET.tostring(self.root, encoding="unicode")

    # ------------------------------------------------------------------------------------ what there is

    def joint(self, name: str) -> ET.Element:
        (found,) = (joint for joint in self.root.findall("joint") if joint.get("name") == name)
        return found

    def link(self, joint: str, end: str = "child") -> str:
        return self._part(joint, end).get("link", "")

    def below(self, joint: str) -> Iterator[str]:
        """The joints that hang from the child of a joint."""
        child = self.link(joint)
        for other in self.root.findall("joint"):
            parent = other.find("parent")
            if parent is not None and parent.get("link") == child:
                yield other.get("name", "")

    def origin(self, joint: str) -> FloatArray:
        element = self.joint(joint).find("origin")
        T = np.eye(4)
        if element is not None:
            T[:3, 3] = [float(x) for x in element.get("xyz", "0 0 0").split()]
            r, p, y = (float(x) for x in element.get("rpy", "0 0 0").split())
            T[:3, :3] = turn("z", y) @ turn("y", p) @ turn("x", r)
        return T

    def axis(self, joint: str) -> FloatArray:
        element = self.joint(joint).find("axis")
        axis = np.array([float(x) for x in element.get("xyz", "").split()] if element is not None else [1.0, 0.0, 0.0])
        return axis / np.linalg.norm(axis)

    def across(self, joint: str) -> FloatArray:
        """A unit vector at right angles to a joint's axis, in the joint's frame."""
        axis = self.axis(joint)
        vector = np.cross(axis, np.eye(3)[abs(axis).argmin()])
        return vector / np.linalg.norm(vector)

    def _part(self, joint: str, tag: str) -> ET.Element:
        element = self.joint(joint)
        found = element.find(tag)
        return ET.SubElement(element, tag) if found is None else found

    # ------------------------------------------------------------------------------------ what is done

    def set_origin(self, joint: str, T: FloatArray) -> None:
        element = self._part(joint, "origin")
        R = T[:3, :3]
        yaw = math.atan2(R[1, 0], R[0, 0])
        pitch = math.atan2(-R[2, 0], math.hypot(R[0, 0], R[1, 0]))
        c, s = math.cos(yaw), math.sin(yaw)
        # What Rz(-yaw) leaves: right at pitch = ±90° too.
        roll = math.atan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1])
        element.set("xyz", written(T[:3, 3]))
        element.set("rpy", written(np.array([roll, pitch, yaw])))

    def set_axis(self, joint: str, axis: FloatArray) -> None:
        self._part(joint, "axis").set("xyz", written(axis))

    def move(self, joint: str, X: FloatArray) -> None:
        """Displace a joint's origin by X in the joint's own frame; what follows goes along."""
        self.set_origin(joint, self.origin(joint) @ X)

    def compensate(self, joint: str, X: FloatArray) -> None:
        """Keep what hangs from a joint's child where it was, although the child's frame is displaced by X."""
        for other in list(self.below(joint)):
            self.set_origin(other, np.linalg.inv(X) @ self.origin(other))

    def reexpress(self, joint: str, X: FloatArray) -> None:
        """Choose a joint's frame anew: origin, axis and what follows, so that all moves as before."""
        axis = None if self.joint(joint).get("type") == "fixed" else self.axis(joint)
        self.move(joint, X)
        self.compensate(joint, X)
        if axis is not None:
            self.set_axis(joint, X[:3, :3].T @ axis)

    def rename_joint(self, old: str, new: str) -> None:
        self.joint(old).set("name", new)
        for mimic in self.root.iter("mimic"):
            if mimic.get("joint") == old:
                mimic.set("joint", new)

    def rename_link(self, old: str, new: str) -> None:
        for element in self.root.findall("link"):
            if element.get("name") == old:
                element.set("name", new)
        for tag in ("parent", "child"):
            for element in self.root.findall(f"joint/{tag}"):
                if element.get("link") == old:
                    element.set("link", new)

    def set_limits(self, joint: str, lower: float, upper: float) -> None:
        self._part(joint, "limit").set("lower", repr(lower))
        self._part(joint, "limit").set("upper", repr(upper))

    def limits(self, joint: str) -> tuple[float, float]:
        element = self._part(joint, "limit")
        return float(element.get("lower", "0")), float(element.get("upper", "0"))

    def reverse(self, joint: str) -> None:
        """Turn a joint's axis round, its limits with it."""
        self.set_axis(joint, -self.axis(joint))
        lower, upper = self.limits(joint)
        self.set_limits(joint, -upper, -lower)

    def mimic(self, joint: str) -> ET.Element:
        return self._part(joint, "mimic")

    def attach(self, name: str, kind: str, parent: str, child: str, X: FloatArray, axis: str = "0 0 1") -> None:
        """A new link at X in another."""
        ET.SubElement(self.root, "link", name=child)
        joint = ET.SubElement(self.root, "joint", name=name, type=kind)
        ET.SubElement(joint, "parent", link=parent)
        ET.SubElement(joint, "child", link=child)
        self.set_origin(name, X)
        if kind != "fixed":
            ET.SubElement(joint, "axis", xyz=axis)
            ET.SubElement(joint, "limit", lower="-1", upper="1", effort="1", velocity="1")

    def insert(self, name: str, kind: str, above: str, X: FloatArray) -> None:
        """A new link between a joint and its parent; the joint keeps its origin, now in the new link."""
        parent = self.link(above, "parent")
        self.attach(name, kind, parent, f"{name}_link", X)
        self._part(above, "parent").set("link", f"{name}_link")

    def remove(self, joint: str) -> None:
        """Take out a joint with its child link; what hung from it hangs from the parent, where it was at zero."""
        parent, child, X = self.link(joint, "parent"), self.link(joint), self.origin(joint)
        for other in list(self.below(joint)):
            self.set_origin(other, X @ self.origin(other))
            self._part(other, "parent").set("link", parent)
        self.root.remove(self.joint(joint))
        for element in self.root.findall("link"):
            if element.get("name") == child:
                self.root.remove(element)


def turn(axis: str | FloatArray, angle: float) -> FloatArray:
    """Rotation (3, 3) about x, y, z or a unit vector, by the matrix exponential."""
    u = np.eye(3)["xyz".index(axis)] if isinstance(axis, str) else axis
    return expm(angle * np.array([[0.0, -u[2], u[1]], [u[2], 0.0, -u[0]], [-u[1], u[0], 0.0]]))


def pose(shift: FloatArray | tuple[float, float, float] = (0.0, 0.0, 0.0), R: FloatArray | None = None) -> FloatArray:
    T = np.eye(4)
    T[:3, 3] = shift
    if R is not None:
        T[:3, :3] = R
    return T


def written(values: FloatArray) -> str:
    return " ".join(repr(float(value)) for value in values)
