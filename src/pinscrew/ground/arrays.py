"""Arrays that a caller gives."""

from __future__ import annotations

import numpy as np

from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray

__all__ = ["numbers"]


def numbers(value: ArrayLike, name: str, where: str = "", remedy: str = "") -> FloatArray:
    """What was given as an array of float64; the same array if it is one.

    Args:
        value: numbers, in whatever numpy takes for an array.
        name: what it is called, for the error.
        where: the place for the error, or ``""``.
        remedy: what would be right.

    Raises:
        InputError: if it is no array, holds what is no real number, or an integer beyond what a float64 can be.
    """
    try:
        complex_ = np.iscomplexobj(value)  # numpy would drop imaginary parts with a mere warning
        array = np.asarray(value, dtype=None if complex_ else np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        what = f"{name} is no array of numbers ({error})"
        raise InputError("not-numbers", what, where=where, remedy=remedy) from None
    if complex_:
        raise InputError("not-numbers", f"{name} is complex", where=where, remedy="expected real numbers")
    return array
