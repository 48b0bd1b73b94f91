"""A document's data as JSON."""

from __future__ import annotations

from pinscrew.ground.escaping import json_text
from pinscrew.reporting.document import Document

__all__ = ["to_json"]


def to_json(document: Document) -> str:
    """The data, laid out for reading; characters as they are, and no NaN or infinity, which JSON does not have."""
    return json_text(document.data)
