"""Pinocchio's model of a robot, from Pinocchio's own reading of the file."""

from __future__ import annotations

import math
import re
import tempfile
import warnings
from typing import Any
from xml.etree import ElementTree as ET

import pinocchio as pin

from pinscrew.description.model import Joint
from pinscrew.engines.native import standard_error_to
from pinscrew.engines.plain import plain_urdf
from pinscrew.ground.errors import EngineError, PinscrewError, PinscrewWarning
from pinscrew.robot.robot import Robot

__all__ = ["build"]


def build(robot: Robot) -> Any:
    """The model of a robot's URDF as it is; or, where Pinocchio refuses that, of its links and joints alone.

    A negative effort, a damping in words, a material that is there twice, reversed limits: none of them touches
    kinematics, but Pinocchio takes the file whole or not at all. What it reads then are the file's own words all the
    same (`plain_urdf`), and a warning says what it refused.

    Raises:
        EngineError: if Pinocchio refuses links and joints alone too; the message carries its words.
    """
    words = ""
    if not any(map(_unlimited, robot.description.joints)):
        try:
            return _read(robot, robot.description.text)
        except _RefusedError as refusal:
            words = str(refusal)
    try:  # the text passed our check when it was loaded, unless the description was made by hand
        model = _read(robot, ET.tostring(plain_urdf(robot, quaternions=True), encoding="unicode"))
    except (_RefusedError, PinscrewError) as refusal:
        what = f"Pinocchio refuses the file: {words or refusal}"
        raise EngineError("pinocchio-refuses", what, where=robot.description.file) from None
    if words:
        remark = f"Pinocchio was given its links and joints alone, since it refuses the file: {words}"
        warnings.warn(PinscrewWarning("pinocchio-plain", remark, file=robot.description.file), stacklevel=2)
    return model


def _unlimited(joint: Joint) -> bool:
    """Whether a joint that URDF wants limits of has none: its are reversed, which was warned of, and refused here."""
    return joint.type in ("revolute", "prismatic") and joint.limits.lower == -math.inf


class _RefusedError(Exception):
    """Pinocchio does not take a text; its words."""


def _read(robot: Robot, text: str) -> Any:
    root = (pin.JointModelFreeFlyer(),) if robot.floating_base else ()
    with tempfile.TemporaryFile() as said:
        try:
            with standard_error_to(said.fileno()):
                return pin.buildModelFromXML(text, *root)
        except (RuntimeError, ValueError, IndexError) as error:
            said.seek(0)
            words = " ".join(f"{said.read().decode(errors='replace')} {error}".split())
            # of the sources that its wheel was built from
            raise _RefusedError(re.sub(r" at line \d+ in \S+", "", words)) from None
