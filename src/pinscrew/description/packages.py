"""ROS packages without ROS: where ``$(find name)`` and ``package://name/…`` lead, and which folders may be read."""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Final
from urllib.parse import unquote

from pinscrew.ground.errors import DescriptionError
from pinscrew.ground.files import open_plain
from pinscrew.ground.words import brief, one_line

__all__ = ["Packages", "is_file", "is_package", "package_name", "packages_below"]

_NAME: Final = re.compile(r"<name>\s*([^<\s]+)\s*</name>")
_DEPTH: Final = 4
"""How deep below an entry of ROS_PACKAGE_PATH, or a repository's top, a package is looked for."""
MOST_FOLDERS: Final = 5_000
"""Folders that are looked into for packages."""
LARGEST: Final = 100_000
"""Bytes of a ``package.xml``, the name in which is looked for."""


@dataclass(frozen=True)
class Packages:
    """The package roots that a robot's file may use.

    Packages are looked for among those declared, then in AMENT_PREFIX_PATH and ROS_PACKAGE_PATH, then upwards of the
    file: the nearest ``package.xml``, its siblings, and the repository or ``src`` folder that it is in. They are known
    by their folders' names and by those in their ``package.xml``.

    Attributes:
        file: the robot's file.
        declared: roots by name, as ``--package name:=path`` gives them.
        allow_outside: let files be read from anywhere.
    """

    file: Path
    declared: Mapping[str, Path] = field(default_factory=lambda: MappingProxyType({}))
    allow_outside: bool = False
    _found: dict[str, Path] = field(default_factory=dict, init=False, repr=False, compare=False)

    def find(self, name: str) -> Path:
        """The root folder of a package.

        Raises:
            DescriptionError: if there is none of this name.
        """
        if name not in self._found:
            for root in self._candidates(name):
                if _is_folder(root):
                    self._found[name] = root.resolve()
                    break
            else:
                raise DescriptionError(
                    "unknown-package",
                    f"there is no package {brief(name)!r}",
                    file=self.file,
                    remedy=f"say where it is: --package {one_line(brief(name))}:=PATH",
                )
        return self._found[name]

    def _candidates(self, name: str) -> Iterator[Path]:
        if name in self.declared:
            yield self.declared[name]
            return
        if not re.fullmatch(r"[\w.+-]+", name) or name in (".", ".."):
            return
        for prefix in _paths("AMENT_PREFIX_PATH"):
            yield prefix / "share" / name
        for entry in _paths("ROS_PACKAGE_PATH"):
            yield from _named(name, packages_below(entry, _DEPTH))
        own = self._own_package()
        if own is not None:
            if name in (own.name, package_name(own)):
                yield own
            yield own.parent / name
            yield from _named(name, packages_below(own.parent, 1))
        for folder in self._checkouts():
            yield from _named(name, packages_below(folder, _DEPTH))

    def _checkouts(self) -> list[Path]:
        """The folders above the file in which other packages of its workspace are: a repository's top, a ``src``."""
        found: list[Path] = []
        for folder in self.file.resolve().parents:
            if folder.name == "src":
                found.append(folder)
            if os.path.lexists(folder / ".git"):
                found.append(folder)
                if folder.parent.name == "src":  # the other repositories of a workspace
                    found.append(folder.parent)
                break
        return found

    def _own_package(self) -> Path | None:
        """The nearest folder above the file that holds a ``package.xml``."""
        for folder in self.file.resolve().parents:
            if is_package(folder):
                return folder
        return None

    def _is_found(self, path: Path) -> bool:
        """Whether a path without links is in a package, with its ``package.xml``, that `find` finds by its name."""
        folder = next((folder for folder in path.parents if is_package(folder)), None)
        if folder is None:
            return False
        for name in {folder.name, package_name(folder)}:
            with contextlib.suppress(DescriptionError):
                if self.find(name) == folder:
                    return True
        return False

    def roots(self) -> tuple[Path, ...]:
        """The folders below which files may be read, beside the packages that `find` finds."""
        own_folders = self.file.parent, self.file.resolve().parent  # two where the file is a link
        roots = [*own_folders, *self.declared.values(), *_paths("ROS_PACKAGE_PATH")]
        roots += [prefix / "share" for prefix in _paths("AMENT_PREFIX_PATH")]
        own = self._own_package()
        if own is not None:
            roots.append(own)
        return tuple(root.resolve() for root in roots)

    def check(self, path: Path) -> Path:
        """The path with its links followed, if it may be read.

        Raises:
            DescriptionError: if it is outside all `roots` and all packages, or its links lead nowhere.
        """
        try:
            resolved = path.resolve()
        except (OSError, RuntimeError, ValueError) as error:  # links in a circle, a NUL character
            what = f"asks for {brief(str(path))!r}, which is no path ({one_line(str(error))})"
            raise DescriptionError("unreadable", what, file=self.file) from None
        inside = self.allow_outside or any(resolved.is_relative_to(root) for root in self.roots())
        if not inside and not self._is_found(resolved):
            raise DescriptionError(
                "outside",
                f"asks for {brief(str(path))!r}, which is outside its own folder and the declared packages",
                file=self.file,
                remedy="declare its package with --package NAME:=PATH, or give --allow-outside",
            )
        return resolved

    def resolve(self, uri: str) -> Path:
        """The file that a mesh's or image's ``filename`` names, which need not exist.

        Args:
            uri: a path relative to the robot's file, ``package://name/path`` or ``file:///path``.

        Raises:
            DescriptionError: if the package is unknown, the file outside all roots, or the scheme another.
        """
        scheme, separator, rest = uri.partition("://")
        if not separator:
            return self.check(self.file.parent / uri)
        if scheme == "file" and rest.startswith("/"):
            return self.check(Path(unquote(rest)))
        if scheme in ("package", "model"):
            name, _, path = rest.partition("/")
            return self.check(self.find(name) / path)
        raise DescriptionError(
            "remote-file",
            f"asks for {brief(uri)!r}; nothing is fetched from elsewhere",
            file=self.file,
            remedy="use a path, package:// or file://",
        )


def is_file(path: Path) -> bool:
    """Whether there is a file of this name; not where the name can't be one, or may not be asked for."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except (OSError, ValueError):
        return False


def _paths(variable: str) -> list[Path]:
    return [Path(entry) for entry in os.environ.get(variable, "").split(os.pathsep) if entry]


def is_package(folder: Path) -> bool:
    """Whether a folder is a ROS package."""
    return is_file(folder / "package.xml")


def packages_below(folder: Path, depth: int) -> Iterator[Path]:
    """Folders with a ``package.xml``, none inside another; links are not followed, nor hidden folders entered.

    Args:
        folder: where to look, itself included unless ``depth`` is all that is to be looked at.
        depth: how many levels down.
    """
    level = [folder]
    looked_at = 0
    for below in range(depth + 1):
        following: list[Path] = []
        for candidate in level:
            looked_at += 1
            if looked_at > MOST_FOLDERS:
                return
            if is_package(candidate):
                yield candidate
            elif below < depth:
                with contextlib.suppress(OSError), os.scandir(candidate) as entries:  # one that may not be read
                    following += sorted(Path(entry.path) for entry in entries if _is_entered(entry))
        level = following


def _is_entered(entry: os.DirEntry[str]) -> bool:
    return not entry.name.startswith(".") and entry.is_dir(follow_symlinks=False)


def _named(name: str, packages: Iterator[Path]) -> Iterator[Path]:
    return (root for root in packages if name in (root.name, package_name(root)))


def package_name(root: Path) -> str:
    """The name in a folder's ``package.xml``, or ``""``."""
    try:
        with open_plain(root / "package.xml") as stream:
            text = stream.read(LARGEST).decode("utf-8", "replace")
    except OSError:
        return ""
    match = _NAME.search(text)
    return match[1] if match else ""
