#!/usr/bin/env python
"""Load and verify every URDF and xacro file below a folder, and say what became of them.

    python scripts/sweep_repository.py FOLDER [--samples N] [--all] [PATTERN ...]

Each file is a child process's, which may take a minute of processor time and 2 GB, so that none hurts the others.
Beside ours stands the verdict of upstream xacro, which is given the same packages, and of Pinocchio about its text. A
file that both take and we refuse is one to look at; so is one that expands to different texts, and one on which the
engines disagree. With --all the others are listed too.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import sys
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

SECONDS: Final = 60
MEMORY: Final = 2 * 2**30
SUFFIXES: Final = (".urdf", ".xacro")


@dataclass(frozen=True)
class Verdict:
    """What became of a file: ours, upstream xacro's, and in words."""

    file: Path
    ours: str
    upstream: str
    words: str

    @property
    def suspect(self) -> bool:
        """Whether upstream xacro does what we do not."""
        loads = self.ours in ("agree", "disagree")
        return self.ours == "disagree" or self.upstream == "other text" or (self.upstream == "expands" and not loads)


def files_below(folder: Path, patterns: Sequence[str]) -> Iterator[Path]:
    """The URDF and xacro files below a folder, in order; with patterns, those that match one."""
    for path in sorted(folder.rglob("*")):
        if path.suffix in SUFFIXES and path.is_file() and (not patterns or any(map(path.match, patterns))):
            yield path


def judge(path: Path, samples: int) -> dict[str, str]:
    """Our verdict and upstream's, in this process."""
    import pinscrew as ps
    from pinscrew.description import expand, markup

    answer = {"ours": "", "upstream": "-", "words": ""}
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            robot = ps.load(path)
        answer["words"] = "; ".join(str(warning.message) for warning in caught)
        report = ps.verify(robot, samples=samples)
        answer["ours"] = "agree" if report.ok else "disagree"
        answer["words"] += "" if report.ok else str(report)
    except ps.PinscrewError as error:
        answer["ours"], answer["words"] = error.code, str(error)
    try:
        if not expand.is_xacro(path) and not expand.text_is_xacro(markup.read(path)):
            return answer
        expected = _upstream(path)
    except Exception as error:  # whatever xacro raises is its verdict
        return {**answer, "upstream": f"fails ({type(error).__name__})"}
    if answer["ours"] != "agree":
        return {**answer, "upstream": "expands" if _is_robot(expected) else "no robot"}
    return {**answer, "upstream": "expands" if expand.expand(path, {}) == expected else "other text"}


def _is_robot(text: str) -> bool:
    """Whether Pinocchio makes a robot of a text."""
    import pinocchio as pin

    try:
        pin.buildModelFromXML(text)
    except Exception:  # of whatever kind Boost makes of it
        return False
    return True


def _upstream(path: Path) -> str:
    """What xacro itself makes of a file."""
    import xacro
    from xacro import substitution_args

    from pinscrew.description.packages import Packages

    packages = Packages(path)
    substitution_args._eval_find = lambda name: str(packages.find(name))
    text: str = xacro.process_file(str(path)).toprettyxml(indent="  ")
    return text


def apart(work: Callable[[], dict[str, str]]) -> dict[str, str]:
    """The answer of a piece of work that is done in a child process, under limits."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        silent = os.open(os.devnull, os.O_WRONLY)
        os.dup2(silent, 1)
        os.dup2(silent, 2)
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 1))
        if sys.platform == "linux":
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        try:
            answer: dict[str, Any] = work()
        except BaseException as error:
            answer = {"ours": "crash", "upstream": "-", "words": f"{type(error).__name__}: {error}"}
        with os.fdopen(writing, "w") as stream:
            json.dump(answer, stream)
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as stream:
        text = stream.read()
    _, status = os.waitpid(child, 0)
    if not text:
        return {"ours": "killed", "upstream": "-", "words": f"status {os.waitstatus_to_exitcode(status)}"}
    found: dict[str, str] = json.loads(text)
    return found


def table(verdicts: Sequence[Verdict]) -> str:
    """How many files met which fate, by what upstream xacro made of them."""
    counts = Counter((verdict.ours, verdict.upstream.partition(" (")[0]) for verdict in verdicts)
    columns = sorted({upstream for _, upstream in counts})
    fates = sorted({ours for ours, _ in counts}, key=lambda fate: (fate not in ("agree", "disagree"), fate))
    width = max(map(len, [*fates, "files"]))
    rows = [f"{'':{width}}  {'files':>6}  " + "  ".join(f"{column:>10}" for column in columns)]
    for fate in fates:
        numbers = [counts[fate, column] for column in columns]
        rows.append(f"{fate:{width}}  {sum(numbers):6}  " + "  ".join(f"{number or '':>10}" for number in numbers))
    sums = [sum(counts[fate, column] for fate in fates) for column in columns]
    rows.append(f"{'files':{width}}  {sum(sums):6}  " + "  ".join(f"{number or '':>10}" for number in sums))
    return "\n".join(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("patterns", nargs="*", help="only files that match one of these")
    parser.add_argument("--samples", type=int, default=2)
    parser.add_argument("--all", action="store_true", help="list every file")
    chosen = parser.parse_args()

    import pinscrew as ps  # once, and not in each child

    ps.verify(ps.load("one_joint"), samples=1)
    verdicts = []
    for path in files_below(chosen.folder, chosen.patterns):
        answer = apart(lambda path=path: judge(path, chosen.samples))  # type: ignore[misc]
        verdict = Verdict(path, **answer)
        verdicts.append(verdict)
        if chosen.all or verdict.suspect:
            place = path.relative_to(chosen.folder)
            print(f"{place}: {verdict.ours}; xacro {verdict.upstream}; {verdict.words}", flush=True)
    print(table(verdicts))


if __name__ == "__main__":
    main()
