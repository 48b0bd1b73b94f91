"""A document as JUnit XML, as test reports of GitLab, Jenkins and others read it."""

from __future__ import annotations

from xml.etree import ElementTree as ET

from pinscrew.ground.escaping import xml_characters
from pinscrew.reporting.document import Case, Document

__all__ = ["to_junit"]


def to_junit(document: Document) -> str:
    """A suite for each account, with its cases."""
    root = ET.Element("testsuites", name=document.task)
    totals = {"tests": 0, "failures": 0, "errors": 0}
    for account in document.accounts:
        cases = account.cases or (Case(document.task),)
        problems = [case.problem.kind for case in cases if case.problem is not None]
        counts = {"tests": len(cases), "failures": problems.count("failure"), "errors": problems.count("error")}
        suite = ET.SubElement(root, "testsuite", name=account.title, skipped="0")
        for count, value in counts.items():
            suite.set(count, str(value))
            totals[count] += value
        for case in cases:
            element = ET.SubElement(suite, "testcase", classname=f"pinscrew.{account.title}", name=case.name)
            if case.problem is not None:
                problem = case.problem
                child = ET.SubElement(element, problem.kind, message=problem.message, type=problem.type)
                child.text = problem.text or None
    for count, value in totals.items():
        root.set(count, str(value))
    ET.indent(root)
    return xml_characters('<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n")
