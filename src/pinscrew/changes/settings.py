"""``[tool.pinscrew]`` of a pyproject.toml, for commands and for the plugin of pytest."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, Final

from pinscrew.changes.gates import gates
from pinscrew.ground.errors import InputError

__all__ = ["FILE", "SECTION", "fail_on", "nearest", "section"]

FILE: Final = "pyproject.toml"
SECTION: Final = "tool.pinscrew"


def section(file: Path) -> Any:
    """The table of pinscrew in a pyproject.toml; an empty one where there is no such table or file.

    Raises:
        InputError: if the file can't be read.
    """
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib
    if not file.is_file():
        return {}
    try:
        return tomllib.loads(file.read_text(encoding="utf-8")).get("tool", {}).get("pinscrew", {})
    except (OSError, ValueError, AttributeError) as error:  # AttributeError: 'tool' is no table
        raise InputError("settings", f"can't be read: {error}", where=str(file)) from None


def nearest(folder: Path) -> Path | None:
    """The pyproject.toml of a folder, or of the nearest one above it, up to the top of its repository."""
    for place in (folder, *folder.parents):
        if (place / FILE).is_file():
            return place / FILE
        if (place / ".git").exists():
            break
    return None


def fail_on(folder: Path) -> frozenset[str]:
    """What ``fail_on`` of ``[tool.pinscrew]`` says for a folder; nothing where it is not said.

    Raises:
        InputError: if the file can't be read, or ``fail_on`` is no list of what can be failed on.
    """
    file = nearest(folder)
    if file is None:
        return frozenset()
    table = section(file)
    names = table.get("fail_on", []) if isinstance(table, dict) else None
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        what = f"{SECTION}.fail_on is no list of texts"
        raise InputError("settings", what, where=str(file), remedy='write such as fail_on = ["names"]')
    return gates(names, f"{file}: {SECTION}.fail_on")
