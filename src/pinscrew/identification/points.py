"""Points that no frame stands at: where a tool must be that a file does not know, for a Jacobian to be right."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.ground.typing import FloatArray
from pinscrew.identification.observers import Observer, moving, observed
from pinscrew.robot.robot import Robot

__all__ = ["Movable", "movable"]

TURNING: Final = 2
"""Columns that turn the frame, at least: with one, many a wrong column is a right one of another point."""
RANK: Final = 1e-9


@dataclass(frozen=True, eq=False)
class Movable:
    """An observer whose point may be any of the frame.

    Attributes:
        observer: who sees the frame's origin.
        J: what it sees, shape (N, 6, nv).
        hats: [ω]× of each column, times what turns p into its axes; shape (N, nv, 3, 3).
    """

    observer: Observer
    J: FloatArray
    hats: FloatArray

    def explaining(self, linear: FloatArray, angular: FloatArray) -> Iterator[Observer]:
        """At a point that explains a Jacobian as well as any; whether it does is for the caller to check.

        A point p of the frame has v' = v + ω × p in each column, which is linear in p: [ω]× p = v' - v, by least
        squares over all columns and samples. What of p these leave open is zero, and then another point comes as well.

        Args:
            linear: v' of each velocity's column, m, shape (N, 3, nv).
            angular: ω of each, shape (N, 3, nv).
        """
        if not np.allclose(self.J[:, 3:], angular, atol=1e-2):
            return
        wanted = (linear - self.J[:, :3]).transpose(0, 2, 1).reshape(-1)
        rows = self.hats.reshape(-1, 3)
        _, singular, axes = np.linalg.svd(rows, full_matrices=False)
        p = np.linalg.lstsq(rows, wanted, rcond=RANK)[0]
        open_ = [axis for value, axis in zip(singular, axes, strict=True) if value <= RANK * singular[0]]
        for point in (p, *(p + axis for axis in open_)):
            yield replace(self.observer, offset=(float(point[0]), float(point[1]), float(point[2])))


def movable(robot: Robot, engine: Engine, q: FloatArray) -> Iterator[Movable]:
    """Observers on frames that at least `TURNING` joints turn, at configurations of the shape (N, nq)."""
    for frame in moving(robot):
        for base in (frame, robot.base):
            observer = Observer(frame, frame, base, robot.base)
            J = observed(engine, observer, q)
            if (abs(J[:, 3:]).max(axis=(0, 1)) > RANK).sum() < TURNING:
                continue
            hats = np.cross(J[:, 3:, :, None], np.eye(3)[None, :, None, :], axis=1).transpose(0, 2, 1, 3)
            if base != frame:
                hats = hats @ np.asarray(engine.fk(q, frame))[:, None, :3, :3]
            yield Movable(observer, J, hats)
