"""The schemes: how coordinates and poses go one step on.

Coordinates go on by Euler's rule but in ``rk4``. The poses of ``euler`` and ``rk4`` are those of the coordinates; the
others carry the pose on by itself, from the velocities that the coordinates have at the begin of each step, and so
can drift from it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, Literal, TypeAlias, get_args

import numpy as np

from pinscrew.description.model import SCALAR_TYPES
from pinscrew.engines.base import Engine
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3, so3
from pinscrew.robot import manifold
from pinscrew.robot.robot import Robot

__all__ = ["SCHEMES", "Scheme", "check", "coordinate_steps", "coordinates", "poses"]

Scheme: TypeAlias = Literal["coursework", "euler", "rk4", "exponential", "exponential-body"]

SCHEMES: Final[tuple[Scheme, ...]] = get_args(Scheme)


def check(scheme: str) -> Scheme:
    """The scheme of this name.

    Raises:
        InputError: if there is none.
    """
    for known in SCHEMES:
        if scheme == known:
            return known
    raise InputError("scheme", f"there is no scheme {scheme!r}", remedy=f"use {', '.join(SCHEMES)}")


def coordinate_steps(
    robot: Robot, scheme: Scheme, rates: Callable[[FloatArray], FloatArray], t: FloatArray, dt: float
) -> FloatArray:
    """What each step adds to the coordinates: velocities times time, shape (K, nv).

    Rates depend on time alone, so that the classical fourth-order Runge–Kutta rule is Simpson's. Planar and floating
    joints move by twists, which don't commute; theirs is the fourth-order Magnus rule for T' = T V̂ᵇ: Iserles,
    Munthe-Kaas, Nørsett and Zanna, "Lie-group methods", Acta Numerica 9, 2000, doi:10.1017/S0962492900002154.
    """
    at = rates(t)
    if scheme != "rk4":
        return at[:-1] * dt
    begin, middle, end = at[:-1], rates(t[:-1] + 0.5 * dt), at[1:]
    steps = (begin + 4.0 * middle + end) * (dt / 6.0)
    for motion in robot.mechanism.motions:
        if motion.joint.type in SCALAR_TYPES:
            continue
        # A planar joint's velocities (vx, vy, ωz) are the twist's entries 0, 1 and 5.
        entries = [0, 1, 5] if motion.joint.type == "planar" else list(range(6))
        first, last = np.zeros((2, len(steps), 6))
        first[:, entries], last[:, entries] = begin[:, motion.velocities], end[:, motion.velocities]
        # T' = T V̂ goes on by exp(Ω) with Ω = ∫V dt + ½∫∫[V(s), V(r)] dr ds …; with V linear between its
        # ends, the commutator term is dt²/12 [V(0), V(dt)].
        bracket = (se3.ad(first) @ last[:, :, None])[:, :, 0]
        steps[:, motion.velocities] += (dt**2 / 12.0) * bracket[:, entries]
    return steps


def coordinates(robot: Robot, q0: FloatArray, steps: FloatArray) -> FloatArray:
    """The coordinates after each step, ``q0`` (nq,) and steps (K, nv) to (K + 1, nq)."""
    if all(motion.joint.type in SCALAR_TYPES for motion in robot.mechanism.motions):
        return np.cumsum(np.concatenate([q0[None], steps]), axis=0)
    q = np.empty((len(steps) + 1, robot.nq))
    q[0] = q0
    for k, step in enumerate(steps):
        q[k + 1] = manifold.integrate(robot, q[k], step)
    return q


def poses(engine: Engine, frame: str, scheme: Scheme, q: FloatArray, qd: FloatArray, dt: float) -> FloatArray:
    """The integrated poses, shape (K + 1, 4, 4), beginning with that of ``q[0]``.

    Args:
        engine: of the robot.
        frame: whose pose it is.
        scheme: one that carries the pose by itself.
        q: coordinates at each time, shape (K + 1, nq).
        qd: rates at each time, shape (K + 1, nv).
        dt: the step (s).
    """
    begin, rates = q[:-1], qd[:-1]
    if scheme == "coursework":
        steps = _printed(engine.velocity(begin, rates, frame, "hybrid") * dt)
    else:
        kind = "spatial" if scheme == "exponential" else "body"
        steps = se3.exp(engine.velocity(begin, rates, frame, kind) * dt)
    out = np.empty((len(q), 4, 4))
    out[0] = engine.fk(q[0], frame)
    with np.errstate(over="ignore", invalid="ignore"):
        for k, step in enumerate(steps):
            if scheme == "exponential-body":
                np.matmul(out[k], step, out=out[k + 1])
            else:
                np.matmul(step, out[k], out=out[k + 1])
    return out


def _printed(increments: FloatArray) -> FloatArray:
    """T(dx) R(δφ) with R = I + [δφ]×, as the coursework prints it: increments (K, 6) to (K, 4, 4)."""
    step = np.zeros((len(increments), 4, 4))
    step[:, :3, :3] = np.eye(3) + so3.hat(increments[:, 3:])
    step[:, :3, 3] = increments[:, :3]
    step[:, 3, 3] = 1.0
    return step
