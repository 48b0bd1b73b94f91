"""What was done to where a joint stands, in words: what the way down met there, as changes and notes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

import numpy as np

from pinscrew.changes.geometry import Poses, apart, between, displaced, kind, motion_of
from pinscrew.changes.matching import Step
from pinscrew.changes.outcome import Change, Near
from pinscrew.changes.walk import Met
from pinscrew.changes.wording import degrees, millimetres, moved
from pinscrew.description.model import Joint
from pinscrew.ground.typing import FloatArray

__all__ = ["Placement", "Tips", "placement"]

REVERSED: Final = 0.1
"""How near (rad) to a half-turn an axis is called reversed, and not turned."""


Tips: TypeAlias = tuple[frozenset[str], frozenset[str]]
"""The leaf links of a and of b."""


@dataclass(frozen=True)
class Placement:
    """What was done to where a joint stands.

    Attributes:
        changes: of the motion.
        notes: without one.
        reversed: whether its axis points the other way.
        zero: by how much its zero is shifted: in b it stands at a value where it stands in a at ``value + zero``.
    """

    changes: tuple[Change, ...] = ()
    notes: tuple[Change, ...] = ()
    reversed: bool = False
    zero: float = 0.0


def placement(step: Step, met: Met, a: Poses, b: Poses, tips: Tips, near: Near) -> Placement:
    """What was done at a step."""
    told = _Told(step, met, a, b, tips, near)
    if step.a is None or step.b is None:
        return told.one_sided(step.named, added=step.a is None)
    return told.both(step.a, step.b)


class _Told:
    def __init__(self, step: Step, met: Met, a: Poses, b: Poses, tips: Tips, near: Near) -> None:
        self._step, self._met, self._a, self._b, self._tips, self._near = step, met, a, b, tips, near
        self._tip = step.link_a in tips[0] or step.link_b in tips[1]

    def one_sided(self, joint: Joint, *, added: bool) -> Placement:
        """A joint that only one of the robots has."""
        word = "added" if added else "removed"
        words = f"joint {joint.name!r} ({joint.type}) is {word} between links {joint.parent!r} and {joint.child!r}"
        carried, length, angle = "", 0.0, 0.0
        if self._met.carried:
            parent = self._a.links[self._step.link_a if added else joint.parent]
            how, length, angle = self._carried(parent, parent[:3, 3])
            carried = f"; what follows is {how}, in the frame of {self._frame_name()!r}"
        if joint.type != "fixed" or self._met.carried:
            change = self._change(f"joint-{word}", words + carried, length, angle)
            return Placement(changes=(change,))
        if not added and joint.child in self._tips[0] and joint.child not in self._b.links:
            return Placement(changes=(self._change("tip-removed", f"{words}: a tip frame is gone"),))
        note = self._change(f"frame-{word}", f"{words}; the motion is the same")
        return Placement(notes=(replace(note, tip=added and joint.child in self._tips[1]),))

    def both(self, joint: Joint, now: Joint) -> Placement:
        """A joint that both robots have."""
        if kind(joint) != kind(now):
            return self._other_type(joint, now)
        if motion_of(self._step) == "pose" and not self._met.own:
            return self._frame_moved(joint)
        if motion_of(self._step) and not self._met.own:
            return self._axis(joint, now)
        # The screw of a mimic joint is the same with a reversed axis, if its multiplier is reversed too.
        back = bool(motion_of(self._step)) and float(np.linalg.norm(self._line(joint, now)[0])) > 1.0
        if self._met.carried:
            return replace(self._zero_or_carried(joint), reversed=back)
        return Placement(tuple(self._tip_lost()), tuple(self._reexpressed(joint)), reversed=back)

    # ------------------------------------------------------------------------------------------ sentences

    def _change(self, word: str, words: str, length: float = 0.0, angle: float = 0.0) -> Change:
        step = self._step
        link = step.link_b if step.b else step.link_a
        line, file = (step.b.line, step.b.file) if step.b else (None, "")
        return Change(word, step.named.name, link, words, length, angle, line, file)

    def _frame_name(self) -> str:
        """The link in whose frame displacements are told: the parent, by its name in b."""
        return self._step.b.parent if self._step.b else self._step.link_b

    def _carried(self, T_base_parent: FloatArray, point: FloatArray) -> tuple[str, float, float]:
        """How what is below is displaced, with length and angle; frame and point are a's."""
        D = self._met.D_in
        X = between(D, self._met.D_out)
        shift, turn = displaced(X, D @ T_base_parent, D[:3, :3] @ point + D[:3, 3])
        words = moved(shift, turn, length=self._near.length, angle=self._near.angle)
        return words, float(np.linalg.norm(shift)), float(np.linalg.norm(turn))

    def _parent(self, joint: Joint) -> FloatArray:
        return self._a.links[joint.parent]

    def _origin(self, joint: Joint) -> FloatArray:
        origin: FloatArray = self._a.joints[joint.name][:3, 3]
        return origin

    def _other_type(self, joint: Joint, now: Joint) -> Placement:
        words = f"joint {now.name!r}: it is {now.type} instead of {joint.type}"
        length = angle = 0.0
        if self._met.carried:
            how, length, angle = self._carried(self._parent(joint), self._origin(joint))
            words += f"; what follows is {how}, in the frame of {self._frame_name()!r}"
        return Placement(changes=(self._change("type", words, length, angle),))

    def _frame_moved(self, joint: Joint) -> Placement:
        """A floating or planar joint, whose coordinates are about its frame."""
        D, T = self._met.D_in, self._a.joints[joint.name]
        X = between(D @ T, self._b.joints[self._step.named.name])
        shift, turn = displaced(X, D @ self._parent(joint), (D @ T)[:3, 3])
        how = moved(shift, turn, length=self._near.length, angle=self._near.angle)
        words = f"joint {self._step.named.name!r}: the frame that it moves in is {how}, in the frame of "
        words += f"{self._frame_name()!r}; what follows {'goes along' if self._met.carried else 'stays'}"
        lengths = float(np.linalg.norm(shift)), float(np.linalg.norm(turn))
        return Placement(changes=(self._change("frame-moved", words, *lengths),))

    def _axis(self, joint: Joint, now: Joint) -> Placement:
        """A joint whose axis is another line or direction."""
        near, name = self._near, now.name
        inside = f", in the frame of {self._frame_name()!r}"
        if self._met.carried and self._met.rigid:
            how, length, angle = self._carried(self._parent(joint), self._origin(joint))
            turned, _ = self._line(joint, now)
            word = "axis-turned" if float(np.linalg.norm(turned)) > near.angle else "axis-moved"
            words = f"joint {name!r}: its axis is {how}{inside}; what follows goes along"
            return Placement(changes=(self._change(word, words, length, angle),))
        turn, shift = self._line(joint, now)
        angle, length = float(np.linalg.norm(turn)), float(np.linalg.norm(shift))
        back = math.pi - angle <= REVERSED
        if back:
            turn, shift = self._line(joint, now, sign=-1.0)
            angle = float(np.linalg.norm(turn))
        parts = ["reversed: its coordinate has the other sign"] if back else []
        if angle > near.angle or length > near.length or not parts:
            parts.append(moved(shift, turn, length=near.length, angle=near.angle) + inside)
        follows = "what follows stays"
        if self._met.carried:
            follows = f"what follows is {self._carried(self._parent(joint), self._origin(joint))[0]}"
        words = f"joint {name!r}: its axis is {', and '.join(parts)}; {follows}"
        word = "axis-reversed" if back else "axis-turned" if angle > near.angle else "axis-moved"
        return Placement(changes=(self._change(word, words, length, angle),), reversed=back)

    def _line(self, joint: Joint, now: Joint, sign: float = 1.0) -> tuple[FloatArray, FloatArray]:
        """How a's axis has to turn and a's origin to move to get to b's axis, in the frame of a's parent link."""
        D = self._met.D_in
        R_parent = (D @ self._parent(joint))[:3, :3]
        u, w = D[:3, :3] @ self._a.direction(joint), sign * self._b.direction(now)
        normal = np.cross(u, w)
        sine = float(np.linalg.norm(normal))
        turn = normal * (math.atan2(sine, float(u @ w)) / sine) if sine else np.zeros(3)
        if not sine and u @ w < 0.0:  # any axis across will do
            across = np.cross(u, np.eye(3)[abs(u).argmin()])
            turn = across * (math.pi / np.linalg.norm(across))
        offset = self._b.joints[now.name][:3, 3] - (D[:3, :3] @ self._origin(joint) + D[:3, 3])
        shift = offset - w * (w @ offset) if kind(now) == "line" else np.zeros(3)
        return R_parent.T @ turn, R_parent.T @ shift

    def _zero_or_carried(self, joint: Joint) -> Placement:
        """A joint that moves as before, or is fixed, with what it carries displaced."""
        near, step = self._near, self._step
        name, link = step.named.name, step.link_b
        X = between(self._met.D_in, self._met.D_out)
        D = self._met.D_in
        point = D[:3, :3] @ self._origin(joint) + D[:3, 3]
        shift, turn = displaced(X, D @ self._parent(joint), point)
        axis = (D @ self._parent(joint))[:3, :3].T @ D[:3, :3] @ self._a.direction(joint)
        length, angle = float(np.linalg.norm(shift)), float(np.linalg.norm(turn))
        about = np.linalg.norm(turn - axis * (axis @ turn)) <= near.angle < angle
        if kind(joint) == "line" and about and length <= near.length:
            zero = float(axis @ turn)
            words = f"joint {name!r}: its zero is shifted by {degrees(zero)} about its axis"
            return Placement(changes=(self._change("zero-shifted", words, 0.0, angle),), zero=zero)
        along = np.linalg.norm(shift - axis * (axis @ shift)) <= near.length < length
        if kind(joint) == "direction" and along and angle <= near.angle:
            zero = float(axis @ shift)
            words = f"joint {name!r}: its zero is shifted by {millimetres(zero)} along its axis"
            return Placement(changes=(self._change("zero-shifted", words, length, 0.0),), zero=zero)
        how = moved(shift, turn, length=near.length, angle=near.angle)
        what = f"tip frame {link!r}" if self._tip else f"link {link!r}, with what follows,"
        fixed = "fixed joint" if joint.type == "fixed" else "joint"
        stays = "" if joint.type == "fixed" else "; its axis stays"
        words = f"{fixed} {name!r}: {what} is {how}, in the frame of {self._frame_name()!r}{stays}"
        word = "tip-moved" if self._tip else "link-moved"
        return Placement(changes=(self._change(word, words, length, angle),))

    def _tip_lost(self) -> Iterator[Change]:
        """A tip that has something below it, and alone is displaced."""
        if self._met.lost:
            how, length, angle = self._frame(self._step.link_a)
            words = f"joint {self._step.named.name!r}: tip frame {self._step.link_b!r} is {how}, in its own frame"
            yield self._change("tip-moved", f"{words}; what follows stays", length, angle)

    def _reexpressed(self, joint: Joint) -> Iterator[Change]:
        """The frame of a link that was chosen anew, without a change of the motion."""
        near, step = self._near, self._step
        far, turned = apart(self._met.D_out @ self._a.links[step.link_a], self._b.links[step.link_b])
        if self._met.lost or (far <= near.length and turned <= near.angle):
            return
        how, length, angle = self._frame(step.link_a)
        name = step.named.name
        slid = turned <= near.angle and (
            kind(joint) == "direction" or (kind(joint) == "line" and self._along(joint) <= near.length)
        )
        if slid:
            words = f"joint {name!r}: its origin is slid by {millimetres(length)}"
            words += " along its axis" if kind(joint) == "line" else ", which its motion does not depend on"
            yield self._change("origin-slid", f"{words}; the motion is the same", length)
            return
        words = f"link {step.link_b!r}: its frame is {how}, in its own frame; the motion is the same"
        yield self._change("frame-re-expressed", words, length, angle)

    def _frame(self, link_a: str) -> tuple[str, float, float]:
        """How the frame of the link that the step leads to is displaced against D, in that frame."""
        T = self._met.D_out @ self._a.links[link_a]
        shift, turn = displaced(between(T, self._b.links[self._step.link_b]), T, T[:3, 3])
        how = moved(shift, turn, length=self._near.length, angle=self._near.angle)
        return how, float(np.linalg.norm(shift)), float(np.linalg.norm(turn))

    def _along(self, joint: Joint) -> float:
        """How far off its axis a joint's origin is displaced against D."""
        D = self._met.D_out
        shift = self._b.links[self._step.link_b][:3, 3] - (D[:3, :3] @ self._origin(joint) + D[:3, 3])
        u = D[:3, :3] @ self._a.direction(joint)
        return float(np.linalg.norm(np.cross(u, shift)))
