"""Where lock files are: beside their robot's file, by its name and ``.lock``."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from pinscrew.description.packages import is_file
from pinscrew.ground.errors import DescriptionError

__all__ = ["SUFFIXES", "below", "beside", "is_lock"]

SUFFIXES: Final = (".urdf.lock", ".xacro.lock")
"""How the name of a lock file ends; other tools have ``.lock`` files too."""


def is_lock(path: str | Path) -> bool:
    """Whether a path is a lock's, by its name."""
    return str(path).endswith(SUFFIXES)


def beside(source: str) -> Path:
    """Where the lock of a robot's file is.

    Args:
        source: the path of the robot's file.

    Raises:
        DescriptionError: if it is no path, or its name ends in neither ``.urdf`` nor ``.xacro``.
    """
    lock = Path(f"{source}.lock")
    if is_lock(lock):
        return lock
    if is_file(Path(source)):
        what = "its name ends in neither .urdf nor .xacro"
        remedy = "name the lock with --output, such as arm.urdf.lock"
    else:
        what, remedy = "is no file, and a lock stands beside its robot's file", "give the path of a .urdf or .xacro"
    raise DescriptionError("lock-name", what, file=source, remedy=remedy)


def below(folder: Path) -> Iterator[Path]:
    """The locks in a folder and all folders below it, in the order of their names, except for hidden folders."""
    for root, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        yield from (Path(root, name) for name in sorted(names) if is_lock(name))
