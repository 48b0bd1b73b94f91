"""What `pinscrew.diff` finds, as plain data: changes of the motion, notes on the rest, how far the tips are apart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from pinscrew.description.model import Joint

__all__ = ["Change", "ChangesData", "Displacement", "TipPlace", "Tolerance"]


@dataclass(frozen=True)
class Tolerance:
    """What counts as equal. Metres and radians don't meet: the tolerance of a joint's value is asked of the joint.

    Attributes:
        length: m.
        angle: rad.
    """

    length: float
    angle: float

    def of(self, joint: Joint) -> float:
        """The tolerance of a joint's value, in the joint's own unit: m of a slide, else rad."""
        return self.length if joint.type == "prismatic" else self.angle


@dataclass(frozen=True)
class Change:
    """One difference between two descriptions.

    Attributes:
        kind: stable word for the kind of difference, such as ``"axis-turned"``; docs/diff.md lists them.
        joint: the joint that was edited, by its name in b (in a, if b has it no more); ``""`` for none.
        link: the link that it is about, likewise; ``""`` for none.
        words: one sentence, in mm and degrees.
        length: how far something moved (m); 0 where nothing did.
        angle: how far something turned (rad); 0 where nothing did.
        line: line of the joint in b's file, or None where b does not have it.
        file: the file that has that line, where it is another: one that b's xacro file includes.
        tip: whether the link is a tip frame's, in a note on a name or on a frame more.
    """

    kind: str
    joint: str
    link: str
    words: str
    length: float
    angle: float
    line: int | None = None
    file: str = ""
    tip: bool = False


@dataclass(frozen=True)
class TipPlace:
    """Where two robots are farthest apart.

    Attributes:
        frame: the tip frame, by its name in a.
        q: the coordinates that move it, by a's names (rad and m).
    """

    frame: str
    q: Mapping[str, float]


@dataclass(frozen=True)
class Displacement:
    """How far apart the tips of two robots are at equal coordinates, at the most, over sampled configurations.

    Attributes:
        length: distance of the tips' origins (m).
        length_at: where that is.
        angle: angle between the tips' frames (rad).
        angle_at: where that is.
    """

    length: float
    length_at: TipPlace
    angle: float
    angle_at: TipPlace

    def within(self, tolerance: Tolerance) -> bool:
        """Whether the tips stand where they stood, to a tolerance."""
        return self.length <= tolerance.length and self.angle <= tolerance.angle


@dataclass(frozen=True)
class ChangesData:
    """What `diff` found between two robots.

    Attributes:
        a: name of the first robot.
        b: name of the second.
        changes: what changes the motion, its coordinates or their limits, down the tree.
        notes: what changed in the file although the motion is identical.
        displacement: how far apart the tips come; None where the two do not have the same coordinates, or no
            common tip.
        file: b's file, to which the changes' lines belong.
        fail_on: what of the notes is to fail: names of `pinscrew.changes.gates.GATES`.
        tolerance: within what things stand where they stood: what was allowed, but at least what rounding does.
    """

    a: str
    b: str
    changes: tuple[Change, ...]
    notes: tuple[Change, ...]
    displacement: Displacement | None
    file: str = ""
    fail_on: frozenset[str] = frozenset()
    tolerance: Tolerance = Tolerance(0.0, 0.0)

    @property
    def same(self) -> bool:
        """Whether both robots move alike: no changes."""
        return not self.changes
