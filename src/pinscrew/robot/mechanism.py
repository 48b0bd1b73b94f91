"""From a description to a mechanism at zero: which coordinates there are, and the screws and poses they move."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pinscrew.description.model import SCALAR_TYPES, Description, Joint, drivers, read_only
from pinscrew.ground.errors import DescriptionError
from pinscrew.ground.expressions import Unit
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3

__all__ = ["Coordinates", "JointMotion", "Mechanism", "mechanism_of"]

_POSITIONS: Final = {"floating": ("x", "y", "z", "qx", "qy", "qz", "qw"), "planar": ("x", "y", "theta")}
_POSITION_UNITS: Final[dict[str, tuple[Unit, ...]]] = {
    "floating": ("m", "m", "m", "", "", "", ""),
    "planar": ("m", "m", "rad"),
    "prismatic": ("m",),
}
_VELOCITY_UNITS: Final[dict[str, tuple[Unit, ...]]] = {
    **_POSITION_UNITS,
    "floating": ("m", "m", "m", "rad", "rad", "rad"),
}
_VELOCITIES: Final = {"floating": ("vx", "vy", "vz", "wx", "wy", "wz"), "planar": ("vx", "vy", "wz")}
# The unit twists (v, ω) that the velocities of these joints multiply, in the child's frame (as in Pinocchio).
_UNIT_TWISTS: Final = {"floating": np.eye(6), "planar": np.eye(6)[:, [0, 1, 5]]}


@dataclass(frozen=True, slots=True)
class JointMotion:
    """How a joint that moves moves: its screws at zero, and the coordinates that drive it.

    Attributes:
        joint: the joint in the description.
        parent: index in `Mechanism.motions` of the moving joint above, or -1.
        T_base_child: pose of the child link at zero, shape (4, 4).
        twists: spatial twists (v, ω) of the joint's unit velocities at zero, shape (6, k); k = 1 but for
            floating (6) and planar (3) joints.
        q: where its coordinates start in ``q``; a mimic joint has its master's.
        v: where its velocities start in ``qd``.
        multiplier: value of the joint per unit of its coordinate; 1 but for mimic joints.
        offset: value of the joint where its coordinate is zero; 0 but for mimic joints. The poses at zero have it
            in them already.
    """

    joint: Joint
    parent: int
    T_base_child: FloatArray
    twists: FloatArray
    q: int
    v: int
    multiplier: float
    offset: float

    @property
    def freedoms(self) -> int:
        """How many velocities it has: k."""
        return int(self.twists.shape[1])

    @property
    def coordinates(self) -> slice:
        """Where its coordinates stand in ``q``."""
        return slice(self.q, self.q + len(_POSITIONS.get(self.joint.type, ("",))))

    @property
    def velocities(self) -> slice:
        """Where its velocities stand in ``qd``."""
        return slice(self.v, self.v + self.freedoms)


@dataclass(frozen=True, slots=True)
class Coordinates:
    """Names, limits and neutral values of ``q`` and ``qd``; `Robot` says what each means."""

    joint_names: tuple[str, ...]
    names: tuple[str, ...]
    velocity_names: tuple[str, ...]
    limits: FloatArray
    neutral: FloatArray
    units: tuple[Unit, ...]
    """Of each entry of ``q``: ``"m"``, ``"rad"``, or ``""`` of a quaternion's."""
    velocity_units: tuple[Unit, ...]
    """Of each entry of ``qd``, per second."""
    q: Mapping[str, int]
    """Where each joint's coordinates start in ``q``."""
    v: Mapping[str, int]
    """Where each joint's velocities start in ``qd``."""

    @property
    def slides(self) -> NDArray[np.bool_]:
        """Which entries of ``q`` are displacements, shape (nq,); the others are angles, or a quaternion's."""
        return np.array([unit == "m" for unit in self.units], dtype=bool)


@dataclass(frozen=True, slots=True)
class Mechanism:
    """A description at zero.

    Attributes:
        coordinates: what moves it.
        motions: the moving joints in tree order.
        homes: the pose of each link in the base frame, at zero.
        motion_above: for each link the index of the motion that moves it most directly, or -1.
        reach: length (m) of the longest way from the base to a link over the joints' origins.
    """

    coordinates: Coordinates
    motions: tuple[JointMotion, ...]
    homes: Mapping[str, FloatArray]
    motion_above: Mapping[str, int]
    reach: float


def mechanism_of(description: Description) -> Mechanism:
    """The mechanism of a description: one pass down the tree."""
    coordinates = _coordinates(description)
    driven = drivers({joint.name: joint.mimic for joint in description.joints})
    root = description.root
    homes: dict[str, FloatArray] = {root: np.eye(4)}
    motion_above = {root: -1}
    lengths = {root: 0.0}
    motions: list[JointMotion] = []
    for joint in description.joints:
        lengths[joint.child] = lengths[joint.parent] + float(np.linalg.norm(joint.T_parent_joint[:3, 3]))
        parent = motion_above[joint.parent]
        T_base_joint = homes[joint.parent] @ joint.T_parent_joint
        if joint.type == "fixed":
            homes[joint.child], motion_above[joint.child] = T_base_joint, parent
            continue
        driver = driven[joint.name]
        twists = _unit_twists(joint)
        if driver.offset:
            # The joint's own motion leaves its twists as they are, so only the pose takes the offset in.
            T_base_joint = T_base_joint @ se3.exp(twists[:, 0] * driver.offset)
        homes[joint.child], motion_above[joint.child] = T_base_joint, len(motions)
        motions.append(
            JointMotion(
                joint=joint,
                parent=parent,
                T_base_child=read_only(T_base_joint),
                twists=read_only(se3.adjoint(T_base_joint) @ twists),
                q=coordinates.q[driver.joint],
                v=coordinates.v[driver.joint],
                multiplier=driver.multiplier,
                offset=driver.offset,
            )
        )
    for pose in homes.values():
        pose.setflags(write=False)
    return Mechanism(
        coordinates=coordinates,
        motions=tuple(motions),
        homes=MappingProxyType(homes),
        motion_above=MappingProxyType(motion_above),
        reach=max(lengths.values()),
    )


def _coordinates(description: Description) -> Coordinates:
    q: dict[str, int] = {}
    v: dict[str, int] = {}
    names: list[str] = []
    velocity_names: list[str] = []
    limits: list[tuple[float, float]] = []
    neutral: list[float] = []
    units: list[Unit] = []
    velocity_units: list[Unit] = []
    for joint in description.joints:
        if joint.type == "fixed" or joint.mimic is not None:
            continue
        q[joint.name], v[joint.name] = len(names), len(velocity_names)
        units += _POSITION_UNITS.get(joint.type, ("rad",))
        velocity_units += _VELOCITY_UNITS.get(joint.type, ("rad",))
        if joint.type in SCALAR_TYPES:
            names.append(joint.name)
            velocity_names.append(joint.name)
            limits.append((joint.limits.lower, joint.limits.upper))
            neutral.append(0.0)
        else:
            names += [f"{joint.name}.{part}" for part in _POSITIONS[joint.type]]
            velocity_names += [f"{joint.name}.{part}" for part in _VELOCITIES[joint.type]]
            limits += [(-math.inf, math.inf)] * len(_POSITIONS[joint.type])
            neutral += [float(part == "qw") for part in _POSITIONS[joint.type]]
    for name, count in Counter(names).items():
        if count > 1:
            what = f"two coordinates would be called {name!r}"
            raise DescriptionError("reserved-name", what, file=description.file, remedy="rename the joint")
    return Coordinates(
        joint_names=tuple(q),
        names=tuple(names),
        velocity_names=tuple(velocity_names),
        limits=read_only(np.array(limits).reshape(-1, 2)),
        neutral=read_only(np.array(neutral)),
        units=tuple(units),
        velocity_units=tuple(velocity_units),
        q=MappingProxyType(q),
        v=MappingProxyType(v),
    )


def _unit_twists(joint: Joint) -> FloatArray:
    """The twists of a joint's unit velocities, in the joint's frame: shape (6, k)."""
    if joint.type in _UNIT_TWISTS:
        return _UNIT_TWISTS[joint.type]
    twist = np.zeros((6, 1))
    first = 0 if joint.type == "prismatic" else 3
    twist[first : first + 3, 0] = joint.axis
    return twist
