"""The same workspace from two choices of frame 0: a product of exponentials in each, brought to the base."""

from __future__ import annotations

import numpy as np

from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.robot.robot import Robot

__all__ = ["from_reference", "other_reference"]


def from_reference(robot: Robot, q: FloatArray, frame: str, reference: str) -> FloatArray:
    """Poses of a frame in the base, by the product of exponentials with frame 0 at ``reference``.

    With T = T_base_reference, and screws ξᵢ and home pose M in the reference frame, they are
    T e^{ξ1 θ1} … e^{ξn θn} M (MLS eq. 3.3); the engines know nothing of it.

    Args:
        robot: an arm with one screw for each coordinate.
        q: coordinates, shape (N, nq), rad and m.
        frame: the frame whose poses are asked for.
        reference: another choice of frame 0: a frame fixed to the base.

    Returns:
        T_base_frame, shape (N, 4, 4).

    Raises:
        UnknownNameError: if there is no such frame.
        InputError: if ``reference`` moves, or a mimic, planar or floating joint moves ``frame``.
    """
    screws = robot.screws(frame, reference=reference)
    T_reference_frame = np.broadcast_to(robot.home(frame, reference=reference), (len(q), 4, 4))
    for index in reversed(robot.motions_above(frame)):
        motion = robot.mechanism.motions[index]
        if motion.freedoms > 1 or motion.joint.mimic is not None:
            what = f"the joint {motion.joint.name!r} has no coordinate and screw of its own"
            remedy = "compare frames 0 of arms of revolute, continuous and prismatic joints"
            raise InputError("frame0", what, where=robot.name, remedy=remedy)
        T_reference_frame = se3.exp(screws[:, motion.v] * q[:, motion.q, None]) @ T_reference_frame
    carried: FloatArray = robot.home(reference) @ T_reference_frame
    return carried


def other_reference(robot: Robot) -> str:
    """The frame that can be frame 0 instead of the base: the only other one that is fixed to it.

    Raises:
        InputError: if there are none or several.
    """
    fixed = [name for name in robot.frame_names[1:] if robot.mechanism.motion_above[name] < 0]
    if len(fixed) != 1:
        what = f"{len(fixed)} frames but the base are fixed to it: {', '.join(fixed) or 'none'}"
        raise InputError("frame0", what, where=robot.name, remedy="name another choice of frame 0")
    return fixed[0]
