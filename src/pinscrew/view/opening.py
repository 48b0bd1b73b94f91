"""How a robot is first seen: at which tip, and in which configuration. For the view alone: elsewhere tips are named."""

from __future__ import annotations

import re
from collections.abc import Collection
from typing import Final

import numpy as np

from pinscrew.ground.errors import AmbiguousTipError
from pinscrew.ground.typing import FloatArray
from pinscrew.robot.robot import Robot

__all__ = ["beside_zero", "configuration", "default_tip"]

TOOLS: Final = frozenset({"tcp", "tool", "ee", "eef", "effector"})
"""Words that name the frame of a tool, such as in ``hand_tcp``, ``tool0`` or ``l_ee_link``."""
GRIPPER: Final = re.compile(r"finger|thumb|index|middle|pinky|gripper|knuckle|jaw|claw", re.IGNORECASE)
"""What names of joints have that open and close a hand: beyond them is no tip of an arm."""


def default_tip(robot: Robot) -> str:
    """The robot's tip, or what is most likely meant where it has several leaves and no default.

    A frame that is named as a tool (`TOOLS`) comes first; then the leaf below most joints, once joints of grippers
    are left out: the hand and not a finger. Of equals the first; a hand alone has nothing but fingers.
    """
    try:
        return robot.tip
    except AmbiguousTipError as error:
        leaves = error.leaves
    tools = [name for name in robot.frame_names if TOOLS & set(_words(name)) and robot.motions_above(name)]
    if tools:
        return _deepest(robot, tools)
    ends = [name for name in _ends(robot) if robot.motions_above(name)]
    return _deepest(robot, ends or leaves)


def configuration(robot: Robot) -> FloatArray:
    """Zero, but the middle of the limits for a coordinate whose limits exclude zero; shape (nq,).

    Where one of those limits is infinite, the coordinate is at the other.
    """
    q = robot.neutral.copy()
    lower, upper = robot.limits.T
    for i in np.flatnonzero((q < lower) | (q > upper)):
        ends = [end for end in (lower[i], upper[i]) if np.isfinite(end)]
        q[i] = sum(ends) / len(ends)
    return q


def beside_zero(robot: Robot) -> list[str]:
    """The coordinates that are not at zero in `configuration`."""
    lower, upper = robot.limits.T
    outside = (robot.neutral < lower) | (robot.neutral > upper)
    return [name for name, beside in zip(robot.coordinate_names, outside, strict=True) if beside]


def _ends(robot: Robot) -> list[str]:
    """The leaves of the tree that is left without the joints of grippers and what hangs on them."""
    hanging: dict[str, list[tuple[str, bool]]] = {}
    for joint in robot.description.joints:
        gripper = joint.type != "fixed" and GRIPPER.search(joint.name) is not None
        hanging.setdefault(joint.parent, []).append((joint.child, gripper))
    kept, found = [robot.base], []
    for name in kept:  # grows as it goes down the tree
        below = [child for child, gripper in hanging.get(name, ()) if not gripper]
        kept += below
        if not below:
            found.append(name)
    return found


def _deepest(robot: Robot, frames: Collection[str]) -> str:
    return max(frames, key=lambda name: len(robot.motions_above(name)))


def _words(name: str) -> list[str]:
    """The words of a name, in small letters: of ``left_eeLink2`` these are left, ee and link."""
    return [word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)]
