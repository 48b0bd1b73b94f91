"""MuJoCo as a witness: its own URDF compiler and kinematics, asked in our coordinates.

It is given the kinematic part of the URDF as written (`plain.plain_urdf`), asked to keep links that don't move, and
to give each link some mass, without which it compiles no body; neither changes where anything is. Mimic joints follow
the equality constraints that its compiler makes of them: `mj_kinematics` does not enforce these, so they are expanded
before each call, and the Jacobians' columns are folded after it.
"""

from __future__ import annotations

import threading
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Final
from xml.etree import ElementTree as ET

import numpy as np

from pinscrew.engines.base import JointView
from pinscrew.engines.hybrid import HybridEngine, Told, drive, joint_names
from pinscrew.engines.plain import limits_seen, plain_urdf
from pinscrew.ground.errors import EngineError, MissingExtraError, PinscrewWarning
from pinscrew.ground.typing import FloatArray
from pinscrew.robot.robot import FLOATING_JOINT, UNIVERSE, Robot

__all__ = ["FreeJoint", "MuJoCo", "library", "warnings_kept"]

WORLD: Final = "world"
"""MuJoCo's name for its first body, which does not move; a root link of this name is it."""

_LOCK: Final = threading.Lock()
"""Held while MuJoCo's handler of warnings, of which there is one in a process, is ours."""


@dataclass(frozen=True, slots=True)
class FreeJoint:
    """A joint of several velocities: where its coordinates and velocities start in the model and in ours."""

    kind: str
    body: int
    q: int
    v: int
    our_q: int
    our_v: int


class MuJoCo(HybridEngine):
    """Kinematics by MuJoCo, from its own reading of the URDF; never our screws.

    Attributes:
        model: the ``mujoco.MjModel``.
    """

    name = "MuJoCo"

    def __init__(self, robot: Robot) -> None:
        """Let MuJoCo compile the robot's URDF.

        Raises:
            MissingExtraError: if MuJoCo is not installed.
            EngineError: if it refuses the file, such as one with a floating joint in mid-tree; the message carries
                its words.
        """
        super().__init__(robot)
        self._library = library()
        self.model = self._compile()
        bodies = {self.model.body(i).name: i for i in range(self.model.nbody)}
        self._names = joint_names(robot)
        self._bodies = {name: bodies.get(self._body_name(name), -1) for name in robot.frame_names}
        for name, index in self._bodies.items():
            if index < 0:
                raise EngineError("witness-frames", f"MuJoCo's model has no body {name!r}", where=robot.name)
        self._links = {index: name for name, index in self._bodies.items()}
        self._kinds = {index: self._kind(index) for index in self._links}
        self._mimics = self._read_mimics()
        self._map_coordinates()
        # MuJoCo drops equal limits, which lock a joint: said once, and no difference in what moves.
        joints = [joint for joint in robot.description.joints if joint.type in ("revolute", "prismatic")]
        equal = [joint for joint in joints if joint.limits.lower == joint.limits.upper]
        self._locked = {joint.name: (joint.limits.lower, joint.limits.upper) for joint in equal}
        if equal:
            names = ", ".join(repr(joint.name) for joint in equal)
            remark = f"MuJoCo drops the limits of {names}, whose lower and upper limit are equal"
            warnings.warn(PinscrewWarning("witness-limits", remark, file=robot.description.file), stacklevel=2)

    def joints(self) -> Mapping[str, JointView]:
        """The joints as MuJoCo's compiler saw them, by name; it forgets those of fixed joints, which are the file's."""
        views = {}
        for link, joint in self._names.items():
            body = self._bodies[link]
            kind = self._kinds[body]
            limits = None
            at = self.model.body_jntadr[body]
            if kind in ("revolute", "prismatic") and self.model.jnt_limited[at]:
                limits = limits_seen(self.model.jnt_range[at, 0], self.model.jnt_range[at, 1])
            elif joint in self._locked:
                limits = self._locked[joint]
            parent = self._links[int(self.model.body_parentid[body])]
            views[joint] = JointView(kind, parent, link, limits, self._mimics.get(joint))
        return views

    def _compile(self) -> Any:
        root = plain_urdf(self._robot)
        extension = ET.SubElement(root, "mujoco")
        ET.SubElement(extension, "compiler", fusestatic="false", boundmass="1", boundinertia="1")
        if self._robot.floating_base:  # a free joint is one to its world
            ET.SubElement(root, "link", name=WORLD)
            floating = ET.SubElement(root, "joint", name=FLOATING_JOINT, type="floating")
            ET.SubElement(floating, "parent", link=WORLD)
            ET.SubElement(floating, "child", link=self._robot.description.joints[0].child)
        try:
            with warnings_kept(self._library):
                return self._library.MjModel.from_xml_string(ET.tostring(root, encoding="unicode"))
        except ValueError as error:
            what = f"MuJoCo refuses the file: {error}"
            raise EngineError("witness-refuses", what, where=self._robot.description.file) from None

    def _body_name(self, frame: str) -> str:
        return WORLD if self._robot.floating_base and frame == UNIVERSE else frame

    def _kind(self, body: int) -> str:
        """What joins a body to its parent, in our words."""
        start, count = int(self.model.body_jntadr[body]), int(self.model.body_jntnum[body])
        found = tuple(int(kind) for kind in self.model.jnt_type[start : start + count])
        kinds = self._library.mjtJoint
        slide, hinge = int(kinds.mjJNT_SLIDE), int(kinds.mjJNT_HINGE)
        words = {
            (): "fixed",
            (hinge,): "revolute",
            (slide,): "prismatic",
            (slide, slide, hinge): "planar",
            (int(kinds.mjJNT_FREE),): "floating",
        }
        return words[found]

    def _read_mimics(self) -> dict[str, tuple[str, float, float]]:
        """The joints that follow others by MuJoCo's equality constraints: joint followed, multiplier, offset."""
        mimics = {}
        for index in range(self.model.neq):
            joint, followed = (self.model.joint(at[index]).name for at in (self.model.eq_obj1id, self.model.eq_obj2id))
            mimics[joint] = (followed, float(self.model.eq_data[index, 1]), float(self.model.eq_data[index, 0]))
        return mimics

    def _map_coordinates(self) -> None:
        """The model's coordinates as ``A q + b``, its velocities as ``F qd``, and the joints for which they aren't."""
        model, robot = self.model, self._robot
        self._A, self._b = np.zeros((model.nq, robot.nq)), np.zeros(model.nq)
        self._F = np.zeros((model.nv, robot.nv))
        free = []
        for body, kind in self._kinds.items():
            if kind == "fixed":
                continue
            at = model.body_jntadr[body]
            source = drive(robot, self._names[self._links[body]], self._mimics)
            if source is None:
                continue
            q, v = int(model.jnt_qposadr[at]), int(model.jnt_dofadr[at])
            if kind in ("planar", "floating"):
                free.append(FreeJoint(kind, body, q, v, source.q, source.v))
            else:
                self._A[q, source.q] = self._F[v, source.v] = source.multiplier
                self._b[q] = source.offset
        self._free = tuple(free)

    def _told(self, q: FloatArray, qd: FloatArray | None, frames: Sequence[str]) -> Told:
        mj, model = self._library, self.model
        data = mj.MjData(model)
        along = np.zeros((len(q), self._robot.nv)) if qd is None else qd
        shape = (len(q), len(frames), 6, self._robot.nv)
        poses = np.zeros((len(q), len(frames), 4, 4))
        poses[..., 3, 3] = 1.0
        J, dJ = np.zeros(shape), np.zeros(shape)
        theirs, rates = np.zeros((6, model.nv)), np.zeros((6, model.nv))
        for i in range(len(q)):
            data.qpos = self._model_q(q[i])
            mj.mj_kinematics(model, data)
            mj.mj_comPos(model, data)
            F, dF = self._fold(data, along[i])
            data.qvel = F @ along[i]
            mj.mj_comVel(model, data)
            for j, name in enumerate(frames):
                body, point, turned = self._frame_in(data, name)
                poses[i, j, :3, :3], poses[i, j, :3, 3] = turned.reshape(3, 3), point
                mj.mj_jac(model, data, theirs[:3], theirs[3:], point, body)
                mj.mj_jacDot(model, data, rates[:3], rates[3:], point, body)
                self._correct(name, theirs, rates, data.qvel)
                J[i, j], dJ[i, j] = theirs @ F, rates @ F + theirs @ dF
        return Told(poses, J, dJ, along)

    def _frame_in(self, data: Any, frame: str) -> tuple[int, FloatArray, FloatArray]:
        """The body of a frame, and its position and rotation in ``data``."""
        body = self._bodies[frame]
        return body, data.xpos[body], data.xmat[body]

    def _correct(self, frame: str, J: FloatArray, J_rate: FloatArray, qvel: FloatArray) -> None:
        """Make the Jacobian of a body, and its rate, those of a frame that not all its joints move, in place."""

    def _at_rest(self) -> FloatArray:
        """What a free joint's coordinates are where ours are an identity, in the model's coordinates."""
        rest: FloatArray = self.model.qpos0
        return rest

    def _model_q(self, q: FloatArray) -> FloatArray:
        """Our coordinates (nq,) as MuJoCo's (model.nq,)."""
        out: FloatArray = self._A @ q + self._b
        for joint in self._free:
            ours = q[joint.our_q :]
            if joint.kind == "planar":
                out[joint.q : joint.q + 3] = ours[:3]
            else:  # its free joint has the pose in the world; the origin of the joint is its pose at rest
                at_rest, target = (whole[joint.q : joint.q + 7] for whole in (self._at_rest(), out))
                pose = at_rest[:3], at_rest[3:], ours[:3], ours[[6, 3, 4, 5]]  # quaternions are w, x, y, z
                self._library.mju_mulPose(target[:3], target[3:], *pose)
        return out

    def _fold(self, data: Any, qd: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The matrix F with MuJoCo's velocities = F @ ours at the pose in ``data``, and its time derivative.

        Ours are twists in the moving frame. MuJoCo has v of a free joint in the world's axes and ω in the body's,
        and a planar joint's are the rates of its slides, which don't turn, and of its hinge.
        """
        F, dF = self._F.copy(), np.zeros_like(self._F)
        for joint in self._free:
            v, ours = joint.v, joint.our_v
            if joint.kind == "planar":
                angle, rate = float(data.qpos[joint.q + 2]), qd[ours + 2]
                c, s = np.cos(angle), np.sin(angle)
                F[v : v + 2, ours : ours + 2] = [[c, -s], [s, c]]
                dF[v : v + 2, ours : ours + 2] = np.array([[-s, -c], [c, -s]]) * rate
                F[v + 2, ours + 2] = 1.0
            else:
                R = data.xmat[joint.body].reshape(3, 3)
                F[v : v + 3, ours : ours + 3] = R
                x, y, z = qd[ours + 3 : ours + 6]
                dF[v : v + 3, ours : ours + 3] = R @ [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
                F[v + 3 : v + 6, ours + 3 : ours + 6] = np.eye(3)
        return F, dF


def library() -> Any:
    """The package.

    Raises:
        MissingExtraError: if it is not installed.
    """
    try:
        import mujoco
    except ImportError:
        raise MissingExtraError("MuJoCo is not installed", "mujoco") from None
    return mujoco


@contextmanager
def warnings_kept(library: Any) -> Iterator[None]:
    """Let MuJoCo say nothing, such as that it ignores equal limits, where it else writes a file MUJOCO_LOG.TXT."""
    with _LOCK:
        handler = library.get_mju_user_warning()
        library.set_mju_user_warning(lambda _: None)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                yield
        finally:
            library.set_mju_user_warning(handler)
