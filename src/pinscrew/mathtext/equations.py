r"""Equations with matrices in them: what stands between the equals signs, taken apart as far as a page shows it.

A side is a row of pieces: matrices, whose cells are texts, and what stands between them. What these mean is not known
here: ``J^{b} = \begin{bmatrix} c_1 & 0 \end{bmatrix}`` has the sides ``("J^{b}",)`` and ``(Grid,)``.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final, TypeAlias

from pinscrew.ground.errors import InputError
from pinscrew.mathtext.tokens import LONGEST

__all__ = ["Equation", "Grid", "Side", "read_equations"]


@dataclass(frozen=True, slots=True)
class Grid:
    """The cells of a matrix as texts, by rows, all as long."""

    cells: tuple[tuple[str, ...], ...]


Side: TypeAlias = tuple[str | Grid, ...]
Equation: TypeAlias = tuple[Side, ...]

_GRID: Final = re.compile(r"\\begin\{([bpvBV]?matrix|smallmatrix)\}((?:(?!\\begin).)*?)\\end\{\1\}", re.DOTALL)
_ALIGNED: Final = re.compile(r"\\begin\{aligned\}|\\end\{aligned\}|&|\\\\")
_BETWEEN: Final = re.compile(r",\s*\\q?quad\b")
_MARK: Final = re.compile("\ue000(\\d+)\ue001")


def read_equations(text: str) -> tuple[Equation, ...]:
    """The equations of a formula: those between commas with a wide space, each as its sides.

    Raises:
        InputError: the text is too long, or the rows of a matrix differ in length, or one has no end.
    """
    if len(text) > LONGEST or "\ue000" in text:
        raise InputError("formula", f"the text is longer than {LONGEST} characters, or has characters for private use")
    grids: list[Grid] = []

    def mark(match: re.Match[str]) -> str:
        rows = [tuple(cell.strip() for cell in row.split("&")) for row in match[2].strip().split(r"\\")]
        if len(rows) > 1 and rows[-1] == ("",):
            del rows[-1]
        if len({len(row) for row in rows}) != 1:
            raise InputError("formula", "the rows of a matrix differ in length", where=match[0][:60])
        grids.append(Grid(tuple(rows)))
        return f"\ue000{len(grids) - 1}\ue001"

    marked = _GRID.sub(mark, text)
    if "matrix}" in marked:
        raise InputError("formula", "a matrix has no end, or another one in it", where=marked[:60])
    plain = _ALIGNED.sub(" ", marked)
    return tuple(tuple(_pieces(side, grids) for side in equation.split("=")) for equation in _BETWEEN.split(plain))


def _pieces(side: str, grids: list[Grid]) -> Side:
    parts = _MARK.split(side)  # texts and numbers of grids take turns
    pieces = (grids[int(part)] if i % 2 else part.strip() for i, part in enumerate(parts))
    return tuple(piece for piece in pieces if piece != "")
