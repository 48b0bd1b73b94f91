"""A repository of robots as users have it: the example, copied and known to git."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "robot_repository"


@pytest.fixture
def repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The example as a git repository of its own, which is the working directory; ``pinscrew`` is on the path."""
    programs = tmp_path / "programs"
    programs.mkdir()
    program = programs / "pinscrew"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m pinscrew "$@"\n')
    program.chmod(0o755)
    for name in [name for name in os.environ if name.startswith(("GIT_", "GITHUB_"))]:
        monkeypatch.delenv(name)
    monkeypatch.setenv("PATH", f"{programs}{os.pathsep}{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
    folder = tmp_path / "repository"
    shutil.copytree(EXAMPLE, folder, ignore=shutil.ignore_patterns("__pycache__", ".pytest_cache"))
    monkeypatch.chdir(folder)
    for command in (["git", "init", "-q"], ["git", "add", "."]):
        subprocess.run(command, check=True)
    return folder


def edit(file: Path, old: str, new: str) -> None:
    """Replace the only place of a text in a file."""
    text = file.read_text(encoding="utf-8")
    assert text.count(old) == 1
    file.write_text(text.replace(old, new), encoding="utf-8")


@pytest.fixture
def broken(repository: Path) -> Path:
    """The repository with a joint of the cart broken, and one of the arm moved by 10 mm."""
    edit(repository / "robots" / "cart.urdf", '<axis xyz="1 0 0"/>', '<axis xyz="0 0 0"/>')
    edit(repository / "robots" / "arm.urdf.xacro", 'xyz="0 0 0.2"', 'xyz="0 0.01 0.2"')
    subprocess.run(["git", "add", "."], check=True)
    return repository
