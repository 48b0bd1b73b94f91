"""Newton's method on the error twist, damped, for many targets and starts at once.

The body error twist e = log(T⁻¹T*) changes with the body velocity V = J q̇ of the frame as ė = -𝒥⁻¹(e) V, 𝒥 the left
Jacobian of SE(3). A step solves 𝒥⁻¹J dq = e; as 𝒥e = e, that is J dq = e where it has a solution: Newton's method, of
quadratic convergence. Away from the target and at singularities the step is that of Levenberg and Marquardt, with a
damping in proportion to the squared error, after T. Sugihara, "Solvability-unconcerned inverse kinematics by the
Levenberg-Marquardt method", IEEE Transactions on Robotics 27(5), 2011, doi:10.1109/TRO.2011.2148230: no step is long,
and the last ones are not damped. Coordinates at a limit that a step would cross are kept there, and the step is found
anew.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from pinscrew.engines.base import Engine
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.motion.freedoms import Freedoms, Task, task_rows

__all__ = ["Descent", "Searches"]

DAMPING: Final = 0.1
"""Damping per squared scaled error e²: steps are at most e / (2 √(DAMPING e²)) = 1.6 rad."""
EASED: Final = 0.3
"""Factor of the damping after a step downhill that lessened the error."""
RAISED: Final = 4.0
"""The same after one that did not."""
FLOOR: Final = 1e-12
"""Damping that is always there, as a part of the trace of JᵀJ: far above rounding, too small to slow the last steps."""
WINDOW: Final = 10
"""Steps after which a descent is asked how far it has come."""


@dataclass(frozen=True, slots=True)
class Searches:
    """Where some descents ended.

    Attributes:
        x: the best values on each way, shape (N, m).
        error: their squared scaled error, shape (N,).
        converged: whether the target was reached, shape (N,).
        settled: whether the error had stopped falling before, shape (N,).
    """

    x: FloatArray
    error: FloatArray
    converged: npt.NDArray[np.bool_]
    settled: npt.NDArray[np.bool_]


class Descent:
    """Descents of one frame to poses, or to positions."""

    def __init__(self, free: Freedoms, engine: Engine, q: FloatArray, task: Task, goal: float) -> None:
        """Fix what is common to all descents.

        Args:
            free: the coordinates that move the frame.
            engine: answers for poses and Jacobians.
            q: values of the other coordinates, shape (nq,).
            task: reach ``"pose"`` or ``"position"``.
            goal: error that is small enough: of angles (rad), and of positions over the characteristic length.
        """
        self._free = free
        self._engine = engine
        self._q = q
        self._weights = task_rows(task, free.length)
        self._goal = goal

    def poses(self, x: FloatArray) -> FloatArray:
        """Poses (N, 4, 4) of the frame at ``x`` (N, m)."""
        return self._engine.fk(self._free.put(self._q, x), self._free.frame)

    def run(self, T: FloatArray, x: FloatArray, steps: int, settled: float, *, downhill: bool = False) -> Searches:
        """Go from ``x`` to the targets ``T``, each lane on its own.

        Args:
            T: targets, shape (N, 4, 4).
            x: starts within the limits, shape (N, m).
            steps: most steps.
            settled: a lane ends when `WINDOW` steps leave more than this part of its squared error.
            downhill: take back each step that does not lessen the error, and damp the next one more. It is slower,
                and ends at a minimum; without it a lane may leap from one valley to another.
        """
        x = x.copy()
        best = Searches(x.copy(), np.full(len(x), np.inf), np.zeros(len(x), dtype=bool), np.zeros(len(x), dtype=bool))
        before, damping = np.full(len(x), np.inf), np.full(len(x), DAMPING)
        errors = np.zeros((len(x), len(self._weights)))
        going = np.arange(len(x))
        for step in range(steps + 1):
            error = self._error(T[going], x[going])
            square = (error * error).sum(axis=1)
            better = square < best.error[going]
            best.x[going[better]], best.error[going[better]] = x[going[better]], square[better]
            best.converged[going] = np.abs(error).max(axis=1) <= self._goal
            if downhill:
                damping[going] *= np.where(better, EASED, RAISED)
                x[going] = best.x[going]
                errors[going[better]] = error[better]
            else:
                errors[going] = error
            on = ~best.converged[going]
            if step % WINDOW == WINDOW - 1:
                best.settled[going] = on & ~(best.error[going] < settled * before[going])
                before[going] = best.error[going]
                on &= ~best.settled[going]
            going = going[on]
            if not len(going) or step == steps:
                break
            x[going] = self._free.brought_within(x[going] + self._step(x[going], errors[going], damping[going]))
        return best

    def _error(self, T: FloatArray, x: FloatArray) -> FloatArray:
        """Scaled error twist of the frame in its own frame, shape (N, 6) or (N, 3)."""
        T_tip_base = se3.inverse(self.poses(x))
        if len(self._weights) == 6:
            return se3.log(T_tip_base @ T) * self._weights
        return (T_tip_base @ T)[:, :3, 3] * self._weights

    def _step(self, x: FloatArray, error: FloatArray, damping: FloatArray) -> FloatArray:
        """The damped step of each lane, shape (N, m): its entries that cross a limit they are at are zero."""
        free, weights = self._free, self._weights
        J = self._engine.jacobian(free.put(self._q, x), free.frame, "body")[:, : len(weights), free.v]
        if len(weights) == 6:
            # ė = -𝒥⁻¹(e) J q̇: what is solved is 𝒥⁻¹J dq = e.
            J = se3.left_jacobian_inverse(error / weights) @ J
        A = weights[:, None] * J * free.scales
        H = np.swapaxes(A, 1, 2) @ A
        g = (A * error[:, :, None]).sum(axis=1)
        diagonal = np.arange(len(free.q))
        # Levenberg and Marquardt: (AᵀA + λI) dq = Aᵀe with λ in proportion to ‖e‖² (Sugihara), and a floor in
        # proportion to H itself, so that it has an inverse where A has lost rank.
        H[:, diagonal, diagonal] += (damping * (error**2).sum(axis=1) + FLOOR * np.trace(H, axis1=1, axis2=2))[:, None]
        y = _solved(H, g)
        stuck = np.zeros(y.shape, dtype=bool)
        for _ in diagonal:  # each round keeps one more coordinate at its limit, or is the last
            crossing = free.held(x, y)
            lanes = crossing.any(axis=1)
            if not lanes.any():
                break
            stuck |= crossing
            loose = ~stuck[lanes]
            reduced = H[lanes] * (loose[:, :, None] & loose[:, None, :])
            reduced[:, diagonal, diagonal] += stuck[lanes]
            y[lanes] = _solved(reduced, g[lanes] * loose)
        return y * free.scales


def _solved(H: FloatArray, g: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.solve(H, g[:, :, None])[:, :, 0])
