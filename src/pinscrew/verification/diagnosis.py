"""Where two robots differ first, and how: joint by joint down the tree.

What the engines' parsers say of a joint comes first. Then both engines are asked for the pose of its child in its
parent and for the twist of the child against its parent per unit of each velocity. That is all there is to a joint,
so whatever makes two engines place or move links differently shows there, whichever parser or engine is to blame;
and since both are relative to the parent, no joint is blamed for one above it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pinscrew.description.model import Joint
from pinscrew.engines.base import Answers, Engine, JointView
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3, so3
from pinscrew.robot.robot import Robot
from pinscrew.verification import structure
from pinscrew.verification.configurations import sizes
from pinscrew.verification.outcome import Check
from pinscrew.verification.structure import Difference

__all__ = ["diagnose"]

MOST: Final = 5
"""Lines of a diagnosis."""
RIGID: Final = 1e-6
"""How far a pose may be from rigid for a rotation to be read off it."""


def diagnose(engines: tuple[Engine, Engine], failed: Sequence[Check], tolerance: float) -> tuple[Difference, ...]:
    """The first joints down the tree that the two engines read, place or move differently, in words.

    They are looked for at zero and, if all is alike there, where the first failed check has its largest error.
    """
    seen = structure.joint_differences(*engines)
    explained = {difference.joint for difference in seen if difference.what != "limits"}
    found = list(seen)
    numbers = [check for check in failed if check.tolerance > 0.0]
    if numbers and structure.same_coordinates(*engines):
        answered = _answered_differently(engines, numbers, tolerance, explained)
        if not answered and not explained:
            names = ", ".join(check.name for check in numbers)
            answered = [_answered("", f"every joint places and moves its child alike; what differs is: {names}")]
        found += answered
    if len(found) > MOST:
        found[MOST - 1 :] = [_answered("", f"… and {len(found) - MOST + 1} more differences")]
    return tuple(found)


def _answered_differently(
    engines: tuple[Engine, Engine], failed: Sequence[Check], tolerance: float, explained: set[str]
) -> list[Difference]:
    """Differences in the engines' answers, but for joints that the parsers' differences explain."""
    robot = engines[0].robot
    skipped = explained | _followers(engines[0].joints(), explained)
    found = _at(engines, robot.neutral, tolerance, skipped)
    place = next((check.place for check in failed if check.place.q), None)
    if not found and place is not None:
        ways = _at(engines, np.array(place.q), tolerance, skipped)
        found = [replace(way, words=f"at {place.configuration}, {way.words}") for way in ways]
    return found


def _answered(joint: str, words: str) -> Difference:
    return Difference(joint, "answers", words)


def _followers(joints: Mapping[str, JointView], masters: set[str]) -> set[str]:
    """The joints that mimic some of these, or mimic joints that do."""
    found = set(masters)
    more = True
    while more:
        new = {name for name, view in joints.items() if view.mimic is not None and view.mimic[0] in found}
        more = not new <= found
        found |= new
    return found - masters


@dataclass(frozen=True, slots=True)
class _Frame:
    """A frame as an engine's answers show it: its pose (4, 4) and body Jacobian (6, nv)."""

    pose: FloatArray
    J: FloatArray

    @classmethod
    def all(cls, answers: Answers, names: Sequence[str]) -> dict[str, _Frame]:
        return {name: cls(answers.poses[0, i], answers.jacobians["body"][0, i]) for i, name in enumerate(names)}

    def flaw(self) -> str:
        """What keeps a joint from being read off it, or ``""``."""
        if not (np.isfinite(self.pose).all() and np.isfinite(self.J).all()):
            return "has an answer that is not finite"
        R = self.pose[:3, :3]
        if abs(R.T @ R - np.eye(3)).max() > RIGID or np.linalg.det(R) < 0.0:
            return "has a pose that is no rigid motion"
        return ""

    def like(self, other: _Frame, near: _Near) -> bool:
        pose = abs(self.pose - other.pose)
        pose[:3, 3] /= near.length / near.angle
        return bool((pose <= near.angle).all() and (abs(self.J - other.J) <= near.twist[:, None]).all())


@dataclass(frozen=True, slots=True)
class _Near:
    """What counts as rounding, in metres and in radians."""

    length: float
    angle: float

    @property
    def twist(self) -> FloatArray:
        return np.repeat([self.length, self.angle], 3)


@dataclass(frozen=True, slots=True)
class _Seen:
    """A joint as an engine's answers show it.

    Attributes:
        T_parent_child: pose of the child link in the parent link, shape (4, 4).
        twists: twist (v, ω) of the child against the parent, in the child's frame, per velocity: shape (6, nv).
    """

    T_parent_child: FloatArray
    twists: FloatArray

    @classmethod
    def between(cls, parent: _Frame, child: _Frame) -> _Seen:
        T_parent_child = se3.inverse(parent.pose) @ child.pose
        return cls(T_parent_child, child.J - se3.adjoint(se3.inverse(T_parent_child)) @ parent.J)


def _at(engines: tuple[Engine, Engine], q: FloatArray, tolerance: float, skipped: set[str]) -> list[Difference]:
    """Differences at one configuration, down the tree."""
    a, b = engines
    robot = a.robot
    names = [name for name in robot.frame_names if name in b.robot.frame_names]
    frames = [_Frame.all(engine.answers(q[None], np.zeros((1, robot.nv)), names), names) for engine in engines]
    near = _Near(tolerance * float(sizes(robot, q[None])[0]), tolerance)
    flaws = [{name: frame.flaw() for name, frame in own.items()} for own in frames]
    alike = {name: frames[0][name].like(frames[1][name], near) for name in names}
    against = f"in {b.name}, compared with {a.name}"
    found = []
    if not alike.get(robot.base, True):
        found.append(_answered("", f"the base {robot.base!r} itself is placed or moved differently {against}"))
    for joint in robot.description.joints:
        # A child that is where it should be, below a parent that is not, shows that the joint is right.
        if joint.name in skipped or alike.get(joint.child, True) or joint.parent not in alike:
            continue
        if any(own[joint.parent] for own in flaws):
            continue
        if any(own[joint.child] for own in flaws):
            told = [
                f"{own[joint.child]} in {e.name}" for e, own in zip(engines, flaws, strict=True) if own[joint.child]
            ]
            ways = [f"its child {joint.child!r} {flaw}" for flaw in told]
        else:
            seen = [_Seen.between(own[joint.parent], own[joint.child]) for own in frames]
            ways = [f"{way} {against}" for way in _ways(joint, seen[0], seen[1], robot, near)]
        found += [_answered(joint.name, f"joint {joint.name!r}: {way}") for way in ways]
    return found


def _ways(joint: Joint, a: _Seen, b: _Seen, robot: Robot, near: _Near) -> list[str]:
    ways = _placed(a, b, near)
    moving_a, moving_b = (_moving(seen.twists, near) for seen in (a, b))
    if moving_a != moving_b:
        by_a, by_b = (_listed(robot.velocity_names[i] for i in sorted(moving)) for moving in (moving_a, moving_b))
        return [*ways, f"it is moved by {by_b} instead of {by_a}"]
    for i in sorted(moving_a):
        ways += _moved(a.twists[:, i], b.twists[:, i], near, free=joint.mimic is None)
    return ways


def _moving(twists: FloatArray, near: _Near) -> set[int]:
    return {int(i) for i in np.flatnonzero((abs(twists) > near.twist[:, None]).any(axis=0))}


def _placed(a: _Seen, b: _Seen, near: _Near) -> list[str]:
    """How the child's pose in its parent differs."""
    ways = []
    shift = b.T_parent_child[:3, 3] - a.T_parent_child[:3, 3]
    if np.linalg.norm(shift) > near.length:
        ways.append(f"its origin is moved by {_offset(shift, near)} mm ({np.linalg.norm(shift) * 1e3:.6g} mm)")
    turn = so3.log(so3.project(b.T_parent_child[:3, :3] @ a.T_parent_child[:3, :3].T))
    if np.linalg.norm(turn) > near.angle:
        ways.append(f"its frame is turned by {_angle(float(np.linalg.norm(turn)))} about {_direction(turn)}")
    return ways


def _moved(a: FloatArray, b: FloatArray, near: _Near, *, free: bool) -> list[str]:
    """How a twist of the child differs; both are in the child's frame. ``free`` joints move with their coordinate."""
    if (abs(a - b) <= near.twist).all():
        return []
    turns = [bool(np.linalg.norm(twist[3:]) > near.angle) for twist in (a, b)]
    if turns[0] != turns[1]:
        kinds = ["revolute" if turning else "prismatic" for turning in turns]
        return [f"it is {kinds[1]} instead of {kinds[0]}"]
    part = slice(3, 6) if turns[0] else slice(0, 3)
    u, w = a[part], b[part]
    size_a, size_b = float(np.linalg.norm(u)), float(np.linalg.norm(w))
    ways = []
    angle = math.atan2(float(np.linalg.norm(np.cross(u, w))), float(u @ w))
    flipped = angle > math.pi - 1e-6
    if abs(size_a - size_b) > near.angle:
        if free:
            ways.append(f"its axis is {size_b:.12g} long instead of {size_a:.12g}")
        else:
            back = ", the other way" * flipped
            return [f"it moves {size_b:.12g} times its coordinate instead of {size_a:.12g}{back}"]
    if flipped:
        ways.append("its axis is flipped")
    elif angle > near.angle:
        ways.append(f"its axis is turned by {_angle(angle)}")
    if turns[0] and not ways:
        ways += _shifted(a, b, near)
    return ways or ["it moves differently"]


def _shifted(a: FloatArray, b: FloatArray, near: _Near) -> list[str]:
    """How two turns with one ω differ: in the line they are about, or in the pitch along it."""
    ways = []
    points = [np.cross(twist[3:], twist[:3]) / (twist[3:] @ twist[3:]) for twist in (a, b)]
    pitches = [float(twist[3:] @ twist[:3] / (twist[3:] @ twist[3:])) for twist in (a, b)]
    offset = points[1] - points[0]
    if np.linalg.norm(offset) > near.length:
        ways.append(f"its axis is moved by {_offset(offset, near)} mm in the child's frame")
    if abs(pitches[1] - pitches[0]) > near.length:
        ways.append(f"its pitch is {pitches[1]:.6g} m/rad instead of {pitches[0]:.6g}")
    return ways


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names) or "nothing"


def _vector(values: NDArray[np.floating]) -> str:
    return f"[{', '.join(f'{value:.6g}' for value in values + 0.0)}]"


def _offset(shift: FloatArray, near: _Near) -> str:
    """Metres in millimetres, without what is rounding."""
    return _vector(np.where(abs(shift) > near.length, shift * 1e3, 0.0))


def _direction(vector: FloatArray) -> str:
    return _vector(np.round(vector / np.linalg.norm(vector), 6))


def _angle(angle: float) -> str:
    return f"{math.degrees(angle):.6g}° ({angle:.6g} rad)"
