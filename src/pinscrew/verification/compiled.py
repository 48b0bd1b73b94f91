"""The compiled engine, held against the others where so many configurations are asked for that it would be used."""

from __future__ import annotations

from typing import Final

from pinscrew.engines.base import Answers
from pinscrew.engines.compiled import can_compile
from pinscrew.engines.compiled.batch import Batch
from pinscrew.ground.typing import FloatArray
from pinscrew.robot.robot import Robot
from pinscrew.verification.comparison import Worst, jacobian_error, pose_error
from pinscrew.verification.configurations import speeds

__all__ = ["MANY", "CompiledChecks", "check_names"]

MANY: Final = 10_000
"""Random configurations from which `Batch` is compared too."""
FRAMES: Final = 4
"""On how many leaves at most: each more takes longer to compile."""


def check_names(samples: int) -> tuple[str, ...]:
    """What the checks of so many samples are called; none without a compiler."""
    return ("forward kinematics, compiled", "body Jacobian, compiled") if samples >= MANY and can_compile() else ()


class CompiledChecks:
    """The largest differences between `Batch` and another engine's answers."""

    def __init__(self, robot: Robot, frames: tuple[str, ...], among: tuple[str, ...], tolerance: float) -> None:
        """Compare the first of some frames, ``among`` those of the other engine's answers."""
        self.worst = tuple(Worst(name, tolerance) for name in check_names(MANY))
        self._engine = Batch(robot)
        self._fastest = speeds(robot)
        self.frames = frames[:FRAMES]
        self._places = [among.index(frame) for frame in self.frames]

    def see(self, q: FloatArray, answers: Answers, scales: FloatArray, start: int) -> None:
        """Take in a block of configurations ``q`` (N, nq), from index ``start`` on."""
        T, J = self._engine.fk_jacobian(q, self.frames, "body")
        self.worst[0].see(pose_error(T, answers.poses[:, self._places], scales), start)
        self.worst[1].see(jacobian_error(J, answers.jacobians["body"][:, self._places], scales) / self._fastest, start)
