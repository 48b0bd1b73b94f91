"""The reports that ``verify`` and ``lock --check`` write for CI."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest

import pinscrew as ps
import urdfs
from broken import Altered
from command_line import ok, refused, run
from pinscrew import lockfile
from pinscrew.description.catalogue import find
from pinscrew.engines.pinocchio import Pinocchio

FEW = ("--samples", "1")
ARM = urdfs.robot(
    urdfs.joint("j1", "revolute", "base", "link1", xyz="0 0 0.3"),
    urdfs.joint("j2", "revolute", "link1", "link2", xyz="0.4 0 0", axis="0 1 0"),
    urdfs.joint("j3", "prismatic", "link2", "link3", xyz="0.2 0 0"),
    links="base link1 link2 link3",
).replace("><", ">\n<")


@pytest.fixture(autouse=True)
def arm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file with an element a line, in the working directory."""
    monkeypatch.chdir(tmp_path)
    for name in ("GITHUB_WORKSPACE", "GITHUB_STEP_SUMMARY"):
        monkeypatch.delenv(name, raising=False)
    file = tmp_path / "arm.urdf"
    file.write_text(ARM)
    return Path("arm.urdf")


@pytest.fixture
def wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pinocchio then answers 1 mm off for ``link3`` and what is below it."""

    def alter(answers: Any, frames: Any, _: Any) -> None:
        if "link3" in frames:
            answers.poses[:, list(frames).index("link3"), 0, 3] += 1e-3

    monkeypatch.setattr("pinscrew.engines.pinocchio.Pinocchio", lambda robot: Altered(Pinocchio(robot), alter))


def line_of(text: str, part: str) -> int:
    return text[: text.index(part)].count("\n") + 1


def results(file: str) -> list[tuple[str, str, str, int | None, str]]:
    """Rule, level, path, line and message of each result."""
    (run_,) = json.loads(Path(file).read_text(encoding="utf-8"))["runs"]
    found = []
    for one in run_["results"]:
        place = one["locations"][0]["physicalLocation"]
        line = place.get("region", {}).get("startLine")
        found.append((one["ruleId"], one["level"], place["artifactLocation"]["uri"], line, one["message"]["text"]))
    return found


# ------------------------------------------------------------------------------------------------- verify


@pytest.mark.usefixtures("wrong")
def test_a_disagreement_is_told_at_its_joint() -> None:
    done = run("verify", "arm.urdf", *FEW, "--json", "--github", "--sarif", "out.sarif")
    assert done.status == 1
    assert json.loads(done.out)["ok"] is False, "standard output is JSON alone"
    found = results("out.sarif")
    rule, level, uri, line, message = found[0]
    assert {one[:4] for one in found} == {found[0][:4]}, "all are about one joint"
    assert (rule, level, uri, line) == ("disagreement", "error", "arm.urdf", line_of(ARM, 'joint name="j3"'))
    assert message.startswith("arm: joint 'j3': its origin is moved by [1, 0, 0] mm (1 mm) in Pinocchio")
    assert "(home poses: error 1.0e-03 above 1.0e-12, largest at frame link3" in message
    annotation = f"::error file=arm.urdf,line={line},title=pinscrew%3A disagreement::{message}"
    assert annotation in done.err.splitlines()


@pytest.mark.usefixtures("wrong")
def test_a_xacro_has_lines_of_its_source() -> None:
    file = Path("scara.urdf.xacro")
    file.write_bytes(find("scara").file.read_bytes())
    third = 1 + next(i for i, text in enumerate(file.read_text().splitlines()) if 'joint name="joint3"' in text)
    assert run("verify", file, *FEW, "--sarif", "out.sarif").status == 1
    _, _, uri, line, message = results("out.sarif")[0]
    assert (uri, line) == ("scara.urdf.xacro", third)
    assert "joint 'joint3'" in message


def test_errors_and_warnings_are_told_at_their_lines(arm: Path) -> None:
    long = ARM.replace('axis xyz="0 1 0"', 'axis xyz="0 2 0"')
    arm.write_text(long)
    Path("bad.urdf").write_text(ARM.replace('axis xyz="0 1 0"', 'axis xyz="0 0 0"'))
    done = run("verify", arm, "bad.urdf", "nowhere.urdf", "armm", *FEW, "--github", "--sarif", "out.sarif")
    assert done.status == 2
    line = line_of(ARM, 'joint name="j2"')
    assert [one[:4] for one in results("out.sarif")] == [
        ("axis-normalised", "warning", "arm.urdf", line),
        ("zero-axis", "error", "bad.urdf", line),
        ("no-file", "error", "nowhere.urdf", None),
    ]
    assert sum(one.startswith(("::error ", "::warning ")) for one in done.err.splitlines()) == 4


def test_the_summary_of_a_job_is_added_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    summary = tmp_path / "summary.md"
    summary.write_text("before\n")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(summary))
    ok("verify", "arm.urdf", *FEW, "--markdown", "out.md")
    assert summary.read_text() == "before\n", "only with --github"
    ok("verify", "arm.urdf", *FEW, "--github")
    ok("verify", "arm.urdf", *FEW, "--github")
    report = Path("out.md").read_text()
    assert summary.read_text() == f"before\n{report}\n{report}\n"
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path / "missing" / "summary.md"))
    done = run("verify", "arm.urdf", *FEW, "--github")
    assert (done.status, done.err.count("can't be written")) == (2, 1)


def test_agreement_says_nothing() -> None:
    assert ok("verify", "arm.urdf", *FEW, "--github", "--sarif", "out.sarif").err == ""
    assert results("out.sarif") == []


# --------------------------------------------------------------------------------------------------- lock


def test_a_move_is_told_at_its_joint(arm: Path) -> None:
    ok("lock", arm)
    reports = ("--github", "--sarif", "out.sarif", "--junit", "out.xml", "--markdown", "out.md")
    assert "::" not in ok("lock", "--check", *reports).err
    assert results("out.sarif") == []
    assert ET.parse("out.xml").getroot().get("failures") == "0"  # noqa: S314 (our own)
    arm.write_text(ARM.replace('xyz="0.4 0 0"', 'xyz="0.41 0 0"'))
    done = run("lock", "--check", *reports)
    assert done.status == 1
    line = line_of(ARM, 'joint name="j2"')
    first = results("out.sarif")[0]
    assert first[:4] == ("moved", "error", "arm.urdf", line)
    assert "10 mm" in first[4]
    assert f"::error file=arm.urdf,line={line},title=pinscrew%3A moved::{first[4]}" in done.err.splitlines()
    root = ET.parse("out.xml").getroot()  # noqa: S314 (our own)
    assert [suite.get("name") for suite in root] == ["arm.urdf.lock"]
    assert (root.get("failures"), root.get("errors")) == ("1", "0")
    assert Path("out.md").read_text().startswith("### pinscrew lock: 0 of 1 mechanisms are those of their locks\n")


def test_a_lock_that_cannot_be_checked_is_an_error(arm: Path) -> None:
    ok("lock", arm)
    arm.unlink()
    assert run("lock", "--check", "--sarif", "out.sarif", "--junit", "out.xml").status == 2
    assert [one[:3] for one in results("out.sarif")] == [("lock-source", "error", "arm.urdf.lock")]
    root = ET.parse("out.xml").getroot()  # noqa: S314 (our own)
    assert (root.get("failures"), root.get("errors")) == ("0", "1")


@pytest.mark.parametrize("option", [("--sarif", "x"), ("--junit", "x"), ("--markdown", "x"), ("--github",)])
def test_writing_a_lock_reports_nothing(arm: Path, option: tuple[str, ...]) -> None:
    assert refused("lock", arm, *option) == "there is something to report with --check only"
    assert not Path("arm.urdf.lock").exists()


# --------------------------------------------------------------------------------------------------- diff

EVERY = ("--github", "--sarif", "out.sarif", "--junit", "out.xml", "--markdown", "out.md")


def test_a_change_is_told_at_its_joint(arm: Path) -> None:
    """``diff`` reports as ``lock --check`` does: errors for changes, notes for the rest, at b's lines."""
    Path("before.urdf").write_text(ARM)
    assert "::" not in ok("diff", "before.urdf", arm, *EVERY).err
    assert results("out.sarif") == []
    root = ET.parse("out.xml").getroot()  # noqa: S314 (our own)
    assert [(suite.get("name"), suite.get("failures")) for suite in root] == [("before.urdf → arm.urdf", "0")]
    arm.write_text(ARM.replace('xyz="0.4 0 0"', 'xyz="0.41 0 0"').replace('velocity="1"', 'velocity="2"', 1))
    done = run("diff", "before.urdf", arm, "--json", *EVERY)
    assert done.status == 1
    assert json.loads(done.out)["schema"] == "pinscrew.diff/1", "standard output is JSON alone"
    lines = {part: line_of(ARM, f'joint name="{part}"') for part in ("j1", "j2")}
    moved, kept = results("out.sarif")
    assert moved[:4] == ("motion-changed", "error", "arm.urdf", lines["j2"])
    assert kept[:4] == ("motion-kept", "note", "arm.urdf", lines["j1"])
    annotation = f"::error file=arm.urdf,line={lines['j2']},title=pinscrew%3A motion-changed::{moved[4]}"
    assert annotation in done.err.splitlines()
    assert "::notice file=arm.urdf" in done.err
    root = ET.parse("out.xml").getroot()  # noqa: S314 (our own)
    assert (root.get("name"), root.get("tests"), root.get("failures")) == ("pinscrew diff", "1", "1")
    (failure,) = root.iter("failure")
    assert failure.get("type") == "motion-changed"
    assert Path("out.md").read_text().startswith("### before.urdf → arm.urdf: 1 change, 1 note\n")


def test_a_diff_that_cannot_be_made_is_an_error(arm: Path) -> None:
    done = run("diff", arm, "nowhere.urdf", *EVERY)
    assert (done.status, done.out) == (2, "")
    assert [one[:3] for one in results("out.sarif")] == [("no-file", "error", "nowhere.urdf")]
    root = ET.parse("out.xml").getroot()  # noqa: S314 (our own)
    assert (root.get("failures"), root.get("errors")) == ("0", "1")
    assert "could not be compared" in Path("out.md").read_text()
    assert "::error file=nowhere.urdf" in done.err


# ----------------------------------------------------------------------------------------- every format


def test_every_answer_is_a_document_that_every_format_takes(arm: Path) -> None:
    """A report, changes and a lock's check have the same methods, and no format knows which of them it writes."""
    robot = ps.load(arm)
    ok("lock", arm)
    arm.write_text(ARM.replace('xyz="0.4 0 0"', 'xyz="0.41 0 0"'))
    moved = ps.load(arm)
    answers = ps.verify(moved, 1), ps.diff(robot, moved), lockfile.check("arm.urdf.lock")
    for answer, schema in zip(answers, ("verify/1", "diff/1", "lock-check/1"), strict=True):
        document = answer.document()
        assert json.loads(answer.to_json())["schema"] == f"pinscrew.{schema}" == document.data["schema"]
        assert ET.fromstring(answer.to_junit().encode()).get("name") == document.task  # noqa: S314 (our own)
        (sarif,) = json.loads(answer.to_sarif())["runs"]
        assert len(sarif["results"]) == len(document.findings) == answer.to_annotations().count("\n")
        assert answer.to_markdown().startswith("### ")
        assert str(answer).startswith(document.accounts[0].heading)
        assert document.ok == (answer is answers[0])
