"""A DH table held against both engines."""

from __future__ import annotations

from typing import Final

import numpy as np

from pinscrew.dh.table import DHTable
from pinscrew.engines.pair import pair_of
from pinscrew.lie import se3
from pinscrew.robot.robot import Robot
from pinscrew.verification.comparison import pose_error
from pinscrew.verification.configurations import configurations

__all__ = ["DH_TOLERANCE", "dh_differences"]

DH_TOLERANCE: Final = 1e-9
"""Rounding of a table: lengths and angles are put right by up to 5e-11 in each row."""


def dh_differences(table: DHTable, robot: Robot, *, samples: int = 50, seed: int = 0) -> dict[str, float]:
    """Largest difference of the table's poses to each engine's: rad, and m divided by the robot's size.

    Args:
        table: the table.
        robot: the robot it is of.
        samples: how many configurations at random, besides zero, the limits and far outside.
        seed: of the random numbers.

    Raises:
        EngineError, UnsupportedError: if Pinocchio does not take the robot.
    """
    where = configurations(robot, samples, seed)
    ours = np.stack([table.fk(q) for q in where.q])
    T_reference_base = se3.inverse(robot.home(table.base))  # T_base_0 may be in another frame fixed to the base
    return {
        engine.name: float(pose_error(ours, T_reference_base @ engine.fk(where.q, table.tip), where.scales).max())
        for engine in pair_of(robot)
    }
