"""Along a chain: poses, Jacobian columns and manipulability with the fewest operations.

Numbers may be floats or anything with their arithmetic: `lanes.Lanes` emits instructions, and folds constants.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from pinscrew.engines.compiled.chain import Chain, Step
from pinscrew.ground.typing import FloatArray, JacobianKind
from pinscrew.lie import se3

__all__ = ["JointMove", "LaneNumber", "Pose", "Twist", "columns", "manipulability", "pose"]

LaneNumber: TypeAlias = Any
"""A float or something that computes like one."""
Vector: TypeAlias = list[LaneNumber]
JointMove: TypeAlias = tuple[LaneNumber, LaneNumber, LaneNumber]
"""What a joint does along or about its axis: the cosine and sine of its angle, and how far it slides."""
Twist: TypeAlias = tuple[Vector, Vector]
"""(v, ω)."""
Pose: TypeAlias = tuple[list[Vector], Vector]
"""The columns of the rotation, and the position."""


def pose(chain: Chain, moves: Sequence[JointMove]) -> Pose:
    """The frame's pose in the base; one move for each step."""
    frame = _Frame.of(chain.start)
    for step, move in zip(chain.steps, moves, strict=True):
        frame.joint(step, move)
        frame.step(step)
    frame.turn(*chain.last)
    return [frame.x, frame.y, frame.z], frame.p


def columns(chain: Chain, kind: JacobianKind, moves: Sequence[JointMove]) -> tuple[list[Twist], Pose]:
    """The Jacobian's column of each step, before multipliers, and the frame's pose in the base.

    For the body Jacobian the chain is walked from the frame to the base: there the axes of the joints appear in the
    frame's own coordinates, and need not be turned into them. The pose that comes of that is the base's in the frame.
    """
    if kind == "body":
        return _body_columns(chain, moves)
    frame = _Frame.of(chain.start)
    lines = []
    for step, move in zip(chain.steps, moves, strict=True):
        lines.append((step, frame.z, frame.p))
        frame.joint(step, move)
        frame.step(step)
    frame.turn(*chain.last)
    if kind == "hybrid":
        lines = [(step, z, [a - b for a, b in zip(point, frame.p, strict=True)]) for step, z, point in lines]
    return [_column(*line) for line in lines], ([frame.x, frame.y, frame.z], frame.p)


def manipulability(vectors: Sequence[Vector], one: LaneNumber) -> LaneNumber:
    """The square of the product of the singular values of a matrix, by Gram and Schmidt.

    Args:
        vectors: its rows or its columns, whichever are fewer.
        one: 1, as a number with `lanes.Lanes.reciprocal`.
    """
    rest = [list(vector) for vector in vectors]
    square = one
    for index, vector in enumerate(rest):
        norm = _dot(vector, vector)
        square = square * norm
        inverse = one.reciprocal(norm)
        for later in rest[index + 1 :]:
            share = _dot(vector, later) * inverse
            later[:] = [a - share * b for a, b in zip(later, vector, strict=True)]
    return square


def _body_columns(chain: Chain, moves: Sequence[JointMove]) -> tuple[list[Twist], Pose]:
    frame = _Frame.of(np.eye(4))
    cos, sin = chain.last
    frame.turn(cos, -sin)
    found = []
    for step, move in zip(reversed(chain.steps), reversed(moves), strict=True):
        frame.step(step, back=True)
        frame.joint(step, move, back=True)
        found.append(_column(step, frame.z, frame.p))
    frame.constant(se3.inverse(chain.start))
    R = [frame.x, frame.y, frame.z]
    return found[::-1], ([list(row) for row in zip(*R, strict=True)], [-_dot(column, frame.p) for column in R])


def _column(step: Step, z: Vector, point: Vector) -> Twist:
    """The twist of a unit velocity about, or along, a line: v = point × ω (MLS, section 3.2)."""
    if not step.turns:
        return z, [0.0, 0.0, 0.0]
    (a, b, c), (x, y, w) = point, z
    return [b * w - c * y, c * x - a * w, a * y - b * x], z


@dataclass(slots=True)
class _Frame:
    """A frame on its way: the columns of its rotation, and its position."""

    x: Vector
    y: Vector
    z: Vector
    p: Vector

    @classmethod
    def of(cls, T: FloatArray) -> _Frame:
        return cls(*([float(value) for value in T[:3, i]] for i in range(4)))

    def joint(self, step: Step, move: JointMove, *, back: bool = False) -> None:
        """Move with a joint, and by its step's constant turn about the same axis; or back."""
        sign = -1.0 if back else 1.0
        cos, sin, slide = move
        c, s = step.turn
        self._shift(self.z, sign * slide)
        self.turn(cos * c - sin * s, sign * (sin * c + cos * s))

    def step(self, step: Step, *, back: bool = False) -> None:
        """Move by a step's translation and its tilt; or back."""
        sign = -1.0 if back else 1.0
        c, s = step.tilt
        if back:
            self._tilt(c, -s)
        for axis, distance in zip((self.x, self.y, self.z), step.shift, strict=True):
            self._shift(axis, sign * distance)
        if not back:
            self._tilt(c, s)

    def turn(self, c: LaneNumber, s: LaneNumber) -> None:
        """Turn about z."""
        pairs = list(zip(self.x, self.y, strict=True))
        self.x, self.y = [c * x + s * y for x, y in pairs], [c * y - s * x for x, y in pairs]

    def constant(self, T: FloatArray) -> None:
        """Move by a constant pose."""
        axes = self.x, self.y, self.z
        for axis, distance in zip(axes, T[:3, 3], strict=True):
            self._shift(axis, float(distance))
        rows = list(zip(*axes, strict=True))
        self.x, self.y, self.z = ([_dot(list(row), list(map(float, T[:3, i]))) for row in rows] for i in range(3))

    def _tilt(self, c: float, s: float) -> None:
        pairs = list(zip(self.y, self.z, strict=True))
        self.y, self.z = [c * y + s * z for y, z in pairs], [c * z - s * y for y, z in pairs]

    def _shift(self, axis: Vector, distance: LaneNumber) -> None:
        self.p = [p + distance * a for p, a in zip(self.p, axis, strict=True)]


def _dot(a: Vector, b: Vector) -> LaneNumber:
    total: LaneNumber = 0.0
    for x, y in zip(a, b, strict=True):
        total = total + x * y
    return total
