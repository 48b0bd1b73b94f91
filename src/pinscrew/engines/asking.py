"""A question that is bound to an engine, a frame and a kind: checked once, asked one configuration at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, TypeAlias

import numpy as np

from pinscrew.engines.answers import Bound
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.robot.robot import Robot

__all__ = ["Answer", "long_way", "written"]

Answer: TypeAlias = tuple[FloatArray, FloatArray]
"""A pose (4, 4) and a Jacobian (6, nv)."""
_DOUBLE: Final = np.dtype(np.float64)


def long_way(robot: Robot, answer: Callable[[ArrayLike], Answer]) -> Bound:
    """A bound question about whatever may be given for q, which is checked each time."""

    def ask(q: ArrayLike, *, out: Answer | None = None) -> Answer:
        if (shape := np.shape(q)) and len(shape) != 1:
            remedy = f"a bound question takes one configuration, of shape ({robot.nq},)"
            raise InputError("shape", f"q has shape {shape}", where=robot.name, remedy=remedy)
        found = answer(q)
        return found if out is None else written(found, out)

    return ask


def written(answer: Answer, out: Answer) -> Answer:
    """``out``, with the answer in it.

    Raises:
        InputError: if it is not two float64 arrays of the answer's shapes that can be written to.
    """
    shapes = [part.shape for part in answer]
    arrays: Sequence[FloatArray] = out
    fit = len(arrays) == 2 and all(
        (getattr(array, "shape", None), getattr(array, "dtype", None)) == (shape, _DOUBLE) and array.flags.writeable
        for array, shape in zip(arrays, shapes, strict=True)
    )
    if not fit:
        remedy = f"give two writeable arrays of float64, of shapes {shapes[0]} and {shapes[1]}"
        raise InputError("out", "out is not fit to write to", remedy=remedy)
    for array, part in zip(out, answer, strict=True):
        array[...] = part
    return out
