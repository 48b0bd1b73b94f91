"""Samples from files: archives of numpy, and tables of numbers."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from typing import Final

import numpy as np

from pinscrew.ground.errors import InputError
from pinscrew.ground.files import BROKEN_ARCHIVE, open_plain
from pinscrew.ground.typing import FloatArray
from pinscrew.ground.words import one_line

__all__ = ["read_arrays", "read_table"]

LARGEST: Final = 64 * 2**20
"""Bytes of a file, and of what an archive unpacks to."""
NAMES: Final = (("q", "J"), ("q", "T"), ("q", "pose"), ("q", "qd", "V"))
"""The arrays of an archive."""


def read_arrays(file: Path) -> tuple[FloatArray, ...]:
    """q and what belongs to it, from an .npz.

    Raises:
        InputError: if it can't be read, holds pickled objects, is larger than 64 MiB, or lacks the arrays.
    """
    data = _bytes(file)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as members:
            if sum(member.file_size for member in members.infolist()) > LARGEST:
                raise InputError("too-large", f"unpacks to more than {LARGEST // 2**20} MB", where=str(file))
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            held = {name: archive[name] for name in archive.files}
    except BROKEN_ARCHIVE as error:
        reason = one_line(str(error)) or type(error).__name__
        what = f"is no archive of plain arrays ({reason})"
        raise InputError("samples-file", what, where=str(file), remedy="write it with numpy.savez") from None
    for names in NAMES:
        if all(name in held for name in names):
            return tuple(held[name] for name in names)
    wanted = ", or ".join(" and ".join(names) for names in NAMES)
    raise InputError("samples-file", "lacks its arrays", where=str(file), remedy=f"name them {wanted}")


def read_table(file: Path) -> FloatArray:
    """A matrix from a text: a row a line, numbers separated by commas, semicolons or spaces; # begins a remark.

    Raises:
        InputError: if it can't be read, holds what is no number, or rows of different lengths.
    """
    rows: list[list[float]] = []
    try:
        text = _bytes(file).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError("encoding", "not UTF-8", where=str(file), remedy="save the file as UTF-8") from None
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.partition("#")[0].translate(str.maketrans(",;[]", "    ")).split()
        try:
            row = [float(word) for word in words]
        except ValueError:
            bad = next(word for word in words if not _is_number(word))
            what = f"{bad[:40]!r} is no number"
            raise InputError("samples-file", what, where=f"{file}:{number}") from None
        rows += [row] if row else []
    if len({len(row) for row in rows}) != 1:
        what = "has rows of different lengths" if rows else "holds no numbers"
        raise InputError("samples-file", what, where=str(file), remedy="give a matrix, a row a line")
    table = np.array(rows)
    return table[0] if len(table) == 1 else table


def _bytes(file: Path) -> bytes:
    try:
        with open_plain(file) as stream:
            data = stream.read(LARGEST + 1)
    except FileNotFoundError:
        raise InputError("no-file", "there is no such file", where=str(file)) from None
    except (OSError, ValueError) as error:
        what = f"can't be read ({getattr(error, 'strerror', None) or error})"
        raise InputError("unreadable", what, where=str(file)) from None
    if len(data) > LARGEST:
        raise InputError("too-large", f"larger than {LARGEST // 2**20} MB", where=str(file))
    return data


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
