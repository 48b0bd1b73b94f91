"""Pinocchio, asked in our coordinates.

It is given the URDF itself and reads all of it in its own way. Two things are done outside its model: a
continuous joint's angle becomes the (cos, sin) that Pinocchio wants, and mimic joints, whose loader refuses
forward references and chains, are left independent in the model: their coordinates are expanded before each
call and their Jacobian columns folded after it. Nothing here uses the description's numbers or our screws.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from math import hypot, isfinite
from typing import Any, Final

import numpy as np
import pinocchio as pin
from numpy import ndarray

from pinscrew.engines.asking import Answer, written
from pinscrew.engines.base import Answers, Bound, CheckedEngine, JointView
from pinscrew.engines.expansion import MAX_COORDINATES, MAX_DEPTH, CoordinateExpansion, Driven, check_size, read_mimics
from pinscrew.engines.pinocchio_model import build
from pinscrew.engines.plain import limits_seen
from pinscrew.ground.errors import EngineError
from pinscrew.ground.typing import KINDS, ArrayLike, FloatArray, JacobianKind, KindLike
from pinscrew.robot.loading import RobotLike, robot_of
from pinscrew.robot.robot import UNIVERSE

__all__ = ["MAX_COORDINATES", "MAX_DEPTH", "Pinocchio"]

_DOUBLE: Final = np.dtype(np.float64)

# Looked up once: of one configuration, even that can be measured.
_forward_kinematics: Final = pin.forwardKinematics
_joint_jacobians: Final = pin.computeJointJacobians
_place_frame: Final = pin.updateFramePlacement
_frame_jacobian: Final = pin.getFrameJacobian

_REFERENCE: Final[dict[KindLike, Any]] = {
    "spatial": pin.ReferenceFrame.WORLD,
    "body": pin.ReferenceFrame.LOCAL,
    "hybrid": pin.ReferenceFrame.LOCAL_WORLD_ALIGNED,
}


class Pinocchio(CheckedEngine):
    """Kinematics by Pinocchio, from its own reading of the URDF; never our screws.

    Attributes:
        model: the Pinocchio model, with mimic joints left independent.
    """

    name = "Pinocchio"

    def __init__(self, robot: RobotLike) -> None:
        """Load the robot's URDF.

        Raises:
            UnsupportedError: if it has more than `MAX_COORDINATES` coordinates or `MAX_DEPTH` joints in a chain.
            EngineError: if Pinocchio refuses the file; the message carries its words.
        """
        super().__init__(robot := robot_of(robot))
        check_size(robot)
        self.model = build(robot)
        self._threads = threading.local()
        self._mimics = read_mimics(robot)
        self._expansion, self._fold = self._map_coordinates()
        self._frames: dict[str | None, int] = {name: self._frame_id(name) for name in robot.frame_names}
        self._plain = bool(np.array_equal(self._fold, np.eye(robot.nv)))
        ones = np.isin(self._fold, (0.0, 1.0)).all() and (self._fold.sum(axis=0) == 1.0).all()
        self._columns = self._fold.argmax(axis=0) if ones and self._fold.size else None
        self._identical = self._expansion.identical
        # The shape of a configuration that takes the short way; nv = 1 gives Pinocchio's Jacobians another shape.
        self._one = (robot.nq,) if self._expansion.scalar and self.model.nv > 1 else None

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._robot,)

    @property
    def _data(self) -> Any:
        """Pinocchio's scratch memory: one for each thread, since two would overwrite each other's."""
        try:
            return self._threads.data
        except AttributeError:
            self._threads.data = self.model.createData()
            return self._threads.data

    def joints(self) -> Mapping[str, JointView]:
        """The joints as Pinocchio's parser saw them, by name."""
        joint_frames = (pin.FrameType.JOINT, pin.FrameType.FIXED_JOINT)
        bodies = {f.parentFrame: f.name for f in self.model.frames if f.type == pin.FrameType.BODY}
        views = {}
        for index, frame in enumerate(self.model.frames):
            if frame.type in joint_frames and index > 0:
                parent = self.model.frames[frame.parentFrame].name
                views[frame.name] = self._view(frame, parent, bodies.get(index, ""))
        return views

    def _view(self, frame: Any, parent: str, child: str) -> JointView:
        if frame.type == pin.FrameType.FIXED_JOINT:
            return JointView("fixed", parent, child)
        joint = self.model.joints[frame.parentJoint]
        kind = _kind(joint)
        limits = None
        if kind in ("revolute", "prismatic") and joint.nq == 1:
            at = joint.idx_q
            limits = limits_seen(self.model.lowerPositionLimit[at], self.model.upperPositionLimit[at])
        return JointView(kind, parent, child, limits, self._mimics.get(frame.name))

    # The checks that are made for batches take many times as long as Pinocchio's answer to one configuration, so that
    # goes a short way. What that does not know (None for the tip, aliases, a thread's first call) goes the long one.

    def fk(self, q: ArrayLike, frame: str | None = None) -> FloatArray:
        """Pose of ``frame`` in the base frame; see `CheckedEngine.fk`."""
        x = self._alone(q)
        try:
            index, data = self._frames[frame], self._threads.data
        except (AttributeError, KeyError, TypeError):
            x = None
        if x is None:
            return super().fk(q, frame)
        _forward_kinematics(self.model, data, x)
        pose: FloatArray = _place_frame(self.model, data, index).homogeneous
        return pose

    def jacobian(self, q: ArrayLike, frame: str | None, kind: KindLike) -> FloatArray:
        """Jacobian of ``frame``; see `CheckedEngine.jacobian`."""
        x = self._alone(q)
        try:
            index, reference, data = self._frames[frame], _REFERENCE[kind], self._threads.data
        except (AttributeError, KeyError, TypeError):
            x = None
        if x is None:
            return super().jacobian(q, frame, kind)
        J: FloatArray = pin.computeFrameJacobian(self.model, data, x, index, reference)
        return J if self._plain else self._folded(J)

    def fk_jacobian(self, q: ArrayLike, frame: str | None, kind: KindLike) -> tuple[FloatArray, FloatArray]:
        """Pose and Jacobian of ``frame``; see `CheckedEngine.fk_jacobian`."""
        x = self._alone(q)
        try:
            index, reference, data = self._frames[frame], _REFERENCE[kind], self._threads.data
        except (AttributeError, KeyError, TypeError):
            x = None
        if x is None:
            return super().fk_jacobian(q, frame, kind)
        model = self.model
        _joint_jacobians(model, data, x)
        pose: FloatArray = _place_frame(model, data, index).homogeneous
        J: FloatArray = _frame_jacobian(model, data, index, reference)
        return pose, J if self._plain else self._folded(J)

    def _bound(self, frame: str, kind: JacobianKind, rest: Bound) -> Bound:
        """See `CheckedEngine.bind`. Pinocchio itself complains of shapes; of what is not finite, nobody else does."""
        if (shape := self._one) is None:
            return rest
        model, threads, plain, folded = self.model, self._threads, self._plain, self._folded
        expand = None if self._identical else self._expansion.one
        index, reference = self._frames[frame], _REFERENCE[kind]

        def ask(q: ArrayLike, *, out: Answer | None = None) -> Answer:
            try:
                if q.dtype is not _DOUBLE or not isfinite(sum(values := q.tolist())):  # type: ignore[union-attr]
                    return rest(q, out=out)
                if expand is None:
                    _joint_jacobians(model, data := threads.data, q)
                elif q.shape == shape:  # type: ignore[union-attr]
                    _joint_jacobians(model, data := threads.data, expand(q, values))  # type: ignore[arg-type]
                else:
                    return rest(q, out=out)
            except (AttributeError, TypeError, ValueError):  # no array, or a thread's first question
                return rest(q, out=out)
            pose: FloatArray = _place_frame(model, data, index).homogeneous
            J: FloatArray = _frame_jacobian(model, data, index, reference)
            answer = pose, J if plain else folded(J)
            return answer if out is None else written(answer, out)

        return ask

    def _alone(self, q: Any) -> FloatArray | None:
        """What Pinocchio takes for ``q``, if that is one good configuration of joints with one value each."""
        if type(q) is ndarray and q.shape == self._one and q.dtype is _DOUBLE:
            values = q.tolist()
            if isfinite(hypot(*values)):  # what is not may only have overflowed: the long way looks closer
                try:
                    return q if self._identical else self._expansion.one(q, values)
                except ValueError:  # the cosine of an angle that its multiplier made infinite
                    return None
        return None

    def _map_coordinates(self) -> tuple[CoordinateExpansion, FloatArray]:
        """The source of each model joint's coordinates, and the matrix F with model velocity = F @ ours."""
        q_of, v_of = self._robot.mechanism.coordinates.q, self._robot.mechanism.coordinates.v
        driven = []
        fold = np.zeros((self.model.nv, self._robot.nv))
        for name, joint in zip(list(self.model.names)[1:], list(self.model.joints)[1:], strict=True):
            master, multiplier, offset = name, 1.0, 0.0
            while master in self._mimics:
                master, factor, shift = self._mimics[master]
                multiplier, offset = multiplier * factor, offset + multiplier * shift
            if master not in q_of:
                what = f"Pinocchio's joint {name!r} has no coordinate among {', '.join(q_of) or 'none'}"
                raise EngineError("pinocchio-coordinates", what, where=self._robot.name)
            kind = _kind(joint)
            driven.append(Driven(joint.idx_q, joint.nq, q_of[master], multiplier, offset, kind))
            rows = np.arange(joint.idx_v, joint.idx_v + joint.nv)
            fold[rows, v_of[master] + np.arange(joint.nv)] = multiplier
        return CoordinateExpansion(tuple(driven), self.model.nq), fold

    def _frame_id(self, name: str) -> int:
        if self._robot.floating_base and name == UNIVERSE:
            return 0
        if not self.model.existFrame(name, pin.FrameType.BODY):
            raise EngineError("pinocchio-frames", f"Pinocchio's model has no link {name!r}", where=self._robot.name)
        return int(self.model.getFrameId(name, pin.FrameType.BODY))

    def _folded(self, J: FloatArray) -> FloatArray:
        if self._plain:
            return J
        return J @ self._fold if self._columns is None else J.take(self._columns, axis=-1)

    def _poses(self, q: FloatArray, frame: str) -> FloatArray:
        out = np.empty((len(q), 4, 4))
        model, data, index = self.model, self._data, self._frames[frame]
        for i, x in enumerate(self._expansion.all(q)):
            pin.forwardKinematics(model, data, x)
            out[i] = pin.updateFramePlacement(model, data, index).homogeneous
        return out

    def _jacobians(self, q: FloatArray, frame: str, kind: JacobianKind) -> FloatArray:
        out = np.empty((len(q), 6, self.model.nv))
        model, data, index, reference = self.model, self._data, self._frames[frame], _REFERENCE[kind]
        for i, x in enumerate(self._expansion.all(q)):
            out[i] = pin.computeFrameJacobian(model, data, x, index, reference).reshape(6, model.nv)
        return self._folded(out)

    def _derivatives(self, q: FloatArray, qd: FloatArray, frame: str, kind: JacobianKind) -> FloatArray:
        return self.answers(q, qd, [frame]).derivatives[kind][:, 0]

    def _velocities(self, q: FloatArray, qd: FloatArray, frame: str, kind: JacobianKind) -> FloatArray:
        out = np.empty((len(q), 6))
        model, data, index, reference = self.model, self._data, self._frames[frame], _REFERENCE[kind]
        for i, (x, rates) in enumerate(zip(self._expansion.all(q), qd @ self._fold.T, strict=True)):
            pin.forwardKinematics(model, data, x, rates)
            out[i] = pin.getFrameVelocity(model, data, index, reference).vector
        return out

    def answers(self, q: FloatArray, qd: FloatArray, frames: Sequence[str]) -> Answers:
        """Everything about ``frames`` at a flat batch, with one pass of Pinocchio each; see the base class."""
        q, qd, names = self._asked(q, qd, frames)
        model, data = self.model, self._data
        indices = [self._frames[name] for name in names]
        shape = (len(q), len(indices), 6, model.nv)
        poses = np.empty((len(q), len(indices), 4, 4))
        jacobians = {kind: np.zeros(shape) for kind in KINDS}
        derivatives = {kind: np.zeros(shape) for kind in KINDS}
        for i, (x, rates) in enumerate(zip(self._expansion.all(q), qd @ self._fold.T, strict=True)):
            pin.computeJointJacobiansTimeVariation(model, data, x, rates)
            pin.updateFramePlacements(model, data)
            for j, index in enumerate(indices):
                poses[i, j] = data.oMf[index].homogeneous
                if not model.nv:
                    continue  # getFrameJacobian ends in a segmentation fault there
                for kind in KINDS:
                    reference = _REFERENCE[kind]
                    J = pin.getFrameJacobian(model, data, index, reference)
                    dJ = pin.getFrameJacobianTimeVariation(model, data, index, reference)
                    jacobians[kind][i, j] = J.reshape(6, model.nv)
                    derivatives[kind][i, j] = dJ.reshape(6, model.nv)
        return Answers(
            poses,
            {kind: self._folded(J) for kind, J in jacobians.items()},
            {kind: self._folded(dJ) for kind, dJ in derivatives.items()},
        )


def _kind(joint: Any) -> str:
    """What a joint of Pinocchio's is, in our words."""
    name = joint.shortname()
    if "FreeFlyer" in name:
        return "floating"
    if "Planar" in name:
        return "planar"
    return "prismatic" if name.startswith("JointModelP") else "revolute"
