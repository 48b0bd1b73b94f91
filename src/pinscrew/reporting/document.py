"""A report as a neutral document: what was asked, how it came out, and what there is to tell, in no format.

Rooms make documents (of a verification, of a comparison, of checked locks), and each format has one writer that takes
any of them::

    Document ─┬─ task, ok, overview, closing, data (the JSON)
              ├─ Account … one robot, lock or comparison: heading, table, lines, cases
              └─ Finding … one thing to tell about a file, at its line
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

from pinscrew.reporting.findings import RULES, Finding

__all__ = ["Account", "Case", "Document", "Problem", "ResultTable", "Role", "Sentence", "Strong", "cases_of"]

Role: TypeAlias = Literal["fault", "note", "remark", "paragraph"]
"""What a line is: what is wrong, what is only noted, what explains either, or text for itself."""


class Strong(str):
    """A cell that stands out, such as the mark of a failed check."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class ResultTable:
    """A table: its headings, and rows of as many cells."""

    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True)
class Sentence:
    """One sentence of an account.

    Attributes:
        text: the sentence.
        role: what it is.
        label: a stable word for its kind, such as ``"axis-turned"``, or ``""``.
    """

    text: str
    role: Role = "remark"
    label: str = ""


@dataclass(frozen=True, slots=True)
class Problem:
    """Why a case did not pass: it failed, or could not be tried (an error)."""

    kind: Literal["failure", "error"]
    message: str
    type: str
    text: str = ""


@dataclass(frozen=True, slots=True)
class Case:
    """One thing that passes or does not."""

    name: str
    problem: Problem | None = None


@dataclass(frozen=True, slots=True)
class Account:
    """What there is to tell about one robot, lock or comparison.

    Attributes:
        title: its name: the robot's, say.
        heading: the outcome in one line.
        table: numbers, where there are any.
        lines: sentences below.
        notes_heading: what stands above the lines that are notes, where they stand for themselves.
        cases: what was tried; without any, the document's task is the one case, which passed.
        tried: False where an error kept it from being looked at.
    """

    title: str
    heading: str
    table: ResultTable | None = None
    lines: tuple[Sentence, ...] = ()
    notes_heading: str = ""
    cases: tuple[Case, ...] = ()
    tried: bool = True


@dataclass(frozen=True, slots=True)
class Document:
    """A report in no format yet.

    Attributes:
        task: what was done, such as ``"pinscrew verify"``.
        ok: the verdict.
        accounts: one for each robot, lock or comparison.
        findings: what there is to tell at lines of files.
        data: the whole as JSON has it, with its ``"schema"``.
        overview: one line about all accounts, where they are many and alike; Markdown then has it and one table of
            the findings, in the place of the accounts.
        closing: the last line of the text: how many there were, and how to go on.
    """

    task: str
    ok: bool = True
    accounts: tuple[Account, ...] = ()
    findings: tuple[Finding, ...] = ()
    data: Mapping[str, Any] = field(default_factory=dict)
    overview: str = ""
    closing: str = ""


def cases_of(findings: Iterable[Finding]) -> tuple[Case, ...]:
    """A case for each rule that errors among these findings have; none where nothing failed.

    An error with a rule of `RULES` is a failure; one with an error's code kept a robot from being looked at, and is an
    error. Warnings and notes are left out: a case has passed or not.
    """
    by_rule: dict[str, list[Finding]] = {}
    for finding in findings:
        if finding.level == "error":
            by_rule.setdefault(finding.rule, []).append(finding)
    return tuple(Case(rule, _problem(rule, failed)) for rule, failed in by_rule.items())


def _problem(rule: str, failed: Sequence[Finding]) -> Problem:
    text = "\n".join(finding.placed for finding in failed)
    return Problem("failure" if rule in RULES else "error", failed[0].message, rule, text)
