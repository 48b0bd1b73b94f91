r"""Text that comes from files, names above all, made safe for the format it is written to: one function for each.

A name in a URDF may hold anything that XML can: quotes, tags, line breaks, dollars, characters that turn the
direction of writing or that a terminal obeys. Whoever writes a name into an output calls the function of that format
here, once, at the place where it writes; nobody else escapes.

There are two kinds. In *data* (HTML, XML, JSON, CSV, string literals) a reader of the format gets the very name back.
In what is for *reading* (terminals, Markdown, LaTeX, comments in code) what can't be seen, or would not be text, stands
as Python's escape for it: a line break as ``\n``, an override of the direction of writing as ``\u202e`` (`visible`).

===========================  =================================================================================
format                       function
===========================  =================================================================================
HTML: text, attribute        `html`
XML, SVG, MathML             `xml`; `xml_characters` for writers such as ElementTree that know the rest; `mathml`;
                             `xml_document` for a whole file on a terminal
JSON, SARIF                  `json_text`; `json_in_script` inside a ``<script>``; `sarif_message`
Markdown: text, cell, title  `markdown`
LaTeX: text                  `latex`
matplotlib                   `plot`
CSV                          `csv_row`
GitHub's workflow commands   `github_data`, `github_property`
terminal                     `terminal`
source code                  `pinscrew.ground.escaping_code`
===========================  =================================================================================
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from typing import Any, Final

__all__ = [
    "csv_row",
    "github_data",
    "github_property",
    "html",
    "json_in_script",
    "json_text",
    "latex",
    "markdown",
    "mathml",
    "plot",
    "sarif_message",
    "terminal",
    "visible",
    "xml",
    "xml_characters",
    "xml_document",
]

_NOT_XML: Final = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""What XML 1.0 (§2.2, production [2] ``Char``) has no way to write, not even as a reference."""

_COMMAND: Final = re.compile(r"^(?=\s*::)(\s*):|#(?=#\w*\[)")
"""What a runner of CI would obey when it reads it in a log.

``::name`` at the start of a line and ``##[name]`` anywhere are GitHub's (`ActionCommand.TryParseV2`, `TryParse` of
actions/runner), ``##vso[…]`` is Azure's, ``##teamcity[…]`` TeamCity's.
"""

_OBEYED: Final = re.compile("[\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb]")
"""Controls and directions of writing that a terminal or an editor obeys."""


def visible(text: str) -> str:
    r"""The text with what can't be seen as Python's escapes: ``a\nb`` for a line break between a and b.

    These are the characters that `str.isprintable` names: controls (C0, C1), formats (directions of writing,
    U+202A to U+202E and U+2066 to U+2069, and characters without width), lone surrogates, separators but the space,
    and what Unicode has not assigned. A backslash stays as it is, so that a path is read as it is written.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else _escaped(c) for c in text)


def _escaped(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")


def terminal(text: str) -> str:
    """Text for a terminal or a log: `visible`, and nothing that a runner of CI takes for a command.

    Source: ECMA-48 (controls are C0, and C1 from U+0080 to U+009F: U+009B begins a sequence as ESC [ does); Unicode
    Technical Report 36, §3.2 (directions of writing).
    """
    return _COMMAND.sub(lambda match: match[0][:-1] + rf"\x{ord(match[0][-1]):02x}", visible(text))


def html(text: str) -> str:
    """Text in HTML, in an element or between quotes in an attribute; not for a script, a style or a URL.

    Source: WHATWG HTML, §13.1.2 (text and attributes have no ``<``, ``&`` and, between them, quotes) and §13.2.3.5 (a
    CR would be read as a LF). NUL has no reference, and a lone surrogate no bytes: both become U+FFFD.
    """
    return _referring(re.sub("[\0\ud800-\udfff]", "\ufffd", text))


def xml(text: str) -> str:
    """Text in XML, SVG among it, in an element or between quotes in an attribute; see `xml_characters`.

    Source: XML 1.0, §2.4 (markup), §2.11 (a CR would be read as a LF) and §3.3.3 (line breaks and tabs in attributes
    as spaces).
    """
    return _referring(xml_characters(text)).replace("\n", "&#10;").replace("\t", "&#9;")


def _referring(text: str) -> str:
    for character, reference in _REFERENCES:
        text = text.replace(character, reference)
    return text


_REFERENCES: Final = (
    ("&", "&amp;"),
    ("<", "&lt;"),
    (">", "&gt;"),
    ('"', "&quot;"),
    ("'", "&#39;"),
    ("\r", "&#13;"),
)


def xml_document(text: str) -> str:
    """A whole document of XML for a terminal or a log, of which a parser reads the same: see `terminal`.

    References stand for what a terminal or a runner of CI would obey; comments have none, but are no data either.
    """
    lines = _OBEYED.sub(lambda match: f"&#{ord(match[0])};", text).split("\n")
    return "\n".join(_COMMAND.sub(lambda match: f"{match[0][:-1]}&#{ord(match[0][-1])};", line) for line in lines)


def mathml(text: str) -> str:
    """Text in MathML within HTML: both read it, so it is XML's rules that hold."""
    return xml(text)


def xml_characters(text: str) -> str:
    """Text with U+FFFD for what XML has no way to write, for writers that know all else (ElementTree: JUnit)."""
    return _NOT_XML.sub("\ufffd", text)


_UNSEEN: Final = re.compile(f"{_OBEYED.pattern}|[\ud800-\udfff]|#(?=#\\w*\\[)")


def json_text(value: Any, indent: int | None = 2) -> str:
    r"""A value as JSON: letters as they are, as ``\uXXXX`` what a terminal or an editor would obey, or has no bytes.

    A reader of JSON gets the value itself. Source: RFC 8259, §7; it wants escapes for C0, quotes and backslashes
    only, so C1 controls, directions of writing and lone surrogates are added here.

    Args:
        value: plain data.
        indent: spaces of each level, or None for all on one line without spaces.

    Raises:
        ValueError: if a number is NaN or infinite; JSON has neither.
    """
    separators = (",", ":") if indent is None else (",", ": ")
    text = json.dumps(value, indent=indent, ensure_ascii=False, allow_nan=False, separators=separators)
    return _UNSEEN.sub(_unicode, text)  # all of these stand inside strings: JSON's own marks are ASCII


def json_in_script(value: Any) -> str:
    """A value as JSON on one line that may stand inside ``<script>``: no ``<`` ends the element or opens a comment.

    Source: WHATWG HTML, §4.12.1.3 (``<!--``, ``<script`` and ``</script`` in scripts); ``>`` and ``&`` for XHTML.
    """
    return re.sub("[<>&]", _unicode, json_text(value, None))


def _unicode(match: re.Match[str]) -> str:
    return rf"\u{ord(match[0]):04x}"


def sarif_message(text: str) -> str:
    """The text of a message in SARIF, without what would be a link or a placeholder there; JSON is to follow.

    Source: SARIF 2.1.0, §3.11.5 (placeholders ``{0}``, braces doubled) and §3.11.6 (links ``[text](destination)``,
    brackets after a backslash).
    """
    text = re.sub(r"\{(\d+)\}", r"{{\1}}", visible(text))
    return re.sub(r"\[(?=[^\[\]]*\]\()", r"\\[", text)


_MARKDOWN: Final = re.compile(r"[\\`*_{}\[\]<>#|~&^]|:(?=//)|(?<=www)\.", re.IGNORECASE)
_OPENING: Final = re.compile(r"([-+=:])|(\d{1,9})(?=[.)](?:\s|$))")


def markdown(text: str) -> str:
    """Plain text in Markdown, on one line: in a paragraph, a heading, an item of a list or a cell of a table.

    A backslash before a mark makes it plain (CommonMark 0.31, §2.4). What would open a list or a heading's underline
    at the start of a line is marked too (§4.3, §5.2), and a bare address is made none (GFM 0.29, §6.9). A dollar
    stands in an element of its own, which GitHub's documentation advises, since ``\\$`` may still begin a formula.
    Spaces at the ends, four of which would be a code block (§4.4), are references.
    """
    text = _MARKDOWN.sub(r"\\\g<0>", visible(text)).replace("$", "<span>$</span>")
    opening = _OPENING.match(text)
    if opening:
        text = f"{opening[2]}\\{text[opening.end() :]}" if opening[2] else f"\\{text}"
    if text.startswith(" "):
        text = f"&#32;{text[1:]}"
    return f"{text[:-1]}&#32;" if text.endswith(" ") else text


_LATEX: Final = {
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    "`": r"\textasciigrave{}",
    '"': r"\symbol{34}",
    **{character: f"\\{character}" for character in "{}$&#_%"},
}


def latex(text: str) -> str:
    r"""Plain text for LaTeX's text mode; in a formula it goes inside ``\text{…}``.

    The ten characters that TeX gives a meaning (The TeXbook, chapter 7; Lamport, "LaTeX", §2.1), and those that the
    old encoding OT1 sets as others. No braces, backslash or ``^^`` of the text reach TeX, so no ``\input`` or
    ``\write18`` does. Two hyphens do not join into a dash. Letters are the document's: it loads what they need.
    """
    return "".join(_LATEX.get(c, c) for c in visible(text)).replace("--", "-{}-").replace("--", "-{}-")


def plot(text: str) -> str:
    r"""Text in a figure of matplotlib, which sets what is between two dollars as a formula (and fails if it is none).

    Source: matplotlib, "Writing mathematical expressions": ``\$`` is a dollar. Its SVG writer escapes the rest. What is
    longer than `LONGEST_IN_A_PLOT` is shown by both its ends: a figure has no line breaks, and its layout no end.
    """
    if len(text) > LONGEST_IN_A_PLOT:
        text = f"{text[: LONGEST_IN_A_PLOT // 2]}…{text[-LONGEST_IN_A_PLOT // 2 :]}"
    return visible(text).replace("$", r"\$")


LONGEST_IN_A_PLOT: Final = 60


_FORMULA: Final = re.compile("'*[=+\\-@\t\r\n＝＋－＠]")


def csv_row(cells: Iterable[object]) -> str:
    """A row of CSV, without its line break: texts and numbers, the latter as Python writes them.

    Source: RFC 4180, §2 (quotes around what has commas, quotes or line breaks, quotes doubled); OWASP, "CSV
    Injection" (``'`` before what a spreadsheet would take for a formula). Each text that begins with any number of
    ``'`` and then a formula's mark gets one ``'`` more, so that a reader who takes one away has the text back.
    """
    return ",".join(_cell(cell) if isinstance(cell, str) else str(cell) for cell in cells)


def _cell(text: str) -> str:
    text = f"'{text}" if _FORMULA.match(text) else text
    if text and text == text.strip() and not re.search('[",\r\n]|::|##', text):
        return text
    return '"' + text.replace('"', '""') + '"'


def github_data(text: str) -> str:
    """What a workflow command of GitHub says, after its last ``::``.

    Source: GitHub, "Workflow commands for GitHub Actions"; the escapes are ``escapeData`` of actions/toolkit. Other
    characters that can't be seen are shown, since a log goes to terminals.
    """
    lines = re.split("([\r\n])", text.replace("%", "%25"))
    return "".join({"\r": "%0D", "\n": "%0A"}.get(part) or visible(part) for part in lines)


def github_property(text: str) -> str:
    """The value of a property of a workflow command: ``escapeProperty``, which adds what separates properties."""
    return github_data(text).replace(":", "%3A").replace(",", "%2C")
