"""What every reader of formulas does: it goes from token to token, and says where it stopped."""

from __future__ import annotations

import re
from collections.abc import Container
from typing import Final, NoReturn

from pinscrew.ground.errors import InputError

__all__ = ["CLOSING", "DEEPEST", "LONGEST", "TokenReader"]

LONGEST: Final = 100_000
"""Characters of a text."""
DEEPEST: Final = 60
"""Parentheses and braces within one another."""
CLOSING: Final = {"(": ")", "[": "]", "{": "}"}


class TokenReader:
    """A text as tokens, and the place where its reader is.

    Args:
        text: the text.
        pattern: what a token is; it matches at every character.
        skipped: tokens that mean nothing, beside white space.
        place: of the text's first character in a longer one.
    """

    def __init__(self, text: str, pattern: re.Pattern[str], skipped: Container[str] = (), place: int = 0) -> None:
        if len(text) > LONGEST:
            raise InputError("formula", f"the text is longer than {LONGEST} characters")
        self._tokens = [
            (match[0], place + match.start())
            for match in pattern.finditer(text)
            if not match[0].isspace() and match[0] not in skipped
        ]
        self._end = place + len(text)
        self._at = 0
        self._depth = 0

    def _token(self, ahead: int = 0) -> str:
        at = self._at + ahead
        return self._tokens[at][0] if at < len(self._tokens) else ""

    def _next(self) -> str:
        token = self._token()
        self._at += 1
        return token

    def _refuse(self, reason: str) -> NoReturn:
        place = self._tokens[self._at][1] if self._at < len(self._tokens) else self._end
        raise InputError("formula", reason, where=f"character {place + 1} of the formula")

    def _expect(self, token: str) -> None:
        if self._token() != token:
            self._refuse(f"{token!r} is missing")
        self._at += 1

    def _deeper(self) -> None:
        self._depth += 1
        if self._depth > DEEPEST:
            self._refuse(f"more than {DEEPEST} parentheses stand within one another")
