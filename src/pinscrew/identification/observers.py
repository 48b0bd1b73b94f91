"""Who looks: the point whose velocity is meant, and the frame in which it is written down."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.ground.errors import AmbiguousTipError
from pinscrew.ground.typing import FloatArray
from pinscrew.identification.encodings import Encoding
from pinscrew.identification.rates import rates_of
from pinscrew.robot.robot import Robot

__all__ = ["Observer", "moving", "observed", "observers"]

MIXED: Final = 16
"""At most so many frames for each to be tried with the axes of each other."""


@dataclass(frozen=True)
class Observer:
    """How a twist of a frame is written down.

    Attributes:
        frame: whose motion it is.
        point: the frame whose origin the linear part is the velocity of: ``frame``, or the base for ``"spatial"``.
        base: the frame whose axes it is written in.
        root: the robot's base.
        offset: where the point stands in ``point``, m: a tool that the file does not know.
        rates: of what, in place of ω: an analytic Jacobian, of the pose of the frame in the base.
    """

    frame: str
    point: str
    base: str
    root: str
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rates: Encoding | None = None

    @property
    def kind(self) -> str:
        """``"spatial"``, ``"body"``, ``"hybrid"``, ``"analytic"``, or ``"mixed"``: the axes of another frame."""
        if self.rates is not None:
            return "analytic"
        if self.point == self.root and self.point != self.frame:
            return "spatial" if self.base == self.root else "mixed"
        return "body" if self.base == self.frame else "hybrid" if self.base == self.root else "mixed"

    @property
    def words(self) -> str:
        """What it is called."""
        called = {"spatial": "Pinocchio WORLD", "body": "Pinocchio LOCAL", "hybrid": "Pinocchio LOCAL_WORLD_ALIGNED"}
        if self.rates is not None:
            return f"the analytic {{}} of {self.frame}, rates of its position and {self.rates.name} in {self.root}"
        if any(self.offset):
            at = ", ".join(f"{value:.6g}" for value in self.offset)
            return f"the {self.kind} {{}} of the point ({at}) m in {self.frame}"
        if self.kind in called:
            return f"the {self.kind} {{}} of {self.frame} ({called[self.kind]})"
        return f"the {{}} of {self.frame} at the origin of {self.point}, in the axes of {self.base}"


def moving(robot: Robot) -> list[str]:
    """The frames that move: the default tip first, if there is one, then those that more joints move."""
    frames = [name for name in robot.frame_names[::-1] if robot.motions_above(name)]
    try:
        tip = robot.tip
    except AmbiguousTipError:
        tip = ""
    return sorted(frames, key=lambda name: (name != tip, -len(robot.motions_above(name))))


def observers(robot: Robot) -> Iterator[Observer]:
    """All that are tried, the plainest first: the last frame, then those before it; axes of other frames at the end."""
    root = robot.base
    frames = moving(robot)
    for frame in frames:
        for point, base in ((root, root), (frame, frame), (frame, root)):
            yield Observer(frame, point, base, root)
    if len(frames) <= MIXED:
        for frame in frames:
            yield from (Observer(frame, frame, base, root) for base in frames if base != frame)


def observed(engine: Engine, observer: Observer, q: FloatArray) -> FloatArray:
    """The Jacobian as an observer has it, rows (v, ω) or v and rates; shape (N, 6, nv), or (N, 7, nv).

    A point p that moves with the frame has the velocity v + ω × p (MLS eq. 2.53), p in the axes of v. Columns of a
    hybrid Jacobian turned into the axes of a frame G: diag(R_base_Gᵀ, R_base_Gᵀ) Jʰ (MLS eq. 2.58, p = 0).
    """
    if observer.kind == "spatial":
        return np.asarray(engine.jacobian(q, observer.frame, "spatial"))
    if observer.kind == "body":
        return _moved(np.asarray(engine.jacobian(q, observer.frame, "body")), np.array(observer.offset))
    J = np.asarray(engine.jacobian(q, observer.frame, "hybrid"))
    if observer.rates is not None:
        R_base_frame = np.asarray(engine.fk(q, observer.frame))[:, :3, :3]
        return np.concatenate([J[:, :3], rates_of(observer.rates, R_base_frame) @ J[:, 3:]], axis=1)
    if observer.kind == "hybrid" and not any(observer.offset):
        return J
    if observer.kind == "hybrid":
        R_base_frame = np.asarray(engine.fk(q, observer.frame))[:, :3, :3]
        return _moved(J, R_base_frame @ np.array(observer.offset))
    R_base_axes = np.asarray(engine.fk(q, observer.base))[:, :3, :3]
    turned = np.swapaxes(R_base_axes, -1, -2)
    return np.concatenate([turned @ J[:, :3], turned @ J[:, 3:]], axis=1)


def _moved(J: FloatArray, point: FloatArray) -> FloatArray:
    """Columns of a point beside the frame's origin; ``point`` has the shape (3,) or (N, 3)."""
    linear = J[:, :3] + np.cross(J[:, 3:], point[..., :, None], axisa=1, axisb=-2, axisc=1)
    return np.concatenate([linear, J[:, 3:]], axis=1)
