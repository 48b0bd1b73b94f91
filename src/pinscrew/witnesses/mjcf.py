"""MuJoCo on an MJCF itself: the independent second of the PoE engine, which reads what we made of the compiled tree.

It is given the file's own elements (`description.mjcf_text`), compiles them again, and is asked for its bodies and
sites, and for the links that our description has between the joints of a body. Only names are ours. Couplings of
joints are followed by its own numbers, as `witnesses.mujoco` does.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from pinscrew.engines.answers import JointView
from pinscrew.engines.base import Engine
from pinscrew.engines.hybrid import HybridEngine, drive
from pinscrew.engines.pair import pair_of
from pinscrew.ground.errors import EngineError
from pinscrew.ground.typing import FloatArray
from pinscrew.robot.robot import Robot
from pinscrew.witnesses.mujoco import FreeJoint, MuJoCo, library, warnings_kept

__all__ = ["MuJoCoFile", "readers_of"]


def readers_of(robot: Robot) -> tuple[Engine, Engine]:
    """The two engines that read a robot's file independently: of an MJCF, PoE and MuJoCo; else PoE and Pinocchio.

    Raises:
        MissingExtraError: if MuJoCo is needed, and not installed.
        EngineError, UnsupportedError: if the second engine does not take the robot.
    """
    if robot.description.mjcf is None:
        return pair_of(robot)
    from pinscrew.engines.poe import PoE

    return PoE(robot), MuJoCoFile(robot)


class MuJoCoFile(MuJoCo):
    """Kinematics by MuJoCo, from an MJCF; never our screws.

    Attributes:
        model: the ``mujoco.MjModel``.
    """

    def __init__(self, robot: Robot) -> None:
        """Let MuJoCo compile the robot's MJCF.

        Raises:
            MissingExtraError: if MuJoCo is not installed.
            EngineError: if the robot has no MJCF, or another one.
        """
        HybridEngine.__init__(self, robot)
        self._library = library()
        mjcf = robot.description.mjcf
        if mjcf is None:
            raise EngineError("witness-refuses", "the robot was not read from an MJCF", where=robot.description.file)
        with warnings_kept(self._library):
            self.model = self._library.MjSpec.from_string(mjcf.text).compile()
        if (self.model.nbody, self.model.njnt, self.model.nsite) != tuple(
            map(len, (mjcf.bodies, mjcf.joints, mjcf.sites))
        ):
            raise EngineError("witness-frames", "MuJoCo's model has other bodies, joints or sites", where=robot.name)
        self._bodies = {name: i for i, name in enumerate(mjcf.bodies)}
        self._sites = {name: i for i, name in enumerate(mjcf.sites)}
        self._joints = mjcf.joints
        self._held, self._mimics = self._read_couplings()
        self._map_joints()
        self._between = {
            joint.child: self._place(joint.name)
            for joint in robot.description.joints
            if joint.child not in self._bodies and joint.child not in self._sites
        }

    def joints(self) -> Mapping[str, JointView]:
        """The joints as MuJoCo's compiler saw them, by name; those that it has not are our description's."""
        model, kinds = self.model, self._library.mjtJoint
        words = {kinds.mjJNT_FREE: "floating", kinds.mjJNT_SLIDE: "prismatic", kinds.mjJNT_HINGE: "revolute"}
        indices = {name: i for i, name in enumerate(self._joints)}
        own = {*self._bodies, *self._sites}
        views = {}
        for joint in self._robot.description.joints:
            parent, child = joint.parent, joint.child
            index = indices.get(joint.name, -1)
            if child in self._sites:
                parent = self._link(int(model.site_bodyid[self._sites[child]]))
            elif child in own and parent in own:
                parent = self._link(int(model.body_parentid[self._bodies[child]]))
            if index < 0 or index in self._held:
                views[joint.name] = JointView("fixed", parent, child, None, None)
                continue
            if child in own:
                child = self._link(int(model.jnt_bodyid[index]))
            limits = tuple(map(float, model.jnt_range[index])) if model.jnt_limited[index] else None
            kind = words[kinds(int(model.jnt_type[index]))]
            views[joint.name] = JointView(kind, parent, child, limits, self._mimics.get(joint.name))  # type: ignore[arg-type]
        return views

    def _place(self, joint: str) -> tuple[int, int, list[int]]:
        """The body that a joint moves, its index, and those of the joints of the body after it."""
        index = self._joints.index(joint)
        body = int(self.model.jnt_bodyid[index])
        end = int(self.model.body_jntadr[body] + self.model.body_jntnum[body])
        return body, index, list(range(index + 1, end))

    def _link(self, body: int) -> str:
        return next(name for name, index in self._bodies.items() if index == body)

    def _read_couplings(self) -> tuple[dict[int, float], dict[str, tuple[str, float, float]]]:
        """The joints that are held at a value, and those that follow others: joint followed, multiplier, offset."""
        model = self.model
        held: dict[int, float] = {}
        mimics = {}
        for index in range(model.neq):
            if not model.eq_active0[index]:
                continue
            joint, followed = int(model.eq_obj1id[index]), int(model.eq_obj2id[index])
            c0, c1 = (float(c) for c in model.eq_data[index, :2])
            y = float(model.qpos0[model.jnt_qposadr[joint]])
            if followed < 0 or not c1:
                held[joint] = y + c0
                continue
            x = float(model.qpos0[model.jnt_qposadr[followed]])
            mimics[self._joints[joint]] = (self._joints[followed], c1, y + c0 - c1 * x)
        return held, mimics

    def _map_joints(self) -> None:
        """The model's coordinates as ``A q + b`` and its velocities as ``F qd``, but for free joints."""
        model, robot = self.model, self._robot
        self._A, self._b = np.zeros((model.nq, robot.nq)), np.zeros(model.nq)
        self._F = np.zeros((model.nv, robot.nv))
        free = []
        for index, name in enumerate(self._joints):
            q, v = int(model.jnt_qposadr[index]), int(model.jnt_dofadr[index])
            if index in self._held:
                self._b[q] = self._held[index]
                continue
            source = drive(robot, name, self._mimics)
            if source is None:
                raise EngineError("witness-frames", f"no coordinate drives MuJoCo's joint {name!r}", where=robot.name)
            if model.jnt_type[index] == self._library.mjtJoint.mjJNT_FREE:
                free.append(FreeJoint("floating", int(model.jnt_bodyid[index]), q, v, source.q, source.v))
            else:
                self._A[q, source.q] = self._F[v, source.v] = source.multiplier
                self._b[q] = source.offset
        self._free = tuple(free)

    def _at_rest(self) -> FloatArray:
        rest = np.zeros(self.model.nq)  # the free joints of an MJCF have the pose in the world
        for joint in self._free:
            rest[joint.q + 3] = 1.0
        return rest

    def _frame_in(self, data: Any, frame: str) -> tuple[int, FloatArray, FloatArray]:
        if frame in self._bodies:
            return super()._frame_in(data, frame)
        if frame in self._sites:
            site = self._sites[frame]
            return int(self.model.site_bodyid[site]), data.site_xpos[site], data.site_xmat[site]
        body, joint, later = self._between[frame]
        R = data.xmat[body].reshape(3, 3)
        for index in reversed(later):  # R_body = R(axis, angle) R_before, by each hinge
            if self.model.jnt_type[index] == self._library.mjtJoint.mjJNT_HINGE:
                quaternion, turned = np.zeros(4), np.zeros(9)
                self._library.mju_axisAngle2Quat(quaternion, data.xaxis[index], -self._travel(data, index))
                self._library.mju_quat2Mat(turned, quaternion)
                R = turned.reshape(3, 3) @ R
        point = data.xanchor[joint].copy()
        if self.model.jnt_type[joint] == self._library.mjtJoint.mjJNT_SLIDE:
            point += self._travel(data, joint) * data.xaxis[joint]
        return body, point, R

    def _travel(self, data: Any, joint: int) -> float:
        """How far a joint is from where the file draws it."""
        address = self.model.jnt_qposadr[joint]
        return float(data.qpos[address] - self.model.qpos0[address])

    def _correct(self, frame: str, J: FloatArray, J_rate: FloatArray, qvel: FloatArray) -> None:
        if frame not in self._between:
            return
        columns = [int(self.model.jnt_dofadr[index]) for index in self._between[frame][2]]
        # MuJoCo's rate is of a point of the body: ω × its velocity; here the later joints' part of that is none.
        more = J[:3, columns] @ qvel[columns]
        J[:, columns] = J_rate[:, columns] = 0.0
        J_rate[:3] -= np.cross(J[3:], more, axis=0)
