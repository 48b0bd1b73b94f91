"""Robots and engines that are wrong on purpose, each in one way, for `verify` to catch."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

import pinscrew as ps
import urdfs
from pinscrew.engines.base import Answers, Engine, JointView
from pinscrew.ground.typing import FloatArray

TEXT = urdfs.robot(
    urdfs.joint("j1", "revolute", "base", "l1", xyz="0 0 0.3"),
    urdfs.joint("j2", "revolute", "l1", "l2", xyz="0.4 0 0", rpy="0.1 0.2 0.3", axis="0 1 0"),
    urdfs.joint("j3", "prismatic", "l2", "l3", xyz="0.2 0.1 0", axis="0 0.6 0.8"),
    urdfs.joint("j4", "revolute", "l3", "l4", xyz="0.2 0 0.1", axis="1 0 0", mimic=("j2", 0.5, 0.25)),
    urdfs.joint("mount", "fixed", "l4", "tool", xyz="0.2 0.1 0", rpy="0 0.4 0"),
    links="base l1 l2 l3 l4 tool",
)
ROBOT = urdfs.load(TEXT)


def edited(*changes: tuple[str, str], text: str = TEXT) -> ps.Robot:
    """The robot of the text with each (old, new) applied to its only place."""
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return urdfs.load(text)


def with_motions(**changes: Mapping[str, Any]) -> ps.Robot:
    """The robot with fields of these joints' motions replaced: screws that are not those of the file."""
    robot = urdfs.load(TEXT)
    motions = (replace(m, **changes.get(m.joint.name, {})) for m in robot.mechanism.motions)
    object.__setattr__(robot, "mechanism", replace(robot.mechanism, motions=tuple(motions)))
    return robot


def motion(joint: str) -> Any:
    """The motion of a joint of `ROBOT`."""
    return next(m for m in ROBOT.mechanism.motions if m.joint.name == joint)


Alter = Callable[[Answers, Sequence[str], FloatArray], None]
"""Changes answers in place, given the frames they are about and the configurations."""


class Altered:
    """An engine whose answers are changed on their way out, the same ones however they are asked for."""

    def __init__(self, engine: Engine, alter: Alter, joints: Mapping[str, JointView] | None = None) -> None:
        self.name, self.robot, self._engine, self._alter = engine.name, engine.robot, engine, alter
        self._joints = engine.joints() if joints is None else joints

    def joints(self) -> Mapping[str, JointView]:
        return self._joints

    def answers(self, q: FloatArray, qd: FloatArray, frames: Sequence[str]) -> Answers:
        answers = self._engine.answers(q, qd, frames)
        self._alter(answers, frames, q)
        return answers

    def fk(self, q: FloatArray, frame: str) -> FloatArray:
        return self._flat(q, frame).poses.reshape(*q.shape[:-1], 4, 4)

    def jacobian(self, q: FloatArray, frame: str, kind: Any) -> FloatArray:
        return self._flat(q, frame).jacobians[kind].reshape(*q.shape[:-1], 6, self.robot.nv)

    def _flat(self, q: FloatArray, frame: str) -> Answers:
        flat = q.reshape(-1, self.robot.nq)
        return self.answers(flat, np.zeros((len(flat), self.robot.nv)), [frame])


def pair(side: int, altered: ps.Robot | Alter) -> tuple[Any, Any]:
    """PoE and Pinocchio, of which the one at index ``side`` has another robot, or is `Altered`."""
    engines: list[Any] = [ps.PoE, ps.Pinocchio]
    made = [engine(ROBOT) for engine in engines]
    made[side] = engines[side](altered) if isinstance(altered, ps.Robot) else Altered(made[side], altered)
    return made[0], made[1]
