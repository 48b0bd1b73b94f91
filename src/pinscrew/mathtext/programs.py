"""Functions without branches or loops in Python, C, MATLAB and Julia, as far as closed forms need them.

A function is its arguments, assignments of formulas to names, and a matrix or an array at the end. Nothing is run.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from pinscrew.ground.errors import InputError
from pinscrew.mathtext.plain import read_plain
from pinscrew.mathtext.tree import Node

__all__ = ["Program", "read_programs"]


@dataclass(frozen=True, slots=True)
class Program:
    """A function.

    Attributes:
        name: its name.
        steps: what is assigned to which name, in order; ``q[0]`` and the like are symbols.
        cells: the result by rows; in C, where it is an array, one row.
    """

    name: str
    steps: tuple[tuple[str, Node], ...]
    cells: tuple[tuple[Node, ...], ...]


_COMMENTS: Final = {"python": '"""', "c": "/*", "matlab": "%", "julia": "#"}
_HEADS: Final = {
    "python": re.compile(r"def (\w+)\("),
    "c": re.compile(r"void (\w+)\("),
    "matlab": re.compile(r"function out = (\w+)\("),
    "julia": re.compile(r"function (\w+)\("),
}
_STEP: Final = re.compile(r"(?:const double )?([^\W\d]\w*|out\[\d+\])\s*=\s*(.+?);?")
_OPENING: Final = {"python": "return [", "matlab": "out = [", "julia": "return ["}
_IGNORED: Final = re.compile(r"\{|\}|\(void\)\w+;|if nargin < 2|lengths = \[.*\];|end|#.*|const .*\};|")
ARRAYS: Final = ("q", "lengths")


def read_programs(text: str, language: str) -> tuple[Program, ...]:
    """The functions of a source text.

    Raises:
        InputError: a line in a function is none of what is read.
    """
    found: list[Program] = []
    lines = _without_comments(text, language).splitlines()
    at = 0
    while at < len(lines):
        head = _HEADS[language].match(lines[at].strip())
        at += 1
        if head:
            end = next((i for i in range(at, len(lines)) if _HEADS[language].match(lines[i].strip())), len(lines))
            found.append(_function(head[1], [line.strip() for line in lines[at:end]], language))
            at = end
    return tuple(found)


def _without_comments(text: str, language: str) -> str:
    mark = _COMMENTS[language]
    if language == "julia":  # 1//2 binds more than a division
        text = re.sub(r"(?<![\w.])(\d+)\s*//\s*(\d+)(?![\w.])", r"(\1/\2)", text)
    if language == "c":
        return re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    if language == "python":
        return re.sub(r'""".*?"""', "", text, count=1, flags=re.DOTALL)
    return "\n".join(line for line in text.splitlines() if not line.strip().startswith(mark))


def _function(name: str, lines: list[str], language: str) -> Program:
    steps: list[tuple[str, Node]] = []
    cells: list[tuple[Node, ...]] = []
    out: list[Node] = []
    inside = False
    for line in lines:
        if inside:
            inside = line not in ("]", "];")
            if inside:
                cells.append(_row(line, language))
        elif line == _OPENING.get(language):
            inside = True
        elif step := _STEP.fullmatch(line):
            if step[1] == "lengths":  # the defaults, where none are given
                continue
            formula = read_plain(step[2], ARRAYS, side_by_side=False)
            if step[1] == f"out[{len(out)}]":
                out.append(formula)
            else:
                steps.append((step[1], formula))
        elif not _IGNORED.fullmatch(line):
            raise InputError("formula", f"this line of a function is not read: {line[:80]!r}")
    return Program(name, tuple(steps), tuple(cells) if cells else (tuple(out),))


def _row(line: str, language: str) -> tuple[Node, ...]:
    # In MATLAB and Julia cells of a row stand between spaces, and have none in them.
    entries = _split(line.removesuffix(",")[1:-1]) if language == "python" else line.removesuffix(";").split()
    return tuple(read_plain(entry, ARRAYS, side_by_side=False) for entry in entries if entry.strip())


def _split(text: str) -> list[str]:
    """What stands between commas outside of parentheses."""
    found, depth = [""], 0
    for c in text:
        depth += (c == "(") - (c == ")")
        if c == "," and depth == 0:
            found.append("")
        else:
            found[-1] += c
    return found
