"""A `Track` to look at: rates given and recovered, how far the poses drifted, and manipulability, over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pinscrew.ground.escaping import plot
from pinscrew.ground.typing import FloatArray
from pinscrew.motion.track import Track
from pinscrew.robot.robot import Robot
from pinscrew.view import figures

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["plot_track"]

MOST_PANELS: Final = 8
"""Velocities that get a panel of their own; more are drawn in one."""
ROUNDING: Final = 1e-17
"""What a logarithmic axis shows for 0."""
_GIVEN: Final[dict[str, Any]] = {"color": "#9ecae1", "linewidth": 4.0}
_RECOVERED: Final[dict[str, Any]] = {"color": "#08519c", "linewidth": 1.2, "linestyle": "--"}


def plot_track(track: Track) -> Figure:
    """The figure of a track, to be written by `figures.save`.

    Raises:
        MissingExtraError: if matplotlib is not installed.
    """
    run = track.trajectory
    names = run.robot.velocity_names
    panels = len(names) if len(names) <= MOST_PANELS else 1
    figure = figures.figure(11.0, max(6.0, 1.7 * panels))
    figure.suptitle(f"{plot(run.robot.name)}: {plot(run.frame)}, scheme {run.scheme}, δt = {run.dt:g} s")
    left, right = figure.subfigures(1, 2, squeeze=False)[0]
    _rates(left.subplots(panels, 1, sharex=True, squeeze=False)[:, 0], track)
    position, rotation, manipulability = right.subplots(3, 1, sharex=True)
    _drift(position, run.t, {"position (m)": run.drift.position, "angle (rad)": run.drift.angle})
    position.set_title("pose error against forward kinematics", fontsize="medium")
    lengths = abs(run.drift.column_lengths - 1.0).max(axis=-1)
    _drift(rotation, run.t, {"‖RᵀR − I‖": run.drift.orthogonality, "largest |column length − 1|": lengths})
    rotation.set_title("distance from SO(3)", fontsize="medium")
    manipulability.plot(run.t, track.recovered.manipulability, color="#08519c")
    manipulability.set_title("manipulability: product of the singular values of J", fontsize="medium")
    manipulability.set_ylim(0.0, 1.1 * max(1e-12, float(track.recovered.manipulability.max())))
    manipulability.grid(alpha=0.3)
    manipulability.set_xlabel("t (s)")
    return figure


def _rates(panels: list[Axes], track: Track) -> None:
    run = track.trajectory
    for i, name in enumerate(run.robot.velocity_names):
        panel = panels[i if len(panels) > 1 else 0]
        first = i == 0
        panel.plot(run.t, run.qd[:, i], label="given" if first else None, **_GIVEN)
        panel.plot(run.t, track.recovered.qd[:, i], label="recovered" if first else None, **_RECOVERED)
        if len(panels) == len(run.robot.velocity_names):
            panel.set_ylabel(f"{plot(name)}\n({_unit(run.robot, i)})", fontsize="small")
    for panel in panels:
        panel.grid(alpha=0.3)
        low, high = panel.get_ylim()  # not so near that a constant rate shows its rounding
        margin = max(0.0, 0.05 * max(abs(low), abs(high), 1e-6) - 0.5 * (high - low))
        panel.set_ylim(low - margin, high + margin)
    panels[0].set_title("rates", fontsize="medium")
    panels[0].legend(loc="best", fontsize="small")
    panels[-1].set_xlabel("t (s)")


def _unit(robot: Robot, index: int) -> str:
    """The unit of an entry of ``qd``."""
    for motion in robot.mechanism.motions:
        if motion.joint.mimic is None and motion.v <= index < motion.velocities.stop:
            turns = bool(motion.twists[3:, index - motion.v].any())
            return "rad/s" if turns else "m/s"
    raise IndexError(index)


def _drift(panel: Axes, t: FloatArray, curves: dict[str, FloatArray]) -> None:
    """Curves on a logarithmic axis, on which 0 is drawn as what rounding could leave."""
    for (name, values), color in zip(curves.items(), ("#08519c", "#d95f02"), strict=True):
        panel.plot(t, np.maximum(values, ROUNDING), label=name, color=color, linewidth=1.2)
    panel.set_yscale("log")
    panel.set_ylim(ROUNDING, 10.0 * max(1e-12, *(float(values.max()) for values in curves.values())))
    panel.legend(loc="best", fontsize="small")
    panel.grid(alpha=0.3)
