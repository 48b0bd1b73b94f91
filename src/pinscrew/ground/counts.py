"""Whole numbers that a caller gives: how many of something, or a seed."""

from __future__ import annotations

import math
from numbers import Real

from pinscrew.ground.errors import InputError

__all__ = ["whole"]


def whole(name: str, value: float, least: int, *, where: str = "") -> int:
    """The number as an integer; 1e7 is a whole number too.

    Args:
        name: what it is called, such as ``"samples"``; also the code of the error.
        value: what was given.
        least: the smallest that will do.
        where: the place for the error, or ``""``.

    Raises:
        InputError: if it is no whole number, or smaller.
    """
    if not (isinstance(value, Real) and least <= value < math.inf and value == int(value)):
        raise InputError(name, f"{name}={value!r}", where=where, remedy=f"give a whole number, {least} or more")
    return int(value)
