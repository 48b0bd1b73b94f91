"""The answers of a class: each file of a folder is graded by a process of its own, which no file can hang.

A child is the command `check` itself. It ends after some seconds, has limits of memory and of processor time, and what
it writes is read as JSON: a file that breaks its child costs one line.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from pinscrew.checking.passages import SUFFIXES
from pinscrew.ground.children import program
from pinscrew.ground.errors import InputError
from pinscrew.ground.escaping import csv_row
from pinscrew.ground.processes import job_count
from pinscrew.ground.words import brief, one_line

__all__ = ["SECONDS", "Submission", "check_folder", "submissions_csv"]

SECONDS: Final = 30.0
"""After which a child is ended: what any answer needs, many times over."""
MOST_FILES: Final = 10_000
MOST_OUTPUT: Final = 20_000_000
_LIMITED: Final = 'ulimit -c 0; ulimit -t "$0" 2>/dev/null; ulimit -v 4194304 2>/dev/null; exec "$@"'
"""A shell that sets limits (s of processor time, kB of memory: 4 GB) and becomes the program."""
_ONE_THREAD: Final = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


@dataclass(frozen=True, slots=True)
class Submission:
    """One file of a class.

    Attributes:
        file: its path below the folder.
        answers: its verdicts, as JSON has them (``pinscrew.check/1``).
        blank: quantities that are not filled in.
        error: why there are no verdicts, or ``""``.
    """

    file: str
    answers: tuple[dict[str, Any], ...] = ()
    blank: tuple[str, ...] = ()
    error: str = ""

    def count(self, word: bool | None) -> int:
        """How many answers are right (True), wrong (False) or not read (None)."""
        return sum(answer["right"] is word for answer in self.answers)

    def cell(self, quantity: str) -> str:
        """What there is to say of a quantity, in a few words."""
        said = [_said(answer) for answer in self.answers if answer["quantity"] == quantity]
        if not said and quantity in self.blank:
            return "blank"
        return "; ".join(dict.fromkeys(said))

    def __str__(self) -> str:
        if self.error:
            return f"{self.file}: {self.error}"
        return f"{self.file}: {self.count(True)} right, {self.count(False)} wrong, {self.count(None)} not read"


def _said(answer: dict[str, Any]) -> str:
    if answer["right"]:
        return "right"
    if answer["right"] is None:
        return one_line(f"not read: {brief(str(answer['unread'][0]['reason']), 120)}")
    places = " ".join(f"({i}, {j})" for i, j in answer["entries"][:6]) + " …" * (len(answer["entries"]) > 6)
    slips = f": {'; '.join(answer['slips'])}" if answer["slips"] else ""
    slips = f": follows from {', '.join(answer['follows'])}" if answer["follows"] else slips
    return one_line(brief(f"wrong {places}{slips}", 240))


def check_folder(
    words: Sequence[str], folder: Path, *, seconds: float = SECONDS, jobs: int | None = None
) -> tuple[Submission, ...]:
    """The verdicts on each file in a folder and the folders in it, by name.

    Args:
        words: of the command line of `check`, before the file: the robot, its arguments, options.
        folder: the folder; hidden files and folders are passed over, links are not followed.
        seconds: after which a file is given up.
        jobs: how many files at once; by default as many as there are cores.

    Raises:
        InputError: the folder can't be read, or has more than `MOST_FILES` files, or ``jobs`` is not positive.
    """
    try:
        files = sorted(_files(folder))
    except OSError as error:
        raise InputError("unreadable", f"can't be read ({error.strerror})", where=str(folder)) from None
    with ThreadPoolExecutor(job_count(jobs)) as threads:
        found = threads.map(lambda file: _submission(words, folder, file, seconds), files)
        return tuple(found)


def _files(folder: Path) -> Iterator[Path]:
    count = 0
    for root, folders, names in os.walk(folder):
        folders[:] = [name for name in folders if not name.startswith((".", "__"))]
        for name in names:
            if not name.startswith("."):
                count += 1
                if count > MOST_FILES:
                    raise InputError("check-file", f"there are more than {MOST_FILES} files", where=str(folder))
                yield Path(root, name)


def _submission(words: Sequence[str], folder: Path, file: Path, seconds: float) -> Submission:
    name = str(file.relative_to(folder))
    if file.is_symlink():
        return Submission(name, error="it is a link, and is not followed")
    if file.suffix.lower() not in SUFFIXES:
        return Submission(name, error=f"files {file.suffix or 'without a suffix'} are not read")
    command = [sys.executable, "-m", "pinscrew", "check", *words, "--json", "--", str(file.absolute())]
    limited = ["/bin/sh", "-c", _LIMITED, str(int(seconds) + 1), *command]
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        try:
            with program(limited, stdout=out, stderr=err, env={**os.environ, **_ONE_THREAD}) as process:
                process.wait(seconds)
        except subprocess.TimeoutExpired:
            return Submission(name, error=f"it takes more than {seconds:g} s")
        out.seek(0)
        err.seek(0)
        return _read(name, out.read(MOST_OUTPUT), err.read(4000))


def _read(name: str, out: bytes, err: bytes) -> Submission:
    """What a child said, on either stream."""
    try:
        document = json.loads(out)
        return Submission(name, tuple(document["answers"]), tuple(document["blank"]))
    except (ValueError, KeyError, TypeError):
        lines = err.decode("utf-8", "replace").strip().splitlines()
        said = lines[-1].removeprefix("pinscrew: ") if lines else "its process ended without an answer"
        return Submission(name, error=one_line(brief(said, 300)))


def submissions_csv(found: Sequence[Submission]) -> str:
    """A row for each file: how many answers are right, wrong and not read, then each quantity in a few words."""
    names = [str(answer["quantity"]) for each in found for answer in each.answers]
    quantities = list(dict.fromkeys([*names, *(name for each in found for name in each.blank)]))
    rows: list[list[object]] = [["file", "right", "wrong", "not read", "error", *quantities]]
    for each in found:
        counts = [each.count(word) for word in (True, False, None)]
        rows.append([each.file, *counts, each.error, *map(each.cell, quantities)])
    return "\n".join([*map(csv_row, rows), ""])
