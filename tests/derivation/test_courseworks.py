"""Every command of docs/courseworks.md answers, and the quantities that it names can be checked."""

from __future__ import annotations

import importlib.util
import re
import shlex
import sys
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import pinscrew as ps
from command_line import ok
from pinscrew.checking.quantities import quantity_key, right_form

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


def script() -> Any:
    sys.path.insert(0, str(SCRIPTS))
    try:
        spec = importlib.util.spec_from_file_location("courseworks_page", SCRIPTS / "courseworks_page.py")
        assert spec
        assert spec.loader
        module = importlib.util.module_from_spec(spec)
        sys.modules[spec.name] = module
        spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(SCRIPTS))
    return module


TABLE = script()
COMMANDS = list(dict.fromkeys(row.command for row in TABLE.ROWS if row.command))
derived = cache(lambda name: ps.derive(ps.load(name)))


def test_the_page_is_up_to_date(monkeypatch: pytest.MonkeyPatch) -> None:
    assert TABLE.PAGE.read_text(encoding="utf-8") == TABLE.page()
    monkeypatch.setattr(sys, "argv", ["courseworks_page.py", "--check"])
    assert TABLE.write_or_check(TABLE.PAGE, TABLE.page()) == 0
    assert TABLE.write_or_check(TABLE.PAGE, TABLE.page() + "more") == 1


def test_all_five_courseworks_to_the_last_part() -> None:
    assert len(TABLE.ROWS) >= 69
    assert {row.part for row in TABLE.MEDICAL_4} >= set("abcdefghijk")
    assert set("abcdef") <= {letter for row in TABLE.MEDICAL_3 for letter in row.part.split(", ")}
    assert {row.part for row in TABLE.ROBOTICS_2} >= {f"Q{i}" for i in (1, 2, 5, 7, 8, 9, 10, 11, 13)} | {"bonus"}
    robots = {entry.coursework.split(",")[0] for entry in ps.description.catalogue.bundled()}
    assert len(TABLE.COURSEWORKS) == 5
    assert robots <= {"Medical robotics", "Robotics", "Velocity kinematics assignment", "Velocities lecture"}
    assert not [row.question for row in TABLE.ROWS if not row.command]


def test_the_table_of_the_readme_is_of_these() -> None:
    """They are run with the others."""
    readme = (SCRIPTS.parent / "README.md").read_text(encoding="utf-8")
    shown = re.findall(r"^\| .* \| `pinscrew (.*)` \|$", readme, re.MULTILINE)
    assert len(shown) >= 8
    assert set(shown) <= set(COMMANDS)


@pytest.mark.parametrize("command", COMMANDS[::4])
def test_the_command_answers(command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    answers(command, tmp_path, monkeypatch)


@pytest.mark.slow
@pytest.mark.parametrize("command", [command for i, command in enumerate(COMMANDS) if i % 4])
def test_every_command_answers(command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    answers(command, tmp_path, monkeypatch)


def answers(command: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Status 0 says that both engines agree, or that the answer is right."""
    monkeypatch.chdir(folder)
    words = shlex.split(command)
    proved = words[0] == "derive" and "--errata" not in words and "--identity" not in words
    done = ok(*words, *(("--samples", "2") if proved else ()))
    assert done.out or list(folder.iterdir())
    assert "disagree" not in done.out.lower()
    if proved:
        assert "was read back" in done.out
        for part in re.findall(r"--part (\S+)", command):
            assert done.out.count("\n## (") == len(part.split(","))


@pytest.mark.parametrize("row", [row for row in TABLE.ROWS if row.quantities], ids=lambda row: row.question)
def test_the_quantities_can_be_checked(row: Any) -> None:
    d = derived(row.robot)
    for name in row.quantities:
        assert right_form(d, quantity_key(name, len(d.chain.joints))).size


def test_an_answer_is_found_right_or_wrong() -> None:
    right = (
        "[[-(L3 + theta3)*c2*dtheta1], [dtheta3], [-(L3 + theta3)*dtheta2], [-dtheta2], [-s2*dtheta1], [c2*dtheta1]]"
    )
    assert ps.check("spherical", "Vb", right).right
    assert not ps.check("spherical", "Vb", right.replace("-s2", "s2")).right
