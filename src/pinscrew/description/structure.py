"""The structural check of a URDF: before either parser is believed, the file must describe one tree.

Both parsers accept files that mean nothing (unknown links, cycles, four-valued axes, NaN), each others of them.
What passes here is refused by neither and read by both in the same way.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from pinscrew.description.markup import Element
from pinscrew.description.model import JOINT_TYPES, SCALAR_TYPES
from pinscrew.description.suspicions import suspicions
from pinscrew.description.tree import tree_of
from pinscrew.description.values import SPACE, numbers
from pinscrew.ground.errors import DescriptionError, PinscrewWarning, UnsupportedError
from pinscrew.ground.words import brief

__all__ = ["MIN_AXIS", "Checked", "check"]

MIN_AXIS: Final = 1e-9
"""Shortest axis whose direction is believed: well above the rounding of any file with 9 digits or fewer."""

MAX_NUMBER: Final = 1e9
"""Largest number of an origin, axis or mimic; squares of much larger ones overflow in both parsers."""

UNIT_AXIS: Final = 1e-6
"""An axis whose length differs from one by less is taken as rounded, and normalised without a warning."""

VERSIONS: Final = ("1.0", "1.1", "1.2")
"""Of URDF; the last has quaternions."""

MAX_LINKS: Final = 10_000
"""Most links of a robot: with so many every command that reads one ends within ten seconds of processor time."""


@dataclass(frozen=True, slots=True)
class Checked:
    """The elements of a file that passed, in tree order: parents before children, siblings as in the file."""

    name: str
    links: tuple[str, ...]
    joints: tuple[Element, ...]
    """The joint that leads to each link but the first."""


def check(root: Element, file: str | Path, *, strict: bool = False) -> Checked:
    """Check that ``root`` describes one tree of named links, with numbers where numbers are due.

    Args:
        root: the file's root element.
        file: what to call it in messages.
        strict: whether what is warned of otherwise is an error.

    Raises:
        DescriptionError: naming the first element that is wrong, and what would be right.
    """
    return _Check(file, strict).run(root)


class _Check:
    def __init__(self, file: str | Path, strict: bool) -> None:
        self.file = file
        self.strict = strict
        self.quaternions = False

    def run(self, root: Element) -> Checked:
        if root.tag != "robot":
            prefixed = root.tag.endswith(":robot")
            remedy = "write <robot> without a namespace prefix" if prefixed else "the root must be <robot>"
            raise self.error("root-element", root, f"<{root.tag}> is not a robot description", remedy, label="")
        for element in root.children:
            if element.tag.startswith("xacro:"):
                remedy = 'declare xmlns:xacro="http://www.ros.org/wiki/xacro" in <robot>, so that it is expanded first'
                raise self.error("unexpanded-xacro", element, f"<{element.tag}> is not URDF", remedy, label="")
        self.quaternions = self._version(root)
        links = self._named(root, "link")
        joints = self._named(root, "joint")
        if not links:
            raise self.error("no-links", root, "has no links", "describe at least one <link>", label="<robot>")
        if len(links) > MAX_LINKS:
            what = f"{len(links)} links are more than {MAX_LINKS}"
            raise self.error("too-large", root, what, label="<robot>")
        if not root.attributes.get("name", "").strip(SPACE):
            raise self.error("no-name", root, "has no name", 'write <robot name="...">', label="<robot>")
        for joint in joints.values():
            self._joint(joint, links)
        self._mimics(joints)
        for suspicion in suspicions(root):
            self.warn(suspicion.code, suspicion.element, suspicion.words, suspicion.joint)
        order, leading = tree_of(root, links, joints, self.error)
        return Checked(root.attributes["name"], order, leading)

    def error(
        self,
        code: str,
        element: Element,
        what: str,
        remedy: str = "",
        *,
        label: str | None = None,
        kind: type[DescriptionError] = DescriptionError,
    ) -> DescriptionError:
        label = _label(element) if label is None else label
        return kind(code, brief(what), file=element.file or self.file, line=element.line, element=label, remedy=remedy)

    def warn(self, code: str, element: Element, what: str, about: Element | None = None) -> None:
        """Warn about something on the line of an element, by the name of the joint that it is in."""
        label = "" if about is None and "name" not in element.attributes else _label(about or element)
        if self.strict:
            raise self.error(code, element, what, label=label)
        file = element.file or self.file
        words = f"{label}: {brief(what)}" if label else brief(what)
        warnings.warn(PinscrewWarning(code, words, file=file, line=element.line), stacklevel=2)

    def _version(self, root: Element) -> bool:
        """Whether the file's version of URDF has quaternions."""
        version = root.attributes.get("version", "1.0")
        if version not in VERSIONS:
            remedy = f"use one of {', '.join(VERSIONS)}, or none, which is 1.0"
            raise self.error("urdf-version", root, f"the version {version!r} of URDF does not exist", remedy, label="")
        return version == VERSIONS[-1]

    def _quaternion(self, joint: Element, origin: Element) -> None:
        quaternion = self._numbers(joint, origin, "quat_xyzw", 4)
        if quaternion is None:
            return
        if not self.quaternions:
            what = "quat_xyzw is of URDF 1.2, and not all readers of this file know it"
            raise self.error("origin-quaternion", joint, what, 'write <robot version="1.2">, or rpy')
        if "rpy" in origin.attributes:
            raise self.error("origin-quaternion", joint, "its <origin> has both rpy and quat_xyzw", "keep one of them")
        length = math.hypot(*quaternion)
        if not length > MIN_AXIS:
            what = f"its quaternion is {length:g} long and no rotation"
            raise self.error("origin-quaternion", joint, what, 'write x, y, z, w of unit length: quat_xyzw="0 0 0 1"')
        if abs(length - 1.0) > UNIT_AXIS:
            self.warn("quaternion-normalised", joint, f"its quaternion is {length:.9g} long and was normalised")

    def _named(self, root: Element, tag: str) -> dict[str, Element]:
        """The elements with this tag, by their names, which must be there and unique."""
        found: dict[str, Element] = {}
        for element in root.all(tag):
            name = element.attributes.get("name", "")
            if not name.strip(SPACE):
                remedy = f'write <{tag} name="...">'
                raise self.error("no-name", element, "has no name", remedy, label=f"<{tag}>")
            if name in found:
                what = f"the name is taken by the {tag} on line {found[name].line}"
                raise self.error("duplicate-name", element, what, f"give each {tag} a name of its own")
            found[name] = element
        return found

    def _joint(self, joint: Element, links: dict[str, Element]) -> None:
        kind = joint.attributes.get("type")
        if kind not in JOINT_TYPES:
            what = "has no type" if kind is None else f"the type {kind!r} does not exist"
            raise self.error("joint-type", joint, what, f"use one of {', '.join(JOINT_TYPES)}")
        if joint.attributes["name"] == "universe":
            what = "the name is Pinocchio's for the world, and a joint with it would be lost"
            raise self.error("reserved-name", joint, what, "rename the joint")
        for tag in ("parent", "child"):
            self._link_of(joint, tag, links)
        if (origin := self._only(joint, "origin")) is not None:
            for attribute in ("xyz", "rpy"):
                self._numbers(joint, origin, attribute, 3)
            self._quaternion(joint, origin)
        if kind in SCALAR_TYPES or kind == "planar":
            self._axis(joint, planar=kind == "planar")
        limit = self._only(joint, "limit")
        if kind in SCALAR_TYPES:
            self._limit(joint, limit, bounded=kind != "continuous")

    def _only(self, joint: Element, tag: str) -> Element | None:
        """The one child with this tag, or None."""
        found = list(joint.all(tag))
        if len(found) > 1:
            what = f"has {len(found)} <{tag}> elements"
            raise self.error("duplicate-element", joint, what, "keep one")
        return found[0] if found else None

    def _link_of(self, joint: Element, tag: str, links: dict[str, Element]) -> None:
        element = self._only(joint, tag)
        name = "" if element is None else element.attributes.get("link", "")
        if not name:
            raise self.error("no-link", joint, f"has no {tag} link", f'write <{tag} link="..."/>')
        if name not in links:
            raise self.error(
                "unknown-link", joint, f"its {tag} is {name!r}, but no link is called so", "define the link"
            )

    def _numbers(
        self, joint: Element, element: Element, attribute: str, count: int, most: float = MAX_NUMBER
    ) -> list[float] | None:
        """The numbers in an attribute of a joint, or None where it is absent."""

        def refuse(code: str, what: str, remedy: str) -> DescriptionError:
            return self.error(code, joint, what, remedy)

        return numbers(element, attribute, count, refuse, most=most)

    def _axis(self, joint: Element, *, planar: bool) -> None:
        element = self._only(joint, "axis")
        axis: list[float] | None = [1.0, 0.0, 0.0]  # what URDF means by no axis
        if element is not None:
            axis = self._numbers(joint, element, "xyz", 3)
        if axis is None:
            raise self.error("no-axis", joint, "<axis> has no xyz", 'write <axis xyz="0 0 1"/>')
        length = math.hypot(*axis)
        if not length > MIN_AXIS:
            what = f"the axis is {length:g} long and has no direction" if length else "the axis is zero"
            raise self.error("zero-axis", joint, what, 'write a unit vector, such as <axis xyz="0 0 1"/>')
        if planar and not (axis[0] == axis[1] == 0.0 and axis[2] > 0.0):
            what = "a planar joint moves in the plane of x and y; Pinocchio ignores any other axis"
            remedy = 'turn the origin and write <axis xyz="0 0 1"/>'
            raise self.error("planar-axis", joint, what, remedy, kind=UnsupportedError)
        if abs(length - 1.0) > UNIT_AXIS:
            self.warn("axis-normalised", joint, f"the axis is {length:.9g} long and was normalised")

    def _limit(self, joint: Element, limit: Element | None, *, bounded: bool) -> None:
        example = 'write <limit lower="-1" upper="1" effort="10" velocity="1"/>'
        if limit is None:
            if bounded:
                kind = joint.attributes["type"]
                raise self.error("no-limit", joint, f"a {kind} joint needs a <limit>", example)
            return
        values = {
            attribute: self._numbers(joint, limit, attribute, 1, math.inf)
            for attribute in ("lower", "upper", "effort", "velocity")
        }
        for attribute in ("effort", "velocity"):
            if values[attribute] is None:
                raise self.error("no-limit", joint, f"its <limit> has no {attribute}", example)
        if not bounded:
            return
        (lower,), (upper,) = values["lower"] or [0.0], values["upper"] or [0.0]
        if lower > upper:
            what = f"its lower limit {lower:g} is above its upper limit {upper:g}"
            self.warn("reversed-limits", joint, f"{what}; it is taken to have none, as PyBullet does")
        if values["lower"] is None or values["upper"] is None:
            missing = " and ".join(a for a in ("lower", "upper") if values[a] is None)
            self.warn("limit-zero", joint, f"its <limit> has no {missing}, which URDF takes as 0")

    def _mimics(self, joints: dict[str, Element]) -> None:
        masters: dict[str, str] = {}
        for name, joint in joints.items():
            mimic = self._only(joint, "mimic")
            if mimic is None:
                continue
            kind = joint.attributes["type"]
            if kind == "fixed":
                self.warn("mimic-fixed", joint, "is fixed, so its <mimic> was ignored")
                continue
            master = mimic.attributes.get("joint", "")
            for attribute in ("multiplier", "offset"):
                self._numbers(joint, mimic, attribute, 1)
            if master not in joints:
                what = f"mimics {master!r}, but no joint is called so" if master else "its <mimic> has no joint"
                raise self.error("mimic-unknown", joint, what, "name the joint to follow")
            master_kind = joints[master].attributes["type"]
            for which, bad in ((name, kind), (master, master_kind)):
                if bad not in SCALAR_TYPES:
                    what = f"mimics {master!r}, but {which!r} is {bad} and has no single value"
                    raise self.error("mimic-type", joint, what, "let scalar joints mimic scalar joints")
            masters[name] = master
        ending: set[str] = set()  # mimics that are known to follow a joint that moves freely
        for name, first in masters.items():
            seen: set[str] = set()
            master = name
            while master in masters and master not in ending:
                if master in seen:
                    what = f"mimics {first!r}, which in the end mimics itself"
                    raise self.error("mimic-cycle", joints[name], what, "let one of them move freely")
                seen.add(master)
                master = masters[master]
            ending |= seen


def _label(element: Element) -> str:
    return f"{element.tag} {brief(element.attributes.get('name', ''))!r}"
