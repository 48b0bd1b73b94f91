"""Arrays with what they came from in one npz file: written whole or not at all, and read with suspicion."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pinscrew.engines.base import Engine
from pinscrew.engines.compiled import can_compile
from pinscrew.engines.compiled.batch import Batch
from pinscrew.ground import files
from pinscrew.ground.errors import InputError
from pinscrew.ground.version import version_of
from pinscrew.lockfile.writing import fingerprint
from pinscrew.robot.robot import Robot
from pinscrew.workspace.axes import Axis

__all__ = ["Arrays", "Metadata", "load", "provenance", "save"]

Arrays: TypeAlias = dict[str, NDArray[Any]]
Metadata: TypeAlias = dict[str, Any]

METADATA: Final = "metadata"
"""The array that holds the provenance, as JSON."""

MOST_SQUEEZED: Final = 100 * 2**20
"""Bytes that compressed members of an archive may have."""
MOST_METADATA: Final = 10 * 2**20
"""Bytes of the provenance."""


def provenance(robot: Robot, engine: Engine, frame: str, axes: tuple[Axis, ...]) -> Metadata:
    """What numbers about a robot depend on: plain data, for `save`."""
    engine_packages = ("llvmlite",) if engine.name == Batch.name and can_compile() else ()
    return {
        "robot": robot.name,
        "fingerprint": fingerprint(robot),
        "arguments": dict(robot.description.arguments),
        "frame": frame,
        "base": robot.base,
        "coordinates": list(robot.coordinate_names),
        "ranges": {axis.name: [axis.lower, axis.upper] for axis in axes},
        "units": {axis.name: "rad" if axis.angle else "m" for axis in axes},
        "engine": engine.name,
        "versions": {name: version_of(name) for name in ("pinscrew", "numpy", *engine_packages)},
    }


def save(path: Path, schema: str, metadata: Metadata, arrays: Arrays) -> None:
    """Write arrays and their provenance as npz.

    Raises:
        InputError: if the file can't be written.
    """
    text = json.dumps({"schema": schema, **metadata}, ensure_ascii=False, allow_nan=False)
    out = io.BytesIO()
    np.savez(out, **{METADATA: np.array(text), **arrays})  # type: ignore[arg-type]
    files.write(path, out.getvalue())


def load(path: Path, schema: str, shapes: Mapping[str, tuple[str, tuple[int | None, ...]]]) -> tuple[Metadata, Arrays]:
    """Read what `save` wrote.

    Args:
        path: the file.
        schema: what it must be.
        shapes: kind of number (as in ``dtype.kind``) and lengths of the axes after the first of each array that must
            be there, None for any; their first axes are equally long.

    Returns:
        the provenance, and all arrays.

    Raises:
        InputError: if there is no such file, or it is broken or something else.
    """
    arrays, cause = _read(path, schema)
    metadata: Any = None
    if METADATA in arrays:
        try:
            metadata = json.loads(str(arrays.pop(METADATA)))
        except (ValueError, RecursionError) as error:
            cause = str(error)
    found = metadata.get("schema") if isinstance(metadata, dict) else None
    if not cause and found != schema:
        cause = f"its schema is {found!r}"
    if not cause:
        wrong = [name for name, wanted in shapes.items() if name not in arrays or not _is(arrays[name], *wanted)]
        lengths = {len(arrays[name]) for name in shapes if name not in wrong}
        cause = f"the array {wrong[0]!r} is not in it, or not as it was written" if wrong else ""
        cause = cause or ("its arrays have different lengths" if len(lengths) > 1 else "")
    if cause:
        raise InputError("workspace-file", f"is no {schema} file ({cause})", where=str(path))
    del metadata["schema"]
    return metadata, arrays


def _is(array: NDArray[Any], kind: str, lengths: tuple[int | None, ...]) -> bool:
    pairs = zip(array.shape[1:], lengths, strict=False)
    return array.dtype.kind == kind and array.ndim == 1 + len(lengths) and all(b in (None, a) for a, b in pairs)


def _read(path: Path, schema: str) -> tuple[Arrays, str]:
    """The arrays of an npz file; of one that is something else the provenance alone. Or why there are none."""
    try:
        stream = files.open_plain(path)
    except (OSError, ValueError) as error:  # ValueError: a NUL character in the path
        code = "no-file" if isinstance(error, FileNotFoundError) else "unreadable"
        what = f"can't be read ({getattr(error, 'strerror', None) or error})"
        raise InputError(code, what, where=str(path)) from None
    with stream:
        try:
            if not zipfile.is_zipfile(stream):
                return {}, "it is no archive of arrays"
            stream.seek(0)
            with zipfile.ZipFile(stream) as members:
                squeezed = [m for m in members.infolist() if m.compress_type != zipfile.ZIP_STORED]
                sizes = {m.filename: m.file_size for m in members.infolist()}
            # `save` does not compress: what takes a thousand times its size in memory is not from here.
            if sum(member.file_size for member in squeezed) > MOST_SQUEEZED:
                return {}, f"compressed, of more than {MOST_SQUEEZED // 2**20} MB"
            if sizes.get(f"{METADATA}.npy", 0) > MOST_METADATA:
                return {}, f"its provenance is larger than {MOST_METADATA // 2**20} MB"
            stream.seek(0)
            archive = np.load(stream, allow_pickle=False)
            told = {METADATA: archive[METADATA]} if METADATA in archive else {}
            return (dict(archive) if schema in str(told.get(METADATA, "")) else told), ""
        except files.BROKEN_ARCHIVE as error:
            return {}, str(error).partition(". ")[0] or type(error).__name__  # numpy goes on about pickles
