"""``pinscrew track``: given rates, the motion they make, and the rates recovered from it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from pinscrew.cli import arguments, output
from pinscrew.cli.progress import progress
from pinscrew.ground import files

if TYPE_CHECKING:
    from pinscrew.ground.typing import FloatArray
    from pinscrew.motion.track import Track

__all__ = ["command"]

_SCHEMES = ("exponential", "exponential-body", "coursework", "euler", "rk4")


@click.command(name="track", short_help="Move along given rates, and recover them.")
@arguments.robot_argument()
@arguments.q_option
@arguments.tip_option
@click.option(
    "--profile",
    default="assignment",
    show_default=True,
    metavar="NAME|FILE",
    help="The given rates: pieces in YAML, a table in CSV, or the assignment's own where the robot has one.",
)
@click.option(
    "--between",
    type=click.Choice(["linear", "hold"]),
    default="linear",
    show_default=True,
    help="What rates of a CSV file are between its rows.",
)
@click.option("--dt", default="0.01", show_default=True, metavar="SECONDS", help="The step.")
@click.option("--duration", metavar="SECONDS", help="How long; by default all of the profile.")
@click.option(
    "--scheme",
    type=click.Choice(_SCHEMES),
    default="exponential",
    show_default=True,
    help="How the pose goes on; coursework is the assignment's update with its errors.",
)
@click.option(
    "--method",
    type=click.Choice(["normal", "pinv", "damped"]),
    default="normal",
    show_default=True,
    help="How rates are recovered: (JᵀJ)⁻¹Jᵀ, by singular values, or by damped least squares.",
)
@click.option("--at", metavar="SECONDS", help="The time to print; by default the begin of the last step.")
@click.option("--csv", "csv_file", type=output.FILE, help="Write a row for each time to this file.")
@click.option("--npz", "npz_file", type=output.FILE, help="Write all arrays to this file, for numpy.load.")
@click.option("--plot", "plot_file", type=output.FILE, help="Draw rates and drift to this file: .png, .svg or .pdf.")
@arguments.json_option
def command(
    words: tuple[str, ...],
    values: str | None,
    tip: str | None,
    at: str | None,
    dt: str,
    duration: str | None,
    csv_file: Path | None,
    npz_file: Path | None,
    plot_file: Path | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Integrate given joint rates, and recover them from the velocity of a frame.

    Printed are, at one time, the velocity, the pose increments, the Jacobian and the pose before and after the step;
    and over all times how well the rates came back, and how far the pose drifted.

    \b
      pinscrew track anthropomorphic
      pinscrew track anthropomorphic --scheme coursework --at 5 --json
      pinscrew track anthropomorphic --dt 0.1 --plot rates.svg
    """
    from pinscrew.motion import formats
    from pinscrew.motion.track import STAGES, track

    if plot_file is not None:
        from pinscrew.view import figures

        figures.check(plot_file)
    robot = arguments.robot(words).load()
    options |= {"q0": arguments.configuration(robot, values), "frame": tip, "dt": arguments.number(dt, "--dt")}
    if duration is not None:
        options["duration"] = arguments.number(duration, "--duration")
    with progress("integrating", len(STAGES)) as advance:
        found = track(robot, advance=lambda stage: advance(1, stage), **options)
    run = found.trajectory
    index = run.steps - 1 if at is None else found.index(arguments.number(at, "--at"))
    if csv_file is not None:
        output.write_file(csv_file, formats.to_csv(found))
    if npz_file is not None:
        files.write(npz_file, formats.to_npz(found))
    if plot_file is not None:
        from pinscrew.view.plot_track import plot_track

        figures.save(plot_track(found), plot_file)
    if as_json:
        output.print_json(formats.document(found, index))
    else:
        _print(found, index)


def _print(found: Track, index: int) -> None:
    run, recovered, drift = found.trajectory, found.recovered, found.trajectory.drift
    robot = run.robot
    output.say(f"{robot.name}: {run.frame} in {robot.base}, {run.steps} steps of {run.dt:g} s, scheme {run.scheme}")
    output.say("", f"at t = {run.t[index]:.12g} s")
    for name, q in zip(robot.coordinate_names, run.q[index], strict=True):
        output.say(f"  {name} = {_digits(q)}")
    table = output.table("velocity", "given", "recovered")
    for i, name in enumerate(robot.velocity_names):
        table.add_row(name, _digits(run.qd[index, i]), _digits(recovered.qd[index, i]))
    output.console().print(table)
    twist, increment = run.twists[index], run.increments[index]
    for label, vector in (
        ("linear velocity v (m/s)", twist[:3]),
        ("angular velocity ω (rad/s)", twist[3:]),
        ("increment dx = v δt (m)", increment[:3]),
        ("increment δφ = ω δt (rad)", increment[3:]),
    ):
        output.say(f"{label:27s}{'  '.join(_digits(x).rjust(11) for x in vector)}")
    _matrix("hybrid Jacobian J, its rows (v, ω)", found.jacobians[index])
    _matrix(f"A({run.t[index]:.12g} s), the pose", run.poses[index])
    if index < run.steps:
        _matrix(f"A({run.t[index + 1]:.12g} s), the pose after the step", run.poses[index + 1])
    output.say("", f"at all of the {run.steps + 1} times")
    output.say(f"  recovered rates differ from the given ones by at most {found.rate_error:.1e}")
    output.say(f"  condition of J at most {recovered.condition.max():.3g}")
    lengths = ", ".join(f"{length:.6f}" for length in drift.column_lengths[-1])
    output.say(f"  ‖RᵀR - I‖ at most {drift.orthogonality.max():.1e}; columns of R at the end {lengths}")
    output.say(
        f"  off the pose of the coordinates by at most {drift.position.max():.1e} m and {drift.angle.max():.1e} rad, "
        f"at the end {drift.position[-1]:.1e} m and {drift.angle[-1]:.1e} rad"
    )


def _matrix(title: str, values: FloatArray) -> None:
    output.say(f"{title}:")
    for line in output.matrix_lines(values):
        output.say(f"  {line}")


def _digits(value: float) -> str:
    return f"{round(value, 8) + 0.0:.8f}"
