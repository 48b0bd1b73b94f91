"""Where the elements of an expansion come from, and where in which macro an expansion failed.

Each element keeps the file and line that it was read from as DOM user data, which follows it into the copies that
xacro makes of macros' bodies. Where an expansion fails, the frames of xacro's own functions in the traceback tell
which element was being expanded, and by which calls.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path
from types import FrameType, TracebackType
from typing import Any, Final, TypeAlias
from xml.dom import expatbuilder, minidom

__all__ = ["Call", "Place", "Trace", "parse", "place_of", "places_below", "trace"]

Place: TypeAlias = tuple[str, int]
"""A file, as it was named, and a line in it."""

_KEY: Final = "pinscrew.place"


class _Carry:
    """Gives the copy of an element its place."""

    def handle(self, _operation: int, key: str, data: Place, _source: minidom.Node, copy: minidom.Node) -> None:
        copy.setUserData(key, data, self)


_CARRY: Final = _Carry()


class _Builder(expatbuilder.ExpatBuilderNS):
    """The builder behind `minidom.parse`, with the place of each element."""

    def __init__(self, file: str) -> None:
        super().__init__()
        self._file = file

    def start_element_handler(self, name: str, attributes: list[str]) -> None:
        super().start_element_handler(name, attributes)
        self.curNode.setUserData(_KEY, (self._file, self.getParser().CurrentLineNumber), _CARRY)


def parse(text: str, file: str | Path) -> minidom.Document:
    """The document that `minidom.parse` makes of a text, with the place of each element."""
    document: minidom.Document = _Builder(str(file)).parseFile(io.StringIO(text))
    return document


def place_of(node: minidom.Node | None) -> Place | None:
    """Where an element was read, or the one that a text or comment is in."""
    while node is not None and node.nodeType != minidom.Node.ELEMENT_NODE:
        node = node.parentNode
    place: Place | None = None if node is None else node.getUserData(_KEY)
    return place


def places_below(root: minidom.Element) -> list[Place]:
    """The places of an element and all below it, in the order of the document."""
    found: list[Place] = []
    pending: list[Any] = [root]
    while pending:
        node = pending.pop()
        if node.nodeType == minidom.Node.ELEMENT_NODE:
            found.append(place_of(node) or ("", 0))
            pending.extend(reversed(node.childNodes))
    return found


@dataclass(frozen=True, slots=True)
class Call:
    """The call of a macro, and its place."""

    macro: str
    place: Place | None


@dataclass(frozen=True, slots=True)
class Trace:
    """The element that was being expanded, and the calls of macros that led to it, the last one first."""

    place: Place | None
    calls: tuple[Call, ...]


def trace(error: BaseException) -> Trace:
    """Where in a xacro file an exception was raised, read off its traceback."""
    place: Place | None = None
    calls: list[Call] = []
    awaiting: FrameType | None = None  # a call whose macro's body is not yet being expanded
    traceback: TracebackType | None = error.__traceback__
    while traceback is not None:
        frame, traceback = traceback.tb_frame, traceback.tb_next
        if frame.f_globals.get("__name__") != "xacro":
            continue
        if frame.f_code.co_name == "handle_macro_call":
            awaiting = frame
        elif frame.f_code.co_name == "eval_all":
            values = frame.f_locals
            if awaiting is not None and values["symbols"] is awaiting.f_locals.get("scoped_symbols"):
                call = awaiting.f_locals
                calls.append(Call(call["m"].body.getAttribute("name"), place_of(call["node"])))
            awaiting = None
            place = place_of(values["node"]) or place
    return Trace(place, tuple(reversed(calls)))
