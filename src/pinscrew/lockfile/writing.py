"""From a robot to its lock."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from pinscrew.changes.gates import gates
from pinscrew.description.model import SCALAR_TYPES, Joint
from pinscrew.ground.typing import FloatArray
from pinscrew.lockfile.content import LockContent, LockedJoint
from pinscrew.robot.robot import Robot

__all__ = ["content", "fingerprint", "text"]

DIGITS: Final = 12
"""Significant digits of a pose or screw: below them are the roundings of different machines."""


def fingerprint(robot: Robot) -> str:
    """A hash of the robot's mechanism, ``sha256:…``: of what its lock holds, without what that was made from.

    It covers the base and, in tree order, each joint's name, type, links, home pose and screw axis to 12 digits,
    limits and mimic. It does not depend on the file's place and formatting, on the robot's name and default tip, on
    geometry and inertia, or on how the numbers came about (xacro arguments).

    Robots of one fingerprint have the same mechanism, coordinates and frames. Robots of different ones may still
    have: a number within rounding of a tie can fall to either side of it, so compare them then, as `check` does.
    """
    return content(robot).hash


def text(robot: Robot, lock: str | Path | None = None, *, fail_on: Iterable[str] | None = None) -> str:
    """The text of the robot's lock file: deterministic, in UTF-8, with a newline at its end.

    Args:
        robot: the robot.
        lock: where the file will stand, since it names the robot's file relative to its own folder; by default
            beside that.
        fail_on: what of the notes is to fail its check, such as ``["names"]``; by default the lock does not say.

    Raises:
        InputError: if there is no such thing to fail on.
    """
    return replace(content(robot, lock), fail_on=None if fail_on is None else gates(fail_on)).text()


def content(robot: Robot, lock: str | Path | None = None) -> LockContent:
    """What the robot's lock holds; see `text`."""
    description = robot.description
    source = Path(description.file)
    folder = source.parent if lock is None else Path(lock).parent
    grid = _Grid(robot)
    return LockContent(
        robot=description.name,
        source=Path(os.path.relpath(source, folder)).as_posix(),
        base=robot.base,
        joints=tuple(grid.joint(joint) for joint in description.joints),
        arguments=dict(description.arguments),
        floating_base=robot.floating_base,
        tip=robot.default_tip,
    )


class _Grid:
    """Poses and screws of a robot, rounded so that noise of the last bits shows in none of them.

    An exact zero and a sine of π must read the same, so lengths are first rounded to a decimal place 13 digits below
    the robot's size, and rotations to the 13th.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        # A size of 1 must not become one of 1.0000000000000002 on another machine: six digits of it tell.
        size = float(f"{robot.reach:.6g}") or 1.0
        self._decimals = DIGITS + 1 - math.ceil(math.log10(size))

    def joint(self, joint: Joint) -> LockedJoint:
        """The joint as a lock holds it."""
        home = self._pose(self._robot.home(joint.child))
        return LockedJoint(
            name=joint.name,
            type=joint.type,
            parent=joint.parent,
            child=joint.child,
            home=home,
            screw=self._screw(joint, home) if joint.type in SCALAR_TYPES else None,
            limits=joint.limits if joint.type in SCALAR_TYPES else None,
            mimic=joint.mimic,
        )

    def _pose(self, pose: FloatArray) -> FloatArray:
        rounded = np.round(pose, DIGITS + 1)
        rounded[:3, 3] = [round(x, self._decimals) for x in pose[:3, 3].tolist()]
        return _digits(rounded)

    def _screw(self, joint: Joint, home: FloatArray) -> FloatArray:
        """The spatial screw axis: ``(-ω × p, ω)`` or ``(v, 0)``, MLS eq. 2.26 and 2.27.

        It follows from the rounded pose, so that a robot read back from its lock has the same one.
        """
        direction = _digits(np.round(self._robot.home(joint.child)[:3, :3] @ joint.axis, DIGITS + 1))
        if joint.type == "prismatic":
            return np.concatenate([direction, np.zeros(3)])
        moment = np.cross(home[:3, 3], direction)
        return np.concatenate([[round(x, self._decimals) for x in moment.tolist()], direction])


def _digits(values: FloatArray) -> FloatArray:
    """The numbers as a lock writes them."""
    return np.array([float(f"{x:.{DIGITS}g}") for x in values.ravel().tolist()]).reshape(values.shape)
