"""``pinscrew expand``: the URDF that a xacro file stands for."""

from __future__ import annotations

from pathlib import Path

import click

from pinscrew.cli import arguments, output
from pinscrew.ground.escaping import json_text, xml_document

__all__ = ["command"]


@click.command(name="expand", short_help="Print the URDF that a xacro file stands for.")
@arguments.robot_argument()
@click.option("--sources", is_flag=True, help="Say before each link and joint, in a comment, where it comes from.")
@click.option("-o", "--output", "file", type=output.FILE, help="Write it to this file instead.")
@arguments.json_option
def command(words: tuple[str, ...], file: Path | None, *, sources: bool, as_json: bool) -> None:
    """Print the URDF that ROBOT's xacro file stands for, as every other command reads it.

    A plain URDF is printed as it is.

    \b
      pinscrew expand scara l1:=0.5
      pinscrew expand scara --sources -o scara.urdf
    """
    from pinscrew.description import catalogue, expand
    from pinscrew.robot.loading import expanded

    named = arguments.robot(words)
    ways = {name: named.options[name] for name in ("packages", "allow_outside") if name in named.options}
    given = {name: str(value) for name, value in named.arguments.items()}
    expansion = expanded(catalogue.find(named.source).file, given, **ways)
    text = expand.with_sources(expansion) if sources else expansion.text
    if as_json:
        places = [{"file": place, "line": line} for place, line in expansion.places]
        document = {"schema": "pinscrew.expand/1", "arguments": given, "urdf": text, "places": places}
        text = json_text(document) + "\n"
    if file is not None:
        output.write_file(file, text)
    else:
        text = text if as_json else xml_document(text)
        click.echo(text, nl=not text.endswith("\n"))
