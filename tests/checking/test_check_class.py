"""The answers of a class: a row for each file, whatever is in it; and pages with the wrong entries marked."""

from __future__ import annotations

import csv
import io
import json
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

import pinscrew as ps
from command_line import run
from hostile import NAMES
from pinscrew.checking import submissions
from pinscrew.checking.submissions import Submission, check_folder, submissions_csv
from pinscrew.cli import arguments
from pinscrew.cli.check import option_words

SCARA = ps.load("scara")
EMPTY: dict[str, list[str]] = {"entries": [], "unread": [], "slips": [], "follows": []}
RIGHT = {"quantity": "Js", "right": True, **EMPTY}
WRONG = {"quantity": "T", "right": False, **EMPTY, "entries": [[2, 4]], "slips": ["the sign of entry (2, 4)"]}
UNREAD = {"quantity": "p", "right": None, **EMPTY, "unread": [{"entry": [1, 1], "reason": "a\nb"}]}


def rows(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text)))


def test_table() -> None:
    found = (
        Submission("=a.md", (RIGHT, WRONG, UNREAD), ("M",)),
        Submission("b,c.md", error='it takes "long"'),
        Submission("d.md", (WRONG | {"entries": [[i, 1] for i in range(1, 9)], "slips": []}, RIGHT, WRONG)),
    )
    first, second, third = rows(submissions_csv(found))
    assert (first["file"], first["right"], first["wrong"], first["not read"]) == ("'=a.md", "1", "1", "1")
    assert (first["Js"], first["T"]) == ("right", "wrong (2, 4): the sign of entry (2, 4)")
    assert (first["p"], first["M"]) == ("not read: a b", "blank")
    assert (second["file"], second["error"], second["Js"]) == ("b,c.md", 'it takes "long"', "")
    assert third["T"].startswith("wrong (1, 1) (2, 1) (3, 1) (4, 1) (5, 1) (6, 1) …; wrong (2, 4)")
    carried = Submission("e.md", (WRONG | {"follows": ["xi2"]},))
    assert carried.cell("T") == "wrong (2, 4): follows from xi2"
    assert str(found[0]) == "=a.md: 1 right, 1 wrong, 1 not read"
    assert str(found[1]) == 'b,c.md: it takes "long"'


def test_what_a_child_says() -> None:
    assert submissions._read("a", b'{"answers": [], "blank": ["M"]}', b"") == Submission("a", (), ("M",))
    assert submissions._read("a", b"", b"pinscrew: x\npinscrew: no such file\n").error == "no such file"
    assert submissions._read("a", b"[]", b"").error == "its process ended without an answer"
    assert submissions._read("a", b"{}", b"\x1b[1mred\xff\n").error == "red�"


@pytest.mark.slow
def test_class(tmp_path: Path) -> None:
    (tmp_path / "anna").mkdir()
    (tmp_path / ".hidden").mkdir()
    (tmp_path / ".hidden" / "a.md").write_text("")
    (tmp_path / "anna" / "a.md").write_text(r"$$\xi_1 = (0, 0, 0, 0, 0, 1)$$ $$p = (1, l_1 s_1 + l_2 s_{12}, -q_3)$$")
    (tmp_path / "deep.md").write_text("$$ p = " + "(" * 100_000 + "$$")
    (tmp_path / "power.py").write_text("p = [9**9**9, l1*s1 + l2*s12, -q3]")
    (tmp_path / "macro.tex").write_text(r"\def\x{\x\x} \[ p = (\x, l_1 s_1 + l_2 s_{12}, -q_3) \]")
    (tmp_path / "code.py").write_text("import os\nos.system('touch here')\nxi1 = [0, 0, 0, 0, 0, open('here', 'w')]")
    (tmp_path / "zip.docx").write_bytes(b"PK")
    (tmp_path / "bytes.md").write_bytes(b"\xff\xfe\x00")
    (tmp_path / "link.md").symlink_to("/dev/zero")
    target = tmp_path.parent / "grades.csv"
    done = run("check", "scara", "l1:=0.5", tmp_path, "--csv", target, "--jobs", "2")
    assert done.status == 1, done
    found = {row["file"]: row for row in rows(target.read_text(encoding="utf-8"))}
    assert len(done.out.splitlines()) == len(found) == 8
    assert (found["anna/a.md"]["xi1"], found["anna/a.md"]["right"], found["anna/a.md"]["wrong"]) == ("right", "1", "1")
    for name in ("deep.md", "power.py", "macro.tex"):
        assert found[name]["p"].startswith("not read"), found[name]
    assert found["code.py"]["xi1"].startswith("not read")
    for name in ("zip.docx", "bytes.md", "link.md"):
        assert found[name]["error"]
    assert not (tmp_path / "here").exists()
    (tmp_path / "anna" / "a.md").unlink()
    files = json.loads(run("check", "scara", tmp_path, "--json").out)["files"]
    assert (files[0]["file"], files[0]["error"] is None) == ("bytes.md", False)


@pytest.mark.slow
def test_what_takes_long_is_given_up(tmp_path: Path) -> None:
    (tmp_path / "a.md").write_text("")
    (found,) = check_folder(["scara"], tmp_path, seconds=0.05)
    assert found.error == "it takes more than 0.05 s"


def test_a_folder_that_is_none(tmp_path: Path) -> None:
    assert check_folder(["scara"], tmp_path) == ()
    assert run("check", "scara", tmp_path).status == 2
    for words in (["--csv", "a.csv"], ["--jobs", "2"]):
        assert run("check", "scara", *words, "--quantity", "p", "--text", "[1]").status == 2


@pytest.mark.parametrize("name", list(NAMES.values())[::10], ids=list(NAMES)[::10])
def test_page(name: str) -> None:
    """What an answer has in it is text in HTML, whatever it is; the wrong entries, and no others, are marked."""
    verdict = ps.check(SCARA, "p", [name, "l1*s1 + l2*s12", "q3"])
    page = verdict.to_html()
    assert page.count('title="wrong"') == len(verdict.entries)
    assert page.count('title="not read"') == len(verdict.unread)
    body = ET.fromstring(verdict._repr_html_().replace("<br>", "<br/>"))  # noqa: S314 (our own)
    cells = [cell.text or "" for cell in body.iter("td")]
    assert len(cells) == 3
    assert cells[1] == "l1*s1 + l2*s12"
    assert {cell.tag for cell in body.iter()} <= {"div", "p", "strong", "table", "tr", "td", "br", "small", "ul", "li"}


def test_format(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text('{"p": ["1", "0", "0"], "M": [1]}')
    page = run("check", "scara", tmp_path / "a.json", "--format", "html")
    assert page.status == 1
    assert page.out.startswith("<!DOCTYPE html>")
    assert page.out.count('title="wrong"') == 3
    assert "M has 4 rows" in page.out
    assert "### p of scara\\_rrp: wrong" in run("check", "scara", tmp_path / "a.json", "--format", "markdown").out
    assert ps.check_file(SCARA, tmp_path / "a.json")._repr_html_() in page.out


def test_options_are_handed_on() -> None:
    seen: list[list[str]] = []
    import click

    @click.command()
    @arguments.robot_argument()
    def command(words: tuple[str, ...]) -> None:
        seen.append([*option_words(), *words])

    given = ["--package", "a:=/b", "--strict", "--allow-outside", "scara", "l1:=2"]
    command(given, standalone_mode=False)
    command(["scara"], standalone_mode=False)
    assert seen == [["--package", "a:=/b", "--allow-outside", "--strict", "scara", "l1:=2"], ["scara"]]
