"""Pages that scripts write: written, or held against what they would be."""

from __future__ import annotations

import sys
from pathlib import Path

__all__ = ["write_or_check"]


def write_or_check(page: Path, text: str) -> int:
    """Write a page; with ``--check`` on the command line tell whether it is up to date, as an exit status."""
    if "--check" not in sys.argv[1:]:
        page.write_text(text, encoding="utf-8")
        return 0
    current = page.read_text(encoding="utf-8") if page.exists() else ""
    if current != text:
        print(f"{page} is not up to date: run python {sys.argv[0]}", file=sys.stderr)
    return int(current != text)
