"""What reports are made of, before any format: sections of paragraphs, formulas and tables."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

__all__ = ["Block", "Formula", "Paragraph", "Report", "Section", "Table"]


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Plain text; what stands between dollars is LaTeX."""

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


Block: TypeAlias = Paragraph | Formula | Table


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
class Report:
    """A whole report; ``code`` is Python that makes the derivation again."""

    title: str
    sections: tuple[Section, ...]
    code: str
    ok: bool
