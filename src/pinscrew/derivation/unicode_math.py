"""Formulas as a terminal shows them: ``-(L₃ + θ₃) s₁ c₂``, matrices in brackets of several lines."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from typing import Final

from pinscrew.mathtext.equations import Grid, Side, read_equations

__all__ = ["lines", "one_line", "width"]

_TOKEN: Final = re.compile(r"\\[A-Za-z]+|\\.|\d+(?:\.\d+)?|\s+|.", re.DOTALL)
_SYMBOLS: Final = {
    r"\theta": "θ", r"\omega": "ω", r"\xi": "ξ", r"\pi": "π", r"\partial": "∂", r"\times": "×", r"\cdot": "·",
    r"\dagger": "†", r"\dots": "…", r"\cos": "cos", r"\sin": "sin", r"\tan": "tan", r"\det": "det", r"\,": " ",
    r"\;": " ", r"\ ": " ", r"\quad": "   ", r"\qquad": "      ", r"\left": "", r"\right": "", r"\_": "_", "'": "′",
    r"\alpha": "α", r"\beta": "β", r"\gamma": "γ", r"\delta": "δ", r"\phi": "φ", r"\psi": "ψ", r"\lambda": "λ",
    r"\mu": "μ", r"\rho": "ρ", r"\displaystyle": "", r"\neq": "≠", r"\leq": "≤", r"\geq": "≥", r"\to": "→",
    r"\wedge": "∧", r"\vee": "∨", r"\infty": "∞", r"\|": "‖", r"\in": "∈", r"\mid": "|", r"\ldots": "…", r"\cdots": "⋯",
    r"\ne": "≠", r"\le": "≤", r"\ge": "≥", r"\pm": "±", r"\top": "⊤", r"\{": "{", r"\}": "}", r"\&": "&",
}  # fmt: skip
_FRACTIONS: Final = {r"\frac", r"\tfrac", r"\dfrac"}
_NAMES: Final = {r"\mathrm", r"\text", r"\operatorname", r"\mathbf", r"\mathit"}
_SCRIPT: Final = {"S": "𝒮", "V": "𝒱"}
_ACCENTS: Final = {r"\hat": "\u0302", r"\dot": "\u0307", r"\ddot": "\u0308", r"\tilde": "\u0303", r"\bar": "\u0304"}
_LOW: Final = dict(zip("0123456789+-=()aehijklmnoprstuvx", "₀₁₂₃₄₅₆₇₈₉₊₋₌₍₎ₐₑₕᵢⱼₖₗₘₙₒₚᵣₛₜᵤᵥₓ", strict=True))
_HIGH: Final = dict(
    zip("0123456789+-=()abcdefghijklmnoprstuvwxyzT†′", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁼⁽⁾ᵃᵇᶜᵈᵉᶠᵍʰⁱʲᵏˡᵐⁿᵒᵖʳˢᵗᵘᵛʷˣʸᶻᵀ†′", strict=True)
)
_BREAK: Final = {"+", "-", "=", ",", ")", "]", ""}


def width(text: str) -> int:
    """How many columns a text takes; accents that stand on a letter take none."""
    return sum(not unicodedata.combining(c) for c in text)


def one_line(latex: str) -> str:
    """A formula without matrices on one line; what is above or below is there as ``a/(b c)``, ``x²`` or ``x^(a b)``."""
    tokens = _TOKEN.findall(" ".join(latex.split()))
    return " ".join(_Line(tokens).text().split())


class _Line:
    """Goes through the tokens of one formula."""

    def __init__(self, tokens: list[str]) -> None:
        self._tokens, self._at = tokens, 0

    def text(self) -> str:
        found = ""
        while self._at < len(self._tokens):
            found += self._piece()
        return found

    def _ahead(self) -> str:
        """The next token that is seen."""
        for token in self._tokens[self._at :]:
            if not token.isspace() and token not in (r"\left", r"\right", r"\,"):
                return token
        return ""

    def _group(self) -> str:
        """What stands in braces, or the next token, set on one line."""
        while self._at < len(self._tokens) and self._tokens[self._at].isspace():
            self._at += 1
        if self._at >= len(self._tokens):
            return ""
        if self._tokens[self._at] != "{":
            return self._piece()
        start, depth = self._at + 1, 0
        while self._at < len(self._tokens):
            depth += {"{": 1, "}": -1}.get(self._tokens[self._at], 0)
            self._at += 1
            if depth == 0:
                break
        return " ".join(_Line(self._tokens[start : self._at - 1]).text().split())

    def _piece(self) -> str:  # noqa: PLR0911 (one for each kind of piece)
        here = self._tokens[self._at]
        if here == "{":
            return self._group()
        self._at += 1
        if here in _FRACTIONS:
            above, below = self._group(), self._group()
            above = f"({above})" if _is_sum(above) else above
            below = f"({below})" if " " in below or "/" in below else below
            whole = self._ahead() in _BREAK or above.startswith("∂")
            return f"{above}/{below}" if whole else f"({above}/{below})"
        if here == r"\sqrt":
            inside = self._group()
            return f"√{inside}" if inside.isalnum() else f"√({inside})"
        if here in _NAMES:
            return self._group()
        if here == r"\mathcal":
            inside = self._group()
            return _SCRIPT.get(inside, inside)
        if here in _ACCENTS:
            inside = self._group()
            return inside + _ACCENTS[here] if width(inside) == 1 else f"({inside}){_ACCENTS[here]}"
        if here in ("_", "^"):
            return _script(self._group(), _LOW if here == "_" else _HIGH, here)
        if here == r"\partial":
            while self._at < len(self._tokens) and self._tokens[self._at].isspace():
                self._at += 1
        if here in (r"\cos", r"\sin", r"\tan", r"\det") and self._ahead() in _FRACTIONS:
            return f"{_SYMBOLS[here]}({self._group().removeprefix('(').removesuffix(')')})"
        if here in (r"\cos", r"\sin", r"\tan", r"\det") and self._ahead() not in ("^", "("):
            return _SYMBOLS[here] + " "
        return _SYMBOLS.get(here, here)


def _script(text: str, small: dict[str, str], mark: str) -> str:
    """An index or a power in small characters, or after a sign where there are none."""
    tight = text.replace(" ", "") if mark == "^" and set(text) <= set("-+0123456789 ") else text
    if all(c in small for c in tight):
        return "".join(small[c] for c in tight)
    if text.isalnum() or (text.startswith("(") and text.endswith(")")):
        return mark + text
    return f"{mark}({text})"


def _is_sum(text: str) -> bool:
    """Whether a text is a sum outside of parentheses, or begins with a minus."""
    depth = 0
    for i, c in enumerate(text):
        depth += (c in "([") - (c in ")]")
        if depth == 0 and c in "+-" and (i == 0 or text[i - 1] == " "):
            return True
    return False


@dataclass(frozen=True, slots=True)
class _Box:
    """Lines of equal width, of which one is in line with the text beside."""

    rows: tuple[str, ...]
    base: int

    @property
    def width(self) -> int:
        return width(self.rows[0])


def _text_box(text: str) -> _Box:
    return _Box((text,), 0)


def _beside(boxes: list[_Box], gap: str = " ") -> _Box:
    above = max(box.base for box in boxes)
    below = max(len(box.rows) - box.base for box in boxes)
    rows = []
    for line in range(above + below):
        parts = []
        for box in boxes:
            row = line - above + box.base
            parts.append(box.rows[row] if 0 <= row < len(box.rows) else " " * box.width)
        rows.append(gap.join(parts))
    return _Box(tuple(rows), above)


def _grid_box(cells: list[list[str]]) -> _Box:
    widths = [max(width(row[j]) for row in cells) for j in range(len(cells[0]))]
    rows = []
    last = len(cells) - 1
    for i, row in enumerate(cells):
        left, right = ("[", "]") if last == 0 else ("⎡", "⎤") if i == 0 else ("⎣", "⎦") if i == last else ("⎢", "⎥")
        inside = "   ".join(
            " " * ((w - width(x) + 1) // 2) + x + " " * ((w - width(x)) // 2) for x, w in zip(row, widths, strict=True)
        )
        rows.append(f"{left} {inside} {right}")
    return _Box(tuple(rows), len(cells) // 2)


def lines(latex: str, columns: int) -> list[str]:
    """A formula on the lines that it needs, none wider than ``columns`` where that can be.

    It is broken before equals signs, and then between factors. A matrix that is too wide has numbers in angle brackets
    for its longest entries, which follow.
    """
    found: list[str] = []
    notes: list[str] = []
    numbers: dict[str, str] = {}
    row: list[_Box] = []
    indent = ""
    for equation in read_equations(latex):
        for number, side in enumerate(equation):
            boxes = _side(side, columns - 8, numbers, notes)
            sign = ["="] if number else [" , "] if row else []
            boxes = [*map(_text_box, sign), *boxes]
            for k, box in enumerate(boxes):
                ahead = boxes[1].width + 1 if sign and k == 0 and len(boxes) > 1 else 0
                used = sum(each.width + 1 for each in row) + len(indent)
                if row and used + box.width + ahead > columns:
                    found += [indent + line.rstrip() for line in _beside(row).rows]
                    row, indent = [], "    "
                    if box.rows == (" , ",):  # what was separated stands below
                        indent = ""
                        continue
                row.append(box)
    found += [indent + line.rstrip() for line in _beside(row).rows] if row else []
    return found + notes


def _side(side: Side, room: int, numbers: dict[str, str], notes: list[str]) -> list[_Box]:
    boxes = []
    for piece in side:
        if isinstance(piece, Grid):
            boxes.append(_grid_box(_fitting([[one_line(x) for x in row] for row in piece.cells], room, numbers, notes)))
        else:
            boxes.append(_text_box(one_line(piece)))
    return boxes


def _fitting(cells: list[list[str]], room: int, numbers: dict[str, str], notes: list[str]) -> list[list[str]]:
    """The cells, the longest of them replaced until the matrix fits."""
    while _grid_box(cells).width > room:
        longest = max((x for row in cells for x in row), key=width)
        if width(longest) <= 4:
            return cells
        if longest not in numbers:
            numbers[longest] = f"⟨{len(numbers) + 1}⟩"
            notes.append(f"    {numbers[longest]} = {longest}")
        cells = [[numbers[longest] if x == longest else x for x in row] for row in cells]
    return cells
