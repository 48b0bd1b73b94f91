"""Velocity profiles: the rates of a robot as functions of time, in pieces or as a table."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from pinscrew.ground.arrays import numbers
from pinscrew.ground.errors import InputError, UnknownNameError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.motion import profile_files
from pinscrew.motion.pieces import Pieces
from pinscrew.motion.rates import Rates
from pinscrew.motion.samples import Between, Samples
from pinscrew.robot.robot import Robot

__all__ = ["Profile"]


class Profile:
    """Rates of named velocities from a first time to a last. Call it with times (...) to get rates (..., n).

    Make one with `read`, `pieces` or `table`.

    Attributes:
        names: the n velocities, as in `Robot.velocity_names`; their order is the file's.
        start: the first time (s).
        end: the last time (s); both belong to it.
        source: where it came from, for messages.
    """

    def __init__(self, rates: Rates) -> None:
        self.names = rates.names
        self.start = rates.start
        self.end = rates.end
        self.source = rates.source
        self._rates = rates

    def __repr__(self) -> str:
        return f"<Profile {self.source!r}: {', '.join(self.names)}, {self.start:g} to {self.end:g} s>"

    @staticmethod
    def read(file: str | Path, between: Between = "linear") -> Profile:
        """The profile in a file: pieces in YAML (``.yaml``, ``.yml``) or a table in CSV (``.csv``).

        Args:
            file: its path; docs/motion.md shows both formats.
            between: what a table's rates are between its rows.

        Raises:
            DescriptionError: if the file can't be read or is no profile.
            InputError: if its suffix is none of these, or ``between`` is neither.
        """
        return Profile(profile_files.read(Path(file), between))

    @staticmethod
    def pieces(
        rates: Mapping[str, str | float | Iterable[tuple[str, str | float]]], source: str = "profile"
    ) -> Profile:
        """A profile in pieces.

        Args:
            rates: for each velocity its pieces ``("0 <= t <= 1", "0.1*t")``, which follow each other without gap or
                overlap; or one expression for all times.
            source: a name for messages.

        Raises:
            DescriptionError: if an interval or an expression is none, pieces leave a gap or overlap, or the velocities
                begin or end at different times.
        """
        return Profile(Pieces.of(rates, source))

    @staticmethod
    def table(
        names: Sequence[str], t: ArrayLike, rates: ArrayLike, between: Between = "linear", source: str = "table"
    ) -> Profile:
        """A profile of samples.

        Args:
            names: the n velocities.
            t: times, shape (N,), N ≥ 2, increasing.
            rates: shape (N, n), rad/s and m/s.
            between: what the rates are between the times.
            source: a name for messages.

        Raises:
            InputError: if the shapes don't match, times don't increase, a number is not finite, or ``between`` is
                neither.
        """
        return Profile(Samples(names, t, rates, between, source))

    def __call__(self, t: ArrayLike) -> FloatArray:
        """The rates at times ``t``, shape (...): shape (..., n), rad/s and m/s.

        Raises:
            InputError: if a time is outside the profile, or a rate not finite there.
        """
        times = numbers(t, "t", self.source)
        outside = ~((times >= self.start) & (times <= self.end))
        if outside.any():
            what = f"there are no rates at t = {times[outside].flat[0]:g} s"
            remedy = f"the profile is from {self.start:g} to {self.end:g} s"
            raise InputError("profile-range", what, where=self.source, remedy=remedy)
        rates = self._rates.at(times.ravel())
        if not np.isfinite(rates).all():
            row, column = np.argwhere(~np.isfinite(rates))[0]
            what = f"the rate of {self.names[column]} is not finite at t = {times.flat[row]:g} s"
            raise InputError("not-finite", what, where=self.source, remedy="correct its expression")
        return rates.reshape(*times.shape, len(self.names))

    def columns(self, robot: Robot) -> npt.NDArray[np.intp]:
        """Which of the rates belongs to each entry of a robot's ``qd``, shape (nv,).

        Raises:
            UnknownNameError: if a name is none of the robot's velocities.
            InputError: if a velocity of the robot is missing, or written as an angle where it is a length
                (``10deg`` for a slide), or the other way round.
        """
        known = robot.velocity_names
        for name in self.names:
            if name not in known:
                where = f"{self.source}, for {robot.name}"
                raise UnknownNameError("unknown-velocity", "velocity", name, known, where=where)
        units = dict(zip(known, robot.velocity_units, strict=True))
        for name, unit in zip(self.names, self._rates.units, strict=True):
            if unit not in ("", units[name]):
                what = f"the rate of {name!r} is written in {unit}/s, but {robot.name} has it in {units[name]}/s"
                raise InputError("unit", what, where=self.source, remedy=f"write it in {units[name]}, or plainly")
        missing = [name for name in known if name not in self.names]
        if missing:
            what = f"there are no rates of {', '.join(missing)}, which {robot.name} has"
            raise InputError("missing-rates", what, where=self.source, remedy="give them, if only as 0")
        return np.array([self.names.index(name) for name in known], dtype=np.intp)
