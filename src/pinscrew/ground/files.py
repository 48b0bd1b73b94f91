"""Writing files whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import secrets
import stat
import struct
import zipfile
import zlib
from pathlib import Path
from typing import BinaryIO, Final

from pinscrew.ground.errors import InputError

__all__ = ["BROKEN_ARCHIVE", "append", "check", "open_plain", "write"]

BROKEN_ARCHIVE: Final = (
    *(OSError, EOFError, ValueError, KeyError, SyntaxError, TypeError, MemoryError, RuntimeError),
    *(zipfile.BadZipFile, zlib.error, struct.error),
)
"""What zip, zlib and numpy say of archives that are damaged, encrypted, or claim to be larger than memory."""
_STREAM: Final = re.compile("/dev/(?:(stdout|stderr)|fd/([0-9]{1,9}))")
"""An open stream, which may be a file that is not to be replaced: another process may hold it too."""
_NOT_PLAIN: Final = "it is no plain file"
_NUMBERS: Final = {"stdout": 1, "stderr": 2}
_HELD: Final[dict[Path, BinaryIO]] = {}
"""Pipes that `check` opened: who reads one would take it for its end if it were closed before `write`."""


def open_plain(path: Path) -> BinaryIO:
    """A file opened for reading, at once; only a plain one: a pipe may never begin, and /dev/zero never ends.

    Raises:
        OSError: if it can't be opened, or is something else.
        ValueError: if there is a NUL character in the path.
    """
    try:
        stream = open(path, "rb", opener=lambda name, flags: os.open(name, flags | os.O_NONBLOCK))  # noqa: SIM115
    except OSError as error:
        if error.errno == errno.ENXIO:  # a socket
            raise OSError(errno.EINVAL, _NOT_PLAIN) from None
        raise
    if not stat.S_ISREG(os.fstat(stream.fileno()).st_mode):
        stream.close()
        raise OSError(errno.EINVAL, _NOT_PLAIN)
    return stream


def check(path: Path) -> None:
    """Refuse a file that `write` would not write; call it before long work. Nothing is written.

    Args:
        path: see `write`. A pipe must have its reader now, and is kept open for `write`.

    Raises:
        InputError: if it is a folder, is in none, or can't be written otherwise.
    """
    try:
        stream = _stream(path)
        if stream is not None:
            os.fstat(stream)
            return
        target, known = _looked_up(path)
        if known is None:
            target.parent.stat()
            _check_access(target.parent, os.W_OK | os.X_OK)
        elif stat.S_ISREG(known.st_mode):
            _check_replaceable(target, known)
        elif stat.S_ISFIFO(known.st_mode):
            _HELD[target] = open(target, "wb", opener=_without_waiting)  # noqa: SIM115 (`write` closes it)
        elif stat.S_ISDIR(known.st_mode):
            raise _error(errno.EISDIR)
        elif stat.S_ISSOCK(known.st_mode):
            raise _error(errno.ENXIO)
        else:
            _check_access(target, os.W_OK)
    except (OSError, ValueError, RuntimeError) as error:
        raise _unwritable(path, error) from None


def write(path: Path, data: bytes) -> None:
    """Write a file whole or not at all: its name appears, or changes its content, only once everything is written.

    A file that is there keeps its mode and, where we may give it, its owner. One that nobody may write to is not
    replaced, not even by root, and neither is one that we may not write to, though its folder would let us.

    Args:
        path: the file, or a link to it; a device, a pipe that somebody reads, or a stream of ours such as
            ``/dev/stdout``, is written to as it is.
        data: its content.

    Raises:
        InputError: if it can't be written.
    """
    try:
        stream = _stream(path)
        if stream is not None:
            with os.fdopen(os.dup(stream), "wb") as file:
                file.write(data)
            return
        target, known = _looked_up(path)
        if known is not None and not stat.S_ISREG(known.st_mode):
            with _HELD.pop(target, None) or open(target, "wb", opener=_without_waiting) as device:
                device.write(data)
        else:
            _replace(target, data, known)
    except (OSError, ValueError, RuntimeError) as error:  # a NUL character in the path; links in a circle
        raise _unwritable(path, error) from None


def _stream(path: Path) -> int | None:
    """The number of the open stream that a path stands for, if it does."""
    found = _STREAM.fullmatch(str(path))
    return None if found is None else _NUMBERS.get(found[1]) or int(found[2])


def _looked_up(path: Path) -> tuple[Path, os.stat_result | None]:
    """What a path leads to, and what is there: None where nothing is."""
    target = path.resolve()
    try:
        return target, target.stat()
    except FileNotFoundError:
        return target, None


def _check_replaceable(target: Path, known: os.stat_result) -> None:
    if not known.st_mode & 0o222:  # not even by root, who may do all
        raise _error(errno.EACCES)
    _check_access(target, os.W_OK)


def _check_access(target: Path, how: int) -> None:
    if not os.access(target, how):
        raise _error(errno.EACCES)


def _error(number: int) -> OSError:
    return OSError(number, os.strerror(number))


def _replace(target: Path, data: bytes, known: os.stat_result | None) -> None:
    if known is not None:
        _check_replaceable(target, known)
    temporary = target.with_name(f".pinscrew.{secrets.token_hex(8)}")  # short: the name itself may be the longest
    private = 0o600 if known is not None else 0o666  # less what the user's mask takes away
    descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, private)
    try:
        with os.fdopen(descriptor, "wb") as stream:
            stream.write(data)
            if known is not None:
                with contextlib.suppress(PermissionError):
                    os.fchown(stream.fileno(), known.st_uid, known.st_gid)
                os.fchmod(stream.fileno(), stat.S_IMODE(known.st_mode))
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


def append(path: Path, data: bytes) -> None:
    """Add to the end of a file that others write to as well.

    Raises:
        InputError: if it can't be written.
    """
    try:
        with open(path, "ab", opener=_without_waiting) as stream:
            stream.write(data)
    except (OSError, ValueError) as error:
        raise _unwritable(path, error) from None


def _without_waiting(path: str, flags: int) -> int:
    """Open a file; a pipe that nobody reads fails at once (ENXIO; POSIX, open), where it would wait for a reader."""
    descriptor = os.open(path, flags | os.O_NONBLOCK, 0o666)
    os.set_blocking(descriptor, True)  # a reader that is slow is waited for
    return descriptor


def _unwritable(path: Path, error: Exception) -> InputError:
    reason = getattr(error, "strerror", None) or error
    if getattr(error, "errno", None) == errno.ENXIO:
        reason = "it is a pipe that nobody reads, or a socket"
    what = f"can't be written ({reason})"
    return InputError("unwritable", what, where=str(path))
