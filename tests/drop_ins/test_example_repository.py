"""The example of a repository: its own commands, and the jobs of its CI, pass; and they fail on what is broken."""

from __future__ import annotations

import itertools
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from command_line import run
from pinscrew.reporting import RULES

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples" / "robot_repository"


def commands() -> list[str]:
    """What the example's README says to type."""
    return re.findall(r"^\$ (.*)$", (EXAMPLE / "README.md").read_text(encoding="utf-8"), re.MULTILINE)


@pytest.mark.usefixtures("repository")
def test_its_commands() -> None:
    tests, *others = commands()
    assert [command.split()[:2] for command in others] == [["pinscrew", "verify"], ["pinscrew", "lock"]]
    for command in others:
        done = run(*command.split()[1:])
        assert done.status == 0, done.err
    words = [sys.executable, "-m", *tests.split(), "-q", "-p", "no:cacheprovider", "-p", "no:hypothesispytest"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    assert re.search(r"^\d+ passed", done.stdout, re.MULTILINE)


@pytest.mark.usefixtures("broken")
def test_its_commands_see_what_is_broken() -> None:
    _, verify, lock = commands()
    assert run(*verify.split()[1:]).status == 2
    done = run(*lock.split()[1:])
    assert done.status == 1
    assert "robots/arm.urdf.xacro.lock: MOVED" in done.out
    assert "10 mm" in done.out


def test_its_jobs_on_gitlab(repository: Path) -> None:
    """The lines of both scripts, and the reports that GitLab is told of."""
    jobs = yaml.safe_load((repository / ".gitlab-ci.yml").read_text(encoding="utf-8"))
    artifacts = jobs[".pinscrew"]["artifacts"]
    files = [repository / file for file in artifacts["paths"]]
    assert repository / artifacts["reports"]["junit"] in files
    for name in ("verify", "lock"):
        assert jobs[name]["extends"] == ".pinscrew"
        (line,) = jobs[name]["script"]
        assert run(*line.split()[1:]).status == 0
        for file in files:
            assert file.stat().st_size
            file.unlink()


def test_its_locks_are_as_they_would_be_written(repository: Path) -> None:
    command = "lock robots/cart.urdf robots/arm.urdf.xacro"
    assert f"`pinscrew {command}`" in (repository / "README.md").read_text(encoding="utf-8")
    done = run(*command.split())
    assert done.out.splitlines() == ["robots/cart.urdf.lock: unchanged", "robots/arm.urdf.xacro.lock: unchanged"]


# --------------------------------------------------------------------------------------------- docs/ci.md

PAGE = (ROOT / "docs" / "ci.md").read_text(encoding="utf-8")


def table(heading: str) -> list[str]:
    """The first cells of the table under a row of headings."""
    below = PAGE.partition(f"| {heading} |")[2].splitlines()[2:]
    cells = [line.split("|")[1].strip() for line in itertools.takewhile(lambda line: line.startswith("|"), below)]
    return [cell.strip("`") for cell in cells]


def test_the_page_shows_what_the_example_has() -> None:
    blocks = re.findall(r"^```yaml\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
    files = [EXAMPLE / ".pre-commit-config.yaml", EXAMPLE / ".gitlab-ci.yml", *EXAMPLE.glob(".github/workflows/*")]
    texts = [file.read_text(encoding="utf-8") for file in files]
    assert len(blocks) == 4
    assert [sum(block in text for text in texts) for block in blocks] == [1] * 4
    assert re.findall(r"^\$ (pinscrew .*)$", PAGE, re.MULTILINE)[1:] == commands()[1:]


def test_the_page_lists_what_there_is() -> None:
    action = yaml.safe_load((ROOT / "action.yml").read_text(encoding="utf-8"))
    assert table("input") == list(action["inputs"])
    hooks = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8"))
    assert table("hook") == [hook["id"] for hook in hooks]
    assert table("rule") == [*RULES, "a [code](errors.md)"]
    options = [option.split()[0] for option in table("option")]
    for command in ("verify", "lock"):
        shown = run(command, "--help").out
        assert all(option in shown for option in options)
