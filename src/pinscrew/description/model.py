"""What a file says about a robot: links, joints, origins, axes, limits, mimics. No kinematics."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from types import MappingProxyType
from typing import Any, Final, Literal, TypeAlias, get_args

import numpy as np

from pinscrew.ground.typing import FloatArray

__all__ = [
    "JOINT_TYPES",
    "SCALAR_TYPES",
    "Description",
    "Joint",
    "JointType",
    "Limits",
    "Mimic",
    "MjcfModel",
    "Rebuilt",
    "drivers",
]

JointType: TypeAlias = Literal["revolute", "continuous", "prismatic", "fixed", "floating", "planar"]

JOINT_TYPES: Final[tuple[JointType, ...]] = get_args(JointType)
SCALAR_TYPES: Final[frozenset[JointType]] = frozenset({"revolute", "continuous", "prismatic"})
"""Joints with one coordinate along or about an axis."""


class Rebuilt:
    """A dataclass that is pickled and copied by its fields: made anew, with its arrays read-only again."""

    __slots__ = ()

    def __reduce__(self) -> tuple[Any, ...]:
        values = (getattr(self, f.name) for f in fields(self) if f.init)  # type: ignore[arg-type]
        return type(self), tuple(dict(v) if isinstance(v, MappingProxyType) else v for v in values)


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of one joint: radians or metres, and per second; infinite where the file sets none."""

    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    effort: float = math.inf


@dataclass(frozen=True, slots=True)
class Mimic:
    """A joint's value as a function of another's: ``multiplier * value(joint) + offset``."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class Joint(Rebuilt):
    """One joint as the file states it.

    Attributes:
        T_parent_joint: pose of the joint's frame in the parent link's, shape (4, 4). The child link's frame
            coincides with it at value zero.
        axis: unit vector in the joint's frame, shape (3,).
        line: line of the element in the robot's file.
        file: the file that has that line, where it is another: one that a xacro file includes.
    """

    name: str
    type: JointType
    parent: str
    child: str
    T_parent_joint: FloatArray = field(repr=False)
    axis: FloatArray
    limits: Limits = Limits()
    mimic: Mimic | None = None
    line: int | None = None
    file: str = ""

    def __post_init__(self) -> None:
        self.T_parent_joint.setflags(write=False)
        self.axis.setflags(write=False)


@dataclass(frozen=True, slots=True)
class MjcfModel(Rebuilt):
    """What an MJCF is to MuJoCo, beside the URDF that is written from it.

    Attributes:
        text: the MJCF, with includes put in place and without what moves nothing.
        bodies: the link of each body, in MuJoCo's order.
        joints: the joint of each joint.
        sites: the link of each site.
    """

    text: str = field(repr=False)
    bodies: tuple[str, ...]
    joints: tuple[str, ...]
    sites: tuple[str, ...]


@dataclass(frozen=True)
class Description(Rebuilt):
    """A robot as its file describes it, checked to be one tree.

    Attributes:
        name: the robot's name in the file.
        file: where it came from.
        text: the URDF itself, after xacro expansion; what any other reader should be given.
        links: the links' names, parents before children (depth first, siblings as in the file).
        joints: the joints, in the order of the links they lead to.
        arguments: the xacro arguments that were given.
        mjcf: the MJCF that ``text`` was written from, if it was.
    """

    name: str
    file: str
    text: str = field(repr=False)
    links: tuple[str, ...]
    joints: tuple[Joint, ...]
    arguments: Mapping[str, str] = field(default_factory=dict)
    mjcf: MjcfModel | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "arguments", MappingProxyType(dict(self.arguments)))

    @property
    def root(self) -> str:
        """The link that no joint leads to."""
        return self.links[0]

    @property
    def leaves(self) -> tuple[str, ...]:
        """The links that no joint starts from, in the order of ``links``."""
        parents = {joint.parent for joint in self.joints}
        return tuple(link for link in self.links if link not in parents)

    def path(self, link: str) -> Iterator[Joint]:
        """The joints from ``link`` up to the root."""
        above = {joint.child: joint for joint in self.joints}
        while link in above:
            joint = above[link]
            yield joint
            link = joint.parent


def drivers(mimics: Mapping[str, Mimic | None]) -> dict[str, Mimic]:
    """What drives each joint: the joint with a coordinate of its own, itself maybe, at the end of its mimics.

    Args:
        mimics: of all joints by their names, None for joints that follow no other.
    """
    found = {}
    for name in mimics:
        driver = Mimic(name)
        while (mimic := mimics[driver.joint]) is not None:
            offset = driver.offset + driver.multiplier * mimic.offset
            driver = Mimic(mimic.joint, driver.multiplier * mimic.multiplier, offset)
        found[name] = driver
    return found


def read_only(array: FloatArray) -> FloatArray:
    """The array, as float64 and without leave to write."""
    array = np.asarray(array, dtype=np.float64)
    array.setflags(write=False)
    return array
