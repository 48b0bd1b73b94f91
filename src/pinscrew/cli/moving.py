"""What commands about motion take beside configurations: velocities of joints, and points of frames."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from pinscrew.cli import arguments
from pinscrew.ground.errors import UnknownNameError

if TYPE_CHECKING:
    from pinscrew.ground.typing import FloatArray
    from pinscrew.robot.robot import Robot

__all__ = ["point", "rates"]


def rates(robot: Robot, text: str) -> FloatArray:
    """The velocities that ``--qd`` gives, shape (nv,).

    Raises:
        click.BadParameter: if they can't be read, or there is another number of them.
        UnknownNameError: if one is of no velocity of the robot.
    """
    import numpy as np

    names, units = robot.velocity_names, robot.velocity_units
    found = np.zeros(len(names))
    for name, value in arguments.values_by_name(text, robot.name, names, units, "--qd").items():
        if name not in names:
            raise UnknownNameError("unknown-velocity", "velocity", name, names, where=robot.name)
        found[names.index(name)] = value
    return found


def point(text: str, tip: str | None) -> tuple[tuple[float, float, float], str | None]:
    """The point that ``--point`` gives as x,y,z or x,y,z@FRAME, and its frame: that one, or ``tip``.

    Raises:
        click.BadParameter: if it is no point, or of another frame than ``tip``.
    """
    place, at, frame = text.removeprefix("=").partition("@")
    if at and not frame.strip():
        raise click.BadParameter(f"{text!r} names no frame after the @", param_hint="--point")
    if at and tip is not None and tip != frame.strip():
        raise click.BadParameter(f"the point is in {frame.strip()!r}, but --tip is {tip!r}", param_hint="--point")
    words = place.split(",")
    if len(words) != 3:
        raise click.BadParameter(f"{place!r} is not x,y,z; write 0,0,0.3 or 0,0,30cm@tool", param_hint="--point")
    x, y, z = (arguments.number(word, "--point", "m", of=axis) for word, axis in zip(words, "xyz", strict=True))
    return (x, y, z), frame.strip() if at else tip
