"""The child process of `expand`: reads a request from standard input, answers on standard output, as JSON.

It runs as a script and imports nothing of pinscrew, so that it starts fast and holds nothing worth taking.
"""

from __future__ import annotations

import sys

if __name__ == "__main__":
    del sys.path[0]  # this script's folder, whose modules must not shadow anyone's

import contextlib
import io
import json
import re
from typing import Any
from xml.dom import minidom

import xacro


class _RefusedError(Exception):
    def __init__(self, code: str, what: str, remedy: str = "") -> None:
        super().__init__(what)
        self.code = code
        self.remedy = remedy


def _declared(files: list[str]) -> dict[str, None]:
    """The names of the arguments that these files declare, in order."""
    names: dict[str, None] = {}
    for file in files:
        for element in minidom.parse(file).getElementsByTagName("xacro:arg"):  # noqa: S318 (already parsed once)
            names[element.getAttribute("name")] = None
    return names


def _expand(file: str, arguments: dict[str, str]) -> str:
    document = xacro.process_file(file, mappings=dict(arguments))
    included = [name for name in xacro.all_includes if name.endswith((".xacro", ".urdf", ".xml"))]
    declared = _declared([file, *included])
    for name in arguments:
        if name not in declared:
            known = ", ".join(declared) or "none"
            raise _RefusedError("xacro-argument", f"declares no argument {name!r}", f"declared are: {known}")
    text: str = document.toprettyxml(indent="  ")
    return text


def _one_line(text: str) -> str:
    return re.sub(r"\s+", " ", re.sub(r"\x1b\[[0-9;]*m", "", text)).strip()


def main() -> None:
    """Answer one request."""
    request = json.load(sys.stdin)
    answer: dict[str, Any] = {}
    said = io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
        try:
            answer["text"] = _expand(request["file"], request["arguments"])
        except _RefusedError as error:
            answer.update(error=str(error), code=error.code, remedy=error.remedy)
        except RecursionError:
            answer.update(error="includes or expands itself without end", code="xacro-limit")
        except Exception as error:
            answer.update(error=_one_line(str(error)) or type(error).__name__, code="xacro")
    answer["warnings"] = [line for line in map(_one_line, said.getvalue().splitlines()) if line]
    json.dump(answer, sys.stdout)


if __name__ == "__main__":
    main()
