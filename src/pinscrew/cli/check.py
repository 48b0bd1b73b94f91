"""``pinscrew check``: whether answers are right, and which slip explains what is wrong."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeAlias

import click

from pinscrew.cli import arguments, output

if TYPE_CHECKING:
    from pinscrew.checking.sheet import AnswerSheet
    from pinscrew.checking.verdict import AnswerVerdict

__all__ = ["command", "option_words"]

_Frames: TypeAlias = tuple[str | None, str | None]
"""The tip, and frame 0."""
_STATUS: Final = {True: 0, False: 1, None: 2}


@click.command(name="check", short_help="Say whether answers are right, and where not.")
@arguments.robot_argument(then=" [FILE|FOLDER]")
@arguments.tip_option
@click.option("--from", "--reference", "reference", metavar="FRAME", help="Another frame 0; by default the base.")
@click.option("--quantity", metavar="Q", help="What was asked for: M, xi1, T, Js, Jb, Jh, Vb, …")
@click.option("--text", help="The answer: a matrix in LaTeX, Python or MATLAB.")
@click.option("-q", "at", metavar="VALUES", help="Answers are in numbers at these joint values: 45deg,pi/4,0.1.")
@click.option("--errata", is_flag=True, help="Check the printed mistakes of the robot's coursework instead.")
@click.option("--format", "form", type=click.Choice(["text", "markdown", "html"]), default="text", help="How to print.")
@click.option("--csv", "csv_file", type=output.FILE, help="Write a row for each file of FOLDER to this file.")
@click.option("--jobs", type=click.IntRange(1), help="Files of FOLDER at once; by default as many as there are cores.")
@arguments.json_option
def command(
    words: tuple[str, ...],
    tip: str | None,
    reference: str | None,
    quantity: str | None,
    text: str | None,
    at: str | None,
    errata: bool,
    form: str,
    csv_file: Path | None,
    jobs: int | None,
    as_json: bool,
) -> None:
    """Hold answers against the closed forms, exactly, however they are written.

    The answer is --text, or those in FILE: Markdown, LaTeX, Python, MATLAB, a notebook or JSON. `pinscrew derive ROBOT
    --worksheet` writes one to fill in. Of a FOLDER each file is graded, by a process of its own.

    Exit status 0 if all are right, 1 if an entry is wrong, 2 if something can't be read and nothing is wrong.

    \b
      pinscrew check spherical --quantity xi2 --text '[0, -L_0, 0, -1, 0, 0]^T'
      pinscrew check scara answers.md
      pinscrew check scara homework --csv grades.csv
    """
    named = arguments.robots(words)
    if errata:
        _errata(named, form, as_json=as_json)
        return
    # Not `Path.is_dir`, which raises for a name that is too long.
    if text is None and len(named) == 2 and os.path.isdir(named[1].source):  # noqa: PTH112
        _class(words[:-1], Path(named[1].source), (tip, reference), at, csv_file, jobs, as_json=as_json)
        return
    if csv_file is not None or jobs is not None:
        raise click.UsageError("--csv and --jobs are for a folder")
    verdict = _verdict(named, (tip, reference), quantity, text, at)
    if as_json:
        output.print_json(verdict.data())
    elif form == "text":
        output.say(*str(verdict).splitlines())
    else:
        click.echo(verdict.to_html() if form == "html" else verdict.to_markdown(), nl=False)
    sys.exit(_STATUS[verdict.right])


def _verdict(
    named: list[arguments.Named], frames: _Frames, quantity: str | None, text: str | None, at: str | None
) -> AnswerVerdict | AnswerSheet:
    import pinscrew as ps

    tip, reference = frames
    if (quantity is None) != (text is None):
        raise click.UsageError("--quantity and --text go together")
    if len(named) != (2 if text is None else 1) or (named[-1].arguments and text is None):
        wanted = "a robot alone beside --text" if text is not None else "a robot and a file of answers"
        raise click.UsageError(f"expected {wanted}, but got {', '.join(each.source for each in named)}")
    robot = named[0].load()
    q = None if at is None else arguments.configuration(robot, at)
    if quantity is not None and text is not None:
        return ps.check(robot, quantity, text, q=q, tip=tip, reference=reference)
    return ps.check_file(robot, Path(named[1].source), q=q, tip=tip, reference=reference)


def _class(
    words: tuple[str, ...],
    folder: Path,
    frames: _Frames,
    at: str | None,
    csv_file: Path | None,
    jobs: int | None,
    *,
    as_json: bool,
) -> None:
    from pinscrew.checking.run import checkable
    from pinscrew.checking.submissions import check_folder, submissions_csv

    robot = arguments.robot(words)
    name = checkable(robot.load(), *frames).robot.name  # what is wrong with the robot is said once, and before the work
    given = option_words()
    for option, value in zip(("--tip", "--from", "-q"), (*frames, at), strict=True):
        given += [option, value] if value is not None else []
    found = check_folder([*given, *words], folder, jobs=jobs)
    if csv_file is not None:
        output.write_file(csv_file, submissions_csv(found))
    if as_json:
        files = [
            {"file": each.file, "answers": each.answers, "blank": each.blank, "error": each.error or None}
            for each in found
        ]
        output.print_json({"schema": "pinscrew.check/1", "robot": name, "files": files})
    else:
        output.say(*map(str, found))
    wrong, unread = (sum(each.count(word) for each in found) for word in (False, None))
    sys.exit(1 if wrong else 2 if unread or not found or any(each.error for each in found) else 0)


def _errata(named: list[arguments.Named], form: str, *, as_json: bool) -> None:
    from pinscrew.checking.coursework import check_errata

    if len(named) != 1 or form == "html":
        raise click.UsageError("--errata takes a robot alone, and --format text or markdown")
    found = check_errata(named[0].load().name)
    if as_json:
        output.print_json(found.data())
    elif form == "markdown":
        click.echo(found.to_markdown(), nl=False)
    else:
        output.say(*str(found).splitlines())
    sys.exit(0 if found.located == len(found.found) else 1)


def option_words() -> list[str]:
    """The options of `robot_argument` as words of a command line, for a child of this process."""
    given = arguments.options()
    found = [word for name, path in given.get("packages", {}).items() for word in ("--package", f"{name}:={path}")]
    flags = ("allow_outside", "strict", "floating_base")
    return found + [f"--{flag.replace('_', '-')}" for flag in flags if given.get(flag)]
