"""What reports are made of, before any format: sections of paragraphs, formulas and tables."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from pinscrew.ground.escaping import visible

__all__ = [
    "Block",
    "Formula",
    "Paragraph",
    "Section",
    "Sketch",
    "SketchLabel",
    "SketchLine",
    "Table",
    "Writeup",
    "from_file",
    "named",
]


def named(text: str) -> str:
    """A name from a file for a `Paragraph`, a cell or a title, to be set as code: it means nothing there but itself.

    It stands between characters for private use, which `visible` leaves in no name.
    """
    return f"\ue000{visible(text)}\ue001"


def from_file(text: str) -> str:
    """Other text with parts from a file, as `named` but set as plain text."""
    return f"\ue002{visible(text)}\ue001"


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Plain text; what stands between dollars is LaTeX, between backquotes code; see `named` and `from_file` too."""

    text: str


@dataclass(frozen=True, slots=True)
class Formula:
    """A displayed formula: parts that are joined by equals signs, one line each where it is long."""

    parts: tuple[str, ...]

    @property
    def latex(self) -> str:
        """The whole, on one line."""
        return " = ".join(self.parts)


@dataclass(frozen=True, slots=True)
class Table:
    """A table; cells are text as in `Paragraph`."""

    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True)
class SketchLine:
    """A line through points (in points of the page, y upwards) in a colour ``#rrggbb``."""

    points: tuple[tuple[float, float], ...]
    color: str
    width: float
    dashed: bool = False


@dataclass(frozen=True, slots=True)
class SketchLabel:
    """A text about a place: a formula in LaTeX, or a name from a file."""

    at: tuple[float, float]
    text: str
    color: str
    formula: bool


@dataclass(frozen=True, slots=True)
class Sketch:
    """A line drawing and its size (points); what cannot show it leaves it out."""

    lines: tuple[SketchLine, ...]
    labels: tuple[SketchLabel, ...]
    size: tuple[float, float]


Block: TypeAlias = Paragraph | Formula | Table | Sketch


@dataclass(frozen=True, slots=True)
class Section:
    """A section: its letter in the coursework (or none), its key for ``--part``, its title and what is in it."""

    letter: str
    key: str
    title: str
    blocks: tuple[Block, ...] = field(default=())

    @property
    def heading(self) -> str:
        """The title with its letter."""
        return f"({self.letter}) {self.title}" if self.letter else self.title


@dataclass(frozen=True, slots=True)
class Writeup:
    """A whole report; ``code`` is Python that makes the derivation again."""

    title: str
    sections: tuple[Section, ...]
    code: str
    ok: bool
