"""What can be different between two robots, as measured: joints, numbers and names; `wording` has the words.

Each kind of difference, listed in docs/diff.md, is a change of the motion or, if it is in `KEPT`, a note. Lengths are
in m and angles in rad, and no number adds the two up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from pinscrew.changes.geometry import Move
from pinscrew.changes.matching import JointPair
from pinscrew.changes.outcome import Displacement
from pinscrew.description.model import Joint, Mimic

__all__ = [
    "KEPT",
    "AxisMoved",
    "CarriedMoved",
    "Difference",
    "Followed",
    "FrameChosen",
    "FrameMoved",
    "LimitsChanged",
    "MimicChanged",
    "Moved",
    "OneSided",
    "RateChanged",
    "Rehung",
    "Renamed",
    "Reordered",
    "TipsApart",
    "TypeChanged",
    "ZeroShifted",
]

KEPT: Final = frozenset((
    "origin-slid", "frame-re-expressed", "mimic-re-expressed", "joint-renamed", "link-renamed", "robot-renamed",
    "order", "frame-added", "frame-removed", "velocity", "effort",
))  # fmt: skip
"""The kinds that leave the motion as it is."""


@dataclass(frozen=True)
class Difference:
    """One difference, of a kind.

    Attributes:
        kind: stable word, such as ``"axis-turned"``.
        pair: the joint that was edited, in both robots; None where none was.
    """

    kind: str
    pair: JointPair | None

    @property
    def size(self) -> tuple[float, float]:
        """How far something moved (m), and turned (rad); 0 where nothing did."""
        return (0.0, 0.0)

    @property
    def joint(self) -> Joint:
        """The joint to name.

        Raises:
            TypeError: if the difference is about none.
        """
        if self.pair is None:
            raise TypeError(f"{self.kind} is about no joint")
        return self.pair.named

    @property
    def link(self) -> str:
        """The link that it is about, by its name in b if b has it."""
        return "" if self.pair is None else self.pair.link_b if self.pair.b else self.pair.link_a

    @property
    def kept(self) -> bool:
        """Whether it leaves the motion as it is."""
        return self.kind in KEPT

    def _of_joint(self, value: float) -> tuple[float, float]:
        """A joint's value as a length or an angle, as the joint has it."""
        sliding = self.pair is not None and self.pair.named.type == "prismatic"
        return (value, 0.0) if sliding else (0.0, value)


# ------------------------------------------------------------------------------------- where joints stand


@dataclass(frozen=True)
class Followed(Difference):
    """A joint that is another one; ``carried`` is how what follows it is displaced, if it is."""

    carried: Move | None

    @property
    def size(self) -> tuple[float, float]:
        """How far what follows is displaced."""
        return (0.0, 0.0) if self.carried is None else (self.carried.length, self.carried.angle)


@dataclass(frozen=True)
class OneSided(Followed):
    """A joint that only one of the robots has.

    The kind is ``"joint-added"`` or ``"joint-removed"`` where that changes the motion, ``"frame-added"`` or
    ``"frame-removed"`` of a fixed joint that displaces nothing, ``"tip-removed"`` where a tip went with it; ``tip`` is
    whether a frame that was added is a tip.
    """

    tip: bool = False


@dataclass(frozen=True)
class TypeChanged(Followed):
    """A joint of another type."""

    old: str
    new: str


@dataclass(frozen=True)
class Moved(Difference):
    """Something that was displaced."""

    move: Move

    @property
    def size(self) -> tuple[float, float]:
        """How far it was displaced."""
        return (self.move.length, self.move.angle)


@dataclass(frozen=True)
class AxisMoved(Moved):
    """A joint whose axis is another line or direction: ``"axis-turned"``, ``"axis-moved"`` or ``"axis-reversed"``.

    Attributes:
        rigid: whether what follows goes along.
        follows: how what follows is displaced where it neither goes along nor stays.
    """

    rigid: bool = False
    follows: Move | None = None


@dataclass(frozen=True)
class FrameMoved(Moved):
    """A floating or planar joint that moves in another frame; ``along`` where what follows goes along."""

    along: bool


@dataclass(frozen=True)
class ZeroShifted(Difference):
    """A joint on its axis, with what it carries moved along or about that: by ``value``, in the joint's unit."""

    value: float

    @property
    def size(self) -> tuple[float, float]:
        """By how much."""
        return self._of_joint(abs(self.value))


@dataclass(frozen=True)
class CarriedMoved(Moved):
    """A joint on its axis, or a fixed one, with what it carries displaced: ``"tip-moved"`` or ``"link-moved"``.

    ``alone`` is whether what follows the link stays; ``move`` then is seen from the link itself.
    """

    alone: bool = False


@dataclass(frozen=True)
class FrameChosen(Moved):
    """The frame of a link that was chosen anew while all moves as before; ``move`` is seen from itself.

    The kind is ``"origin-slid"`` where only the origin was, to where the joint does not depend on it, else
    ``"frame-re-expressed"``.
    """

    @property
    def size(self) -> tuple[float, float]:
        """How far it was displaced."""
        return (self.move.length, 0.0 if self.kind == "origin-slid" else self.move.angle)


@dataclass(frozen=True)
class Rehung(Difference):
    """A joint that hangs from the link ``new`` instead of ``old``; ``at_zero`` is what was done to where it stands."""

    old: str
    new: str
    at_zero: Difference | None

    @property
    def size(self) -> tuple[float, float]:
        """How far it stands from where it stood."""
        return (0.0, 0.0) if self.at_zero is None else self.at_zero.size


# -------------------------------------------------------------------------------- limits, mimics and names


@dataclass(frozen=True)
class LimitsChanged(Difference):
    """Limits of a joint's value, ends within the tolerance made equal; ``turned_round`` with a reversed axis."""

    old: tuple[float, float]
    new: tuple[float, float]
    turned_round: bool

    @property
    def size(self) -> tuple[float, float]:
        """How far an end went, at most; 0 where one went to infinity or came from there."""
        farthest = max(0.0 if x == y else abs(x - y) for x, y in zip(self.old, self.new, strict=True))
        return self._of_joint(farthest if math.isfinite(farthest) else 0.0)


@dataclass(frozen=True)
class RateChanged(Difference):
    """A limit that does not restrict where a joint can be: ``"velocity"`` or ``"effort"``."""

    old: float
    new: float


@dataclass(frozen=True)
class MimicChanged(Difference):
    """What a joint follows, None for a coordinate of its own; numbers within the tolerance are made equal.

    The kind is ``"mimic"``, or ``"mimic-re-expressed"`` where axis, origin or another mimic make up for it.
    """

    old: Mimic | None
    new: Mimic | None

    @property
    def size(self) -> tuple[float, float]:
        """How far the offset went."""
        if self.old is None or self.new is None or self.kind != "mimic":
            return (0.0, 0.0)
        return self._of_joint(abs(self.new.offset - self.old.offset))


@dataclass(frozen=True)
class Renamed(Difference):
    """A joint, the link below it, the base or the robot that is called otherwise.

    The kind is ``"names-swapped"`` where another joint has the old name or had the new one. ``tip`` is whether it is a
    tip's name.
    """

    old: str
    new: str
    tip: bool = False

    @property
    def link(self) -> str:
        """The link below the joint, or the base if that is called otherwise."""
        return self.new if self.kind == "link-renamed" else super().link


@dataclass(frozen=True)
class Reordered(Difference):
    """Joints, by their names in b, whose coordinates have other places in q."""

    joints: tuple[str, ...]


@dataclass(frozen=True)
class TipsApart(Difference):
    """Tips that come apart by more than the tolerance although each joint keeps within it.

    A joint that turned by 0.015 rad, with 0.02 allowed, carries a tip 1 m away by 15 mm; many small ones add up.
    ``turned`` is whether it is their angle that counts, and not their distance.
    """

    displacement: Displacement
    turned: bool

    @property
    def size(self) -> tuple[float, float]:
        """How far they come apart."""
        return (self.displacement.length, self.displacement.angle)

    @property
    def link(self) -> str:
        """The tip that comes apart farthest, by its name in a."""
        return (self.displacement.angle_at if self.turned else self.displacement.length_at).frame
