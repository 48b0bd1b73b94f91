"""The pages of the documentation: each is found, each name is listed, and what the first one shows happens.

`scripts/site` builds the site, in CI; it fails on links that lead nowhere.
"""

from __future__ import annotations

import os
import re
import runpy
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import pinscrew as ps
from command_line import run

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def test_every_page_is_in_the_index() -> None:
    """Name a new page in a toctree of docs/index.md."""
    trees = re.findall(r"^```\{toctree\}\n(.*?)^```", (DOCS / "index.md").read_text(encoding="utf-8"), re.M | re.S)
    listed = [line for tree in trees for line in tree.splitlines() if line and not line.startswith(":")]
    assert sorted(listed) == sorted(path.stem for path in DOCS.glob("*.md") if path.stem != "index")


def test_every_public_name_is_in_the_reference() -> None:
    text = (DOCS / "reference.md").read_text(encoding="utf-8")
    named = re.findall(r"^\.\. auto(?:class|function):: pinscrew\.(\w+)$", text, re.MULTILINE)
    assert sorted(named) == sorted(set(ps.__all__) - {"__version__", "lie"})
    assert re.findall(r"^\.\. automodule:: pinscrew\.lie\.(\w+)$", text, re.MULTILINE) == ["so3", "se3"]
    assert {"so3", "se3"} == set(ps.lie.__all__)


def test_the_page_of_commands_is_up_to_date() -> None:
    """As `python scripts/commands_page.py` writes it."""
    sys.path.insert(0, str(ROOT / "scripts"))
    try:
        script = runpy.run_path(str(ROOT / "scripts" / "commands_page.py"))
    finally:
        sys.path.remove(str(ROOT / "scripts"))
    assert script["page"]() == (DOCS / "commands.md").read_text(encoding="utf-8")


def test_the_first_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its commands succeed and its Python runs, in order; what it shows is among what they print."""
    monkeypatch.chdir(tmp_path)
    printed = ""
    for language, body in BLOCK.findall((DOCS / "start.md").read_text(encoding="utf-8")):
        if language == "xml":
            Path("arm.urdf").write_text(body, encoding="utf-8")
        elif language == "python":
            paths = os.pathsep.join([str(ROOT / "src"), os.environ.get("PYTHONPATH", "")])
            command = [sys.executable, "-W", "error", "-c", body]
            done = subprocess.run(command, capture_output=True, text=True, env=dict(os.environ, PYTHONPATH=paths))
            assert done.returncode == 0, done.stderr
            printed = done.stdout
        elif language == "console":
            printed = ""
            for line in body.splitlines():
                if line.startswith("$ pinscrew"):
                    ran = run(*shlex.split(line)[2:])
                    assert ran.status == (1 if "diff" in line else 0), ran.err
                    printed += ran.out
        else:
            assert language == "text"
            for line in body.splitlines():
                assert line in printed
    assert {path.name for path in tmp_path.iterdir()} == {"arm.urdf", "moved.urdf", "arm.urdf.lock", "arm.html"}
