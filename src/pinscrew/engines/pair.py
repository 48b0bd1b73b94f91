"""The two engines whose answers are held against each other."""

from __future__ import annotations

from pinscrew.engines.base import Engine
from pinscrew.robot.robot import Robot

__all__ = ["pair_of"]


def pair_of(robot: Robot) -> tuple[Engine, Engine]:
    """`PoE` and `Pinocchio` of a robot.

    Raises:
        EngineError, UnsupportedError: if Pinocchio does not take the robot.
    """
    from pinscrew.engines.pinocchio import Pinocchio
    from pinscrew.engines.poe import PoE

    return PoE(robot), Pinocchio(robot)
