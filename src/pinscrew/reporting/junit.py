"""JUnit XML, as test reports of GitLab, Jenkins and others read it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal
from xml.etree import ElementTree as ET

from pinscrew.reporting.model import RULES, Finding

__all__ = ["Case", "Problem", "Suite", "document", "to_junit"]

_NOT_XML: Final = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""What XML 1.0 has no way to write; a file's name may hold it."""


@dataclass(frozen=True, slots=True)
class Problem:
    """Why a case did not pass: it failed, or could not be tried (an error)."""

    kind: Literal["failure", "error"]
    message: str
    type: str
    text: str = ""


@dataclass(frozen=True, slots=True)
class Case:
    """One test case."""

    name: str
    problem: Problem | None = None


@dataclass(frozen=True, slots=True)
class Suite:
    """The test cases about one robot."""

    name: str
    cases: Sequence[Case]

    def count(self, kind: str) -> int:
        """How many of its cases have this kind of problem."""
        return sum(case.problem is not None and case.problem.kind == kind for case in self.cases)


def document(name: str, suites: Sequence[Suite]) -> str:
    """The JUnit XML of these suites."""
    root = ET.Element("testsuites", name=name)
    for suite in suites:
        element = ET.SubElement(root, "testsuite", name=suite.name, skipped="0", tests=str(len(suite.cases)))
        element.set("failures", str(suite.count("failure")))
        element.set("errors", str(suite.count("error")))
        for case in suite.cases:
            shown = ET.SubElement(element, "testcase", classname=f"pinscrew.{suite.name}", name=case.name)
            if case.problem is not None:
                problem = case.problem
                told = ET.SubElement(shown, problem.kind, message=problem.message, type=problem.type)
                told.text = problem.text or None
    for count in ("tests", "failures", "errors"):
        root.set(count, str(sum(int(suite.get(count, "0")) for suite in root)))
    ET.indent(root)
    text = '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"
    return _NOT_XML.sub("\N{REPLACEMENT CHARACTER}", text)


def to_junit(findings: Sequence[Finding], checked: Sequence[str], task: str) -> str:
    """Findings as JUnit XML: a suite for each robot, a case for each rule that failed there.

    Args:
        findings: those with the level ``"error"`` become failures if they have a rule of `RULES`, and errors if they
            have an error's code, which kept a robot from being looked at. The others are left out: a case has passed
            or not.
        checked: all robots that were looked at; one without errors is a suite with one case that passed.
        task: what was done, such as ``"pinscrew lock"``.
    """
    failed: dict[str, list[Finding]] = {robot: [] for robot in checked}
    for finding in findings:
        if finding.level == "error":
            failed.setdefault(finding.robot or finding.file, []).append(finding)
    return document(task, [Suite(robot, _cases(found, task)) for robot, found in failed.items()])


def _cases(found: Sequence[Finding], task: str) -> list[Case]:
    by_rule: dict[str, list[Finding]] = {}
    for finding in found:
        by_rule.setdefault(finding.rule, []).append(finding)
    cases = []
    for rule, findings in by_rule.items():
        lines = [_placed(finding) for finding in findings]
        kind: Literal["failure", "error"] = "failure" if rule in RULES else "error"
        cases.append(Case(rule, Problem(kind, findings[0].message, rule, "\n".join(lines))))
    return cases or [Case(task)]


def _placed(finding: Finding) -> str:
    place = finding.file if finding.line is None else f"{finding.file}:{finding.line}"
    return f"{place}: {finding.message}" if place else finding.message
