"""From vectors, screws and twists to shapes: arrows, screw axes with their coils, velocity circles, ellipsoids.

Each function is a small formula that gives named parts, each a unit primitive times a transform. The page has the
same formulas (``page/twists.js``) and a test holds the two against each other, so a change here is one there.
What can't be drawn (no velocity, an axis far away) keeps its parts, with a transform that shrinks them to a point.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from pinscrew.description.visuals import Color
from pinscrew.ground.typing import FloatArray
from pinscrew.view.shapes import PlacedShape, Shape, stretch

__all__ = ["Line", "arrow", "circle", "ellipsoid", "frame_along", "line_of", "screw"]

THIN: Final = 0.005
"""Radius of an axis or arrow, in sizes of the robot, as all lengths here."""
COIL_RADIUS: Final = 0.075
BACK: Final = 0.16
"""How far an axis reaches backwards from its point."""
FRONT: Final = 0.28
COIL_AT: Final = 0.62
"""Where the coil is, as a part of `FRONT`: outside of what is drawn around a joint."""
MOST_TURNS: Final = 3.0
RING_TURNS: Final = 0.8
"""Of a coil of pitch 0, so that its arrow shows."""
RING_TUBE: Final = 0.0035
FARTHEST: Final = 12.0
"""An axis or a circle farther from its point than this is not drawn."""
NEGLIGIBLE: Final = 1e-9
"""Below this part of the rest, a rotation, a pitch or a radius is rounding."""


@dataclass(frozen=True, slots=True)
class Line:
    """The screw of a twist, as seen from a point.

    Attributes:
        point: the point of the axis that is nearest to where it is seen from, shape (3,); for a translation that
            place itself.
        direction: unit vector, shape (3,); zeros for no motion.
        pitch: m/rad; ``inf`` for a translation.
        velocity: of the place it is seen from, shape (3,).
    """

    point: FloatArray
    direction: FloatArray
    pitch: float
    velocity: FloatArray


def frame_along(point: FloatArray, direction: FloatArray) -> FloatArray:
    """A frame at ``point`` with z along the unit vector ``direction``, shape (4, 4)."""
    e = np.zeros(3)
    e[int(np.argmin(np.abs(direction)))] = 1.0
    x = e - (e @ direction) * direction
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3, 0], T[:3, 1], T[:3, 2], T[:3, 3] = x, np.cross(direction, x), direction, point
    return T


def line_of(twist: FloatArray, at: FloatArray, size: float) -> Line:
    """The screw of a spatial twist, seen from the point ``at``.

    A rotation so slow that it moves nothing of the robot's ``size`` visibly counts as none: the axis of what is a
    translation but for rounding lies anywhere.

    Args:
        twist: (v, ω) in the base frame, shape (6,).
        at: shape (3,).
        size: of the robot, m.
    """
    w = twist[3:]
    velocity = twist[:3] + np.cross(w, at)
    speed, rate = float(np.linalg.norm(velocity)), float(np.linalg.norm(w))
    if rate * size <= NEGLIGIBLE * speed or rate == 0.0:
        direction = velocity / speed if speed > 0.0 else np.zeros(3)
        return Line(at, direction, math.inf, velocity)
    pitch = float(w @ velocity) / rate**2
    if abs(pitch) <= NEGLIGIBLE * size:
        pitch = 0.0
    return Line(at + np.cross(w, velocity) / rate**2, w / rate, pitch, velocity)


def arrow(name: str, at: FloatArray, vector: FloatArray, radius: float, color: Color) -> list[PlacedShape]:
    """An arrow from ``at`` along ``vector``, of its length; a short one is thinner."""
    length = float(np.linalg.norm(vector))
    if length <= NEGLIGIBLE * radius:
        nothing = _nothing(at)
        return [
            PlacedShape(f"{name}-shaft", Shape("rod"), nothing, color),
            PlacedShape(f"{name}-head", Shape("cone"), nothing, color),
        ]
    r = radius * min(1.0, length / (10.0 * radius))
    head = 5.0 * r
    T = frame_along(at, vector / length)
    return [
        PlacedShape(f"{name}-shaft", Shape("rod"), T @ stretch(r, r, length - head), color),
        PlacedShape(f"{name}-head", Shape("cone"), T @ _up(length - head) @ stretch(2.5 * r, 2.5 * r, head), color),
    ]


def screw(name: str, line: Line, size: float, color: Color, *, bigger: float = 1.0) -> list[PlacedShape]:
    """The axis of a screw as an arrow, with a coil that advances by the pitch; for a translation a thick arrow alone.

    A coil has three turns, or as many as fit along the axis. At pitch 0 it is a ring, open so that it has a sense.
    """
    tube = THIN * size * bigger
    back, front, radius = BACK * size * bigger, FRONT * size * bigger, COIL_RADIUS * size * bigger
    hidden = not line.direction.any()
    turns, rise, lead = RING_TURNS, 0.0, 0.0
    if math.isfinite(line.pitch):
        lead = 2.0 * math.pi * line.pitch
        if abs(lead) > 3.0 * tube:
            turns = min(MOST_TURNS, (COIL_AT * front + back) / abs(lead))
            rise = line.pitch / radius
        else:
            lead = 0.0
    coil = Shape("coil", {"turns": turns, "rise": rise, "tube": tube / radius})
    if hidden:
        nothing = _nothing(line.point)
        axis = arrow(f"{name}axis", line.point, np.zeros(3), tube, color)
        return [
            *axis,
            PlacedShape(f"{name}coil", coil, nothing, color),
            PlacedShape(f"{name}tip", Shape("cone"), nothing, color),
        ]
    T = frame_along(line.point, line.direction)
    thick = tube if math.isfinite(line.pitch) else 1.8 * tube
    axis = arrow(f"{name}axis", line.point - back * line.direction, (back + front) * line.direction, thick, color)
    if not math.isfinite(line.pitch):
        nothing = _nothing(line.point)
        return [
            *axis,
            PlacedShape(f"{name}coil", coil, nothing, color),
            PlacedShape(f"{name}tip", Shape("cone"), nothing, color),
        ]
    T_coil = T @ _up(COIL_AT * front - max(turns * lead, 0.0)) @ stretch(radius, radius, radius)
    end = 2.0 * math.pi * turns
    tangent = np.array([-math.sin(end), math.cos(end), rise]) / math.hypot(1.0, rise)
    T_tip = frame_along(np.array([math.cos(end), math.sin(end), rise * end]), tangent)
    head = 5.0 * tube / radius
    return [
        *axis,
        PlacedShape(f"{name}coil", coil, T_coil, color),
        PlacedShape(f"{name}tip", Shape("cone"), T_coil @ T_tip @ stretch(0.5 * head, 0.5 * head, head), color),
    ]


def circle(
    name: str, twist: FloatArray, at: FloatArray, size: float, seconds: float, color: Color, *, bold: float = 1.0
) -> list[PlacedShape]:
    """The "circle drawing" of a velocity: the circle about the screw axis through ``at``, and the velocity there.

    The velocity's arrow is tangent to the circle, but for a pitch, which leads it out of the circle's plane. A
    translation has no circle.

    Args:
        name: of the parts.
        twist: spatial (v, ω), shape (6,).
        at: where the field of the twist is looked at: the base's origin or the tip's, shape (3,).
        size: of the robot, m.
        seconds: length of the arrow per unit of speed.
        color: of all parts.
        bold: how much thicker than usual.
    """
    line = line_of(twist, at, size)
    spoke = at - line.point
    radius = float(np.linalg.norm(spoke))
    parts = arrow(name, at, seconds * line.velocity, 1.2 * THIN * size * bold, color)
    ring = {"turns": 1.0, "rise": 0.0, "tube": RING_TUBE * bold * size / max(radius, 1e-3 * size)}
    T_ring, T_spoke = _nothing(line.point), _nothing(line.point)
    if math.isfinite(line.pitch) and 1e-6 * size < radius < FARTHEST * size:
        x = spoke / radius
        T = np.eye(4)
        T[:3, 0], T[:3, 1], T[:3, 2], T[:3, 3] = x, np.cross(line.direction, x), line.direction, line.point
        T_ring = T @ stretch(radius, radius, radius)
        thin = 0.5 * RING_TUBE * bold * size
        T_spoke = frame_along(line.point, x) @ stretch(thin, thin, radius)
    parts.append(PlacedShape(f"{name}-circle", Shape("coil", ring), T_ring, color))
    parts.append(PlacedShape(f"{name}-spoke", Shape("rod"), T_spoke, color))
    return parts


def ellipsoid(name: str, at: FloatArray, J: FloatArray, scale: float, thinnest: float, color: Color) -> PlacedShape:
    """The image of the unit ball under ``scale * J``, at least ``thinnest`` thick: the ball times (J Jᵀ)^½.

    Args:
        name: of the part.
        at: its centre, shape (3,).
        J: shape (3, n).
        scale: metres per unit of what J gives.
        thinnest: least half axis, m.
        color: of it.
    """
    squares, U = np.linalg.eigh(J @ J.T)
    half_axes = np.maximum(scale * np.sqrt(np.maximum(squares, 0.0)), thinnest)
    T = np.eye(4)
    T[:3, :3] = (U * half_axes) @ U.T
    T[:3, 3] = at
    return PlacedShape(name, Shape("sphere"), T, color)


def triad(length: float, radius: float, colors: Mapping[str, Color]) -> Sequence[PlacedShape]:
    """The axes of a frame, as rods in its own colours, in the frame."""
    places = []
    for i, name in enumerate("xyz"):
        T = frame_along(np.zeros(3), np.eye(3)[i])
        places.append(PlacedShape(name, Shape("rod"), T @ stretch(radius, radius, length), colors[name]))
    return places


def _up(z: float) -> FloatArray:
    T = np.eye(4)
    T[2, 3] = z
    return T


def _nothing(at: FloatArray) -> FloatArray:
    """A transform that shrinks to a point."""
    T = np.zeros((4, 4))
    T[:3, 3], T[3, 3] = at, 1.0
    return T
