"""Reports as text, JSON, JUnit XML and Markdown: complete, valid, and safe with any name."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from xml.etree import ElementTree as ET

import pytest

import pinscrew as ps
import urdfs
from broken import ROBOT, edited, pair
from pinscrew.ground.errors import DescriptionError
from pinscrew.reporting import to_json, to_junit, to_markdown
from pinscrew.verification.document import Attempt, document
from pinscrew.verification.outcome import Check, ErrorPlace
from pinscrew.verification.report import Report
from pinscrew.verification.run import verify
from pinscrew.verification.wording import details, failures

GOOD = verify(ROBOT, 2)
BAD = verify(ROBOT, 2, engines=pair(1, edited(("0.4 0 0", "0.41 0 0"), ('offset="0.25"', 'offset="0.3"'))))
NO_FILE = DescriptionError("no-file", 'there is no "such" file & folder', file="arm <1>.urdf")
ERROR = Attempt("arm <1>.urdf", errors=(NO_FILE,))
ALL = document([Attempt("good", (GOOD,)), Attempt("bad", (BAD,)), ERROR])
NAMES = ["a|b", "a<b>&c", "a`b`", "a\nb", "a\"b'c", "a]]>b", "*a_b*", "[a](b)", "a\\b", "ä ω 機", "<!-- a -->"]


def named(name: str) -> Report:
    """A failed report whose robot, joint and link have this name."""
    written = name.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;").replace("\n", "&#10;")
    text = urdfs.robot(urdfs.joint(written, "revolute", "base", written, xyz="0.1 0 0"), links=f"base {'?'}")
    text = text.replace('"?"', f'"{written}"').replace('"small"', f'"{written}"')
    right, wrong = urdfs.load(text), urdfs.load(text.replace("0.1 0 0", "0.2 0 0"))
    assert (right.name, right.tip, right.joint_names) == (name, name, (name,))
    return verify(right, 1, engines=(ps.PoE(right), ps.Pinocchio(wrong)))


def report(*checks: Check, tolerance: float = 1e-12) -> Report:
    return Report("r", "r.urdf", {}, ("A", "B"), 1, 1, 1, 0, tolerance, 1.0, checks)


# -------------------------------------------------------------------------------------------- the report


def test_outcome() -> None:
    checks = Check("x", 1e-13, 1e-12), Check("y", 1e-10, 1e-9), Check("z", 0.0, 0.0)
    good = report(*checks)
    assert good.ok
    assert good.failed == ()
    assert good.worst.name == "x"
    assert good.largest_difference == 1e-13
    bad = report(*checks, Check("w", 2e-12, 1e-12), Check("v", 3e-9, 1e-9))
    assert not bad.ok
    assert [check.name for check in bad.failed] == ["w", "v"]
    assert bad.worst.name == "v"
    assert bad.largest_difference == 2e-12


@pytest.mark.parametrize("error", [math.nan, math.inf, 1.0000001e-12])
def test_what_fails(error: float) -> None:
    check = Check("x", error, 1e-12)
    failing = report(Check("y", 1e-13, 1e-12), check)
    assert not check.ok
    assert not failing.ok
    assert failing.failed == (check,)
    assert failing.worst is check


def test_remarks_are_worse_than_numbers() -> None:
    structure = Check("structure", 1.0, 0.0, remarks=("x",))
    assert report(Check("y", 1.0, 1e-12), structure).worst is structure


# --------------------------------------------------------------------------------------------------- text


def test_text() -> None:
    lines = str(GOOD).splitlines()
    assert lines[0] == "small: PoE and Pinocchio agree on 6 frames at 23 configurations (seed 0)"
    assert lines[1].split() == ["check", "error", "tolerance", "largest", "at"]
    assert [line[: len(check.name)] for line, check in zip(lines[2:], GOOD.checks, strict=True)] == [
        check.name for check in GOOD.checks
    ]
    column = lines[1].index("error")
    assert all(re.match(r"\d\.\de[+-]\d\d  \d\.\de[+-]\d\d +ok", line[column:]) for line in lines[2:])
    assert all(line == line.rstrip() for line in lines)


def test_text_of_a_failure() -> None:
    lines = str(BAD).splitlines()
    assert lines[0].startswith("small: PoE and Pinocchio DISAGREE on 6 frames")
    assert sum("FAIL" in line for line in lines) == len(BAD.failed) > 0
    end = lines[2 + len(BAD.checks) :]
    mimic = "joint 'j4': its mimic is 0.5 times 'j2' plus 0.25 to PoE, 0.5 times 'j2' plus 0.3 to Pinocchio"
    origin = "joint 'j2': its origin is moved by [10, 0, 0] mm (10 mm) in Pinocchio, compared with PoE"
    assert end[:2] == [mimic, origin]
    assert re.fullmatch(r"home poses: largest at q = \[0\.0, 0\.0, 0\.0\]", end[2])
    assert len(end) == 3


# --------------------------------------------------------------------------------------------------- JSON


def loaded(text: str) -> dict[str, object]:
    """JSON as the standard has it: without NaN and Infinity."""
    document: dict[str, object] = json.loads(text, parse_constant=pytest.fail)
    return document


def test_json() -> None:
    document = loaded(GOOD.to_json())
    assert (document["schema"], document["ok"], document["errors"]) == ("pinscrew.verify/1", True, [])
    assert set(document["versions"]) == {"pinscrew", "pin", "yourdfpy", "numpy"}
    (robot,) = document["robots"]
    for name in ("robot", "file", "frames", "samples", "configurations", "seed", "tolerance", "reach", "ok"):
        assert robot[name] == getattr(GOOD, name)
    assert robot["engines"] == ["PoE", "Pinocchio"]
    assert robot["worst"] == GOOD.worst.name
    assert robot["diagnosis"] == []
    for said, check in zip(robot["checks"], GOOD.checks, strict=True):
        assert (said["name"], said["error"], said["tolerance"]) == (check.name, check.error, check.tolerance)
        assert (said["frame"], said["joint"], said["configuration"]) == (
            check.place.frame,
            check.place.joint,
            check.place.configuration,
        )
        assert tuple(said["q"]) == check.place.q


def test_json_of_failures() -> None:
    data = loaded(to_json(ALL))
    assert data["ok"] is False
    assert [robot["ok"] for robot in data["robots"]] == [True, False]
    assert data["robots"][1]["diagnosis"] == list(BAD.diagnosis)
    assert data["robots"][1]["checks"][0]["remarks"] == list(BAD.checks[0].remarks)
    assert data["errors"] == [{"robot": ERROR.robot, "code": "no-file", "message": str(NO_FILE)}]
    assert loaded(to_json(document([Attempt("good", (GOOD,)), ERROR])))["ok"] is False


@pytest.mark.parametrize("error", [math.inf, math.nan])
def test_json_knows_no_infinity(error: float) -> None:
    document = loaded(report(Check("x", error, 1e-12)).to_json())
    assert document["robots"][0]["checks"][0]["error"] == "inf"


# -------------------------------------------------------------------------------------------------- JUnit


def junit(text: str) -> ET.Element:
    return ET.fromstring(text.encode())  # noqa: S314 (our own)


def test_junit() -> None:
    root = junit(to_junit(ALL))
    checks, failures = len(GOOD.checks) + len(BAD.checks), len(BAD.failed)
    assert root.tag == "testsuites"
    assert [int(root.get(name)) for name in ("tests", "failures", "errors")] == [checks + 1, failures, 1]
    good, bad, error = root
    assert [int(bad.get(name)) for name in ("tests", "failures", "errors")] == [len(BAD.checks), failures, 0]
    assert [case.get("name") for case in good] == [check.name for check in GOOD.checks]
    assert good.get("failures") == "0"
    assert not good.findall(".//failure")
    said = {case.get("name"): case.find("failure") for case in bad if case.find("failure") is not None}
    assert set(said) == {check.name for check in BAD.failed}
    for check in BAD.failed:
        failure = said[check.name]
        assert failure.get("message").startswith(f"error {check.error:.3e} above {check.tolerance:.3e}")
        assert failure.text.splitlines() == [*BAD.diagnosis, f"q = {list(check.place.q)}"]
    (problem,) = error.findall("./testcase/error")
    assert (problem.get("type"), problem.get("message")) == ("no-file", str(NO_FILE))


@pytest.mark.parametrize("name", NAMES)
def test_junit_with_any_name(name: str) -> None:
    failed = named(name)
    (suite,) = junit(failed.to_junit())
    assert suite.get("name") == name
    assert {case.get("classname") for case in suite} == {f"pinscrew.{name}"}
    texts = [failure.text for failure in suite.iter("failure")]
    assert len(texts) == len(failed.failed) > 0
    assert all(f"joint {name!r}: its origin is moved" in text for text in texts)


@pytest.mark.parametrize("name", ["a\x00b", "a\x1bb", "a\udcffb", "a\ufffeb"])
def test_junit_leaves_out_what_xml_cannot_hold(name: str) -> None:
    (suite,) = junit(to_junit(document([Attempt(name, errors=(DescriptionError("no-file", "none", file=name),))])))
    assert suite.get("name") == "a\ufffdb"


# ----------------------------------------------------------------------------------------------- Markdown


def cells(line: str) -> list[str]:
    return [cell.strip() for cell in re.split(r"(?<!\\)(?:\\\\)*\|", line)[1:-1]]


@pytest.mark.parametrize(("given", "outcome"), [(GOOD, "agree"), (BAD, "DISAGREE")], ids=["good", "bad"])
def test_markdown(given: Report, outcome: str) -> None:
    heading, blank, header, rule, *rest = given.to_markdown().splitlines()
    assert heading.startswith(f"### small: PoE and Pinocchio {outcome} on 6 frames")
    assert (blank, rule) == ("", "|---|---|---|---|---|")
    assert cells(header) == ["check", "error", "tolerance", "", "largest at"]
    rows = [cells(line) for line in rest[: len(given.checks)]]
    assert [row[3] for row in rows] == ["ok" if check.ok else "**FAIL**" for check in given.checks]
    assert [row[1] for row in rows] == [f"{check.error:.1e}" for check in given.checks]
    bullets = [line for line in rest[len(given.checks) :] if line]
    assert all(line.startswith("- ") for line in bullets)
    assert len(bullets) == len(details(given))


@pytest.mark.parametrize("name", NAMES)
def test_markdown_with_any_name(name: str) -> None:
    """A name is on one line and has no unescaped markup, so the table keeps its five columns."""
    failed = named(name)
    lines = failed.to_markdown().splitlines()
    table = [line for line in lines if line.startswith("|")]
    assert len(table) == len(failed.checks) + 2
    assert {len(cells(line)) for line in table} == {5}
    plain = " ".join(name.split())
    assert re.sub(r"\\(.)", r"\1", lines[0]).startswith(f"### {plain}: PoE and Pinocchio DISAGREE")
    bare = re.sub(r"\\.", "", lines[0].removeprefix("### "))
    assert not set("`*_|<>[]\\") & set(bare)


@pytest.mark.parametrize("name", NAMES)
def test_text_with_any_name(name: str) -> None:
    """Names with line breaks don't break the table."""
    failed = named(name)
    assert len(str(failed).splitlines()) == 2 + len(failed.checks) + len(details(failed))


def test_markdown_of_several() -> None:
    text = to_markdown(ALL)
    headings = [line for line in text.splitlines() if line.startswith("### ")]
    assert len(headings) == 3
    assert headings[2] == r"### arm \<1\>.urdf: could not be verified"
    assert r'arm \<1\>.urdf: there is no "such" file \& folder' in text.splitlines()


def test_failures() -> None:
    lines = failures(BAD)
    assert len(lines) == len(BAD.failed)
    assert failures(GOOD) == []
    check = Check("x", 0.5, 1e-12, ErrorPlace("tool", "j", "random 3", (0.0,)))
    assert failures(report(check)) == ["x: error 5.0e-01 above 1.0e-12, largest at frame tool, joint j, random 3"]


def test_a_failure_without_a_diagnosis_is_a_finding_all_the_same() -> None:
    failed = replace(BAD, diagnosis=(), blamed=(), lines=(), files=())
    (finding,) = failed.document().findings
    assert (finding.rule, finding.level, finding.file, finding.line) == ("disagreement", "error", BAD.file, None)
    assert finding.message.startswith("the engines disagree (")
    assert GOOD.document().findings == ()
    assert len(BAD.document().findings) == len(BAD.diagnosis)
