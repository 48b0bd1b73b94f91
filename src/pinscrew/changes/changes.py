"""What `pinscrew.diff` answers: the changes, with the formats that they can be written in."""

from __future__ import annotations

from dataclasses import dataclass

from pinscrew.changes import formats
from pinscrew.changes.outcome import ChangesData

__all__ = ["Changes"]


@dataclass(frozen=True)
class Changes(ChangesData):
    """What `diff` found between two robots; `ChangesData` lists what it holds. ``print`` shows it as text."""

    def __str__(self) -> str:
        return formats.to_text(self)

    def to_json(self) -> str:
        """The changes as JSON, schema ``pinscrew.diff/1``."""
        return formats.to_json(self)

    def to_markdown(self) -> str:
        """The changes as Markdown: a heading and lists."""
        return formats.to_markdown(self)
