"""SARIF 2.1.0, the format of code scanning on GitHub and of many editors.

Source: OASIS, "Static Analysis Results Interchange Format (SARIF) Version 2.1.0", 2020; section numbers are its.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final
from urllib.parse import quote

from pinscrew.ground.escaping import json_text, sarif_message
from pinscrew.ground.version import __version__
from pinscrew.reporting.document import Document
from pinscrew.reporting.findings import Finding, help_text
from pinscrew.reporting.paths import below

__all__ = ["to_sarif"]

_SCHEMA: Final = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"


def to_sarif(document: Document) -> str:
    """The findings of a document as a SARIF log with one run.

    One about no file becomes a notification of the tool (§3.20.21), since a result must be somewhere. GitHub keeps the
    results of each of the documents' tasks apart.
    """
    findings = document.findings
    rules = list(dict.fromkeys(finding.rule for finding in findings))
    results = [_result(finding, rules) for finding in findings if finding.file]
    notifications = [_notification(finding, rules) for finding in findings if not finding.file]
    driver = {
        "name": "pinscrew",
        "version": __version__,
        "rules": [{"id": rule, "shortDescription": _text(rule), "help": _text(rule)} for rule in rules],
    }
    run = {
        "tool": {"driver": driver},
        "automationDetails": {"id": f"{document.task}/"},
        "originalUriBaseIds": {"%SRCROOT%": {"description": {"text": "The top of the checkout."}}},
        "invocations": [
            {
                "executionSuccessful": not any(note["level"] == "error" for note in notifications),
                "toolExecutionNotifications": notifications,
            }
        ],
        "results": results,
    }
    log = {"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}
    return json_text(log) + "\n"


def _text(rule: str) -> dict[str, str]:
    return {"text": sarif_message(help_text(rule))}


def _result(finding: Finding, rules: Sequence[str]) -> dict[str, Any]:
    place: dict[str, Any] = {"artifactLocation": _location(finding.file)}
    if finding.line is not None:
        place["region"] = {"startLine": finding.line}
    return {
        "ruleId": finding.rule,
        "ruleIndex": rules.index(finding.rule),
        "level": finding.level,
        "message": {"text": sarif_message(finding.text)},
        "locations": [{"physicalLocation": place}],
    }


def _notification(finding: Finding, rules: Sequence[str]) -> dict[str, Any]:
    return {
        "associatedRule": {"id": finding.rule, "index": rules.index(finding.rule)},
        "level": finding.level,
        "message": {"text": sarif_message(finding.text)},
    }


def _location(file: str) -> dict[str, str]:
    """A relative URI below the top of the checkout, an absolute one elsewhere (§3.4.3, §3.10)."""
    relative = below(file)
    if relative is None:
        return {"uri": Path(os.path.abspath(file)).as_uri()}  # noqa: PTH100 (links are kept, as in `paths.below`)
    return {"uri": quote(os.fsencode(relative)), "uriBaseId": "%SRCROOT%"}
