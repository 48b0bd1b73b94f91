"""Figures of matplotlib as files: no window, no state that figures share, and the same bytes for the same numbers."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from pinscrew.ground import files
from pinscrew.ground.errors import InputError, MissingExtraError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["FORMATS", "check", "figure", "save"]

# What matplotlib would write of the time and of its own version, by the suffix that tells the format.
FORMATS: Final[dict[str, dict[str, Any]]] = {
    ".png": {"Software": None},
    ".svg": {"Date": None, "Creator": None},
    ".pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}
"""The suffixes of files that a figure can be saved in, with what is left out of their metadata."""


def check(path: Path) -> None:
    """Refuse a file that `save` would not write; call it before long work.

    Raises:
        InputError: if its suffix is none of `FORMATS`, or it can't be written.
        MissingExtraError: if matplotlib is not installed.
    """
    if path.suffix.lower() not in FORMATS:
        what = f"a figure can't be written with the suffix {path.suffix!r}"
        raise InputError("figure-suffix", what, where=str(path), remedy=f"use {', '.join(FORMATS)}")
    files.check(path)
    _require()


def figure(width: float = 8.0, height: float = 6.0) -> Figure:
    """An empty figure that no window will show.

    Args:
        width: inches.
        height: inches.

    Raises:
        MissingExtraError: if matplotlib is not installed.
    """
    _require()
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def save(figure: Figure, path: Path, *, dpi: float = 150.0) -> None:
    """Write a figure as PNG, SVG or PDF, by the file's suffix: whole or not at all.

    Args:
        figure: see `figure`.
        path: the file.
        dpi: dots per inch of a PNG.

    Raises:
        InputError: if the suffix is none of `FORMATS`, or the file can't be written.
    """
    check(path)
    import matplotlib as mpl

    suffix = path.suffix.lower()
    out = io.BytesIO()
    # A fixed salt, since ids in an SVG are random without one; text of an SVG stays text.
    with mpl.rc_context({"svg.hashsalt": "pinscrew", "svg.fonttype": "none"}):
        figure.savefig(out, format=suffix[1:], dpi=dpi, metadata=FORMATS[suffix])
    files.write(path, out.getvalue())


def _require() -> None:
    try:
        import matplotlib as mpl  # noqa: F401 (only whether it is there)
    except ModuleNotFoundError:
        raise MissingExtraError("matplotlib is not installed", "plot") from None
    except ValueError as error:  # a backend in the environment, say, that does not exist
        what = f"matplotlib can't be loaded with its settings ({error})"
        raise InputError("figure-settings", what, remedy="unset MPLBACKEND, or mend matplotlibrc") from None
