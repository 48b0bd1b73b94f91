"""The mistakes of the printed courseworks, as data: ``errata.json`` beside the robots."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Final, Literal, TypeAlias

from pinscrew.description import catalogue

__all__ = ["SLIPS", "Erratum", "Slip", "errata"]

Slip: TypeAlias = Literal[
    "sign",
    "dot",
    "bracket",
    "index",
    "function",
    "term",
    "constant",
    "transposed",
    "copied",
    "size",
    "name",
    "formula",
]

SLIPS: Final[Mapping[Slip, str]] = {
    "sign": "a wrong or lost sign",
    "dot": "a lost, or one too many, dot of a derivative",
    "bracket": "a lost bracket",
    "index": "a wrong index",
    "function": "sine and cosine exchanged",
    "term": "a lost or false term or factor",
    "constant": "a wrong constant",
    "transposed": "a matrix is transposed",
    "copied": "something copied from another place",
    "size": "a wrong number of rows or columns",
    "name": "one thing is called by the name of another",
    "formula": "the formula is not the one that holds",
}
"""The kinds of slip, in words."""


@dataclass(frozen=True, slots=True)
class Erratum:
    """One mistake.

    Attributes:
        arm: the arm's number among the assignments.
        robot: its name in the catalogue.
        part: of the coursework.
        where: where it is printed.
        quantity: what it is an entry of; see `errata_truth.truth`.
        index: row and column, from 1.
        printed: the expression as printed, in the lengths and c1, s12, theta1, dtheta1, …; `mathtext.read_plain`
            reads it. Letters of which the arm has none stand for any number.
        right: the right expression.
        slip: the kind of mistake, one of `SLIPS`.
        scan: whether it may be the scan's, and not the author's.
        note: more in words, or ``""``.
        reference: the frame in which the quantity is, or ``""`` for the base.
        frame: the frame whose quantity it is, or ``""`` for the tool.
        joint: the number of the joint that is meant where the quantity is a joint's, such as ``"axis hat"``; and of
            the first in g_i = e^{ξ̂i θi} … e^{ξ̂n θn} g(0), those before it at zero. 0 for none.
        check: the robot to check it on where that is another, or ``""``.
        at: values of coordinates at which it holds, as expressions.
    """

    arm: str
    robot: str
    part: str
    where: str
    quantity: str
    index: tuple[int, int]
    printed: str
    right: str
    slip: Slip
    scan: bool = False
    note: str = ""
    reference: str = ""
    frame: str = ""
    joint: int = 0
    check: str = ""
    at: Mapping[str, str] = field(default_factory=dict)


@cache
def errata(robot: str | None = None) -> tuple[Erratum, ...]:
    """The mistakes in what is printed about a robot of the catalogue, or all."""
    text = (catalogue.robots_directory() / "errata.json").read_text(encoding="utf-8")
    rows = (Erratum(**{**row, "index": tuple(row["index"])}) for row in json.loads(text)["errata"])
    return tuple(row for row in rows if robot in (None, row.robot))
