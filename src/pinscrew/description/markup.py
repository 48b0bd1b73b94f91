"""From bytes to elements with line numbers, and nothing that could hurt: no entities, no other encodings.

expat without namespace processing sees tags as tinyxml2 (and so Pinocchio) does: ``<a:link>`` is an element of
an extension, whatever ``a`` is bound to, and a default ``xmlns`` changes no name.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, NoReturn, TypeAlias
from xml.parsers import expat

from pinscrew.ground.errors import DescriptionError
from pinscrew.ground.files import open_plain

__all__ = ["MAX_BYTES", "Element", "Place", "decode", "parse", "read"]

Place: TypeAlias = tuple[str, int]
"""A file, as it was named, and a line in it."""

MAX_BYTES: Final = 20 * 2**20
"""Largest file that is read."""
MAX_ELEMENTS: Final = 250_000
"""Most elements that a file may have: five million ``<a/>`` would take 20 MB as text and 1.3 GB as elements."""
MAX_ATTRIBUTES: Final = 1_000
"""Most attributes of an element: tinyxml2 (in Pinocchio) takes time that grows with their square."""
MAX_VALUE: Final = 100_000
"""Most characters of an attribute's value: lxml (in yourdfpy) does not read ten million."""

_MISPLACED: Final = expat.errors.codes[expat.errors.XML_ERROR_MISPLACED_XML_PI]
_BOM: Final = b"\xef\xbb\xbf"
_DECLARED: Final = re.compile(rb"""<\?xml[^>]*?\bencoding\s*=\s*["']([^"']*)["']""")


@dataclass(slots=True)
class Element:
    """An XML element: tag, attributes, child elements, the text before these, and the line of ``file`` it starts on."""

    tag: str
    attributes: dict[str, str]
    line: int
    children: list[Element] = field(default_factory=list)
    text: str = ""
    file: str = ""

    def all(self, tag: str) -> Iterator[Element]:
        """The direct children with this tag."""
        return (child for child in self.children if child.tag == tag)


def read(path: Path) -> str:
    """The text of a file of at most ``MAX_BYTES``.

    Raises:
        DescriptionError: if it can't be read, is no plain file (a pipe may never end), is too large, or is not UTF-8.
    """
    try:
        with open_plain(path) as stream:
            data = stream.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise DescriptionError("no-file", "there is no such file", file=path) from None
    except (OSError, ValueError) as error:  # ValueError: a NUL character in the path
        reason = getattr(error, "strerror", None) or str(error)
        raise DescriptionError("unreadable", f"can't be read ({reason})", file=path) from None
    return decode(data, path)


def decode(data: bytes, file: str | Path) -> str:
    """UTF-8 bytes, with or without a byte order mark, as text.

    Raises:
        DescriptionError: if they are more than ``MAX_BYTES``, not UTF-8, or declare another encoding.
    """
    if len(data) > MAX_BYTES:
        raise DescriptionError("too-large", f"larger than {MAX_BYTES // 2**20} MB", file=file)
    remedy = "save the file as UTF-8"
    declared = _DECLARED.match(data.removeprefix(_BOM))
    if declared and declared[1].lower() not in (b"utf-8", b"utf8", b"us-ascii", b"ascii"):
        what = f"declares the encoding {declared[1].decode('ascii', 'replace')!r}"
        raise DescriptionError("encoding", what, file=file, line=1, remedy=remedy)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise DescriptionError("encoding", "not UTF-8", file=file, line=line, remedy=remedy) from None
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        raise DescriptionError("encoding", "holds a NUL character", file=file, line=line, remedy=remedy)
    return text


def parse(text: str, file: str | Path, places: Sequence[Place] = ()) -> Element:
    """The root element of an XML text.

    Args:
        text: the text.
        file: what to call it in messages.
        places: where its elements come from, in the order of the document, if the text is the expansion of the file.

    Raises:
        DescriptionError: if the text is not well-formed, or has a DOCTYPE.
    """
    parser = expat.ParserCreate("utf-8")
    open_elements: list[Element] = []
    roots: list[Element] = []
    pieces: list[str] = []  # of text: adding each to what is there would take time that grows with the square
    count = itertools.count(1)
    name = str(file)

    def start(tag: str, attributes: dict[str, str]) -> None:
        number = next(count)
        for size, most, of_what in (
            (number, MAX_ELEMENTS, "elements"),
            (len(attributes), MAX_ATTRIBUTES, "attributes of an element"),
            (max(map(len, attributes.values()), default=0), MAX_VALUE, "characters in an attribute"),
        ):
            if size > most:
                what = f"more than {most} {of_what}"
                raise DescriptionError("too-large", what, file=file, line=parser.CurrentLineNumber)
        keep_text()
        place = places[number - 1] if places else (name, parser.CurrentLineNumber)
        element = Element(tag, attributes, place[1], file=place[0])
        (open_elements[-1].children if open_elements else roots).append(element)
        open_elements.append(element)

    def end(_tag: str) -> None:
        keep_text()
        open_elements.pop()

    def keep_text() -> None:
        if open_elements and not open_elements[-1].children:
            open_elements[-1].text = "".join(pieces)
        pieces.clear()

    def doctype(*_: object) -> NoReturn:
        raise DescriptionError(
            "doctype",
            "has a DOCTYPE, which URDF does not use and which can define entities",
            file=file,
            line=parser.CurrentLineNumber,
            remedy="remove it",
        )

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = pieces.append
    parser.StartDoctypeDeclHandler = doctype
    parser.buffer_text = True
    try:
        # The text is encoded anew, so a declared "ascii" must not make expat refuse what decode() accepted.
        parser.Parse(text.encode(), True)
    except expat.ExpatError as error:
        what = f"not well-formed XML ({expat.ErrorString(error.code)})"
        if places:
            what += f" on line {error.lineno} of its expansion"
            raise DescriptionError("not-xml", what, file=file) from None
        remedy = f"delete what stands before <?xml on line {error.lineno}" if error.code == _MISPLACED else ""
        raise DescriptionError("not-xml", what, file=file, line=error.lineno, remedy=remedy) from None
    return roots[0]
