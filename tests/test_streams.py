"""Standard streams that fail: a full disk, a closed stream, a reader that has gone; no command ends in a traceback."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import limited
import pinscrew as ps
import urdfs
from pinscrew.cli import _COMMANDS, BROKEN_PIPE

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="there is no /dev/full")

FILE = "arm.urdf"
EVERY: dict[str, list[str]] = {
    "check": [FILE, "--quantity", "xi1", "--text", "[-0.5, 0, 0.3, 0, 1, 0]"],
    "completion": ["bash"],
    "derive": [FILE],
    "dh": [FILE],
    "diff": [FILE, FILE],
    "expand": [FILE],
    "fk": [FILE],
    "identify": [FILE, "-q", "0.3", "--matrix", "T.txt"],
    "jacobian": [FILE, "--kind", "body"],
    "list": [],
    "lock": [FILE, "--check"],
    "screws": [FILE],
    "show": [FILE, "--html", "/dev/stdout"],
    "track": [FILE, "--profile", "profile.csv"],
    "velocity": [FILE, "--qd", "1"],
    "verify": [FILE, "--samples", "2"],
    "workspace": [FILE, "--samples", "20"],
}
SILENT = ("show",)  # writes to a file, which says so by itself


@pytest.fixture(scope="module")
def server() -> Iterator[limited.Server]:
    with limited.Server() as started:
        yield started


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, server: limited.Server) -> Path:
    folder = tmp_path_factory.mktemp("streams")
    (folder / FILE).write_text(urdfs.single_revolute())
    np.savetxt(folder / "T.txt", ps.Pinocchio(ps.load(folder / FILE)).fk([0.3]))
    (folder / "profile.csv").write_text("t,j\n0,0\n0.1,1\n")
    assert server.run("lock", FILE, folder=folder).status == 0
    return folder


def test_every_command_is_here() -> None:
    assert set(EVERY) == set(_COMMANDS)


@pytest.mark.parametrize("command", EVERY)
def test_each_works_where_nothing_fails(command: str, server: limited.Server, folder: Path) -> None:
    result = server.run(command, *EVERY[command], folder=folder)
    assert result.status == 0, result
    assert result.stdout


@pytest.mark.parametrize("command", EVERY)
def test_full(command: str, server: limited.Server, folder: Path) -> None:
    """One line says that the output is not there, and so does the status."""
    result = server.run(command, *EVERY[command], folder=folder, streams={1: "full"})
    assert result.status == 2, result
    *_, last = result.stderr.splitlines()
    assert last.startswith("pinscrew: ")
    assert "No space left on device" in last
    assert "Traceback" not in result.stderr
    assert "ignored" not in result.stderr


@pytest.mark.parametrize("command", EVERY)
def test_closed(command: str, server: limited.Server, folder: Path) -> None:
    """Who closes the output wants the status only."""
    result = server.run(command, *EVERY[command], folder=folder, streams={1: "closed"})
    assert result.status == 0, result
    assert "Traceback" not in result.stderr
    assert sorted(path.name for path in folder.iterdir()) == sorted((FILE, f"{FILE}.lock", "T.txt", "profile.csv"))


@pytest.mark.parametrize("command", [command for command in EVERY if command not in SILENT])
def test_unread(command: str, server: limited.Server, folder: Path) -> None:
    """As `head` does it: silence, and the status that a shell gives a program that SIGPIPE ended."""
    result = server.run(command, *EVERY[command], folder=folder, streams={1: "unread"})
    assert result.status == BROKEN_PIPE, result
    assert "Traceback" not in result.stderr
    assert "pinscrew:" not in result.stderr


@pytest.mark.parametrize("fate", ["full", "closed", "unread"])
def test_errors_that_nobody_hears(fate: str, server: limited.Server, folder: Path) -> None:
    """An error has its status, whatever becomes of its words."""
    result = server.run("fk", "nowhere.urdf", folder=folder, streams={2: fate})
    assert result.status in (2, BROKEN_PIPE)
    assert result.status == 2 or fate == "unread"
    assert (result.stdout, result.stderr) == ("", "")
    both = server.run("fk", FILE, folder=folder, streams={1: fate, 2: fate})
    assert both.status == {"full": 2, "closed": 0, "unread": BROKEN_PIPE}[fate]


@pytest.mark.parametrize(("redirected", "status"), [("> /dev/full", 2), (">&-", 0), ("2>&- >&- <&-", 0)])
def test_a_real_process(redirected: str, status: int) -> None:
    """Once as a shell does it, to show that the server's forks are the same."""
    script = f"{sys.executable} -m pinscrew list {redirected}"
    done = subprocess.run(["sh", "-c", script], capture_output=True, text=True)
    assert done.returncode == status
    assert done.stderr.count("\n") == bool(status)
