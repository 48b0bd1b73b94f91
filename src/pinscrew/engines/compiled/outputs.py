"""What a batch call may be given beside its question: arrays to write to, and a number of threads."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pinscrew.ground.errors import InputError
from pinscrew.ground.memory import free_bytes
from pinscrew.ground.processes import cores

__all__ = ["Results", "outputs", "thread_count"]

Results: TypeAlias = NDArray[np.floating[Any]]

SMALL: Final = 2**28
"""Bytes of results that are allocated without asking whether they are free."""


def outputs(
    given: Sequence[Results | None], shapes: Sequence[tuple[int, ...]], q: NDArray[Any], robot: str
) -> list[Results]:
    """The arrays to write results to: those given, checked, or new ones of the type of the coordinates.

    Args:
        given: arrays, or None for each.
        shapes: what they must have.
        q: the coordinates.
        robot: its name, for errors.

    Raises:
        InputError: if arrays given are not fit to write to, or new ones need more memory than is free.
    """
    if len(given) != len(shapes):
        raise InputError("out", f"out has {len(given)} arrays", where=robot, remedy=f"give {len(shapes)}")
    if all(array is None for array in given):
        needed = sum(int(np.prod(shape)) for shape in shapes) * q.dtype.itemsize
        if needed > SMALL and needed > (free := free_bytes()):
            count = math.prod(q.shape[:-1])
            what = f"{count} configurations give {needed / 1e9:.3g} GB of results, but {free / 1e9:.3g} GB are free"
            remedy = "ask for blocks of them, with out= to use the same memory again, or use reduce"
            raise InputError("memory", what, where=robot, remedy=remedy)
        return [np.empty(shape, q.dtype) for shape in shapes]
    kind = np.float32 if getattr(given[0], "dtype", None) == np.float32 else np.float64
    found = [_checked(array, shape, kind, robot) for array, shape in zip(given, shapes, strict=True)]
    if any(np.may_share_memory(*pair) for pair in combinations([q, *found], 2)):
        raise InputError("out", "out overlaps q or itself", where=robot, remedy="give arrays of their own")
    return found


def _checked(array: Results | None, shape: tuple[int, ...], kind: type, robot: str) -> Results:
    if isinstance(array, np.ndarray) and array.shape == shape and array.dtype == kind:
        if array.flags.carray:  # C-contiguous, aligned and writeable
            return array
        found = "an array that is read-only or not contiguous"
    else:
        found = f"shape {array.shape} of {array.dtype}" if isinstance(array, np.ndarray) else type(array).__name__
    remedy = f"give a writeable, C-contiguous array of float64, or all of float32, here of shape {shape}"
    raise InputError("out", f"out has {found}", where=robot, remedy=remedy)


def thread_count(threads: int | None) -> int:
    """A number of threads, checked; by default the cores that the process may use.

    Raises:
        InputError: if it is no whole number, below 1 or more than there are.
    """
    most = cores()
    if threads is None:
        return most
    if threads not in range(1, most + 1):
        raise InputError("threads", f"threads={threads!r}", remedy=f"give 1 to {most}, the cores of this machine")
    return int(threads)
