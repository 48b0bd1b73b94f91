"""From rates to coordinates and poses: `pinscrew.integrate`."""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import Decimal
from typing import Final, TypeAlias

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.engines.poe import PoE
from pinscrew.ground.arrays import numbers
from pinscrew.ground.counts import whole
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.motion import schemes
from pinscrew.motion.profile import Profile
from pinscrew.motion.schemes import Scheme
from pinscrew.motion.trajectory import Drift, Trajectory
from pinscrew.robot import manifold
from pinscrew.robot.loading import RobotLike, robot_of
from pinscrew.robot.robot import Robot

__all__ = ["GivenRates", "integrate", "times"]

GivenRates: TypeAlias = Profile | Callable[[float], ArrayLike]
"""Rates over time: a profile, or a function of the time (s) that returns them, shape (nv,), rad/s and m/s."""

MOST_STEPS: Final = 1_000_000
"""Steps of one integration: 1 GB of poses, twists and Jacobians."""


def integrate(
    robot: RobotLike,
    q0: ArrayLike | None,
    qd: GivenRates,
    dt: float,
    scheme: Scheme = "exponential",
    *,
    duration: float | None = None,
    steps: int | None = None,
    start: float | None = None,
    frame: str | None = None,
    engine: Engine | None = None,
    advance: Callable[[str], object] | None = None,
) -> Trajectory:
    """Integrate given rates over time, to coordinates and to the pose of a frame.

    ================  ======================================================  =================================
    scheme            pose after a step                                       coordinates
    ================  ======================================================  =================================
    coursework        T(dx) (I + [δφ]×) A, dx = v δt, δφ = ω δt, hybrid       Euler
    euler             forward kinematics of the coordinates                   Euler: θ + θ̇(t) δt
    rk4               forward kinematics of the coordinates                   classical Runge–Kutta, order 4
    exponential       exp(V̂ˢ δt) T, MLS eq. 2.36                              Euler
    exponential-body  T exp(V̂ᵇ δt)                                            Euler
    ================  ======================================================  =================================

    The twists are Jθ̇ at the begin of a step, with the Jacobian at the integrated coordinates. ``coursework`` is the
    update of the velocity kinematics assignment as it is printed. It leaves SO(3), and turns the position about the
    base's origin, which the hybrid velocity has in it already.

    Args:
        robot: what moves: a robot, or a name or path that `load` takes.
        q0: the first coordinates, shape (nq,); `Robot.neutral` for None.
        qd: the rates: a `Profile`, or a function of time.
        dt: the step δt (s).
        scheme: see the table.
        duration: how long (s), a multiple of ``dt``; by default from ``start`` to the end of a profile.
        steps: how many steps, instead of ``duration``.
        start: the first time (s); by default the profile's, or 0.
        frame: a link's name; by default the robot's tip.
        engine: who computes poses and Jacobians; by default the product of exponentials.
        advance: called with ``"coordinates"`` and with ``"poses"`` when these are done.

    Raises:
        InputError: if ``q0`` or the rates have another shape or hold what is no finite number, a time or the number of
            steps is out of range, there is no such scheme, or numbers overflow.
        UnknownNameError, AmbiguousTipError: see `Robot.frame` and `Profile.columns`.
    """
    scheme = schemes.check(scheme)
    robot = robot_of(robot)
    frame = robot.frame(frame)
    engine = PoE(robot) if engine is None else engine
    t = times(qd, dt, duration=duration, steps=steps, start=start, where=robot.name)
    rates = _rates(robot, qd)
    q = schemes.coordinates(robot, _first(robot, engine, q0), schemes.coordinate_steps(robot, scheme, rates, t, dt))
    given = rates(t)
    advance = advance or (lambda _: None)
    advance("coordinates")
    references = engine.fk(q, frame)
    poses = references if scheme in ("euler", "rk4") else schemes.poses(engine, frame, scheme, q, given, dt)
    if not np.isfinite(poses).all():
        k = int(np.argmin(np.isfinite(poses).all(axis=(-2, -1))))
        what = f"the pose overflows at t = {t[k]:g} s"
        raise InputError("overflow", what, where=robot.name, remedy="use smaller rates or a smaller dt")
    twists = engine.velocity(q, given, frame, "hybrid")
    drift = Drift.of(poses, references)
    advance("poses")
    return Trajectory(robot, frame, scheme, float(dt), t, q, given, poses, twists, drift)


def times(
    qd: GivenRates,
    dt: float,
    *,
    duration: float | None = None,
    steps: int | None = None,
    start: float | None = None,
    where: str = "",
) -> FloatArray:
    """The times of an integration, shape (K + 1,); arguments as of `integrate`.

    Raises:
        InputError: if they are not finite, not positive, no multiple of each other, or too many.
    """
    profile = qd if isinstance(qd, Profile) else None
    step = _number(dt, "dt", where)
    if not step > 0.0:
        raise InputError("dt", f"dt = {step:g} s", where=where, remedy="expected a positive time")
    begin = profile.start if profile else 0.0
    first = begin if start is None else _number(start, "start", where)
    # Times are the decimals that were written, so that three steps of 0.1 end at 0.3 and not just above.
    origin, delta = Decimal(repr(first)), Decimal(repr(step))
    if steps is not None and duration is not None:
        raise InputError("duration", "both steps and a duration are given", where=where, remedy="give one of them")
    if steps is not None:
        count = whole("steps", steps, 1, where=where)
        _few(count, where)
        last = float(origin + delta * count)
    else:
        if duration is not None:
            last = float(origin + Decimal(repr(_number(duration, "duration", where))))
        elif profile is not None:
            last = profile.end
        else:
            raise InputError("duration", "neither steps nor a duration is given", where=where, remedy="give one")
        count = _count(last - first, step, where)
    t = np.array([float(origin + delta * k) for k in range(count + 1)])
    t[-1] = last
    if not (np.diff(t) > 0.0).all():
        what = f"dt = {step:g} s vanishes beside the time {max(abs(first), abs(last)):g} s"
        raise InputError("dt", what, where=where, remedy="use a larger dt")
    return t


def _count(duration: float, dt: float, where: str) -> int:
    """How many steps a duration has."""
    ratio = duration / dt
    _few(ratio, where)
    count = round(ratio)
    if count < 1 or not abs(count * dt - duration) <= 1e-9 * duration:
        what = f"the duration {duration:g} s is no multiple of dt = {dt:g} s"
        near = max(1, count)
        remedy = f"use a duration of {near * dt:g} s, or dt = {duration / near:g} s"
        raise InputError("duration", what, where=where, remedy=remedy if duration > 0.0 else "expected a positive time")
    return count


def _few(count: float, where: str) -> None:
    if not count <= MOST_STEPS:
        what = f"{count:.4g} steps"
        raise InputError("steps", what, where=where, remedy=f"at most {MOST_STEPS}: use a larger dt")


def _number(value: float, name: str, where: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise InputError("not-finite", f"{name} is {value!r}", where=where, remedy="expected a finite time in s")
    return number


def _first(robot: Robot, engine: Engine, q0: ArrayLike | None) -> FloatArray:
    """The first coordinates, checked, with quaternions of norm 1."""
    if q0 is None:
        return robot.neutral.copy()
    engine.fk(q0, robot.base)
    first = np.asarray(q0, dtype=np.float64)
    if first.ndim != 1:
        raise InputError("shape", f"q0 has shape {first.shape}", where=robot.name, remedy=f"expected ({robot.nq},)")
    return manifold.integrate(robot, first, np.zeros(robot.nv))


def _rates(robot: Robot, qd: GivenRates) -> Callable[[FloatArray], FloatArray]:
    """The rates at times (N,), as (N, nv) in the robot's order."""
    if isinstance(qd, Profile):
        columns = qd.columns(robot)
        return lambda t: qd(t)[:, columns]

    if not callable(qd):
        what = f"the rates are {type(qd).__name__}"
        raise InputError("profile-format", what, where=robot.name, remedy="give a Profile or a function of the time")

    def called(t: FloatArray) -> FloatArray:
        out = np.empty((len(t), robot.nv))
        for k, time in enumerate(t):
            out[k] = _one(robot, qd(float(time)), float(time))
        return out

    return called


def _one(robot: Robot, value: ArrayLike, t: float) -> FloatArray:
    rates = numbers(value, f"what the rates are at t = {t:g} s", robot.name)
    if rates.shape != (robot.nv,):
        what = f"the rates at t = {t:g} s have shape {rates.shape}"
        remedy = f"expected ({robot.nv},): {', '.join(robot.velocity_names) or 'the robot has no velocities'}"
        raise InputError("shape", what, where=robot.name, remedy=remedy)
    if not np.isfinite(rates).all():
        what = f"the rates at t = {t:g} s hold NaN or infinity"
        raise InputError("not-finite", what, where=robot.name, remedy="give finite numbers")
    return rates
