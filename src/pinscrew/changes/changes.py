"""What `pinscrew.diff` answers: the changes, which can be printed and written in every format."""

from __future__ import annotations

from dataclasses import dataclass

from pinscrew.changes.document import document, failing, passes
from pinscrew.changes.outcome import Change, ChangesData
from pinscrew.reporting.document import Document
from pinscrew.reporting.documented import Documented

__all__ = ["Changes"]


@dataclass(frozen=True)
class Changes(Documented, ChangesData):
    """What `diff` found between two robots; `ChangesData` lists what it holds. ``print`` shows it as text.

    Its JSON has the schema ``pinscrew.diff/1``, its Markdown a heading and lists.
    """

    @property
    def passes(self) -> bool:
        """Whether the motion is the same, and no note is one to fail on."""
        return passes(self)

    @property
    def failing(self) -> tuple[Change, ...]:
        """The changes, and the notes to fail on."""
        return failing(self)

    def document(self) -> Document:
        """The changes in no format yet."""
        return document(self)
