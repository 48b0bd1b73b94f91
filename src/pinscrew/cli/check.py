"""``pinscrew check``: whether answers are right, and which slip explains what is wrong."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from pinscrew.cli import arguments, output

if TYPE_CHECKING:
    from pinscrew.checking.sheet import AnswerSheet
    from pinscrew.checking.verdict import AnswerVerdict

__all__ = ["command"]


@click.command(name="check", short_help="Say whether answers are right, and where not.")
@arguments.robot_argument(then=" [FILE]")
@arguments.tip_option
@click.option("--quantity", metavar="Q", help="What was asked for: M, xi1, T, Js, Jb, Jh, Vb, …")
@click.option("--text", help="The answer: a matrix in LaTeX, Python or MATLAB.")
@arguments.json_option
def command(words: tuple[str, ...], tip: str | None, quantity: str | None, text: str | None, as_json: bool) -> None:
    """Hold answers against the closed forms, exactly, however they are written.

    The answer is --text, or those in FILE: Markdown, LaTeX, Python, MATLAB, a notebook or JSON. `pinscrew derive ROBOT
    --worksheet` writes one to fill in.

    Exit status 0 if all are right, 1 if an entry is wrong, 2 if something can't be read and nothing is wrong.

    \b
      pinscrew check spherical --quantity xi2 --text '[0, -L_0, 0, -1, 0, 0]^T'
      pinscrew check scara answers.md
    """
    verdict = _verdict(arguments.robots(words), tip, quantity, text)
    if as_json:
        output.print_json(verdict.data())
    else:
        output.say(*str(verdict).splitlines())
    sys.exit({True: 0, False: 1, None: 2}[verdict.right])


def _verdict(
    named: list[arguments.Named], tip: str | None, quantity: str | None, text: str | None
) -> AnswerVerdict | AnswerSheet:
    import pinscrew as ps

    if (quantity is None) != (text is None):
        raise click.UsageError("--quantity and --text go together")
    if len(named) != (2 if text is None else 1) or (named[-1].arguments and text is None):
        wanted = "a robot alone beside --text" if text is not None else "a robot and a file of answers"
        raise click.UsageError(f"expected {wanted}, but got {', '.join(each.source for each in named)}")
    robot = named[0].load()
    if quantity is not None and text is not None:
        return ps.check(robot, quantity, text, tip=tip)
    return ps.check_file(robot, Path(named[1].source), tip=tip)
