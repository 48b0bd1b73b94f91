"""``pinscrew fk``: the pose of a frame, from both engines."""

from __future__ import annotations

import sys

import click

from pinscrew.cli import arguments, output

__all__ = ["command"]


@click.command(name="fk", short_help="Print the pose of a frame, from both engines.")
@arguments.robot_argument()
@arguments.q_option
@arguments.tip_option
@arguments.json_option
def command(words: tuple[str, ...], values: str | None, tip: str | None, as_json: bool) -> None:
    """Print the pose of a frame in the base frame, and by how much the two engines differ.

    \b
      pinscrew fk scara -q 45deg,pi/4,0.1
      pinscrew fk scara l1:=0.5 -q joint3=0.1 --tip link2
    """
    import pinscrew as ps
    from pinscrew.verification.comparison import pose_error
    from pinscrew.verification.configurations import sizes
    from pinscrew.verification.run import TOLERANCE

    robot = arguments.robot(words).load()
    q, frame = arguments.configuration(robot, values), robot.frame(tip)
    T_base_frame = ps.PoE(robot).fk(q, frame)
    other = ps.Pinocchio(robot).fk(q, frame)
    error = float(pose_error(T_base_frame[None], other[None], sizes(robot, q[None]))[0])
    if as_json:
        document = {
            "schema": "pinscrew.fk/1",
            "robot": robot.name,
            "base": robot.base,
            "frame": frame,
            "q": dict(zip(robot.coordinate_names, output.plain(q), strict=True)),
            "pose": output.plain(T_base_frame),
            "difference": error,
        }
        output.print_json(document)
    else:
        output.say(f"{frame} in {robot.base}:", *output.matrix_lines(T_base_frame))
        output.say(f"PoE and Pinocchio differ by {error:.1e}", err=True)
    if not error <= TOLERANCE:
        sys.exit(1)
