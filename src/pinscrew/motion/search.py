"""The search for a configuration that reaches each target: descents from many starts, checked by a second engine."""

from __future__ import annotations

import math
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from pinscrew.engines.base import Engine
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import so3
from pinscrew.motion.descent import Descent
from pinscrew.motion.freedoms import Freedoms, Task

__all__ = ["SETTLED", "STEPS", "Findings", "Search"]

Findings: TypeAlias = tuple[FloatArray, FloatArray, FloatArray, npt.NDArray[np.str_]]
"""Configurations, errors in m and rad, and reasons."""

MARGIN: Final = 1e-3
"""What the search aims at, as a part of the tolerance: one step more."""
LEAST: Final = 1e-13
"""The least that it aims at: rounding."""
STEPS: Final = 60
SETTLED: Final = 0.9
"""A start is given up when `WINDOW` steps leave more than this of its squared error."""
LAST_STEPS: Final = 1000
LAST_SETTLED: Final = 1.0 - 1e-6
"""The same of the nearest configuration, where none reaches the target."""
DRAWN: Final = 10
"""Configurations that are drawn for each start: the nearest to the target become starts."""
GROWTH: Final = 4
"""By how much each round of starts is larger than the one before."""


class Search:
    """The search for configurations of one robot's frame.

    Attributes:
        free: the coordinates that are searched for.
        starts: most starts for a target.
        drawn: configurations within the limits to start from, shape (`DRAWN` times starts, m).
    """

    def __init__(
        self, free: Freedoms, engines: tuple[Engine, Engine], task: Task, starts: int, seed: int, tolerance: float
    ) -> None:
        """Draw the starts.

        Args:
            free: the coordinates that move the frame.
            engines: to search with, and to check with.
            task: reach the ``"pose"`` or the ``"position"``.
            starts: most starts for a target.
            seed: of the starts.
            tolerance: of a target that is reached: rad, and m over max(1, length).

        Raises:
            InputError: see `Freedoms.draw`.
        """
        self.free = free
        self._engines = engines
        self._task: Task = task
        self.starts = starts
        self._tolerance = tolerance
        self.drawn = free.draw(seed, starts, DRAWN)
        self._marks = self._features(Descent(free, engines[0], free.robot.neutral, task, 0.0).poses(self.drawn))

    def solve(self, T: FloatArray, q: FloatArray, given: bool) -> Findings:
        """Configurations (N, nq), errors (N,) in m and rad, and reasons (N,), from ``q`` (N, nq) first if ``given``."""
        nearest = self._nearest(T)
        first = q[:, self.free.q]
        if given:
            nearest = np.concatenate([first[:, None], nearest[:, : self.starts - 1]], axis=1)
        x, reached = self._descend(self.free, T, nearest)
        reason = np.where(reached, "", "unreachable").astype("U16")
        missed = np.flatnonzero(~reached)
        last = self.descent(self.free).run(T[missed], x[missed], LAST_STEPS, LAST_SETTLED, downhill=True)
        x[missed] = last.x
        reason[missed[~last.settled]] = "stalled"
        reason[missed[last.converged]] = ""
        missed = missed[~last.converged]
        if np.isfinite(self.free.limits[~self.free.wraps]).any():
            _, beyond = self._descend(self.free.unlimited(), T[missed], nearest[missed])
            reason[missed[beyond]] = "outside limits"
        out = self.free.put(q, self.free.nearest_turn(x, first))
        distance, angle, good = self.confirmed(T, out)
        reason[~good & (reason == "")] = "unconfirmed"
        reason[good] = ""
        return out, distance, angle, reason

    def _descend(self, free: Freedoms, T: FloatArray, starts: FloatArray) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
        """The best values (N, m) from starts (N, S, m), tried in rounds of growing size, and whether they do."""
        descent = self.descent(free)
        x, error, reached = starts[:, 0].copy(), np.full(len(T), np.inf), np.zeros(len(T), dtype=bool)
        at, size = 0, 1
        while at < starts.shape[1] and not reached.all():
            left = np.flatnonzero(~reached)
            chosen = starts[left, at : at + size]
            count = chosen.shape[1]
            lanes = descent.run(np.repeat(T[left], count, axis=0), chosen.reshape(-1, len(free.q)), STEPS, SETTLED)
            converged, errors = lanes.converged.reshape(-1, count), lanes.error.reshape(-1, count)
            # The first that converged, or else the one with the least error.
            best = np.where(converged.any(axis=1), converged.argmax(axis=1), errors.argmin(axis=1))
            rows = np.arange(len(left))
            reached[left] = converged[rows, best]
            better = reached[left] | (errors[rows, best] < error[left])
            x[left[better]] = lanes.x.reshape(-1, count, len(free.q))[rows, best][better]
            error[left[better]] = errors[rows, best][better]
            at, size = at + size, GROWTH * size
        return x, reached

    def descent(self, free: Freedoms) -> Descent:
        """The descent within the limits of these freedoms, to the error that is aimed at."""
        return Descent(free, self._engines[0], free.robot.neutral, self._task, max(LEAST, MARGIN * self._tolerance))

    def _features(self, T: FloatArray) -> FloatArray:
        """Numbers (N, k) whose distances tell how far poses are from each other."""
        p = T[:, :3, 3] / self.free.length
        # ‖R₁ - R₂‖² = 4 (1 - cos θ), twice the squared angle where that is small.
        return p if self._task == "position" else np.concatenate([p, T[:, :3, :3].reshape(-1, 9) / math.sqrt(2.0)], 1)

    def _nearest(self, T: FloatArray) -> FloatArray:
        """The drawn configurations nearest to each target, shape (N, starts, m), nearest first."""
        distances = (self._marks**2).sum(axis=1) - 2.0 * self._features(T) @ self._marks.T
        order = np.argsort(distances, axis=1, kind="stable")[:, : self.starts]
        return self.drawn[order]

    def confirmed(self, T: FloatArray, q: FloatArray) -> tuple[FloatArray, FloatArray, npt.NDArray[np.bool_]]:
        """Distances and angles (N,) by the second engine, and whether they are within the tolerance."""
        found = self._engines[1].fk(q, self.free.frame)
        distance = np.linalg.norm(found[:, :3, 3] - T[:, :3, 3], axis=1)
        angle = np.linalg.norm(so3.log(np.swapaxes(found[:, :3, :3], 1, 2) @ T[:, :3, :3]), axis=1)
        # A comparison with NaN is false, so the good ones are asked for.
        good = distance <= self._tolerance * max(1.0, self.free.length)
        return distance, angle, good & (angle <= self._tolerance) if self._task == "pose" else good
