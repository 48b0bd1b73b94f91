"""Running ``pinscrew`` as a shell would, in this process."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import warnings
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

from pinscrew.cli import main
from pinscrew.ground.errors import PinscrewError, PinscrewWarning


@dataclass(frozen=True)
class Done:
    """Exit status, standard output, standard error."""

    status: int
    out: str
    err: str


def run(*words: str | Path) -> Done:
    """What ``pinscrew WORDS`` does; any exception but an exit is an error of the test."""
    out, err = (io.TextIOWrapper(io.BytesIO(), encoding="utf-8", write_through=True) for _ in range(2))
    argv = ["pinscrew", *map(str, words)]
    with redirect_stdout(out), redirect_stderr(err), mock.patch.object(sys, "argv", argv), warnings.catch_warnings():
        warnings.simplefilter("always", PinscrewWarning)
        try:
            main()
            status = 0
        except SystemExit as exit_:
            status = int(exit_.code or 0)
    return Done(status, *(stream.buffer.getvalue().decode() for stream in (out, err)))


def ok(*words: str | Path) -> Done:
    """`run`, which must succeed."""
    done = run(*words)
    assert done.status == 0, done.err
    return done


def refused(*words: str | Path) -> str:
    """The one message of a command that could not run: status 2, nothing on standard output."""
    done = run(*words)
    assert (done.status, done.out) == (2, "")
    assert "Traceback" not in done.err
    message = done.err.splitlines()[-1]
    assert message.startswith(("Error: ", "pinscrew: "))
    return message.removeprefix("Error: ").removeprefix("pinscrew: ")


def refusal(*words: str | Path) -> PinscrewError:
    """The error of ours that `refused` tells of: its code and its parts are what a test should ask for."""
    message = refused(*words)
    raised: list[PinscrewError] = []
    with mock.patch("pinscrew.cli.say", side_effect=lambda *_, **__: raised.append(sys.exc_info()[1])):
        run(*words)
    (error,) = raised
    assert isinstance(error, PinscrewError)
    assert str(error) == message
    return error


def process(*words: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """``python -m pinscrew`` in a process of its own."""
    command = [sys.executable, "-m", "pinscrew", *words]
    return subprocess.run(command, capture_output=True, text=True, env={**os.environ, **environment}, check=False)
