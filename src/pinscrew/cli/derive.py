"""``pinscrew derive``: the worked closed forms of a robot, proved."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from pinscrew.cli import arguments, moving, output

if TYPE_CHECKING:
    from pinscrew.derivation.writer import Detail
    from pinscrew.robot.robot import Robot

__all__ = ["command"]

_BEFORE_A_POINT = ("pose", "velocity-matrix", "spatial-velocity")


def _lengths(_ctx: click.Context, _param: click.Parameter, values: tuple[str, ...]) -> dict[str, float]:
    found = {}
    for name, text in arguments.pairs(values, "NAME=LENGTH").items():
        try:
            found[name] = float(text)
        except ValueError:
            raise click.BadParameter(f"{text!r} is not a number") from None
    return found


@click.command(name="derive", short_help="Derive closed forms of a frame's motion.")
@arguments.robot_argument(required=False, metavar="[ROBOT [ARG:=VALUE]...]")
@arguments.tip_option
@click.option(
    "--from",
    "--reference",
    "reference",
    metavar="FRAME",
    help="The frame in which it moves: another choice of frame 0, or any link; by default the base.",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(["terminal", "markdown", "latex", "html", "notebook"]),
    help="How to write the report; by default for a terminal where it is shown on one, else as Markdown.",
)
@click.option("-o", "--output", "target", type=output.FILE, help="Write to this file.")
@click.option(
    "--part",
    "parts",
    multiple=True,
    metavar="PART",
    help="Only these sections, by letter (d), key (pose) or name (T, Js, Jb, Jh, Ad): i,l or repeated. "
    "Parts n to r (singularities, screws, spatial-velocity, general-column, geometric) are shown only so.",
)
@click.option(
    "--point",
    "place",
    metavar="X,Y,Z",
    help="The velocity of this point of the frame too; X,Y,Z@FRAME names the frame.",
)
@click.option("--at", metavar="NAME=VALUE", help="With --point: its velocity at these values, the other joints free.")
@click.option("--via", metavar="FRAME", help="Compose the velocity through this frame: V_AC = V_AB + Ad V_BC.")
@click.option(
    "--detail",
    type=click.Choice(["result", "steps", "full"]),
    default="steps",
    show_default=True,
    help="How much of the way is shown: results alone, the products they are of, or every matrix on the way.",
)
@click.option(
    "--convention",
    type=click.Choice(["mls", "lynch-park"]),
    default="mls",
    show_default=True,
    help="Names, equations and order of twists of Murray-Li-Sastry or of Lynch-Park.",
)
@click.option(
    "--joints",
    "names",
    type=click.Choice(["theta", "d", "urdf"]),
    default="theta",
    show_default=True,
    help="Call all joint values theta1, theta2, …, those of sliding joints d3, or as the file does.",
)
@click.option("--symbols", is_flag=True, help="Name the distinct lengths of a file without arguments l1, l2, …")
@click.option(
    "--symbol", "named", multiple=True, metavar="NAME=LENGTH", callback=_lengths, help="Name this length (m)."
)
@click.option("--snap", type=float, help="Largest change (rad) that makes an angle exact; 0 for none.")
@click.option(
    "--code", "language", type=click.Choice(["python", "c", "matlab", "julia"]), help="Write functions instead."
)
@click.option(
    "--kind",
    type=click.Choice(["spatial", "body", "hybrid", "geometric"]),
    default="body",
    show_default=True,
    help="Of the Jacobian in --code; geometric, as DH textbooks say, is hybrid.",
)
@click.option("--errata", is_flag=True, help="Show the mistakes of the printed coursework instead, and check them.")
@click.option("--worksheet", is_flag=True, help="Write a worksheet to fill in instead, for `pinscrew check`.")
@click.option(
    "--identity",
    type=click.Choice(["rotation"]),
    help="Prove instead what holds of every rotation: R Rᵀ = I, det R = 1, R â Rᵀ = (R a)^.",
)
@click.option("--samples", default=100, show_default=True, type=click.IntRange(1), help="Of the numerical proof.")
@click.option("--seed", default=0, show_default=True, type=click.IntRange(0), help="Of the numerical proof.")
def command(
    words: tuple[str, ...],
    form: str | None,
    target: Path | None,
    errata: bool,
    worksheet: bool,
    identity: str | None,
    **options: Any,
) -> None:
    """Derive a frame's pose, velocities and Jacobians in closed form, step by step.

    Everything is exact and in symbols, and proved at the end: exit status 1 if it differs from either engine.

    \b
      pinscrew derive spherical
      pinscrew derive scara --format html -o scara.html
      pinscrew derive planar_rrr --part i --convention lynch-park
      pinscrew derive scara --worksheet -o scara.md
      pinscrew derive path/to/arm.urdf --symbols --code c --kind hybrid
      pinscrew derive --identity rotation
    """
    form = form or ("terminal" if target is None and sys.stdout.isatty() else "markdown")
    if not words and identity is None:
        raise click.UsageError("Missing argument 'ROBOT [ARG:=VALUE]...'.")
    if identity is not None:
        text, ok = _identity(identity, words, form)
    elif worksheet:
        text, ok = _worksheet(words, form, options["tip"]), True
    else:
        text, ok = _errata(words, form) if errata else _report(words, form, **options)
    if target is None:
        click.echo(text, nl=not text.endswith("\n"))
    else:
        output.write_file(target, text)
    if not ok:
        what = "the closed forms and the engines disagree" if identity is None else "an identity does not hold"
        click.echo(f"pinscrew: {what}", err=True)
        sys.exit(1)


def _report(
    words: tuple[str, ...],
    form: str,
    *,
    tip: str | None,
    reference: str | None,
    parts: tuple[str, ...],
    place: str | None,
    at: str | None,
    via: str | None,
    detail: Detail,
    symbols: bool,
    named: dict[str, float],
    language: str | None,
    kind: str,
    samples: int,
    seed: int,
    snap: float | None,
    **options: Any,
) -> tuple[str, bool]:
    """The text, and whether the proof holds."""
    from pinscrew.derivation import reports
    from pinscrew.derivation.asked import NOTHING, asked
    from pinscrew.derivation.composition import composition_section
    from pinscrew.derivation.exact import SNAP
    from pinscrew.derivation.parts import wanted
    from pinscrew.derivation.points import point_section
    from pinscrew.derivation.run import derive

    one = arguments.robot(words)
    wanted(parts, large=False)  # a wrong part is said before the work begins
    if place is None and at is not None:
        raise click.UsageError("--at is of a point: give --point too")
    if language is not None and (place is not None or via is not None):
        raise click.UsageError("--code writes functions, and has no place for --point or --via")
    point, tip = ((0.0, 0.0, 0.0), tip) if place is None else moving.point(place, tip)
    robot = one.load()
    values = _values(robot, at)
    further = {
        "symbols": symbols or named,
        "snap": SNAP if snap is None else snap,
        "loader": lambda change: arguments.Named(one.source, {**one.arguments, **change}, one.options).load(),
        **options,
    }
    derivation = derive(robot, tip, reference=reference, also=() if via is None else (via,), **further)
    if language is not None:
        from pinscrew.derivation.code import code
        from pinscrew.derivation.read_back_code import read_back_code

        proof = derivation.prove(samples, seed)
        kind = "hybrid" if kind == "geometric" else kind
        text = code(derivation, language, kind)
        if proof.ok:
            read_back_code(derivation, text, language, kind)
        return text, proof.ok
    about = NOTHING if place is None else asked(derivation, point, values)
    extra = [] if place is None else [point_section(derivation, about, detail)]
    proof = derivation.prove(samples, seed)
    if via is not None:
        first = derive(robot, via, reference=reference, also=(derivation.tip,), **further)
        second = derive(robot, derivation.tip, reference=via, also=(derivation.reference,), **further)
        extra.append(composition_section(derivation, (first, second), detail))
        about = replace(about, frames={"A": derivation.reference, "B": first.tip, "C": derivation.tip})
        proof = next((bad for bad in (first.prove(samples, seed), second.prove(samples, seed)) if not bad.ok), proof)
    parts = parts or (_BEFORE_A_POINT if place is not None else ("pose",) if extra else ())
    whole = reports.report(derivation, proof, parts, extra, detail)
    if not proof.ok:  # what is wrong already is not held against the engines once more
        return reports.write(whole, form), False
    return reports.written(derivation, whole, form, about), True


def _values(robot: Robot, text: str | None) -> dict[str, float]:
    """The values of ``--at`` by the names of coordinates."""
    if text is None:
        return {}
    return arguments.values_by_name(text, robot.name, robot.coordinate_names, robot.coordinate_units, "--at")


def _worksheet(words: tuple[str, ...], form: str, tip: str | None) -> str:
    from pinscrew.checking.run import checkable
    from pinscrew.checking.worksheet import worksheet

    return worksheet(checkable(arguments.robot(words).load(), tip), form)


def _errata(words: tuple[str, ...], form: str) -> tuple[str, bool]:
    from pinscrew.derivation import errata, reports

    report = errata.report(arguments.robot(words).load())
    return reports.write(report, form), report.ok


def _identity(name: str, words: tuple[str, ...], form: str) -> tuple[str, bool]:
    from pinscrew.derivation import identities, reports

    if words:
        raise click.UsageError("--identity is of no robot: give one or the other")
    report = identities.identities(name)
    return reports.write(report, form), report.ok
