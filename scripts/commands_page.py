"""Write docs/commands.md from the help of each command.

python scripts/commands_page.py           # write
python scripts/commands_page.py --check   # exit status 1 if it is not up to date
"""

from __future__ import annotations

import sys
from pathlib import Path

import click

from generated import write_or_check
from pinscrew.cli import command as pinscrew

PAGE = Path(__file__).resolve().parents[1] / "docs" / "commands.md"
WIDTH = 100

INTRODUCTION = """\
# On the command line

ROBOT is a name that `pinscrew list` prints, the name of a URDF of example-robot-data, or a file; xacro arguments follow
it as in ROS, `l1:=0.4`. Results go to standard output, words to standard error. The exit status is 0 if all is well, 1
if the answer is no, and 2 if there is none. `eval "$(pinscrew completion bash)"` (or `zsh`, `fish`) completes commands,
options and robots.

This page is written by `scripts/commands_page.py`.
"""


def page() -> str:
    """The page, in Markdown."""
    top = click.Context(pinscrew, info_name="pinscrew", **pinscrew.context_settings)
    parts = [INTRODUCTION]
    for name in pinscrew.list_commands(top):
        command = pinscrew.get_command(top, name)
        if command is not None:
            context = click.Context(command, info_name=name, parent=top, max_content_width=WIDTH, terminal_width=WIDTH)
            parts.append(f"## `pinscrew {name}`\n\n```text\n{command.get_help(context)}\n```\n")
    return "\n".join(parts)


if __name__ == "__main__":
    sys.exit(write_or_check(PAGE, page()))
