"""Where a joint stands in two robots, and what it carries, measured."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from pinscrew.changes.differences import (
    AxisMoved,
    CarriedMoved,
    Difference,
    FrameChosen,
    FrameMoved,
    OneSided,
    TypeChanged,
    ZeroShifted,
)
from pinscrew.changes.geometry import Move, Poses, common_locus, displacement, locus, seen_from
from pinscrew.changes.matching import JointPair
from pinscrew.changes.outcome import Tolerance
from pinscrew.changes.walk import Crossing
from pinscrew.description.model import Joint
from pinscrew.ground.typing import FloatArray

__all__ = ["Placed", "Placing"]

REVERSED: Final = 0.1
"""How near (rad) to a half-turn an axis is called reversed, and not turned."""


@dataclass(frozen=True)
class Placed:
    """Where a joint of both robots stands.

    Attributes:
        difference: what was done to that, if anything.
        reversed: whether its axis points the other way.
        zero: by how much its zero is shifted: in b it stands at a value where it stands in a at ``value + zero``.
    """

    difference: Difference | None
    reversed: bool = False
    zero: float = 0.0


class Placing:
    """Measures where one joint stands, and what it carries.

    All of a is carried along by the displacement D above the joint: only what the joint adds to that is its own.
    """

    def __init__(self, pair: JointPair, crossing: Crossing, a: Poses, b: Poses, tolerance: Tolerance) -> None:
        self._pair, self._crossing, self._a, self._b, self._tolerance = pair, crossing, a, b, tolerance

    def one_sided(self) -> Difference:
        """A joint that only one of the robots has."""
        pair, joint, added = self._pair, self._pair.named, self._pair.a is None
        word = "added" if added else "removed"
        carried = None
        if self._crossing.carried:
            parent = self._a.links[pair.link_a if added else joint.parent]
            carried = self._carried(parent, parent[:3, 3])
        if joint.type != "fixed" or carried is not None:
            return OneSided(f"joint-{word}", pair, carried)
        if not added and joint.child in self._a.tips and joint.child not in self._b.links:
            return OneSided("tip-removed", pair, None)
        return OneSided(f"frame-{word}", pair, None, tip=added and joint.child in self._b.tips)

    def both(self, joint: Joint, now: Joint) -> Placed:
        """A joint that both robots have: ``joint`` in a, ``now`` in b."""
        pair, crossing = self._pair, self._crossing
        if locus(joint) != locus(now):
            carried = self._carried_of(joint) if crossing.carried else None
            return Placed(TypeChanged("type", pair, carried, joint.type, now.type))
        if common_locus(pair) and not crossing.own:
            return Placed(self._frame_moved(joint)) if common_locus(pair) == "pose" else self._axis(joint, now)
        # The screw of a mimic joint is the same with a reversed axis, if its multiplier is reversed too.
        back = bool(common_locus(pair)) and self._axis_move(joint, now).angle > 0.5 * math.pi
        if crossing.carried:
            return replace(self._zero_or_carried(joint), reversed=back)
        return Placed(self._own_frame(joint), reversed=back)

    # ------------------------------------------------------------------------------------ moves

    def _frame_name(self) -> str:
        """The link in whose frame displacements are told: the parent, by its name in b."""
        return self._pair.b.parent if self._pair.b else self._pair.link_b

    def _carried(self, T_base_parent: FloatArray, point: FloatArray) -> Move:
        """How what is below is displaced beside what is above, ``D_out D_in⁻¹``; frame and point are a's."""
        D = self._crossing.D_in
        X = displacement(D, self._crossing.D_out)
        return seen_from(D @ T_base_parent, X, D[:3, :3] @ point + D[:3, 3], self._frame_name())

    def _carried_of(self, joint: Joint) -> Move:
        return self._carried(self._a.links[joint.parent], self._origin(joint))

    def _origin(self, joint: Joint) -> FloatArray:
        origin: FloatArray = self._a.joints[joint.name][:3, 3]
        return origin

    def _axis_move(self, joint: Joint, now: Joint, sign: float = 1.0) -> Move:
        """How a's axis has to turn, and a's origin to move across it, to get to b's axis, in a's parent link.

        The shortest turn from u to w is about ``u × w``, by ``atan2(‖u × w‖, u·w)``. Of the way between the origins,
        what is along the axis does not count: ``s - w (w·s)``.
        """
        D = self._crossing.D_in
        R_parent = (D @ self._a.links[joint.parent])[:3, :3]
        u, w = D[:3, :3] @ self._a.direction(joint), sign * self._b.direction(now)
        normal = np.cross(u, w)
        sine = float(np.linalg.norm(normal))
        turn = normal * (math.atan2(sine, float(u @ w)) / sine) if sine else np.zeros(3)
        if not sine and u @ w < 0.0:  # a half-turn about any axis across
            across = np.cross(u, np.eye(3)[abs(u).argmin()])
            turn = across * (math.pi / np.linalg.norm(across))
        offset = self._b.joints[now.name][:3, 3] - (D[:3, :3] @ self._origin(joint) + D[:3, 3])
        shift = offset - w * (w @ offset) if locus(now) == "line" else np.zeros(3)
        return Move(R_parent.T @ shift, R_parent.T @ turn, self._frame_name())

    # ------------------------------------------------------------------------------------ differences

    def _frame_moved(self, joint: Joint) -> Difference:
        """A floating or planar joint, whose coordinates are about its frame."""
        D = self._crossing.D_in
        T = D @ self._a.joints[joint.name]
        X = displacement(T, self._b.joints[self._pair.named.name])
        move = seen_from(D @ self._a.links[joint.parent], X, T[:3, 3], self._frame_name())
        return FrameMoved("frame-moved", self._pair, move, along=self._crossing.carried)

    def _axis(self, joint: Joint, now: Joint) -> Placed:
        """A joint whose axis is another line or direction."""
        tolerance, axis = self._tolerance, self._axis_move(joint, now)
        carried = self._carried_of(joint) if self._crossing.carried else None
        if carried is not None and self._crossing.rigid:
            kind = "axis-turned" if axis.angle > tolerance.angle else "axis-moved"
            return Placed(AxisMoved(kind, self._pair, carried, rigid=True))
        follows = None if carried is None or carried.within(tolerance) else carried
        if math.pi - axis.angle <= REVERSED:
            rest = self._axis_move(joint, now, sign=-1.0)
            return Placed(AxisMoved("axis-reversed", self._pair, rest, follows=follows), reversed=True)
        kind = "axis-turned" if axis.angle > tolerance.angle else "axis-moved"
        return Placed(AxisMoved(kind, self._pair, axis, follows=follows))

    def _zero_or_carried(self, joint: Joint) -> Placed:
        """A joint that moves as before, or is fixed, with what it carries displaced."""
        tolerance, move = self._tolerance, self._carried_of(joint)
        # The axis in the parent's frame, in which the move is too.
        axis = self._a.links[joint.parent][:3, :3].T @ self._a.direction(joint)
        if locus(joint) == "line" and move.length <= tolerance.length and move.angle > tolerance.angle:
            about = float(axis @ move.turn)
            if np.linalg.norm(move.turn - axis * about) <= tolerance.angle:
                return Placed(ZeroShifted("zero-shifted", self._pair, about), zero=about)
        if locus(joint) == "direction" and move.angle <= tolerance.angle and move.length > tolerance.length:
            along = float(axis @ move.shift)
            if np.linalg.norm(move.shift - axis * along) <= tolerance.length:
                return Placed(ZeroShifted("zero-shifted", self._pair, along), zero=along)
        tip = self._pair.link_a in self._a.tips or self._pair.link_b in self._b.tips
        return Placed(CarriedMoved("tip-moved" if tip else "link-moved", self._pair, move))

    def _own_frame(self, joint: Joint) -> Difference | None:
        """The link's frame where all else stands as before: a tip that alone is displaced, or one chosen anew."""
        D, tolerance = self._crossing.D_out, self._tolerance
        T, now = D @ self._a.links[self._pair.link_a], self._b.links[self._pair.link_b]
        if np.array_equal(T, now):  # most frames of most robots
            return None
        move = seen_from(T, displacement(T, now), T[:3, 3], self._pair.link_b)
        if self._crossing.lost:
            return CarriedMoved("tip-moved", self._pair, move, alone=True)
        if move.within(tolerance):
            return None
        slid = locus(joint) == "direction"
        if locus(joint) == "line":
            u = D[:3, :3] @ self._a.direction(joint)
            off_axis = np.cross(u, now[:3, 3] - (D[:3, :3] @ self._origin(joint) + D[:3, 3]))
            slid = float(np.linalg.norm(off_axis)) <= tolerance.length
        kind = "origin-slid" if slid and move.angle <= tolerance.angle else "frame-re-expressed"
        return FrameChosen(kind, self._pair, move)
