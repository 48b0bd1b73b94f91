"""What the options and ``[tool.pinscrew]`` of the rootdir's pyproject.toml say."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatch
from pathlib import Path
from typing import Any, Final, NoReturn

import pytest

from pinscrew.changes.gates import FILE, GATES, SECTION, section
from pinscrew.ground.errors import InputError
from pinscrew.ground.words import brief, one_line

__all__ = ["Listed", "Settings", "read"]

SUFFIXES: Final = (".urdf", ".urdf.xacro")
SAMPLES: Final = 100


@dataclass(frozen=True, slots=True)
class Listed:
    """A robot to test.

    Attributes:
        file: its file.
        arguments: its xacro arguments.
        packages: roots of ROS packages by name.
        frames: the frames to compare; None for all.
        id: what tells it from other robots of the file, or ``""``.
    """

    file: Path
    arguments: Mapping[str, str | float] = field(default_factory=dict)
    packages: Mapping[str, Path] = field(default_factory=dict)
    frames: tuple[str, ...] | None = None
    id: str = ""


@dataclass(frozen=True, slots=True)
class Settings:
    """How robots are tested, and which.

    Attributes:
        root: pytest's rootdir.
        samples: random configurations within limits.
        seed: of them.
        tolerance: largest error that is rounding; None for `pinscrew.verify`'s.
        exclude: patterns of paths, relative to the root, that are left out.
        fail_on: what of the notes is to fail the check of a lock that does not say so itself.
        robots: those that are listed, by their resolved files.
    """

    root: Path
    samples: int
    seed: int
    tolerance: float | None
    exclude: tuple[str, ...]
    fail_on: tuple[str, ...]
    robots: Mapping[Path, tuple[Listed, ...]]

    def robots_in(self, file: Path) -> tuple[Listed, ...]:
        """The robots of a file: those listed, or the one that it is with its own defaults."""
        listed = self.robots.get(file.resolve())
        if listed is not None:
            return listed
        path = file.relative_to(self.root).as_posix() if file.is_relative_to(self.root) else file.as_posix()
        excluded = any(fnmatch(path, pattern) for pattern in self.exclude)
        return () if excluded or not file.name.endswith(SUFFIXES) else (Listed(file),)


@dataclass(frozen=True, slots=True)
class _Kind:
    """What a value must be."""

    words: str
    fits: Callable[[Any], bool]


def _number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _table_of(fits: Callable[[Any], bool]) -> Callable[[Any], bool]:
    return lambda value: isinstance(value, dict) and all(map(fits, value.values()))


def _list_of(fits: Callable[[Any], bool]) -> Callable[[Any], bool]:
    return lambda value: isinstance(value, list) and all(map(fits, value))


def _text(value: object) -> bool:
    return isinstance(value, str) and value != ""


_COUNT: Final = _Kind("an integer, 0 or more", lambda value: _number(value) and isinstance(value, int) and value >= 0)
_TOLERANCE: Final = _Kind("a positive number, such as 1e-12", lambda value: _number(value) and 0.0 < value < math.inf)
_TEXT: Final = _Kind("a text", _text)
_TEXTS: Final = _Kind("a list of texts", _list_of(_text))

_NUMBERS: Final = {"samples": _COUNT, "seed": _COUNT, "tolerance": _TOLERANCE}
_TABLE: Final = {
    **_NUMBERS,
    "exclude": _TEXTS,
    "fail_on": _Kind(f"a list of {', '.join(GATES)}", _list_of(lambda one: isinstance(one, str) and one in GATES)),
    "robots": _Kind(f"a list of tables, each below [[{SECTION}.robots]]", _list_of(lambda one: isinstance(one, dict))),
}
_ROBOT: Final = {
    "file": _TEXT,
    "name": _TEXT,
    "arguments": _Kind(
        "a table of texts, numbers and booleans",
        _table_of(lambda value: isinstance(value, (str, bool)) or _number(value)),
    ),
    "packages": _Kind("a table of folders", _table_of(_text)),
    "frames": _Kind("a list of one or more frames", lambda value: _list_of(_text)(value) and value != []),
}


def read(config: pytest.Config) -> Settings:
    """The settings: options first, then the file.

    Raises:
        pytest.UsageError: if a key does not exist, a value is not what it must be, or a file is not there.
    """
    root = config.rootpath
    table = _checked(_section(root / FILE), SECTION, _TABLE)
    for name, kind in _NUMBERS.items():
        value = config.getoption(f"pinscrew_{name}")
        if value is not None:
            if not kind.fits(value):
                _refuse(f"--pinscrew-{name} is {value!r}; it must be {kind.words}")
            table[name] = value
    return Settings(
        root=root,
        samples=table.get("samples", SAMPLES),
        seed=table.get("seed", 0),
        tolerance=table.get("tolerance"),
        exclude=tuple(table.get("exclude", ())),
        fail_on=tuple(table.get("fail_on", ())),
        robots=_by_file([_robot(one, i, root) for i, one in enumerate(table.get("robots", ()))]),
    )


def _refuse(words: str) -> NoReturn:
    raise pytest.UsageError(one_line(brief(f"pinscrew: {words}", 1000)))


def _section(file: Path) -> Any:
    """The table of pinscrew in a pyproject.toml; empty where there is no such table or file."""
    try:
        return section(file)
    except InputError as error:
        _refuse(f"{FILE} {error.what}")


def _checked(table: Any, name: str, kinds: Mapping[str, _Kind]) -> dict[str, Any]:
    """The table, if it is one and has only these keys, with what they must be."""
    if not isinstance(table, dict):
        _refuse(f"{FILE}: {name} is {table!r}; it must be a table")
    known = ", ".join(kinds)
    for key, value in table.items():
        if key not in kinds:
            _refuse(f"{FILE}: {name} has a key {key!r}, which does not exist; known are: {known}")
        if not kinds[key].fits(value):
            _refuse(f"{FILE}: {name}.{key} is {value!r}; it must be {kinds[key].words} (known keys are: {known})")
    return dict(table)


def _robot(given: Any, index: int, root: Path) -> Listed:
    name = f"{SECTION}.robots[{index}]"
    table = _checked(given, name, _ROBOT)
    if "file" not in table:
        _refuse(f"{FILE}: {name} has no key 'file'; known are: {', '.join(_ROBOT)}")
    file = root / table["file"]
    if not file.is_file():
        _refuse(f"{FILE}: {name}.file: there is no file {table['file']!r} in {root}")
    packages = {package: root / folder for package, folder in table.get("packages", {}).items()}
    for package, folder in packages.items():
        if not folder.is_dir():
            _refuse(f"{FILE}: {name}.packages.{package}: there is no folder {table['packages'][package]!r} in {root}")
    arguments = {key: _argument(value) for key, value in table.get("arguments", {}).items()}
    frames = tuple(table["frames"]) if "frames" in table else None
    shown = table.get("name", ",".join(f"{key}={value}" for key, value in arguments.items()))
    return Listed(file, arguments, packages, frames, one_line(shown))


def _argument(value: Any) -> str | float:
    """A xacro argument; its booleans are written small, as in ROS."""
    return str(value).lower() if isinstance(value, bool) else value


def _by_file(robots: list[Listed]) -> dict[Path, tuple[Listed, ...]]:
    found: dict[Path, tuple[Listed, ...]] = {}
    for robot in robots:
        file = robot.file.resolve()
        others = found.get(file, ())
        if any(robot.id == other.id for other in others):
            shown = f"are both called {robot.id!r}" if robot.id else "have neither arguments nor a name"
            _refuse(f"{FILE}: two robots of {robot.file.name!r} {shown}; give each a 'name' of its own")
        found[file] = (*others, robot)
    return found
