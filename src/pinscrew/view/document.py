"""The document that a page is given: the robot's screws, what is fixed to its links, and how to begin. Plain JSON."""

from __future__ import annotations

import base64
import math
from collections.abc import Collection
from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias

import numpy as np

from pinscrew.ground.typing import FloatArray, JacobianKind
from pinscrew.view import opening, scene
from pinscrew.view.mesh_files import MeshPart
from pinscrew.view.model import Body, Model
from pinscrew.view.shapes import COLORS, GROUPS, Group, PlacedShape

__all__ = ["Animation", "State", "document"]

Json: TypeAlias = dict[str, Any]

DEFAULT_DRAW: Final[tuple[Group, ...]] = ("links", "frames", "screws")


@dataclass(frozen=True, slots=True)
class Animation:
    """Configurations to show one after the other: shape (N, nq), at ``fps`` a second."""

    trajectory: FloatArray
    fps: float


@dataclass(frozen=True, slots=True)
class State:
    """How a page begins.

    Attributes:
        q: configuration, shape (nq,).
        qd: velocities, shape (nv,).
        kind: of the Jacobian in the panel.
        draw: what is drawn.
        animation: what is played.
    """

    q: FloatArray
    qd: FloatArray
    kind: JacobianKind = "spatial"
    draw: Collection[Group] = DEFAULT_DRAW
    animation: Animation | None = field(default=None)


def document(model: Model, state: State, *, live: str = "", picture: tuple[int, int] | None = None) -> Json:
    """What a page needs to know.

    Args:
        model: the robot, made ready.
        state: how the page begins.
        live: the token of the server to talk to; empty where there is none.
        picture: width and height in pixels, to show the scene alone at this size, without the panel.
    """
    robot = model.robot
    motions = robot.mechanism.motions
    animation = state.animation
    return {
        "schema": "pinscrew.view/1",
        "live": live,
        "picture": picture,
        "name": robot.name,
        "base": robot.base,
        "tip": model.tip,
        "size": model.size,
        "coordinates": [
            {
                "name": name,
                "lower": _finite(low),
                "upper": _finite(high),
                "neutral": float(zero),
                "opening": float(start),
                "angle": unit == "rad",
            }
            for name, (low, high), zero, start, unit in zip(
                robot.coordinate_names,
                robot.limits,
                robot.neutral,
                opening.configuration(robot),
                robot.coordinate_units,
                strict=True,
            )
        ],
        "velocities": list(robot.velocity_names),
        "motions": [
            {
                "joint": motion.joint.name,
                "type": motion.joint.type,
                "parent": motion.parent,
                "home": _matrix(motion.T_base_child),
                "twists": motion.twists.T.tolist(),
                "q": motion.q,
                "v": motion.v,
                "multiplier": motion.multiplier,
                "offset": motion.offset,
                "mimic": motion.joint.mimic is not None,
            }
            for motion in motions
        ],
        "frames": [
            {"name": name, "motion": robot.mechanism.motion_above[name], "home": _matrix(robot.home(name))}
            for name in robot.frame_names
        ],
        "bodies": [_body(body) for body in model.bodies],
        "meshes": [_mesh(part) for part in model.meshes],
        "scales": {
            "linear": model.scales.linear.tolist(),
            "field": model.scales.field.tolist(),
            "angular": model.scales.angular.tolist(),
            "limits": model.scales.limits.tolist(),
        },
        "colors": {name: list(color) for name, color in COLORS.items()},
        "groups": list(GROUPS),
        "state": {
            "q": state.q.tolist(),
            "qd": state.qd.tolist(),
            "kind": state.kind,
            "draw": [group for group in GROUPS if group in state.draw],
            "trace": scene.trail(model, state.q).tolist() if state.q.any() else [],
            "workspace": np.round(scene.cloud(model), 6).tolist(),
        },
        "animation": None if animation is None else {"trajectory": animation.trajectory.tolist(), "fps": animation.fps},
    }


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _matrix(T: FloatArray) -> list[float]:
    """A matrix as 16 numbers, row by row."""
    return [float(x) for x in T.ravel()]


def _body(body: Body) -> Json:
    return {
        "group": body.group,
        "owner": body.owner,
        "motion": body.motion,
        "home": _matrix(body.home),
        "parts": [_part(part) for part in body.parts],
    }


def _part(part: PlacedShape) -> Json:
    shape = part.shape
    found: Json = {
        "name": part.name,
        "kind": shape.kind,
        "transform": _matrix(part.transform),
        "color": list(part.color),
    }
    if shape.parameters:
        found["parameters"] = dict(shape.parameters)
    if shape.kind == "label":
        found["text"] = shape.text
    if shape.kind == "mesh":
        found["mesh"] = shape.mesh
    return found


def _mesh(part: MeshPart) -> Json:
    """A mesh in few bytes: positions in 65536 steps along each axis of its box, normals in 8 bits."""
    low, high = part.bounds
    step = np.where(high > low, (high - low) / 65535.0, 1.0)
    positions = np.round((part.vertices - low) / step).astype("<u2")
    normals = np.round(np.clip(np.nan_to_num(part.normals), -1.0, 1.0) * 127.0).astype("i1")
    wide = len(part.vertices) > 65536
    return {
        "low": low.tolist(),
        "step": step.tolist(),
        "positions": _base64(positions),
        "normals": _base64(normals),
        "faces": _base64(part.faces.astype("<u4" if wide else "<u2")),
        "wide": wide,
    }


def _base64(array: Any) -> str:
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")
