"""Central finite differences of forward kinematics against the body Jacobian.

Let u = 2⁻⁵³ be the unit of rounding and s the robot's size; a coordinate may drive several joints, so let
g be the largest sum of multipliers. Every derivative of a pose by a coordinate brings at most a factor g (a
rotation's entries and its lever arm stay within 1 and s), so the third is at most g³ s and the truncation of a
central difference with step h is at most h² g³ s / 6. The pose itself is off by at most about 4 u s for each of the
k joints on the way (measured: less than 1 u s), and a coordinate of size a by u a, which turns joints by up to g u a;
the difference magnifies both by 1/h.
With h = u^(1/3) / g all are multiples of u^(2/3) g s, and the tolerance, s divided out, is
u^(2/3) g (1/6 + 4 (k + 1) + g a).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.robot.manifold import integrate
from pinscrew.robot.robot import Robot
from pinscrew.verification.comparison import Worst, jacobian_error
from pinscrew.verification.configurations import angles

__all__ = ["POINTS", "check_name", "compare_differences", "difference_frames", "tolerance"]

UNIT: Final = 2.0**-53
POINTS: Final = 4
"""Configurations at which differences are taken."""


def check_name(engine: str) -> str:
    """What the check of an engine's own Jacobians is called."""
    return f"finite differences of FK in {engine}"


def difference_frames(robot: Robot, frames: tuple[str, ...]) -> tuple[str, ...]:
    """Leaves among ``frames``: every joint moves one of them. Without a leaf, all."""
    leaves = set(robot.description.leaves)
    return tuple(frame for frame in frames if frame in leaves) or frames


def tolerance(robot: Robot, q: FloatArray) -> float:
    """What truncation and rounding may leave at configurations ``q``; the module's docstring derives it."""
    largest = float(abs(q[:, angles(robot)]).max(initial=0.0))
    joints = len(robot.mechanism.motions)
    gain = _gain(robot)
    return float(UNIT ** (2 / 3) * gain * (1 / 6 + 4 * (joints + 1) + gain * largest))


def compare_differences(engine: Engine, q: FloatArray, scales: FloatArray, frames: tuple[str, ...]) -> Worst:
    """The check of ``frames`` at configurations ``q`` (N, nq), whose sizes are ``scales`` (N,)."""
    robot = engine.robot
    check = Worst(check_name(engine.name), tolerance(robot, q))
    h = UNIT ** (1 / 3) / _gain(robot)
    steps = np.concatenate([np.eye(robot.nv), -np.eye(robot.nv)]) * h
    moved = integrate(robot, q[:, None], steps)
    errors = []
    for frame in frames:
        poses = engine.fk(moved, frame)
        rates = (poses[:, : robot.nv] - poses[:, robot.nv :]) / (2 * h)
        hats = se3.inverse(engine.fk(q, frame))[:, None] @ rates
        J = np.moveaxis(se3.vee(hats), 1, 2)
        errors.append(jacobian_error(engine.jacobian(q, frame, "body"), J, scales))
    check.see(np.stack(errors, axis=1))
    return check


def _gain(robot: Robot) -> float:
    """The largest sum of multipliers with which one coordinate moves joints."""
    gains = np.ones(max(robot.nv, 1))
    for motion in robot.mechanism.motions:
        if motion.joint.mimic is not None:
            gains[motion.v] += abs(motion.multiplier)
    return float(gains.max())
