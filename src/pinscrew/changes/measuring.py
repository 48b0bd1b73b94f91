"""All that is different between two robots, measured.

The way: joints are matched (`matching`), their poses at zero taken (`geometry`), the edited ones found (`walk`), what
was done to each measured (`placing`, and here for types, limits, mimics and names), and at the end how far the tips
come apart (`distance`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from pinscrew.changes.differences import (
    Difference,
    LimitsChanged,
    MimicChanged,
    RateChanged,
    Rehung,
    Renamed,
    Reordered,
    TipsApart,
    TypeChanged,
    ZeroShifted,
)
from pinscrew.changes.distance import columns, largest
from pinscrew.changes.geometry import Poses, locus
from pinscrew.changes.matching import JointPair, Matching, match
from pinscrew.changes.outcome import Displacement, Tolerance
from pinscrew.changes.placing import Placed, Placing
from pinscrew.changes.walk import Features, walk
from pinscrew.description.model import Description, Joint, Mimic, drivers
from pinscrew.robot.robot import Robot

__all__ = ["Measured", "measure"]

ROUNDING: Final = 1e-11
"""Radians, and metres per metre of the robot's size, within which two computed poses are the same."""
WRITTEN: Final = 1e-12
"""What two numbers of a file differ by, for their size, that were written in other ways."""


@dataclass(frozen=True)
class Measured:
    """What is different between two robots.

    Attributes:
        differences: down the tree, those of the robot as a whole at the end.
        displacement: how far the tips come apart; None where that can't be asked.
        tolerance: within what things stand where they stood: what was allowed, but at least what rounding does.
    """

    differences: tuple[Difference, ...]
    displacement: Displacement | None
    tolerance: Tolerance


def measure(a: Robot, b: Robot, tolerance: Tolerance) -> Measured:
    """Measure what is different between two robots."""
    matching = match(a.description, b.description)
    poses_a, poses_b = Poses(a.description), Poses(b.description)
    joints = _Joints(a, b, matching, tolerance)
    tips = _tips(matching, poses_a, poses_b)
    size = max(poses_a.size, poses_b.size)
    computed = Tolerance(max(tolerance.length, ROUNDING * size), max(tolerance.angle, ROUNDING))
    features = Features(poses_a, poses_b, matching.pairs, tips, joints.opposite(), computed)
    differences: list[Difference] = []
    for pair, crossing in zip(matching.pairs, walk(matching.pairs, poses_a, poses_b, features), strict=True):
        placing = Placing(pair, crossing, poses_a, poses_b, computed)
        if pair.a is None or pair.b is None:
            differences.append(placing.one_sided())
        else:
            differences += joints.named(pair, pair.a, pair.b)
            differences += joints.both(pair, pair.a, pair.b, placing.both(pair.a, pair.b))
    differences += _whole(a, b, matching)
    places = columns(a, b, matching.joints)
    displacement = None if places is None else largest(a, b, places, [(x, y) for x, y, _ in tips])
    apart = displacement is not None and not displacement.within(computed)
    if displacement is not None and apart and all(difference.kept for difference in differences):
        differences.append(TipsApart("tip-moved", None, displacement, turned=displacement.length <= computed.length))
    return Measured(tuple(differences), displacement, computed)


def _tips(matching: Matching, a: Poses, b: Poses) -> list[tuple[str, str, int]]:
    """The tips of either robot that both have, by their names, with the last pair that leads to either, or -1."""
    last_a: dict[str, int] = {}
    last_b: dict[str, int] = {}
    for i, pair in enumerate(matching.pairs):
        if pair.a:
            last_a[pair.link_a] = i
        if pair.b:
            last_b[pair.link_b] = i
    tips = [(x, y) for x, y in matching.links.items() if x in a.tips or y in b.tips]
    return [(x, y, max(last_a.get(x, -1), last_b.get(y, -1))) for x, y in tips]


def _whole(a: Robot, b: Robot, matching: Matching) -> Iterator[Difference]:
    """The robot's name, its base and the order of its coordinates."""
    if a.description.name != b.description.name:
        yield Renamed("robot-renamed", None, a.description.name, b.description.name)
    if a.base != b.base and a.base not in b.description.links:
        yield Renamed("link-renamed", None, a.base, b.base)
    order = [matching.joints.get(name) for name in a.joint_names]
    if order != list(b.joint_names) and set(order) == set(b.joint_names):
        moved = (now for before, now in zip(order, b.joint_names, strict=True) if before != now)
        yield Reordered("order", None, tuple(moved))


# ------------------------------------------------------------------------------------------ single joints


@dataclass(frozen=True)
class DrivingLaw:
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


def _driving_laws(robot: Robot) -> dict[str, DrivingLaw]:
    """What drives each joint that moves, through however many mimics."""
    joints = {joint.name: joint for joint in robot.description.joints}
    laws = drivers({name: joint.mimic for name, joint in joints.items()})
    driving = {}
    for motion in robot.mechanism.motions:
        law = laws[motion.joint.name]
        driving[motion.joint.name] = DrivingLaw(law.joint, law.multiplier, law.offset, _span(joints[law.joint]))
    return driving


def _span(joint: Joint) -> float:
    ends = [abs(end) for end in (joint.limits.lower, joint.limits.upper) if math.isfinite(end)]
    return max(ends) if len(ends) == 2 else 1.0 if joint.type == "prismatic" else math.pi


def _alike(a: tuple[float, float], b: tuple[float, float], span: float, tolerance: float) -> bool:
    """Whether two laws (multiplier, offset) of an x with ``|x| <= span`` give values within a tolerance.

    ``|(m_a - m_b) x + (o_a - o_b)| <= |m_a - m_b| span + |o_a - o_b|``: the bound is in the driven joint's unit, though
    multipliers of a slide on a turning joint are in m/rad. So 0.01 m/rad more is 20 mm at the limit of 2 rad.
    """
    return abs(a[0] - b[0]) * span + abs(a[1] - b[1]) <= tolerance


class _Joints:
    """What two robots' joints are, beside where they stand."""

    def __init__(self, a: Robot, b: Robot, matching: Matching, tolerance: Tolerance) -> None:
        self._matching, self._tolerance = matching, tolerance
        self._laws = _driving_laws(a), _driving_laws(b)
        self._names = _joint_names(a.description) & _joint_names(b.description)
        self._links = frozenset(a.description.links), frozenset(b.description.links)
        self._tips = frozenset(b.description.leaves)

    def opposite(self) -> frozenset[int]:
        """The pairs whose joints are driven by opposite values: there a reversed axis is the same motion."""
        return frozenset(
            i for i, pair in enumerate(self._matching.pairs) if pair.a and pair.b and self._opposite(pair.a, pair.b)
        )

    def _opposite(self, joint: Joint, now: Joint) -> bool:
        a, b = self._laws[0].get(joint.name), self._laws[1].get(now.name)
        if a is None or b is None or a.multiplier * b.multiplier >= 0.0:
            return False
        span = max(a.span, b.span)
        return _alike((a.multiplier, a.offset), (-b.multiplier, -b.offset), span, self._tolerance.of(now))

    def named(self, pair: JointPair, joint: Joint, now: Joint) -> Iterator[Difference]:
        """The names of a joint, ``joint`` in a and ``now`` in b, and of the link below it."""
        if joint.name != now.name:
            swapped = now.name in self._names or joint.name in self._names
            yield Renamed("names-swapped" if swapped else "joint-renamed", pair, joint.name, now.name)
        if joint.child != now.child and joint.child not in self._links[1] and now.child not in self._links[0]:
            yield Renamed("link-renamed", pair, joint.child, now.child, tip=now.child in self._tips)

    def both(self, pair: JointPair, joint: Joint, now: Joint, placed: Placed) -> Iterator[Difference]:
        """A joint, ``joint`` in a and ``now`` in b, that stands as ``placed``."""
        where = placed.difference
        mimic = self._mimic(pair, joint, now, placed)
        if pair.elsewhere:
            moved = None if where is None or where.kept else where
            yield Rehung("parent", pair, joint.parent, now.parent, moved)
            where = where if moved is None else None
        elif isinstance(where, ZeroShifted) and mimic is not None and mimic.kept:
            where = None  # the mimic makes up for it
        if where is not None:
            yield where
        if joint.type != now.type and locus(joint) == locus(now):
            yield TypeChanged("type", pair, None, joint.type, now.type)
        elif joint.type == now.type:
            yield from self._limits(pair, joint, now, placed)
        yield from self._rates(pair, joint, now)
        if mimic is not None:
            yield mimic

    def _limits(self, pair: JointPair, joint: Joint, now: Joint, placed: Placed) -> Iterator[Difference]:
        tolerance = self._tolerance.of(joint)
        old, new = (joint.limits.lower, joint.limits.upper), (now.limits.lower, now.limits.upper)
        # An axis that is turned round has its limits turned round too: [-1, 2] is [-2, 1] then.
        turned_round = placed.reversed and _near(new[0], -old[1], tolerance) and _near(new[1], -old[0], tolerance)
        new = (_snapped(old[0], new[0], tolerance), _snapped(old[1], new[1], tolerance))
        moves_as_before = placed.difference is None or placed.difference.kept
        if new != old and not (turned_round and moves_as_before):
            yield LimitsChanged("limits", pair, old, new, turned_round)

    def _rates(self, pair: JointPair, joint: Joint, now: Joint) -> Iterator[Difference]:
        """Limits of velocity, to the joint's tolerance in a second, and of effort, which has none, to rounding."""
        old, new = joint.limits, now.limits
        if not _near(old.velocity, new.velocity, self._tolerance.of(joint)):
            yield RateChanged("velocity", pair, old.velocity, new.velocity)
        if not math.isclose(old.effort, new.effort, rel_tol=WRITTEN):
            yield RateChanged("effort", pair, old.effort, new.effort)

    def _mimic(self, pair: JointPair, joint: Joint, now: Joint, placed: Placed) -> Difference | None:
        """What drives the joint; two mimics are the same if the values they give are, and stand for the same place.

        In b the axis may be reversed (sign s) and the zero shifted by z: there the value y is a's ``s y + z``.
        """
        old, new = self._laws[0].get(joint.name), self._laws[1].get(now.name)
        if old is None or new is None or (joint.mimic is None and now.mimic is None):
            return None
        if joint.mimic is None or now.mimic is None:
            return MimicChanged("mimic", pair, joint.mimic, now.mimic)
        tolerance, old_mimic, new_mimic = self._tolerance.of(now), joint.mimic, now.mimic
        reach = max(self._laws[0][old_mimic.joint].reach, self._laws[1][new_mimic.joint].reach)
        direct = (old_mimic.multiplier, old_mimic.offset), (new_mimic.multiplier, new_mimic.offset)
        if self._matching.joints.get(old_mimic.joint) == new_mimic.joint and _alike(*direct, reach, tolerance):
            return None
        sign = -1.0 if placed.reversed else 1.0
        laws = (old.multiplier, old.offset), (sign * new.multiplier, sign * new.offset + placed.zero)
        kept = self._matching.joints.get(old.joint) == new.joint and _alike(*laws, max(old.span, new.span), tolerance)
        multiplier = _snapped(old_mimic.multiplier, new_mimic.multiplier, tolerance / reach if reach else math.inf)
        shown = Mimic(new_mimic.joint, multiplier, _snapped(old_mimic.offset, new_mimic.offset, tolerance))
        return MimicChanged("mimic-re-expressed" if kept else "mimic", pair, old_mimic, shown)


def _joint_names(description: Description) -> frozenset[str]:
    return frozenset(joint.name for joint in description.joints)


def _near(x: float, y: float, tolerance: float) -> bool:
    """Whether two numbers are equal to a tolerance; infinite ones are if they are the same."""
    return x == y or abs(x - y) <= tolerance


def _snapped(old: float, new: float, tolerance: float) -> float:
    """The new number, or the old one where the two are equal: what differs by less is not told."""
    return old if _near(old, new, tolerance) else new
