"""``pinscrew show``: the robot, its screws and its velocities in the browser, as one HTML file, or as a picture."""

from __future__ import annotations

import signal
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from pinscrew.cli import arguments, moving, output
from pinscrew.ground import files

if TYPE_CHECKING:
    from types import FrameType

    from pinscrew.view.document import State
    from pinscrew.view.model import Model

__all__ = ["command"]

_GROUPS = ("links", "frames", "screws", "velocity", "circles", "ellipsoid", "trace", "workspace")


def _groups(_ctx: click.Context, _param: click.Parameter, value: str | None) -> tuple[str, ...] | None:
    """The words of ``--draw``; the links are always drawn."""
    if value is None:
        return None
    words = [word.strip() for word in value.split(",") if word.strip()]
    for word in words:
        if word not in _GROUPS:
            raise click.BadParameter(f"{word!r} can't be drawn; use some of {', '.join(_GROUPS)}")
    return ("links", *words)


@click.command(name="show", short_help="Show a robot, its screws and velocities.")
@arguments.robot_argument()
@arguments.q_option
@click.option(
    "--qd",
    "rates",
    metavar="VALUES",
    help="Joint velocities in rad/s and m/s, written as for -q. By default 1 rad/s, and for what slides a quarter "
    "of the robot's size per second.",
)
@click.option("--tip", metavar="FRAME", help="The frame whose velocity is shown; by default the robot's tip.")
@click.option(
    "--draw",
    metavar="WORDS",
    callback=_groups,
    help=f"What is drawn at first, separated by commas: {', '.join(_GROUPS)}. By default frames and screws, and "
    "velocity if --qd is given.",
)
@click.option(
    "--html",
    "html_file",
    type=output.FILE,
    help="Write the page as one HTML file that needs no server and no network, and end.",
)
@click.option(
    "--png",
    "png_file",
    type=output.FILE,
    help="Write a picture, made by Chromium or Chrome without a window, and end.",
)
@click.option("--no-open", is_flag=True, help="Print the address alone and open no browser.")
@click.option("--port", type=click.IntRange(1, 65535), help="Where to look for a free port first. By default 7000.")
@click.pass_context
def command(
    ctx: click.Context,
    words: tuple[str, ...],
    values: str | None,
    rates: str | None,
    tip: str | None,
    draw: Any,
    html_file: Path | None,
    png_file: Path | None,
    no_open: bool,
    port: int | None,
) -> None:
    """Show a robot, its screws and its velocities in the browser, until Ctrl-C.

    The page has a slider for each coordinate, and the Jacobian as it changes. Its address is on this computer only.

    \b
      pinscrew show scara -q 45deg,pi/4,0.1
      pinscrew show two_joint --qd 1,0.5 --draw screws,circles
      pinscrew show panda --html panda.html
    """
    from pinscrew.view import opening, prepare

    named = arguments.robot(words)
    robot = named.load()
    where = {name: named.options[name] for name in ("packages", "allow_outside") if name in named.options}
    model = prepare.prepare(robot, tip=tip, **where)
    if draw is None:
        draw = ("links", "frames", "screws", *(["velocity"] if rates is not None else []))
    q = None
    if values is not None and values.strip():
        q = arguments.configuration(robot, values)
    elif beside := opening.beside_zero(robot):
        names = ", ".join(beside)
        click.echo(f"pinscrew: zero is outside the limits of {names}: shown in the middle of them", err=True)
    qd = None if rates is None else moving.rates(robot, rates)
    state = prepare.begin(model, q, qd, draw=draw)
    if html_file is not None:
        output.write_file(html_file, prepare.page(model, state))
    if png_file is not None:
        files.write(png_file, prepare.picture(model, state))
    if html_file is None and png_file is None:
        ctx.exit(_serve(model, state, port, open_browser=not no_open))


def _serve(model: Model, state: State, port: int | None, *, open_browser: bool) -> int:
    """Show the page until a signal comes or the server dies; the exit status."""
    from pinscrew.view.meshcat import View
    from pinscrew.view.prepare import launch
    from pinscrew.view.server import PATIENCE

    stop = threading.Event()

    def on_signal(_number: int, _frame: FrameType | None) -> None:
        stop.set()

    # Before the server starts, so that no signal finds it without an end.
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), on_signal)
    with View(model, state, port) as view:
        click.echo(view.url)
        sys.stdout.flush()
        if open_browser and not launch(view.url):
            click.echo("pinscrew: found no browser with a window to open; the address is above", err=True)
        click.echo("pinscrew: Ctrl-C ends", err=True)
        while not stop.wait(PATIENCE / 2):
            if not view.alive:
                click.echo("pinscrew: the server has stopped", err=True)
                return 2
    return 0
