"""Rates in pieces: intervals of time, each with an expression of t."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
import numpy.typing as npt

from pinscrew.ground import expressions
from pinscrew.ground.errors import DescriptionError, InputError
from pinscrew.ground.expressions import Expression, Unit
from pinscrew.ground.typing import FloatArray
from pinscrew.motion.rates import Rates

__all__ = ["Piece", "Pieces", "Spot"]

_INTERVAL: Final = re.compile(r"([^<≤]+)(<=|≤|<)\s*t\s*(<=|≤|<)([^<≤]+)")


@dataclass(frozen=True, slots=True)
class Spot:
    """Where something was written, for messages: the source, a line of it, and what stands there."""

    source: str
    line: int | None = None
    element: str = ""

    def error(self, code: str, what: str, remedy: str = "") -> DescriptionError:
        """An error about it."""
        return DescriptionError(code, what, file=self.source, line=self.line, element=self.element, remedy=remedy)


@dataclass(frozen=True, slots=True)
class Piece:
    """An interval from ``begin`` to ``end`` (s), either of which may belong to it, and the rate there."""

    begin: float
    end: float
    has_begin: bool
    has_end: bool
    rate: Expression
    place: Spot

    @classmethod
    def of(cls, when: str, rate: str | float, place: Spot) -> Piece:
        """The piece that ``0 <= t < 1`` and an expression of t describe.

        Raises:
            DescriptionError: if they are no interval and no expression.
        """
        found = _INTERVAL.fullmatch(str(when).strip())
        if found is None:
            raise place.error("profile-interval", f"{when!r} is no interval", "write such as 0 <= t < 1")
        try:
            begin, end = expressions.number(found[1]), expressions.number(found[4])
        except InputError as error:
            raise place.error("profile-interval", f"{when!r} is no interval ({error.what})") from None
        if not begin < end:
            raise place.error("profile-interval", f"{when!r} is empty", "the later time comes last")
        return cls(begin, end, found[2] != "<", found[3] != "<", expression(rate, place), place)

    def covers(self, t: FloatArray) -> npt.NDArray[np.bool_]:
        """Which times belong to it."""
        late = t >= self.begin if self.has_begin else t > self.begin
        early = t <= self.end if self.has_end else t < self.end
        return np.asarray(late & early)

    def follows(self, before: Piece) -> None:
        """Refuse a piece that does not begin where the one before ends."""
        here = f"{before.end:g} s, where the piece before ends"
        if self.begin != before.end:
            what = f"begins at {self.begin:g} s, not at {here}"
            kind = "leaves a gap" if self.begin > before.end else "overlaps or is out of order"
            raise self.place.error("profile-interval", f"{kind}: it {what}", "let each piece begin where one ends")
        if self.has_begin == before.has_end:
            what = "both have" if self.has_begin else "neither has"
            remedy = "write <= in one of them and < in the other"
            raise self.place.error("profile-interval", f"{what} t = {here}", remedy)


class Pieces(Rates):
    """Rates in pieces; `Profile.pieces` makes a profile of them."""

    def __init__(self, rates: Mapping[str, Sequence[Piece] | Expression], source: str) -> None:
        """Take the pieces of each velocity, or one expression for all times, and check that they fit together."""
        lists = {name: pieces for name, pieces in rates.items() if not isinstance(pieces, Expression)}
        if not lists:
            what = "no velocity has pieces, so it is not said for how long"
            remedy = "write at least one as pieces, such as 0 <= t <= 1; they may be longer than what is asked for"
            raise Spot(source).error("profile-interval", what, remedy)
        for name, pieces in lists.items():
            _check(name, pieces, source)
        (first, reference), *others = lists.items()
        start, end = reference[0].begin, reference[-1].end
        for name, pieces in others:
            if (pieces[0].begin, pieces[-1].end) != (start, end):
                what = f"goes from {pieces[0].begin:g} to {pieces[-1].end:g} s, but {first} from {start:g} to {end:g} s"
                raise Spot(source, pieces[0].place.line, name).error("profile-interval", what, "let all do the same")
        units = [_unit(name, pieces, source) for name, pieces in rates.items()]
        super().__init__(tuple(rates), start, end, source, units)
        self._pieces = rates

    @classmethod
    def of(cls, rates: Mapping[str, str | float | Iterable[tuple[str, str | float]]], source: str) -> Pieces:
        """See `Profile.pieces`."""
        return cls({name: _read(name, given, source) for name, given in rates.items()}, source)

    def at(self, times: FloatArray) -> FloatArray:
        out = np.empty((len(times), len(self.names)))
        with np.errstate(all="ignore"):  # what is not finite is refused by the caller
            for column, pieces in enumerate(self._pieces.values()):
                if isinstance(pieces, Expression):
                    out[:, column] = pieces.value({"t": times})
                    continue
                for piece in pieces:
                    here = piece.covers(times)
                    out[here, column] = piece.rate.value({"t": times[here]})
        return out


def expression(rate: str | float, place: Spot) -> Expression:
    """The expression of t that a text or a number stands for.

    Raises:
        DescriptionError: if it is none.
    """
    try:
        found = Expression.parse(str(rate), ("t",))
        found.value({"t": np.zeros(1)})
    except InputError as error:
        raise place.error(error.code, error.what, error.remedy) from None
    except ArithmeticError as error:
        raise place.error("expression", f"{rate!r} has no value ({error})") from None
    return found


def _read(name: str, given: str | float | Iterable[tuple[str, str | float]], source: str) -> list[Piece] | Expression:
    if not isinstance(given, Iterable) or isinstance(given, str):
        return expression(given, Spot(source, element=name))
    found = []
    for i, piece in enumerate(given, 1):
        place = Spot(source, element=f"{name}, piece {i}")
        try:
            when, rate = piece
        except (TypeError, ValueError):
            remedy = 'write such as ("0 <= t <= 1", "0.1*t")'
            raise place.error("profile-format", "is no pair of an interval and a rate", remedy) from None
        found.append(Piece.of(when, rate, place))
    return found


def _unit(name: str, pieces: Sequence[Piece] | Expression, source: str) -> Unit:
    """What the pieces of a velocity are of, per second."""
    if isinstance(pieces, Expression):
        return pieces.unit
    written = {piece.rate.unit: piece for piece in pieces if piece.rate.unit}
    if len(written) > 1:
        raise Spot(source, element=name).error("unit", "some pieces are angles and others lengths", "use one unit")
    return next(iter(written), "")


def _check(name: str, pieces: Sequence[Piece], source: str) -> None:
    """Refuse pieces that are none, do not follow each other, or lack the first or last time."""
    if not pieces:
        raise Spot(source, element=name).error("profile-interval", "has no pieces", "write such as 0 <= t <= 1")
    for before, piece in pairwise(pieces):
        piece.follows(before)
    if not pieces[0].has_begin:
        raise pieces[0].place.error("profile-interval", f"lacks its own begin, {pieces[0].begin:g} s", "write <=")
    if not pieces[-1].has_end:
        raise pieces[-1].place.error("profile-interval", f"lacks its own end, {pieces[-1].end:g} s", "write <=")
