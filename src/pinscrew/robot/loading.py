"""A robot by its name or file: the way from the catalogue through xacro and URDF to a `Robot`."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import TypeAlias

from pinscrew.description import catalogue, expand, markup, mjcf, urdf
from pinscrew.description.model import Description
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
        source: a bundled robot (``pinscrew list`` names them), the path of a URDF, xacro or MJCF file, or the name of
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
    text = markup.read(entry.file)
    ways = _packages(entry.file, packages, allow_outside=allow_outside)
    if mjcf.text_is_mjcf(text):
        description = _of_mjcf(text, ways, given, floating_base=floating_base, strict=strict)
    else:
        urdf_text = _expanded(text, given, ways)
        description = urdf.parse(urdf_text.text, entry.file, given, urdf_text.places, strict=strict)
    return Robot.from_description(description, name=entry.name, tip=tip or entry.tip, floating_base=floating_base)


def expanded(
    file: Path,
    arguments: Mapping[str, str],
    *,
    packages: Mapping[str, str | Path] | None = None,
    allow_outside: bool = False,
) -> expand.Expansion:
    """The URDF in a file, or what its xacro or MJCF stands for; see `load`. Of a plain URDF no places are known.

    Raises:
        DescriptionError: if the file can't be read or expanded, or has no arguments and some are given.
    """
    text, ways = markup.read(file), _packages(file, packages, allow_outside=allow_outside)
    if mjcf.text_is_mjcf(text):
        return expand.Expansion(_of_mjcf(text, ways, arguments).text, ())
    return _expanded(text, arguments, ways)


def _packages(file: Path, packages: Mapping[str, str | Path] | None, *, allow_outside: bool) -> Packages:
    return Packages(file, {name: Path(root) for name, root in (packages or {}).items()}, allow_outside)


def _of_mjcf(
    text: str, ways: Packages, arguments: Mapping[str, str], *, floating_base: bool = False, strict: bool = False
) -> Description:
    """The description of an MJCF.

    Raises:
        DescriptionError: see `mjcf.description_of`; or if it is to have arguments or a base that floats.
    """
    _refuse_arguments("an MJCF", ways.file, arguments)
    if floating_base:
        what = "an MJCF says itself what floats"
        raise DescriptionError("mjcf-floating", what, file=ways.file, remedy="write <freejoint/> in its body")
    return mjcf.description_of(text, ways, strict=strict)


def _expanded(text: str, arguments: Mapping[str, str], ways: Packages) -> expand.Expansion:
    file = ways.file
    by_content = not expand.is_xacro(file) and expand.text_is_xacro(text)
    if by_content:
        remark = "has xacro in it, and was expanded first"
        warnings.warn(PinscrewWarning("xacro-content", remark, file=file), stacklevel=4)
    if by_content or expand.is_xacro(file):
        return expand.expansion(file, arguments, ways)
    _refuse_arguments("a plain URDF", file, arguments)
    return expand.Expansion(text, ())


def _refuse_arguments(kind: str, file: Path, arguments: Mapping[str, str]) -> None:
    if arguments:
        what = f"{kind} has no arguments, but {', '.join(arguments)} came"
        raise DescriptionError("xacro-argument", what, file=file, remedy="leave them out")
