"""From a lock file to what it holds, checked, and to a robot."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pinscrew.description import markup
from pinscrew.description.model import Description, Joint, Limits, drivers
from pinscrew.description.packages import is_file
from pinscrew.ground.errors import DescriptionError
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.lockfile import parsing
from pinscrew.lockfile.content import LockContent, LockedJoint
from pinscrew.robot.robot import Robot

__all__ = ["Lock", "read", "read_lock"]


@dataclass(frozen=True, slots=True)
class Lock:
    """A lock file that was read.

    Attributes:
        path: the lock file.
        content: what it holds.
    """

    path: Path
    content: LockContent

    @property
    def source(self) -> Path:
        """The robot's file."""
        return self.path.parent / self.content.source

    def robot(self) -> Robot:
        """The robot as it was when the lock was written.

        Its description has no text, so it can be given to `PoE` and to comparisons, but not to `Pinocchio`. Poses
        come back as the lock has them, within 1e-12 of a rotation.

        Raises:
            DescriptionError: if its names can't be a robot's; see `Robot`.
        """
        content = self.content
        homes: dict[str, FloatArray] = {content.base: np.eye(4)}
        driven = drivers({joint.name: joint.mimic for joint in content.joints})
        joints = []
        for joint in content.joints:
            homes[joint.child] = joint.home
            joints.append(_joint(joint, homes[joint.parent], driven[joint.name].offset))
        description = Description(
            name=content.robot,
            file=str(self.path),
            text="",
            links=tuple(homes),
            joints=tuple(joints),
            arguments=content.arguments,
        )
        return Robot(content.robot, description, content.floating_base, content.tip)


def read(path: str | Path) -> Robot:
    """The robot of a lock file, as it was when that was written, to 12 digits.

    Its description has no text, so `PoE` and comparisons take it, and `Pinocchio` does not.

    Raises:
        DescriptionError: if the file is no lock, is not whole, or was edited: codes ``lock-…``.
    """
    return read_lock(path).robot()


def read_lock(path: str | Path) -> Lock:
    """A lock file, checked: see `read`."""
    path = Path(path)
    if not is_file(path):
        remedy = f"write it with pinscrew lock {path.with_suffix('')}"
        raise DescriptionError("not-locked", "there is no such lock", file=path, remedy=remedy)
    return Lock(path, parsing.parse(markup.read(path), path))


def _joint(joint: LockedJoint, T_base_parent: FloatArray, value: float) -> Joint:
    """The joint in the parent's frame, from the child's home pose, the screw axis, and the value that it has there."""
    T_base_joint, axis = joint.home, np.zeros(3)
    if joint.screw is not None:
        slots = slice(0, 3) if joint.type == "prismatic" else slice(3, 6)
        axis = _solve(joint.home[:3, :3], joint.screw[slots])
        if value:
            twist = np.zeros(6)
            twist[slots] = axis
            T_base_joint = joint.home @ se3.exp(-twist * value)
    elif joint.type == "planar":
        axis = np.array([0.0, 0.0, 1.0])
    return Joint(
        name=joint.name,
        type=joint.type,
        parent=joint.parent,
        child=joint.child,
        T_parent_joint=_solve(T_base_parent, T_base_joint),
        axis=axis,
        limits=joint.limits or Limits(),
        mimic=joint.mimic,
    )


def _solve(A: FloatArray, B: FloatArray) -> FloatArray:
    """``A⁻¹ B``: not by transposing, so that poses rounded to 12 digits come back as they were."""
    return np.asarray(np.linalg.solve(A, B), dtype=np.float64)
