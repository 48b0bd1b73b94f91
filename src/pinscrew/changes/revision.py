"""Files as they are in a git revision: ``HEAD~1:arm.urdf``."""

from __future__ import annotations

import io
import os
import posixpath
import re
import subprocess
import tempfile
import warnings
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

from pinscrew.ground.errors import InputError, PinscrewError, PinscrewWarning

__all__ = ["is_revision", "taken_out", "working_file"]

_WORD: Final = re.compile(r"([^:]+):(.+)", re.DOTALL)
_NOT_NEEDED: Final = ("stl", "dae", "obj", "ply", "glb", "png", "jpg", "jpeg", "tga", "zip", "gz", "pdf")
"""Meshes and such, by their suffixes: kinematics needs none, and they can be large."""


def is_revision(source: str) -> bool:
    """Whether ``source`` is written as ``REV:path`` and no file is called so."""
    return _WORD.fullmatch(source) is not None and not os.path.lexists(source)


@contextmanager
def taken_out(source: str) -> Iterator[Path]:
    """The file that ``REV:path`` names, in a temporary folder beside the files that it may include.

    As in git, the path is from the top of the repository, or with ``./`` from the working folder. Errors and warnings
    raised inside name ``REV:path`` and not the temporary folder.

    Args:
        source: such as ``HEAD~1:arm.urdf``.

    Raises:
        InputError: if there is no git, no repository, no such revision, or no such file in it.
    """
    top, revision, path = _parts(source)
    commit = _commit(top, source, revision)
    if path.startswith(("../", "/")) or _kind(top, source, commit, path) != "blob":
        what = f"there is no file {path!r} in revision {revision!r}"
        raise InputError(
            "git-path", what, where=source, remedy="give its path from the top of the repository, or ./path"
        )
    with tempfile.TemporaryDirectory(prefix="pinscrew-") as folder:
        root = Path(folder).resolve()
        if path.endswith((".xacro", ".xml")):
            _unpack(top, source, commit, root)
        target = root / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(_git(top, source, "cat-file", "blob", f"{commit}:{path}"))
        with _named(f"{root}{os.sep}", f"{revision}:"):
            yield target


def working_file(source: str) -> str:
    """Where the file of ``REV:path`` is in the working tree, if it still is there: what a forge shows lines of.

    Raises:
        InputError: if there is no git, or no repository.
    """
    top, _, path = _parts(source)
    return os.path.relpath(top / path)


def _parts(source: str) -> tuple[Path, str, str]:
    """The top of the repository, the revision, and the path from the top."""
    match = _WORD.fullmatch(source)
    if match is None:
        raise InputError("git", f"{source!r} is not REV:path", remedy="write such as HEAD~1:arm.urdf")
    revision, path = match.groups()
    top = Path(_git(Path(), source, "rev-parse", "--show-toplevel").decode().strip())
    if path.startswith(("./", "../")):
        prefix = _git(Path(), source, "rev-parse", "--show-prefix").decode().strip()
        path = posixpath.join(prefix, path)
    return top, revision, posixpath.normpath(path)


def _commit(top: Path, source: str, revision: str) -> str:
    """The commit that a revision is, as its hash."""
    # A revision that starts with a dash would be an option.
    known = not revision.startswith("-")
    done = _run(top, "rev-parse", "--verify", "--quiet", f"{revision}^{{commit}}") if known else None
    if done is None or done.returncode != 0:
        what = f"git knows no revision {revision!r}"
        remedy = "give a commit, branch or tag, such as HEAD~1; or is it a file that does not exist?"
        raise InputError("git-revision", what, where=source, remedy=remedy)
    return done.stdout.decode().strip()


def _kind(top: Path, source: str, commit: str, path: str) -> str:
    """What a path is in a commit: a blob, a tree, or nothing."""
    row = _git(top, source, "ls-tree", "-z", "--full-tree", commit, "--", f":(literal){path}")
    return row.split(b"\t")[0].split()[1].decode() if row else ""


def _unpack(top: Path, source: str, commit: str, root: Path) -> None:
    """All files of a commit but meshes and pictures: a xacro file or an MJCF may include any of them."""
    without = [f":(exclude,icase,glob)**/*.{suffix}" for suffix in _NOT_NEEDED]
    archive = _git(top, source, "archive", "--format=zip", commit, "--", ".", *without)
    with zipfile.ZipFile(io.BytesIO(archive)) as files:
        files.extractall(root)


def _git(folder: Path, source: str, *words: str) -> bytes:
    """What git answers.

    Raises:
        InputError: if it fails; the message carries its words.
    """
    done = _run(folder, *words)
    if done.returncode != 0:
        said = done.stderr.decode(errors="replace").strip()
        remedy = "run it inside the repository that has the revision" if "not a git repository" in said else ""
        raise InputError("git", f"git says: {said}", where=source, remedy=remedy)
    return done.stdout


def _run(folder: Path, *words: str) -> subprocess.CompletedProcess[bytes]:
    environment = {**os.environ, "LC_ALL": "C"}
    try:
        return subprocess.run(  # noqa: S603 (no shell)
            ["git", *words],  # noqa: S607 (the user's own git)
            cwd=folder,
            env=environment,
            capture_output=True,
            check=False,
        )
    except OSError as error:
        what = f"a revision needs git, which can't be run ({error.strerror})"
        raise InputError("git", what, remedy="install git, or give two files") from None


@contextmanager
def _named(folder: str, name: str) -> Iterator[None]:
    """Errors and warnings from inside with another name for a folder."""

    def renamed(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(renamed(element) for element in value)
        return value.replace(folder, name) if isinstance(value, str) else value

    remarks: list[PinscrewWarning] = []
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", PinscrewWarning)
            yield
        remarks += [warning.message for warning in caught if isinstance(warning.message, PinscrewWarning)]
    except PinscrewError as error:
        error.args = renamed(error.args)
        vars(error).update({key: renamed(value) for key, value in vars(error).items()})
        raise
    for remark in remarks:
        named = PinscrewWarning(remark.code, renamed(remark.what), file=renamed(remark.file), line=remark.line)
        warnings.warn(named, stacklevel=3)
