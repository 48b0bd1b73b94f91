"""The product of exponentials, batched with numpy.

With the joints' spatial screws ξ at zero, the pose of a frame is ``e^{ξ1 θ1} … e^{ξn θn} M`` (MLS eq. 3.3) and
column i of its spatial Jacobian is ``Ad(e^{ξ1 θ1} … e^{ξ(i-1) θ(i-1)}) ξi`` (MLS eq. 3.54). Body and hybrid
Jacobians follow from it (MLS eq. 3.56), and derivatives from d/dt Ad(g) = ad(V^s) Ad(g).

Everything is computed in blocks of configurations with the batch axis last, so that numpy's inner loops are
long and their operands stay in the cache.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from pinscrew.description.model import Joint
from pinscrew.engines._lanes import (
    apply,
    cross,
    matmul,
    rodrigues_basis,
    rotation,
    rotation_of_quaternion,
    store,
    times,
    turned_back,
)
from pinscrew.engines.base import Answers, CheckedEngine, JointView
from pinscrew.ground.typing import KINDS, FloatArray, JacobianKind
from pinscrew.robot.loading import RobotLike, robot_of
from pinscrew.robot.mechanism import JointMotion
from pinscrew.robot.robot import Robot

__all__ = ["PoE"]

BLOCK: Final = 1024
"""Configurations per block: enough to hide numpy's cost per call, few enough for the L2 cache."""


class PoE(CheckedEngine):
    """Kinematics by the product of exponentials, from the screws of the robot's description; never Pinocchio."""

    name = "PoE"

    def __init__(self, robot: RobotLike) -> None:
        """Take the screws and home poses of ``robot``."""
        robot = robot_of(robot)
        super().__init__(robot)
        self._factors = tuple(_Factor.of(motion) for motion in robot.mechanism.motions)

    def joints(self) -> Mapping[str, JointView]:
        """The joints as yourdfpy read them, by name."""
        return {joint.name: _view(joint) for joint in self._robot.description.joints}

    def poses(self, q: FloatArray, frames: Sequence[str]) -> FloatArray:
        """Poses of F frames at a flat batch (N, nq), sharing the way down the tree: shape (N, F, 4, 4); see `fk`."""
        return self._poses_of(self._coordinates(q)[0], [self._robot.frame(frame) for frame in frames])

    def _poses(self, q: FloatArray, frame: str) -> FloatArray:
        return self._poses_of(q, [frame])[:, 0]

    def _poses_of(self, q: FloatArray, frames: Sequence[str]) -> FloatArray:
        out = np.empty((len(q), len(frames), 4, 4))
        for block in _blocks(len(q)):
            chain = _Chain(self._robot, self._factors, q[block])
            for i, frame in enumerate(frames):
                _store_pose(out[block, i], *chain.pose(frame))
        return out

    def _jacobians(self, q: FloatArray, frame: str, kind: JacobianKind) -> FloatArray:
        out = np.empty((len(q), 6, self._robot.nv))
        for block in _blocks(len(q)):
            chain = _Chain(self._robot, self._factors, q[block])
            store(out[block], chain.jacobian(frame, kind))
        return out

    def _poses_and_jacobians(self, q: FloatArray, frame: str, kind: JacobianKind) -> tuple[FloatArray, FloatArray]:
        poses, jacobians = np.empty((len(q), 4, 4)), np.empty((len(q), 6, self._robot.nv))
        for block in _blocks(len(q)):
            chain = _Chain(self._robot, self._factors, q[block])
            _store_pose(poses[block], *chain.pose(frame))
            store(jacobians[block], chain.jacobian(frame, kind))
        return poses, jacobians

    def _derivatives(self, q: FloatArray, qd: FloatArray, frame: str, kind: JacobianKind) -> FloatArray:
        out = np.empty((len(q), 6, self._robot.nv))
        for block in _blocks(len(q)):
            chain = _Chain(self._robot, self._factors, q[block], qd[block])
            store(out[block], chain.derivative(frame, kind))
        return out

    def answers(self, q: FloatArray, qd: FloatArray, frames: Sequence[str]) -> Answers:
        """Everything about ``frames`` at a flat batch, sharing the way down the tree; see the base class."""
        q, qd, names = self._asked(q, qd, frames)
        shape = (len(q), len(names), 6, self._robot.nv)
        answers = Answers(
            np.empty((len(q), len(names), 4, 4)),
            {kind: np.empty(shape) for kind in KINDS},
            {kind: np.empty(shape) for kind in KINDS},
        )
        for block in _blocks(len(q)):
            chain = _Chain(self._robot, self._factors, q[block], qd[block])
            for i, name in enumerate(names):
                _store_pose(answers.poses[block, i], *chain.pose(name))
                for kind in KINDS:
                    store(answers.jacobians[kind][block, i], chain.jacobian(name, kind))
                    store(answers.derivatives[kind][block, i], chain.derivative(name, kind))
        return answers


@dataclass(frozen=True, slots=True)
class _Factor:
    """A joint's factor e^{ξθ} with what can be computed beforehand.

    Attributes:
        basis: of its rotation, for `rotation`; a floating joint's is not used.
        point: a point on its axis, in the base frame.
    """

    motion: JointMotion
    basis: FloatArray
    point: FloatArray

    @classmethod
    def of(cls, motion: JointMotion) -> _Factor:
        if motion.joint.type in ("floating", "planar"):
            return cls(motion, rodrigues_basis(np.array([0.0, 0.0, 1.0])), np.zeros(3))
        v, w = motion.twists[:3, 0], motion.twists[3:, 0]
        return cls(motion, rodrigues_basis(w), np.cross(w, v))


class _Chain:
    """The moving joints of a robot at a block of B configurations, each computed when first asked for.

    Rotations have shape (3, 3, B), vectors (3, B), twists (6, B).
    """

    def __init__(self, robot: Robot, factors: Sequence[_Factor], q: FloatArray, qd: FloatArray | None = None) -> None:
        self._robot = robot
        self._factors = factors
        self._motions = robot.mechanism.motions
        self._q = np.ascontiguousarray(q.T)
        self._qd = None if qd is None else np.ascontiguousarray(qd.T)
        self._size = len(q)
        # Displacement of each joint's child: p_base = R @ p_home + p, for points moving with it. -1 is the base.
        self._displacements: dict[int, tuple[FloatArray, FloatArray]] = {-1: (np.eye(3)[:, :, None], np.zeros((3, 1)))}
        self._columns: dict[int, FloatArray] = {}
        self._twists: dict[int, FloatArray] = {-1: np.zeros((6, 1))}

    def pose(self, frame: str) -> tuple[FloatArray, FloatArray]:
        """Rotation (3, 3, B) and position (3, B) of a frame."""
        R, p = self._displacement(self._above(frame))
        M = self._robot.mechanism.homes[frame]
        return times(R, M[:3, :3]), times(R, M[:3, 3]) + p

    def jacobian(self, frame: str, kind: JacobianKind) -> FloatArray:
        """Jacobian (6, nv, B) of a frame."""
        J = self._gather(frame, self._column)
        if kind != "spatial":
            R, p = self.pose(frame)
            J[:3] -= cross(p[:, None], J[3:])
            if kind == "body":
                J = turned_back(R, J)
        return J

    def derivative(self, frame: str, kind: JacobianKind) -> FloatArray:
        """Time derivative (6, nv, B) of a frame's Jacobian."""
        dJ = self._gather(frame, self._column_rate)
        if kind == "spatial":
            return dJ
        # Hybrid columns are (v - p×ω, ω); their rates have -p×ω̇ and, the frame's origin moving with ṗ, -ṗ×ω.
        R, p = self.pose(frame)
        twist = self._twist(self._above(frame))
        rate = twist[:3] + cross(twist[3:], p)
        J = self.jacobian(frame, "hybrid")
        dJ[:3] -= cross(p[:, None], dJ[3:]) + cross(rate[:, None], J[3:])
        if kind == "hybrid":
            return dJ
        # The body Jacobian is Rᵀ of the hybrid one, so its rate is Rᵀ(J̇ - ω×J).
        turning = twist[3:, None]
        dJ[:3] -= cross(turning, J[:3])
        dJ[3:] -= cross(turning, J[3:])
        return turned_back(R, dJ)

    def _above(self, frame: str) -> int:
        return self._robot.mechanism.motion_above[frame]

    def _gather(self, frame: str, column: Callable[[int], FloatArray]) -> FloatArray:
        """A (6, nv, B) matrix from the columns (6, k, B) of the joints that move a frame."""
        J = np.zeros((6, self._robot.nv, self._size))
        for index in self._robot.motions_above(frame):
            motion = self._motions[index]
            own = column(index)
            J[:, motion.velocities] += own if motion.multiplier == 1.0 else motion.multiplier * own
        return J

    def _displacement(self, index: int) -> tuple[FloatArray, FloatArray]:
        pending = []
        while index not in self._displacements:
            pending.append(index)
            index = self._motions[index].parent
        found = self._displacements[index]
        for below in reversed(pending):
            found = self._displacements[below] = self._step(self._factors[below], *found)
        return found

    def _step(self, factor: _Factor, R: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The displacement of a joint's child from that of its parent: a factor e^{ξθ} from the right."""
        motion = factor.motion
        if motion.joint.type in ("floating", "planar"):
            return self._free_step(factor, R, p)
        theta = motion.multiplier * self._q[motion.q]
        if motion.joint.type == "prismatic":
            return R, times(R, motion.twists[:3, 0]) * theta + p
        # e^{ξθ} turns about the axis through c: its position is c - e^{ω̂θ} c.
        turned = matmul(R, rotation(factor.basis, theta))
        return turned, p + times(R, factor.point) - times(turned, factor.point)

    def _free_step(self, factor: _Factor, R: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:
        """As `_step`, for joints that put their child at a pose X in their own frame T: a factor T X T⁻¹."""
        motion = factor.motion
        if motion.joint.type == "planar":
            x, y, theta = self._q[motion.coordinates]
            position = np.stack([x, y, np.zeros_like(x)])
            X = rotation(factor.basis, theta)
        else:
            position = self._q[motion.q : motion.q + 3]
            X = rotation_of_quaternion(self._q[motion.q + 3 : motion.q + 7])
        T = motion.T_base_child
        R_joint = times(R, T[:3, :3])
        origin = apply(R_joint, position) + times(R, T[:3, 3]) + p
        turned = times(matmul(R_joint, X), T[:3, :3].T)
        return turned, origin - times(turned, T[:3, 3])

    def _column(self, index: int) -> FloatArray:
        """Spatial Jacobian columns (6, k, B) of a joint, before its multiplier."""
        if index not in self._columns:
            motion = self._motions[index]
            # A joint with one velocity leaves its own screw as it is; others move theirs along.
            carrier = motion.parent if motion.freedoms == 1 else index
            R, p = self._displacement(carrier)
            column = np.empty((6, motion.freedoms, self._size))
            column[3:] = times(R, motion.twists[3:])
            column[:3] = times(R, motion.twists[:3]) + cross(p[:, None], column[3:])
            self._columns[index] = column
        return self._columns[index]

    def _column_rate(self, index: int) -> FloatArray:
        """Time derivative (6, k, B) of a joint's columns: ad of the twist that carries them."""
        motion = self._motions[index]
        column = self._column(index)
        twist = self._twist(motion.parent if motion.freedoms == 1 else index)[:, None]
        rate = np.empty_like(column)
        rate[:3] = cross(twist[3:], column[:3]) + cross(twist[:3], column[3:])
        rate[3:] = cross(twist[3:], column[3:])
        return rate

    def _twist(self, index: int) -> FloatArray:
        """Spatial twist (6, B) of a joint's child."""
        pending = []
        while index not in self._twists:
            pending.append(index)
            index = self._motions[index].parent
        found = self._twists[index]
        for below in reversed(pending):
            motion = self._motions[below]
            rates = motion.multiplier * self._rates()[motion.velocities]
            found = self._twists[below] = found + (self._column(below) * rates).sum(axis=1)
        return found

    def _rates(self) -> FloatArray:
        if self._qd is None:
            raise RuntimeError("a derivative was asked for without velocities")
        return self._qd


def _view(joint: Joint) -> JointView:
    ends = (joint.limits.lower, joint.limits.upper)
    mimic = joint.mimic
    return JointView(
        type="revolute" if joint.type == "continuous" else joint.type,
        parent=joint.parent,
        child=joint.child,
        limits=None if ends == (-np.inf, np.inf) else ends,
        mimic=None if mimic is None else (mimic.joint, mimic.multiplier, mimic.offset),
    )


def _blocks(length: int) -> Iterator[slice]:
    return (slice(start, min(start + BLOCK, length)) for start in range(0, length, BLOCK))


def _store_pose(out: FloatArray, R: FloatArray, p: FloatArray) -> None:
    """Write rotations (3, 3, B) and positions (3, B) into poses (B, 4, 4)."""
    store(out[:, :3, :3], R)
    out[:, :3, 3] = p.T
    out[:, 3] = (0.0, 0.0, 0.0, 1.0)
