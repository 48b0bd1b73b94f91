"""What the README says works as it says it: its Python runs, its commands end with status 0."""

import re
import runpy
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from command_line import run

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
DOCUMENTS = [ROOT / "README.md", ROOT / "robots" / "README.md"]

BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def blocks(path: Path, language: str) -> list[str]:
    return [body for tag, body in BLOCK.findall(path.read_text(encoding="utf-8")) if tag == language]


COMMANDS = [
    line.removeprefix("$ ")
    for path in DOCUMENTS
    for body in blocks(path, "console")
    for line in body.splitlines()
    if line.startswith("$ pinscrew")
]


def test_the_two_commands_are_those_of_ci() -> None:
    first, second = blocks(ROOT / "README.md", "console")[0].splitlines()
    assert first == '$ python -m pip install -e ".[all]" && pinscrew verify'
    assert second == '$ python -m pip install -e ".[all,test]" && python -m pytest'
    ci = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    steps = [line.removeprefix("step ").replace("--quiet ", "") for line in ci.splitlines() if line.startswith("step ")]
    for command in (*first.removeprefix("$ ").split(" && "), *second.removeprefix("$ ").split(" && ")):
        assert command in steps


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_python_runs(path: Path, tmp_path: Path) -> None:
    code = "\n".join(blocks(path, "python"))
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    if path.parent == ROOT:
        assert 0.0 <= float(done.stdout) < 1e-15  # the one number it prints: the engines' difference


@pytest.mark.parametrize("command", COMMANDS)
def test_commands_succeed(command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    done = run(*shlex.split(command)[1:])
    assert done.status == 0, done.err
    assert done.out or "--html" in command


def test_a_command_succeeds_as_a_process(tmp_path: Path) -> None:
    """Once as a shell runs it; `test_commands_succeed` runs them all in this process."""
    done = subprocess.run([sys.executable, "-m", *COMMANDS[0].split()], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout or "--html" in COMMANDS[0]


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda path: path.name)
def test_examples_run(path: Path, tmp_path: Path) -> None:
    done = subprocess.run([sys.executable, "-W", "error", path], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_links_lead_somewhere() -> None:
    for path in DOCUMENTS:
        for target in re.findall(r"\]\(([^)#]+)\)", path.read_text(encoding="utf-8")):
            assert target.startswith("https://") or (path.parent / target).exists(), f"{path}: {target}"


def test_the_table_of_robots_is_up_to_date(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Run here; scripts/check runs it as a process."""
    script = runpy.run_path(str(ROOT / "scripts" / "robots_table.py"))
    monkeypatch.setattr(sys, "argv", ["robots_table.py", "--check"])
    assert script["main"]() == 0, capsys.readouterr().err
