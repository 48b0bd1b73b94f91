"""The scene at one configuration: every drawable with its pose. No viewer, no file, no server.

What is rigid comes from the `Model`; what depends on velocities is made anew here, from the engine's Jacobians and
the formulas in `twists`. The page does the same for itself as its sliders move; this is what it is tested against.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.view import twists
from pinscrew.view.model import Model, displacement, samples
from pinscrew.view.shapes import COLORS, Drawable, Group, PlacedShape, Scene, Shape

__all__ = ["arrow_scales", "build", "cloud", "default_rates", "trail"]

ARROW: Final = 0.6
"""Sizes of the robot that the arrow of the greatest possible velocity is long."""
ELLIPSOID: Final = 0.5
"""Sizes of the robot to which the half axes of an ellipsoid are bounded."""
THINNEST: Final = 1e-3
"""Sizes of the robot that an ellipsoid is thick at least, so that a flat one shows."""
TRAIL: Final = 65
CLOUD: Final = 2000
LINEAR_RATE: Final = 0.25


def build(
    model: Model,
    q: ArrayLike,
    qd: ArrayLike | None = None,
    *,
    tip: str | None = None,
    trace: ArrayLike | None = None,
    workspace: ArrayLike | None = None,
) -> Scene:
    """The scene of a robot.

    Args:
        model: the robot, made ready.
        q: configuration, shape (nq,), rad and m.
        qd: velocities, shape (nv,), rad/s and m/s; by default `default_rates`.
        tip: the frame whose velocity is shown; by default the model's.
        trace: points that the tip has passed, shape (N, 3), in the base frame; by default `trail` from zero.
        workspace: points that the tip can reach, shape (N, 3); by default `cloud`.

    Raises:
        InputError, UnknownNameError: see `Engine.jacobian`.
    """
    robot, engine = model.robot, model.engine
    tip = model.tip if tip is None else robot.frame(tip)
    q = np.asarray(q, dtype=np.float64)
    rates = default_rates(model) if qd is None else np.asarray(qd, dtype=np.float64)
    if q.ndim != 1 or rates.ndim != 1:
        raise InputError("shape", "q and qd must be of one configuration", remedy=f"({robot.nq},) and ({robot.nv},)")
    moved = displacement(engine, q)
    drawables = [
        Drawable(
            body.group, body.owner, part.name, part.shape, moved[body.motion] @ body.home @ part.transform, part.color
        )
        for body in model.bodies
        for part in body.parts
    ]

    def add(group: Group, owner: str, *parts: PlacedShape) -> None:
        drawables.extend(Drawable(group, owner, part.name, part.shape, part.transform, part.color) for part in parts)

    J = engine.jacobian(q, tip, "spatial")
    T_base_tip = engine.fk(q, tip)
    at = T_base_tip[:3, 3]
    size, seconds = model.size, arrow_scales(model, rates)
    twist = J @ rates
    for i in _compound(model, tip):
        line = twists.line_of(J[:, i], at, size)
        add("screws", robot.velocity_names[i], *twists.screw("compound-", line, size, COLORS["compound"]))
    add("velocity", tip, *_tip_velocity(twist, at, size, seconds))
    for i in _moving(model, tip):
        own = J[:, i] * rates[i]
        add("circles", robot.velocity_names[i], *_circles("", own, at, size, seconds[0], 1.0))
    add("circles", tip, *_circles("sum-", twist, at, size, seconds[0], 1.7))
    add("ellipsoid", tip, *_ellipsoids(model, engine.jacobian(q, tip, "hybrid")[:3], at))
    trace = trail(model, q, tip) if trace is None else np.asarray(trace, dtype=np.float64)
    add("trace", tip, PlacedShape("line", Shape("line", points=trace), np.eye(4), COLORS["trace"]))
    workspace = cloud(model, tip) if workspace is None else np.asarray(workspace, dtype=np.float64)
    add("workspace", tip, PlacedShape("points", Shape("points", points=workspace), np.eye(4), COLORS["workspace"]))
    poses = {name: moved[robot.mechanism.motion_above[name]] @ robot.home(name) for name in robot.frame_names}
    return Scene(poses, {drawable.path: drawable for drawable in drawables})


def default_rates(model: Model) -> FloatArray:
    """Velocities where none are given: 1 rad/s, and a quarter of the robot's size per second; shape (nv,)."""
    rates = np.ones(model.robot.nv)
    for motion in model.robot.mechanism.motions:
        linear = {"prismatic": [0], "planar": [0, 1], "floating": [0, 1, 2]}.get(motion.joint.type, [])
        if motion.joint.mimic is None:
            rates[[motion.v + i for i in linear]] = LINEAR_RATE * model.size
    return rates


def arrow_scales(model: Model, rates: FloatArray) -> tuple[float, float]:
    """Metres of an arrow per m/s and per rad/s.

    They follow what these rates could at most do to the tip, not what they do at one configuration: so arrows keep
    their scale while the robot moves, and fit it.
    """
    most = np.abs(rates) @ model.scales.field, np.abs(rates) @ model.scales.angular
    linear, angular = (ARROW * model.size / float(bound) if bound > 0.0 else 0.0 for bound in most)
    return linear, 0.7 * angular


def trail(model: Model, q: FloatArray, tip: str | None = None) -> FloatArray:
    """Where the tip passes if all coordinates go from zero to ``q`` together, shape (N, 3)."""
    robot = model.robot
    path = robot.neutral + np.linspace(0.0, 1.0, TRAIL)[:, None] * (q - robot.neutral)
    for motion in robot.mechanism.motions:
        if motion.joint.type == "floating":
            quaternion = slice(motion.q + 3, motion.q + 7)
            path[:, quaternion] += (path[:, quaternion] == 0.0).all(axis=1, keepdims=True) * robot.neutral[quaternion]
            path[:, quaternion] /= np.linalg.norm(path[:, quaternion], axis=1, keepdims=True)
    return model.engine.fk(path, model.tip if tip is None else tip)[:, :3, 3]


def cloud(model: Model, tip: str | None = None) -> FloatArray:
    """Random points that the tip can reach, shape (N, 3)."""
    q = samples(model.robot, CLOUD, model.size)
    return model.engine.fk(q, model.tip if tip is None else tip)[:, :3, 3]


def _moving(model: Model, tip: str) -> list[int]:
    """The velocities that move the tip."""
    motions = [model.robot.mechanism.motions[i] for i in model.robot.motions_above(tip)]
    return sorted({i for motion in motions for i in range(motion.velocities.start, motion.velocities.stop)})


def _compound(model: Model, tip: str) -> list[int]:
    """The velocities that move the tip through several joints: their one screw is none of the joints' own."""
    motions = [model.robot.mechanism.motions[i] for i in model.robot.motions_above(tip)]
    driven = [motion.v for motion in motions]
    return sorted({v for v in driven if driven.count(v) > 1})


def _tip_velocity(twist: FloatArray, at: FloatArray, size: float, seconds: tuple[float, float]) -> list[PlacedShape]:
    line = twists.line_of(twist, at, size)
    if np.linalg.norm(line.point - at) > twists.FARTHEST * size:
        line = twists.Line(at, np.zeros(3), line.pitch, line.velocity)
    return [
        *twists.screw("screw-", line, size, COLORS["instantaneous"], bigger=1.35),
        *twists.arrow("v", at, seconds[0] * line.velocity, 1.6 * twists.THIN * size, COLORS["linear"]),
        *twists.arrow("w", at, seconds[1] * twist[3:], 1.6 * twists.THIN * size, COLORS["angular"]),
    ]


def _circles(
    name: str, twist: FloatArray, at: FloatArray, size: float, seconds: float, bold: float
) -> list[PlacedShape]:
    base = np.zeros(3)
    return [
        *twists.circle(f"{name}spatial", twist, base, size, seconds, COLORS["spatial"], bold=bold),
        *twists.circle(f"{name}body", twist, at, size, seconds, COLORS["body"], bold=bold),
    ]


def _ellipsoids(model: Model, J: FloatArray, at: FloatArray) -> list[PlacedShape]:
    """The tip's velocities for velocities of norm 1, and for such as the joints' velocity limits allow."""
    found = []
    for name, weights in (("manipulability", np.ones(model.robot.nv)), ("velocity", model.scales.limits)):
        bound = float(np.linalg.norm(model.scales.linear * weights))
        scale = ELLIPSOID * model.size / bound if bound > 0.0 else 0.0
        found.append(twists.ellipsoid(name, at, J * weights, scale, THINNEST * model.size, COLORS[name]))
    return found
