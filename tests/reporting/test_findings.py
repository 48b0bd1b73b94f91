"""Findings in each format: valid, complete, and safe with any name and path."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any
from urllib.parse import unquote_to_bytes, urlsplit
from xml.etree import ElementTree as ET

import jsonschema
import pytest

from pinscrew.ground.errors import DescriptionError, EngineError, PinscrewWarning, UnknownNameError, XacroError
from pinscrew.reporting import (
    Account,
    Document,
    Finding,
    cases_of,
    from_error,
    from_warning,
    to_annotations,
    to_junit,
    to_markdown,
    to_sarif,
)
from pinscrew.reporting.findings import help_text

SCHEMA = Path(__file__).resolve().parents[1] / "data" / "sarif-2.1.0-rtm.5.json"
VALIDATOR = jsonschema.Draft4Validator(
    json.loads(SCHEMA.read_text(encoding="utf-8")), format_checker=jsonschema.Draft4Validator.FORMAT_CHECKER
)
ODD = [
    "a b.urdf",
    "ä/ω 機.urdf",
    "100%.urdf",
    "a:b,c.urdf",
    "a#b?c.urdf",
    "a|b`c*.urdf",
    "a&<b>\"'.urdf",
    "sub/[x].urdf",
]

FOUND = [
    Finding("disagreement", "error", "joint 'j': its axis is flipped", "arm.urdf", 7, "arm"),
    Finding("axis-normalised", "warning", "the axis is 2 long", "arm.urdf", 9, "arm"),
    Finding("placed-anew", "note", "link 'tool' is placed anew", "arm.urdf"),
    Finding("unknown-robot", "error", "there is no robot 'am'", "", robot="am"),
]


def document(*findings: Finding) -> Document:
    return Document("pinscrew verify", findings=findings, overview="all of it")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working directory of each test; none of them is in a job of GitHub's."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GITHUB_WORKSPACE", raising=False)
    return tmp_path


# ------------------------------------------------------------------------------------------------- SARIF


def sarif(*findings: Finding) -> Any:
    """The one run of a log, which must be valid."""
    log = json.loads(to_sarif(document(*findings)), parse_constant=pytest.fail)
    VALIDATOR.validate(log)
    (run,) = log["runs"]
    return run


def location(run: Any) -> dict[str, str]:
    (result,) = run["results"]
    found: dict[str, str] = result["locations"][0]["physicalLocation"]["artifactLocation"]
    return found


def test_the_schema_refuses_what_is_no_sarif() -> None:
    log = json.loads(to_sarif(document(*FOUND)))
    assert VALIDATOR.is_valid(log)
    log["runs"][0]["results"][0]["level"] = "fatal"
    assert not VALIDATOR.is_valid(log)
    log = json.loads(to_sarif(document(*FOUND)))
    log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["region"]["startLine"] = 0
    assert not VALIDATOR.is_valid(log)


def test_sarif() -> None:
    run = sarif(*FOUND)
    driver = run["tool"]["driver"]
    assert (driver["name"], driver["version"]) == ("pinscrew", "0.1.0")
    assert run["automationDetails"]["id"] == "pinscrew verify/"
    assert [rule["id"] for rule in driver["rules"]] == [finding.rule for finding in FOUND]
    assert all(rule["help"]["text"].endswith(".") for rule in driver["rules"])
    for finding, result in zip(FOUND, run["results"], strict=False):
        assert driver["rules"][result["ruleIndex"]]["id"] == result["ruleId"] == finding.rule
        assert (result["level"], result["message"]["text"]) == (finding.level, finding.text)
        place = result["locations"][0]["physicalLocation"]
        assert place["artifactLocation"] == {"uri": "arm.urdf", "uriBaseId": "%SRCROOT%"}
        assert place.get("region") == (None if finding.line is None else {"startLine": finding.line})


def test_sarif_of_no_file_is_a_notification() -> None:
    """GitHub refuses results without a location."""
    run = sarif(FOUND[-1])
    assert run["results"] == []
    (invocation,) = run["invocations"]
    (notification,) = invocation["toolExecutionNotifications"]
    assert invocation["executionSuccessful"] is False
    assert notification["message"]["text"] == "am: there is no robot 'am'"
    assert sarif(*FOUND[:3])["invocations"] == [{"executionSuccessful": True, "toolExecutionNotifications": []}]


@pytest.mark.parametrize("name", ODD)
def test_sarif_paths_are_uris(name: str, folder: Path) -> None:
    """A relative URI below the working directory, however the file is written; elsewhere an absolute one."""
    for file in (name, f"./{name}", f"x/../{name}", str(folder / name)):
        found = location(sarif(Finding("no-file", "error", "x", file)))
        assert found["uriBaseId"] == "%SRCROOT%"
        assert re.fullmatch(r"(?:[A-Za-z0-9._~/-]|%[0-9A-F]{2})+", found["uri"])
        assert urlsplit(found["uri"]).path == found["uri"], "no scheme, query or fragment"
        assert unquote_to_bytes(found["uri"]).decode() == name
    outside = location(sarif(Finding("no-file", "error", "x", f"../{name}")))
    assert "uriBaseId" not in outside
    parts = urlsplit(outside["uri"])
    assert (parts.scheme, unquote_to_bytes(parts.path).decode()) == ("file", str(folder.parent / name))


def test_sarif_of_bytes_that_are_no_text() -> None:
    assert location(sarif(Finding("no-file", "error", "\udcff", "\udcff.urdf")))["uri"] == "%FF.urdf"


def test_paths_start_at_the_top_of_a_checkout(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A GitHub job that works in a folder of its checkout tells of files from the checkout's top."""
    (folder / "sub").mkdir()
    monkeypatch.chdir(folder / "sub")
    finding = Finding("no-file", "error", "x", "arm.urdf")
    assert location(sarif(finding))["uri"] == "arm.urdf"
    monkeypatch.setenv("GITHUB_WORKSPACE", str(folder))
    assert location(sarif(finding))["uri"] == "sub/arm.urdf"
    assert to_annotations(document(finding)).startswith("::error file=sub/arm.urdf,")
    monkeypatch.setenv("GITHUB_WORKSPACE", "/nowhere")
    assert location(sarif(finding))["uri"] == "arm.urdf"


def test_links_keep_their_names(folder: Path) -> None:
    """A link in a checkout is what is told about, not what it leads to."""
    (folder / "arm.urdf").symlink_to("/dev/null")
    assert location(sarif(Finding("no-file", "error", "x", "arm.urdf")))["uri"] == "arm.urdf"


def test_every_rule_is_explained() -> None:
    assert help_text("no-mesh").count(".") == 2, "an error and a warning share the code"
    with pytest.raises(KeyError):
        help_text("nonsense")


def test_names_of_robots_are_cut() -> None:
    assert Finding("moved", "error", "it moved", "", robot="a\n" * 1000).text.startswith("a a a")
    assert len(Finding("moved", "error", "it moved", "", robot="a" * 5000).text) < 500


# ------------------------------------------------------------------------------------------ annotations


def parsed(line: str) -> tuple[str, dict[str, str], str]:
    """A workflow command as GitHub's runner reads it: name, properties, message."""
    match = re.fullmatch(r"::(\w+) (.*?)::(.*)", line)
    assert match is not None
    back = {"%0D": "\r", "%0A": "\n", "%3A": ":", "%2C": ","}

    def text(written: str, codes: dict[str, str]) -> str:
        for code, mark in codes.items():
            written = written.replace(code, mark)
        return written.replace("%25", "%")

    pairs = (one.partition("=") for one in match[2].split(","))
    return match[1], {name: text(value, back) for name, _, value in pairs}, text(match[3], dict(list(back.items())[:2]))


def test_annotations() -> None:
    assert to_annotations(document(*FOUND)).splitlines() == [
        "::error file=arm.urdf,line=7,title=pinscrew%3A disagreement::arm: joint 'j': its axis is flipped",
        "::warning file=arm.urdf,line=9,title=pinscrew%3A axis-normalised::arm: the axis is 2 long",
        "::notice file=arm.urdf,title=pinscrew%3A placed-anew::link 'tool' is placed anew",
        "::error title=pinscrew%3A unknown-robot::am: there is no robot 'am'",
    ]


@pytest.mark.parametrize("name", [*ODD, "a::b", "a\n::error::b", "a%0Ab", "a\r\nb,title=c"])
def test_annotations_of_any_name(name: str) -> None:
    """Nothing in a name or message ends a property, the message or the command."""
    written = to_annotations(document(Finding("no-file", "error", name, name, 3)))
    assert written.count("\n") == 1
    command, properties, message = parsed(written.removesuffix("\n"))
    assert (command, message) == ("error", name)
    assert properties == {"file": name, "line": "3", "title": "pinscrew: no-file"}


# --------------------------------------------------------------------------------------- JUnit, Markdown


def test_junit() -> None:
    found = {"arm": FOUND[:3], "good": [], "am": FOUND[3:], "b.urdf": [Finding("moved", "error", "it moved", "b", 2)]}
    accounts = tuple(Account(name, name, cases=cases_of(findings)) for name, findings in found.items())
    text = to_junit(Document("pinscrew lock", accounts=accounts))
    root = ET.fromstring(text.encode())  # noqa: S314 (our own)
    assert [suite.get("name") for suite in root] == ["arm", "good", "am", "b.urdf"]
    assert [root.get(name) for name in ("tests", "failures", "errors")] == ["4", "2", "1"]
    arm, good, am, b = root
    (failure,) = arm.findall("testcase/failure")
    assert failure.get("message") == "joint 'j': its axis is flipped"
    assert failure.text == "arm.urdf:7: joint 'j': its axis is flipped"
    assert [(case.get("name"), len(case)) for case in good] == [("pinscrew lock", 0)]
    assert am.find("testcase/error") is not None
    assert b.find("testcase/failure") is not None


@pytest.mark.parametrize("name", ODD)
def test_markdown_keeps_its_columns(name: str) -> None:
    assert to_markdown(document()) == "### all of it\n"
    written = to_markdown(document(Finding("no-file", "error", f"{name}\n{name}", name, 3, name), *FOUND))
    lines = written.splitlines()[2:]
    assert len(lines) == 2 + 1 + len(FOUND)
    rows = [re.split(r"(?<!\\)\|", line) for line in lines]
    assert {len(row) for row in rows} == {7}
    plain = re.sub(r"\\(.)", r"\1", rows[2][3]).strip()
    assert plain == f"{name}:3"


# --------------------------------------------------------------------------------- errors and warnings


def test_errors_as_findings(folder: Path) -> None:
    error = DescriptionError("zero-axis", "is zero", file="a.urdf", line=3, element="joint 'j'", remedy="give one")
    assert from_error(error, "a.urdf") == Finding(
        "zero-axis", "error", "joint 'j': is zero; give one", "a.urdf", 3, "a.urdf"
    )
    (folder / "b.urdf").touch()
    refused = EngineError("pinocchio-refuses", "no", where="b.urdf")
    assert from_error(refused, "b.urdf") == Finding("pinocchio-refuses", "error", "no", "b.urdf", None, "b.urdf")
    for name in ("b" * 5000, "b\0", "", "."):
        assert from_error(refused, name).file == "", "no file has such a name"
    unknown = UnknownNameError("unknown-frame", "frame", "tol", ("tool",), where="arm")
    assert from_error(unknown).message == "arm: there is no frame 'tol'; known are: tool"
    assert from_error(DescriptionError("not-xml", "a\x1b[31m\nb" + "x" * 5000, file="c")).message.startswith("a b")
    assert len(from_error(DescriptionError("not-xml", "x" * 5000, file="c")).message) < 1300


def test_lines_are_those_of_the_file_that_has_them() -> None:
    error = DescriptionError("zero-axis", "is zero", file="part.xacro", line=3)
    expected = Finding("zero-axis", "error", "is zero", "part.xacro", 3, "a.urdf.xacro")
    assert from_error(error, "a.urdf.xacro") == expected
    warning = PinscrewWarning("axis-normalised", "is long", file="part.xacro", line=3)
    assert from_warning(warning, "arm") == Finding("axis-normalised", "warning", "is long", "part.xacro", 3, "arm")
    own = XacroError("not-xml", "is not well-formed", file="a.urdf.xacro", line=3)
    assert from_error(own).line == 3
