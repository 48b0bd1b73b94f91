r"""Text from files in generated source code: string literals, comments and identifiers; see `pinscrew.ground.escaping`.

A ``…_string`` function gives a whole literal, quotes and all, whose value is the text. A ``…_comment`` function gives
text for one line of a comment, in which what can't be seen, and what would end the comment or do something in it,
stands as Python's escape for it: ``*\x2f`` in C for what would end it.
"""

from __future__ import annotations

import keyword
import re
from itertools import groupby
from typing import Final, Literal

from pinscrew.ground.escaping import visible

__all__ = [
    "Language",
    "c_comment",
    "c_string",
    "identifier",
    "julia_comment",
    "julia_string",
    "matlab_comment",
    "matlab_string",
    "python_comment",
    "python_docstring",
    "python_string",
]

Language = Literal["python", "c", "matlab", "julia"]


def python_string(text: str) -> str:
    """A literal of Python: `repr`, which escapes all that is not printable (The Python Language Reference, §2.4.1)."""
    return repr(text)


def python_docstring(text: str) -> str:
    r"""Text on one line between ``\"\"\"``, of which Python reads the very text.

    Every backslash and quote is escaped: three quotes would end the string, ``\u2`` is a syntax error in it.
    """
    marked = text.replace("\\", r"\\").replace('"', r"\"")
    return visible(marked)


def python_comment(text: str) -> str:
    """Text after ``#``: on one line, and no declaration of an encoding.

    Python reads a file whose first or second line says ``coding: utf-7`` in that encoding, in which other text is
    code (PEP 263). That needs ``coding`` followed by a colon or an equals sign.
    """
    return _broken(r"(?<=coding)[:=]", visible(text))


_C_ESCAPES: Final = {"\\": r"\\", '"': r"\"", "?": r"\?"}


def c_string(text: str) -> str:
    r"""A literal of C, whose value is the text in UTF-8, and ends at a NUL in it.

    Source: ISO C11, §6.4.4.4 and §6.4.5. Bytes outside of ASCII's printable ones are octal, with three digits: hex
    escapes have no end. ``\?`` keeps ``??/`` from being a trigraph (§5.2.1.1).
    """
    return '"' + "".join(map(_c_byte, text.encode("utf-8", "surrogatepass"))) + '"'


def _c_byte(byte: int) -> str:
    character = chr(byte)
    return _C_ESCAPES.get(character, character if 32 <= byte < 127 else f"\\{byte:03o}")


def c_comment(text: str) -> str:
    """Text in a comment of C, of either kind.

    It neither ends it (``*/``) nor seems to open one, and no backslash, or trigraph of it, joins the next line to it
    (ISO C11, §5.1.1.2, phases 1 to 3).
    """
    return _broken(r"(?<=\*)/|(?<=/)[*/]|(?<=\?)\?|^/|\\$", visible(text))


def matlab_string(text: str) -> str:
    """A literal of MATLAB and Octave: characters between single quotes, or a bracket of such and of unseen ones.

    Source: MathWorks, "Text in String and Character Arrays": a quote is doubled, and no backslash means anything.
    A line break can't stand between quotes, so unseen characters are numbers, of 16 bits each as in MATLAB.
    """
    pieces = []
    for seen, characters in groupby(text, str.isprintable):
        run = "".join(characters)
        pieces.append("'" + run.replace("'", "''") + "'" if seen else f"char([{_units(run)}])")
    if len(pieces) == 1 or not pieces:
        return "".join(pieces) or "''"
    return f"[{', '.join(pieces)}]"


def _units(text: str) -> str:
    data = text.encode("utf-16-le", "surrogatepass")
    return " ".join(str(int.from_bytes(data[i : i + 2], "little")) for i in range(0, len(data), 2))


def matlab_comment(text: str) -> str:
    """Text after ``%``: on one line, and no ``%{`` or ``%}``, which open and close a block of comments."""
    return _broken(r"^\s*[{}%]|\.\.\.$", visible(text))


def julia_string(text: str) -> str:
    r"""A literal of Julia. A dollar would interpolate code: ``"$(run(`rm`))"`` runs it.

    Source: The Julia Language, manual, "Strings". ``\U`` with all of its eight digits, so that none that follows is
    taken for one. Lone surrogates, which Julia's literals refuse, become U+FFFD.
    """
    return '"' + "".join(map(_julia_character, text)) + '"'


def _julia_character(character: str) -> str:
    if character in '\\"$':
        return f"\\{character}"
    if character.isprintable():
        return character
    return "\ufffd" if "\ud800" <= character <= "\udfff" else rf"\U{ord(character):08x}"


def julia_comment(text: str) -> str:
    """Text after ``#``: on one line, and no ``#=`` or ``=#``, which open and close a block of comments."""
    return _broken(r"^=|(?<=#)=|(?<==)#", visible(text))


def _broken(pattern: str, text: str) -> str:
    """The text with the last of the characters that each match of a pattern has as its escape."""
    return re.sub(pattern, lambda match: match[0][:-1] + rf"\x{ord(match[0][-1]):02x}", text)


_MATLAB_WORDS: Final = (
    "break case catch classdef continue else elseif end for function global if otherwise parfor persistent return spmd "
    "switch try while"
)
_C_WORDS: Final = (
    "auto break case char const continue default do double else enum extern float for goto if inline int long register "
    "restrict return short signed sizeof static struct switch typedef union unsigned void volatile while"
)
_JULIA_WORDS: Final = (
    "abstract baremodule begin break catch const continue do else elseif end export false finally for function global "
    "if import in isa let local macro module mutable primitive quote return struct true try type using where while"
)
_WORDS: Final[dict[Language, frozenset[str]]] = {
    "python": frozenset((*keyword.kwlist, *keyword.softkwlist)),
    "c": frozenset(_C_WORDS.split()),
    "matlab": frozenset(_MATLAB_WORDS.split()),
    "julia": frozenset(_JULIA_WORDS.split()),
}
_LONGEST: Final = 63
"""Characters that tell identifiers apart in C (ISO C11, §5.2.4.1) and MATLAB (``namelengthmax``)."""


def identifier(text: str, language: Language) -> str:
    """An identifier made of a name: ASCII letters, digits and underscores as they are, an underscore for each other.

    Different names may become one; whoever declares several has to see to that. It begins with a letter, which
    MATLAB wants and C keeps for us (§7.1.3 reserves underscores), and is no word of the language.
    """
    plain = re.sub(r"[^A-Za-z0-9_]", "_", text)[:_LONGEST]
    if not re.match("[A-Za-z]", plain):
        plain = f"x{plain}"[:_LONGEST]
    return f"{plain}_" if plain in _WORDS[language] else plain
