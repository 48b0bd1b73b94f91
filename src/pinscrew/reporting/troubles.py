"""Errors and warnings of pinscrew as findings."""

from __future__ import annotations

from pathlib import Path

from pinscrew.description.packages import is_file
from pinscrew.ground.errors import LONGEST, DescriptionError, PinscrewError, PinscrewWarning
from pinscrew.ground.words import brief, one_line
from pinscrew.reporting.findings import Finding

__all__ = ["from_error", "from_warning"]


def from_error(error: PinscrewError, robot: str = "") -> Finding:
    """What an error says, at its place.

    Args:
        error: the error.
        robot: the robot, as it was asked for; its file is the place of an error that has none.
    """
    file, line = (robot if is_file(Path(robot)) else ""), None
    if isinstance(error, DescriptionError):
        file, line = error.file, error.line
    said = [error.what, error.remedy]
    if not file and error.where:
        said[0] = f"{error.where}: {error.what}"
    return Finding(error.code, "error", "; ".join(_short(text) for text in said if text), file, line, robot)


def from_warning(warning: PinscrewWarning, robot: str = "") -> Finding:
    """What a warning says, at its place."""
    return Finding(warning.code, "warning", _short(warning.what), warning.file, warning.line, robot)


def _short(text: str) -> str:
    return one_line(brief(text, LONGEST))
