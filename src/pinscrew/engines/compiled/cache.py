"""Compiled code, kept on disk for the next process; loaded only if nobody but this user can have written it.

What is loaded here is run, and a damaged object ends the process within LLVM. So a file is believed if

- its folder and the file itself belong to this user and nobody else may write to them, as ssh asks of its keys. Both
  are opened first and asked afterwards, by their descriptors, and no link is followed: what was asked about is then
  what is read. Who may write to a folder further up can only put another folder of this user's in the place of ours.
- it says, under a digest of the whole, which key it was stored for. A file that was renamed, as by a copy of one
  arm's kernel over another's, is no answer.

Files appear whole (written aside, then renamed), so processes that compile the same at once do no harm. A cache that
can't be read or written, or is not to be trusted, only costs time.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import secrets
import stat
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Final

from pinscrew.ground.errors import PinscrewWarning

__all__ = ["key_of", "load", "store"]

_LINK_ERRORS: Final = (errno.ELOOP, getattr(errno, "EMLINK", None))  # Linux and macOS; FreeBSD
_MAGIC: Final = b"pinscrew kernel 2\n"
_DIGEST: Final = hashlib.sha256().digest_size
_LARGEST: Final = 2**28
"""Bytes of a file that is read; kernels have some 10 kB."""
# Where the system lacks these, it lacks what they guard against.
_NO_LINK: Final = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_CLOEXEC", 0)
_READ: Final = os.O_RDONLY | _NO_LINK | getattr(os, "O_NONBLOCK", 0)  # to open a FIFO must not wait for a writer
_WRITE: Final = os.O_WRONLY | os.O_CREAT | os.O_EXCL | _NO_LINK
_FOLDER: Final = os.O_RDONLY | _NO_LINK | getattr(os, "O_DIRECTORY", 0)


def key_of(*parts: str) -> str:
    """One name, fit for a file, for all that decides what a compiler makes."""
    digest = hashlib.sha256(_MAGIC)
    for part in parts:
        data = part.encode()
        digest.update(b"%d:%s" % (len(data), data))  # with lengths, so that no two lists of parts look the same
    return digest.hexdigest()


def load(key: str) -> bytes | None:
    """What was stored under a key, if it is whole and certainly ours."""
    try:
        with _folder() as (folder, path):
            descriptor = os.open(key, _READ, dir_fd=folder)
            try:
                content = _content(descriptor, path / key)
            finally:
                os.close(descriptor)
    except FileNotFoundError:
        return None
    except (OSError, RuntimeError, NotImplementedError) as error:  # RuntimeError: there is no home
        if getattr(error, "errno", None) in _LINK_ERRORS:
            _say_unused(str(_place() / key), "is a link")
        return None
    if content is None:
        return None
    digest, code = content[:_DIGEST], content[_DIGEST:]
    return code if secrets.compare_digest(digest, _digest(key, code)) else None


def store(key: str, code: bytes) -> None:
    """Keep something under a key, in place of whatever has that name now."""
    with contextlib.suppress(OSError, RuntimeError, NotImplementedError):
        place = _place()
        place.parent.mkdir(parents=True, exist_ok=True)
        place.mkdir(mode=0o700, exist_ok=True)
        with _folder() as (folder, _):
            aside = f".{key}.{os.getpid()}.{secrets.token_hex(8)}"
            descriptor = os.open(aside, _WRITE, 0o600, dir_fd=folder)
            try:
                with os.fdopen(descriptor, "wb") as stream:
                    stream.write(_digest(key, code) + code)
                os.replace(aside, key, src_dir_fd=folder, dst_dir_fd=folder)
            except OSError:
                os.unlink(aside, dir_fd=folder)
                raise


def _digest(key: str, code: bytes) -> bytes:
    return hashlib.sha256(b"%s%s\n%s" % (_MAGIC, key.encode(), code)).digest()


def _place() -> Path:
    """Where compiled code is kept: ``$PINSCREW_CACHE``, or the user's cache folder."""
    given = os.environ.get("PINSCREW_CACHE")
    if given:
        return Path(given)
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "pinscrew"


@contextmanager
def _folder() -> Iterator[tuple[int, Path]]:
    """The folder, open, if it is this user's alone.

    Raises:
        OSError: if there is none, or it is not to be used.
    """
    path = _place()
    try:
        descriptor = os.open(path, _FOLDER)
    except OSError:
        if path.is_symlink():
            _say_unused(str(path), "is a link")
        raise
    try:
        if (reason := _not_ours(os.fstat(descriptor))) is not None:
            _say_unused(str(path), reason)
            raise PermissionError(reason)
        yield descriptor, path
    finally:
        os.close(descriptor)


def _content(descriptor: int, path: Path) -> bytes | None:
    """All of an open file, if it is this user's alone."""
    status = os.fstat(descriptor)
    reason = _not_ours(status)
    if reason is None and not stat.S_ISREG(status.st_mode):
        reason = "is no file"
    if reason is None and status.st_size > _LARGEST:
        reason = f"has {status.st_size} bytes"
    if reason is not None:
        _say_unused(str(path), reason)
        return None
    with os.fdopen(os.dup(descriptor), "rb") as stream:
        return stream.read()


def _not_ours(status: os.stat_result) -> str | None:
    """Why something may not be as we left it: as ssh asks of its files."""
    if not hasattr(os, "geteuid"):
        return None
    if status.st_uid != os.geteuid():
        return "belongs to another user"
    return "may be written by others" if status.st_mode & (stat.S_IWGRP | stat.S_IWOTH) else None


@lru_cache(maxsize=64)
def _say_unused(place: str, reason: str) -> None:
    """Warn, once, that something is passed over."""
    remedy = "remove it, or set PINSCREW_CACHE to a folder that only you can write to"
    message = f"{place} {reason}, so no compiled kernel is taken from it; {remedy}"
    warnings.warn(PinscrewWarning("cache", message), stacklevel=3)
