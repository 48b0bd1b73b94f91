"""``pinscrew verify``: outcomes, exit status, the files it writes, many robots and narrow terminals."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest

import urdfs
from broken import Altered
from command_line import ok, process, refused, run
from pinscrew.description.catalogue import Entry, bundled, find
from pinscrew.engines.pinocchio import Pinocchio

NAMES = [entry.name for entry in bundled()]
FEW = ("--samples", "2")
ARM = find("drone").file

WRONG = pytest.mark.usefixtures("wrong")


@pytest.fixture
def wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pinocchio then answers 1 mm off for robots with a frame ``link3``."""

    def alter(answers: Any, frames: Any, _: Any) -> None:
        if "link3" in frames:
            answers.poses[:, list(frames).index("link3"), 0, 3] += 1e-3

    def engine(robot: Any) -> Any:
        return Altered(Pinocchio(robot), alter)

    monkeypatch.setattr("pinscrew.Pinocchio", engine)  # first, while what it gets from the other is the real one
    monkeypatch.setattr("pinscrew.engines.pinocchio.Pinocchio", engine)


def loaded(text: str) -> Any:
    """JSON as the standard has it."""
    return json.loads(text, parse_constant=pytest.fail)


# ---------------------------------------------------------------------------------------------- verify


def test_verify_all() -> None:
    done = ok("verify", "--samples", "0")
    lines = done.out.splitlines()
    assert done.err == ""
    assert lines[0].split() == ["robot", "engines", "largest", "error", "frames", "configurations"]
    assert [line.split()[:2] for line in lines[1:-1]] == [[name, "agree"] for name in NAMES]
    assert lines[-1] == "12 of 12 robots: both engines agree to rounding error on every frame"


def test_verify_one() -> None:
    done = ok("verify", "drone", *FEW)
    lines = done.out.splitlines()
    assert lines[0].split() == ["check", "error", "tolerance", "largest", "at"]
    assert all(" ok" in line for line in lines[1:-1])
    assert lines[-1] == "drone: PoE and Pinocchio agree on 5 frames at 23 configurations (seed 0)"
    assert done.err == ""


def test_verify_options() -> None:
    done = ok("verify", "drone", "--samples=4", "--seed=9", "--frame", "tool", "--frame", "link1", "--json")
    (robot,) = loaded(done.out)["robots"]
    assert (robot["samples"], robot["seed"], robot["frames"], robot["configurations"]) == (4, 9, 2, 25)
    lines = ok("verify", "drone", "2r", "--frame", "tool", *FEW).out.splitlines()
    assert lines[-1] == "2 of 2 robots: both engines agree to rounding error on every compared frame"


@WRONG
def test_verify_disagrees() -> None:
    done = run("verify", "drone", "scara", *FEW)
    assert done.status == 1
    lines = done.out.splitlines()
    assert [line.split()[:2] for line in lines[1:3]] == [["drone", "agree"], ["scara_rrp", "DISAGREE"]]
    assert lines[3] == "scara_rrp: PoE and Pinocchio DISAGREE on 5 frames at 23 configurations (seed 0)"
    assert lines[4].startswith("home poses: error 1.0e-03 above 1.0e-12, largest at frame link3")
    expected = "joint 'joint3': its origin is moved by [1, 0, 0] mm (1 mm) in Pinocchio, compared with PoE"
    assert expected in lines
    assert lines[-1] == "1 of 2 robots: both engines agree to rounding error on every frame"
    assert done.err == ""


@WRONG
def test_verify_disagrees_on_one() -> None:
    done = run("verify", "scara", *FEW)
    assert done.status == 1
    assert sum("FAIL" in line for line in done.out.splitlines()) == 3
    assert "DISAGREE" in done.out.splitlines()[-1]


def test_verify_could_not_run() -> None:
    done = run("verify", "nowhere.urdf", "drone", "scara", "l9:=1", *FEW)
    assert done.status == 2
    assert done.out.splitlines()[-1].startswith("1 of 3 robots: ")
    first, second = done.err.splitlines()
    assert first == "pinscrew: nowhere.urdf: there is no such file"
    assert "declares no argument 'l9'" in second


@WRONG
def test_disagreement_outranks_an_error() -> None:
    assert run("verify", "nowhere.urdf", "scara", *FEW).status == 1


@WRONG
def test_verify_json_is_alone_on_standard_output() -> None:
    done = run("verify", "scara", "l1:=0.5", "drone", "nowhere.urdf", *FEW, "--json")
    document = loaded(done.out)
    assert done.status == 1
    assert document["schema"] == "pinscrew.verify/1"
    assert document["ok"] is False
    assert [(robot["robot"], robot["ok"]) for robot in document["robots"]] == [("scara_rrp", False), ("drone", True)]
    assert document["robots"][0]["arguments"] == {"l1": "0.5"}
    assert [(error["robot"], error["code"]) for error in document["errors"]] == [("nowhere.urdf", "no-file")]
    assert done.err == "pinscrew: nowhere.urdf: there is no such file\n"


@WRONG
def test_verify_writes_files(tmp_path: Path) -> None:
    junit, markdown = tmp_path / "report.xml", tmp_path / "report.md"
    junit.write_text("old")
    done = run("verify", "scara", "drone", "nowhere.urdf", *FEW, "--junit", junit, "--markdown", markdown)
    assert done.status == 1
    root = ET.fromstring(junit.read_bytes())  # noqa: S314 (our own)
    assert [suite.get("name") for suite in root] == ["scara_rrp", "drone", "nowhere.urdf"]
    assert (root.get("failures"), root.get("errors")) == ("3", "1")
    headings = [line for line in markdown.read_text(encoding="utf-8").splitlines() if line.startswith("### ")]
    assert len(headings) == 3
    assert sorted(tmp_path.iterdir()) == [markdown, junit], "nothing else is left"


def test_writing_fails_halfway(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    report = tmp_path / "report.xml"
    report.write_text("old")

    def full(*_: Path) -> Path:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    done = run("verify", "drone", *FEW, "--junit", report)
    assert (done.status, done.err) == (2, f"pinscrew: {report}: can't be written (No space left on device)\n")
    assert report.read_text() == "old"
    assert list(tmp_path.iterdir()) == [report]


def test_links_and_devices_are_written_to(tmp_path: Path) -> None:
    """A link stays one, and a device is not replaced by a file."""
    target, link = tmp_path / "target.md", tmp_path / "link.md"
    target.write_text("old")
    link.symlink_to(target)
    ok("verify", "drone", *FEW, "--markdown", link, "--junit", os.devnull)
    assert link.is_symlink()
    assert target.read_text(encoding="utf-8").startswith("### drone")
    assert Path(os.devnull).is_char_device()


@pytest.mark.parametrize("option", ["--samples", "--seed"])
@pytest.mark.parametrize("value", ["-1", "x", "1.5"])
def test_verify_numbers(option: str, value: str) -> None:
    assert refused("verify", "drone", option, value).startswith(f"Invalid value for '{option}'")


def test_verify_frame_that_is_not_there() -> None:
    assert "no frame 'hand'; known are: base" in refused("verify", "drone", "--frame", "hand")


# ------------------------------------------------------------------------------------------ many robots


def test_all(monkeypatch: pytest.MonkeyPatch) -> None:
    examples = (Entry("first", ARM), Entry("second", ARM))
    monkeypatch.setattr("pinscrew.description.catalogue.example_robots", lambda: examples)
    monkeypatch.setattr("pinscrew.description.catalogue.bundled", lambda: ())
    lines = ok("verify", "--all", "--samples", "0").out.splitlines()
    assert lines[-1].startswith("2 of 2 robots: ")
    assert refused("verify", "--all", "drone") == "--all takes no ROBOT"


def test_jobs(tmp_path: Path) -> None:
    """Several processes say the same as one: results, errors and remarks, in the order of the robots."""
    file = tmp_path / "arm.urdf"
    file.write_text(urdfs.single_revolute().replace("0 1 0", "0 2 0"))
    words = ["verify", "drone", str(file), "nowhere.urdf", "scar", "2r", *FEW]
    one, several = (process(*words, "--jobs", jobs) for jobs in ("1", "3"))
    assert one.returncode == 2
    assert [line.split()[0] for line in one.stdout.splitlines()[1:4]] == ["drone", "arm", "planar_2r"]
    assert [line.split(": ")[1] for line in one.stderr.splitlines()] == [
        "warning", "nowhere.urdf", "there is no robot or file 'scar'; known are"
    ]  # fmt: skip
    assert (several.returncode, several.stdout, several.stderr) == (one.returncode, one.stdout, one.stderr)


# ------------------------------------------------------------------------------------- narrow terminals


@pytest.mark.parametrize("width", [120, 80, 40, 20])
def test_narrow_terminals_hide_nothing(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A check's verdict stays in its row; what has no room stands below it."""
    monkeypatch.setattr("pinscrew.cli.output.UNSEEN_WIDTH", width)
    *table, summary = ok("verify", "drone", *FEW).out.splitlines()
    assert "agree" in summary
    assert max(map(len, table)) <= width
    rows = [line for line in table if not line.startswith(" ")]
    assert sum("ok" in line.split() for line in rows) == 16
    words = " ".join(" ".join(table).split())
    assert words.count("frame ") == 13  # all but the structure, home poses and screws, which are exact
    assert len(re.findall(r"\d\.\de[+-]\d\d", words)) == 32


@WRONG
def test_failures_on_narrow_terminals(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pinscrew.cli.output.UNSEEN_WIDTH", 80)
    lines = run("verify", "scara", *FEW).out.splitlines()
    assert sum(line.endswith(" FAIL") for line in lines) == 3
    place = lines.index(next(line for line in lines if line.startswith("home poses")))
    assert lines[place + 1] == "  largest at: frame link3, joint joint3, zero"
