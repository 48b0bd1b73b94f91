"""``pinscrew check``: whether an answer is right, and which slip explains it if not."""

from __future__ import annotations

import sys

import click

from pinscrew.cli import arguments, output

__all__ = ["command"]


@click.command(name="check", short_help="Say whether an answer is right, and where not.")
@arguments.robot_argument()
@arguments.tip_option
@click.option("--quantity", required=True, metavar="Q", help="What was asked for: M, xi1, T, Js, Jb, Jh, Vb, …")
@click.option("--text", required=True, help="The answer: a matrix in LaTeX, Python or MATLAB.")
@arguments.json_option
def command(words: tuple[str, ...], tip: str | None, quantity: str, text: str, as_json: bool) -> None:
    """Hold an answer against the closed forms, exactly, however it is written.

    Exit status 0 if it is right, 1 if an entry is wrong, 2 if something can't be read and nothing is wrong.

    \b
      pinscrew check spherical --quantity xi2 --text '[0, -L_0, 0, -1, 0, 0]^T'
    """
    from pinscrew.checking.run import check

    verdict = check(arguments.robot(words).load(), quantity, text, tip=tip)
    if as_json:
        output.print_json(verdict.data())
    else:
        output.say(*str(verdict).splitlines())
    sys.exit({True: 0, False: 1, None: 2}[verdict.right])
