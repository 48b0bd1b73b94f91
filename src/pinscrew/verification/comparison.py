"""Differences between answers: scaled, NaN-proof, and with the place of the largest."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from pinscrew.engines.base import Answers
from pinscrew.ground.typing import KINDS, FloatArray
from pinscrew.lie import se3
from pinscrew.robot.robot import Robot
from pinscrew.verification.configurations import Configurations
from pinscrew.verification.outcome import Check, ErrorPlace

__all__ = [
    "Worst",
    "compare_answers",
    "compare_identities",
    "jacobian_error",
    "pose_error",
    "see_answers",
    "see_identities",
]


def pose_error(a: FloatArray, b: FloatArray, scales: FloatArray) -> FloatArray:
    """Largest difference of each pair of poses (N, ..., 4, 4), metres divided by ``scales`` (N,): shape (N, ...)."""
    difference = abs(a - b)
    difference[..., :3, 3] /= scales.reshape(-1, *[1] * (a.ndim - 2))
    return _no_nan(difference.max(axis=(-2, -1)))


def jacobian_error(a: FloatArray, b: FloatArray, scales: FloatArray) -> FloatArray:
    """Largest difference in each column of Jacobians (N, ..., 6, n), the v rows divided by ``scales``: (N, ..., n)."""
    difference = abs(a - b)
    difference[..., :3, :] /= scales.reshape(-1, *[1] * (a.ndim - 1))
    return _no_nan(difference.max(axis=-2))


def _no_nan(error: FloatArray) -> FloatArray:
    return np.where(np.isnan(error), np.inf, error)


@dataclass
class Worst:
    """The largest error of one check so far, and where it was."""

    name: str
    tolerance: float
    error: float = 0.0
    at: tuple[int, ...] = field(default=())
    """Index of the configuration, the frame and, for Jacobians, the column."""

    def see(self, errors: FloatArray, start: int = 0) -> None:
        """Take in errors (N, F) or (N, F, n) of configurations from index ``start``."""
        if not errors.size:
            return
        index = np.unravel_index(int(errors.argmax()), errors.shape)
        error = float(errors[index])
        if not self.at or error > self.error:
            self.error = error
            self.at = (int(index[0]) + start, *map(int, index[1:]))

    def check(self, robot: Robot, frames: tuple[str, ...], where: Configurations) -> Check:
        """The outcome, with names for the indices."""
        if not self.at or self.error == 0.0:
            return Check(self.name, self.error, self.tolerance)
        configuration, frame = self.at[0], frames[self.at[1]]
        above = robot.mechanism.motion_above[frame]
        joint = robot.mechanism.motions[above].joint.name if above >= 0 else ""
        if len(self.at) > 2:
            joint = robot.velocity_names[self.at[2]]
        place = ErrorPlace(frame, joint, where.labels[configuration], tuple(map(float, where.q[configuration])))
        return Check(self.name, self.error, self.tolerance, place)


def compare_answers(tolerance: float) -> dict[str, Worst]:
    """The checks between two engines' answers, for `see_answers`."""
    names = ["forward kinematics"]
    names += [f"{kind} Jacobian" for kind in KINDS]
    names += [f"{kind} Jacobian derivative" for kind in KINDS]
    return {name: Worst(name, tolerance) for name in names}


def see_answers(
    checks: dict[str, Worst], a: Answers, b: Answers, scales: FloatArray, fastest: FloatArray, start: int
) -> None:
    """Take the answers of two engines at a block of configurations into their checks.

    Columns of Jacobians are divided by how fast their velocity moves joints (``fastest``: `configurations.speeds`),
    those of derivatives, which are sums of products of two, by that and by the largest of all.
    """
    twice = fastest * fastest.max(initial=1.0)
    checks["forward kinematics"].see(pose_error(a.poses, b.poses, scales), start)
    for kind in KINDS:
        checks[f"{kind} Jacobian"].see(jacobian_error(a.jacobians[kind], b.jacobians[kind], scales) / fastest, start)
        rates = jacobian_error(a.derivatives[kind], b.derivatives[kind], scales) / twice
        checks[f"{kind} Jacobian derivative"].see(rates, start)


def compare_identities(engine: str, tolerance: float) -> tuple[Worst, Worst]:
    """The checks of one engine's Jacobians against each other, for `see_identities`."""
    return Worst(f"J_s = Ad(T) J_b in {engine}", tolerance), Worst(f"J_h = diag(R, R) J_b in {engine}", tolerance)


def see_identities(
    checks: tuple[Worst, Worst], a: Answers, scales: FloatArray, fastest: FloatArray, start: int
) -> None:
    """Take an engine's three Jacobians at a block of configurations into their checks; see `see_answers`."""
    body = a.jacobians["body"]
    turned = np.empty_like(body)
    R = a.poses[..., :3, :3]
    turned[..., :3, :], turned[..., 3:, :] = R @ body[..., :3, :], R @ body[..., 3:, :]
    adjoint = se3.adjoint(a.poses)
    checks[0].see(jacobian_error(a.jacobians["spatial"], adjoint @ body, scales) / fastest, start)
    checks[1].see(jacobian_error(a.jacobians["hybrid"], turned, scales) / fastest, start)
