"""The command as a whole: list, completion, help, exit status, and what goes where."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import urdfs
from command_line import ok, process, refusal, refused, run
from pinscrew import __version__
from pinscrew.cli import _COMMANDS
from pinscrew.description.catalogue import bundled, example_robots
from pinscrew.ground.errors import MissingExtraError

NAMES = [entry.name for entry in bundled()]
FEW = ("--samples", "2")
SLOW = {"pinscrew verify", "pinscrew verify --all --samples 100"}
SHOWN = {"pinscrew show scara -q 45deg,pi/4,0.1", "pinscrew show two_joint --qd 1,0.5 --draw screws,circles"}
"""Examples that open a browser and wait for Ctrl-C; `tests/view` runs such."""
IN_GIT = {
    "pinscrew diff HEAD~1:arm.urdf arm.urdf",
    "pinscrew diff main:./arm.urdf.xacro arm.urdf.xacro --tolerance-mm 0.01",
}
"""Examples that need a git repository; `tests/changes` runs such."""
MEASURED = {
    "pinscrew identify scara -q 0.3,0.5,0.1 --matrix J.csv",
    "pinscrew identify scara --samples samples.npz --json",
    "pinscrew identify scara --home --matrix Slist.csv",
}
"""Examples that need somebody's numbers; `tests/identification` runs such."""


def loaded(text: str) -> Any:
    """JSON as the standard has it."""
    return json.loads(text, parse_constant=pytest.fail)


# ------------------------------------------------------------------------------------------------ list


def test_list() -> None:
    lines = ok("list").out.splitlines()
    assert lines[0].split() == ["robot", "also", "arguments", "what", "it", "is", "from"]
    assert [line.split()[0] for line in lines[1:]] == NAMES
    (scara,) = (line for line in lines if line.startswith("scara_rrp"))
    assert scara.split()[:7] == ["scara_rrp", "scara", "l1:=0.4", "l2:=0.3", "SCARA", "RRP", "arm"]
    assert scara.endswith("Robotics, assignment 2, questions 7 and 11")


def test_list_json() -> None:
    document = loaded(ok("list", "--json").out)
    assert document["schema"] == "pinscrew.list/1"
    assert [robot["name"] for robot in document["robots"]] == NAMES
    (scara,) = (robot for robot in document["robots"] if robot["name"] == "scara_rrp")
    assert (scara["aliases"], scara["arguments"]) == (["scara"], {"l1": "0.4", "l2": "0.3"})
    assert all(Path(robot["file"]).is_file() for robot in document["robots"])


def test_list_examples_without_them(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing() -> None:
        raise MissingExtraError("example-robot-data is not installed", "robots")

    monkeypatch.setattr("pinscrew.description.catalogue.example_robots", missing)
    error = refusal("list", "--examples")
    assert error.code == "missing-extra"
    assert 'pip install "pinscrew[robots]"' in error.remedy
    assert refusal("fk", "panda").code == "unknown-robot"


def has_examples() -> bool:
    try:
        return bool(example_robots())
    except MissingExtraError:
        return False


@pytest.mark.skipif(not has_examples(), reason="the extra robots is not installed")
def test_list_examples() -> None:
    document = loaded(ok("list", "--examples", "--json").out)
    names = [robot["name"] for robot in document["robots"]]
    assert names[: len(NAMES)] == NAMES
    assert len(set(names)) == len(names) > len(NAMES) + 50
    assert "panda" in names


def test_names_are_whole_on_narrow_terminals(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pinscrew.cli.output.UNSEEN_WIDTH", 80)
    lines = ok("list").out.splitlines()
    assert [line.split()[0] for line in lines if not line.startswith(" ")] == ["robot", *NAMES]
    assert max(map(len, lines)) <= 80


# ------------------------------------------------------------------------------------- help, completion


@pytest.mark.parametrize("command", [None, *_COMMANDS])
@pytest.mark.parametrize("flag", ["--help", "-h"])
def test_help_shows_an_example(command: str | None, flag: str) -> None:
    done = ok(*filter(None, [command, flag]))
    assert done.err == ""
    call = f"pinscrew {command or 'verify'}"
    examples = [line for line in done.out.splitlines() if line.startswith("    ") and call in line]
    assert examples
    assert all(len(line) <= 80 for line in done.out.splitlines())
    assert "..." not in done.out.partition("Commands:")[2], "each command's line is whole"


def test_examples_of_the_help_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every example line of every command, in a folder that has their file."""
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "path" / "to" / "arm.urdf"
    file.parent.mkdir(parents=True)
    file.write_text(urdfs.rotated())
    (tmp_path / "homework").mkdir()
    (tmp_path / "homework" / "one.md").write_text(r"$\xi_1 = (0, 0, 0, 0, 0, 1)$")
    (tmp_path / "answers.md").write_text(r"$\xi_1 = (0, 0, 0, 0, 0, 1)$")
    lines = [line.strip() for name in _COMMANDS for line in ok(name, "--help").out.splitlines()]
    lines += [line.strip() for line in ok("--help").out.splitlines()]
    examples = {line for line in lines if line.startswith("pinscrew ")} - SLOW - SHOWN - IN_GIT - MEASURED
    assert len(examples) >= 8
    for example in sorted(examples):
        alone = ["--jobs", "1"] if "--map" in example else []  # processes take seconds to start
        done = ok(*shlex.split(example)[1:], *alone)
        written = [
            tmp_path / word for word in example.split() if word.endswith((".html", ".tex", ".ipynb", ".urdf", ".md"))
        ]
        assert done.out or (written and all(path.stat().st_size for path in written)), example


@pytest.mark.parametrize(
    ("shell", "says"), [("bash", "complete -o nosort"), ("zsh", "#compdef pinscrew"), ("fish", "complete --no-files")]
)
def test_completion(shell: str, says: str) -> None:
    done = ok("completion", shell)
    assert says in done.out
    assert "_PINSCREW_COMPLETE" in done.out


def test_completion_in_a_shell() -> None:
    environment = {**os.environ, "_PINSCREW_COMPLETE": "bash_complete"}
    for words, index, found in (("pinscrew ver", 1, ["verify"]), ("pinscrew fk plan", 2, ["planar_2r", "planar_rrr"])):
        asked = {**environment, "COMP_WORDS": words, "COMP_CWORD": str(index)}
        code = "from pinscrew.cli import main; main()"
        done = subprocess.run([sys.executable, "-c", code], env=asked, capture_output=True, text=True, check=True)
        assert [line.split(",")[1] for line in done.stdout.splitlines()] == found


def test_version_and_usage() -> None:
    assert ok("--version").out == f"pinscrew, version {__version__}\n"
    assert "'nonsense'" in refused("nonsense")
    assert "bash" in refused("completion", "powershell")
    done = run()
    assert (done.status, done.out) == (2, "")
    assert "pinscrew verify" in done.err


# --------------------------------------------------------------------------------------- as a process


def test_process_agrees() -> None:
    done = process("verify", "drone", *FEW)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.splitlines()[-1].startswith("drone: PoE and Pinocchio agree")


def test_process_says_what_is_wrong_in_one_line() -> None:
    done = process("fk", "scar")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"pinscrew: {refusal('fk', 'scar')}\n"
    assert done.stderr.count("\n") == 1


def test_warnings_are_words_on_standard_error(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(urdfs.single_revolute().replace("0 1 0", "0 2 0"))
    done = process("fk", str(file), "--json")
    assert done.returncode == 0
    np.testing.assert_array_equal(loaded(done.stdout)["pose"][0], [1, 0, 0, 0.3])
    words = f"pinscrew: warning: {file}:1: joint 'j': the axis is 2 long and was normalised"
    assert words in done.stderr.splitlines()
    assert "Warning" not in done.stderr


@pytest.mark.parametrize("command", ["screws", "list"])
def test_any_encoding(command: str) -> None:
    words = [command] if command == "list" else [command, "drone"]
    assert process(*words, PYTHONIOENCODING="ascii").returncode == 0
    assert loaded(process(*words, "--json", PYTHONIOENCODING="ascii").stdout)["schema"]


def test_any_bytes(tmp_path: Path) -> None:
    report = tmp_path / "report.xml"
    command = [sys.executable, "-m", "pinscrew", "verify", b"\xff", "--json", "--junit", report]
    done = subprocess.run(command, capture_output=True, check=False)
    assert done.returncode == 2
    assert loaded(done.stdout.decode())["errors"][0]["code"] == "unknown-robot"
    assert b"Traceback" not in done.stderr
    assert ET.fromstring(report.read_bytes()).get("errors") == "1"  # noqa: S314 (our own)


def test_a_closed_pipe_is_no_error() -> None:
    script = f"{sys.executable} -m pinscrew list | head -n 1"
    done = subprocess.run(["sh", "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.startswith("robot")
    assert done.stderr == ""


def test_a_misspelt_command() -> None:
    assert "there is no command 'verfy'; did you mean 'verify'?" in refused("verfy")
    assert "No such command 'nonsense'" in refused("nonsense")
