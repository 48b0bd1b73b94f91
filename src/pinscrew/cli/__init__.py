"""Layer 6: the command ``pinscrew``; one small module per subcommand."""

from __future__ import annotations

import difflib
import io
import os
import sys
import traceback
import warnings
from importlib import import_module
from typing import Any, Final

import click

from pinscrew import __version__
from pinscrew.ground.errors import PinscrewError, PinscrewWarning

__all__ = ["command", "main"]

_COMMANDS: Final = {
    "completion": "pinscrew.cli.completion",
    "derive": "pinscrew.cli.derive",
    "diff": "pinscrew.cli.diff",
    "fk": "pinscrew.cli.fk",
    "jacobian": "pinscrew.cli.jacobian",
    "list": "pinscrew.cli.list_robots",
    "lock": "pinscrew.cli.lock",
    "screws": "pinscrew.cli.screws",
    "show": "pinscrew.cli.show",
    "track": "pinscrew.cli.track",
    "verify": "pinscrew.cli.verify",
    "workspace": "pinscrew.cli.workspace",
}


class _Group(click.Group):
    """Subcommands, each imported when it is called or listed."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 (click's signature)
        return sorted(_COMMANDS)

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        if name not in _COMMANDS:
            near = difflib.get_close_matches(name, _COMMANDS, n=1)
            if near and not ctx.resilient_parsing:
                raise click.UsageError(f"there is no command {name!r}; did you mean {near[0]!r}?", ctx)
            return None
        found: click.Command = import_module(_COMMANDS[name]).command
        return found


@click.group(cls=_Group, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="pinscrew")
def command() -> None:
    """Kinematics from URDF that you can trust.

    Two engines, Pinocchio and the product of exponentials, answer the same questions about a robot, each from
    its own reading of the file.

    ROBOT is a name (see "pinscrew list"), or a .urdf or .xacro file; xacro arguments follow it as in ROS:

    \b
      pinscrew verify
      pinscrew screws scara l1:=0.4 l2:=0.3
      pinscrew fk path/to/arm.urdf -q 45deg,pi/4,0.1
    """


def main() -> None:
    """Run the command.

    Every error of pinscrew ends in one line and exit status 2. Status 1 is kept for engines that disagree, so a
    mistake of ours, which ends in a traceback, has status 2 too, and Ctrl-C 130 as in a shell.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # names from a file, or ω, may not be in its encoding
            stream.reconfigure(errors="backslashreplace")
    warnings.showwarning = _show_warning
    try:
        sys.exit(command(prog_name="pinscrew", standalone_mode=False))
    except PinscrewError as error:
        click.echo(f"pinscrew: {error}", err=True)
        sys.exit(2)
    except click.ClickException as error:
        error.show()
        sys.exit(error.exit_code)
    except (click.Abort, KeyboardInterrupt):
        sys.exit(130)
    except BrokenPipeError:  # whoever read our output has had enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
    except Exception:
        traceback.print_exc()
        sys.exit(2)


def _show_warning(message: Warning | str, category: type[Warning], *_: Any, **__: Any) -> None:
    if issubclass(category, PinscrewWarning):
        click.echo(f"pinscrew: warning: {message}", err=True)
