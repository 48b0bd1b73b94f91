"""Files are written whole or not at all, and stay whose they are."""

from __future__ import annotations

import os
import select
import socket
import stat
import threading
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Final

import pytest

import urdfs
from command_line import ok, refusal, refused
from pinscrew.cli import _COMMANDS
from pinscrew.cli.output import FILE
from pinscrew.description.packages import package_name
from pinscrew.ground import files
from pinscrew.ground.errors import InputError


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def names(folder: Path) -> list[str]:
    return [path.name for path in folder.iterdir()]


def write_2(path: Path) -> None:
    files.write(path, b"2")


def test_a_new_file_has_the_mode_that_the_mask_leaves(tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        files.write(tmp_path / "a", b"1")
    finally:
        os.umask(before)
    assert (tmp_path / "a").read_bytes() == b"1"
    assert mode(tmp_path / "a") == 0o640


@pytest.mark.parametrize("bits", [0o600, 0o644, 0o755, 0o200, 0o4711])
def test_a_file_keeps_its_mode(tmp_path: Path, bits: int) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"1")
    path.chmod(bits)
    files.write(path, b"22")
    assert mode(path) == bits
    path.chmod(0o600)
    assert path.read_bytes() == b"22"
    assert names(tmp_path) == ["a"]


@pytest.mark.parametrize("bits", [0o444, 0o400, 0o555, 0])
def test_what_nobody_may_write_is_not_replaced(tmp_path: Path, bits: int) -> None:
    """Not even by root, who may do all."""
    path = tmp_path / "a"
    path.write_bytes(b"1")
    path.chmod(bits)
    for refusing in (files.check, write_2):
        with pytest.raises(InputError) as caught:
            refusing(path)
        assert (caught.value.code, caught.value.where) == ("unwritable", str(path))
    assert mode(path) == bits
    path.chmod(0o600)
    assert path.read_bytes() == b"1"
    assert names(tmp_path) == ["a"]


@pytest.mark.skipif(os.geteuid() != 0, reason="only root has files that are another's")
def test_a_file_keeps_its_owner(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"1")
    os.chown(path, 65534, 65534)
    files.write(path, b"2")
    assert (path.stat().st_uid, path.stat().st_gid) == (65534, 65534)


@pytest.mark.parametrize("name", ["a" * 255, "é" * 127, "a\nb", "=1", "-x"])
def test_names_that_a_folder_can_have(tmp_path: Path, name: str) -> None:
    files.check(tmp_path / name)
    assert names(tmp_path) == []
    files.write(tmp_path / name, b"1")
    files.check(tmp_path / name)
    files.write(tmp_path / name, b"2")
    assert (tmp_path / name).read_bytes() == b"2"
    assert names(tmp_path) == [name]


@pytest.mark.parametrize("name", ["a" * 256, "é" * 128, "a\0b", "folder", "file/b", "no/b", "loop"])
def test_names_that_it_can_not(tmp_path: Path, name: str) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").touch()
    (tmp_path / "loop").symlink_to("loop")
    before = sorted(names(tmp_path))
    for refusing in (files.check, write_2):
        with pytest.raises(InputError) as caught:
            refusing(tmp_path / name)
        assert caught.value.code == "unwritable"
    assert sorted(names(tmp_path)) == before


def test_a_folder_that_we_may_not_change(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """For root there is none, so the system's answer is ours."""
    files.check(tmp_path / "a")
    monkeypatch.setattr(os, "access", lambda path, how: not (path == tmp_path and how & os.W_OK))
    with pytest.raises(InputError, match="Permission denied"):
        files.check(tmp_path / "a")


def test_links_are_followed(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to("folder/file")
    (tmp_path / "folder").mkdir()
    for text in (b"1", b"2"):
        files.write(tmp_path / "link", text)
        assert (tmp_path / "link").is_symlink()
        assert (tmp_path / "folder" / "file").read_bytes() == text


def test_devices_are_written_to_directly(tmp_path: Path) -> None:
    files.write(Path(os.devnull), b"1")
    assert Path(os.devnull).is_char_device()
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    end = os.open(pipe, os.O_RDWR)
    files.write(pipe, b"12")
    assert os.read(end, 3) == b"12"
    os.close(end)
    assert stat.S_ISFIFO(pipe.stat().st_mode)


@pytest.mark.parametrize("function", [lambda path, _: files.check(path), files.write, files.append])
def test_a_pipe_that_nobody_reads_is_not_waited_for(function: Callable[[Path, bytes], None], tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    failures: list[Exception] = []

    def attempt() -> None:
        try:
            function(pipe, b"1")
        except InputError as error:
            failures.append(error)

    thread = threading.Thread(target=attempt, daemon=True)
    thread.start()
    thread.join(2)
    assert [(error.code, "nobody reads" in error.what) for error in failures] == [("unwritable", True)]
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_a_slow_reader_of_a_pipe_gets_all(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    end = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    os.set_blocking(end, True)
    data = b"12345678" * 2**15  # more than a pipe holds
    files.check(pipe)
    assert select.select([end], [], [], 0)[0] == []  # it is no end of what it reads
    writer = threading.Thread(target=files.write, args=(pipe, data), daemon=True)
    writer.start()
    with os.fdopen(end, "rb") as stream:
        select.select([stream], [], [], 5)
        assert stream.read() == data
    writer.join(5)


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="there is no /dev/fd")
def test_open_streams_are_written_to_where_they_are(tmp_path: Path) -> None:
    """A file that is another's output too, as with ``>> log``, is neither replaced nor cut."""
    with (tmp_path / "a").open("ab") as stream:
        stream.write(b"1")
        stream.flush()
        files.write(Path(f"/dev/fd/{stream.fileno()}"), b"2")
        stream.write(b"3")
    assert (tmp_path / "a").read_bytes() == b"123"
    for refusing in (files.check, write_2):
        with pytest.raises(InputError):
            refusing(Path("/dev/fd/999999"))


TARGETS: Final = [
    pytest.param(name, option.opts[-1], id=f"{name} {option.opts[-1]}")
    for name, module in _COMMANDS.items()
    for option in import_module(module).command.params
    if option.type is FILE
]


@pytest.mark.parametrize(("command", "option"), TARGETS)
def test_what_a_command_can_not_write_is_known_before_its_work(command: str, option: str, tmp_path: Path) -> None:
    """The robot, which is not there, is not even looked for."""
    (tmp_path / "folder.png").mkdir()
    (tmp_path / "protected.png").touch(0o444)
    (tmp_path / "loop.png").symlink_to("loop.png")
    os.mkfifo(tmp_path / "pipe.png")
    before = sorted(names(tmp_path))
    for name in ("folder.png", "protected.png", "loop.png", "pipe.png", "none/a.png", "protected.png/a.png"):
        error = refusal(command, "nowhere.urdf", option, tmp_path / name)
        assert (error.code, error.where) == ("unwritable", str(tmp_path / name))
    assert sorted(names(tmp_path)) == before


def test_locks_are_written_all_or_none(tmp_path: Path) -> None:
    robots = [tmp_path / "a.urdf", tmp_path / "b.urdf"]
    for robot in robots:
        robot.write_text(urdfs.single_revolute())
    (tmp_path / "b.urdf.lock").mkdir()
    assert refusal("lock", *robots).code == "unwritable"
    assert not (tmp_path / "a.urdf.lock").exists()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_a_full_disk_is_told() -> None:
    for function in (files.write, files.append):
        with pytest.raises(InputError) as caught:
            function(Path("/dev/full"), b"1")
        assert "No space left" in caught.value.what


def test_nothing_is_left_of_what_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    (tmp_path / "a").write_bytes(b"1")
    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(InputError):
        files.write(tmp_path / "a", b"2")
    assert names(tmp_path) == ["a"]
    assert (tmp_path / "a").read_bytes() == b"1"


def test_append(tmp_path: Path) -> None:
    files.append(tmp_path / "a", b"1")
    files.append(tmp_path / "a", b"2")
    assert (tmp_path / "a").read_bytes() == b"12"
    with pytest.raises(InputError):
        files.append(tmp_path / "no" / "a", b"1")


def test_only_plain_files_are_read(tmp_path: Path) -> None:
    """At once, whatever it is: opening a pipe for reading waits for a writer, and /dev/zero never ends."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    door = tmp_path / "socket"
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(str(door))
    for path in (pipe, door, Path("/dev/zero"), tmp_path):
        with pytest.raises(OSError, match=r"plain file|directory"):
            files.open_plain(path)
    plain = tmp_path / "plain"
    plain.write_bytes(b"12")
    with files.open_plain(plain) as stream:
        assert stream.read() == b"12"


def test_pipes_where_other_files_are_looked_for(tmp_path: Path) -> None:
    """A lock to be written anew, and the description of a package: neither is waited for."""
    robot = tmp_path / "a.urdf"
    robot.write_text(urdfs.single_revolute())
    lock = tmp_path / "a.urdf.lock"
    os.mkfifo(lock)
    assert str(lock) in refused("lock", robot)
    assert stat.S_ISFIFO(lock.stat().st_mode)
    os.mkfifo(tmp_path / "package.xml")
    assert package_name(tmp_path) == ""
    assert ok("fk", robot, "-q", "0").out
