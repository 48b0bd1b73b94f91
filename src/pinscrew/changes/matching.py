"""Which joint and link of one description is which of another: by name, else by the place in the tree."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from pinscrew.description.model import Description, Joint

__all__ = ["Matching", "Step", "match"]

DEEPEST: Final = 50
"""Added or removed joints in a row behind which a known joint is looked for."""
DIGITS: Final = 9
"""Digits (of m and of unit vectors) in which two joints agree that are taken for one whose name changed."""


@dataclass(frozen=True)
class Step:
    """One joint on the way down both trees at once.

    Attributes:
        a: the joint in a, or None where it was added.
        b: the joint in b, or None where it was removed.
        above: index of the step above, or -1.
        link_a: the link in a that the step leads to; where a joint was added, the one it is added below.
        link_b: the link in b that the step leads to; where a joint was removed, the one it hung from.
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
            raise TypeError("a step has a joint")
        return joint


@dataclass(frozen=True)
class Matching:
    """Two descriptions, matched.

    Attributes:
        steps: all joints, those above before those below.
        joints: names of b's joints by those in a.
        links: names of b's links by those in a.
    """

    steps: tuple[Step, ...]
    joints: Mapping[str, str]
    links: Mapping[str, str]


def match(a: Description, b: Description) -> Matching:
    """Match two descriptions, from the base down."""
    steps = _Matcher(a, b).run()
    joints = {step.a.name: step.b.name for step in steps if step.a and step.b}
    links = {link: link for link in a.links if link in set(b.links)}
    taken = set(links.values())
    pairs = [(a.root, b.root), *((step.link_a, step.link_b) for step in steps if step.a and step.b)]
    for link_a, link_b in pairs:
        if link_a not in links and link_b not in taken:
            links[link_a] = link_b
            taken.add(link_b)
    return Matching(steps, joints, links)


@dataclass
class _Side:
    """One description while it is matched."""

    description: Description
    names: frozenset[str] = field(init=False)
    below: dict[str, list[Joint]] = field(init=False)
    seen: set[str] = field(init=False, default_factory=set)

    def __post_init__(self) -> None:
        self.names = frozenset(joint.name for joint in self.description.joints)
        self.below = {link: [] for link in self.description.links}
        for joint in self.description.joints:
            self.below[joint.parent].append(joint)

    def hanging(self, joint: Joint | None) -> list[Joint]:
        """The joints below one that were not matched yet."""
        return [] if joint is None else self.fresh(self.below[joint.child])

    def fresh(self, joints: Iterable[Joint]) -> list[Joint]:
        return [joint for joint in joints if joint.name not in self.seen]


class _Matcher:
    def __init__(self, a: Description, b: Description) -> None:
        self._a, self._b = _Side(a), _Side(b)
        self._steps: list[Step] = []
        self._pending: list[tuple[list[Joint], list[Joint], int]] = []

    def run(self) -> tuple[Step, ...]:
        a, b = self._a, self._b
        self._pending.append((a.below[a.description.root], b.below[b.description.root], -1))
        self._work()
        # What is left has a namesake that hangs elsewhere, or had one that was matched to another joint.
        others = {joint.name: joint for joint in b.description.joints}
        for joint in a.description.joints:
            if joint.name not in a.seen:
                partner = others.get(joint.name)
                partner = None if partner is None or partner.name in b.seen else partner
                self._descend(joint, partner, self._index(joint.parent, "a"), elsewhere=partner is not None)
                self._work()
        for joint in b.description.joints:
            if joint.name not in b.seen:
                self._descend(None, joint, self._index(joint.parent, "b"))
                self._work()
        return tuple(self._steps)

    def _work(self) -> None:
        while self._pending:
            self._level(*self._pending.pop(), depth=0)

    def _index(self, link: str, side: str) -> int:
        """The last step that leads to a link."""
        found = (i for i, step in enumerate(self._steps) if getattr(step, f"link_{side}") == link)
        return max(found, default=-1)

    def _step(self, a: Joint | None, b: Joint | None, above: int, *, elsewhere: bool = False) -> int:
        root_a, root_b = self._a.description.root, self._b.description.root
        before = (root_a, root_b) if above < 0 else (self._steps[above].link_a, self._steps[above].link_b)
        links = (a.child if a else before[0], b.child if b else before[1])
        self._steps.append(Step(a, b, above, *links, elsewhere=elsewhere))
        if a:
            self._a.seen.add(a.name)
        if b:
            self._b.seen.add(b.name)
        return len(self._steps) - 1

    def _descend(self, a: Joint | None, b: Joint | None, above: int, *, elsewhere: bool = False) -> None:
        """Take a step; what hangs below waits."""
        index = self._step(a, b, above, elsewhere=elsewhere)
        self._pending.append((self._a.hanging(a), self._b.hanging(b), index))

    def _level(self, at_a: list[Joint], at_b: list[Joint], above: int, *, depth: int) -> None:
        """Match joints that hang from one place, and look for what has no partner behind added or removed joints."""
        at_a, at_b = self._a.fresh(at_a), self._b.fresh(at_b)
        for joint, partner in self._pairs(at_a, at_b):
            self._descend(joint, partner, above)
        for joint in self._a.fresh(at_a):
            rest = self._b.fresh(at_b)
            if joint.name not in self._b.names:
                index = self._step(joint, None, above)
                self._behind(self._a.hanging(joint), rest, index, depth)
        for joint in self._b.fresh(at_b):
            rest = self._a.fresh(at_a)
            if joint.name not in self._a.names:
                index = self._step(None, joint, above)
                self._behind(rest, self._b.hanging(joint), index, depth)

    def _behind(self, at_a: list[Joint], at_b: list[Joint], index: int, depth: int) -> None:
        if depth < DEEPEST and at_a and at_b:
            self._level(at_a, at_b, index, depth=depth + 1)
        else:
            last = self._steps[index]
            below_a = at_a if last.a else []
            below_b = at_b if last.b else []
            self._pending.append((below_a, below_b, index))

    def _pairs(self, at_a: list[Joint], at_b: list[Joint]) -> list[tuple[Joint, Joint]]:
        """Partners among joints that hang from one place: first by name, then by child, then by how they stand."""
        pairs = _partners(at_a, at_b, lambda joint: joint.name)
        pairs += _partners(*_rest(at_a, at_b, pairs), lambda joint: joint.child)
        # A name that the other side knows belongs to a joint elsewhere: that is no new name.
        new_a = [joint for joint in at_a if joint.name not in self._b.names]
        new_b = [joint for joint in at_b if joint.name not in self._a.names]
        pairs += _partners(*_rest(new_a, new_b, pairs), _stand)
        new_a, new_b = _rest(new_a, new_b, pairs)
        if sorted(joint.type for joint in new_a) == sorted(joint.type for joint in new_b):
            pairs += _partners(new_a, new_b, lambda joint: joint.type)
        return pairs


def _partners(at_a: list[Joint], at_b: list[Joint], key: Callable[[Joint], object]) -> list[tuple[Joint, Joint]]:
    """The joints with equal keys, in order."""
    waiting: dict[object, deque[Joint]] = defaultdict(deque)
    for joint in at_b:
        waiting[key(joint)].append(joint)
    return [(joint, waiting[key(joint)].popleft()) for joint in at_a if waiting[key(joint)]]


def _rest(at_a: list[Joint], at_b: list[Joint], pairs: list[tuple[Joint, Joint]]) -> tuple[list[Joint], list[Joint]]:
    """The joints that have no partner yet."""
    taken_a, taken_b = {joint.name for joint, _ in pairs}, {joint.name for _, joint in pairs}
    return [x for x in at_a if x.name not in taken_a], [x for x in at_b if x.name not in taken_b]


def _stand(joint: Joint) -> object:
    """How a joint stands in its parent link, to `DIGITS`."""
    place = np.concatenate([joint.T_parent_joint.ravel(), joint.axis])
    return joint.type, (np.round(place, DIGITS) + 0.0).tobytes()
