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
from pinscrew.ground.words import brief, one_line

__all__ = ["Packages", "is_file"]

_NAME: Final = re.compile(r"<name>\s*([^<\s]+)\s*</name>")
_DEPTH: Final = 4
"""How deep below an entry of ROS_PACKAGE_PATH a package is looked for."""


@dataclass(frozen=True)
class Packages:
    """The package roots that a robot's file may use.

    Packages are looked for among those declared, then in AMENT_PREFIX_PATH and ROS_PACKAGE_PATH, then upwards of the
    file: the nearest ``package.xml``, and its siblings.

    Attributes:
        file: the robot's file.
        declared: roots by name, as ``--package name:=path`` gives them.
        allow_outside: let files be read from anywhere.
    """

    file: Path
    declared: Mapping[str, Path] = field(default_factory=lambda: MappingProxyType({}))
    allow_outside: bool = False

    def find(self, name: str) -> Path:
        """The root folder of a package.

        Raises:
            DescriptionError: if there is none of this name.
        """
        for root in self._candidates(name):
            if _is_folder(root):
                return root.resolve()
        raise DescriptionError(
            "unknown-package",
            f"there is no package {brief(name)!r}",
            file=self.file,
            remedy=f"say where it is: --package {one_line(brief(name))}:=PATH",
        )

    def _candidates(self, name: str) -> Iterator[Path]:
        if name in self.declared:
            yield self.declared[name]
            return
        if not re.fullmatch(r"[\w.+-]+", name) or name in (".", ".."):
            return
        for prefix in _paths("AMENT_PREFIX_PATH"):
            yield prefix / "share" / name
        for entry in _paths("ROS_PACKAGE_PATH"):
            for root in _packages_below(entry, _DEPTH):
                if root.name == name or _package_name(root) == name:
                    yield root
        own = self._own_package()
        if own is not None:
            if name in (own.name, _package_name(own)):
                yield own
            yield own.parent / name

    def _own_package(self) -> Path | None:
        """The nearest folder above the file that holds a ``package.xml``."""
        for folder in self.file.resolve().parents:
            if is_file(folder / "package.xml"):
                return folder
        return None

    def roots(self) -> tuple[Path, ...]:
        """The folders below which files may be read."""
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
            DescriptionError: if it is outside all `roots`, or its links lead nowhere.
        """
        try:
            resolved = path.resolve()
        except (OSError, RuntimeError, ValueError) as error:  # links in a circle, a NUL character
            what = f"asks for {brief(str(path))!r}, which is no path ({one_line(str(error))})"
            raise DescriptionError("unreadable", what, file=self.file) from None
        if not self.allow_outside and not any(resolved.is_relative_to(root) for root in self.roots()):
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


def _packages_below(folder: Path, depth: int) -> Iterator[Path]:
    """Folders with a ``package.xml``, at most ``depth`` levels down and none inside another."""
    if is_file(folder / "package.xml"):
        yield folder
    elif depth and _is_folder(folder):
        with contextlib.suppress(OSError):  # a folder that may not be read
            for child in sorted(folder.iterdir()):
                if _is_folder(child) and not child.is_symlink() and not child.name.startswith("."):
                    yield from _packages_below(child, depth - 1)


def _package_name(root: Path) -> str:
    try:
        found = _NAME.search((root / "package.xml").read_text(encoding="utf-8", errors="replace"))
    except OSError:
        return ""
    return found[1] if found else ""
