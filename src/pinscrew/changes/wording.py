"""What was measured, in words: lengths in millimetres, angles in degrees, named axes, as an engineer says them.

Each difference becomes one sentence: a subject, such as ``joint 'elbow'``, and what is said of it (`_predicate`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import singledispatch
from typing import Final

import numpy as np

from pinscrew.changes.differences import (
    AxisMoved,
    CarriedMoved,
    Difference,
    FrameChosen,
    FrameMoved,
    LimitsChanged,
    MimicChanged,
    OneSided,
    RateChanged,
    Rehung,
    Renamed,
    Reordered,
    TipsApart,
    TypeChanged,
    ZeroShifted,
)
from pinscrew.changes.geometry import Move
from pinscrew.changes.outcome import Change, Tolerance
from pinscrew.ground.typing import FloatArray

__all__ = ["degrees", "millimetres", "number", "worded"]

DIGITS: Final = 6
"""Digits of a number that stands for itself."""
MOST_DIGITS: Final = 17
"""Digits that tell any two doubles apart."""
ALONG: Final = 1e-6
"""Largest other component of a unit vector that still is called x, y or z."""


def worded(difference: Difference, tolerance: Tolerance) -> Change:
    """A difference with its sentence, at the line of its joint in b's file."""
    subject, predicate = _subject(difference), _predicate(difference, tolerance)
    words = f"{subject}: {predicate}" if subject else predicate
    length, angle = difference.size
    pair = difference.pair
    if pair is None:
        return Change(difference.kind, "", difference.link, words, length, angle)
    line, file = (pair.b.line, pair.b.file) if pair.b else (None, "")
    tip = isinstance(difference, (OneSided, Renamed)) and difference.tip
    return Change(difference.kind, pair.named.name, difference.link, words, length, angle, line, file, tip)


def _subject(difference: Difference) -> str:
    """What a sentence is about; ``""`` where the sentence names it itself."""
    pair = difference.pair
    if pair is None or isinstance(difference, OneSided) or difference.kind == "link-renamed":
        return ""
    if difference.kind == "frame-re-expressed":
        return f"link {pair.link_b!r}"
    carries = isinstance(difference, CarriedMoved) and not difference.alone
    fixed = "fixed " if carries and pair.a is not None and pair.a.type == "fixed" else ""
    return f"{fixed}joint {pair.named.name!r}"


# --------------------------------------------------------------------------------------------- predicates


@singledispatch
def _predicate(difference: Difference, tolerance: Tolerance) -> str:
    """What is said of a difference."""
    raise TypeError(f"there are no words for {difference} to {tolerance}")


@_predicate.register
def _one_sided(difference: OneSided, tolerance: Tolerance) -> str:
    joint = difference.joint
    word = "removed" if difference.kind.endswith("removed") else "added"
    words = f"joint {joint.name!r} ({joint.type}) is {word} between links {joint.parent!r} and {joint.child!r}"
    if difference.kind == "tip-removed":
        return f"{words}: a tip frame is gone"
    if difference.kind.startswith("frame-"):
        return f"{words}; the motion is the same"
    return words + _what_follows(difference.carried, tolerance)


@_predicate.register
def _type(difference: TypeChanged, tolerance: Tolerance) -> str:
    words = f"it is {difference.new} instead of {difference.old}"
    if {difference.new, difference.old} == {"revolute", "continuous"}:
        return f"{words}, {'with' if difference.new == 'revolute' else 'without'} limits"
    return words + _what_follows(difference.carried, tolerance)


def _what_follows(carried: Move | None, tolerance: Tolerance) -> str:
    if carried is None:
        return ""
    return f"; what follows is {_moved(carried, tolerance)}, in the frame of {carried.frame!r}"


@_predicate.register
def _axis(difference: AxisMoved, tolerance: Tolerance) -> str:
    move, follows = difference.move, "what follows stays"
    if difference.rigid:
        follows = "what follows goes along"
    elif difference.follows is not None:
        follows = f"what follows is {_moved(difference.follows, tolerance)}"
    parts = ["reversed: its coordinate has the other sign"] * (difference.kind == "axis-reversed")
    if not parts or not move.within(tolerance):
        parts.append(f"{_moved(move, tolerance)}, in the frame of {move.frame!r}")
    return f"its axis is {', and '.join(parts)}; {follows}"


@_predicate.register
def _frame(difference: FrameMoved, tolerance: Tolerance) -> str:
    move, follows = difference.move, "goes along" if difference.along else "stays"
    how = f"{_moved(move, tolerance)}, in the frame of {move.frame!r}"
    return f"the frame that it moves in is {how}; what follows {follows}"


@_predicate.register
def _zero(difference: ZeroShifted, _tolerance: Tolerance) -> str:
    if difference.joint.type == "prismatic":
        return f"its zero is shifted by {millimetres(difference.value)} along its axis"
    return f"its zero is shifted by {degrees(difference.value)} about its axis"


@_predicate.register
def _carried(difference: CarriedMoved, tolerance: Tolerance) -> str:
    move, link = difference.move, difference.link
    if difference.alone:
        return f"tip frame {link!r} is {_moved(move, tolerance)}, in its own frame; what follows stays"
    subject = f"tip frame {link!r}" if difference.kind == "tip-moved" else f"link {link!r}, with what follows,"
    beyond = ", which displaces what is farther out by more than the tolerance" if move.within(tolerance) else ""
    stays = "" if difference.joint.type == "fixed" else "; its axis stays"
    return f"{subject} is {_moved(move, tolerance)}, in the frame of {move.frame!r}{beyond}{stays}"


@_predicate.register
def _chosen(difference: FrameChosen, tolerance: Tolerance) -> str:
    if difference.kind == "frame-re-expressed":
        return f"its frame is {_moved(difference.move, tolerance)}, in its own frame; the motion is the same"
    where = ", which its motion does not depend on" if difference.joint.type == "prismatic" else " along its axis"
    return f"its origin is slid by {millimetres(difference.move.length)}{where}; the motion is the same"


@_predicate.register
def _rehung(difference: Rehung, tolerance: Tolerance) -> str:
    where = "it stands where it stood"
    if difference.at_zero is not None:
        where = _predicate(difference.at_zero, tolerance)
    return f"it hangs from link {difference.new!r} instead of {difference.old!r}; at zero, {where}"


@_predicate.register
def _limits(difference: LimitsChanged, _tolerance: Tolerance) -> str:
    (lower, upper), (new_lower, new_upper) = difference.old, difference.new
    word = "changed"
    if new_lower <= lower and upper <= new_upper:
        word = "widened"
    elif lower <= new_lower and new_upper <= upper:
        word = "narrowed"
    sliding = difference.joint.type == "prismatic"
    written = _thousandths if sliding else degrees
    ends = told_apart(lower, new_lower, written), told_apart(upper, new_upper, written)
    unit = " mm" if sliding else ""
    old, new = (f"[{low}, {high}]{unit}" for low, high in zip(*ends, strict=True))
    turned_round = ", as its direction is reversed" if difference.turned_round else ""
    return f"its limits are {word} from {old} to {new}{turned_round}"


@_predicate.register
def _rate(difference: RateChanged, _tolerance: Tolerance) -> str:
    old, new = told_apart(difference.old, difference.new)
    return f"its limit of {difference.kind} is {new} instead of {old}"


@_predicate.register
def _mimic(difference: MimicChanged, _tolerance: Tolerance) -> str:
    old, new = difference.old, difference.new
    if old is None or new is None:
        now = f"follows {new.joint!r}" if new else "has a coordinate of its own"
        before = f"following {old.joint!r}" if old else "having a coordinate of its own"
        return f"it {now} instead of {before}"
    factors = told_apart(old.multiplier, new.multiplier)
    offsets = told_apart(old.offset, new.offset, millimetres if difference.joint.type == "prismatic" else degrees)
    laws = [
        f"{factor} × {mimic.joint!r}{f' + {offset}' * bool(mimic.offset)}"
        for mimic, factor, offset in zip((old, new), factors, offsets, strict=True)
    ]
    kept = "; the motion is the same" if difference.kept else ""
    return f"its mimic goes from {laws[0]} to {laws[1]}{kept}"


@_predicate.register
def _renamed(difference: Renamed, _tolerance: Tolerance) -> str:
    old, new = difference.old, difference.new
    if difference.kind == "robot-renamed":
        return f"the robot is called {new!r} instead of {old!r}"
    if difference.kind == "link-renamed":
        return f"{'the base ' * (difference.pair is None)}link {new!r} was called {old!r}"
    swapped = ", and that name or its own is now another joint's" if difference.kind == "names-swapped" else ""
    return f"it was called {old!r}{swapped}"


@_predicate.register
def _reordered(difference: Reordered, _tolerance: Tolerance) -> str:
    return f"the coordinates of {', '.join(map(repr, difference.joints))} have other places in q"


@_predicate.register
def _apart(difference: TipsApart, _tolerance: Tolerance) -> str:
    far = difference.displacement
    size = degrees(far.angle) if difference.turned else millimetres(far.length)
    beyond = "though no joint on its own is beyond the tolerance"
    return f"tip frame {difference.link!r} is displaced by up to {size}, {beyond}"


# ------------------------------------------------------------------------------------------------ numbers


def number(value: float, digits: int = DIGITS) -> str:
    """A number to some digits."""
    return f"{value + 0.0:.{digits}g}"


def millimetres(length: float, digits: int = DIGITS) -> str:
    """A length (m) in millimetres."""
    return f"{_thousandths(length, digits)} mm"


def _thousandths(value: float, digits: int) -> str:
    return number(value * 1e3, digits)


def degrees(angle: float, digits: int = DIGITS) -> str:
    """An angle (rad) in degrees."""
    return f"{number(math.degrees(angle), digits)}°"


def told_apart(old: float, new: float, written: Callable[[float, int], str] = number) -> tuple[str, str]:
    """Two numbers, written with as many digits as tell them apart: six where these do, or where the two are equal."""
    texts = written(old, DIGITS), written(new, DIGITS)
    for digits in range(DIGITS + 1, MOST_DIGITS + 1):
        if texts[0] != texts[1] or old == new:
            break
        texts = written(old, digits), written(new, digits)
    return texts


def _moved(move: Move, tolerance: Tolerance) -> str:
    """How something moved, such as ``turned by 0.5° about x and moved by 4 mm along y``; nothing within the tolerance.

    Of a move that is all within the tolerance, what is nearer to it is told.
    """
    turned = move.angle > tolerance.angle
    shifted = move.length > tolerance.length
    if not turned and not shifted:
        turned = move.angle * tolerance.length >= move.length * tolerance.angle
        shifted = not turned
    parts = []
    if turned:
        sign, axis = _axis_name(move.turn / move.angle if move.angle else move.turn)
        parts.append(f"turned by {degrees(sign * move.angle)} about {axis}")
    if shifted:
        sign, axis = _axis_name(move.shift / move.length if move.length else move.shift)
        if axis in "xyz":
            parts.append(f"moved by {millimetres(sign * move.length)} along {axis}")
        else:
            parts.append(f"moved by {_vector(move.shift * 1e3)} mm")
    return " and ".join(parts)


def _axis_name(direction: FloatArray) -> tuple[int, str]:
    """The name of the axis that a unit vector is along, and whether (1) or against (-1); of others, the vector."""
    i = int(abs(direction).argmax())
    if (abs(np.delete(direction, i)) <= ALONG).all():
        return (1 if direction[i] > 0.0 else -1), "xyz"[i]
    return 1, _vector(direction)


def _vector(values: FloatArray) -> str:
    largest = abs(values).max()
    return f"({', '.join(number(x) if abs(x) > ALONG * largest else '0' for x in values)})"
