"""``pinscrew list``: the robots that are known by name."""

from __future__ import annotations

import click

from pinscrew.cli.arguments import json_option
from pinscrew.cli.output import console, print_json, table

__all__ = ["command"]


@click.command(name="list")
@click.option("--examples", is_flag=True, help="List the URDFs of example-robot-data too.")
@json_option
def command(examples: bool, as_json: bool) -> None:
    """List the robots known by name.

    \b
      pinscrew list --examples
    """
    from pinscrew.description import catalogue

    entries = catalogue.bundled() + (catalogue.example_robots() if examples else ())
    if as_json:
        rows = [
            {
                "name": entry.name,
                "aliases": list(entry.aliases),
                "arguments": catalogue.declared_arguments(entry.file),
                "title": entry.title,
                "coursework": entry.coursework,
                "file": str(entry.file),
            }
            for entry in entries
        ]
        print_json({"schema": "pinscrew.list/1", "robots": rows})
        return
    shown = table("robot", "also", "arguments", "what it is", "from")
    for entry in entries:
        arguments = catalogue.declared_arguments(entry.file)
        defaults = " ".join(f"{name}:={default}" for name, default in arguments.items())
        shown.add_row(entry.name, ", ".join(entry.aliases), defaults, entry.title, entry.coursework)
    console().print(shown)
