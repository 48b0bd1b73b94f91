"""What pytest runs: an item for the loading of a robot, for each check, and for its lock file."""

from __future__ import annotations

import os
import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NoReturn

import pytest

from pinscrew.ground.errors import DescriptionError
from pinscrew.pytest_plugin.subject import TROUBLE, Subject, joint_lines

__all__ = ["CheckItem", "LoadItem", "LockItem", "RobotItem"]


class RobotItem(pytest.Item):
    """One question about a robot's file. Failures are told in words, at the line that they are about."""

    def __init__(self, **rest: Any) -> None:
        super().__init__(**rest)
        self.add_marker("pinscrew")
        self._line: int | None = None
        self._summary = ""

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """The file, the line that a failure is about (from 0, as pytest counts), and what to call the item."""
        return self.path, None if self._line is None else self._line - 1, f"{self.path.name}: {self.name}"

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """What the item has to say; a traceback only for what is not its own."""
        shown = super().repr_failure(excinfo, style)
        crash = getattr(shown, "reprcrash", None)
        if isinstance(excinfo.value, pytest.fail.Exception) and crash is not None:
            # Summaries, annotations and editors read from here where a failure is: not in this module.
            crash.path, crash.lineno = str(self.path), self._line or 1
            crash.message = self._summary or str(excinfo.value).partition("\n")[0]
            vars(self).pop("location", None)  # pytest keeps what reportinfo said before the line was known
        return shown

    def fail(self, words: str, line: int | None, summary: str = "") -> NoReturn:
        """Fail with these words about this line; their first line is the summary unless one is given."""
        self._line, self._summary = line, summary
        pytest.fail(words, pytrace=False)

    def fail_for(self, trouble: Exception) -> NoReturn:
        """Fail because the file can't be used."""
        folder = self.config.invocation_params.dir
        words = str(trouble).replace(str(self.path), os.path.relpath(self.path, folder))
        own = isinstance(trouble, DescriptionError) and trouble.file == str(self.path)
        self.fail(words, getattr(trouble, "line", None) if own else None)


class _SubjectItem(RobotItem):
    """A question about a robot as it is loaded and verified for all items of its file."""

    def __init__(self, *, subject: Subject, **rest: Any) -> None:
        super().__init__(**rest)
        self.subject = subject

    def first_to_tell(self) -> None:
        """Skip an item with nothing to test, unless it is the first: that one has to say why."""
        self.subject.told = self.subject.told or self.name
        if self.subject.told != self.name:
            pytest.skip(f"{self.path.name} can't be tested: see {self.subject.told!r}")


class LoadItem(_SubjectItem):
    """The file can be used."""

    def runtest(self) -> None:
        """Load the robot."""
        if isinstance(self.subject.robot, TROUBLE):
            self.first_to_tell()
            self.fail_for(self.subject.robot)


class CheckItem(_SubjectItem):
    """One check of the robot's report."""

    def __init__(self, *, check: str, **rest: Any) -> None:
        super().__init__(**rest)
        self._check = check

    def runtest(self) -> None:
        """Look the check up in the report."""
        report = self.subject.report
        if isinstance(report, TROUBLE):
            self.first_to_tell()
            self.fail_for(report)
        if len(report.checks) == 1:  # the engines do not see the same coordinates; that is all there is to tell
            self.first_to_tell()
        check = next((check for check in report.checks if check.name == self._check), report.checks[0])
        self.user_properties += [("error", f"{check.error:.3e}"), ("tolerance", f"{check.tolerance:.3e}")]
        if not check.ok:
            folder = self.config.invocation_params.dir
            self.fail(self.subject.words(report, check, folder), self.subject.line(report, check))


class LockItem(RobotItem):
    """The file still describes the mechanism of its lock file."""

    def __init__(self, *, lock: Path, packages: Mapping[str, Path], fail_on: tuple[str, ...], **rest: Any) -> None:
        super().__init__(**rest)
        self._lock, self._packages, self._fail_on = lock, packages, fail_on

    def runtest(self) -> None:
        """Compare the file with its lock."""
        from pinscrew.lockfile import check

        trouble: Exception | None = None
        try:
            checked = check(self._lock, packages=self._packages, otherwise=self._fail_on)
        except TROUBLE as error:
            trouble = error
        if trouble is not None:  # said out of the except clause, or pytest would tell both
            self.fail_for(trouble)
        if checked.changes is not None and not checked.passes:
            lock = os.path.relpath(self._lock, self.config.invocation_params.dir)
            changes = checked.changes.failing
            lines = joint_lines(self.path)
            line = next((lines[one.joint] for one in changes if one.joint in lines), None)
            words = f"{checked.changes}\nif that is meant: {shlex.join(['pinscrew', 'lock', lock])}"
            self.fail(words, line, summary=changes[0].words)
