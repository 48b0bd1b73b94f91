"""xacro files to URDF text, in a child process: a macro language evaluates what the file says."""

from __future__ import annotations

import json
import subprocess
import sys
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from pinscrew.errors import PinscrewWarning, XacroError

__all__ = ["TIMEOUT", "expand", "is_xacro"]

TIMEOUT: Final = 10.0
"""Seconds that an expansion may take."""

_WORKER: Final = Path(__file__).with_name("_xacro_worker.py")


def is_xacro(path: Path) -> bool:
    """Whether a file is to be expanded first, by its name."""
    return path.suffix == ".xacro"


def expand(path: Path, arguments: Mapping[str, str]) -> str:
    """The URDF that a xacro file stands for.

    Args:
        path: the file.
        arguments: values of its ``<xacro:arg>``s; the others keep their defaults.

    Raises:
        XacroError: if an argument is not declared, or the expansion fails or takes too long.
    """
    request = json.dumps({"file": str(path), "arguments": dict(arguments)})
    try:
        child = subprocess.run(  # noqa: S603 (our own worker, under our own interpreter)
            [sys.executable, str(_WORKER)],
            input=request,
            capture_output=True,
            check=False,
            text=True,
            timeout=TIMEOUT,
        )
    except subprocess.TimeoutExpired:
        what = f"its expansion takes more than {TIMEOUT:g} s"
        raise XacroError("xacro-limit", what, file=path, remedy="look for endless macros") from None
    answer = _answer(child.stdout)
    if answer is None:
        what = f"its expansion died (exit status {child.returncode})"
        raise XacroError("xacro-limit", what, file=path, remedy="look for endless macros and huge numbers")
    for message in answer["warnings"]:
        warnings.warn(PinscrewWarning("xacro", f"{path}: {message}"), stacklevel=2)
    if "error" in answer:
        raise XacroError(answer["code"], answer["error"], file=path, remedy=answer.get("remedy", ""))
    text: str = answer["text"]
    return text


def _answer(output: str) -> dict[str, Any] | None:
    """The worker's answer, or None where it did not live to give one."""
    try:
        answer: dict[str, Any] = json.loads(output)
    except json.JSONDecodeError:
        return None
    return answer
