"""What the fixtures do: robots loaded once, and how two of them differ."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pinscrew.description import catalogue
from pinscrew.robot.loading import load
from pinscrew.robot.robot import Robot

__all__ = ["Robots", "difference"]


class Robots:
    """Loads robots as `pinscrew.load` does, paths relative to a folder, and keeps them."""

    def __init__(self, root: Path) -> None:
        self._root = root
        self._kept: dict[str, Robot] = {}

    def __call__(self, source: str | Path, **options: Any) -> Robot:
        """The robot; see `pinscrew.load` for the options and the errors."""
        if catalogue.is_path(source, self._root):
            source = self._root / source
        key = json.dumps([str(source), options], sort_keys=True, default=str)
        if key not in self._kept:
            self._kept[key] = load(source, **options)
        return self._kept[key]


def difference(a: Robot, b: Robot, *, length: float, angle: float) -> str:
    """How two robots differ by more than ``length`` (m) and ``angle`` (rad), in words; ``""`` if they don't."""
    from pinscrew.changes.run import diff

    changes = diff(a, b, length=length, angle=angle)
    return "" if changes.same else str(changes)
