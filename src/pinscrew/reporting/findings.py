"""One thing to tell about a file, in terms that editors, forges and test reports share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

from pinscrew.ground.words import brief, one_line

__all__ = ["RULES", "Finding", "Level", "help_text"]

Level: TypeAlias = Literal["error", "warning", "note"]

RULES: Final[dict[str, str]] = {
    "disagreement": "The two engines read, place or move a joint differently, so one of them is wrong about the file.",
    "moved": "The mechanism is no longer the one that the robot's lock holds.",
    "placed-anew": "The file differs from the lock in what does not change how the robot moves.",
    "motion-changed": "The robot moves otherwise than the one that it is compared with.",
    "motion-kept": "The file differs from the other one in what does not change how the robot moves.",
}
"""What each rule stands for, beside the codes of errors and warnings."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing to tell about a file.

    Attributes:
        rule: what kind of thing: a name in `RULES`, or the code of an error or warning.
        level: ``"error"``, ``"warning"`` or ``"note"``.
        message: what is wrong, in one sentence, without the place.
        file: the file, or ``""`` if it is about none.
        line: the line in that file, or ``None``.
        robot: the robot, as it was asked for, or ``""``.
    """

    rule: str
    level: Level
    message: str
    file: str
    line: int | None = None
    robot: str = ""

    @property
    def text(self) -> str:
        """The message, with the robot where that is not the file."""
        if self.robot in ("", self.file):
            return self.message
        return f"{one_line(brief(self.robot))}: {self.message}"

    @property
    def placed(self) -> str:
        """The message, with file and line where there are any."""
        place = self.file if self.line is None else f"{self.file}:{self.line}"
        return f"{place}: {self.message}" if place else self.message


def help_text(rule: str) -> str:
    """What a rule stands for, in a sentence.

    Raises:
        KeyError: if nothing explains it: add it to `RULES`.
    """
    from pinscrew.ground.error_codes import ERRORS, WARNINGS

    if rule in RULES:
        return RULES[rule]
    return " ".join(texts[rule] for texts in (ERRORS, WARNINGS) if rule in texts) or RULES[rule]
