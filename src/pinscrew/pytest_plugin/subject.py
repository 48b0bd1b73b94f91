"""A robot that is tested: loaded and verified when an item first asks, and once for all of them."""

from __future__ import annotations

import os
import shlex
from functools import cached_property
from pathlib import Path
from typing import Final

from pinscrew.description import markup
from pinscrew.ground.errors import PinscrewError, PinscrewWarning
from pinscrew.pytest_plugin.settings import Listed, Settings
from pinscrew.robot.loading import load
from pinscrew.robot.robot import Robot
from pinscrew.verification.outcome import Check
from pinscrew.verification.report import Report
from pinscrew.verification.run import TOLERANCE, verify
from pinscrew.verification.wording import largest_at

__all__ = ["TROUBLE", "Subject", "joint_lines"]

TROUBLE: Final = (PinscrewError, PinscrewWarning)
"""What keeps a robot from being tested; a warning does where Python is told to make errors of them."""


class Subject:
    """A robot that is tested.

    Attributes:
        listed: which it is.
        told: the item that said why there is nothing to test, or ``""``.
    """

    def __init__(self, listed: Listed, settings: Settings) -> None:
        self.listed = listed
        self.told = ""
        self._settings = settings

    @cached_property
    def robot(self) -> Robot | PinscrewError | PinscrewWarning:
        """The robot, or why it can't be loaded."""
        try:
            return load(self.listed.file, arguments=self.listed.arguments, packages=self.listed.packages)
        except TROUBLE as trouble:
            return trouble

    @cached_property
    def report(self) -> Report | PinscrewError | PinscrewWarning:
        """The report on it, or why there is none."""
        if isinstance(self.robot, TROUBLE):
            return self.robot
        s = self._settings
        tolerance = TOLERANCE if s.tolerance is None else s.tolerance
        try:
            return verify(self.robot, s.samples, s.seed, tolerance=tolerance, frames=self.listed.frames)
        except TROUBLE as trouble:
            return trouble

    def words(self, report: Report, check: Check, folder: Path) -> str:
        """What a failed check has to say, the joint to blame first; its command is for ``folder``."""
        lines = [*check.remarks, *report.diagnosis]
        if check.tolerance > 0.0:
            lines.append(f"{check.name}: error {check.error:.1e} above {check.tolerance:.1e}{largest_at(check)}")
        if check.place.q:
            lines.append(f"q = {list(check.place.q)}")
        return "\n".join(dict.fromkeys([*lines, f"again: {self._command(report, folder)}"]))

    def _command(self, report: Report, folder: Path) -> str:
        words = ["pinscrew", "verify", os.path.relpath(self.listed.file, folder)]
        words += [f"{name}:={value}" for name, value in self.listed.arguments.items()]
        for name, root in self.listed.packages.items():
            words += ["--package", f"{name}:={os.path.relpath(root, folder)}"]
        for frame in self.listed.frames or ():
            words += ["--frame", frame]
        return shlex.join([*words, "--samples", str(report.samples), "--seed", str(report.seed)])

    def line(self, report: Report, check: Check) -> int | None:
        """The line in the file of the joint that the diagnosis names first."""
        lines = joint_lines(self.listed.file)
        return next((lines[joint] for joint in (*report.blamed, check.place.joint) if joint in lines), None)


def joint_lines(file: Path) -> dict[str, int]:
    """Where joints are in a file, by name; those of macros and with names that are expressions are left out."""
    root = markup.parse(markup.read(file), file)
    return {joint.attributes["name"]: joint.line for joint in root.all("joint") if "name" in joint.attributes}
