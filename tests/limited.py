"""Runs the command line in child processes under limits, so that no input can hurt the tests themselves.

A server (this file as a script) imports pinscrew and its parsers once. For each request it forks a child, which gets
its limits, runs ``python -m pinscrew`` and is waited for: a request takes milliseconds instead of a second.
"""

from __future__ import annotations

import contextlib
import json
import os
import resource
import runpy
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import IO, Any, Final

SECONDS: Final = 10
"""Of processor time that a child and its own children may take; on the clock it is killed after `PATIENCE`."""
PATIENCE: Final = 30
MEMORY: Final = 2**30
"""Bytes that a child may hold in memory, its own children's included, and map beyond what the imports did."""
NOBODY: Final = 65534


@dataclass(frozen=True)
class Result:
    """What became of a child.

    Attributes:
        status: exit status; negative, the signal that ended it.
        seconds: on the clock.
        work: seconds of processor time, its own children's included.
        peak: most bytes that it, or a child of it, held in memory, shared ones included.
    """

    status: int
    stdout: str
    stderr: str
    seconds: float
    work: float
    peak: int


class Server:
    """The client's side: a context manager, started once per test process."""

    def __enter__(self) -> Server:
        command = [sys.executable, "-W", "ignore", __file__]
        environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONUTF8": "1"}
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment, text=True
        )
        return self

    def __exit__(self, *_: object) -> None:
        self._stream(self._process.stdin).close()
        self._stream(self._process.stdout).close()
        self._process.wait(SECONDS)

    @staticmethod
    def _stream(stream: IO[str] | None) -> IO[str]:
        assert stream is not None
        return stream

    def run(
        self,
        *arguments: str | Path,
        expansion: int | None = None,
        environment: Mapping[str, str] | None = None,
        unprivileged: bool = False,
        folder: str | Path | None = None,
        streams: Mapping[int, str] | None = None,
    ) -> Result:
        """Run ``pinscrew`` with these arguments.

        Args:
            arguments: of the command line.
            expansion: seconds that a xacro file may take, for attacks that would use them all.
            environment: variables to add.
            unprivileged: run without root's rights to read everything.
            folder: where to run.
            streams: what becomes of standard output (1) or error (2): it is on a ``"full"`` disk, ``"closed"``, or a
                pipe that nobody reads, ``"unread"``.
        """
        request = {
            "arguments": [str(argument) for argument in arguments],
            "expansion": expansion,
            "environment": dict(environment or {}),
            "unprivileged": unprivileged,
            "folder": str(folder or Path.cwd()),
            "streams": {str(number): fate for number, fate in (streams or {}).items()},
        }
        stream = self._stream(self._process.stdin)
        stream.write(json.dumps(request) + "\n")
        stream.flush()
        return Result(**json.loads(self._stream(self._process.stdout).readline()))


def _serve() -> None:
    # What a child needs is imported before it is forked.
    import sympy  # noqa: F401

    import pinscrew as ps
    from pinscrew.cli import _COMMANDS

    for module in (*_COMMANDS.values(), "pinscrew.cli.tables", "pinscrew.derivation.run", "pinscrew.workspace"):
        import_module(module)
    ps.verify(ps.load("one_joint"), samples=1)
    replies = os.fdopen(os.dup(1), "w")
    for line in sys.stdin:
        json.dump(_answer(json.loads(line)), replies)
        replies.write("\n")
        replies.flush()


def _answer(request: Mapping[str, Any]) -> dict[str, Any]:
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        start = time.monotonic()
        child = os.fork()
        if child == 0:
            _run(request, out.fileno(), err.fileno())
        status, work, peak = _wait(child, start)
        texts = []
        for stream in (out, err):
            stream.seek(0)
            texts.append(stream.read().decode(errors="replace"))
    seconds = time.monotonic() - start
    measured = {"seconds": seconds, "work": work, "peak": peak}
    return {"status": status, "stdout": texts[0], "stderr": texts[1], **measured}


def _wait(child: int, start: float) -> tuple[int, float, int]:
    """Exit status, processor time and peak memory of a child, killed with all its own when its time is up."""
    while True:
        pid, status, usage = os.wait4(child, os.WNOHANG)
        if pid:
            unit = 1 if sys.platform == "darwin" else 1024
            return os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime, usage.ru_maxrss * unit
        if time.monotonic() - start > PATIENCE:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(child, signal.SIGKILL)
        time.sleep(0.002)


def _run(request: Mapping[str, Any], out: int, err: int) -> None:
    """The child: never returns."""
    status = 99
    try:
        os.setsid()
        os.dup2(out, 1)
        os.dup2(err, 2)
        for number, fate in request["streams"].items():
            _spoil(int(number), fate)
        sys.stdout, sys.stderr = (
            None if request["streams"].get(str(fd)) == "closed" else os.fdopen(fd, "w", encoding="utf-8")
            for fd in (1, 2)
        )  # as Python does as it starts
        _prepare(request)
        sys.argv = ["pinscrew", *request["arguments"]]
        runpy.run_module("pinscrew", run_name="__main__", alter_sys=True)
        status = 0
    except SystemExit as end:
        status = int(end.code or 0)
    except BaseException:
        traceback.print_exc()
    finally:
        for stream in (sys.stdout, sys.stderr):
            try:
                stream.flush()
            except OSError as error:  # as Python does as it ends
                status = 120
                os.write(err, f"Exception ignored in: {stream}: {error}\n".encode())
        os._exit(status)


def _spoil(number: int, fate: str) -> None:
    """Let a stream fail."""
    os.close(number)
    if fate == "full":
        os.open("/dev/full", os.O_WRONLY)  # the lowest free number: this one
    elif fate == "unread":
        reading, writing = os.pipe()
        if writing != number:
            os.dup2(writing, number)
            os.close(writing)
        if reading != number:
            os.close(reading)


def _prepare(request: Mapping[str, Any]) -> None:
    from pinscrew.description import expand

    os.chdir(request["folder"])
    os.environ.update(request["environment"])
    if request["expansion"]:
        expand.SECONDS = request["expansion"]
    _limit()
    if request["unprivileged"] and os.geteuid() == 0:
        os.setegid(NOBODY)
        os.seteuid(NOBODY)


def _limit() -> None:
    limits = {resource.RLIMIT_CPU: SECONDS, resource.RLIMIT_CORE: 0, resource.RLIMIT_FSIZE: 2**26}
    if sys.platform == "linux":
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
        limits[resource.RLIMIT_AS] = pages * resource.getpagesize() + MEMORY
    for which, most in limits.items():
        resource.setrlimit(which, (most, resource.getrlimit(which)[1]))


def one_error(result: Result, words: Sequence[str]) -> str:
    """The message of a child that ended with one error of pinscrew, without ``pinscrew:``, and nothing else."""
    assert result.status == 2, result
    assert result.stdout == ""
    lines = result.stderr.splitlines()
    assert len(lines) == 1, result.stderr[:2000]
    assert lines[0].startswith("pinscrew: ")
    assert not lines[0].startswith("pinscrew: warning: ")
    for word in words:
        assert word in lines[0]
    within_limits(result)
    return lines[0].removeprefix("pinscrew: ")


def within_limits(result: Result) -> None:
    """That a child took no more than it may, as far as nothing ended it for that."""
    assert result.work < SECONDS
    assert result.peak < MEMORY


if __name__ == "__main__":
    _serve()
