r"""Matrices of named blocks, ``\begin{bmatrix} R & p \\ 0 & 1 \end{bmatrix}``, put together from those before."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

from pinscrew.checking.texts import Written

__all__ = ["put_together"]

_BLOCK: Final = re.compile(r"(-?)\s*(.+?)\s*(\^\s*\{?\s*(?:T|\\top|\\intercal)\s*\}?|\.T|')?")
_ZERO: Final = {"0", r"\mathbf{0}", r"\boldsymbol{0}", "O"}
_IDENTITY: Final = {"1", "I"}


def put_together(matrix: Written, named: Mapping[str, Written]) -> Written:
    """The matrix with its blocks written out; itself where none of its cells is a matrix.

    Zeros and identities take the size that is left for them. Blocks that do not fit leave it as it is.

    Args:
        matrix: a matrix.
        named: the matrices before it, by name.
    """
    blocks = [[_block(cell, named, matrix.language) for cell in row] for row in matrix.rows]
    known = [block for row in blocks for block in row if block is not None]
    if not known or matrix.factor:
        return matrix
    heights = [{len(block) for block in row if block is not None} or {1} for row in blocks]
    widths = [{len(block[0]) for block in column if block is not None} or {1} for column in zip(*blocks, strict=True)]
    if any(len(sizes) > 1 for sizes in (*heights, *widths)):
        return matrix
    rows: list[tuple[str, ...]] = []
    for cells, row, (height,) in zip(matrix.rows, blocks, heights, strict=True):
        parts = []
        for cell, block, (width,) in zip(cells, row, widths, strict=True):
            filled = block or _filled(cell, height, width)
            if filled is None:
                return matrix
            parts.append(filled)
        rows += [tuple(text for part in parts for text in part[i]) for i in range(height)]
    return Written(tuple(rows), matrix.language)


def _block(cell: str, named: Mapping[str, Written], language: str) -> list[list[str]] | None:
    found = _BLOCK.fullmatch(cell)
    block = named.get(found[2]) if found else None
    if found is None or block is None or block.factor or block.language != language:
        return None
    if len(block.rows) == len(block.rows[0]) == 1:
        return None
    rows = [list(row) for row in block.rows]
    rows = [list(column) for column in zip(*rows, strict=True)] if found[3] else rows
    return [[f"-({text})" for text in row] for row in rows] if found[1] else rows


def _filled(cell: str, height: int, width: int) -> list[list[str]] | None:
    """A block of zeros, an identity, or one entry."""
    if cell in _ZERO or re.fullmatch(r"0_\{?\d.*|\\mathbf\{0\}.*", cell):
        return [["0"] * width for _ in range(height)]
    if (cell in _IDENTITY or re.fullmatch(r"I_\{?\d.*", cell)) and height == width:
        return [["1" if i == j else "0" for j in range(width)] for i in range(height)]
    return [[cell]] if height == width == 1 else None
