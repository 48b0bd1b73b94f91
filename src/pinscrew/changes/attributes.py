"""What was done to a joint beside its placement: type, limits, mimic, and where it hangs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from pinscrew.changes.geometry import kind
from pinscrew.changes.matching import Step
from pinscrew.changes.outcome import Change, Near
from pinscrew.changes.placement import Placement
from pinscrew.changes.wording import degrees, intervals, millimetres, told_apart
from pinscrew.description.model import Description, Joint, Mimic, drivers
from pinscrew.robot.robot import Robot

__all__ = ["Drive", "attributes", "driven", "opposite", "renames"]

ROUNDING: Final = 1e-12
"""What two numbers of a file differ by, for their size, that were written in other ways."""


@dataclass(frozen=True)
class Drive:
    """What drives a joint: ``value = multiplier * x + offset`` of the coordinate x at the end of its mimics.

    Attributes:
        joint: the joint that has x.
        multiplier: units of the driven joint per unit of x.
        offset: in the driven joint's unit.
        span: the largest |x| within the limits; half a turn, or 1 m, where there are none.
    """

    joint: str
    multiplier: float
    offset: float
    span: float

    @property
    def reach(self) -> float:
        """A bound of the driven joint's value."""
        return abs(self.multiplier) * self.span + abs(self.offset)


def driven(robot: Robot) -> dict[str, Drive]:
    """What drives each joint that moves, through however many mimics."""
    joints = {joint.name: joint for joint in robot.description.joints}
    laws = drivers({name: joint.mimic for name, joint in joints.items()})
    drives = {}
    for motion in robot.mechanism.motions:
        law = laws[motion.joint.name]
        drives[motion.joint.name] = Drive(law.joint, law.multiplier, law.offset, _span(joints[law.joint]))
    return drives


def _span(joint: Joint) -> float:
    ends = [abs(end) for end in (joint.limits.lower, joint.limits.upper) if math.isfinite(end)]
    return max(ends) if len(ends) == 2 else 1.0 if joint.type == "prismatic" else math.pi


def opposite(a: Drive | None, b: Drive | None, tolerance: float) -> bool:
    """Whether two joints are driven by opposite values, to a tolerance in their unit."""
    if a is None or b is None or a.multiplier * b.multiplier >= 0.0:
        return False
    return _close((a.multiplier, a.offset), (-b.multiplier, -b.offset), max(a.span, b.span), tolerance)


def _close(a: tuple[float, float], b: tuple[float, float], span: float, tolerance: float) -> bool:
    """Whether two laws (multiplier, offset) of an x with ``|x| <= span`` give values within a tolerance.

    ``|(m_a - m_b) x + (o_a - o_b)| <= |m_a - m_b| span + |o_a - o_b|``: the bound is in the driven joint's unit, though
    multipliers of a slide on a turning joint are in m/rad.
    """
    return abs(a[0] - b[0]) * span + abs(a[1] - b[1]) <= tolerance


def attributes(
    step: Step,
    placed: Placement,
    names: Mapping[str, str],
    drives: tuple[Mapping[str, Drive], Mapping[str, Drive]],
    near: Near,
) -> tuple[list[Change], list[Change]]:
    """Changes and notes about a joint that both robots have; ``names`` are b's names of joints by those in a."""
    joint, now = step.a, step.b
    if joint is None or now is None:
        return [], []
    changes, notes = list(placed.changes), list(placed.notes)
    if step.elsewhere:
        changes = [_rehung(step, joint, now, changes)]
    if joint.type != now.type and kind(joint) == kind(now):
        words = f"it is {now.type} instead of {joint.type}, {'with' if now.type == 'revolute' else 'without'} limits"
        changes.append(_change("type", step, words))
    elif joint.type == now.type:
        changes += _limits(step, joint, now, placed, near)
    notes += _rates(step, joint, now, near)
    mimic = _mimic(step, joint, now, placed, names, drives, near)
    if mimic is not None and mimic.kind == "mimic-re-expressed":
        # Axis or origin make up for the other numbers.
        changes = [change for change in changes if change.kind != "zero-shifted"]
        notes.append(mimic)
    elif mimic is not None:
        changes.append(mimic)
    return changes, notes


def _change(word: str, step: Step, words: str, length: float = 0.0, angle: float = 0.0) -> Change:
    now = step.named
    return Change(word, now.name, now.child, f"joint {now.name!r}: {words}", length, angle, now.line, now.file)


def _rehung(step: Step, joint: Joint, now: Joint, placed: list[Change]) -> Change:
    """A joint that hangs from another link; how it stands now is part of that."""
    words = f"it hangs from link {now.parent!r} instead of {joint.parent!r}"
    for change in placed:
        how = change.words.partition(": ")[2]
        return _change("parent", step, f"{words}; at zero, {how}", change.length, change.angle)
    return _change("parent", step, f"{words}; at zero, it stands where it stood")


def _limits(step: Step, joint: Joint, now: Joint, placed: Placement, near: Near) -> Iterator[Change]:
    sliding = joint.type == "prismatic"
    tolerance = near.of(joint)
    old, new = (joint.limits.lower, joint.limits.upper), (now.limits.lower, now.limits.upper)
    apart = [0.0 if x == y else abs(x - y) for x, y in zip(old, new, strict=True)]
    turned_round = placed.reversed and all(_equal(x, -y, tolerance) for x, y in zip(new, reversed(old), strict=True))
    if max(apart) <= tolerance or (turned_round and not placed.changes):
        return
    new = (old[0] if apart[0] <= tolerance else new[0], old[1] if apart[1] <= tolerance else new[1])
    word = "changed"
    if new[0] <= old[0] and old[1] <= new[1]:
        word = "widened"
    elif old[0] <= new[0] and new[1] <= old[1]:
        word = "narrowed"
    words = f"its limits are {word} from {{}} to {{}}".format(*intervals(old, new, sliding=sliding))
    if turned_round:
        words += ", as its direction is reversed"
    size = max(apart) if math.isfinite(max(apart)) else 0.0
    yield _change("limits", step, words, *((size, 0.0) if sliding else (0.0, size)))


def _equal(x: float, y: float, tolerance: float) -> bool:
    return x == y or abs(x - y) <= tolerance


def _rates(step: Step, joint: Joint, now: Joint, near: Near) -> Iterator[Change]:
    """Limits that do not restrict where the joint can be; those of efforts, which have no tolerance, to rounding."""
    limits = joint.limits, now.limits
    if not _equal(limits[0].velocity, limits[1].velocity, near.of(joint)):  # in a second
        yield _rate("velocity", step, limits[0].velocity, limits[1].velocity)
    if not math.isclose(limits[0].effort, limits[1].effort, rel_tol=ROUNDING):
        yield _rate("effort", step, limits[0].effort, limits[1].effort)


def _rate(word: str, step: Step, old: float, new: float) -> Change:
    before, after = told_apart(old, new)
    return _change(word, step, f"its limit of {word} is {after} instead of {before}")


def _mimic(
    step: Step,
    joint: Joint,
    now: Joint,
    placed: Placement,
    names: Mapping[str, str],
    drives: tuple[Mapping[str, Drive], Mapping[str, Drive]],
    near: Near,
) -> Change | None:
    old, new = drives[0].get(joint.name), drives[1].get(now.name)
    if old is None or new is None or (joint.mimic is None and now.mimic is None):
        return None
    if joint.mimic is None or now.mimic is None:
        what = f"follows {now.mimic.joint!r}" if now.mimic else "has a coordinate of its own"
        instead = f"following {joint.mimic.joint!r}" if joint.mimic else "having a coordinate of its own"
        return _change("mimic", step, f"it {what} instead of {instead}")
    tolerance = near.of(now)
    direct = (joint.mimic.multiplier, joint.mimic.offset), (now.mimic.multiplier, now.mimic.offset)
    if names.get(joint.mimic.joint) == now.mimic.joint:
        span = max(drives[0][joint.mimic.joint].reach, drives[1][now.mimic.joint].reach)
        if _close(*direct, span, tolerance):
            return None
    sign = -1.0 if placed.reversed else 1.0
    before, after = (old.multiplier, old.offset), (sign * new.multiplier, sign * new.offset + placed.zero)
    same_master = names.get(old.joint) == new.joint
    told = "{} to {}".format(*_laws(joint, now, max(old.span, new.span), tolerance))
    if same_master and _close(before, after, max(old.span, new.span), tolerance):
        return _change("mimic-re-expressed", step, f"its mimic goes from {told}; the motion is the same")
    far = abs(now.mimic.offset - joint.mimic.offset)
    size = (far, 0.0) if now.type == "prismatic" else (0.0, far)
    return _change("mimic", step, f"its mimic goes from {told}", *size)


def _laws(joint: Joint, now: Joint, span: float, tolerance: float) -> tuple[str, ...]:
    """What a mimic joint did and does, such as ``2 × 'drive' + 5°``; what differs within the tolerance is not told."""
    old, new = joint.mimic or Mimic("", 0.0, 0.0), now.mimic or Mimic("", 0.0, 0.0)
    multipliers, offsets = (old.multiplier, new.multiplier), (old.offset, new.offset)
    if abs(multipliers[0] - multipliers[1]) * span <= tolerance:
        multipliers = (multipliers[0],) * 2
    if abs(offsets[0] - offsets[1]) <= tolerance:
        offsets = (offsets[0],) * 2
    units = [millimetres if j.type == "prismatic" else degrees for j in (joint, now)]
    shown = told_apart(*offsets, units[0]) if joint.type == now.type else tuple(map(lambda u, x: u(x), units, offsets))
    return tuple(
        f"{factor} × {mimic.joint!r}{f' + {offset}' * bool(value)}"
        for factor, mimic, offset, value in zip(told_apart(*multipliers), (old, new), shown, offsets, strict=True)
    )


def renames(step: Step, a: Description, b: Description) -> tuple[list[Change], list[Change]]:
    """Changes and notes about the names of a joint and its link that both robots have."""
    joint, now = step.a, step.b
    changes: list[Change] = []
    notes: list[Change] = []
    if joint is None or now is None:
        return changes, notes
    if joint.name != now.name:
        others = {j.name for j in a.joints} & {j.name for j in b.joints}
        if now.name in others or joint.name in others:
            words = f"it was called {joint.name!r}, and that name or its own is now another joint's"
            changes.append(_change("names-swapped", step, words))
        else:
            notes.append(_change("joint-renamed", step, f"it was called {joint.name!r}"))
    if joint.child != now.child and joint.child not in b.links and now.child not in a.links:
        words = f"link {now.child!r} was called {joint.child!r}"
        tip = now.child in b.leaves
        notes.append(Change("link-renamed", now.name, now.child, words, line=now.line, file=now.file, tip=tip))
    return changes, notes
