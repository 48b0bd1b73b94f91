"""Rates at some times, and a rule for the times between."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, TypeAlias, get_args

import numpy as np

from pinscrew.ground.arrays import numbers
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.motion.rates import Rates

__all__ = ["Between", "Samples", "check_between"]

Between: TypeAlias = Literal["linear", "hold"]
"""What the rates are between their times: on the line from one to the next, or as at the time before."""


class Samples(Rates):
    """Rates at some times; `Profile.table` makes a profile of them."""

    def __init__(self, names: Sequence[str], t: ArrayLike, rates: ArrayLike, between: Between, source: str) -> None:
        """See `Profile.table`."""
        check_between(between)
        times, values = numbers(t, "t", source).copy(), numbers(rates, "the table of rates", source).copy()
        if times.ndim != 1 or len(times) < 2 or values.shape != (len(times), len(names)):
            what = f"t has shape {times.shape} and rates have {values.shape}"
            remedy = f"expected (N,) and (N, {len(names)}), N at least 2, for {', '.join(names)}"
            raise InputError("shape", what, where=source, remedy=remedy)
        if len(set(names)) < len(names):
            raise InputError("duplicate-name", f"a name is twice in {', '.join(names)}", where=source)
        if not (np.isfinite(times).all() and np.isfinite(values).all()):
            raise InputError("not-finite", "the table holds NaN or infinity", where=source)
        if not (np.diff(times) > 0.0).all():
            row = int(np.argmin(np.diff(times) > 0.0))
            what = f"t = {times[row + 1]:g} s comes after {times[row]:g} s"
            raise InputError("profile-table", what, where=source, remedy="times must increase from row to row")
        super().__init__(names, float(times[0]), float(times[-1]), source)
        self._times = times
        self._values = values
        self._between = between

    def at(self, times: FloatArray) -> FloatArray:
        if self._between == "hold":
            return np.asarray(self._values[np.searchsorted(self._times, times, side="right") - 1])
        columns = [np.interp(times, self._times, column) for column in self._values.T]
        return np.stack(columns, axis=-1) if columns else np.empty((len(times), 0))


def check_between(between: str) -> None:
    """Refuse a rule that does not exist.

    Raises:
        InputError: if it is neither ``"linear"`` nor ``"hold"``.
    """
    if between not in get_args(Between):
        raise InputError("profile-table", f"between={between!r}", remedy="use 'linear' or 'hold'")
