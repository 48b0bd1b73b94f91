"""What `pinscrew.identify` answers."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final, Literal

import numpy as np

from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.identification.encodings import Encoding
from pinscrew.identification.given import Quantity
from pinscrew.identification.observers import Observer
from pinscrew.identification.writings import UNITS, Writing

__all__ = ["Candidate", "Identified"]

SHOWN: Final = 2
"""Other names that are printed."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """A convention that the samples are in, as far as they tell.

    Attributes:
        quantity: what it is of.
        observer: of a Jacobian or a twist, whose; None of a pose.
        writing: of a Jacobian or a twist, how it is written down.
        frames: of a pose, the frame it is in, and the frame it is of.
        encoding: of a pose, how it is written down.
        residual: the largest difference from the samples, in their own units.
        names: the robot's velocities.
        turning: for each of them 1 if it is an angle's, otherwise 0; shape (nv,).
        aliases: other names of the very same numbers, for every q.
    """

    quantity: Quantity
    residual: float
    names: tuple[str, ...]
    turning: FloatArray
    observer: Observer | None = None
    writing: Writing | None = None
    frames: tuple[str, str] = ("", "")
    encoding: Encoding | None = None
    aliases: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """What it is called."""
        if self.observer is not None and self.writing is not None:
            if self.quantity == "screws":
                where = {"spatial": "space", "body": "body"}[self.observer.kind]
                said = f"the {where} screw axes of {self.observer.frame} at zero"
                written = self.writing.words(self.names)
                return f"{said}, {written}" if written else said
            thing = "Jacobian" if self.quantity == "jacobian" else "twist"
            said = self.observer.words.format(thing)
            written = self.writing.words(self.names, "rates" if self.observer.rates else "ω")
            return f"{said}, {written}" if written else said
        a, b = self.frames
        return f"the pose of {b} in {a}, as {self.encoding.name if self.encoding else ''}"

    @property
    def cost(self) -> int:
        """How far from the plainest convention it is."""
        if self.writing is not None and self.observer is not None:
            rates = 2 + self.observer.rates.cost if self.observer.rates else 0
            return self.writing.cost(len(self.names)) + 3 * (self.observer.kind == "mixed") + rates
        return self.encoding.cost if self.encoding else 0

    def convert(self, given: ArrayLike) -> FloatArray:
        """What was given, as ours: rows (v, ω), metres and radians, a column for each velocity; poses as 4×4.

        Of an analytic Jacobian the rates remain rates of the same angles, as it is q that makes ω of them.

        Args:
            given: numbers in this convention, shape (..., 6, m), (..., 6), (..., 7) or (..., 4, 4) as they were given.

        Raises:
            InputError: if they can't be in it.
        """
        array = np.asarray(given, dtype=np.float64)
        if self.encoding is not None:
            core = array.shape[-2:] if self.encoding.form in ("matrix", "inverse", "transposed") else array.shape[-1:]
            lead = array.shape[: array.ndim - len(core)]
            found = self.encoding.decode(array.reshape(-1, *core))
            if found is None:
                raise InputError("not-a-pose", "a row of the matrix is not 0, 0, 0, 1", where="convert")
            return found.reshape(*lead, 4, 4)
        return _converted(array, self)


@dataclass(frozen=True, eq=False)
class Identified:
    """Which conventions samples are in.

    Attributes:
        robot: the robot's name.
        candidates: all that fit, the plainest first; each stands for its aliases too.
        ask: a configuration at which the candidates differ, where there are several; shape (nq,).
        samples: how many were given.
    """

    robot: str
    candidates: tuple[Candidate, ...]
    samples: int
    ask: FloatArray | None = field(default=None)

    @property
    def verdict(self) -> Literal["unique", "ambiguous", "none"]:
        """Whether one convention fits, several, or none that is known."""
        return "unique" if len(self.candidates) == 1 else "ambiguous" if self.candidates else "none"

    @property
    def code(self) -> str:
        """Lines of numpy that turn Jacobians of the plainest candidate into ours; ``""`` where there is none."""
        return _code(self.candidates[0]) if self.candidates else ""

    def convert(self, given: ArrayLike) -> FloatArray:
        """Turn more of the same into ours; see `Candidate.convert`.

        Raises:
            InputError: if the convention is not known: it is ambiguous, or there is none.
        """
        if self.verdict != "unique":
            what = f"the convention is not known ({self.verdict})"
            raise InputError("not-identified", what, where=self.robot, remedy="give samples at other configurations")
        return self.candidates[0].convert(given)

    def __str__(self) -> str:
        if self.verdict == "unique":
            return _with_aliases(self.candidates[0])
        if self.verdict == "none":
            return "none of the conventions that are known"
        lines = ["ambiguous; each of these fits:", *(f"  {_with_aliases(each)}" for each in self.candidates)]
        if self.ask is not None:
            lines.append("give it at another q too, such as " + ",".join(f"{value:.4g}" for value in self.ask))
        return "\n".join(lines)

    def to_document(self) -> dict[str, Any]:
        """What `pinscrew identify --json` prints."""
        return {
            "schema": "pinscrew.identify/1",
            "robot": self.robot,
            "samples": self.samples,
            "verdict": self.verdict,
            "candidates": [_fields(each) for each in self.candidates],
            "ask": None if self.ask is None else self.ask.tolist(),
        }


def _with_aliases(candidate: Candidate) -> str:
    """A candidate with its other names, of which a few are enough for a person; the document has all."""
    if not candidate.aliases:
        return candidate.words
    more = len(candidate.aliases) - SHOWN
    rest = f", and {more} more" if more > 0 else ""
    return f"{candidate.words}; the same as {', '.join(candidate.aliases[:SHOWN])}{rest}"


def _fields(candidate: Candidate) -> dict[str, Any]:
    common = {"quantity": candidate.quantity, "words": candidate.words, "residual": candidate.residual}
    common["aliases"] = list(candidate.aliases)
    if candidate.encoding is not None:
        form, (base, frame) = candidate.encoding, candidate.frames
        own = {"frame": frame, "base": base, "encoding": form.form, "sequence": form.sequence or None}
        return {**common, **own, "order": form.order, "unit": UNITS[form.unit], "angle": form.angle}
    observer, writing = candidate.observer, candidate.writing
    if observer is None or writing is None:
        return common
    own_: dict[str, Any] = {
        "kind": observer.kind,
        "frame": observer.frame,
        "point": observer.point,
        "base": observer.base,
    }
    how = {"order": writing.order, "unit": UNITS[writing.unit], "angle": writing.angle, "layout": writing.layout}
    names = [candidate.names[i] for i in writing.joints]
    if observer.rates is not None:
        own_ |= {"encoding": observer.rates.form, "sequence": observer.rates.sequence or None}
        own_ |= {"rates": observer.rates.angle}
    return {**common, **own_, **how, "joints": names, "signs": list(writing.signs)}


def _converted(array: FloatArray, candidate: Candidate) -> FloatArray:
    writing = candidate.writing or Writing()
    per = 180.0 / np.pi if writing.angle == "deg" else 1.0
    if candidate.quantity == "twist":
        rows = array if writing.order == "v,w" else np.concatenate([array[..., 3:], array[..., :3]], axis=-1)
        return np.concatenate([rows[..., :3] * UNITS[writing.unit], rows[..., 3:] / per], axis=-1)
    J = np.swapaxes(array, -1, -2) if writing.layout == "transposed" else array
    J = J if writing.order == "v,w" else np.concatenate([J[..., -3:, :], J[..., :-3, :]], axis=-2)
    J = np.concatenate([J[..., :3, :] * UNITS[writing.unit], J[..., 3:, :]], axis=-2)
    found = np.zeros((*J.shape[:-1], len(candidate.names)))
    joints = list(writing.joints)
    scale = np.array(writing.signs) * np.where(candidate.turning[joints] > 0.0, per, 1.0)
    found[..., joints] = J * scale
    return found


def _code(candidate: Candidate) -> str:
    writing = candidate.writing
    if writing is None or candidate.quantity not in ("jacobian", "screws"):
        return ""
    lines = ["J = np.swapaxes(J, -1, -2)"] if writing.layout == "transposed" else []
    rates = candidate.observer.rates if candidate.observer else None
    turning = 4 if rates and rates.form.startswith("quaternion") else 3
    if writing.order == "w,v":
        lines.append(f"J = J[..., {[*range(turning, turning + 3), *range(turning)]}, :]")
    if writing.unit != "m":
        lines.append(f"J = J * np.array([[{UNITS[writing.unit]}]] * 3 + [[1.0]] * {turning})")
    per = np.where(candidate.turning[list(writing.joints)] > 0.0, 180.0 / np.pi, 1.0)
    scale = np.array(writing.signs) * (per if writing.angle == "deg" else 1.0)
    lines += [] if (scale == 1.0).all() else [f"J = J * np.array({[float(value) for value in scale]})"]
    if writing.joints != tuple(range(len(candidate.names))):
        lines.append(f"ours = np.zeros((*J.shape[:-1], {len(candidate.names)}))")
        lines.append(f"ours[..., {list(writing.joints)}] = J")
    else:
        lines.append("ours = J")
    return "\n".join(lines)
