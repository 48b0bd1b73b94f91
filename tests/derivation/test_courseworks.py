"""Every command of docs/courseworks.md answers."""

import re
from pathlib import Path

import pytest
from test_derive_cli import run

PAGE = Path(__file__).resolve().parents[2] / "docs" / "courseworks.md"
COMMANDS = re.findall(r"`pinscrew derive (.*?)` \|", PAGE.read_text(encoding="utf-8"))


@pytest.mark.parametrize("command", COMMANDS)
def test_the_command_answers(command: str) -> None:
    options = () if "--errata" in command else ("--samples", "2")
    done = run(*command.split(), *options)
    assert done.exit_code == 0, done.output
    assert r"\begin{bmatrix}" in done.stdout or "--errata" in command
    assert "disagree" not in done.output.lower()
