"""`sweep`: the pose of a frame and how well it moves, over a grid or a sample of the joints' ranges."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from decimal import Decimal
from pathlib import Path
from typing import Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.engines.compiled.batch import for_many
from pinscrew.engines.measures import generic_ranks
from pinscrew.ground.counts import whole
from pinscrew.ground.errors import InputError
from pinscrew.ground.memory import free_bytes
from pinscrew.ground.typing import FloatArray, KindLike, jacobian_kind
from pinscrew.robot.loading import RobotLike, robot_of
from pinscrew.robot.robot import Robot
from pinscrew.workspace import archive
from pinscrew.workspace.axes import GridSteps, Ranges, axes, grid_counts, grid_points, sobol
from pinscrew.workspace.measures import Measures

__all__ = ["SAMPLES", "STEP", "Sweep", "sweep"]

STEP: Final = math.radians(5.0)
"""The step (rad) of the default grid."""
SAMPLES: Final = 2**14
"""Configurations where there is no default grid."""
BLOCK: Final = 4096
"""Configurations per question to the engine."""
SHARE: Final = 0.5
"""The part of the machine's memory that a sweep may take."""

SEQUENCE: Final = "scrambled Sobol of scipy"
SCHEMA: Final = "pinscrew.sweep/1"
_SHAPES: Final = {
    "q": ("f", (None,)),
    "poses": ("f", (4, 4)),
    "translation": ("f", (None,)),
    "rotation": ("f", (None,)),
}


@dataclass(frozen=True, eq=False)
class Sweep:
    """A frame at N configurations.

    Attributes:
        q: coordinates, shape (N, nq), rad and m; those that don't move the frame are as in `Robot.neutral`.
        poses: T_base_frame, shape (N, 4, 4).
        translation: how well the frame's origin moves, in m per unit of a coordinate.
        rotation: how well the frame turns, in rad per unit of a coordinate.
        jacobians: shape (N, 6, nv), rows (v, ω); None if they were not asked for.
        metadata: where all this comes from: robot and fingerprint, frame, ranges, grid or samples and seed, kind of
            the Jacobians, engine, versions. Plain data.
    """

    q: FloatArray = field(repr=False)
    poses: FloatArray = field(repr=False)
    translation: Measures = field(repr=False)
    rotation: Measures = field(repr=False)
    jacobians: FloatArray | None = field(repr=False)
    metadata: archive.Metadata

    @property
    def positions(self) -> FloatArray:
        """The frame's origin in the base, shape (N, 3), m."""
        return self.poses[:, :3, 3]

    def save(self, path: str | Path) -> None:
        """Write everything to an npz file, whole or not at all; ``numpy.load(path)`` reads it without pickle.

        Raises:
            InputError: if it can't be written.
        """
        arrays: archive.Arrays = {"q": self.q, "poses": self.poses}
        arrays["translation"] = self.translation.singular_values
        arrays["rotation"] = self.rotation.singular_values
        if self.jacobians is not None:
            arrays["jacobians"] = self.jacobians
        archive.save(Path(path), SCHEMA, self.metadata, arrays)

    @classmethod
    def load(cls, path: str | Path) -> Sweep:
        """Read what `save` wrote.

        Raises:
            InputError: if there is no such file, or it is no sweep or a broken one.
        """
        metadata, found = archive.load(Path(path), SCHEMA, _SHAPES)
        measures = Measures(found["translation"]), Measures(found["rotation"])
        return cls(found["q"], found["poses"], *measures, found.get("jacobians"), metadata)


def sweep(
    robot: RobotLike,
    *,
    grid: GridSteps | None = None,
    samples: float | None = None,
    seed: int = 0,
    frame: str | None = None,
    ranges: Ranges | None = None,
    kind: KindLike | None = None,
    engine: Engine | None = None,
) -> Sweep:
    """Poses and Jacobians of a frame over a grid, or over a sample of low discrepancy, of the joints' ranges.

    Without ``grid`` and ``samples``, one or two angles get a grid of 5°, anything else `SAMPLES` samples.

    Args:
        robot: a robot, or a name or path that `load` takes.
        grid: the step for all angles (rad), or steps by coordinate (rad or m). Both ends of a range are in the
            grid, and a step that does not divide the range is shortened to one that does. The last coordinate
            varies fastest.
        samples: how many points of a Sobol sequence to take; powers of 2 are balanced best.
        seed: of the sequence's scrambling.
        frame: a link's name; by default the robot's tip.
        ranges: lower and upper end by coordinate (rad or m), instead of its limits. An angle without limits has a
            full turn from -π, of which a grid leaves the end out.
        kind: keep the Jacobians, of this kind: ``"spatial"``, ``"body"`` or ``"hybrid"``; see `pinscrew.ground.typing`.
        engine: whom to ask; by default `Batch`, or `PoE` where it can't be compiled.

    Raises:
        InputError: if ``grid`` and ``samples`` are both given, are not positive or ask for more than half of the
            memory, or a range is missing or wrong; a floating joint moves the frame, or none does.
        UnknownNameError, AmbiguousTipError: see `Robot.frame`; also for a coordinate that does not exist.
        MissingExtraError: if scipy is not installed, and samples are asked for.
    """
    robot = robot_of(robot)
    frame = robot.frame(frame)
    kind = None if kind is None else jacobian_kind(kind)
    found = axes(robot, frame, ranges)
    if grid is not None and samples is not None:
        raise InputError("grid", "both a grid and samples are asked for", remedy="leave one out")
    if grid is None and samples is None:
        small = len(found) <= 2 and all(axis.angle for axis in found)
        grid, samples = (STEP, None) if small else (None, SAMPLES)
    count, seed = whole("samples", 1 if samples is None else samples, 1), whole("seed", seed, 0)
    points = None if grid is None else grid_counts(found, grid)
    count = count if points is None else math.prod(points)
    engine = engine or for_many(robot)
    ranks = generic_ranks(engine, frame)
    _fits(robot, count, sum(ranks) + (0 if kind is None else 6 * robot.nv))
    q = np.tile(robot.neutral, (count, 1))
    q[:, [axis.index for axis in found]] = sobol(found, count, seed) if points is None else grid_points(found, points)
    made: archive.Metadata = {"samples": count, "seed": seed, "sequence": SEQUENCE}
    if points is not None:
        made = {"grid": {axis.name: n for axis, n in zip(found, points, strict=True)}}
    metadata = {**archive.provenance(robot, engine, frame, found), **made, "jacobian_kind": kind}
    return _asked(engine, q, ranks, metadata)


def _asked(engine: Engine, q: FloatArray, ranks: tuple[int, int], metadata: archive.Metadata) -> Sweep:
    """The sweep over the configurations ``q``."""
    n, nv, (r_v, r_w) = len(q), engine.robot.nv, ranks
    frame, kind = metadata["frame"], metadata["jacobian_kind"]
    poses, v, w = np.empty((n, 4, 4)), np.empty((n, r_v)), np.empty((n, r_w))
    jacobians = None if kind is None else np.empty((n, 6, nv))
    for start in range(0, n, BLOCK):
        block = slice(start, start + BLOCK)
        poses[block], J = engine.fk_jacobian(q[block], frame, "hybrid")
        v[block] = np.linalg.svd(J[:, :3], compute_uv=False)[:, :r_v]
        w[block] = np.linalg.svd(J[:, 3:], compute_uv=False)[:, :r_w]
        if jacobians is not None:
            jacobians[block] = J if kind == "hybrid" else engine.jacobian(q[block], frame, kind)
    return Sweep(q, poses, Measures(v), Measures(w), jacobians, metadata)


def _fits(robot: Robot, count: int, numbers: int) -> None:
    """Refuse more configurations than memory has room for, with so many numbers each beside ``q`` and the pose."""
    needed = 8 * count * (2 * robot.nq + 16 + numbers)
    memory = free_bytes()
    if needed > SHARE * memory:
        gigabytes = Decimal(needed) / 2**30  # too many points for a float, maybe
        what = f"{Decimal(count):.4g} configurations need {gigabytes:.4g} GiB of memory, and "
        remedy = "take a larger step or fewer samples, or make a reachability map, which keeps voxels only"
        raise InputError("memory", f"{what}{memory / 2**30:.3g} GiB are free", where=robot.name, remedy=remedy)
