"""Other people's engines by name, to hold ours against: the witnesses."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any, Final

from pinscrew.ground.errors import UnknownNameError

if TYPE_CHECKING:
    from pinscrew.engines.base import Engine
    from pinscrew.robot.loading import RobotLike

__all__ = ["WITNESSES", "require", "witness"]

WITNESSES: Final = {
    "mujoco": ("pinscrew.witnesses.mujoco", "MuJoCo"),
    "roboticstoolbox": ("pinscrew.witnesses.roboticstoolbox", "RoboticsToolbox"),
}
"""The module and class of each witness; none is needed, and each is an extra."""


def witness(name: str, robot: RobotLike) -> Engine:
    """Another library's kinematics of a robot, from the library's own reading of the file.

    Compare it with ours by ``verify(robot, engines=(PoE(robot), witness("mujoco", robot)))``.

    Args:
        name: ``"mujoco"`` or ``"roboticstoolbox"``.
        robot: a robot, or a name or path that `load` takes.

    Raises:
        UnknownNameError: if there is no such witness.
        MissingExtraError: if its package is not installed.
        EngineError, UnsupportedError: if it does not take the robot.
    """
    from pinscrew.robot.loading import robot_of  # the command line asks for the names alone, and is quick

    require(name)
    robot = robot_of(robot)
    module, attribute = WITNESSES[name]
    if name == "mujoco" and robot.description.mjcf is not None:  # which it reads itself
        module, attribute = "pinscrew.witnesses.mjcf", "MuJoCoFile"
    engine: Engine = getattr(importlib.import_module(module), attribute)(robot)
    return engine


def require(name: str) -> None:
    """Check that there is such a witness, and that its package is installed.

    Raises:
        UnknownNameError: if there is no such witness.
        MissingExtraError: if its package is not installed.
    """
    if name not in WITNESSES:
        raise UnknownNameError("unknown-witness", "witness", name, tuple(WITNESSES))
    module: Any = importlib.import_module(WITNESSES[name][0])
    module.library()
