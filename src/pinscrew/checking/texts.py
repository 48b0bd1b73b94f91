r"""From a text to the cells of the matrices in it: LaTeX, Python and MATLAB, without running anything.

A program is its assignments, in order; a formula in LaTeX is what stands between equals signs. A cell stays a
text here.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, Literal

from pinscrew.ground.errors import InputError
from pinscrew.mathtext.tokens import CLOSING, LONGEST

__all__ = ["Assigned", "Written", "closing", "is_latex", "parts", "written"]

Language = Literal["latex", "plain", "matlab"]

MOST_CELLS: Final = 400
"""Entries of a matrix."""
_LIST: Final = re.compile(
    r"(?:[\w.]*\.)?(?:array|asarray|matrix|Matrix|ImmutableMatrix|sym|list|tuple)\s*\(\s*(?=[\[(])"
)
_ENVIRONMENT: Final = re.compile(r"\\(begin|end)\{((?:[bpvBV]|small)?matrix\*?|array|aligned|align\*?|equation\*?)\}")
_MATRICES: Final = re.compile(r"(?:[bpvBV]|small)?matrix\*?|array")
_TRANSPOSED: Final = re.compile(
    r"\^\s*\{?\s*(?:T|\\top|\\intercal|\\mathsf\s*\{?\s*T\s*\}?|\\mathrm\s*\{\s*T\s*\})\s*\}?|\.T\b|\.?'"
)
_PASSED: Final = re.compile(
    r"(?:import|from|def|function|end|syms|clear|clc|close|print|disp|with|class)\b|@|\.\.\.$|$"
)
_SUBSCRIPTS: Final = str.maketrans("₀₁₂₃₄₅₆₇₈₉₊₋", "0123456789+-")
_SIGNS: Final = {"−": "-", "·": "*", "⋅": "*", "×": "*", "²": "^2", "³": "^3", "\u00a0": " ", "°": "*pi/180"}
_SHORT_FUNCTION: Final = re.compile(r"(?<![A-Za-z\\_{])([cs])\s*(?=\\(?:var)?theta(?![A-Za-z]))")
"""Craig's cθ₁ for cos θ₁; in an index, ``c_{\\theta_1}``, it is a name."""
_LETTERS: Final = {
    "θ": r"\theta",
    "ϑ": r"\vartheta",
    "φ": r"\phi",
    "ϕ": r"\phi",
    "π": r"\pi",
    "ω": r"\omega",
    "ξ": r"\xi",
}


@dataclass(frozen=True, slots=True)
class Written:
    """A matrix as it is written.

    Attributes:
        rows: the cells, by rows, all as long.
        language: what the cells are read as.
        factor: what stands before the matrix, or ``""``.
    """

    rows: tuple[tuple[str, ...], ...]
    language: Language
    factor: str = ""

    @property
    def vector(self) -> bool:
        """Whether it is one row or one column."""
        return len(self.rows) == 1 or len(self.rows[0]) == 1


@dataclass(frozen=True, slots=True)
class Assigned:
    """What a text gives a name to: a matrix, or one cell.

    Attributes:
        name: the left side as it stands, or ``""``.
        matrix: the right side.
        listed: whether the right side is a matrix or list, rather than one formula.
    """

    name: str
    matrix: Written
    listed: bool


def is_latex(text: str) -> bool:
    """Whether a text is LaTeX, rather than a program or numbers."""
    return bool(re.search(r"\\[A-Za-z]|_\{|\$", text))


def written(text: str) -> tuple[Assigned, ...]:
    """All that a text assigns, in order; a text without a name is assigned to ``""``.

    Raises:
        InputError: it is too long, or a bracket or an environment has no end.
    """
    if len(text) > LONGEST:
        raise InputError("formula", f"the text is longer than {LONGEST} characters")
    for sign, plain in _SIGNS.items():
        text = text.replace(sign, plain)
    if is_latex(text):
        text = re.sub("[₀-₉₊₋]+", lambda m: "_{" + m[0].translate(_SUBSCRIPTS) + "}", text)
        for letter, name in _LETTERS.items():
            text = text.replace(letter, name + " ")
        text = _SHORT_FUNCTION.sub(lambda m: {"c": r"\cos ", "s": r"\sin "}[m[1]], text)
        return tuple(_latex(re.sub(r"(?<!\\)%.*", "", text).replace("$", " ")))
    text = re.sub("(\\w)\u0307", r"dot_\1", text.translate(_SUBSCRIPTS))
    return tuple(_plain(text))


# ------------------------------------------------------------------------------------------------ LaTeX


def _latex(text: str) -> Iterator[Assigned]:
    text = re.sub(r"\\(?:begin|end)\{(?:aligned|align\*?|equation\*?|displaymath)\}|\\\[(?!\d)|\\\]|\\[()]", " ", text)
    for formula in parts(text, r"\n\s*\n|;(?=\s*\\?[A-Za-z])|,\s*\\q?quad"):
        sides = list(parts(formula, r"(?<![<>!:])=|:=|\\coloneqq|\\equiv"))
        last = sides[-1].strip().rstrip(".,;").strip().removesuffix(r"\\").strip()
        if not last:
            continue
        name = next((side.strip().lstrip("&").strip() for side in sides[:-1] if side.strip()), "")
        yield _latex_side(name, last.lstrip("&").strip())


def _latex_side(name: str, side: str) -> Assigned:
    spans = _environments(side)
    if spans:
        if len(spans) > 1:
            raise InputError("formula", "a product or sum of matrices is not read: write the result", where=side[:60])
        (start, inner, stop, end) = spans[0]
        body = (
            re.sub(r"^\s*\{[^{}]*\}", "", side[inner:stop])
            if side[start:inner].endswith("array}")
            else side[inner:stop]
        )
        rows = [[cell.strip() for cell in parts(row, "&")] for row in parts(body, r"\\\\(?:\s*\[[^\]]*\])?|\\cr\b")]
        rows = [[re.sub(r"\\[hc]line(?:\{[^}]*\})?", "", cell).strip() for cell in row] for row in rows]
        rows = [row for row in rows if row != [""]]
        before = re.sub(r"\\left\s*[.\[({|]?$|\\[Bb]igg?l?\s*[\[({|]$|[\[({|]$", "", side[:start].strip()).strip()
        after = re.sub(r"^\\right\s*[.\])}|]?|^\\[Bb]igg?r?\s*[\])}|]|^[\])}|]", "", side[end:].strip()).strip()
        return Assigned(name, _checked(rows, "latex", before, after), True)
    plain = re.sub(r"\\left|\\right|\\[Bb]igg?[lr]?(?![A-Za-z])", "", side).strip()
    listed = _bracketed(plain, r",|;|\\\\")
    if listed is not None:
        cells, after = listed
        return Assigned(name, _checked([cells], "latex", "", after), True)
    return Assigned(name, Written(((side,),), "latex"), False)


def _environments(text: str) -> list[tuple[int, int, int, int]]:
    """The outermost matrices of a text: where each starts, its inside starts and stops, and it ends."""
    found: list[tuple[int, int, int, int]] = []
    depth, start, inner = 0, 0, 0
    for match in _ENVIRONMENT.finditer(text):
        if not _MATRICES.fullmatch(match[2]):
            continue
        if match[1] == "begin":
            if depth == 0:
                start, inner = match.start(), match.end()
            depth += 1
        else:
            depth -= 1
            if depth < 0:
                break
            if depth == 0:
                found.append((start, inner, match.start(), match.end()))
    if depth:
        raise InputError("formula", "a matrix has no end, or no beginning", where=text[:60])
    return found


# ---------------------------------------------------------------------------------------- Python, MATLAB


def _plain(text: str) -> Iterator[Assigned]:
    for statement in parts(re.sub(r"(?m)[#%].*$", "", text).replace("...\n", " "), r"\n|;"):
        line = statement.strip()
        if _PASSED.match(line):
            continue
        line = re.sub(r"^return\b\s*", "", line)
        assignment = re.match(r"([^\W\d]\w*(?:\^\w+)?)\s*(?::[^=]*)?=(?!=)\s*", line)
        name = assignment[1] if assignment else ""
        yield _plain_side(name, line[assignment.end() :] if assignment else line)


def _plain_side(name: str, side: str) -> Assigned:
    calls = 0
    while (call := _LIST.match(side)) and calls < 5:
        side, calls = side[call.end() :], calls + 1
    opening = side[:1]
    rest = ""
    if opening and opening in "[(":
        end = closing(side)
        rest = side[end + 1 :].strip()
        rest = re.sub(r"^(?:,\s*[a-z]+\s*=\s*[\w.]+\s*)?\)+", "", rest).strip() if calls else rest
        if opening == "[" or (calls and opening == "("):
            return Assigned(name, _grid(side[1:end], rest), True)
        if not rest and "," in side[1:end] and len(list(parts(side[1:end], ","))) > 1:
            return Assigned(name, _grid(side[1:end], rest), True)
    return Assigned(name, Written(((side,),), "plain"), False)


def _grid(inside: str, after: str) -> Written:
    """The cells between brackets, as Python nests them or as MATLAB parts them."""
    cells = [cell.strip() for cell in parts(inside, ",")]
    if cells and cells[-1] == "":
        cells.pop()
    if cells and all(cell[:1] in "[(" and cell[:1] and closing(cell) == len(cell) - 1 for cell in cells):
        rows = [[cell.strip() for cell in parts(row[1:-1], ",")] for row in cells]
        if any(row[0][:1] == "[" for row in rows if row):
            raise InputError("formula", "a matrix in a matrix is not read")
        return _checked([row[:-1] if row[-1] == "" else row for row in rows], "plain", "", after)
    lines = [line.strip() for line in parts(re.sub(r",\s*\n", ", ", inside), r";|\n") if line.strip()]
    found: list[list[str]] = []
    language: Language = "plain"
    for line in lines:
        row = [cell.strip() for cell in parts(line.rstrip(","), ",")]
        if len(row) == 1:
            row, language = _spaced(line), "matlab"
        found.append(row)
    return _checked(found, language, "", after)


def _spaced(line: str) -> list[str]:
    """The cells of a row between spaces, as MATLAB has them: in ``a -b`` there are two, in ``a - b`` one."""
    found, depth = [""], 0
    for i, c in enumerate(line):
        depth += (c in "([{") - (c in ")]}")
        if c.isspace() and depth == 0 and found[-1]:
            after = line[i : i + 50].lstrip()[:2]
            operator = after[:1] in "*/^.=" or (after[:1] in "+-" and after[1:].isspace())
            if not operator and found[-1][-1] not in "+-*/^(":
                found.append("")
        elif not c.isspace():
            found[-1] += c
    return found if found[-1] else found[:-1]


def _bracketed(text: str, separator: str) -> tuple[list[str], str] | None:
    """The cells of a list in brackets, and what follows it; None where it is none."""
    if text[:1] not in ("[", "("):
        return None
    end = closing(text)
    cells = [cell.strip() for cell in parts(text[1:end], separator)]
    after = text[end + 1 :].strip()
    listed = len(cells) > 1 and (not after or _TRANSPOSED.fullmatch(after))
    return (cells, after) if listed else None


# ------------------------------------------------------------------------------------------------ both


def _checked(rows: list[list[str]], language: Language, factor: str, after: str) -> Written:
    if not rows or len({len(row) for row in rows}) != 1 or not rows[0]:
        raise InputError("formula", "the rows of the matrix differ in length, or there are none")
    if len(rows) * len(rows[0]) > MOST_CELLS:
        raise InputError("formula", f"the matrix has more than {MOST_CELLS} entries")
    if after:
        if not _TRANSPOSED.fullmatch(after):
            raise InputError("formula", f"what follows the matrix is not read: {after[:60]!r}")
        rows = [list(column) for column in zip(*rows, strict=True)]
    return Written(tuple(map(tuple, rows)), language, factor)


def parts(text: str, separator: str) -> Iterator[str]:
    """What stands between separators that are in no bracket and no environment."""
    pattern = re.compile(rf"\\(?:begin|end)\{{[a-zA-Z]+\*?\}}|\\[{{}}|]|({separator})|[\[\](){{}}]")
    depth, last = 0, 0
    for match in pattern.finditer(text):
        found = match[0]
        if match[1] is not None:
            if depth == 0:
                yield text[last : match.start()]
                last = match.end()
        elif found.startswith(r"\begin") or found in "[({":
            depth += 1
        elif found.startswith(r"\end") or found in "])}":
            depth -= 1
    yield text[last:]


def closing(text: str) -> int:
    """Where the bracket ends with which a text begins.

    Raises:
        InputError: it has no end.
    """
    open_: list[str] = []
    for i, c in enumerate(text):
        if c in CLOSING:
            open_.append(CLOSING[c])
        elif c in "])}":
            if not open_ or open_.pop() != c:
                break
            if not open_:
                return i
    raise InputError("formula", "a bracket has no end", where=text[:60])
