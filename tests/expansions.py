"""Expands xacro files in forks of one process that has xacro loaded: milliseconds instead of a fifth of a second each.

It stands in for what `pinscrew.description.expand` takes from `subprocess`; the worker, its limits and its answer are
the real ones. This file as a script is the process that forks.
"""

from __future__ import annotations

import io
import json
import os
import select
import signal
import subprocess
import sys
import threading
import time
import traceback
from pathlib import Path
from typing import Any


class Expansions:
    """A context manager, whose `run` is used as `subprocess.run` is; the process starts with the first."""

    TimeoutExpired = subprocess.TimeoutExpired

    def __init__(self) -> None:
        self._process: subprocess.Popen[str] | None = None
        self._lock = threading.Lock()  # derivations ask in threads

    def __enter__(self) -> Expansions:
        return self

    def __exit__(self, *_: object) -> None:
        if self._process is None:
            return
        for stream in (self._process.stdin, self._process.stdout):
            assert stream is not None
            stream.close()
        self._process.wait(10)

    def run(
        self,
        command: list[str],
        *,
        input: str,  # noqa: A002 (as in subprocess)
        timeout: float,
        **rest: Any,
    ) -> subprocess.CompletedProcess[str]:
        """What becomes of the worker with this input."""
        if not command[1].endswith("_xacro_worker.py"):
            return subprocess.run(command, input=input, timeout=timeout, **rest)
        surroundings = {"folder": str(Path.cwd()), "environment": dict(os.environ)}
        with self._lock:
            answer = self._ask({"input": input, "timeout": timeout, **surroundings})
        if answer is None:
            raise subprocess.TimeoutExpired(command, timeout)
        return subprocess.CompletedProcess(command, **answer)

    def _ask(self, request: dict[str, Any]) -> dict[str, Any] | None:
        if self._process is None:
            server = [sys.executable, __file__]
            self._process = subprocess.Popen(server, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps(request) + "\n")
        self._process.stdin.flush()
        answer: dict[str, Any] | None = json.loads(self._process.stdout.readline())
        return answer


def _serve() -> None:
    from pinscrew.description import _xacro_worker

    for line in sys.stdin:
        request = json.loads(line)
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(reading)
            sys.stdin, sys.stdout, sys.stderr = io.StringIO(request["input"]), io.StringIO(), io.StringIO()
            status = 0
            try:
                os.chdir(request["folder"])
                os.environ.clear()
                os.environ.update(request["environment"])
                _xacro_worker.main()
            except BaseException:
                traceback.print_exc()
                status = 1
            with os.fdopen(writing, "w") as pipe:  # no file: the worker may write none
                json.dump({"stdout": sys.stdout.getvalue(), "stderr": sys.stderr.getvalue()}, pipe)
            os._exit(status)
        os.close(writing)
        said = _all(reading, time.monotonic() + request["timeout"])
        if said is None:
            os.kill(child, signal.SIGKILL)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        texts = json.loads(said or '{"stdout": "", "stderr": ""}')
        print(json.dumps(None if said is None else {"returncode": status, **texts}), flush=True)  # noqa: T201


def _all(pipe: int, end: float) -> str | None:
    """What comes through a pipe until it is closed, or None if that is later than it may be."""
    data = b""
    with os.fdopen(pipe, "rb", buffering=0) as stream:
        while select.select([stream], [], [], max(end - time.monotonic(), 0))[0]:
            piece = stream.read(2**20)
            if not piece:
                return data.decode()
            data += piece
    return None


if __name__ == "__main__":
    _serve()
