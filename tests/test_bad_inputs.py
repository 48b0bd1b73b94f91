"""No input hurts: every bad, hostile or odd file ends in one error, or loads with the warnings that are documented.

Each file of `bad_inputs` and `bad_xacros` is given to the command line in a child process that may take 10 s and
1 GB (see `limited`), and to `pinscrew.load`, whose error must carry its parts as attributes.
"""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import pytest

import bad_inputs
import bad_xacros
import limited
import pinscrew as ps
from bad_inputs import Case
from pinscrew.description import expand
from pinscrew.ground import errors
from pinscrew.ground.errors import DescriptionError, PinscrewError, PinscrewWarning

REFUSED = [*bad_inputs.REFUSED, *bad_xacros.REFUSED]


LIMITS: Final = [case for case in REFUSED if case.seconds or callable(case.content) or case.code == "xacro-limit"]
"""Files that would take all the time or memory that they get."""
ONE_EACH: Final = list({case.code: case for case in reversed(REFUSED) if case not in LIMITS}.values())
"""One file for each code."""


@pytest.fixture(scope="module")
def server() -> Iterator[limited.Server]:
    with limited.Server() as started:
        yield started


def name_of(case: Case) -> str:
    return case.name


def write(case: Case, folder: Path) -> Path:
    """The case's file in a folder of its own below ``folder``, with the files it comes with."""
    file = folder / "robot" / f"case{case.suffix}"
    file.parent.mkdir()
    file.write_bytes(case.data())
    for name, content in case.files.items():
        path = file.parent / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, str) and content.startswith("-> "):
            path.symlink_to(content.removeprefix("-> "))
        else:
            path.write_bytes(bad_inputs.data(content))
    return file


def options(arguments: Sequence[str]) -> dict[str, Any]:
    """What `pinscrew.load` takes for these words of the command line."""
    words = list(arguments)
    if words and words[0] == "--package":
        name, _, root = words[1].partition(":=")
        return {"packages": {name: root}}
    return {"arguments": dict(word.split(":=") for word in words)}


def raised(file: Path, arguments: Sequence[str]) -> PinscrewError:
    """The error of loading and verifying a file."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PinscrewWarning)
        try:
            ps.verify(ps.load(file, **options(arguments)), samples=2)
        except PinscrewError as error:
            return error
    pytest.fail("nothing was raised")


def test_there_are_many() -> None:
    assert len(bad_inputs.REFUSED) >= 150
    assert len(bad_xacros.REFUSED) >= 150
    names = [case.name for case in (*REFUSED, *bad_inputs.ACCEPTED)]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("case", [case for case in REFUSED if case not in LIMITS], ids=name_of)
def test_one_error(case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In this process, where the error's parts can be seen."""
    file = write(case, tmp_path)
    monkeypatch.chdir(file.parent)
    error = raised(file, case.arguments)
    assert (type(error), error.code) == (getattr(errors, case.error), case.code)
    message = str(error)
    assert [word for word in case.words if word not in message] == []
    assert len(message) < 3000
    assert message.isprintable()
    if isinstance(error, DescriptionError):
        assert Path(error.file).suffix in (".urdf", ".xacro", ".yaml")
        assert error.file in message
        assert case.line is None or error.line == case.line
        assert case.element is None or error.element == case.element


def in_a_child(case: Case, server: limited.Server, folder: Path) -> None:
    """As a command under its limits, whose report has the error's parts."""
    file = write(case, folder)
    words = ("verify", file, *case.arguments, "--samples", 2, "--json")
    result = server.run(*words, expansion=case.seconds, folder=file.parent)
    said = json.loads(result.stdout)
    message = limited.one_error(replace(result, stdout=""), case.words)
    assert len(message) < 3000
    assert message.isprintable()
    (error,) = said["errors"]
    assert (error["code"], error["message"]) == (case.code, message)
    assert case.line is None or f":{case.line}: " in message


LIKE_OTHERS: Final = {
    "21 MB",
    "five million elements",
    "${str([[0]*10**5]*10**5)}",
    "${xacro.tokenize('aaaaaaaaaaaaaaaaaaaaaaaa}",
    "catastrophic parameters",
    "xacro of 240 000 elements",
    "YAML of 10 MB",
}
"""Files that run into a limit as another does in every run; each takes a second and more."""


@pytest.mark.parametrize(
    "case",
    [pytest.param(case, marks=pytest.mark.slow if case.name in LIKE_OTHERS else ()) for case in LIMITS],
    ids=name_of,
)
def test_limits(case: Case, server: limited.Server, tmp_path: Path) -> None:
    in_a_child(case, server, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("case", [case for case in REFUSED if case not in LIMITS], ids=name_of)
def test_one_error_of_a_child(case: Case, server: limited.Server, tmp_path: Path) -> None:
    in_a_child(case, server, tmp_path)


# ------------------------------------------------------------------------------------------------ every command

COMMANDS: Final[dict[str, tuple[str, ...]]] = {
    "derive": (),
    "diff": ("{file}",),
    "fk": (),
    "jacobian": ("--kind", "body"),
    "lock": (),
    "screws": (),
    "show": ("--html", "page.html"),
    "track": ("--profile", "profile.csv"),
    "verify": ("--samples", "2"),
    "workspace": ("--samples", "5"),
}
"""The commands that read a robot, with what follows the robot."""


def any_command(command: str, case: Case, server: limited.Server, folder: Path) -> None:
    """One line, status 2, within the limits, and nothing written, whichever command gets the file.

    What Pinocchio does not take, a command that does not ask it may.
    """
    file = write(case, folder)
    (file.parent / "profile.csv").write_text("t,j\n0,0\n0.1,1\n")
    before = sorted(file.parent.rglob("*"))
    words = [word.format(file=file) for word in COMMANDS[command]]
    arguments = () if command == "diff" and ":=" in "".join(case.arguments) else case.arguments
    result = server.run(command, file, *arguments, *words, expansion=case.seconds, folder=file.parent)
    limited.within_limits(result)
    pinocchio = case.code.startswith("pinocchio")
    if result.status == 0 and (pinocchio or arguments != case.arguments):
        return
    message = limited.one_error(result, () if pinocchio or arguments != case.arguments else case.words)
    assert len(message) < 3000
    assert message.isprintable()
    assert sorted(file.parent.rglob("*")) == before


def sample() -> list[tuple[str, Case]]:
    """Each command with some of the files, so that all the codes are seen."""
    commands = list(COMMANDS)
    return [(commands[i % len(commands)], case) for i, case in enumerate(ONE_EACH)]


@pytest.mark.parametrize(("command", "case"), sample(), ids=lambda each: each if isinstance(each, str) else each.name)
def test_one_error_of_any_command(command: str, case: Case, server: limited.Server, tmp_path: Path) -> None:
    any_command(command, case, server, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("case", REFUSED, ids=name_of)
def test_one_error_of_every_command(command: str, case: Case, server: limited.Server, tmp_path: Path) -> None:
    any_command(command, case, server, tmp_path)


@pytest.mark.parametrize("case", bad_inputs.ACCEPTED, ids=name_of)
def test_odd_but_right(case: Case, server: limited.Server, tmp_path: Path) -> None:
    file = write(case, tmp_path)
    result = server.run("verify", file, "--samples", 2)
    limited.within_limits(result)
    assert result.status == 0, result
    assert "agree" in result.stdout
    lines = result.stderr.splitlines()
    assert len(lines) == bool(case.code)
    for line in lines:
        assert line.startswith(f"pinscrew: warning: {file}:")
        assert all(word in line for word in case.words)

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        robot = ps.load(file)
    assert len(robot.frame_names) == case.links
    assert [warning.message.code for warning in caught] == [case.code] * bool(case.code)  # type: ignore[union-attr]


@pytest.mark.parametrize("case", bad_inputs.PLAIN, ids=name_of)
def test_pinocchio_is_not_asked_for_what_is_no_kinematics(case: Case, tmp_path: Path) -> None:
    """It refuses these, takes links and joints alone, and agrees."""
    robot = ps.load(write(case, tmp_path))
    with pytest.warns(PinscrewWarning) as caught:
        report = ps.verify(robot, samples=2)
    assert report.ok
    assert [w.message.code for w in caught if isinstance(w.message, PinscrewWarning)] == [case.code]
    assert all(word in str(caught[0].message) for word in case.words)


@pytest.mark.parametrize("name", bad_inputs.NAMES.values(), ids=bad_inputs.NAMES)
def test_names_are_text(name: str, server: limited.Server, tmp_path: Path) -> None:
    """A name is shown as it is, whatever it holds, and reaches no terminal, mark-up or format as more than text."""
    file = tmp_path / "r.urdf"
    file.write_text(bad_inputs.child_named(name), encoding="utf-8")
    robot = ps.load(file)
    assert robot.joint_names == (robot.tip,)
    result = server.run("fk", file, "--json")
    assert result.status == 0
    assert len(result.stderr.splitlines()) == 0
    assert json.loads(result.stdout)["frame"] == robot.tip


@pytest.mark.parametrize("option", [(), ("--tip", "x"), ("-q", "x=1")], ids=str)
def test_messages_stay_in_their_line(option: tuple[str, ...], server: limited.Server, tmp_path: Path) -> None:
    """The leaves, frames and joints that a message lists, and the file that it names, may hold anything."""
    names = ("b&#10;c", "d\u009b31m", "e\u202ef", "g" * 90_000)
    joints = [
        bad_inputs.joint(name=name, ends=f'<parent link="a"/><child link="{name}"/>') + f'<link name="{name}"/>'
        for name in names
    ]
    file = tmp_path / "line\nbreak\x1b[31m.urdf"
    file.write_text(bad_inputs.robot("".join(joints), '<link name="a"/>'), encoding="utf-8")
    message = limited.one_error(server.run("fk", file, *option), [])
    assert message.isprintable()
    assert len(message) < 3000


def test_a_real_process() -> None:
    """Once as users run it, to show that the server's forks are the same."""
    command = [sys.executable, "-m", "pinscrew", "verify", os.devnull + ".urdf", "--samples", "2"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"pinscrew: {os.devnull}.urdf: there is no such file\n"


# ------------------------------------------------------------------------------------------------ kinds of files


@pytest.mark.parametrize("suffix", [".urdf", ".xacro"])
def test_files_that_are_none(suffix: str, server: limited.Server, tmp_path: Path) -> None:
    folder, pipe, loop, missing = (tmp_path / f"{name}{suffix}" for name in ("folder", "pipe", "loop", "missing"))
    folder.mkdir()
    os.mkfifo(pipe)
    loop.symlink_to(loop.name)
    (tmp_path / "file").write_text("")
    for path, code in (
        (folder, "unreadable"),
        (pipe, "unreadable"),
        (loop, "unreadable"),
        (missing, "no-file"),
        (tmp_path / "file" / f"x{suffix}", "unreadable"),
        (tmp_path / f"{'x' * 300}{suffix}", "unreadable"),
        (tmp_path / f"{'x/' * 3000}x{suffix}", "unreadable"),
    ):
        message = limited.one_error(server.run("verify", path), [])
        shown = str(path) if len(str(path)) <= 400 else f"{str(path)[:200]} … {str(path)[-200:]}"
        assert message.startswith(f"{shown}: ")
        error = raised(path, [])
        assert (type(error), error.code, error.file) == (DescriptionError, code, str(path))


def test_sockets_and_devices(server: limited.Server, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # a socket's path must be short
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind("x.urdf")
        assert "no plain file" in limited.one_error(server.run("verify", "x.urdf", folder=tmp_path), [])
    (tmp_path / "zero.urdf").symlink_to("/dev/zero")
    assert "no plain file" in limited.one_error(server.run("verify", tmp_path / "zero.urdf"), [])


def test_names_that_are_no_files(server: limited.Server) -> None:
    for name in ("", ".", "/", "nosuch", "x" * 5000, "../" * 2000, "a\nb", "http://127.0.0.1:9/robot"):
        assert "robot or file" in limited.one_error(server.run("verify", name), [])
    assert "a.urdf" in limited.one_error(server.run("verify", "http://127.0.0.1:9/a.urdf"), ["no such file"])
    for path in ("a\0b.urdf", "a\0b", Path("a\0b")):
        assert raised(path, []).code in ("unreadable", "unknown-robot")  # type: ignore[arg-type]


def test_a_file_without_the_right_to_read_it(server: limited.Server, tmp_path: Path) -> None:
    file = tmp_path / "locked.urdf"
    file.write_text(bad_inputs.plain())
    file.chmod(0)
    message = limited.one_error(server.run("verify", file, unprivileged=True), ["Permission denied"])
    assert message.startswith(f"{file}: can't be read")
    hidden = tmp_path / "hidden"
    hidden.mkdir(0o700)
    (hidden / "robot").write_text(bad_inputs.plain())
    limited.one_error(server.run("verify", hidden / "robot", unprivileged=True), ["robot or file"])


# ------------------------------------------------------------------------------------------------------- limits


@pytest.mark.slow
def test_an_endless_expansion_is_ended_in_time(server: limited.Server, tmp_path: Path) -> None:
    """The limits of an expansion as they are, where the cases above have shorter ones."""
    case = next(case for case in REFUSED if case.name == "3¹⁵ expansions")
    result = server.run("verify", write(case, tmp_path))
    limited.one_error(result, [f"{expand.SECONDS} s"])
    assert result.seconds >= expand.SECONDS


def test_no_process_is_left(server: limited.Server, tmp_path: Path) -> None:
    case = next(case for case in REFUSED if case.name == "3¹⁵ expansions")
    file = write(case, tmp_path)
    server.run("verify", file, expansion=1)
    for process in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            assert str(file) not in process.read_text(errors="replace")
        except OSError:
            continue


def test_many_files_at_once(server: limited.Server, tmp_path: Path) -> None:
    """A bad file among good ones is told of, and the others are verified."""
    good, bad = tmp_path / "good.urdf", tmp_path / "bad.urdf"
    good.write_text(bad_inputs.plain())
    bad.write_text("<robot>")
    result = server.run("verify", good, bad, good, "--samples", 2)
    assert result.status == 2
    assert result.stderr.splitlines() == [f"pinscrew: {bad}:2: not well-formed XML (no element found)"] or (
        result.stderr.startswith(f"pinscrew: {bad}:1: not well-formed XML") and result.stderr.count("\n") == 1
    )
    assert result.stdout.count("agree") >= 2
