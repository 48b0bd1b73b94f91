"""Numbers in attributes, as strict as both parsers together."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Final, TypeAlias

from pinscrew.description.markup import Element
from pinscrew.ground.errors import DescriptionError

__all__ = ["SPACE", "Refuse", "numbers"]

SPACE: Final = " \t\r\n"
"""What separates words in XML."""

# No two parts of it match the same digits, so that a long line of them takes no time that grows with the square.
_NUMBER: Final = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_WORD: Final = re.compile(rf"[^{SPACE}]+")

Refuse: TypeAlias = Callable[[str, str, str], DescriptionError]
"""From a code, what is wrong and what would be right to the error about the element that it is in."""


def numbers(
    element: Element, attribute: str, count: int, refuse: Refuse, *, most: float = math.inf
) -> list[float] | None:
    """The finite numbers in an attribute, of at most ``most`` each, or None where it is absent.

    Raises:
        DescriptionError: that ``refuse`` makes, if they are none or not so many.
    """
    text = element.attributes.get(attribute)
    if text is None:
        return None
    words = _WORD.findall(text)
    remedy = f"write {'one finite number' if count == 1 else f'{count} finite numbers'}, such as "
    remedy += f'{attribute}="{" ".join(["0.1"] * count)}"'
    place = f"<{element.tag} {attribute}={text!r}>"
    if len(words) != count:
        raise refuse("number-count", f"{place} has {len(words)} values", remedy)
    for word in words:
        if not _NUMBER.fullmatch(word) or not math.isfinite(float(word)):
            raise refuse("number", f"{place}: {word!r} is not a finite number", remedy)
        if not abs(float(word)) <= most:
            raise refuse("number", f"{place}: {word} is larger than {most:g}", remedy)
    return [float(word) for word in words]
