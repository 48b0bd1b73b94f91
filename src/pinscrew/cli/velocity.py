"""``pinscrew velocity``: the twist of a frame and the velocity of a point of it, from both engines."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from pinscrew.cli import arguments, moving, output

if TYPE_CHECKING:
    from pinscrew.ground.typing import FloatArray

__all__ = ["command"]

_ROWS = ("vx", "vy", "vz", "wx", "wy", "wz")


@click.command(name="velocity", short_help="Print the velocity of a frame or point, from both engines.")
@arguments.robot_argument()
@arguments.q_option
@click.option(
    "--qd",
    "rates",
    metavar="VALUES",
    required=True,
    help="Joint velocities in rad/s and m/s, written as for -q.",
)
@click.option(
    "--point",
    "place",
    metavar="X,Y,Z",
    help="A point in the frame that moves with it; X,Y,Z@FRAME names the frame too. By default its origin.",
)
@arguments.tip_option
@click.option(
    "--kind",
    type=click.Choice(["all", "spatial", "body", "hybrid", "geometric", "WORLD", "LOCAL", "LOCAL_WORLD_ALIGNED"]),
    default="all",
    show_default=True,
    help="Which twist: spatial (Pinocchio's WORLD), body (LOCAL), hybrid or geometric (LOCAL_WORLD_ALIGNED).",
)
@arguments.json_option
def command(
    words: tuple[str, ...],
    values: str | None,
    rates: str,
    place: str | None,
    tip: str | None,
    kind: str,
    as_json: bool,
) -> None:
    """Print the twist (v, ω) of a frame and the velocity of a point that moves with it, in the axes of the base and of
    the frame, and by how much the two engines differ.

    \b
      pinscrew velocity two_joint -q pi/2,0 --qd 1,1
      pinscrew velocity scara -q pi/4,0.5,0.1 --qd 1,1,0 --point 0,0,0.3
      pinscrew velocity two_joint --qd 1,0 --point 0,0,10cm@A --kind body
    """
    import pinscrew as ps
    from pinscrew.ground.typing import KINDS, jacobian_kind
    from pinscrew.motion.velocities import difference, frame_velocity
    from pinscrew.verification.configurations import sizes
    from pinscrew.verification.run import TOLERANCE

    robot = arguments.robot(words).load()
    point, tip = ((0.0, 0.0, 0.0), tip) if place is None else moving.point(place, tip)
    q, qd, frame = arguments.configuration(robot, values), moving.rates(robot, rates), robot.frame(tip)
    kinds = KINDS if kind == "all" else (jacobian_kind("hybrid" if kind == "geometric" else kind),)
    found, other = (frame_velocity(engine(robot), q, qd, frame, point) for engine in (ps.PoE, ps.Pinocchio))
    speed = max(1.0, float(abs(qd).max(initial=0.0)))  # rounding grows with the velocities
    error = difference(found, other, float(sizes(robot, q[None])[0])) / speed
    if as_json:
        document = {
            "schema": "pinscrew.velocity/1",
            "robot": robot.name,
            "base": robot.base,
            "frame": frame,
            "q": dict(zip(robot.coordinate_names, output.plain(q), strict=True)),
            "qd": dict(zip(robot.velocity_names, output.plain(qd), strict=True)),
            "rows": list(_ROWS),
            "twists": {each: output.plain(found.twists[each]) for each in kinds},
            "point": list(point),
            "point_in_base": output.plain(found.point_base),
            "point_velocity": {
                "base": output.plain(found.point_velocity),
                "frame": output.plain(found.point_velocity_body),
            },
            "difference": error,
        }
        output.print_json(document)
    else:
        width = max(map(len, kinds))
        output.say(f"twists of {frame} in {robot.base} (v, ω), m/s and rad/s", f"{' ' * width}  {_cells(_ROWS)}")
        output.say(*(f"{each.ljust(width)}  {_numbers(found.twists[each])}" for each in kinds))
        where = "its origin" if place is None else f"the point {', '.join(f'{x:g}' for x in point)} of {frame}"
        output.say("", f"velocity of {where}, m/s", f"{' ' * 10}  {_cells('xyz')}")
        output.say(
            f"in base     {_numbers(found.point_velocity)}", f"in frame    {_numbers(found.point_velocity_body)}"
        )
        output.say(f"PoE and Pinocchio differ by {error:.1e}", err=True)
    if not error <= TOLERANCE:
        sys.exit(1)


def _numbers(values: FloatArray) -> str:
    return _cells([f"{round(x, 6) + 0.0:.6f}" for x in values.tolist()])


def _cells(cells: Sequence[str]) -> str:
    """Numbers, or names above them, in columns."""
    return "  ".join(cell.rjust(10) for cell in cells)
