"""``pinscrew dh``: the Denavit-Hartenberg table of a robot."""

from __future__ import annotations

import sys
from typing import Any

import click

from pinscrew.cli import arguments, output
from pinscrew.cli.dh_formats import DH_FORMATS, dh_cells

__all__ = ["command"]


@click.command(name="dh", short_help="Print a Denavit-Hartenberg table, proved against both engines.")
@arguments.robot_argument()
@arguments.tip_option
@click.option("--base", metavar="FRAME", help="Another frame fixed to the base, to begin in.")
@click.option(
    "--convention",
    type=click.Choice(["standard", "modified"]),
    default="standard",
    show_default=True,
    help="Rz(θ) Tz(d) Tx(a) Rx(α) in each row, or Craig's, which has a and α of the link before it come first.",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(["table", *DH_FORMATS]),
    default="table",
    show_default=True,
    help="How to print; csv has the rows alone.",
)
@click.option("--json", "as_json", is_flag=True, help="The same as --format json.")
def command(
    words: tuple[str, ...], tip: str | None, base: str | None, convention: Any, form: str, as_json: bool
) -> None:
    """Print the DH table of the joints that move a frame, the transforms before and after it, and how far it is from
    both engines.

    \b
      pinscrew dh anthropomorphic
      pinscrew dh path/to/arm.urdf --convention modified
    """
    from pinscrew.dh.proof import DH_TOLERANCE, dh_differences
    from pinscrew.dh.table import dh_table

    robot = arguments.robot(words).load()
    found = dh_table(robot, tip, convention=convention, base=base)
    differences = dh_differences(found, robot)
    form = "json" if as_json else form
    if form != "table":
        click.echo(DH_FORMATS[form](found, differences))
    else:
        hayati = any(row.beta for row in found.rows)
        names = ("θ", "d", "a", "α", "β") if convention == "standard" else ("θ", "d", "a₋₁", "α₋₁", "β₋₁")
        table = output.table("joint", *names[: 5 if hayati else 4])
        for i, row in enumerate(found.rows, 1):
            table.add_row(row.joint, *dh_cells(row, i)[: 5 if hayati else 4])
        output.say(f"{found.robot}: {convention} DH table of {found.tip} (m, rad)")
        output.console().print(table)
        if hayati:
            output.say("nearly parallel axes have Hayati's angle β about y, after α")
        for words_, T in (("frame 0", found.T_base_0), ("tool", found.T_n_tool)):
            output.say("", f"{words_} in {found.base if T is found.T_base_0 else f'frame {len(found.rows)}'}")
            output.say(*output.matrix_lines(T))
    proved = ", ".join(f"{name} by {error:.1e}" for name, error in differences.items())
    output.say(f"differs from {proved}", err=True)
    if not max(differences.values()) <= DH_TOLERANCE:
        sys.exit(1)
