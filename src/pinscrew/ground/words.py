"""What a file, a macro or a caller says, made fit for one line of a message."""

from __future__ import annotations

import re
from typing import Final

from pinscrew.ground.escaping import visible

__all__ = ["brief", "one_line"]

MOST: Final = 400
"""Characters of a message that may come from a file; a name in it can have millions."""


def brief(text: str, most: int = MOST) -> str:
    """Both ends of a long text, or the text."""
    half = most // 2
    return text if len(text) <= most else f"{text[:half]} … {text[-half:]}"


def one_line(text: str) -> str:
    """The text without line breaks and colours, and with other control characters as escapes."""
    spaced = " ".join(re.sub(r"\x1b\[[0-9;]*m", "", text).split())
    return visible(spaced)
