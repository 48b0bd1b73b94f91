"""``pinscrew completion``: the script that completes commands and robots in a shell."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

__all__ = ["command"]


@click.command(name="completion")
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@click.pass_context
def command(ctx: click.Context, shell: str) -> None:
    """Print the completion script of SHELL.

    \b
      eval "$(pinscrew completion bash)"
    """
    completer = get_completion_class(shell)
    if completer is None:  # the choices above are click's own
        raise click.UsageError(f"no completion for {shell}")
    click.echo(completer(ctx.find_root().command, {}, "pinscrew", "_PINSCREW_COMPLETE").source())
