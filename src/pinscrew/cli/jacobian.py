"""``pinscrew jacobian``: a Jacobian of a frame, from both engines."""

from __future__ import annotations

import sys

import click

from pinscrew.cli import arguments, output

__all__ = ["command"]

_ROWS = ("vx", "vy", "vz", "wx", "wy", "wz")


@click.command(name="jacobian", short_help="Print a Jacobian, from both engines.")
@arguments.robot_argument()
@arguments.q_option
@click.option(
    "--kind",
    type=click.Choice(["spatial", "body", "hybrid", "WORLD", "LOCAL", "LOCAL_WORLD_ALIGNED"]),
    required=True,
    help="Which Jacobian: spatial (Pinocchio's WORLD), body (LOCAL) or hybrid (LOCAL_WORLD_ALIGNED).",
)
@arguments.tip_option
@arguments.json_option
def command(words: tuple[str, ...], values: str | None, kind: str, tip: str | None, as_json: bool) -> None:
    """Print a Jacobian, its rows (v, ω), and by how much the two engines differ.

    \b
      pinscrew jacobian scara -q 45deg,pi/4,0.1 --kind body
    """
    import pinscrew as ps
    from pinscrew.ground.typing import jacobian_kind
    from pinscrew.verification.comparison import jacobian_error
    from pinscrew.verification.configurations import sizes
    from pinscrew.verification.run import TOLERANCE

    robot = arguments.robot(words).load()
    q, frame, which = arguments.configuration(robot, values), robot.frame(tip), jacobian_kind(kind)
    J = ps.PoE(robot).jacobian(q, frame, which)
    other = ps.Pinocchio(robot).jacobian(q, frame, which)
    error = float(jacobian_error(J[None], other[None], sizes(robot, q[None])).max(initial=0.0))
    if as_json:
        document = {
            "schema": "pinscrew.jacobian/1",
            "robot": robot.name,
            "base": robot.base,
            "frame": frame,
            "kind": which,
            "rows": list(_ROWS),
            "columns": list(robot.velocity_names),
            "q": dict(zip(robot.coordinate_names, output.plain(q), strict=True)),
            "jacobian": output.plain(J),
            "difference": error,
        }
        output.print_json(document)
    else:
        output.say(f"{which} Jacobian of {frame}; columns: {', '.join(robot.velocity_names)}")
        for row, line in zip(_ROWS, output.matrix_lines(J), strict=True):
            output.say(f"{row}  {line}")
        output.say(f"PoE and Pinocchio differ by {error:.1e}", err=True)
    if not error <= TOLERANCE:
        sys.exit(1)
