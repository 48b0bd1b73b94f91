"""The tree that MuJoCo compiles from an MJCF, written as URDF with the same coordinates.

A joint's value is MuJoCo's ``qpos``, so that at zero it stands ``ref`` away from where the file draws it. Of a body
with joints 1 … k at points p₁ … pₖ, `mj_kinematics` computes

    T_parent_body = T_body · Π T(pᵢ) Jᵢ(qᵢ - refᵢ) T(-pᵢ),

which is a chain of URDF joints, with links between them that the file has not.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final
from xml.etree import ElementTree as ET

import numpy as np

from pinscrew.description import orientation
from pinscrew.description.model import Mimic
from pinscrew.ground.errors import UnsupportedError
from pinscrew.ground.typing import FloatArray
from pinscrew.ground.words import brief

__all__ = ["WrittenTree", "write"]

_KINDS: Final = {"hinge": "revolute", "slide": "prismatic", "free": "floating"}
_NO_LIMITS: Final = {"lower": "1", "upper": "-1", "effort": "0", "velocity": "0"}
"""Reversed limits are none to every reader here; URDF has no other way to say so of a sliding joint."""


@dataclass(slots=True)
class WrittenTree:
    """A tree as URDF.

    Attributes:
        root: the ``<robot>``.
        bodies, joints, sites: the names in it of MuJoCo's, in MuJoCo's order.
        efforts: the largest force or torque of each joint that has one.
    """

    root: ET.Element
    bodies: tuple[str, ...]
    joints: tuple[str, ...]
    sites: tuple[str, ...]
    efforts: dict[str, float] = field(default_factory=dict)

    def text(self) -> str:
        """The URDF."""
        ET.indent(self.root)
        return ET.tostring(self.root, encoding="unicode") + "\n"


def write(name: str, tree: Mapping[str, Any], file: str) -> WrittenTree:
    """The URDF of a compiled tree.

    Args:
        name: the model's name.
        tree: what `_mjcf_worker` answers.
        file: what to call it in messages.

    Raises:
        UnsupportedError: if it has a ball joint, or a coupling of joints that is not linear.
    """
    return _Writer(name, tree, file).write()


class _Writer:
    def __init__(self, name: str, tree: Mapping[str, Any], file: str) -> None:
        self.bodies, self.joints, self.sites = tree["bodies"], tree["joints"], tree["sites"]
        self.file = file
        taken: set[str] = set()
        links = _names(self.bodies["name"], "body", taken)
        sites = _names(self.sites["name"], "site", taken)
        self.links_taken = taken
        self.joints_taken: set[str] = set()
        joints = _names(self.joints["name"], "joint", self.joints_taken)
        self.out = WrittenTree(ET.Element("robot", name=name), links, joints, sites)
        self.followed = {coupling["joint"]: self._followed(coupling) for coupling in tree["couplings"]}

    def write(self) -> WrittenTree:
        for link in self.out.bodies:
            ET.SubElement(self.out.root, "link", name=link)
        of_body: dict[int, list[int]] = {}
        for joint, body in enumerate(self.joints["body"]):
            of_body.setdefault(body, []).append(joint)
        sites_of: dict[int, list[int]] = {}
        for site, body in enumerate(self.sites["body"]):
            sites_of.setdefault(body, []).append(site)
        for body, link in enumerate(self.out.bodies):
            if body:  # body 0 is the world
                parent = self.out.bodies[self.bodies["parent"][body]]
                self._body(parent, link, _pose(self.bodies, body), of_body.get(body, []))
            for site in sites_of.get(body, []):
                name = self.out.sites[site]
                ET.SubElement(self.out.root, "link", name=name)
                self._fixed(link, name, _pose(self.sites, site))
        return self.out

    def _body(self, parent: str, link: str, T: FloatArray, joints: Sequence[int]) -> None:
        """The joints between a body and its parent."""
        for count, joint in enumerate(joints, 1):
            point = np.eye(4)
            point[:3, 3] = self.joints["point"][joint]
            free = self.joints["kind"][joint] == "free"  # whose coordinates are a pose in the world
            T = np.eye(4) if free else T @ point @ self._moved(joint, -self.joints["rest"][joint])
            after = np.eye(4) if free else _translation(-point[:3, 3])
            last = count == len(joints) and not after[:3, 3].any()
            name = self.out.joints[joint]
            child = link if last else _free_name(f"{name}_frame", self.links_taken)
            if not last:
                ET.SubElement(self.out.root, "link", name=child)
            self._joint(joint, parent, child, T)
            if last:
                return
            parent, T = child, after
        self._fixed(parent, link, T)

    def _joint(self, joint: int, parent: str, child: str, T: FloatArray) -> None:
        name, kind = self.out.joints[joint], self.joints["kind"][joint]
        if kind not in _KINDS:
            what = f"joint {brief(name)!r}: ball joints are not supported"
            raise UnsupportedError("mjcf-unsupported", what, file=self.file, remedy="write three hinges in its body")
        follows = self.followed.get(joint)
        if isinstance(follows, float):  # held where it is
            element = _element(self.out.root, name, "fixed", parent, child, T @ self._moved(joint, follows))
            return
        limited = bool(self.joints["limited"][joint])
        word = _KINDS[kind] if limited or kind != "hinge" else "continuous"
        element = _element(self.out.root, name, word, parent, child, T)
        if kind == "free":
            return
        ET.SubElement(element, "axis", xyz=_numbers(self.joints["axis"][joint]))
        if self.joints["force_limited"][joint]:
            self.out.efforts[name] = max(map(abs, self.joints["force"][joint]))
        effort = repr(self.out.efforts.get(name, 0.0))
        if limited:
            lower, upper = (repr(end) for end in self.joints["range"][joint])
            ET.SubElement(element, "limit", lower=lower, upper=upper, effort=effort, velocity="0")
        elif kind == "slide":
            ET.SubElement(element, "limit", _NO_LIMITS | {"effort": effort})
        if isinstance(follows, Mimic):
            multiplier, offset = repr(follows.multiplier), repr(follows.offset)
            ET.SubElement(element, "mimic", joint=follows.joint, multiplier=multiplier, offset=offset)

    def _fixed(self, parent: str, child: str, T: FloatArray) -> None:
        _element(self.out.root, _free_name(f"{child}_fixed", self.joints_taken), "fixed", parent, child, T)

    def _moved(self, joint: int, value: float) -> FloatArray:
        """How a hinge or slide at its own point moves: shape (4, 4)."""
        axis = np.array(self.joints["axis"][joint])
        if self.joints["kind"][joint] == "slide":
            return _translation(value * axis)
        T = np.eye(4)
        if value:
            T[:3, :3] = orientation.of_quaternion([*(math.sin(value / 2.0) * axis), math.cos(value / 2.0)])
        return T

    def _followed(self, coupling: Mapping[str, Any]) -> Mimic | float:
        """What a coupled joint follows, or the value that it is held at.

        MuJoCo's coupling is y - ref_y = c₀ + c₁ (x - ref_x) + … + c₄ (x - ref_x)⁴ (XML reference, equality/joint).
        """
        joint, of = coupling["joint"], coupling["of"]
        constant, linear, *higher = coupling["coefficients"]
        rest = self.joints["rest"]
        if of < 0 or not (linear or any(higher)):
            return float(rest[joint] + constant)
        if any(higher):
            names = " to ".join(repr(brief(self.out.joints[index])) for index in (joint, of))
            shown = " ".join(f"{c:g}" for c in coupling["coefficients"])
            what = f"the coupling of joint {names} is not linear: polycoef={shown!r}"
            remedy = 'write polycoef="c0 c1 0 0 0", or leave the coupling out'
            raise UnsupportedError("mjcf-coupling", what, file=self.file, remedy=remedy)
        return Mimic(self.out.joints[of], linear, rest[joint] + constant - linear * rest[of])


def _names(given: Iterable[str], what: str, taken: set[str]) -> tuple[str, ...]:
    """Names that are there and unique; one that is not gets its kind, and its number if it has none."""
    names = list(given)
    own = set(names)
    found = []
    for index, name in enumerate(names):
        if name and name not in taken:
            taken.add(name)
            found.append(name)
        else:
            wanted = f"{name}_{what}" if name else f"{what}{index}"
            found.append(_free_name(wanted, taken | own))
            taken.add(found[-1])
    return tuple(found)


def _free_name(wanted: str, taken: set[str]) -> str:
    while wanted in taken:
        wanted += "_"
    taken.add(wanted)
    return wanted


def _translation(vector: FloatArray) -> FloatArray:
    T = np.eye(4)
    T[:3, 3] = vector
    return T


def _pose(of: Mapping[str, Any], index: int) -> FloatArray:
    w, x, y, z = of["quaternion"][index]
    T = _translation(of["position"][index])
    T[:3, :3] = orientation.of_quaternion([x, y, z, w])
    return T


def _numbers(values: Iterable[float]) -> str:
    return " ".join(repr(float(value) + 0.0).removesuffix(".0") for value in values)


def _element(root: ET.Element, name: str, kind: str, parent: str, child: str, T: FloatArray) -> ET.Element:
    joint = ET.SubElement(root, "joint", name=name, type=kind)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    ET.SubElement(joint, "origin", xyz=_numbers(T[:3, 3]), rpy=_numbers(orientation.to_rpy(T[:3, :3])))
    return joint
