"""The Denavit-Hartenberg table of a chain, from its screws at zero.

Both conventions are groupings of one product, with Z = Rz(θ) Tz(d) about a joint's axis and X = Tx(a) Rx(α) Ry(β)
along the common normal to the next:

    T = T_base_0 · Z₁ X₁ Z₂ X₂ ⋯ Zₙ Xₙ · T_n_tool

Standard (Spong, Hutchinson, Vidyasagar, *Robot Modeling and Control*, eq. 3.10): Aᵢ = Zᵢ Xᵢ. Modified (Craig,
*Introduction to Robotics*, eq. 3.6): Tᵢ = Xᵢ₋₁ Zᵢ. β is 0 unless axes are nearly parallel (Hayati and Mirmirani 1985).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.robot.mechanism import JointMotion
from pinscrew.robot.robot import Robot

__all__ = ["Convention", "DHRow", "DHTable", "about_z", "along_x", "check_convention", "dh_table"]

Convention = Literal["standard", "modified"]

NEARLY_PARALLEL: Final = 1e-3
"""Sine of the angle between axes below which their common normal is taken for undetermined."""
ROUNDING: Final = 1e-12
"""Lengths (m) below this are none."""
SNAP: Final = 5e-11
"""Lengths (m) this near to whole nanometres are these: what rounded angles make of them within a metre."""
ANGLE_ROUNDING: Final = 5e-11
"""Angles (rad) this near to a multiple of 15° are it: files write π/2 as 1.57079632679, and it adds up."""


@dataclass(frozen=True, slots=True)
class DHRow:
    """A row: lengths in m, angles in rad.

    Attributes:
        joint: the joint that moves.
        prismatic: whether its value is added to d, rather than to θ.
        coordinate: which entry of q drives it.
        multiplier: value of the joint per unit of its coordinate; 1 but for mimic joints.
        theta, d, a, alpha: at zero. In the modified convention a and α are aᵢ₋₁ and αᵢ₋₁.
        beta: Hayati's angle about y, which follows α; 0 unless axes are nearly parallel.
    """

    joint: str
    prismatic: bool
    coordinate: int
    multiplier: float
    theta: float
    d: float
    a: float
    alpha: float
    beta: float


@dataclass(frozen=True, slots=True)
class DHTable:
    """A table, and the transforms before and after it.

    Attributes:
        robot, base, tip: names: of the robot, of the frame that ``T_base_0`` is in, and of the tool.
        convention: ``"standard"`` or ``"modified"``.
        rows: one for each joint that moves the tip, from the base outwards.
        T_base_0: pose of frame 0 in the base, shape (4, 4).
        T_n_tool: pose of the tip in frame n, shape (4, 4).
    """

    robot: str
    base: str
    tip: str
    convention: Convention
    rows: tuple[DHRow, ...]
    T_base_0: FloatArray
    T_n_tool: FloatArray

    def fk(self, q: FloatArray) -> FloatArray:
        """Pose of the tip in ``base``: ``q`` (nq,), all of the robot's, to (4, 4)."""
        T = self.T_base_0
        for row in self.rows:
            value = row.multiplier * q[row.coordinate]
            theta, d = (row.theta, row.d + value) if row.prismatic else (row.theta + value, row.d)
            Z, X = about_z(theta, d), along_x(row.a, row.alpha, row.beta)
            T = T @ Z @ X if self.convention == "standard" else T @ X @ Z
        return T @ self.T_n_tool


def dh_table(
    robot: Robot, tip: str | None = None, *, convention: Convention = "standard", base: str | None = None
) -> DHTable:
    """The table of the chain to a frame.

    The choices: zᵢ points along the joint's axis, so that θ and d grow with its value. xᵢ lies on the common normal,
    in the direction that turns θ by -90° < θ ≤ 90° at zero. Parallel axes: d is 0. Axes that meet: a is 0. A
    prismatic joint's axis goes through the joint's origin in the file. Frame 0 is the base's where its z is on the
    first axis. The last row of the standard convention goes on to a line through the tip's origin, parallel to the
    last axis; that of the modified one has θ = d = 0, and the tool's transform has the rest.

    Args:
        robot: the robot.
        tip: the frame; by default the robot's tip.
        convention: ``"standard"`` or ``"modified"``.
        base: another frame fixed to the base, to begin in.

    Raises:
        InputError: if nothing moves the tip, a floating or planar joint does, or there is no such convention.
        UnknownNameError, AmbiguousTipError: see `Robot.frame`.
    """
    check_convention(convention)
    tip = robot.frame(tip)
    motions = [robot.mechanism.motions[i] for i in robot.motions_above(tip)]
    for motion in motions:
        if motion.freedoms != 1:
            what = f"{motion.joint.name!r} is a {motion.joint.type} joint, which no row describes"
            raise InputError("dh-joint", what, where=robot.name, remedy="name a tip and a base below it")
    if not motions:
        raise InputError("dh-joint", f"no joint moves {tip!r}", where=robot.name, remedy="name another tip")
    tool = robot.home(tip, reference=base)
    T_reference_base = tool @ se3.inverse(robot.home(tip))
    lines = [_line(motion, T_reference_base) for motion in motions]
    start = frame = _first_frame(*lines[0])
    after = [*lines[1:], (lines[-1][0], tool[:3, 3])] if convention == "standard" else lines[1:]
    steps: list[tuple[float, float, float, float, float]] = []
    for direction, point in after:
        step = _step(frame, direction, point, last=len(steps) == len(lines) - 1)
        frame = frame @ about_z(*step[:2]) @ along_x(*step[2:])
        steps.append(step)
    if convention == "modified":  # the same steps, each row with what comes before its Z
        zs, xs = [*(s[:2] for s in steps), (0.0, 0.0)], [(0.0, 0.0, 0.0), *(s[2:] for s in steps)]
        steps = [(*z, *x) for z, x in zip(zs, xs, strict=True)]
    rows = tuple(
        DHRow(m.joint.name, m.joint.type == "prismatic", m.q, m.multiplier, *step)
        for m, step in zip(motions, steps, strict=True)
    )
    T_n_tool = se3.inverse(frame) @ tool
    T_n_tool[abs(T_n_tool) < ROUNDING] = 0.0
    return DHTable(robot.name, base or robot.base, tip, convention, rows, start, T_n_tool)


def check_convention(convention: str) -> None:
    """Refuse what is no convention.

    Raises:
        InputError: if it is neither standard nor modified.
    """
    if convention not in ("standard", "modified"):
        raise InputError("dh-convention", f"convention={convention!r}", remedy="use 'standard' or 'modified'")


def _line(motion: JointMotion, T_reference_base: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Direction of a joint's axis, and a point on it."""
    R, p = T_reference_base[:3, :3], T_reference_base[:3, 3]
    twist = motion.twists[:, 0]
    direction = twist[:3] if motion.joint.type == "prismatic" else twist[3:]
    return R @ (direction / np.linalg.norm(direction)), R @ motion.T_base_child[:3, 3] + p


def _first_frame(z: FloatArray, point: FloatArray) -> FloatArray:
    """Frame 0: the base's where its z is the first axis; else at the foot of the base's origin on the axis."""
    foot = point - (point @ z) * z
    foot[abs(foot) < ROUNDING] = 0.0
    # The first axis of the base's that is perpendicular to z, or what of the least parallel one is.
    overlaps = np.where(abs(z) < ANGLE_ROUNDING, 0.0, abs(z))
    x = np.eye(3)[int(np.argmin(overlaps))]
    x = x - (x @ z) * z
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    T[:3, 3] = foot
    T[abs(T) < ROUNDING] = 0.0
    return T


def _step(
    frame: FloatArray, direction: FloatArray, point: FloatArray, *, last: bool
) -> tuple[float, float, float, float, float]:
    """θ, d, a, α, β from a frame on one axis to the next axis."""
    w, p = frame[:3, :3].T @ direction, frame[:3, :3].T @ (point - frame[:3, 3])  # the next axis, in this frame
    sine = math.hypot(w[0], w[1])  # of the angle between the axes: z × w = (-w_y, w_x, 0)
    if sine > NEARLY_PARALLEL:
        x = np.array([-w[1], w[0], 0.0]) / sine
        # Feet of the common normal: on the next axis r = p + s w, with (r - d z) ∥ x, so that r · (z × x) = 0.
        y = np.array([-x[1], x[0], 0.0])
        r = p - (p @ y) / (w @ y) * w
        d = float(r[2])
    else:  # parallel, or nearly: the normal through this origin; d = 0, or up to the tip in the last row
        d = float(p[2]) if last else 0.0
        r = p + (d - p[2]) / w[2] * w
        away = math.hypot(r[0], r[1])
        x = np.array([r[0], r[1], 0.0]) / away if away > SNAP else np.array([1.0, 0.0, 0.0])
    if x[0] < -ANGLE_ROUNDING or (abs(x[0]) <= ANGLE_ROUNDING and x[1] < 0.0):
        x = -x  # -90° < θ ≤ 90°
    theta = _angle(math.atan2(x[1], x[0]))
    rest = w[0] * x[0] + w[1] * x[1]  # the next axis along x, y and z of the turned frame: (sβ, -cβ sα, cβ cα)
    beta = _angle(math.asin(max(-1.0, min(1.0, rest)))) if sine <= NEARLY_PARALLEL else 0.0
    alpha = _angle(math.atan2(-(w[1] * x[0] - w[0] * x[1]), w[2]))
    return theta, _length(d), _length(float(r[:2] @ x[:2])), alpha, beta


def _angle(value: float) -> float:
    exact = round(value * 12.0 / math.pi) * math.pi / 12.0
    near = exact if abs(value - exact) < ANGLE_ROUNDING else value
    return math.pi if near == -math.pi else near + 0.0


def _length(value: float) -> float:
    """The length, or the whole nanometres that it is but for rounding."""
    exact = round(value, 9)
    return exact + 0.0 if abs(value - exact) < SNAP else value


def about_z(theta: float, d: float) -> FloatArray:
    """Rz(θ) Tz(d), shape (4, 4); rad, m."""
    c, s = math.cos(theta), math.sin(theta)
    return np.array([[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, d], [0.0, 0.0, 0.0, 1.0]])


def along_x(a: float, alpha: float, beta: float) -> FloatArray:
    """Tx(a) Rx(α) Ry(β), shape (4, 4); m, rad, rad."""
    ca, sa, cb, sb = math.cos(alpha), math.sin(alpha), math.cos(beta), math.sin(beta)
    return np.array(
        [[cb, 0.0, sb, a], [sa * sb, ca, -sa * cb, 0.0], [-ca * sb, sa, ca * cb, 0.0], [0.0, 0.0, 0.0, 1.0]]
    )
