"""Other programs as children of this process: they end when it ends, in whatever way it does.

A parent that is killed can't end anybody. So either the child asks the system to be told (Linux has
``PR_SET_PDEATHSIG``), or somebody beside it waits at the end of a pipe that only the parent holds open: the system
closes it even for a process that dies by SIGKILL.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Final

__all__ = ["end_with_parent", "limit", "program"]

_PR_SET_PDEATHSIG: Final = 1  # of Linux's <sys/prctl.h>

_GUARDED: Final = 'exec 3<&0; { read -r line <&3; kill -9 0; } >/dev/null 2>&1 & exec "$@" 3<&- </dev/null'
"""A shell that leaves somebody waiting at the pipe, to kill the whole group, and becomes the program."""


def end_with_parent(parent: int | None = None) -> None:
    """In a child: be killed when the thread that started this process ends; nothing where the system can't say.

    Args:
        parent: the parent's process id, if it is known: it may have ended already.
    """
    if sys.platform != "linux":
        return
    with contextlib.suppress(OSError, AttributeError):  # a system that only looks like Linux
        ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if parent is not None and os.getppid() != parent:
        os._exit(1)


def limit(seconds: int, memory: int) -> None:
    """In a child: let the system end this process if it takes more, or writes a file.

    Args:
        seconds: of processor time, after which it is told, and a second later killed.
        memory: bytes that it may address.
    """
    import resource  # which Windows has not

    limits = {resource.RLIMIT_FSIZE: (0, 0), resource.RLIMIT_CORE: (0, 0)}
    limits[resource.RLIMIT_CPU] = (seconds, seconds + 1)
    if sys.platform == "linux":  # macOS does not enforce it, and refuses to set it
        limits[resource.RLIMIT_AS] = (memory, memory)
    for which, (soft, hard) in limits.items():
        most = resource.getrlimit(which)[1]
        bounded = (soft, hard) if most == resource.RLIM_INFINITY else (min(soft, most), min(hard, most))
        resource.setrlimit(which, bounded)


@contextmanager
def program(command: Sequence[str], **options: Any) -> Iterator[subprocess.Popen[bytes]]:
    """A program in a process group of its own, which ends, with all that it started there, when this block does.

    It also ends when this process does: by a signal, by SIGKILL, by whatever.

    Args:
        command: the program and its arguments; it reads nothing from standard input.
        options: of `subprocess.Popen`.

    Raises:
        OSError: if there is no shell.
    """
    theirs, ours = os.pipe()
    try:
        words = ["/bin/sh", "-c", _GUARDED, "sh", *command]
        with subprocess.Popen(words, stdin=theirs, start_new_session=True, **options) as process:  # noqa: S603
            try:
                yield process
            finally:
                # The one who waits is of the group too, so that its number is not given to another meanwhile.
                with contextlib.suppress(ProcessLookupError, PermissionError):
                    os.killpg(process.pid, signal.SIGKILL)
    finally:
        os.close(ours)
        os.close(theirs)
