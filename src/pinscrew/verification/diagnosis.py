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
from pinscrew.verification.configurations import sizes, speeds
from pinscrew.verification.outcome import Check
from pinscrew.verification.structure import EngineDifference

__all__ = ["diagnose"]

MOST: Final = 5
"""Lines of a diagnosis."""
RIGID: Final = 1e-6
"""How far a pose may be from rigid for a rotation to be read off it."""


def diagnose(engines: tuple[Engine, Engine], failed: Sequence[Check], tolerance: float) -> tuple[EngineDifference, ...]:
    """The first joints down the tree that the two engines read, place or move differently, in words.

    They are looked for at zero and, if all is alike there, where the first failed check has its largest error.
    """
    read = structure.joint_differences(*engines)
    explained = {difference.joint for difference in read if difference.aspect != "limits"}
    differences = list(read)
    numbers = [check for check in failed if check.tolerance > 0.0]
    if numbers and structure.same_coordinates(*engines):
        answered = _answered_differently(engines, numbers, tolerance, explained)
        if not answered and not explained:
            names = ", ".join(check.name for check in numbers)
            answered = [_answered("", f"every joint places and moves its child alike; what differs is: {names}")]
        differences += answered
    if len(differences) > MOST:
        differences[MOST - 1 :] = [_answered("", f"… and {len(differences) - MOST + 1} more differences")]
    return tuple(differences)


def _answered_differently(
    engines: tuple[Engine, Engine], failed: Sequence[Check], tolerance: float, explained: set[str]
) -> list[EngineDifference]:
    """Differences in the engines' answers, but for joints that the parsers' differences explain."""
    robot = engines[0].robot
    skipped = explained | _followers(engines[0].joints(), explained)
    differences = _at(engines, robot.neutral, tolerance, skipped)
    place = next((check.place for check in failed if check.place.q), None)
    if not differences and place is not None:
        there = _at(engines, np.array(place.q), tolerance, skipped)
        differences = [
            replace(difference, words=f"at {place.configuration}, {difference.words}") for difference in there
        ]
    return differences


def _answered(joint: str, words: str) -> EngineDifference:
    return EngineDifference(joint, "answers", words)


def _followers(joints: Mapping[str, JointView], masters: set[str]) -> set[str]:
    """The joints that mimic some of these, or mimic joints that do."""
    followers = set(masters)
    more = True
    while more:
        new = {name for name, view in joints.items() if view.mimic is not None and view.mimic[0] in followers}
        more = not new <= followers
        followers |= new
    return followers - masters


@dataclass(frozen=True, slots=True)
class _AnsweredFrame:
    """A frame as an engine's answers show it: its pose (4, 4) and body Jacobian (6, nv)."""

    pose: FloatArray
    J: FloatArray

    @classmethod
    def all(cls, answers: Answers, names: Sequence[str]) -> dict[str, _AnsweredFrame]:
        return {name: cls(answers.poses[0, i], answers.jacobians["body"][0, i]) for i, name in enumerate(names)}

    def flaw(self) -> str:
        """What keeps a joint from being read off it, or ``""``."""
        if not (np.isfinite(self.pose).all() and np.isfinite(self.J).all()):
            return "has an answer that is not finite"
        R = self.pose[:3, :3]
        if abs(R.T @ R - np.eye(3)).max() > RIGID or np.linalg.det(R) < 0.0:
            return "has a pose that is no rigid motion"
        return ""

    def like(self, other: _AnsweredFrame, rounding: _Rounding) -> bool:
        pose = abs(self.pose - other.pose)
        pose[:3, 3] /= rounding.length / rounding.angle
        return bool((pose <= rounding.angle).all() and (abs(self.J - other.J) <= rounding.twist[:, None]).all())


@dataclass(frozen=True, slots=True)
class _Rounding:
    """What counts as rounding, in metres and in radians."""

    length: float
    angle: float

    @property
    def twist(self) -> FloatArray:
        return np.repeat([self.length, self.angle], 3)


@dataclass(frozen=True, slots=True)
class _JointMotion:
    """A joint as an engine's answers show it.

    Attributes:
        T_parent_child: pose of the child link in the parent link, shape (4, 4).
        twists: twist (v, ω) of the child against the parent, in the child's frame, per velocity: shape (6, nv).
    """

    T_parent_child: FloatArray
    twists: FloatArray

    @classmethod
    def between(cls, parent: _AnsweredFrame, child: _AnsweredFrame) -> _JointMotion:
        T_parent_child = se3.inverse(parent.pose) @ child.pose
        return cls(T_parent_child, child.J - se3.adjoint(se3.inverse(T_parent_child)) @ parent.J)


def _at(engines: tuple[Engine, Engine], q: FloatArray, tolerance: float, skipped: set[str]) -> list[EngineDifference]:
    """Differences at one configuration, down the tree."""
    a, b = engines
    robot = a.robot
    names = [name for name in robot.frame_names if name in b.robot.frame_names]
    frames = [_AnsweredFrame.all(engine.answers(q[None], np.zeros((1, robot.nv)), names), names) for engine in engines]
    tolerance *= float(speeds(robot).max(initial=1.0))
    rounding = _Rounding(tolerance * float(sizes(robot, q[None])[0]), tolerance)
    flaws = [{name: frame.flaw() for name, frame in own.items()} for own in frames]
    alike = {name: frames[0][name].like(frames[1][name], rounding) for name in names}
    against = f"in {b.name}, compared with {a.name}"
    differences = []
    if not alike.get(robot.base, True):
        differences.append(_answered("", f"the base {robot.base!r} itself is placed or moved differently {against}"))
    for joint in robot.description.joints:
        # A child that is where it should be, below a parent that is not, shows that the joint is right.
        if joint.name in skipped or alike.get(joint.child, True) or joint.parent not in alike:
            continue
        if any(own[joint.parent] for own in flaws):
            continue
        if any(own[joint.child] for own in flaws):
            flawed = [
                f"{own[joint.child]} in {e.name}" for e, own in zip(engines, flaws, strict=True) if own[joint.child]
            ]
            ways = [f"its child {joint.child!r} {flaw}" for flaw in flawed]
        else:
            motions = [_JointMotion.between(own[joint.parent], own[joint.child]) for own in frames]
            ways = [f"{way} {against}" for way in _ways(joint, motions[0], motions[1], robot, rounding)]
        differences += [_answered(joint.name, f"joint {joint.name!r}: {way}") for way in ways]
    return differences


def _ways(joint: Joint, a: _JointMotion, b: _JointMotion, robot: Robot, rounding: _Rounding) -> list[str]:
    ways = _placed(a, b, rounding)
    moving_a, moving_b = (_moving(motion.twists, rounding) for motion in (a, b))
    if moving_a != moving_b:
        by_a, by_b = (_listed(robot.velocity_names[i] for i in sorted(moving)) for moving in (moving_a, moving_b))
        return [*ways, f"it is moved by {by_b} instead of {by_a}"]
    for i in sorted(moving_a):
        ways += _moved(a.twists[:, i], b.twists[:, i], rounding, free=joint.mimic is None)
    return ways


def _moving(twists: FloatArray, rounding: _Rounding) -> set[int]:
    return {int(i) for i in np.flatnonzero((abs(twists) > rounding.twist[:, None]).any(axis=0))}


def _placed(a: _JointMotion, b: _JointMotion, rounding: _Rounding) -> list[str]:
    """How the child's pose in its parent differs."""
    ways = []
    shift = b.T_parent_child[:3, 3] - a.T_parent_child[:3, 3]
    if np.linalg.norm(shift) > rounding.length:
        ways.append(f"its origin is moved by {_offset(shift, rounding)} mm ({np.linalg.norm(shift) * 1e3:.6g} mm)")
    turn = so3.log(so3.project(b.T_parent_child[:3, :3] @ a.T_parent_child[:3, :3].T))
    if np.linalg.norm(turn) > rounding.angle:
        ways.append(f"its frame is turned by {_angle(float(np.linalg.norm(turn)))} about {_direction(turn)}")
    return ways


def _moved(a: FloatArray, b: FloatArray, rounding: _Rounding, *, free: bool) -> list[str]:
    """How a twist of the child differs; both are in the child's frame. ``free`` joints move with their coordinate."""
    if (abs(a - b) <= rounding.twist).all():
        return []
    turns = [bool(np.linalg.norm(twist[3:]) > rounding.angle) for twist in (a, b)]
    if turns[0] != turns[1]:
        kinds = ["revolute" if turning else "prismatic" for turning in turns]
        return [f"it is {kinds[1]} instead of {kinds[0]}"]
    part = slice(3, 6) if turns[0] else slice(0, 3)
    u, w = a[part], b[part]
    size_a, size_b = float(np.linalg.norm(u)), float(np.linalg.norm(w))
    ways = []
    angle = math.atan2(float(np.linalg.norm(np.cross(u, w))), float(u @ w))
    flipped = angle > math.pi - 1e-6
    if abs(size_a - size_b) > rounding.angle:
        if free:
            ways.append(f"its axis is {size_b:.12g} long instead of {size_a:.12g}")
        else:
            back = ", the other way" * flipped
            return [f"it moves {size_b:.12g} times its coordinate instead of {size_a:.12g}{back}"]
    if flipped:
        ways.append("its axis is flipped")
    elif angle > rounding.angle:
        ways.append(f"its axis is turned by {_angle(angle)}")
    if turns[0] and not ways:
        ways += _shifted(a, b, rounding)
    return ways or ["it moves differently"]


def _shifted(a: FloatArray, b: FloatArray, rounding: _Rounding) -> list[str]:
    """How two turns with one ω differ: in the line they are about, or in the pitch along it."""
    ways = []
    points = [np.cross(twist[3:], twist[:3]) / (twist[3:] @ twist[3:]) for twist in (a, b)]
    pitches = [float(twist[3:] @ twist[:3] / (twist[3:] @ twist[3:])) for twist in (a, b)]
    offset = points[1] - points[0]
    if np.linalg.norm(offset) > rounding.length:
        ways.append(f"its axis is moved by {_offset(offset, rounding)} mm in the child's frame")
    if abs(pitches[1] - pitches[0]) > rounding.length:
        ways.append(f"its pitch is {pitches[1]:.6g} m/rad instead of {pitches[0]:.6g}")
    return ways


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names) or "nothing"


def _vector(values: NDArray[np.floating]) -> str:
    return f"[{', '.join(f'{value:.6g}' for value in values + 0.0)}]"


def _offset(shift: FloatArray, rounding: _Rounding) -> str:
    """Metres in millimetres, without what is rounding."""
    return _vector(np.where(abs(shift) > rounding.length, shift * 1e3, 0.0))


def _direction(vector: FloatArray) -> str:
    return _vector(np.round(vector / np.linalg.norm(vector), 6))


def _angle(angle: float) -> str:
    return f"{math.degrees(angle):.6g}° ({angle:.6g} rad)"
