"""What of a scene does not change as the robot moves: sizes, scales, and the parts fixed to links and joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from pinscrew.description.visuals import DEFAULT_COLOR, Looks, Visual
from pinscrew.engines.poe import PoE
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.robot.robot import Robot
from pinscrew.view import opening, twists
from pinscrew.view.mesh_files import Mesh, MeshPart
from pinscrew.view.shapes import COLORS, Group, PlacedShape, Shape, stretch

__all__ = ["Body", "Model", "Scales", "samples"]

SMALLEST: Final = 1e-6
"""Size (m) given to a robot that has neither reach nor looks."""
SAMPLES: Final = 64
FARTHEST: Final = 1e6
"""Limits beyond this many half turns, or sizes of the robot, count as this far for random configurations."""
CROWDED: Final = 5
"""With more joints than this, what is drawn about each gets smaller."""


@dataclass(frozen=True, slots=True)
class Body:
    """Parts that move with a link or with the parent of a joint.

    Attributes:
        group: of the parts.
        owner: the link, or the joint whose axis they show.
        motion: index in ``mechanism.motions`` of the joint that moves them most directly, or -1.
        home: pose of their frame at zero, shape (4, 4).
    """

    group: Group
    owner: str
    motion: int
    home: FloatArray
    parts: tuple[PlacedShape, ...]


@dataclass(frozen=True, slots=True)
class Scales:
    """Lengths in the scene per unit of what they stand for, so that what is drawn fits the robot.

    Attributes:
        linear: most that a unit of each velocity moves the tip, m, shape (nv,).
        field: likewise the tip or what passes the base's origin, m, shape (nv,).
        angular: most that it turns the tip, rad, shape (nv,).
        limits: each velocity's limit, 1 where there is none, shape (nv,).
    """

    linear: FloatArray
    field: FloatArray
    angular: FloatArray
    limits: FloatArray


@dataclass(frozen=True, slots=True)
class Model:
    """A robot made ready to be drawn.

    Attributes:
        robot: the robot.
        engine: what poses and Jacobians come from.
        tip: the frame whose velocity is shown at first.
        size: of the robot, m; all lengths that stand for nothing follow it.
        bodies: what is rigid.
        meshes: that shapes refer to, by number.
        scales: of velocities and ellipsoids.
    """

    robot: Robot
    engine: PoE
    tip: str
    size: float
    bodies: tuple[Body, ...]
    meshes: tuple[MeshPart, ...]
    scales: Scales

    @classmethod
    def of(cls, robot: Robot, looks: Looks, meshes: Mapping[Visual, Mesh], tip: str | None = None) -> Model:
        """The model of a robot.

        Args:
            robot: the robot.
            looks: of its links.
            meshes: of the visuals that are meshes.
            tip: the frame whose velocity is shown; by default `opening.default_tip`.

        Raises:
            UnknownNameError: if there is no frame ``tip``.
        """
        tip = opening.default_tip(robot) if tip is None else robot.frame(tip)
        solids: dict[str, list[PlacedShape]] = {name: [] for name in robot.frame_names}
        parts: list[MeshPart] = []
        for visual in looks.visuals:
            placed = solids[visual.link]
            placed += _solid(visual, meshes, parts, len(placed))
        size = _size(robot, solids, parts)
        bodies = []
        long, short = (
            twists.triad(part * size, width * size, COLORS) for part, width in ((0.17, 0.0055), (0.11, 0.004))
        )
        for name in robot.frame_names:
            motion, home = robot.mechanism.motion_above[name], robot.mechanism.homes[name]
            if solids[name]:
                bodies.append(Body("links", name, motion, home, tuple(solids[name])))
            bodies.append(
                Body("frames", name, motion, home, _frame(name, long if name in (robot.base, tip) else short))
            )
        bodies += _axes(robot, size)
        engine = PoE(robot)
        scales = _scales(robot, engine, tip, size)
        return cls(robot, engine, tip, size, tuple(bodies), tuple(parts), scales)


def samples(robot: Robot, count: int, size: float, seed: int = 0) -> FloatArray:
    """Random configurations within the limits, shape (count, nq).

    Where there are none, angles are within ±π and displacements within ± the robot's size; quaternions are uniform.
    None is farther than `FARTHEST` times that.
    """
    rng = np.random.default_rng(seed)
    limits = robot.limits.copy()
    reach = np.where(robot.mechanism.coordinates.slides, size, np.pi)
    limits[:, 0] = np.where(np.isfinite(limits[:, 0]), limits[:, 0], -reach)
    limits[:, 1] = np.where(np.isfinite(limits[:, 1]), limits[:, 1], reach)
    limits = np.clip(limits, -FARTHEST * reach[:, None], FARTHEST * reach[:, None])
    q: FloatArray = rng.uniform(limits[:, 0], limits[:, 1], (count, robot.nq))
    for motion in robot.mechanism.motions:
        if motion.joint.type == "floating":
            quaternion = rng.normal(size=(count, 4))
            q[:, motion.q + 3 : motion.q + 7] = quaternion / np.linalg.norm(quaternion, axis=1, keepdims=True)
    return q


def _solid(visual: Visual, meshes: Mapping[Visual, Mesh], parts: list[MeshPart], start: int) -> list[PlacedShape]:
    """The parts of a visual, named by numbers from ``start``; new meshes are added to ``parts``."""
    geometry, T = visual.geometry, visual.T_link_visual
    color = visual.color or DEFAULT_COLOR
    if geometry.kind == "mesh":
        placed = []
        for i, part in enumerate(meshes[visual]):
            if part not in parts:
                parts.append(part)
            own = part.color or visual.color or DEFAULT_COLOR  # as RViz: a mesh's own colours come first
            scaled = T @ stretch(*geometry.size)
            placed.append(PlacedShape(str(start + i), Shape("mesh", mesh=parts.index(part)), scaled, own))
        return placed
    if geometry.kind == "box":
        shapes = [("box", T @ stretch(*geometry.size))]
    elif geometry.kind == "sphere":
        (r,) = geometry.size
        shapes = [("sphere", T @ stretch(r, r, r))]
    else:
        r, length = geometry.size
        shapes = [("cylinder", T @ stretch(r, r, length))]
        if geometry.kind == "capsule":
            for end in (-0.5 * length, 0.5 * length):
                at = np.eye(4)
                at[2, 3] = end
                shapes.append(("sphere", T @ at @ stretch(r, r, r)))
    return [PlacedShape(str(start + i), Shape(kind), M, color) for i, (kind, M) in enumerate(shapes)]  # type: ignore[arg-type]


def _frame(name: str, axes: Sequence[PlacedShape]) -> tuple[PlacedShape, ...]:
    """Axes and label of a link's frame."""
    return (*axes, PlacedShape("label", Shape("label", text=name), np.eye(4), (0.1, 0.1, 0.12, 1.0)))


def _axes(robot: Robot, size: float) -> list[Body]:
    """The screw of each joint that has one. It is carried by the joint's parent: its own motion leaves it."""
    bodies = []
    for motion in robot.mechanism.motions:
        if motion.twists.shape[1] != 1:
            continue
        color = COLORS["prismatic" if motion.joint.type == "prismatic" else "revolute"]
        line = twists.line_of(motion.twists[:, 0], motion.T_base_child[:3, 3], size)
        parts = twists.screw("", line, size, color)
        at = np.eye(4)
        at[:3, 3] = line.point + 1.06 * twists.FRONT * size * line.direction
        parts.append(PlacedShape("label", Shape("label", text=motion.joint.name), at, color))
        bodies.append(Body("screws", motion.joint.name, motion.parent, np.eye(4), tuple(parts)))
    return bodies


def _size(robot: Robot, solids: Mapping[str, Sequence[PlacedShape]], meshes: Sequence[MeshPart]) -> float:
    """The reach, but three quarters of the extent at zero at least, and all of it at most.

    A lead screw has no reach, and the reach of an arm that is folded at zero is longer than the arm.
    """
    origins = np.array([home[:3, 3] for home in robot.mechanism.homes.values()])
    low, high = origins.min(axis=0), origins.max(axis=0)
    for name, placed in solids.items():
        for part in placed:
            half = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])
            if part.shape.kind == "mesh":
                half = meshes[part.shape.mesh].bounds
            elif part.shape.kind in ("box", "cylinder"):
                half = half * ([0.5] * 3 if part.shape.kind == "box" else [1.0, 1.0, 0.5])
            corners = np.array([[x, y, z, 1.0] for x in half[:, 0] for y in half[:, 1] for z in half[:, 2]])
            world = (robot.mechanism.homes[name] @ part.transform @ corners.T)[:3].T
            low, high = np.minimum(low, world.min(axis=0)), np.maximum(high, world.max(axis=0))
    extent = float(np.linalg.norm(high - low))
    whole = max(min(robot.reach, extent), 0.75 * extent, SMALLEST)
    return whole * min(1.0, float(np.sqrt(CROWDED / max(len(robot.mechanism.motions), 1))))


def _scales(robot: Robot, engine: PoE, tip: str, size: float) -> Scales:
    q = samples(robot, SAMPLES, size)
    hybrid, spatial = engine.jacobian(q, tip, "hybrid"), engine.jacobian(q, tip, "spatial")
    limits = np.ones(robot.nv)
    for motion in robot.mechanism.motions:
        limit = motion.joint.limits.velocity
        if motion.joint.mimic is None and np.isfinite(limit) and limit > 0.0:
            limits[motion.velocities] = limit
    linear, angular = _greatest(hybrid[:, :3], size), _greatest(hybrid[:, 3:], 1.0)
    return Scales(linear, np.maximum(linear, _greatest(spatial[:, :3], size)), angular, limits)


def _greatest(columns: FloatArray, unit: float) -> FloatArray:
    """Greatest length of each column over a batch (N, 3, nv), zero where that is rounding: shape (nv,)."""
    found: FloatArray = np.linalg.norm(columns, axis=1).max(axis=0)
    return np.where(found > twists.NEGLIGIBLE * unit, found, 0.0)


def displacement(engine: PoE, q: FloatArray) -> Mapping[int, FloatArray]:
    """The displacement of each motion's child from its place at zero, by the motion's index: shape (4, 4)."""
    mechanism = engine.robot.mechanism
    found: dict[int, FloatArray] = {-1: np.eye(4)}
    for i, motion in enumerate(mechanism.motions):
        found[i] = engine.fk(q, motion.joint.child) @ se3.inverse(motion.T_base_child)
    return found
