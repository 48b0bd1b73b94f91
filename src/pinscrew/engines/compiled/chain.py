"""The product of exponentials with the fewest multiplications: every joint turns or slides along z of its own frame.

With B_k a frame whose z axis is the axis of joint k at zero, e^{ξ_k θ_k} = B_k Z(θ_k) B_k⁻¹, so

    T = e^{ξ_1 θ_1} … e^{ξ_n θ_n} M = B_1 Z(θ_1) (B_1⁻¹ B_2) Z(θ_2) … Z(θ_n) (B_n⁻¹ M).

Turning B_k about its axis and sliding it along it are free. They are chosen, as by Denavit and Hartenberg, so that
each constant factor is Rz(φ) Trans(t) Rx(α), most often with a zero in t; φ then joins the joint's own turn.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from pinscrew.ground.typing import FloatArray, JacobianKind
from pinscrew.lie import se3
from pinscrew.robot.mechanism import JointMotion
from pinscrew.robot.robot import Robot

__all__ = ["LARGEST_ANGLE", "Chain", "Part", "Question", "Step", "chain_to"]

Part: TypeAlias = Literal["all", "translation", "rotation"]

LARGEST_ANGLE: Final = 1e5
"""Up to which the range reduction of `lanes.Lanes.turn` is exact to rounding."""
ROUNDING: Final = 4e-16
"""A constant this near to 0 or ±1 (a length: for the size of the robot) is that: what is left of cos(π/2), say."""
SKEW: Final = 0.1
"""Sine of the angle between axes from which their common normal is well determined."""


@dataclass(frozen=True, slots=True)
class Question:
    """What is asked of each frame.

    Attributes:
        poses: whether its pose.
        kind: which Jacobian, or None.
        part: of which rows of the Jacobian the manipulability, or None.
    """

    poses: bool = False
    kind: JacobianKind | None = None
    part: Part | None = None

    def shapes(self, nv: int) -> list[tuple[int, ...]]:
        """The shapes of the parts of the answer about one frame, of those that are asked for."""
        parts: list[tuple[tuple[int, ...], Any]] = [((4, 4), self.poses), ((6, nv), self.kind), ((), self.part)]
        return [shape for shape, asked in parts if asked]


@dataclass(frozen=True, slots=True)
class Step:
    """A joint of a chain, and the constant motion to the next joint or to the frame.

    Attributes:
        motion: the joint: its coordinate, multiplier and column.
        turn: (cos φ, sin φ).
        shift: the translation after that turn.
        tilt: (cos α, sin α) of the turn about x after that.
    """

    motion: JointMotion
    turn: tuple[float, float]
    shift: tuple[float, float, float]
    tilt: tuple[float, float]

    @property
    def turns(self) -> bool:
        """Whether the joint turns about its axis; it slides along it otherwise."""
        return self.motion.joint.type != "prismatic"


@dataclass(frozen=True, slots=True)
class Chain:
    """The joints that move a frame.

    Attributes:
        start: the first joint's frame B_1 in the base, shape (4, 4); the frame itself if no joint moves it.
        steps: the joints, from the base outwards.
        last: (cos γ, sin γ) of the turn about z after all of them.
    """

    start: FloatArray
    steps: tuple[Step, ...]
    last: tuple[float, float]


def chain_to(robot: Robot, frame: str) -> Chain | None:
    """The chain of a frame; None if a joint with several velocities moves it."""
    motions = [robot.mechanism.motions[index] for index in robot.motions_above(frame)]
    if any(motion.freedoms > 1 for motion in motions):
        return None
    home = robot.mechanism.homes[frame]
    if not motions:
        return Chain(home, (), (1.0, 0.0))
    size = max(robot.reach, float(np.linalg.norm(home[:3, 3])))
    start = T_base_axis = _axis_frame(motions[0], None)
    steps = []
    last = (1.0, 0.0)
    for index, motion in enumerate(motions):
        end = index + 1 == len(motions)
        target = home if end else _axis_frame(motions[index + 1], T_base_axis)
        phi, shift, alpha, gamma = _parts(se3.inverse(T_base_axis) @ target, turn_first=end)
        turn, tilt, rest = _direction(phi), _direction(alpha), _direction(gamma)
        t = tuple(0.0 if abs(x) <= ROUNDING * size else float(x) for x in shift)
        steps.append(Step(motion, turn, (t[0], t[1], t[2]), tilt))
        if end:
            last = rest
        else:
            T_base_axis = target @ _turn_z(-gamma)
    return Chain(_snapped(start, size), tuple(steps), last)


def _axis_frame(motion: JointMotion, T_base_before: FloatArray | None) -> FloatArray:
    """A frame with z along a joint's axis at zero; its place along the axis is chosen by the axis before."""
    twist = motion.twists[:, 0]
    turns = motion.joint.type != "prismatic"
    z = _snap(twist[3:] if turns else twist[:3])
    before = np.eye(4) if T_base_before is None else T_base_before
    origin, z_before = before[:3, 3], before[:3, 2]
    point = np.cross(z, twist[:3]) if turns else origin
    point = point + z * (z @ (origin - point))  # the nearest to the origin of the frame before
    sine = np.linalg.norm(np.cross(z_before, z))
    if turns and T_base_before is not None and sine >= SKEW:
        # The foot of the common normal: Denavit and Hartenberg's choice.
        gap = point - origin
        point = point + z * ((z_before @ gap) * (z_before @ z) - z @ gap) / sine**2
    nearest = np.eye(3)[np.argmin(abs(z))] if abs(abs(z).max() - 1.0) > ROUNDING else np.roll(abs(z).round(), 1)
    x = np.cross(np.cross(z, nearest), z)
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3] = np.column_stack([x, np.cross(z, x), z, point])
    return T


def _parts(T: FloatArray, *, turn_first: bool) -> tuple[float, FloatArray, float, float]:
    """φ, t, α and γ with T = Rz(φ) Trans(t) Rx(α) Rz(γ); with α a multiple of π either φ or γ can be zero."""
    R = T[:3, :3]
    sine = math.hypot(R[0, 2], R[1, 2])
    if sine <= ROUNDING:
        flipped = R[2, 2] < 0.0
        alpha, angle = math.pi if flipped else 0.0, math.atan2(R[1, 0], R[0, 0])
        phi, gamma = (angle, 0.0) if turn_first else (0.0, -angle if flipped else angle)
    else:
        alpha, phi = math.atan2(sine, R[2, 2]), math.atan2(R[0, 2], -R[1, 2])
        # What is left, so that an inaccurate φ between nearly parallel axes does no harm.
        rest = _turn_x(-alpha)[:3, :3] @ _turn_z(-phi)[:3, :3] @ R
        gamma = math.atan2(rest[1, 0], rest[0, 0])
    return phi, _turn_z(-phi)[:3, :3] @ T[:3, 3], alpha, gamma


def _turn_z(angle: float) -> FloatArray:
    return se3.exp(np.array([0.0, 0.0, 0.0, 0.0, 0.0, angle]))


def _turn_x(angle: float) -> FloatArray:
    return se3.exp(np.array([0.0, 0.0, 0.0, angle, 0.0, 0.0]))


def _direction(angle: float) -> tuple[float, float]:
    c, s = _snap(np.array([math.cos(angle), math.sin(angle)]))
    return float(c), float(s)


def _snap(values: FloatArray) -> FloatArray:
    """Numbers with those next to 0, 1 and -1 put there."""
    near = values.round()
    return np.where((abs(values - near) <= ROUNDING) & (abs(near) <= 1.0), near, values)


def _snapped(T: FloatArray, size: float) -> FloatArray:
    """A pose with its next-to-zero entries put to zero."""
    T = T.copy()
    T[:3, :3] = _snap(T[:3, :3])
    T[:3, 3] = np.where(abs(T[:3, 3]) <= ROUNDING * size, 0.0, T[:3, 3])
    return T
