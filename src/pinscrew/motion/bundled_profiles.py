"""Profiles by name: those that come with some of the bundled robots, and files."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from pinscrew.description import catalogue
from pinscrew.description.packages import is_file
from pinscrew.ground.errors import UnknownNameError
from pinscrew.motion.profile import Profile
from pinscrew.motion.profile_files import SUFFIXES
from pinscrew.motion.samples import Between
from pinscrew.robot.robot import Robot

__all__ = ["ASSIGNMENT", "named"]

ASSIGNMENT: Final = "assignment"
"""The name of the profile that a coursework gives with its robot."""


def named(name: str | Path, robot: Robot, between: Between = "linear") -> Profile:
    """The profile of this name: ``"assignment"``, which is bundled with some robots, or a file.

    Raises:
        UnknownNameError: if the robot has no bundled profile, or there is no such file.
        DescriptionError, InputError: see `Profile.read`.
    """
    folder = catalogue.robots_directory() / "profiles"
    bundled = folder / f"{robot.name}.yaml"
    path = Path(name)
    if name == ASSIGNMENT and is_file(bundled):
        return Profile.read(bundled, between)
    if name == ASSIGNMENT or not (path.suffix.lower() in SUFFIXES or is_file(path)):
        robots = ", ".join(sorted(file.stem for file in folder.glob("*.yaml")))
        known = (f"{ASSIGNMENT} (for {robots})", f"a file that ends in {', '.join(SUFFIXES)}")
        raise UnknownNameError("unknown-profile", "profile", str(name), known, where=robot.name)
    return Profile.read(path, between)
