"""Which joint and link of one description is which of another: by name, else by the place in the tree.

Both trees are gone down at once, level by level. Of the joints that hang from one place, partners are sought by name,
then by the child link's name, then by how they stand, then by type alone. A joint without a partner, whose name the
other side does not know, was added or removed; what hangs behind it may still have partners in front of it. So if a
bracket is inserted in

    a:  base ─ shoulder ─ elbow          b:  base ─ shoulder ─ bracket ─ elbow

then below the shoulder 'elbow' of a and 'bracket' of b are left. The name 'bracket' is new, so it was added, and behind
it 'elbow' meets 'elbow'. What is left in the end has its namesake elsewhere in the tree, or none.
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from pinscrew.description.model import Description, Joint

__all__ = ["JointPair", "Matching", "match"]

DEEPEST: Final = 50
"""Added or removed joints in a row behind which a known joint is looked for."""
LOOKED_THROUGH: Final = 100
"""Joints beside added and removed ones that are looked through, on the average of all joints of the two robots."""
DIGITS: Final = 9
"""Digits (of m and of unit vectors) in which two joints agree that are taken for one whose name changed."""


@dataclass(frozen=True)
class JointPair:
    """A joint in both robots, or one that only one of them has: a step on the way down both trees at once.

    Attributes:
        a: the joint in a, or None where it was added.
        b: the joint in b, or None where it was removed.
        above: index of the pair above, or -1.
        link_a: the link in a that the joint leads to; where it was added, the one it is added below.
        link_b: the link in b that the joint leads to; where it was removed, the one it hung from.
        elsewhere: whether the joint hangs from another place in b.
    """

    a: Joint | None
    b: Joint | None
    above: int
    link_a: str
    link_b: str
    elsewhere: bool = False

    @property
    def named(self) -> Joint:
        """The joint to name: b's, or a's where b does not have it."""
        joint = self.b or self.a
        if joint is None:
            raise TypeError("a pair has a joint")
        return joint


@dataclass(frozen=True)
class Matching:
    """Two descriptions, matched.

    Attributes:
        pairs: all joints, those above before those below.
        joints: names of b's joints by those in a.
        links: names of b's links by those in a.
    """

    pairs: tuple[JointPair, ...]
    joints: Mapping[str, str]
    links: Mapping[str, str]


def match(a: Description, b: Description) -> Matching:
    """Match two descriptions, from the base down."""
    pairs = _Matcher(a, b).run()
    joints = {pair.a.name: pair.b.name for pair in pairs if pair.a and pair.b}
    known = frozenset(b.links)
    links = {link: link for link in a.links if link in known}
    taken = set(links)
    for link_a, link_b in [(a.root, b.root), *((pair.link_a, pair.link_b) for pair in pairs if pair.a and pair.b)]:
        if link_a not in links and link_b not in taken:
            links[link_a] = link_b
            taken.add(link_b)
    return Matching(pairs, joints, links)


@dataclass
class _Side:
    """One description while it is matched.

    Attributes:
        names: its joints' names.
        below: the joints that hang from each link.
        seen: names of the joints that were matched, added or removed so far.
        last: index of the last pair that leads to a link.
    """

    description: Description
    names: frozenset[str] = field(init=False)
    below: dict[str, list[Joint]] = field(init=False)
    seen: set[str] = field(init=False, default_factory=set)
    last: dict[str, int] = field(init=False)

    def __post_init__(self) -> None:
        self.names = frozenset(joint.name for joint in self.description.joints)
        self.below = {link: [] for link in self.description.links}
        for joint in self.description.joints:
            self.below[joint.parent].append(joint)
        self.last = {self.description.root: -1}

    def hanging(self, joint: Joint | None) -> list[Joint]:
        """The joints below one that were not matched yet."""
        return [] if joint is None else self.fresh(self.below[joint.child])

    def fresh(self, joints: Iterable[Joint]) -> list[Joint]:
        return [joint for joint in joints if joint.name not in self.seen]


class _Matcher:
    def __init__(self, a: Description, b: Description) -> None:
        self._a, self._b = _Side(a), _Side(b)
        self._pairs: list[JointPair] = []
        self._pending: list[tuple[list[Joint], list[Joint], int]] = []
        self._left_to_look_through = LOOKED_THROUGH * (len(a.joints) + len(b.joints))

    def run(self) -> tuple[JointPair, ...]:
        a, b = self._a, self._b
        self._pending.append((a.below[a.description.root], b.below[b.description.root], -1))
        self._work()
        # What is left has a namesake that hangs elsewhere, or had one that was matched to another joint.
        namesakes = {joint.name: joint for joint in b.description.joints}
        for joint in a.description.joints:
            if joint.name not in a.seen:
                partner = namesakes.get(joint.name)
                partner = None if partner is None or partner.name in b.seen else partner
                self._descend(joint, partner, a.last.get(joint.parent, -1), elsewhere=partner is not None)
                self._work()
        for joint in b.description.joints:
            if joint.name not in b.seen:
                self._descend(None, joint, b.last.get(joint.parent, -1))
                self._work()
        return tuple(self._pairs)

    def _work(self) -> None:
        while self._pending:
            self._level(*self._pending.pop(), depth=0)

    def _pair(self, a: Joint | None, b: Joint | None, above: int, *, elsewhere: bool = False) -> int:
        """Add a pair; its index."""
        roots = (self._a.description.root, self._b.description.root)
        before = roots if above < 0 else (self._pairs[above].link_a, self._pairs[above].link_b)
        index, links = len(self._pairs), (a.child if a else before[0], b.child if b else before[1])
        self._pairs.append(JointPair(a, b, above, *links, elsewhere=elsewhere))
        for side, joint, link in ((self._a, a, links[0]), (self._b, b, links[1])):
            side.last[link] = index
            if joint is not None:
                side.seen.add(joint.name)
        return index

    def _descend(self, a: Joint | None, b: Joint | None, above: int, *, elsewhere: bool = False) -> None:
        """Add a pair; what hangs below waits."""
        index = self._pair(a, b, above, elsewhere=elsewhere)
        self._pending.append((self._a.hanging(a), self._b.hanging(b), index))

    def _level(self, at_a: list[Joint], at_b: list[Joint], above: int, *, depth: int) -> None:
        """Match joints that hang from one place, and look for what has no partner behind added or removed joints."""
        at_a, at_b = self._a.fresh(at_a), self._b.fresh(at_b)
        for joint, partner in self._partners(at_a, at_b):
            self._descend(joint, partner, above)
        for joint in self._a.fresh(at_a):
            if joint.name not in self._b.names:
                index = self._pair(joint, None, above)
                hanging = self._a.hanging(joint)
                self._behind(hanging, self._beside(self._b, at_b) if hanging else [], index, depth)
        for joint in self._b.fresh(at_b):
            if joint.name not in self._a.names:
                index = self._pair(None, joint, above)
                hanging = self._b.hanging(joint)
                self._behind(self._beside(self._a, at_a) if hanging else [], hanging, index, depth)

    def _beside(self, side: _Side, joints: list[Joint]) -> list[Joint]:
        """Those that were not matched yet; none once too many were looked through."""
        self._left_to_look_through -= len(joints)
        return side.fresh(joints) if self._left_to_look_through >= 0 else []

    def _behind(self, at_a: list[Joint], at_b: list[Joint], index: int, depth: int) -> None:
        """Match what hangs behind an added or removed joint with what hangs beside it on the other side."""
        if depth < DEEPEST and at_a and at_b:
            self._level(at_a, at_b, index, depth=depth + 1)
        else:
            last = self._pairs[index]
            self._pending.append((at_a if last.a else [], at_b if last.b else [], index))

    def _partners(self, at_a: list[Joint], at_b: list[Joint]) -> list[tuple[Joint, Joint]]:
        """Partners among joints that hang from one place: first by name, then by child, then by how they stand."""
        partners = _with_equal(lambda joint: joint.name, at_a, at_b)
        partners += _with_equal(lambda joint: joint.child, *_without(partners, at_a, at_b))
        # A name that the other side knows belongs to a joint elsewhere: that is no new name.
        new_a = [joint for joint in at_a if joint.name not in self._b.names]
        new_b = [joint for joint in at_b if joint.name not in self._a.names]
        partners += _with_equal(_stand, *_without(partners, new_a, new_b))
        new_a, new_b = _without(partners, new_a, new_b)
        if sorted(joint.type for joint in new_a) == sorted(joint.type for joint in new_b):
            partners += _with_equal(lambda joint: joint.type, new_a, new_b)
        return partners


def _with_equal(key: Callable[[Joint], object], at_a: list[Joint], at_b: list[Joint]) -> list[tuple[Joint, Joint]]:
    """The joints with equal keys, in order."""
    waiting: dict[object, deque[Joint]] = defaultdict(deque)
    for joint in at_b:
        waiting[key(joint)].append(joint)
    return [(joint, waiting[key(joint)].popleft()) for joint in at_a if waiting[key(joint)]]


def _without(
    partners: list[tuple[Joint, Joint]], at_a: list[Joint], at_b: list[Joint]
) -> tuple[list[Joint], list[Joint]]:
    """The joints that have no partner yet."""
    taken_a, taken_b = {joint.name for joint, _ in partners}, {joint.name for _, joint in partners}
    return [x for x in at_a if x.name not in taken_a], [x for x in at_b if x.name not in taken_b]


def _stand(joint: Joint) -> object:
    """How a joint stands in its parent link, to `DIGITS`."""
    place = np.concatenate([joint.T_parent_joint.ravel(), joint.axis])
    return joint.type, (np.round(place, DIGITS) + 0.0).tobytes()
