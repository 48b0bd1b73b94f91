"""The cache of compiled kernels: what is loaded is what this user's pinscrew stored for that very question."""

from __future__ import annotations

import hashlib
import os
import socket
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pinscrew as ps
from pinscrew.engines.compiled import cache
from pinscrew.ground.errors import PinscrewWarning

pytest.importorskip("llvmlite")

KEY = cache.key_of("a", "b")
CODE = b"not run here"

ASK = """
import numpy as np, pinscrew as ps
robot = ps.load("scara_rrp")
q = np.random.default_rng(0).uniform(-3, 3, (50, 3))
assert abs(ps.Batch(robot).fk(q) - ps.PoE(robot).fk(q)).max() < 1e-13
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A cache of one's own, in which nobody has been warned yet."""
    place = tmp_path / "cache"
    monkeypatch.setenv("PINSCREW_CACHE", str(place))
    cache._say_unused.cache_clear()
    yield place
    cache._say_unused.cache_clear()


def ask(folder: Path, code: str = ASK) -> subprocess.Popen[str]:
    environment = {**os.environ, "PINSCREW_CACHE": str(folder)}
    pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen([sys.executable, "-c", code], env=environment, **pipes)


def outcome(process: subprocess.Popen[str]) -> str:
    out, words = process.communicate(timeout=120)
    assert process.returncode == 0, words
    return out + words


def warned(do: Callable[[], object]) -> list[str]:
    """What is said of the cache meanwhile; nothing else may be said."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        do()
    assert {getattr(one.message, "code", None) for one in caught} <= {"cache"}
    return [str(one.message) for one in caught]


# ------------------------------------------------------------------------------------- between processes


def test_two_at_once_and_a_third(folder: Path) -> None:
    """Two processes compile at once; a third finds what they kept; a damaged file is compiled anew."""
    for process in [ask(folder), ask(folder)]:
        assert outcome(process) == ""
    (kept,) = folder.iterdir()
    good = kept.read_bytes()
    kept.write_bytes(good[:-100])
    assert outcome(ask(folder)) == ""
    assert kept.read_bytes() == good
    before = kept.stat().st_mtime_ns
    assert outcome(ask(folder)) == ""
    assert kept.stat().st_mtime_ns == before
    assert list(folder.iterdir()) == [kept]
    assert folder.stat().st_mode & 0o777 == 0o700
    assert kept.stat().st_mode & 0o777 == 0o600


def test_no_cache(tmp_path: Path) -> None:
    """A folder that can't be made, because a file is in its way, only costs time."""
    (tmp_path / "file").write_text("")
    assert outcome(ask(tmp_path / "file" / "cache")) == ""


# ------------------------------------------------------------------------------- what a file is good for


def agree(robot: ps.Robot) -> bool:
    """Whether a fresh compiled engine says what the other one says; it takes what is in the cache."""
    q = np.random.default_rng(0).uniform(-1, 1, (20, robot.nq))
    return bool(abs(ps.Batch(robot).fk(q) - ps.PoE(robot).fk(q)).max() < 1e-13)


def test_another_arms_kernel_is_not_loaded(folder: Path) -> None:
    """Two SCARAs differ by a length alone: a kernel of the one under the other's name would be wrong by 0.5 m."""
    long, short = ps.load("scara", l1=0.9), ps.load("scara", l1=0.4)
    assert agree(long)
    (first,) = folder.iterdir()
    foreign = first.read_bytes()
    assert agree(short)
    (second,) = set(folder.iterdir()) - {first}
    own = second.read_bytes()
    for copied in (foreign, own[:32] + foreign[32:], foreign[:32] + own[32:]):
        second.write_bytes(copied)
        assert agree(short)
        assert second.read_bytes() == own, "what was refused is compiled anew and stored"


FORGED = {
    "the digest of the code alone": lambda code: hashlib.sha256(code).digest() + code,
    "bound to another key": lambda code: cache._digest(cache.key_of("another"), code) + code,
    "cut": lambda code: cache._digest(KEY, code) + code[:-1],
    "a digest alone": lambda code: cache._digest(KEY, code),
    "empty": lambda _: b"",
}


@pytest.mark.parametrize("forge", FORGED.values(), ids=FORGED)
def test_forged(forge: Callable[[bytes], bytes], folder: Path) -> None:
    cache.store(KEY, CODE)
    assert cache.load(KEY) == CODE
    (folder / KEY).write_bytes(forge(CODE))
    assert cache.load(KEY) is None


def test_keys() -> None:
    """Every part counts, and so does where one ends."""
    lists = [("ab", "c"), ("a", "bc"), ("abc",), ("abc", ""), ("", "abc"), ("c", "ab"), ("a\0b", "c")]
    assert len({cache.key_of(*parts) for parts in lists}) == len(lists)


@pytest.mark.parametrize("changed", ["version", "processor", "features", "compiler", "system"])
def test_what_a_kernel_is_bound_to(changed: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another version of ours or the compiler's, another processor or system: compiled anew."""
    from pinscrew.engines.compiled import machine

    robot = ps.load("planar_rrr")
    assert agree(robot)
    (before,) = folder.iterdir()
    cpu, features = machine.processor()
    if changed == "version":
        monkeypatch.setattr(machine, "__version__", "0.0.9")
    elif changed == "compiler":
        monkeypatch.setattr(machine.llvmlite, "__version__", "0.0.9")
    elif changed == "system":
        real = machine.llvm.get_default_triple()
        monkeypatch.setattr(machine.llvm, "get_default_triple", lambda: real + "-other")
    elif changed == "processor":
        monkeypatch.setattr(machine, "processor", lambda: ("generic", features))
    else:
        monkeypatch.setattr(machine, "processor", lambda: (cpu, features + ",-prfchw"))
    assert agree(robot)
    assert before in (now := set(folder.iterdir()))
    assert len(now) == 2


# ------------------------------------------------------------------------------------- whom it belongs to


@pytest.mark.parametrize("mode", [0o770, 0o702, 0o722])
def test_a_folder_that_others_may_write_to(mode: int, folder: Path) -> None:
    cache.store(KEY, CODE)
    folder.chmod(mode)
    (said,) = warned(lambda: cache.load(KEY))
    assert said.startswith(f"{folder} may be written by others")
    assert cache.load(KEY) is None
    assert warned(lambda: (cache.load(KEY), cache.store(cache.key_of("x"), CODE))) == [], "it is said once"
    assert [path.name for path in folder.iterdir()] == [KEY], "nothing is stored there either"
    folder.chmod(0o755)
    assert cache.load(KEY) == CODE


@pytest.mark.parametrize("mode", [0o620, 0o602])
def test_a_file_that_others_may_write_to(mode: int, folder: Path) -> None:
    cache.store(KEY, CODE)
    (folder / KEY).chmod(mode)
    (said,) = warned(lambda: cache.load(KEY))
    assert said.startswith(f"{folder / KEY} may be written by others")
    cache.store(KEY, CODE)  # in its place
    assert cache.load(KEY) == CODE


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give files away")
@pytest.mark.parametrize("name", ["", KEY])
def test_another_users(name: str, folder: Path) -> None:
    cache.store(KEY, CODE)
    os.chown(folder / name, 65534, 65534)
    (said,) = warned(lambda: cache.load(KEY))
    assert "belongs to another user" in said
    assert cache.load(KEY) is None


def test_the_note_is_ours(folder: Path) -> None:
    folder.mkdir(mode=0o700)
    folder.chmod(0o777)
    with pytest.warns(PinscrewWarning, match="PINSCREW_CACHE") as caught:
        assert agree(ps.load("planar_rrr"))
    assert [one.message.code for one in caught if isinstance(one.message, PinscrewWarning)] == ["cache"]


# --------------------------------------------------------------------------------------- links and pipes


def test_a_link_for_a_file(folder: Path, tmp_path: Path) -> None:
    """It is not read, and what it leads to is not written over."""
    cache.store(KEY, CODE)
    elsewhere = tmp_path / "elsewhere"
    (folder / KEY).rename(elsewhere)
    (folder / KEY).symlink_to(elsewhere)
    kept = elsewhere.read_bytes()
    (said,) = warned(lambda: cache.load(KEY))
    assert said.startswith(f"{folder / KEY} is a link")
    assert cache.load(KEY) is None
    cache.store(KEY, b"other")
    assert elsewhere.read_bytes() == kept
    assert cache.load(KEY) == b"other"


def test_a_link_for_the_folder(folder: Path, tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir(mode=0o700)
    folder.symlink_to(elsewhere)
    (said,) = warned(lambda: cache.store(KEY, CODE))
    assert said.startswith(f"{folder} is a link")
    assert list(elsewhere.iterdir()) == []


def a_pipe(path: Path) -> None:
    os.mkfifo(path)


def a_socket(path: Path) -> None:
    here = Path.cwd()
    os.chdir(path.parent)  # the path of a socket may have 100 characters
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(path.name)
    os.chdir(here)


@pytest.mark.parametrize("make", [a_pipe, a_socket, Path.mkdir])
def test_what_is_no_file(make: Callable[[Path], None], folder: Path) -> None:
    """Nobody waits for a writer, and a kernel takes the place of what is there, if that can be."""
    cache.store(cache.key_of("x"), CODE)
    make(folder / KEY)
    start = time.monotonic()
    said = warned(lambda: cache.load(KEY))
    assert time.monotonic() - start < 10
    assert all("is no file" in one for one in said)
    cache.store(KEY, CODE)
    assert cache.load(KEY) == (None if make is Path.mkdir else CODE)
    assert not [path for path in folder.iterdir() if path.name.startswith(".")], "nothing is left behind"


def test_a_pipe_for_a_kernel(folder: Path) -> None:
    robot = ps.load("planar_rrr")
    assert agree(robot)
    (kept,) = folder.iterdir()
    kept.unlink()
    os.mkfifo(kept)
    assert len(warned(lambda: agree(robot))) == 1
    assert agree(robot)
    assert kept.is_file()


def test_a_huge_file(folder: Path) -> None:
    cache.store(KEY, CODE)
    os.truncate(folder / KEY, 2**40)  # a hole, not bytes
    (said,) = warned(lambda: cache.load(KEY))
    assert "has 1099511627776 bytes" in said
