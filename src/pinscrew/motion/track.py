"""The experiment of the velocity kinematics assignment: rates to twists and poses, and back: `pinscrew.track`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.engines.poe import PoE
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.motion.bundled_profiles import ASSIGNMENT, named
from pinscrew.motion.integration import GivenRates, integrate
from pinscrew.motion.inverse_velocity import InverseVelocity, Method, inverse_velocity
from pinscrew.motion.profile import Profile
from pinscrew.motion.samples import Between
from pinscrew.motion.schemes import Scheme
from pinscrew.motion.trajectory import Trajectory
from pinscrew.robot.loading import RobotLike, robot_of

__all__ = ["STAGES", "Track", "track"]

STAGES: Final = ("coordinates", "poses", "rates")
"""What `track` computes, one after the other."""


@dataclass(frozen=True, eq=False, repr=False)
class Track:
    """A motion from given rates, and the rates recovered from its twists; `pinscrew.track` makes one.

    Attributes:
        trajectory: coordinates, poses and twists over time; `Trajectory.qd` are the given rates.
        jacobians: hybrid Jacobians at the integrated coordinates, shape (K + 1, 6, nv).
        recovered: the rates that `inverse_velocity` finds for the twists, batch axis (K + 1,).
        method: how they were found.
        profile: where the given rates came from.
    """

    trajectory: Trajectory
    jacobians: FloatArray
    recovered: InverseVelocity
    method: Method
    profile: str

    def __repr__(self) -> str:
        return f"<Track along {self.profile}: {self.trajectory!r}>"

    @property
    def rate_error(self) -> float:
        """Largest difference (rad/s or m/s) between a recovered rate and the given one."""
        return float(abs(self.recovered.qd - self.trajectory.qd).max())

    def index(self, t: float) -> int:
        """Which of the times is ``t`` (s).

        Raises:
            InputError: if none is.
        """
        times, dt = self.trajectory.t, self.trajectory.dt
        near = int(np.argmin(abs(times - t))) if np.isfinite(t) else 0
        if not abs(times[near] - t) <= 1e-6 * dt:
            what = f"t = {t:g} s is none of the times"
            remedy = f"they go from {times[0]:g} to {times[-1]:g} s in steps of {dt:g} s; near is {times[near]:.12g}"
            raise InputError("profile-range", what, where=self.profile, remedy=remedy)
        return near


def track(
    robot: RobotLike,
    profile: GivenRates | str | Path = ASSIGNMENT,
    dt: float = 0.01,
    scheme: Scheme = "exponential",
    *,
    q0: ArrayLike | None = None,
    method: Method = "normal",
    duration: float | None = None,
    between: Between = "linear",
    frame: str | None = None,
    engine: Engine | None = None,
    advance: Callable[[str], object] | None = None,
) -> Track:
    """Move a robot along given rates, and recover these from the twists of a frame.

    At each time, ξ = Jʰ(θ) θ̇ and θ̇ = (JᵀJ)⁻¹ Jᵀ ξ again, with θ integrated from the given rates.

    Args:
        robot: what moves: a robot, or a name or path that `load` takes.
        profile: the given rates: ``"assignment"``, which some bundled robots have, a file, a `Profile`, or a function
            of the time (s).
        dt: the step (s).
        scheme: how poses and coordinates are integrated; see `integrate`.
        q0: the first coordinates, shape (nq,); by default `Robot.neutral`.
        method: of `inverse_velocity`.
        duration: how long (s), a multiple of ``dt``; by default all of the profile.
        between: what rates of a CSV file are between its rows: ``"linear"`` or ``"hold"``.
        frame: a link's name; by default the robot's tip.
        engine: who computes poses and Jacobians; by default the product of exponentials.
        advance: called with the name of each of `STAGES` when it is done.

    Raises:
        UnknownNameError: if there is no such profile, frame or velocity.
        DescriptionError: if a profile's file can't be used.
        InputError: see `integrate`, and `inverse_velocity` for ``normal`` where the Jacobian loses rank.
    """
    robot = robot_of(robot)
    rates = named(profile, robot, between) if isinstance(profile, (str, Path)) else profile
    source = rates.source if isinstance(rates, Profile) else getattr(rates, "__name__", "a function")
    engine = PoE(robot) if engine is None else engine
    trajectory = integrate(robot, q0, rates, dt, scheme, duration=duration, frame=frame, engine=engine, advance=advance)
    jacobians = engine.jacobian(trajectory.q, trajectory.frame, "hybrid")
    recovered = inverse_velocity(jacobians, trajectory.twists, method)
    if advance is not None:
        advance("rates")
    return Track(trajectory, jacobians, recovered, method, source)
