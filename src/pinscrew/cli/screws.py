"""``pinscrew screws``: screw axes and home pose of a robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from pinscrew.cli import arguments, output
from pinscrew.cli.screw_formats import FORMATS, Screws

if TYPE_CHECKING:
    from pinscrew.robot.robot import Robot

__all__ = ["command"]


@click.command(name="screws", short_help="Print screw axes and home pose of a frame.")
@arguments.robot_argument()
@arguments.tip_option
@click.option(
    "--at",
    type=click.Choice(["space", "body"]),
    default="space",
    show_default=True,
    help="Give the axes in the base frame, or in the tip frame.",
)
@click.option("--reference", metavar="FRAME", help="Another frame fixed to the base, to give space axes in.")
@click.option(
    "--order",
    type=click.Choice(["v,w", "w,v"]),
    default="v,w",
    show_default=True,
    help="Linear part first (Murray-Li-Sastry, Pinocchio) or angular part first (Lynch-Park).",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(["table", *FORMATS]),
    default="table",
    show_default=True,
    help="How to print; csv has the axes alone, a row each.",
)
@click.option("--json", "as_json", is_flag=True, help="The same as --format json.")
def command(
    words: tuple[str, ...],
    tip: str | None,
    at: Any,
    reference: str | None,
    order: str,
    form: str,
    as_json: bool,
) -> None:
    """Print the screw axes of the joints that move a frame, and the frame's home pose.

    \b
      pinscrew screws lead_screw
      pinscrew screws scara l1:=0.5 --format python
      pinscrew screws planar_2r --reference frame0
    """
    robot = arguments.robot(words).load()
    found = Screws(
        robot=robot.name,
        base=reference or robot.base,
        tip=robot.frame(tip),
        at=at,
        angular_first=order == "w,v",
        names=robot.velocity_names,
        axes=robot.screws(tip, at=at, reference=reference),
        home=robot.home(tip, reference=reference),
    )
    form = "json" if as_json else form
    if form != "table":
        click.echo(FORMATS[form](found))
        return
    _print_table(found, robot)


def _print_table(found: Screws, robot: Robot) -> None:
    from pinscrew.lie.screw import Screw

    frame = found.tip if found.at == "body" else found.base
    table = output.table("joint", found.heading, "direction", "through", "pitch", "magnitude")
    still = []
    for name, twist in zip(found.names, found.axes.T, strict=True):
        if not twist.any():
            still.append(name)
            continue
        screw = Screw.from_twist(twist)
        through = _numbers(screw.point)
        pitch = "translation" if screw.pitch == float("inf") else f"{screw.pitch:.6g}"
        row = (
            _numbers(found.ordered(twist)),
            _numbers(screw.direction),
            through,
            pitch,
            f"{screw.magnitude:.6g}",
        )
        table.add_row(name, *row)
    output.say(f"{found.robot}: {found.at} screw axes of {found.tip}, in {frame} (m, rad; pitch in m/rad)")
    output.console().print(table)
    if still:
        output.say(f"not moving {found.tip}: {', '.join(still)}")
    for index in robot.motions_above(found.tip):
        motion = robot.mechanism.motions[index]
        if motion.joint.mimic is not None:
            master = robot.velocity_names[motion.v]
            output.say(f"{motion.joint.name} follows {master} times {motion.multiplier:.6g}, and is in its screw")
    output.say("", f"home pose M: {found.tip} in {found.base} at zero")
    output.say(*output.matrix_lines(found.home))


def _numbers(values: Any) -> str:
    return f"[{', '.join(f'{x:.6g}' for x in output.plain(values.round(9)))}]"
