"""What a kernel computes for each configuration: the numbers of poses, Jacobians and manipulabilities."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from typing import Final

from llvmlite import ir

from pinscrew.engines.compiled.chain import LARGEST_ANGLE, Chain, Part, Question
from pinscrew.engines.compiled.kernel import Kernel, Rows
from pinscrew.engines.compiled.lanes import Lanes
from pinscrew.engines.compiled.walk import JointMove, LaneNumber, columns, manipulability, pose

__all__ = ["compile_kernel", "rows_of"]

_ROWS_OF: Final[dict[Part, slice]] = {"all": slice(0, 6), "translation": slice(0, 3), "rotation": slice(3, 6)}


def compile_kernel(chains: Sequence[Chain], question: Question, nq: int, nv: int, single: tuple[bool, bool]) -> Kernel:
    """The kernel whose results are the parts of the answer, each for all frames: shape (F, …) per configuration.

    Args:
        chains: one per frame.
        question: about each of them.
        nq, nv: how many coordinates and velocities the robot has.
        single: whether coordinates, and whether results, are float32.
    """
    lengths = [math.prod(shape) * len(chains) for shape in question.shapes(nv)]
    return Kernel(nq, rows_of(chains, question, nv), lengths, single)


def rows_of(chains: Sequence[Chain], question: Question, nv: int) -> Rows:
    """The arithmetic from coordinates to the parts of the answer; see `compile_kernel`."""

    def rows(q: list[Lanes]) -> tuple[list[list[LaneNumber]], list[ir.Value]]:
        good = [x.within(sys.float_info.max) for x in q]
        one = Lanes(q[0].build, q[0].constant(1.0))
        turns: dict[tuple[int, float], tuple[LaneNumber, LaneNumber]] = {}
        answers = []
        for chain in chains:
            moves: list[JointMove] = []
            for step in chain.steps:
                source, multiplier = key = step.motion.q, step.motion.multiplier
                value = multiplier * q[source]
                if not step.turns:
                    moves.append((1.0, 0.0, value))
                    continue
                if key not in turns and isinstance(value, Lanes):
                    turns[key] = value.turn()
                    good.append(value.within(LARGEST_ANGLE))
                moves.append((*turns.get(key, (1.0, 0.0)), 0.0))  # a multiplier of 0 leaves no lanes
            answers.append(_about(chain, question, moves, nv, one))
        return [[number for part in parts for number in part] for parts in zip(*answers, strict=True)], good

    return rows


def _about(chain: Chain, question: Question, moves: Sequence[JointMove], nv: int, one: Lanes) -> list[list[LaneNumber]]:
    """The numbers of one frame's pose, Jacobian and manipulability, as far as they are asked for."""
    if question.kind is None and question.part is None:
        return [_pose_row(*pose(chain, moves))]
    twists, found = columns(chain, question.kind or "body", moves)
    J: list[list[LaneNumber]] = [[0.0] * nv for _ in range(6)]
    for step, (v, w) in zip(chain.steps, twists, strict=True):
        for row, number in zip(J, [*v, *w], strict=True):
            row[step.motion.v] = row[step.motion.v] + step.motion.multiplier * number
    parts = [_pose_row(*found)] if question.poses else []
    if question.kind is not None:
        parts.append([number for row in J for number in row])
    if question.part is not None:
        moving = sorted({step.motion.v for step in chain.steps})
        parts.append([_manipulability(J[_ROWS_OF[question.part]], moving, one)])
    return parts


def _pose_row(R: Sequence[Sequence[LaneNumber]], p: Sequence[LaneNumber]) -> list[LaneNumber]:
    return [number for row in zip(*R, p, strict=True) for number in row] + [0.0, 0.0, 0.0, 1.0]


def _manipulability(J: list[list[LaneNumber]], moving: Sequence[int], one: Lanes) -> LaneNumber:
    """The product of the singular values of some rows of the Jacobian, without the columns that move nothing."""
    rows = [[row[i] for i in moving] for row in J]
    vectors = rows if len(moving) > len(rows) else [list(column) for column in zip(*rows, strict=True)]
    square = manipulability(vectors, one) if vectors else 0.0
    return square.root() if isinstance(square, Lanes) else 0.0
