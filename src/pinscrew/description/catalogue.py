"""Robots by name: those that travel with pinscrew, those of example-robot-data, and any file."""

from __future__ import annotations

import difflib
import importlib
import importlib.metadata
import importlib.util
import json
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

from pinscrew.description import expand, markup
from pinscrew.description.packages import is_file
from pinscrew.ground.errors import DescriptionError, MissingExtraError, UnknownNameError
from pinscrew.ground.words import brief, one_line

__all__ = ["Entry", "bundled", "declared_arguments", "example_robots", "find", "is_path", "robots_directory"]

EXAMPLE_DATA: Final = "example-robot-data"
DESCRIPTIONS: Final = "robot_descriptions"
_MODULE: Final = re.compile(r"[a-z0-9_]+_description")


@dataclass(frozen=True, slots=True)
class Entry:
    """A robot that can be loaded.

    Attributes:
        name: what to load it by.
        file: its URDF or xacro file.
        aliases: further names.
        tip: its default tip, where that is not the lone leaf.
        title: what it is, in a few words.
        coursework: where it comes from.
    """

    name: str
    file: Path
    aliases: tuple[str, ...] = ()
    tip: str | None = None
    title: str = ""
    coursework: str = ""


def robots_directory() -> Path:
    """The folder of the bundled robots: inside the package when installed, at the top of a checkout."""
    package = Path(__file__).resolve().parents[1]
    installed = package / "_robots"
    return installed if installed.is_dir() else package.parents[1] / "robots"


@cache
def bundled() -> tuple[Entry, ...]:
    """The robots that travel with pinscrew, in the order of its catalogue."""
    directory = robots_directory()
    catalogue = json.loads((directory / "catalogue.json").read_text(encoding="utf-8"))
    return tuple(
        Entry(
            name=row["name"],
            file=directory / row["file"],
            aliases=tuple(row["aliases"]),
            tip=row["tip"],
            title=row["title"],
            coursework=row["coursework"],
        )
        for row in catalogue["robots"]
    )


@cache
def example_robots() -> tuple[Entry, ...]:
    """The URDFs of example-robot-data, by their files' names without the suffix.

    Where two files share a name, the folder that describes the robot comes before it, with a slash.

    Raises:
        MissingExtraError: if example-robot-data is not installed.
    """
    try:
        files = importlib.metadata.distribution(EXAMPLE_DATA).files or []
    except importlib.metadata.PackageNotFoundError:
        raise MissingExtraError(f"{EXAMPLE_DATA} is not installed", "robots") from None
    paths = sorted(Path(str(file.locate())).resolve() for file in files if file.suffix == ".urdf")
    stems = [path.stem for path in paths]
    entries = []
    for path in paths:
        folder = next(part for part in reversed(path.parts[:-1]) if part not in ("urdf", "robots"))
        name = path.stem if stems.count(path.stem) == 1 else f"{folder}/{path.stem}"
        entries.append(Entry(name, path))
    return tuple(entries)


def is_path(source: str | Path, folder: Path = Path()) -> bool:
    """Whether ``source`` is a path and not a name: a `Path`, text with a suffix of ours, or a file in ``folder``."""
    path = Path(source)
    return isinstance(source, Path) or path.suffix in (".urdf", ".xacro", ".xml") or is_file(folder / path)


def find(source: str | Path) -> Entry:
    """The robot that ``source`` names: a path, a bundled robot, a URDF of example-robot-data, or of robot_descriptions.

    Text is taken as a path if it ends in ``.urdf``, ``.xacro`` or ``.xml``, or is an existing file.

    Raises:
        UnknownNameError: if it names none of them; the message lists what comes close.
    """
    if is_path(source):
        return _of_path(Path(source))
    name = str(source)
    for entry in bundled():
        if name == entry.name or name in entry.aliases:
            return entry
    names = [known for entry in bundled() for known in (entry.name, *entry.aliases)]
    try:
        others = example_robots()
    except MissingExtraError:
        others = ()
    for entry in others:
        if name == entry.name:
            return entry
    names += [entry.name for entry in others]
    if (described := _described(name)) is not None:
        return described
    near = difflib.get_close_matches(name, names, n=5, cutoff=0.5)
    near += [known for known in names if name.lower() in re.split(r"[/_-]", known.lower()) and known not in near]
    raise UnknownNameError(
        "unknown-robot", "robot or file", name, tuple(near) or tuple(entry.name for entry in bundled())
    )


def _described(name: str) -> Entry | None:
    """The robot of a module of robot_descriptions, such as ``ur5e_description``, where that package is installed.

    Importing the module brings the robot's repository to its cache, unless it is there; that is the package's doing,
    and pinscrew's only where such a name is asked for.
    """
    if not _MODULE.fullmatch(name) or importlib.util.find_spec(DESCRIPTIONS) is None:
        return None
    if importlib.util.find_spec(f"{DESCRIPTIONS}.{name}") is None:
        return None
    try:
        module = importlib.import_module(f"{DESCRIPTIONS}.{name}")
    except Exception as error:  # whatever git, the network or the module raises
        what = f"{DESCRIPTIONS} does not get it ({type(error).__name__}: {one_line(brief(str(error)))})"
        raise DescriptionError("unreadable", what, file=name) from error
    for attribute in ("URDF_PATH", "XACRO_PATH", "MJCF_PATH"):
        if (file := getattr(module, attribute, None)) is not None:
            return Entry(name, Path(file))
    remedy = "name one that has a URDF, xacro or MJCF file"
    raise DescriptionError("no-file", f"the module of {DESCRIPTIONS} has no robot's file", file=name, remedy=remedy)


def _of_path(path: Path) -> Entry:
    """The file's own entry; a bundled file keeps what the catalogue says of it."""
    if is_file(path):
        for entry in bundled():
            if path.samefile(entry.file):
                return entry
    name = path.name
    for suffix in (".xacro", ".xml", ".urdf"):
        name = name.removesuffix(suffix)
    return Entry(name, path)


def declared_arguments(file: Path) -> dict[str, str]:
    """The arguments that a bundled xacro file declares, with their defaults."""
    if not expand.is_xacro(file):
        return {}
    root = markup.parse(markup.read(file), file)
    return {e.attributes["name"]: e.attributes.get("default", "") for e in root.all("xacro:arg")}
