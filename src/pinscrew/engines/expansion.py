"""From our coordinates to those of Pinocchio's model: mimic joints expanded, angles as it wants them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pinscrew.description import markup
from pinscrew.ground.errors import UnsupportedError
from pinscrew.ground.typing import FloatArray
from pinscrew.robot.robot import Robot

__all__ = ["MAX_COORDINATES", "MAX_DEPTH", "CoordinateExpansion", "Driven", "check_size", "read_mimics"]

MAX_COORDINATES: Final = 200
"""Pinocchio's data grows with the cube of the velocities: 0.6 GB for 200, 8 GB for 500."""
MAX_DEPTH: Final = 1000
"""Longest chain of moving joints; Pinocchio's stack overflows at about 3500."""


@dataclass(frozen=True, slots=True)
class Driven:
    """How one joint of the model gets its coordinates from ours.

    Attributes:
        q: where its coordinates start in the model's.
        nq: how many they are: 2 for the angle of a continuous joint, its cosine and sine.
        source: where ours start.
        multiplier, offset: of what it mimics.
        kind: as in `JointView.type`.
    """

    q: int
    nq: int
    source: int
    multiplier: float
    offset: float
    kind: str


@dataclass(frozen=True)
class CoordinateExpansion:
    """The way from our coordinates to the model's, joint by joint in the model's order; ``nq`` is the model's."""

    joints: tuple[Driven, ...]
    nq: int

    @cached_property
    def gathered(self) -> NDArray[np.intp] | None:
        """Which of our coordinates are the model's, if these are nothing else."""
        if any((joint.nq, joint.multiplier, joint.offset) != (1, 1.0, 0.0) for joint in self.joints):
            return None
        return np.array([joint.source for joint in self.joints], dtype=np.intp)

    @property
    def scalar(self) -> bool:
        """Whether each joint has one value."""
        return all(joint.kind in ("revolute", "prismatic") for joint in self.joints)

    @property
    def identical(self) -> bool:
        """Whether the model's coordinates are ours."""
        return all(
            (joint.q, joint.nq, joint.multiplier, joint.offset) == (joint.source, 1, 1, 0) for joint in self.joints
        )

    def all(self, q: FloatArray) -> FloatArray:
        """Our coordinates (N, nq) as the model's."""
        out = np.empty((len(q), self.nq))
        for joint in self.joints:
            target = out[:, joint.q : joint.q + joint.nq]
            if joint.kind == "floating":
                target[:] = q[:, joint.source : joint.source + 7]
            elif joint.kind == "planar":
                target[:, :2] = q[:, joint.source : joint.source + 2]
                _store_angle(target[:, 2:], q[:, joint.source + 2])
            else:
                value = joint.multiplier * q[:, joint.source] + joint.offset
                if joint.nq == 2:
                    _store_angle(target, value)
                else:
                    target[:, 0] = value
        return out

    def one(self, q: FloatArray, values: Sequence[float]) -> FloatArray:
        """One configuration, also as a list, of joints with one value each.

        Without numpy, whose calls take longer than the work, but where one call does it all.
        """
        if self.gathered is not None:
            return q.take(self.gathered)
        out: list[float] = []
        for joint in self.joints:
            value = joint.multiplier * values[joint.source] + joint.offset
            out += (value,) if joint.nq == 1 else (math.cos(value), math.sin(value))
        return np.array(out)


def read_mimics(robot: Robot) -> dict[str, tuple[str, float, float]]:
    """The mimic joints of the URDF (checked when it was loaded): joint followed, multiplier, offset."""
    mimics = {}
    for joint in markup.parse(robot.description.text, robot.description.file).all("joint"):
        for mimic in joint.all("mimic"):
            if joint.attributes["type"] != "fixed":
                multiplier = float(mimic.attributes.get("multiplier", "1"))
                offset = float(mimic.attributes.get("offset", "0"))
                mimics[joint.attributes["name"]] = (mimic.attributes["joint"], multiplier, offset)
    return mimics


def _store_angle(out: FloatArray, angle: FloatArray) -> None:
    out[:, 0], out[:, 1] = np.cos(angle), np.sin(angle)


def check_size(robot: Robot) -> None:
    """Refuse a robot that Pinocchio takes too long for, or ends the process over.

    Raises:
        UnsupportedError: if it has more than `MAX_COORDINATES` velocities or `MAX_DEPTH` joints in a chain.
    """
    depths = {robot.base: 0}
    for joint in robot.description.joints:
        depths[joint.child] = depths[joint.parent] + 1
    velocities = sum(motion.freedoms for motion in robot.mechanism.motions)
    for count, limit, what in (
        (velocities, MAX_COORDINATES, "velocities (mimic joints counted)"),
        (max(depths.values()), MAX_DEPTH, "joints in a chain"),
    ):
        if count > limit:
            raise UnsupportedError(
                "pinocchio-size",
                f"{count} {what} are more than the {limit} that the Pinocchio engine takes",
                file=robot.description.file,
                remedy="use the PoE engine, which has no such limit",
            )
