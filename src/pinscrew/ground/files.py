"""Writing files whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

from pinscrew.ground.errors import InputError

__all__ = ["append", "write"]


def write(path: Path, data: bytes) -> None:
    """Write a file whole or not at all: its name appears, or changes its content, only once everything is on disk.

    Args:
        path: the file; a device or a pipe, such as ``/dev/stdout``, is written to directly.
        data: its content.

    Raises:
        InputError: if it can't be written.
    """
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(data)
            return
        temporary = path.resolve().with_name(f".{path.name}.{os.getpid()}")
        try:
            temporary.write_bytes(data)
            temporary.replace(path.resolve())
        finally:
            temporary.unlink(missing_ok=True)
    except (OSError, ValueError) as error:  # ValueError: a NUL character in the path
        raise _unwritable(path, error) from None


def append(path: Path, data: bytes) -> None:
    """Add to the end of a file that others write to as well.

    Raises:
        InputError: if it can't be written.
    """
    try:
        with path.open("ab") as stream:
            stream.write(data)
    except (OSError, ValueError) as error:
        raise _unwritable(path, error) from None


def _unwritable(path: Path, error: Exception) -> InputError:
    what = f"can't be written ({getattr(error, 'strerror', None) or error})"
    return InputError("unwritable", what, where=str(path))
