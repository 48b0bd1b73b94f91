"""Layer 6: the command ``pinscrew``; one small module per subcommand."""

from __future__ import annotations

import contextlib
import difflib
import errno
import io
import os
import sys
import traceback
import warnings
from collections.abc import Iterator
from importlib import import_module
from typing import Any, Final

import click

from pinscrew import __version__
from pinscrew.cli.endings import heard
from pinscrew.cli.output import say
from pinscrew.ground.errors import LONGEST, PinscrewError, PinscrewWarning
from pinscrew.ground.words import brief, one_line

__all__ = ["command", "main"]

_COMMANDS: Final = {
    "check": "pinscrew.cli.check",
    "completion": "pinscrew.cli.completion",
    "derive": "pinscrew.cli.derive",
    "dh": "pinscrew.cli.dh",
    "diff": "pinscrew.cli.diff",
    "expand": "pinscrew.cli.expand",
    "fk": "pinscrew.cli.fk",
    "identify": "pinscrew.cli.identify",
    "jacobian": "pinscrew.cli.jacobian",
    "list": "pinscrew.cli.list_robots",
    "lock": "pinscrew.cli.lock",
    "screws": "pinscrew.cli.screws",
    "show": "pinscrew.cli.show",
    "track": "pinscrew.cli.track",
    "velocity": "pinscrew.cli.velocity",
    "verify": "pinscrew.cli.verify",
    "workspace": "pinscrew.cli.workspace",
}

INTERRUPTED: Final = 130
"""Exit status after Ctrl-C: 128 and the number of SIGINT."""
BROKEN_PIPE: Final = 141
"""Exit status when nobody reads our output any more: 128 and the number of SIGPIPE."""
_UNWRITTEN: Final = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF, errno.EPIPE})
"""What writing to a stream may end with."""


class _Unread(Exception):  # noqa: N818 (it says what happened)
    """Nobody reads our output any more. click would end with status 1 where it sees the error itself."""


@contextlib.contextmanager
def _read() -> Iterator[None]:
    try:
        yield
    except BrokenPipeError:
        raise _Unread from None


class _Group(click.Group):
    """Subcommands, each imported when it is called or listed."""

    def make_context(self, *args: Any, **options: Any) -> click.Context:
        with _read():  # help is printed here
            return super().make_context(*args, **options)

    def invoke(self, ctx: click.Context) -> Any:
        with _read():
            return super().invoke(ctx)

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
    """Run the command, and exit with its status.

    Every error of pinscrew ends in one line and exit status 2. Status 1 is kept for engines that disagree, so a
    mistake of ours, which ends in a traceback, has status 2 too. As in a shell, Ctrl-C has 130, and a reader of our
    output that has had enough 141. Output that can't be written, to a full disk say, is an error.
    """
    _open_streams()
    warnings.showwarning = _show_warning
    try:
        status = _run()
        for stream in (sys.stdout, sys.stderr):
            stream.flush()  # now, and not when Python ends, where an error would be told by a traceback
    except (_Unread, BrokenPipeError):
        status = BROKEN_PIPE
        _silence()
    except OSError as error:
        if not _of_a_stream(error):
            raise
        status = 2
        with contextlib.suppress(OSError):
            sys.stderr.write(f"pinscrew: the output can't be written ({error.strerror})\n")
            sys.stderr.flush()
        _silence()
    sys.exit(status)


def _run() -> int:
    """Run the command; its exit status."""
    try:
        with heard():
            command(prog_name="pinscrew", standalone_mode=False)
    except SystemExit as end:
        return int(end.code or 0)
    except PinscrewError as error:
        say(f"pinscrew: {error}", err=True)
        return 2
    except click.ClickException as error:
        shown = io.StringIO()
        error.show(shown)
        usage, _, what = f"\n{shown.getvalue()}".partition("\nError: ")
        say(*usage.split("\n")[1:], f"Error: {one_line(brief(what, LONGEST))}", err=True)
        return error.exit_code
    except (click.Abort, KeyboardInterrupt):
        return INTERRUPTED
    except Exception as error:
        if _of_a_stream(error) or isinstance(error, _Unread):
            raise
        traceback.print_exc()
        return 2
    return 0


def _of_a_stream(error: Exception) -> bool:
    """Whether an error is of writing to a stream: no file is named in it, as one is where a file can't be opened."""
    return isinstance(error, OSError) and error.filename is None and error.errno in _UNWRITTEN


def _open_streams() -> None:
    """Let no standard stream be closed, and none refuse a character.

    A file that is opened while one is closed would get its number, and what is printed would go there.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # the lowest number that is free: this one
    sys.stdout = sys.stdout or open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115 (open to the end)
    sys.stderr = sys.stderr or open(2, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # names from a file, or ω, may not be in its encoding
            stream.reconfigure(errors="backslashreplace")


def _silence() -> None:
    """Send what is still in the streams' buffers nowhere: Python writes it as it ends."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError):
            stream.flush()
            continue
        with contextlib.suppress(io.UnsupportedOperation):  # a stream without a file, in tests
            os.dup2(nowhere, stream.fileno())


def _show_warning(message: Warning | str, category: type[Warning], *_: Any, **__: Any) -> None:
    if issubclass(category, PinscrewWarning):
        say(f"pinscrew: warning: {message}", err=True)
