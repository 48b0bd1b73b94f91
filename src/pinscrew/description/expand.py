"""xacro files to URDF text, in a child process: a macro language evaluates what the file says."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from xml.parsers import expat

from pinscrew.description.markup import Place
from pinscrew.description.packages import Packages
from pinscrew.ground.errors import DescriptionError, PinscrewWarning, XacroError
from pinscrew.ground.words import brief, one_line

__all__ = ["MEMORY", "SECONDS", "Expansion", "ask", "expand", "expansion", "is_xacro", "text_is_xacro", "with_sources"]

SECONDS: Final = 8
"""Processor time that an expansion may take."""
PATIENCE: Final = 10
"""On the clock it may take so many times as long: the machine may be busy with other things."""
MEMORY: Final = 2**30
"""Bytes that its process may address."""

_WORKER: Final = Path(__file__).with_name("_xacro_worker.py")
# A file with neither is no xacro; one with both may be, and is looked at more closely.
_NAMESPACE: Final = re.compile(r"""<robot\b[^>]*\bxmlns:xacro\s*=""")
_MACRO: Final = re.compile(r"<xacro:\w|[\"'][^<\"']*\$[({]")
_COMMENT: Final = re.compile(r"<!--.*?-->", re.DOTALL)


@dataclass(frozen=True, slots=True)
class Expansion:
    """What a xacro file stands for.

    Attributes:
        text: the URDF.
        places: file and line that each of its elements comes from, in the order of the document.
    """

    text: str
    places: tuple[Place, ...]


def with_sources(expansion: Expansion) -> str:
    """The text of an expansion, with a comment before each link and joint that says where it comes from.

    Elements that stand on a line with others get none, so that no text changes its meaning.
    """
    if not expansion.places:
        return expansion.text
    lines = expansion.text.split("\n")
    parser = expat.ParserCreate("utf-8")
    places = iter(expansion.places)
    comments: dict[int, str] = {}

    def start(tag: str, _attributes: dict[str, str]) -> None:
        file, line = next(places)
        at, column = parser.CurrentLineNumber - 1, parser.CurrentColumnNumber
        if tag in ("link", "joint") and not lines[at][:column].strip():
            source = f"{file}:{line}".replace("--", "- -")  # which no comment may have
            comments[at] = f"{lines[at][:column]}<!-- {source} -->"

    parser.StartElementHandler = start
    parser.Parse(expansion.text.encode(), True)
    told = ([comments[at], line] if at in comments else [line] for at, line in enumerate(lines))
    return "\n".join(text for pair in told for text in pair)


def is_xacro(path: Path) -> bool:
    """Whether a file is to be expanded first, by its name."""
    return path.suffix == ".xacro"


def text_is_xacro(text: str) -> bool:
    """Whether a text is to be expanded first, by its content: it declares xacro's namespace, and uses it."""
    if "xmlns:xacro" not in text:  # most files, and at once
        return False
    plain = _COMMENT.sub("", text)
    return bool(_NAMESPACE.search(plain) and _MACRO.search(plain))


def expand(path: Path, arguments: Mapping[str, str], packages: Packages | None = None) -> str:
    """The URDF that a xacro file stands for; see `expansion`."""
    return expansion(path, arguments, packages).text


def expansion(path: Path, arguments: Mapping[str, str], packages: Packages | None = None) -> Expansion:
    """The URDF that a xacro file stands for, and where its elements come from.

    Args:
        path: the file.
        arguments: values of its ``<xacro:arg>``s, and of others that it uses; those not given keep their defaults.
        packages: what ``$(find …)`` finds and which folders may be read; by default those of the environment.

    Raises:
        XacroError: if arguments are missing or unknown, an expression goes beyond arithmetic, a file outside the roots
            is asked for, or the expansion fails, takes more than `SECONDS` of processor time or more than `MEMORY`.
    """
    packages = packages or Packages(path)
    request = {
        "file": str(path),
        "arguments": dict(arguments),
        "packages": {name: str(root.resolve()) for name, root in packages.declared.items()},
        "allow_outside": packages.allow_outside,
    }

    def ended(what: str, remedy: str) -> XacroError:
        remedy = remedy or "look for endless macros and huge numbers"
        return XacroError("xacro-limit", f"its expansion takes {what}", file=path, remedy=remedy)

    def failed(words: str) -> XacroError:
        return XacroError("xacro", f"its expansion failed: {words}", file=path)

    answer = ask(_WORKER, request, ended, failed)
    for message in answer["warnings"]:
        warnings.warn(PinscrewWarning("xacro", message, file=path), stacklevel=2)
    if "error" in answer:
        raise XacroError(
            answer["code"],
            answer["error"],
            file=answer["file"],
            line=answer["line"],
            remedy=answer["remedy"],
        )
    files = answer["files"]
    return Expansion(answer["text"], tuple((files[file], line) for file, line in answer["places"]))


def ask(
    worker: Path,
    request: Mapping[str, Any],
    ended: Callable[[str, str], DescriptionError],
    failed: Callable[[str], DescriptionError],
) -> dict[str, Any]:
    """What a worker, a script of ours in a limited child process, answers.

    Args:
        worker: the script, which reads ``request`` from standard input, and limits itself to `SECONDS` and `MEMORY`.
        request: what to do.
        ended: the error, from what was taken too much of, and what would help where it is not the file.
        failed: the error, from what the worker said before it ended.

    Raises:
        DescriptionError: if a limit ended it, or it failed.
    """
    try:
        child = subprocess.run(  # noqa: S603 (our own worker, under our own interpreter)
            [sys.executable, str(worker)],
            input=json.dumps({**request, "seconds": SECONDS, "memory": MEMORY}),
            capture_output=True,
            check=False,
            text=True,
            timeout=SECONDS * PATIENCE,
        )
    except subprocess.TimeoutExpired:
        what = f"more than {SECONDS * PATIENCE} s, most of which it waited"
        raise ended(what, "try again on a machine that is less busy") from None
    if child.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        raise ended(f"more than {SECONDS} s of processor time", "")
    if child.returncode < 0 or "MemoryError" in child.stderr:
        raise ended(f"more than {MEMORY // 2**20} MB", "")
    if child.returncode > 0:
        raise failed(one_line(brief(child.stderr)))
    answer: dict[str, Any] = json.loads(child.stdout)
    return answer
