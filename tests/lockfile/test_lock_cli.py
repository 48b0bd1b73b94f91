"""``pinscrew lock``: what it writes and refuses, what ``--check`` says, and the locks of this project's own robots."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

import urdfs
from command_line import ok, refused, run
from pinscrew import lockfile
from pinscrew.description import catalogue

XACRO = """<robot name="arm" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:arg name="l1" default="0.4"/>
<link name="base"/><link name="tool"/><joint name="j" type="continuous"><parent link="base"/><child link="tool"/>
<origin xyz="$(arg l1) 0 0"/><axis xyz="0 0 1"/></joint></robot>
"""
MACROS = '<robot xmlns:xacro="http://ros.org/wiki/xacro"><xacro:macro name="m" params="x"/></robot>'


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working directory with an arm and a xacro file."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "arm.urdf").write_text(urdfs.rotated())
    (tmp_path / "slim.urdf.xacro").write_text(XACRO)
    return tmp_path


def move(file: Path) -> None:
    """Edit the arm."""
    file.write_text(file.read_text().replace("0.1 -0.4 0.2", "0.1 -0.4 0.204"))


# ------------------------------------------------------------------------------------------------ writing


def test_it_writes_beside_the_file_what_the_library_says(here: Path) -> None:
    assert ok("lock", "arm.urdf", "slim.urdf.xacro").out == ("arm.urdf.lock: written\nslim.urdf.xacro.lock: written\n")
    robot = lockfile.read(here / "slim.urdf.xacro.lock")
    assert (robot.joint_names, robot.home()[0, 3]) == (("j",), 0.4)
    assert sorted(path.name for path in here.iterdir()) == [
        "arm.urdf", "arm.urdf.lock", "slim.urdf.xacro", "slim.urdf.xacro.lock"
    ]  # fmt: skip


def test_what_is_unchanged_keeps_its_bytes(here: Path) -> None:
    ok("lock", "arm.urdf", "slim.urdf.xacro")
    times = {path: path.stat().st_mtime_ns for path in here.glob("*.lock")}
    move(here / "arm.urdf")
    assert ok("lock", "arm.urdf", "slim.urdf.xacro").out == (
        "arm.urdf.lock: written\nslim.urdf.xacro.lock: unchanged\n"
    )
    changed = {path.name for path, time in times.items() if path.stat().st_mtime_ns != time}
    assert changed == {"arm.urdf.lock"}
    document = json.loads(ok("lock", "arm.urdf", "--json").out)
    assert document == {"schema": "pinscrew.locked/1", "locks": [{"lock": "arm.urdf.lock", "written": False}]}


def test_nothing_is_written_if_any_robot_fails(here: Path) -> None:
    (here / "bad.urdf").write_text("<robot/>")
    assert refused("lock", "arm.urdf", "bad.urdf").startswith("bad.urdf:1: ")
    assert not list(here.glob("*.lock"))


def test_what_cannot_be_written(here: Path) -> None:
    (here / "folder.urdf.lock").mkdir()
    for path in ("nowhere/arm.urdf.lock", "folder.urdf.lock"):
        assert f"{path}: can't be written" in refused("lock", "arm.urdf", "--output", path, "--allow-outside")
    assert not [path for path in here.rglob("*") if path.is_file() and ".lock" in path.name]


def test_a_write_that_fails_keeps_the_old_lock(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ok("lock", "arm.urdf")
    before = (here / "arm.urdf.lock").read_bytes()
    move(here / "arm.urdf")

    def full(*_: Path) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(Path, "replace", full)
        assert refused("lock", "arm.urdf") == "arm.urdf.lock: can't be written (No space left on device)"
    assert (here / "arm.urdf.lock").read_bytes() == before
    assert len(list(here.iterdir())) == 3


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize("name", ["scara", "panda", "no_such_robot"])
def test_names_are_refused(name: str) -> None:
    words = f"{name}: is no file, and a lock stands beside its robot's file; give the path of a .urdf, .xacro or .xml"
    assert refused("lock", name) == refused("lock", "--check", name) == words


def test_other_suffixes(here: Path) -> None:
    (here / "arm.txt").write_text(urdfs.rotated())
    assert "name the lock with --output, such as arm.urdf.lock" in refused("lock", "arm.txt")
    assert "so --check would not find it" in refused("lock", "arm.txt", "--output", "arm.lock")
    ok("lock", "arm.txt", "--output", "other.urdf.lock")
    assert "other.urdf.lock: the same" in ok("lock", "--check").out


def test_arguments_tip_and_base_are_kept(here: Path) -> None:
    ok("lock", "slim.urdf.xacro", "l1:=0.5", "--floating-base", "--tip", "tool")
    lock = here / "slim.urdf.xacro.lock"
    before = lock.read_text()
    message = refused("lock", "slim.urdf.xacro")
    assert "it was made with l1:=0.5 --floating-base --tip tool, and not as this one would be" in message
    (here / "slim.urdf.xacro").write_text(XACRO.replace(" 0 0", " 0 0.1", 1))
    assert run("lock", "--check").status == 1
    assert ok("lock", lock.name).out == "slim.urdf.xacro.lock: written\n"
    assert lock.read_text() != before
    assert "slim.urdf.xacro.lock: the same" in ok("lock", "--check").out
    assert "of its own" in refused("lock", lock.name, "l1:=0.4")


WAYS = {
    "arguments": ("slim.urdf.xacro", ("l1:=0.5",), "l1:=0.5"),
    "tip": ("slim.urdf.xacro", ("--tip", "base"), "--tip base"),
    "floating base": ("slim.urdf.xacro", ("--floating-base",), "--floating-base"),
}


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(("file", "words", "told"), WAYS.values(), ids=WAYS)
def test_a_lock_that_was_made_in_another_way_is_not_written_over(file: str, words: tuple[str, ...], told: str) -> None:
    """Each way on its own, in both directions; made in the same way it is written."""
    ok("lock", file, *words)
    lock = Path(f"{file}.lock")
    before = lock.read_text()
    assert f"it was made with {told}, and not as" in refused("lock", file)
    assert lock.read_text() == before
    assert ok("lock", file, *words).out == f"{lock}: unchanged\n"
    lock.unlink()
    ok("lock", file)
    assert "it was made with no arguments, and not as" in refused("lock", file, *words)
    others = ("--tip", "tool") if words[0] == "--tip" else words
    assert "and not as" in refused("lock", file, *others)


def test_several_locks_of_one_file(here: Path) -> None:
    assert "two robots for the lock" in refused("lock", "slim.urdf.xacro", "slim.urdf.xacro", "l1:=0.5")
    (here / "locks").mkdir()
    for length in ("0.5", "0.6"):
        words = ("lock", "slim.urdf.xacro", f"l1:={length}", "--output", f"locks/slim_{length}.xacro.lock")
        assert "is outside its folder" in refused(*words)
        ok(*words, "--allow-outside")
    assert run("lock", "--check").status == 2
    done = ok("lock", "--check", "--allow-outside")
    assert done.out.splitlines()[-1] == "2 of 2 mechanisms are those of their locks"
    assert "--output takes one robot" in refused("lock", "arm.urdf", "slim.urdf.xacro", "--output", "x.urdf.lock")


def test_the_last_line_counts_all_that_was_asked(here: Path) -> None:
    """Of three locks one is the same, one moved, and one can't be read."""
    for name in ("arm", "same", "bad"):
        (here / f"{name}.urdf").write_text(urdfs.rotated())
        ok("lock", f"{name}.urdf")
    (here / "bad.urdf").unlink()
    assert run("lock", "--check").out.splitlines()[-1] == "2 of 3 mechanisms are those of their locks"
    move(here / "arm.urdf")
    done = run("lock", "--check")
    assert done.status == 1
    assert done.out.splitlines()[-1] == "1 of 3 mechanisms moved; if that is meant: pinscrew lock arm.urdf.lock"


def test_a_broken_lock_is_written_anew(here: Path) -> None:
    ok("lock", "arm.urdf")
    before = (here / "arm.urdf.lock").read_text()
    (here / "arm.urdf.lock").write_text(f"<<<<<<< HEAD\n{before}")
    assert "the marks of a merge conflict" in refused("lock", "arm.urdf.lock")
    ok("lock", "arm.urdf")
    assert (here / "arm.urdf.lock").read_text() == before


# ----------------------------------------------------------------------------------------------- checking


def test_what_the_check_says(here: Path) -> None:
    ok("lock", "arm.urdf", "slim.urdf.xacro")
    lines = ok("lock", "--check").out.splitlines()
    assert lines == [
        "arm.urdf.lock: the same",
        "slim.urdf.xacro.lock: the same",
        "2 of 2 mechanisms are those of their locks",
    ]
    move(here / "arm.urdf")
    done = run("lock", "--check")
    assert (done.status, done.err) == (1, "")
    lines = done.out.splitlines()
    assert lines[0] == "arm.urdf.lock: MOVED"
    assert lines[1].startswith("  ")
    assert "'j1'" in lines[1]
    assert "4 mm" in lines[1]
    assert lines[-2:] == [
        "slim.urdf.xacro.lock: the same",
        "1 of 2 mechanisms moved; if that is meant: pinscrew lock arm.urdf.lock",
    ]
    before = (here / "arm.urdf.lock").read_bytes()
    assert ok(*lines[-1].partition(": pinscrew ")[2].split()).out == "arm.urdf.lock: written\n"
    assert (here / "arm.urdf.lock").read_bytes() != before
    assert ok("lock", "--check", "arm.urdf").out.startswith("arm.urdf.lock: the same")


def test_the_check_by_file_and_by_lock(here: Path) -> None:
    ok("lock", "arm.urdf")
    for word in ("arm.urdf", "arm.urdf.lock", here / "arm.urdf"):
        assert "1 of 1 mechanisms" in ok("lock", "--check", word).out
    done = run("lock", "--check", "arm.urdf", "slim.urdf.xacro")
    assert (done.status, done.out.splitlines()[0]) == (2, "arm.urdf.lock: the same")
    assert done.err == (
        "pinscrew: slim.urdf.xacro.lock: there is no such lock; write it with pinscrew lock slim.urdf.xacro\n"
    )


def test_without_locks(here: Path) -> None:
    (here / "uv.lock").write_text("version = 1")
    assert refused("lock", "--check").startswith(".: there is no .urdf.lock and no .xacro.lock here or below")


def test_it_finds_its_own_locks_only(here: Path) -> None:
    """Other tools' locks, hidden folders, and xacro files that are no robots are passed by."""
    ok("lock", "arm.urdf")
    for name in ("uv.lock", "sub/Cargo.lock", ".hidden/arm.urdf.lock"):
        (here / name).parent.mkdir(exist_ok=True)
        (here / name).write_text("no lock of ours")
    (here / "macros.xacro").write_text(MACROS)
    (here / "macros.urdf.xacro").write_text(MACROS)
    assert "1 of 1 mechanisms" in ok("lock", "--check").out


def test_errors_do_not_hide_what_moved(here: Path) -> None:
    ok("lock", "arm.urdf", "slim.urdf.xacro")
    (here / "slim.urdf.xacro").write_text("<robot")
    move(here / "arm.urdf")
    done = run("lock", "--check")
    assert done.status == 1
    assert "arm.urdf.lock: MOVED" in done.out
    assert "slim.urdf.xacro:1: not well-formed XML" in done.err


@pytest.mark.parametrize(
    "words", [("--output", "x.urdf.lock"), ("--tip", "tool"), ("--floating-base",), ("l1:=0.5",)], ids=" ".join
)
@pytest.mark.usefixtures("here")
def test_the_check_takes_everything_from_the_lock(words: tuple[str, ...]) -> None:
    ok("lock", "slim.urdf.xacro")
    assert "from the locks" in refused("lock", "--check", "slim.urdf.xacro", *words)


def test_json(here: Path) -> None:
    ok("lock", "arm.urdf", "slim.urdf.xacro")
    move(here / "arm.urdf")
    (here / "slim.urdf.xacro").unlink()
    done = run("lock", "--check", "--json")
    document = json.loads(done.out)
    assert (done.status, document["schema"], document["ok"]) == (1, "pinscrew.lock-check/1", False)
    (row,) = document["locks"]
    assert (row["lock"], row["file"], row["same"], row["notes"]) == ("arm.urdf.lock", "arm.urdf", False, [])
    assert row["changes"][0]["joint"] == "j1"
    assert row["changes"][0]["length"] == pytest.approx(0.004)
    assert [error["code"] for error in document["errors"]] == ["lock-source"]


def test_reports(here: Path) -> None:
    ok("lock", "arm.urdf", "slim.urdf.xacro")
    move(here / "arm.urdf")
    done = run("lock", "--check", "--junit", "r.xml", "--markdown", "r.md", "--sarif", "r.sarif", "--github")
    assert done.status == 1
    assert ET.parse(here / "r.xml").getroot().get("failures") == "1"  # noqa: S314 (our own)
    assert "1 of 2 mechanisms" in (here / "r.md").read_text()
    (result,) = json.loads((here / "r.sarif").read_text())["runs"][0]["results"]
    assert (result["ruleId"], result["level"]) == ("moved", "error")
    assert "'j1'" in result["message"]["text"]
    assert "::error file=arm.urdf,line=1" in done.err
    assert "--check only" in refused("lock", "arm.urdf", "--junit", "r.xml")


# --------------------------------------------------------------------------------------- robots/ of pinscrew


def test_the_robots_of_this_project_are_locked() -> None:
    folder = catalogue.robots_directory()
    files = [entry.file for entry in catalogue.bundled()]
    assert sorted(folder.glob("*.lock")) == sorted(folder / f"{file.name}.lock" for file in files)
    assert f"{len(files)} of {len(files)} mechanisms" in ok("lock", "--check", *files).out


def test_the_check_loads_no_engine() -> None:
    code = """
import sys
from pinscrew.cli import command
try:
    command(["lock", "--check", sys.argv[1]])
except SystemExit as end:
    print(end.code, *{"pinocchio", "sympy", "meshcat", "numba"} & set(sys.modules))
"""
    lock = catalogue.robots_directory() / "drone.urdf.lock"
    done = subprocess.run([sys.executable, "-c", code, str(lock)], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "0"
