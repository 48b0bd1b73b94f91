"""A robot by its name or file: the way from the catalogue through xacro and URDF to a `Robot`."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import TypeAlias

from pinscrew.description import catalogue, expand, markup, urdf
from pinscrew.description.packages import Packages
from pinscrew.ground.errors import DescriptionError, InputError, PinscrewWarning
from pinscrew.robot.robot import Robot

__all__ = ["RobotLike", "expanded", "load", "robot_of"]

RobotLike: TypeAlias = Robot | str | Path
"""A robot, or what `load` makes one of: a name or the path of a file."""


def robot_of(robot: RobotLike) -> Robot:
    """The robot itself, or the one that a name or a path stands for, as `load` without options has it.

    Raises:
        InputError: if it is neither.
        UnknownNameError, DescriptionError: see `load`.
    """
    if isinstance(robot, Robot):
        return robot
    if isinstance(robot, (str, Path)):
        return load(robot)
    what = f"a robot is needed, not {type(robot).__name__}"
    raise InputError("not-a-robot", what, remedy="give what ps.load returns, or a name or path that it takes")


def load(
    source: str | Path,
    *,
    floating_base: bool = False,
    tip: str | None = None,
    arguments: Mapping[str, float | str] | None = None,
    packages: Mapping[str, str | Path] | None = None,
    allow_outside: bool = False,
    strict: bool = False,
    **more: float | str,
) -> Robot:
    """Load a robot.

    Args:
        source: a bundled robot (``pinscrew list`` names them), the path of a URDF or xacro file, or the name of
            a URDF of example-robot-data.
        floating_base: let the root link float: seven coordinates (x, y, z and a quaternion x, y, z, w) come first.
        tip: the default tip frame.
        arguments: the xacro file's arguments, where their names are no Python identifiers or are taken here.
        packages: roots of ROS packages by name, for ``$(find …)`` and ``package://``; the environment's and the
            file's own are found without.
        allow_outside: let a xacro file read files outside its own folder and the packages; for meshes, see `show`.
        strict: refuse what is warned of otherwise: misspelt elements, degrees for radians, axes that are not of unit
            length, and the like.
        more: the xacro file's arguments, such as ``l1=0.4``.

    Raises:
        UnknownNameError: if there is no such robot, file, or frame ``tip``.
        DescriptionError: if the file can't be used.
    """
    entry = catalogue.find(source)
    given = {name: str(value) for name, value in {**(arguments or {}), **more}.items()}
    urdf_text = expanded(entry.file, given, packages=packages, allow_outside=allow_outside)
    description = urdf.parse(urdf_text.text, entry.file, given, urdf_text.places, strict=strict)
    return Robot.from_description(description, name=entry.name, tip=tip or entry.tip, floating_base=floating_base)


def expanded(
    file: Path,
    arguments: Mapping[str, str],
    *,
    packages: Mapping[str, str | Path] | None = None,
    allow_outside: bool = False,
) -> expand.Expansion:
    """The URDF in a file, or what its xacro stands for; see `load`. Of a plain URDF no places are known but its own.

    Raises:
        DescriptionError: if the file can't be read or expanded, or has no arguments and some are given.
    """
    text = markup.read(file)
    by_content = not expand.is_xacro(file) and expand.text_is_xacro(text)
    if by_content:
        remark = "has xacro in it, and was expanded first"
        warnings.warn(PinscrewWarning("xacro-content", remark, file=file), stacklevel=3)
    if by_content or expand.is_xacro(file):
        roots = {name: Path(root) for name, root in (packages or {}).items()}
        return expand.expansion(file, arguments, Packages(file, roots, allow_outside))
    if arguments:
        what = f"a plain URDF has no arguments, but {', '.join(arguments)} came"
        raise DescriptionError("xacro-argument", what, file=file, remedy="leave them out")
    return expand.Expansion(text, ())
