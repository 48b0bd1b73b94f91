"""Screw axes and home pose as JSON, CSV, Python, MATLAB and LaTeX."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from pinscrew.cli.output import plain
from pinscrew.ground.escaping import csv_row, json_text
from pinscrew.ground.escaping_code import matlab_comment, python_comment

if TYPE_CHECKING:
    from pinscrew.ground.typing import FloatArray

__all__ = ["FORMATS", "Screws"]

_V: Final = ("vx", "vy", "vz")
_W: Final = ("wx", "wy", "wz")


@dataclass(frozen=True, slots=True)
class Screws:
    """What is printed.

    Attributes:
        robot: the robot's name.
        base: the frame of the home pose, and of space axes.
        tip: the tip frame, and the frame of body axes.
        at: ``"space"`` or ``"body"``.
        angular_first: whether twists are printed (ω, v).
        names: one name per axis.
        axes: twists (v, ω), shape (6, n).
        home: the home pose, shape (4, 4).
    """

    robot: str
    base: str
    tip: str
    at: str
    angular_first: bool
    names: tuple[str, ...]
    axes: FloatArray
    home: FloatArray

    @property
    def rows(self) -> tuple[str, ...]:
        """What the entries of a printed twist are."""
        return (*_W, *_V) if self.angular_first else (*_V, *_W)

    @property
    def heading(self) -> str:
        """A printed twist in symbols."""
        return "twist (ω, v)" if self.angular_first else "twist (v, ω)"

    def ordered(self, twists: FloatArray) -> FloatArray:
        """Twists (6, ...) with their rows as they are printed."""
        from numpy import roll

        return roll(twists, 3, axis=0) if self.angular_first else twists


def _json(s: Screws) -> str:
    document = {
        "schema": "pinscrew.screws/1",
        "robot": s.robot,
        "base": s.base,
        "tip": s.tip,
        "at": s.at,
        "rows": list(s.rows),
        "columns": list(s.names),
        "screws": plain(s.ordered(s.axes)),
        "home": plain(s.home),
    }
    return json_text(document)


def _csv(s: Screws) -> str:
    rows = ((name, *axis) for name, axis in zip(s.names, plain(s.ordered(s.axes).T), strict=True))
    return "\n".join(map(csv_row, (("joint", *s.rows), *rows)))


def _words(s: Screws) -> tuple[str, str]:
    """What the axes and the home pose are, for a comment in code."""
    frame = s.tip if s.at == "body" else s.base
    axes = f"{s.at} screw axes in {frame}: rows {', '.join(s.rows)}; columns {', '.join(s.names)}"
    return axes, f"home pose: {s.tip} in {s.base}"


def _python(s: Screws) -> str:
    axes, home = map(python_comment, _words(s))
    lines = ["import numpy as np", "", f"# {axes}", *_array("screws", plain(s.ordered(s.axes)))]
    return "\n".join((*lines, "", f"# {home}", *_array("M", plain(s.home))))


def _array(name: str, rows: Sequence[Sequence[float]]) -> list[str]:
    return [f"{name} = np.array([", *(f"    {list(row)!r}," for row in rows), "])"]


def _matlab(s: Screws) -> str:
    axes, home = map(matlab_comment, _words(s))
    lines = [f"% {axes}", *_brackets("screws", plain(s.ordered(s.axes)))]
    return "\n".join((*lines, "", f"% {home}", *_brackets("M", plain(s.home))))


def _brackets(name: str, rows: Sequence[Sequence[float]]) -> list[str]:
    return [f"{name} = [", *(f"    {' '.join(map(repr, row))}" for row in rows), "];"]


def _latex(s: Screws) -> str:
    kind = r"\mathcal{B}" if s.at == "body" else r"\mathcal{S}"
    return "\n".join((*_bmatrix(kind, plain(s.ordered(s.axes))), *_bmatrix("M", plain(s.home))))


def _bmatrix(name: str, rows: Sequence[Sequence[float]]) -> list[str]:
    body = [" & ".join(map(_tex, row)) + r" \\" for row in rows]
    return [rf"\[ {name} =", r"\begin{bmatrix}", *body, r"\end{bmatrix} \]"]


def _tex(x: float) -> str:
    """Nine digits, without the rounding of zero."""
    digits, _, exponent = f"{round(x, 12) + 0.0:.9g}".partition("e")
    return rf"{digits} \times 10^{{{int(exponent)}}}" if exponent else digits


FORMATS: Final[dict[str, Callable[[Screws], str]]] = {
    "json": _json,
    "csv": _csv,
    "python": _python,
    "matlab": _matlab,
    "latex": _latex,
}
