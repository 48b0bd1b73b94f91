"""What pytest collects: a file of a robot, and in it an item for each check."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from pinscrew.pytest_plugin.items import CheckItem, LoadItem, LockItem
from pinscrew.pytest_plugin.settings import Settings
from pinscrew.pytest_plugin.subject import Subject
from pinscrew.verification.run import check_names

__all__ = ["Collector", "RobotFile"]


class Collector:
    """The hooks of a run with ``--pinscrew``."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._files: set[Path] = set()

    def pytest_collect_file(self, file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
        """Collect a file with robots to test."""
        if not self._settings.robots_in(file_path):
            return None
        self._files.add(file_path)
        return RobotFile.from_parent(parent, path=file_path, settings=self._settings)

    def pytest_report_collectionfinish(self) -> str:
        """Say how many files there are; that none was found would go unseen among other tests."""
        if not self._files:
            return "pinscrew: no robot files; name their folder, such as: pytest --pinscrew robots"
        s = self._settings
        return f"pinscrew: robot files: {len(self._files)}, samples: {s.samples}, seed: {s.seed}"


class RobotFile(pytest.File):
    """A URDF or xacro file. Nothing of it is read here: which items it has, only pinscrew and its settings say."""

    def __init__(self, *, settings: Settings, **rest: object) -> None:
        super().__init__(**rest)  # type: ignore[arg-type]
        self._settings = settings

    def collect(self) -> Iterator[pytest.Item]:
        """The items of each robot of the file."""
        robots = self._settings.robots_in(self.path)
        for robot in robots:
            subject = Subject(robot, self._settings)
            # As in parametrised tests, so that file::check[id] selects one, and file::check all.
            suffix = f"[{robot.id}]" if robot.id else ""
            yield LoadItem.from_parent(self, name=f"load{suffix}", subject=subject)
            for check in check_names(self._settings.samples):
                yield CheckItem.from_parent(self, name=f"{check}{suffix}", subject=subject, check=check)
        lock = self.path.with_name(f"{self.path.name}.lock")
        if lock.is_file():  # it names the robot's arguments itself, so there is one per file
            packages = {name: root for robot in robots for name, root in robot.packages.items()}
            yield LockItem.from_parent(self, name="lock", lock=lock, packages=packages, fail_on=self._settings.fail_on)
