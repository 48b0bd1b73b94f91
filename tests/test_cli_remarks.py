"""Remarks about a file: all of them where it was named, the first of them in the list of all robots."""

from __future__ import annotations

from pathlib import Path

import pytest

import urdfs
from command_line import ok
from pinscrew.description.catalogue import Entry

TWO_REMARKS = urdfs.robot(
    urdfs.joint("j", "revolute", "base", "a", axis="0 0 2"),
    urdfs.joint("k", "revolute", "a", "tool", axis="0 0 2"),
    links="base a tool",
)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "two.urdf"
    path.write_text(TWO_REMARKS, encoding="utf-8")
    return path


def remarks(err: str) -> list[str]:
    return [line for line in err.splitlines() if line.startswith("pinscrew: warning: ")]


def test_a_named_file_has_all_its_remarks(file: Path) -> None:
    said = remarks(ok("verify", file, "--samples", "0").err)
    assert [joint for line in said for joint in "jk" if f"joint '{joint}'" in line] == ["j", "k"]
    assert not any("more remarks" in line for line in said)


def test_among_all_robots_the_first_stands_for_the_rest(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pinscrew.description.catalogue.example_robots", lambda: (Entry("two", file),))
    monkeypatch.setattr("pinscrew.description.catalogue.bundled", lambda: ())
    (line,) = remarks(ok("verify", "--all", "--samples", "0").err)
    assert "joint 'j'" in line
    assert line.endswith("(and 1 more remarks on this file)")
