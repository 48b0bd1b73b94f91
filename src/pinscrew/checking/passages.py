r"""What stands in a file of answers: its formulas and statements in order, each below its heading, at its line.

Markdown has formulas between dollars and code between fences, LaTeX has environments, a notebook has cells, and a
program is statements all through. JSON has quantities by name. Nothing is run, and no macro of LaTeX is expanded.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

from pinscrew.checking.texts import closing, is_latex, parts
from pinscrew.ground.errors import InputError

__all__ = ["SUFFIXES", "Passage", "passages"]

SUFFIXES: Final = (".md", ".markdown", ".tex", ".py", ".m", ".ipynb", ".json", ".txt")
"""Of the files that are read."""
MOST: Final = 2000
"""Formulas and statements of a file."""
_DISPLAYS: Final = "equation|align|alignat|gather|displaymath|eqnarray|multline|math|flalign"
_FORMULA: Final = (
    r"(?P<open>\$\$|(?<!\\)\\\[|(?<!\\)\\\(|(?<!\\)\$|\\fitted\{"
    rf"|\\begin\{{(?:{_DISPLAYS})\*?\}})"
)
_MARKDOWN: Final = re.compile(
    rf"^#{{1,6}}[ \t]+(?P<heading>.*)$|^[ \t]*(?P<fence>```+|~~~+)[ \t]*(?P<language>[\w+-]*).*$|{_FORMULA}",
    re.MULTILINE,
)
_LATEX: Final = re.compile(
    rf"\\(?:sub){{0,2}}(?:section|paragraph|question|part)\*?\s*\{{(?P<heading>[^{{}}]*)\}}|{_FORMULA}"
)
_CLOSES: Final = {"$$": "$$", r"\[": r"\]", r"\(": r"\)", "$": "$", r"\fitted{": "}\n"}
_NOTES: Final = re.compile(
    r"\\(?:label|tag)\*?\s*\{[^{}]*\}|\\(?:nonumber|notag)\b|\\(?:begin|end)\{(?:aligned|split|gathered)\}"
)
_ROW: Final = r"\\\\(?:\s*\[[^\]]*\])?"
_LEFT_SIDE: Final = re.compile(r"[\s&]*[^\s&=][^=]*?=")
_DEFINES: Final = re.compile(r"(?:def\s+(\w+)\s*\(|function\s+(?:\[?\s*(\w+)\s*\]?\s*=\s*)?(\w+))")


@dataclass(frozen=True, slots=True)
class Passage:
    """One formula or statement.

    Attributes:
        text: as it stands.
        heading: what it stands below: the nearest heading, or the function that returns it; or ``""``.
        line: where it begins, from 1; 0 where lines mean nothing, as in JSON.
        value: what stands in JSON in the place of a text.
    """

    text: str
    heading: str = ""
    line: int = 0
    value: Any = None


def passages(text: str, suffix: str) -> list[Passage]:
    """The formulas and statements of a file.

    Args:
        text: its content.
        suffix: of its name, one of `SUFFIXES`; a ``.txt`` is taken for what it looks like.

    Raises:
        InputError: files of that kind are not read, it is no JSON, or has more than `MOST`.
    """
    readers = {".md": _markdown, ".markdown": _markdown, ".tex": _latex, ".py": _program, ".m": _program}
    readers |= {".ipynb": _notebook, ".json": _json, ".txt": _latex if is_latex(text) else _program}
    if suffix not in readers:
        raise InputError("check-file", f"a file {suffix or 'without a suffix'} is not read", remedy=_READ)
    found = []
    for passage in readers[suffix](text):
        found.append(passage)
        if len(found) > MOST:
            raise InputError("check-file", f"there are more than {MOST} formulas", remedy="give the results alone")
    return found


_READ: Final = f"give one of {', '.join(SUFFIXES)}"


def _markdown(text: str) -> Iterator[Passage]:
    yield from _formulas(text, _MARKDOWN)


def _latex(text: str) -> Iterator[Passage]:
    yield from _formulas(re.sub(r"(?<!\\)%.*", "", text), _LATEX)


def _formulas(text: str, pattern: re.Pattern[str]) -> Iterator[Passage]:
    """What is between the marks of formulas, and in fences; a mark without its end is none."""
    heading, at, endless = "", 0, set()
    lines = _Lines(text)
    while match := pattern.search(text, at):
        at = match.end()
        groups = match.groupdict()
        if groups["heading"] is not None:
            heading = groups["heading"].strip()
            continue
        opening = groups["open"] or "\n" + groups["fence"]
        close = _CLOSES.get(opening, opening.replace("begin", "end"))
        end = -1 if opening in endless else text.find(close, at)
        if end < 0:
            endless.add(opening)
            continue
        inside, line, at = text[match.end() : end], lines.number(match.start()), end + len(close)
        if groups["open"] or groups["language"].lower() in ("math", "latex", "tex"):
            yield from (Passage(formula, heading, line) for formula in _equations(inside))
        elif groups["language"].lower() in ("", "python", "py", "matlab", "octave", "m"):
            yield from _program(inside, heading, line)


class _Lines:
    """Numbers of lines, asked for in order."""

    def __init__(self, text: str) -> None:
        self._text, self._at, self._line = text, 0, 1

    def number(self, at: int) -> int:
        self._line += self._text.count("\n", self._at, at)
        self._at = at
        return self._line


def _equations(text: str) -> Iterator[str]:
    """The equations of a display: a line that begins with a left side of its own begins another."""
    text = _unboxed(_NOTES.sub(" ", text).strip())
    found: list[str] = []
    for line in parts(text, _ROW):
        if found and not _LEFT_SIDE.match(line):
            found[-1] += " " + line
        elif line.strip():
            found.append(line)
    yield from found


def _unboxed(text: str) -> str:
    inside = text.removeprefix(r"\boxed").lstrip()
    if inside == text or not inside.startswith("{"):
        return text
    try:
        end = closing(inside)
    except InputError:  # the reader of formulas says so
        return text
    return inside[1:end] if not inside[end + 1 :].strip(" .,;") else text


def _program(text: str, heading: str = "", line: int = 1) -> Iterator[Passage]:
    """The statements of a program; what a function returns stands below the function's name."""
    text = re.sub(r"(?m)[#%].*$", "", text)
    at, result, lines = 0, "", _Lines(text)
    for statement in parts(text, r"\n|;"):
        words = statement.replace("...\n", " ").strip()
        defined = _DEFINES.match(words)
        if defined:
            heading, result = defined[1] or defined[3], defined[2] or ""
        elif words:
            number = line - 1 + lines.number(at + len(statement) - len(statement.lstrip()))
            yield Passage(re.sub(rf"^{result}\s*=(?!=)", "", words) if result else words, heading, number)
        at += len(statement) + 1


def _notebook(text: str) -> Iterator[Passage]:
    document = _parsed(text)
    heading = ""
    cells = document.get("cells") if isinstance(document, dict) else None
    if not isinstance(cells, list):
        raise InputError("check-file", "this is no notebook: it has no list of cells")
    for cell in cells:
        source = cell.get("source", "") if isinstance(cell, dict) else ""
        source = "".join(map(str, source)) if isinstance(source, list) else str(source)
        code = isinstance(cell, dict) and cell.get("cell_type") == "code"
        for passage in _program(source, heading) if code else _formulas(source, _MARKDOWN):
            yield Passage(passage.text, passage.heading or heading)
        if not code:
            titles = [match["heading"].strip() for match in _MARKDOWN.finditer(source) if match["heading"]]
            heading = titles[-1] if titles else heading


def _json(text: str) -> Iterator[Passage]:
    """Quantities by name, or what `check` writes itself: a list of ``quantity`` and ``given``."""
    document = _parsed(text)
    answers = document.get("answers", document) if isinstance(document, dict) else document
    if isinstance(answers, list) and all(isinstance(each, dict) and "quantity" in each for each in answers):
        answers = {str(each["quantity"]): each.get("given", each.get("answer")) for each in answers}
    if not isinstance(answers, dict):
        raise InputError("check-file", "this JSON has no answers", remedy='write {"Js": [["0", …], …], …}')
    for name, value in answers.items():
        if isinstance(value, (str, list, int, float)):
            yield Passage(value if isinstance(value, str) else "", str(name), value=value)


def _parsed(text: str) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        reason = "it is nested too deeply" if isinstance(error, RecursionError) else str(error)
        raise InputError("check-file", f"this is no JSON: {reason}") from None
