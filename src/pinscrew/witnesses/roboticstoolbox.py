"""roboticstoolbox as a witness: its own URDF reader and elementary transforms, asked in our coordinates.

It is given the kinematic part of the URDF as written (`plain.plain_urdf`). What it gets wrong is left as it is, for
`verify` to show; ``docs/witnesses.md`` lists it. Joints that it takes for independent although they mimic others have
no coordinate of ours, and stay at zero.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np

from pinscrew.engines.base import JointView
from pinscrew.engines.hybrid import HybridEngine, Told, drive, joint_names
from pinscrew.engines.plain import limits_seen, plain_urdf
from pinscrew.ground.errors import EngineError, MissingExtraError, UnsupportedError
from pinscrew.ground.typing import FloatArray
from pinscrew.robot.robot import Robot

__all__ = ["RoboticsToolbox", "library"]


class RoboticsToolbox(HybridEngine):
    """Kinematics by roboticstoolbox, from its own reading of the URDF; never our screws.

    Attributes:
        model: the ``roboticstoolbox.Robot``.
    """

    name = "roboticstoolbox"

    def __init__(self, robot: Robot) -> None:
        """Let roboticstoolbox read the robot's URDF.

        Raises:
            MissingExtraError: if roboticstoolbox is not installed.
            UnsupportedError: if the robot has a floating base, which roboticstoolbox has not.
            EngineError: if it refuses the file; the message carries its words.
        """
        super().__init__(robot)
        if robot.floating_base:
            what = "roboticstoolbox has no floating bases"
            raise UnsupportedError(
                "witness-floating", what, file=robot.description.file, remedy="load it with its base fixed"
            )
        self.model = _read(robot)
        self._names = joint_names(robot)
        links = {link.name: link for link in self.model.links}
        for name in robot.frame_names:
            if name not in links:
                raise EngineError("witness-frames", f"roboticstoolbox has no link {name!r}", where=robot.name)
        self._chains = {name: self.model.ets(end=links[name]) for name in robot.frame_names}
        self._map_coordinates()

    def joints(self) -> Mapping[str, JointView]:
        """The joints as roboticstoolbox saw them, by name: without mimics, and fixed where it can't move them."""
        views = {}
        for link in self.model.links:
            if link.parent is not None:
                kind = "fixed" if not link.isjoint else "revolute" if link.isrevolute else "prismatic"
                limits = None if link.qlim is None else limits_seen(link.qlim[0], link.qlim[1])
                views[self._names[link.name]] = JointView(kind, link.parent.name, link.name, limits)
        return views

    def _map_coordinates(self) -> None:
        """Its coordinates as ``F q[:, at]``; for the joints without one of ours the rows of F are zero."""
        self._at = np.zeros(self._robot.nv, dtype=int)
        self._F = np.zeros((self.model.n, self._robot.nv))
        for link in self.model.links:
            if link.isjoint:
                source = drive(self._robot, self._names[link.name], {})
                if source is not None:
                    self._F[link.jindex, source.v], self._at[source.v] = 1.0, source.q

    def _told(self, q: FloatArray, qd: FloatArray | None, frames: Sequence[str]) -> Told:
        along = np.zeros((len(q), self._robot.nv)) if qd is None else qd
        theirs, rates = q[:, self._at] @ self._F.T, along @ self._F.T
        shape = (len(q), len(frames), 6, self._robot.nv)
        poses = np.empty((len(q), len(frames), 4, 4))
        J, dJ = np.zeros(shape), np.zeros(shape)
        for j, name in enumerate(frames):
            chain = self._chains[name]
            joints = np.asarray(chain.jindices, dtype=int)
            F = self._F[joints]
            for i in range(len(q)):
                x = theirs[i, joints]
                poses[i, j] = chain.eval(x if len(joints) else [])  # an empty array is refused
                if len(joints):
                    J[i, j] = chain.jacob0(x) @ F
                if len(joints) and qd is not None:
                    dJ[i, j] = np.tensordot(chain.hessian0(x), rates[i, joints], (0, 0)) @ F
        return Told(poses, J, dJ, along)


def library() -> Any:
    """The package.

    Raises:
        MissingExtraError: if it is not installed.
    """
    try:
        import roboticstoolbox
    except ImportError:
        raise MissingExtraError("roboticstoolbox is not installed", "rtb") from None
    return roboticstoolbox


def _read(robot: Robot) -> Any:
    model = library().Robot
    # `URDF_file`, the public way, would first have xacro evaluate whatever looks like an expression in a name.
    from roboticstoolbox.models.URDF.URDFRobot import _links_from_urdf
    from roboticstoolbox.tools.urdf import URDF

    text = ET.tostring(plain_urdf(robot), encoding="unicode")
    try:
        links, name = _links_from_urdf(URDF.loadstr(text, None))
        return model(links, name=name)
    except (ValueError, TypeError, LookupError, AttributeError, RuntimeError) as error:
        what = f"roboticstoolbox refuses the file: {error}"
        raise EngineError("witness-refuses", what, where=robot.description.file) from None
