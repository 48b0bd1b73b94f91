"""What any matrix of a kind has, whatever the robot: RᵀR = I, a last row, a lower block of zeros."""

from __future__ import annotations

import re
from collections.abc import Iterator

from pinscrew.derivation.chain import Elements

__all__ = ["structure"]


def structure(key: str, given: Elements) -> tuple[str, ...]:
    """In words, what keeps a matrix from being one of its kind.

    Args:
        key: the quantity.
        given: the answer, as elements.
    """
    return tuple(_faults(key, given))


def _faults(key: str, given: Elements) -> Iterator[str]:
    if re.fullmatch(r"M|T|Tinv|(?:exp|prod|tail)\d+|inv\(.*\)", key):
        yield from _last_row(given, last=1)
        yield from _rotation(given[:3, :3])
    elif re.fullmatch(r"R|R\(.*\)", key) and not key.startswith("R(dot"):
        yield from _rotation(given)
    elif given.shape == (4, 4) and re.fullmatch(r"V[sb]hat|hat\(.*\)", key):
        yield from _last_row(given, last=0)
        yield from _skew(given[:3, :3])
    elif given.shape == (3, 3) and re.fullmatch(r"phat|hat\(.*\)", key):
        yield from _skew(given)
    elif key == "Tdot":
        yield from _last_row(given, last=0)
    elif given.shape == (6, 6) and key.startswith("Ad"):
        if given[3:, :3].any():
            yield "it is no adjoint: its lower left block is not 0"
        elif (given[:3, :3] - given[3:, 3:]).any():
            yield "it is no adjoint: its blocks on the diagonal differ"


def _last_row(given: Elements, last: int) -> Iterator[str]:
    one = given[3, 3].algebra.constant(last)
    if given[3, :3].any() or given[3, 3] - one:
        yield f"its last row is not 0 0 0 {last}"


def _rotation(R: Elements) -> Iterator[str]:
    one = R[0, 0].algebra.constant(1)
    product = R.T @ R
    for i in range(3):
        product[i, i] = product[i, i] - one
    if product.any():
        yield "its rotation is none: RᵀR is not I"
        return
    a, b, c = R
    determinant = sum((a[i] * (b[j] * c[k] - b[k] * c[j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))), one - one)
    if determinant - one:
        yield "its rotation is none: its determinant is -1, the axes are left-handed"


def _skew(block: Elements) -> Iterator[str]:
    if (block + block.T).any():
        yield "the matrix of a vector is skew: each entry is minus the one across the diagonal"
