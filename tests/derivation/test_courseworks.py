"""Every command of docs/courseworks.md answers."""

import re
import shlex
from pathlib import Path

import pytest
from test_derive_cli import run

from command_line import ok

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "courseworks.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"`pinscrew derive (.*?)` \|", PAGE)
OTHERS = re.findall(r"`pinscrew (?!derive )(.*?)` \|", PAGE)


@pytest.mark.parametrize("command", COMMANDS)
def test_the_command_answers(command: str) -> None:
    options = () if "--errata" in command else ("--samples", "2")
    done = run(*command.split(), *options)
    assert done.exit_code == 0, done.output
    assert r"\begin{bmatrix}" in done.stdout or "--errata" in command
    assert "disagree" not in done.output.lower()


def test_every_row_is_run() -> None:
    rows = [line for line in PAGE.splitlines() if line.startswith("| ") and "the question" not in line]
    assert len(COMMANDS) + len(OTHERS) == len(rows) >= 25


@pytest.mark.parametrize("command", OTHERS)
def test_another_command_answers(command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Status 0 says that both engines agree, or that the answer is right."""
    monkeypatch.chdir(tmp_path)
    done = ok(*shlex.split(command))
    assert done.out or list(tmp_path.iterdir())
