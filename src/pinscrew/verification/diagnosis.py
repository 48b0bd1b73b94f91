"""Where two robots differ first, and how: read off the engines' answers at zero, joint by joint down the tree.

For each joint both engines are asked for the pose of its child in its parent and for the twist of the child against
its parent per unit of each velocity. That is all there is to a joint, so whatever makes two engines disagree at zero
shows here, whichever parser or engine is to blame.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pinscrew.engines.base import Answers, Engine
from pinscrew.lie import se3, so3
from pinscrew.typing import FloatArray

__all__ = ["diagnose"]

MOST: int = 5
"""Joints that a diagnosis names."""


@dataclass(frozen=True, slots=True)
class _Seen:
    """A joint as an engine's answers show it at zero.

    Attributes:
        T_parent_child: pose of the child link in the parent link, shape (4, 4).
        twists: twist (v, ω) of the child against the parent, in the child's frame, per velocity: shape (6, nv).
    """

    T_parent_child: FloatArray
    twists: FloatArray


def diagnose(engines: tuple[Engine, Engine], tolerance: float) -> tuple[str, ...]:
    """The first joints down the tree that the two engines place or move differently, in words."""
    a, b = engines
    robot = a.robot
    frames = [name for name in robot.frame_names if name in b.robot.frame_names]
    zero = robot.neutral[None], np.zeros((1, robot.nv))
    answers = {engine.name: engine.answers(*zero, frames) for engine in engines}
    at = {name: i for i, name in enumerate(frames)}
    scale = max(1.0, robot.reach)
    found: list[str] = []
    for joint in robot.description.joints:
        if joint.parent not in at or joint.child not in at:
            continue
        ends = at[joint.parent], at[joint.child]
        seen = [_see(answers[engine.name], *ends) for engine in engines]
        ways = _differences(seen[0], seen[1], robot.velocity_names, tolerance * scale)
        found += [f"joint {joint.name!r}: {way} in {b.name}, compared with {a.name}" for way in ways]
        if len(found) >= MOST:
            break
    if not found:
        found.append("at zero all joints are alike: the engines differ in how they move")
    return tuple(found)


def _see(answers: Answers, parent: int, child: int) -> _Seen:
    T_parent_child = se3.inverse(answers.poses[0, parent]) @ answers.poses[0, child]
    of_parent = se3.adjoint(se3.inverse(T_parent_child)) @ answers.jacobians["body"][0, parent]
    return _Seen(T_parent_child, answers.jacobians["body"][0, child] - of_parent)


def _differences(a: _Seen, b: _Seen, velocities: tuple[str, ...], tolerance: float) -> list[str]:
    ways = _placed(a, b, tolerance)
    moving_a, moving_b = (_moving(seen.twists, tolerance) for seen in (a, b))
    if moving_a != moving_b:
        names = [", ".join(velocities[i] for i in sorted(m)) or "nothing" for m in (moving_a, moving_b)]
        ways.append(f"is moved by {names[1]} instead of {names[0]}")
        return ways
    for i in sorted(moving_a):
        ways += _moved(a.twists[:, i], b.twists[:, i], tolerance)
    return ways


def _moving(twists: FloatArray, tolerance: float) -> set[int]:
    return {int(i) for i in np.flatnonzero(abs(twists).max(axis=0) > tolerance)}


def _placed(a: _Seen, b: _Seen, tolerance: float) -> list[str]:
    """How the child's pose in its parent differs."""
    ways = []
    shift = b.T_parent_child[:3, 3] - a.T_parent_child[:3, 3]
    if not np.linalg.norm(shift) <= tolerance:
        ways.append(f"its origin is moved by {_vector(shift * 1e3)} mm ({np.linalg.norm(shift) * 1e3:.6g} mm)")
    turn = so3.log(so3.project(b.T_parent_child[:3, :3] @ a.T_parent_child[:3, :3].T))
    if not np.linalg.norm(turn) <= tolerance:
        ways.append(f"its frame is turned by {_degrees(np.linalg.norm(turn))} about {_direction(turn)}")
    return ways


def _moved(a: FloatArray, b: FloatArray, tolerance: float) -> list[str]:
    """How a twist of the child differs; both are in the child's frame."""
    if (abs(a - b) <= tolerance).all():
        return []
    turns = [bool(np.linalg.norm(twist[3:]) > tolerance) for twist in (a, b)]
    if turns[0] != turns[1]:
        kinds = ["revolute" if turning else "prismatic" for turning in turns]
        return [f"it is {kinds[1]} instead of {kinds[0]}"]
    part = slice(3, 6) if turns[0] else slice(0, 3)
    u, w = a[part], b[part]
    size_a, size_b = np.linalg.norm(u), np.linalg.norm(w)
    ways = []
    if not abs(size_a - size_b) <= tolerance:
        ways.append(f"it moves {size_b:.12g} times its coordinate instead of {size_a:.12g}")
    angle = math.atan2(float(np.linalg.norm(np.cross(u, w))), float(u @ w))
    if angle > math.pi - 1e-6:
        ways.append("its axis is flipped")
    elif angle > tolerance:
        ways.append(f"its axis is turned by {_degrees(angle)}")
    if turns[0] and not ways:
        # The same direction through another point: the offset is across the axis.
        offset = np.cross(w, b[:3]) / size_b**2 - np.cross(u, a[:3]) / size_a**2
        ways.append(f"its axis is moved by {_vector(offset * 1e3)} mm in the child's frame")
    return ways or ["it moves differently"]


def _vector(values: NDArray[np.floating]) -> str:
    return f"[{', '.join(f'{value:.6g}' for value in values + 0.0)}]"


def _direction(vector: FloatArray) -> str:
    return _vector(np.round(vector / np.linalg.norm(vector), 6))


def _degrees(angle: float | np.floating) -> str:
    return f"{math.degrees(angle):.6g}°"
