"""Files as forges name them: relative to the top of the checkout, with slashes."""

from __future__ import annotations

import os
from pathlib import Path

__all__ = ["below", "top"]


def top() -> Path:
    """The folder that paths are relative to: ``$GITHUB_WORKSPACE`` if it holds the working directory, else the latter.

    A GitHub job that works in a folder of its checkout is told about the files from the checkout's top.
    """
    here = Path.cwd()
    workspace = os.environ.get("GITHUB_WORKSPACE", "")
    if workspace:
        folder = Path(workspace).resolve()
        if here.is_relative_to(folder):
            return folder
    return here


def below(file: str) -> str | None:
    """The file's path from `top`, or None if it is elsewhere, or no file."""
    path = Path(os.path.abspath(file))  # noqa: PTH100 (a link in the checkout stays the file that is told about)
    root = top()
    return path.relative_to(root).as_posix() if file and path.is_relative_to(root) else None
