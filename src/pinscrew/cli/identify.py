"""``pinscrew identify``: which convention a matrix is in."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from pinscrew.cli import arguments, output

__all__ = ["command"]

_FILE = click.Path(path_type=Path)


@click.command(name="identify", short_help="Say which convention a Jacobian or a pose is in.")
@arguments.robot_argument()
@click.option(
    "--samples", "archive", type=_FILE, metavar="FILE", help="An .npz with q and J, T or pose, or q, qd and V."
)
@arguments.q_option
@click.option("--matrix", type=_FILE, metavar="FILE", help="What is given at -q: a row a line, as text.")
@click.option("--home", is_flag=True, help="The matrix is of no q: a list of screw axes, or a home pose.")
@arguments.json_option
def command(
    words: tuple[str, ...], archive: Path | None, values: str | None, matrix: Path | None, home: bool, as_json: bool
) -> None:
    """Say which convention a Jacobian, a pose or a twist is in: whose, in which axes, order and units.

    Exit status 0 if one convention fits, 1 if several do, or none that is known.

    \b
      pinscrew identify scara -q 0.3,0.5,0.1 --matrix J.csv
      pinscrew identify scara --samples samples.npz --json
      pinscrew identify scara --home --matrix Slist.csv
    """
    import pinscrew as ps
    from pinscrew.identification.reading import read_arrays, read_table

    if (archive is None) == (matrix is None):
        raise click.UsageError("give --samples FILE, or -q and --matrix FILE")
    if home and (matrix is None or values is not None):
        raise click.UsageError("--home takes --matrix FILE, and no -q")
    robot = arguments.robot(words).load()
    if archive is not None:
        q, *given = read_arrays(archive)
    elif matrix is not None:
        q, given = arguments.configuration(robot, values), [read_table(matrix)]
    found = ps.identify(robot, None if home else q, *given)
    if as_json:
        output.print_json(found.to_document())
    else:
        output.say(*str(found).split("\n"))
    if found.verdict != "unique":
        sys.exit(1)
