"""Hostile names in a browser: pages that a name could make run something, and does not."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from command_line import ok
from hostile import NAMES
from test_hostile import arm


@pytest.fixture(scope="module")
def names() -> list[str]:
    return [name for name in NAMES.values() if name.strip() and len(name) <= 400]


def test_the_trap_would_snap(open_page: Callable[..., Any], tmp_path: Path) -> None:
    """Without escapes the names do what these tests look for."""
    file = tmp_path / "page.html"
    file.write_text(f'<html data-ready="true"><title>a</title><p>{NAMES["tag"]}</p>')
    assert open_page(file.as_uri()).title() == "1337"


def test_the_viewer(open_page: Callable[..., Any], names: list[str], tmp_path: Path) -> None:
    """The page of an arm that has them all is ready, has run none, asked for nothing, and shows the names."""
    (tmp_path / "arm.urdf").write_text(arm(names))
    ok("show", tmp_path / "arm.urdf", "--html", tmp_path / "page.html")
    page = open_page((tmp_path / "page.html").as_uri())
    assert page.title() == "arm · pinscrew"
    assert page.asked == [(tmp_path / "page.html").as_uri()]
    assert [said for said in page.said if "Content Security" in said] == []
    shown = page.evaluate("document.documentElement.textContent")
    assert [name for name in names if name not in shown] == []


@pytest.mark.parametrize("title", ["tag", "script in a formula", "end of a script", "end of a title"])
def test_the_name_of_a_robot(open_page: Callable[..., Any], title: str, tmp_path: Path) -> None:
    """It is in the page's title, which is that of the file."""
    file = tmp_path / f"{NAMES[title].replace('/', '')}.urdf"
    file.write_text(arm(["a"]))
    ok("show", file, "--html", tmp_path / "page.html")
    assert open_page((tmp_path / "page.html").as_uri()).title() == f"{file.stem} · pinscrew"


def test_a_derivation(open_page: Callable[..., Any], tmp_path: Path) -> None:
    (tmp_path / "arm.urdf").write_text(arm([NAMES["script in a formula"], NAMES["tag"]]))
    ok("derive", tmp_path / "arm.urdf", "--format", "html", "-o", tmp_path / "page.html", "--samples", "2")
    text = (tmp_path / "page.html").read_text().replace("<html ", '<html data-ready="true" ')
    (tmp_path / "page.html").write_text(text)
    page = open_page((tmp_path / "page.html").as_uri())
    assert page.title() != "1337"
    assert NAMES["tag"] in page.evaluate("document.body.textContent")
