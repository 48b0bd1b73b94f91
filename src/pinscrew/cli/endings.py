"""What ends a command from outside is raised as an error, so that what is half done is taken away.

A signal comes at any moment. In the middle of an import, say, it may be raised in a library's ``except:``, or under C
code that drops whatever is raised (scipy's modules have both), and the command would go on as if nothing had come. An
error that somebody handles lives until it is handled; so one that dies before the command has ended was dropped, and is
raised again.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Final

__all__ = ["heard"]

_AGAIN: Final = 0.02
"""Seconds until what was dropped is raised again: not in the very place that drops it."""


class _Command:
    """Where the command is."""

    ended = False


class _Ending(BaseException):
    def __del__(self) -> None:
        if not _Command.ended:
            number = self.args[0] % 128
            signal.signal(signal.SIGALRM, lambda _, frame: _end(number, frame))
            signal.setitimer(signal.ITIMER_REAL, _AGAIN)


class _Ended(_Ending, SystemExit):
    """The end of a command, with the status that a shell gives it."""


class _Interrupted(_Ending, KeyboardInterrupt):
    """Ctrl-C."""


@contextmanager
def heard() -> Iterator[None]:
    """Let SIGINT, SIGTERM and SIGHUP raise in this block, again and again until it ends by that.

    One that is ignored, or that somebody else listens to, stays as it is.
    """
    defaults = {"SIGINT": signal.default_int_handler, "SIGTERM": signal.SIG_DFL, "SIGHUP": signal.SIG_DFL}
    _Command.ended = False
    sys.unraisablehook = _tell
    for name, default in defaults.items():
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is default:
            signal.signal(number, _end)
    try:
        yield
    finally:
        _Command.ended = True


def _tell(dropped: sys.UnraisableHookArgs) -> None:
    """Python's own words on errors that nothing can handle, but for ours: it is raised again."""
    if not isinstance(dropped.exc_value, _Ending):
        sys.__unraisablehook__(dropped)


def _end(number: int, _frame: FrameType | None) -> None:
    # No name for the error: its traceback holds this frame, which would hold the error, and neither would ever die.
    raise _Interrupted(number) if number == signal.SIGINT else _Ended(128 + number)
