"""Children of this process: they answer, and they end when it does, however it ends."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor
from pathlib import Path

import pytest

from pinscrew.ground.children import program
from pinscrew.ground.errors import InputError, ViewError
from pinscrew.ground.processes import process_pool
from pinscrew.view.png import BROWSERS, picture

pytestmark = pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="processes are counted in /proc")

MARK = "PINSCREW_TEST_OF_PROCESSES"


def marked(mark: str) -> set[int]:
    """The processes that run with a mark in their environment, and are not only waited for."""
    found = set()
    for folder in Path("/proc").iterdir():
        with contextlib.suppress(OSError):
            if folder.name.isdigit() and f"{MARK}={mark}".encode() in (folder / "environ").read_bytes():
                state = (folder / "stat").read_text().rpartition(")")[2].split()[0]
                found |= {int(folder.name)} if state != "Z" else set()
    return found


def until(condition: Callable[[], bool], seconds: float = 30.0) -> bool:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.02)
    return False


@pytest.fixture
def mark(request: pytest.FixtureRequest) -> Iterator[str]:
    """A mark for a test's processes; none of them may be left."""
    name = f"{os.getpid()}-{request.node.name}"
    yield name
    left = marked(name)
    for pid in left:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    assert not left


@contextlib.contextmanager
def start(script: Path, mark: str, code: str) -> Iterator[subprocess.Popen[str]]:
    script.write_text(code)
    words = [sys.executable, script]
    environment = {**os.environ, MARK: mark}
    with subprocess.Popen(words, env=environment, stderr=subprocess.PIPE, text=True, start_new_session=True) as process:
        try:
            yield process
        finally:
            process.kill()


# ------------------------------------------------------------------------------------------------ the pool


def square(x: int) -> int:
    return x * x


def fail(code: str) -> None:
    raise InputError(code, "it fails")


class FussyError(Exception):
    """It does not survive a trip between processes."""

    def __init__(self, first: int, second: int) -> None:
        super().__init__(f"fussy {first + second}")


def fail_fussily() -> None:
    raise FussyError(1, 2)


def end() -> None:
    os._exit(3)


def test_answers() -> None:
    with process_pool(2) as (pool, workers):
        assert workers == 2
        assert list(pool.map(square, range(10))) == [x * x for x in range(10)]
        with pytest.raises(InputError, match="it fails") as caught:
            pool.submit(fail, "code").result()
        assert caught.value.code == "code"
        assert "in fail" in str(caught.value.__cause__)
        with pytest.raises(RuntimeError, match="FussyError: fussy 3"):
            pool.submit(fail_fussily).result()
        with pytest.raises(Exception, match="pickle"):
            pool.submit(lambda: None).result()
        assert pool.submit(square, 3).result() == 9, "errors do a worker no harm"


def test_a_worker_that_ends_breaks_the_pool() -> None:
    with process_pool(1) as (pool, _):
        assert pool.submit(square, 2).result() == 4
        for function in (end, end):
            with pytest.raises(BrokenExecutor):
                pool.submit(function).result()


def test_a_pool_in_a_thread_that_ends() -> None:
    """Workers are started by threads of the pool's own, not by whoever asks first."""
    with process_pool(1) as (pool, _):
        asking = threading.Thread(target=lambda: pool.submit(square, 1).result())
        asking.start()
        asking.join()
        time.sleep(0.1)
        assert pool.submit(square, 5).result() == 25


WORK = """
import os
from pinscrew.ground.processes import process_pool
from pinscrew.view.png import BROWSERS

def spin():
    os.write(2, b"ready\\n")
    while True:
        sum(range(1000))

if __name__ == "__main__":
    with process_pool(2) as (pool, _):
        for future in [pool.submit(spin), pool.submit(spin)]:
            future.result()
"""


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
@pytest.mark.parametrize("whole_group", [False, True])
def test_workers_end_with_their_parent(number: int, whole_group: bool, mark: str, tmp_path: Path) -> None:
    """All of them, in the middle of their work, and nobody complains of anything."""
    with start(tmp_path / "script.py", mark, WORK) as process:
        assert process.stderr is not None
        assert [process.stderr.readline() for _ in range(2)] == ["ready\n"] * 2
        assert len(marked(mark)) >= 3
        (os.killpg if whole_group else os.kill)(process.pid, number)
        assert until(lambda: not marked(mark))
        said = process.stderr.read()
        assert "semaphore" not in said
        assert said == "" or (number == signal.SIGINT and said.count("Traceback") == 1), said
        assert process.wait() == -number


GRIPPED = WORK.replace("while True:\n        sum(range(1000))", "sum(repeat(0, 10**12))")
GRIPPED = GRIPPED.replace("import os", "import os\nfrom itertools import repeat")


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux ends what does not listen")
def test_workers_that_hold_the_interpreter_end(mark: str, tmp_path: Path) -> None:
    """In the middle of one long instruction, in which no thread of Python's own is heard."""
    with start(tmp_path / "script.py", mark, GRIPPED) as process:
        assert process.stderr is not None
        assert [process.stderr.readline() for _ in range(2)] == ["ready\n"] * 2
        process.kill()
        assert until(lambda: not marked(mark), 5.0)


UNGUARDED = """
from pinscrew.ground.processes import process_pool
from pinscrew.view.png import BROWSERS
with process_pool(2) as (pool, _):
    print(pool.submit(abs, -1).result())
"""


def test_a_script_without_its_guard(mark: str, tmp_path: Path) -> None:
    """It starts itself in its workers; these refuse, and so it ends."""
    with start(tmp_path / "script.py", mark, UNGUARDED) as process:
        _, said = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "BrokenExecutor" in said


# ---------------------------------------------------------------------------------------- other programs

PROGRAM = """
import sys, time
from pinscrew.ground.children import program

with program(["/bin/sh", "-c", "sleep 600 & sleep 600 & echo ready; wait"], stdout=sys.stderr):
    time.sleep(600)
"""


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_programs_end_with_their_parent(number: int, mark: str, tmp_path: Path) -> None:
    with start(tmp_path / "script.py", mark, PROGRAM) as process:
        assert process.stderr is not None
        assert process.stderr.readline() == "ready\n"
        assert len(marked(mark)) >= 4
        process.send_signal(number)
        assert until(lambda: not marked(mark))


DROPPED = """
import os
import time
from pinscrew.cli.endings import heard
from pinscrew.view.png import BROWSERS

class Dropping:
    def __del__(self):
        os.write(2, b"ready\\n")
        time.sleep(600)

try:
    with heard():
        Dropping()
        try:
            time.sleep(600)
        except:
            os.write(2, b"dropped\\n")
        time.sleep(600)
except KeyboardInterrupt:
    raise SystemExit(130)
"""


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_an_end_that_a_library_drops(number: int, mark: str, tmp_path: Path) -> None:
    """One signal is enough, wherever it comes: it is raised until it ends the command."""
    with start(tmp_path / "script.py", mark, DROPPED) as process:
        assert process.stderr is not None
        assert process.stderr.readline() == "ready\n"
        process.send_signal(number)
        assert process.stderr.readline() == "dropped\n"
        _, said = process.communicate(timeout=30)
    assert said == ""
    assert process.returncode == 128 + number


COMMANDS = {
    "a picture": ("show", "panda", "--png", "{folder}/panda.png"),
    "a map": ("workspace", "spherical_rrp", "--map", "{folder}/map.npz", "--samples", "1000000000", "--jobs", "2"),
}


ENDS = {(name, number) for name in COMMANDS for number in (signal.SIGTERM, signal.SIGINT, signal.SIGKILL)}
OFTEN = {("a picture", signal.SIGTERM), ("a map", signal.SIGKILL), ("a map", signal.SIGINT)}
"""Ways to end a command; those in every run, the others in slow ones."""


@pytest.mark.parametrize(
    ("name", "number"),
    [pytest.param(*end, marks=() if end in OFTEN else pytest.mark.slow) for end in sorted(ENDS)],
)
def test_a_command_that_is_ended(name: str, number: int, mark: str, tmp_path: Path) -> None:
    """Browser and workers end with it; only SIGKILL may leave a temporary folder behind."""
    words = COMMANDS[name]
    if "show" in words and not any(map(shutil.which, BROWSERS)):
        pytest.skip("there is no browser")
    asked = [sys.executable, "-m", "pinscrew", *(word.format(folder=tmp_path) for word in words)]
    environment = {**os.environ, MARK: mark, "TMPDIR": str(tmp_path)}
    with subprocess.Popen(asked, env=environment, stderr=subprocess.PIPE, text=True) as process:
        try:
            assert until(lambda: len(marked(mark)) >= 3)
            process.send_signal(number)
            _, said = process.communicate(timeout=30)
        finally:
            process.kill()
    assert until(lambda: not marked(mark))
    assert "semaphore" not in said
    assert "Traceback" not in said or number == signal.SIGKILL  # a worker that had not yet been told what to do
    assert process.returncode == (-number if number == signal.SIGKILL else 128 + number)
    if number != signal.SIGKILL:
        assert not list(tmp_path.glob("pinscrew-*"))


def test_what_a_browser_leaves_when_it_is_stopped(mark: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    browser, place = tmp_path / "bin" / "chromium", tmp_path / "place"
    for folder in (browser.parent, place):
        folder.mkdir()
    browser.write_text(f'#!/bin/sh\ntouch "$TMPDIR/left"\ntouch {tmp_path}/came\nexec sleep 600\n')
    browser.chmod(0o755)
    monkeypatch.setenv("PATH", f"{browser.parent}:{os.environ['PATH']}")
    monkeypatch.setenv(MARK, mark)
    monkeypatch.setattr(tempfile, "tempdir", str(place))
    with pytest.raises(ViewError, match="did not end"):
        picture("", seconds=0.5)
    assert (tmp_path / "came").exists()
    assert list(place.iterdir()) == []
    assert until(lambda: not marked(mark))


INTERRUPTED = """
import runpy
import sys

class Ctrl:
    def find_spec(self, name, *_):
        if name == "pinscrew.cli.endings":
            raise KeyboardInterrupt

sys.meta_path.insert(0, Ctrl())
runpy.run_module("pinscrew", run_name="__main__", alter_sys=True)
"""


def test_an_interrupt_while_modules_are_loaded(mark: str, tmp_path: Path) -> None:
    with start(tmp_path / "script.py", mark, INTERRUPTED) as process:
        _, said = process.communicate(timeout=30)
    assert (process.returncode, said) == (130, "")


def test_a_program(mark: str) -> None:
    """Its output and its status are the program's, and what it started ends with the block."""
    words = ["/bin/sh", "-c", 'cat; sleep 600 >/dev/null & echo "$1 said"; exit 7', "sh", "a b"]
    with program(words, stdout=subprocess.PIPE, env={**os.environ, MARK: mark}) as process:
        out, _ = process.communicate(timeout=30)
        assert (out, process.returncode) == (b"a b said\n", 7)
        assert marked(mark)
    assert until(lambda: not marked(mark))


def test_a_program_that_is_not_there(mark: str) -> None:
    environment = {**os.environ, MARK: mark}
    with program(["/no/such/thing"], env=environment, stderr=subprocess.PIPE) as process:
        _, words = process.communicate(timeout=30)
    assert process.returncode == 127
    assert b"/no/such/thing" in words
    assert until(lambda: not marked(mark))


def test_nothing_is_left_open(mark: str) -> None:
    counts = []
    for _ in range(3):
        with program(["/bin/true"], env={**os.environ, MARK: mark}) as process:
            process.wait(30)
        with process_pool(1) as (pool, _workers):
            pool.submit(square, 1).result()
        counts.append(len(list(Path("/proc/self/fd").iterdir())))
    assert len(set(counts)) == 1, counts
    assert until(lambda: not marked(mark))
