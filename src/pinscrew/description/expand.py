"""xacro files to URDF text, in a child process: a macro language evaluates what the file says."""

from __future__ import annotations

import json
import subprocess
import sys
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from pinscrew.description.packages import Packages
from pinscrew.ground.errors import PinscrewWarning, XacroError
from pinscrew.ground.words import brief, one_line

__all__ = ["MEMORY", "SECONDS", "expand", "is_xacro"]

SECONDS: Final = 8
"""Time that an expansion may take, on the clock and on the processor."""
MEMORY: Final = 2**30
"""Bytes that its process may address."""

_WORKER: Final = Path(__file__).with_name("_xacro_worker.py")


def is_xacro(path: Path) -> bool:
    """Whether a file is to be expanded first, by its name."""
    return path.suffix == ".xacro"


def expand(path: Path, arguments: Mapping[str, str], packages: Packages | None = None) -> str:
    """The URDF that a xacro file stands for.

    Args:
        path: the file.
        arguments: values of its ``<xacro:arg>``s; the others keep their defaults.
        packages: what ``$(find …)`` finds and which folders may be read; by default those of the environment.

    Raises:
        XacroError: if an argument is not declared, an expression goes beyond arithmetic, a file outside the roots is
            asked for, or the expansion fails, takes more than `SECONDS` or more than `MEMORY`.
    """
    packages = packages or Packages(path)
    request = {
        "file": str(path),
        "arguments": dict(arguments),
        "packages": {name: str(root.resolve()) for name, root in packages.declared.items()},
        "allow_outside": packages.allow_outside,
        "seconds": SECONDS,
        "memory": MEMORY,
    }
    answer = _ask(request)
    if answer is None:
        what = f"its expansion takes more than {SECONDS} s or {MEMORY // 2**20} MB"
        raise XacroError("xacro-limit", what, file=path, remedy="look for endless macros and huge numbers")
    for message in answer["warnings"]:
        warnings.warn(PinscrewWarning("xacro", message, file=path), stacklevel=2)
    if "error" in answer:
        raise XacroError(
            answer["code"],
            answer["error"],
            file=answer["file"],
            line=answer.get("line"),
            remedy=answer.get("remedy", ""),
        )
    text: str = answer["text"]
    return text


def _ask(request: Mapping[str, Any]) -> dict[str, Any] | None:
    """The worker's answer, or None where a limit ended it."""
    try:
        child = subprocess.run(  # noqa: S603 (our own worker, under our own interpreter)
            [sys.executable, str(_WORKER)],
            input=json.dumps(request),
            capture_output=True,
            check=False,
            text=True,
            timeout=SECONDS,
        )
    except subprocess.TimeoutExpired:
        return None
    if child.returncode < 0 or "MemoryError" in child.stderr:
        return None
    if child.returncode > 0:
        what = f"its expansion failed: {one_line(brief(child.stderr))}"
        raise XacroError("xacro", what, file=request["file"])
    answer: dict[str, Any] = json.loads(child.stdout)
    return answer
