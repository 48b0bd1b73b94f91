"""Rates of named velocities as functions of time: what every kind of profile is made of."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence

from pinscrew.ground.expressions import Unit
from pinscrew.ground.typing import FloatArray

__all__ = ["Rates"]


class Rates(ABC):
    """Rates of named velocities from a first time to a last.

    Attributes:
        names: the n velocities, as in `Robot.velocity_names`; their order is the file's.
        start: the first time (s).
        end: the last time (s); both belong to it.
        source: where it came from, for messages.
        units: of each, per second, what was written: ``"rad"``, ``"m"``, or ``""`` where nothing was, and either fits.
    """

    def __init__(
        self, names: Sequence[str], start: float, end: float, source: str, units: Sequence[Unit] | None = None
    ) -> None:
        self.names = tuple(names)
        no_units: tuple[Unit, ...] = ("",)
        self.units: tuple[Unit, ...] = no_units * len(self.names) if units is None else tuple(units)
        self.start = start
        self.end = end
        self.source = source

    @abstractmethod
    def at(self, times: FloatArray) -> FloatArray:
        """The rates (N, n), rad/s and m/s, at times (N,) that are not outside; NaN or infinity where they have none."""
