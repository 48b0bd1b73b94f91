"""Where lock files are: beside their robot's file, by its name and ``.lock``."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from pinscrew.description.packages import is_file
from pinscrew.ground.errors import DescriptionError

__all__ = ["SUFFIXES", "below", "beside", "check_source", "is_lock"]

SUFFIXES: Final = (".urdf.lock", ".xacro.lock", ".xml.lock")
"""How the name of a lock file ends; other tools have ``.lock`` files too."""


def is_lock(path: str | Path) -> bool:
    """Whether a path is a lock's, by its name."""
    return str(path).endswith(SUFFIXES)


def beside(source: str) -> Path:
    """Where the lock of a robot's file is.

    Args:
        source: the path of the robot's file.

    Raises:
        DescriptionError: if it is no path, or its name ends in none of ``.urdf``, ``.xacro`` and ``.xml``.
    """
    lock = Path(f"{source}.lock")
    if is_lock(lock):
        return lock
    if is_file(Path(source)):
        what = "its name ends in none of .urdf, .xacro and .xml"
        remedy = "name the lock with --output, such as arm.urdf.lock"
    else:
        what, remedy = (
            "is no file, and a lock stands beside its robot's file",
            "give the path of a .urdf, .xacro or .xml",
        )
    raise DescriptionError("lock-name", what, file=source, remedy=remedy)


def check_source(lock: Path, source: str, *, named: Path | None = None, allow_outside: bool = False) -> None:
    """Refuse a lock that is of another file than it seems to be of, so that no file passes by another one's check.

    Args:
        lock: the lock file.
        source: the robot's file, relative to the lock's folder.
        named: the robot's file that was asked for; by default the one that the lock stands beside, if there is one.
        allow_outside: let the file be outside the lock's folder.

    Raises:
        DescriptionError: if the source is another file, or outside the lock's folder.
    """
    if not allow_outside and Path(os.path.normpath(source)).parts[:1] == ("..",):
        what = f"it was made from {source!r}, which is outside its folder"
        remedy = "keep it in the folder of the robot's file or above, or pass --allow-outside"
        raise DescriptionError("lock-outside", what, file=lock, remedy=remedy)
    neighbour = lock.with_name(lock.name.removesuffix(".lock"))
    expected = named or (neighbour if is_file(neighbour) else None)
    if expected is not None and not _same_file(lock.parent / source, expected):
        what = f"it was made from {source!r}, and not from {str(expected)!r}"
        remedy = "write that file's own lock with pinscrew lock, and give this one another name"
        raise DescriptionError("lock-other", what, file=lock, remedy=remedy)


def _same_file(a: Path, b: Path) -> bool:
    if os.path.abspath(a) == os.path.abspath(b):  # noqa: PTH100 (the name counts, whether or not there is a file)
        return True
    return is_file(a) and is_file(b) and a.samefile(b)


def below(folder: Path) -> Iterator[Path]:
    """The locks in a folder and all folders below it, in the order of their names, except for hidden folders."""
    for root, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        yield from (Path(root, name) for name in sorted(names) if is_lock(name))
