"""The arm at zero as a small line drawing: its links, its axes, the frames at both ends."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from pinscrew.derivation.blocks import Sketch, SketchLabel, SketchLine
from pinscrew.derivation.forms import ClosedForms
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.robot.robot import Robot

__all__ = ["sketch"]

WIDTH, HEIGHT, MARGIN = 420.0, 300.0, 34.0
"""Of the drawing, in points."""
AZIMUTH, ELEVATION = np.radians(28.0), np.radians(22.0)
"""Whence it is seen: z is up, x comes towards the viewer, to the left."""
LINK, AXIS, SLIDE = "#5b6470", "#1a1a1a", "#7a3e9d"
FRAME: Final = ("#c0392b", "#1e8449", "#1f5fa8")
_NEAR: Final = 13.0
"""Labels do not come nearer to each other than this, in points."""


@dataclass(frozen=True, slots=True)
class _Spatial:
    """A line or a label in space, in metres."""

    points: FloatArray
    color: str
    width: float = 1.2
    dashed: bool = False
    label: str = ""
    formula: bool = False


def sketch(d: ClosedForms) -> Sketch:
    """The joints that move the frame, with the lengths of the file and all coordinates at zero."""
    robot = d.robot
    into = se3.inverse(robot.home(d.reference))
    tip = into @ robot.home(d.tip)
    points = [np.zeros(3), *(_origin(robot, into, joint.variable.joint) for joint in d.chain.joints), tip[:3, 3]]
    size = float(np.ptp(np.array(points), axis=0).max()) or 1.0
    parts = [_Spatial(np.array(points), LINK, 3.2)]
    for i, screw in enumerate(d.screws, 1):
        axis = _numbers(d, screw.omega if screw.revolute else screw.v)
        parts += _joint(i, screw.revolute, points[i], axis, size)
    parts += _frame(np.eye(4), d.reference, size)
    if d.tip != d.reference:
        parts += _frame(tip, d.tip, size)
    return _projected(parts)


def _origin(robot: Robot, into: FloatArray, joint: str) -> FloatArray:
    """Where a joint is: the origin of the link that it moves, which slides and turns do not leave."""
    child = next(each.child for each in robot.description.joints if each.name == joint)
    return np.asarray((into @ robot.home(child))[:3, 3])


def _numbers(d: ClosedForms, vector: object) -> FloatArray:
    return np.array([float(x.xreplace(dict(d.lengths))) for x in vector])  # type: ignore[attr-defined]


def _joint(i: int, revolute: bool, at: FloatArray, axis: FloatArray, size: float) -> Iterator[_Spatial]:
    reach = 0.34 * size
    label = rf"\xi_{{{i}}}"
    if not revolute:
        yield from _arrow(at, at + 0.42 * size * axis, SLIDE, 1.8, size)
        yield _Spatial(np.array([at + 0.5 * size * axis]), SLIDE, label=label, formula=True)
        return
    yield _Spatial(np.array([at - 0.6 * reach * axis, at + reach * axis]), AXIS, 0.9, dashed=True)
    yield _Spatial(np.array([at + 1.22 * reach * axis]), AXIS, label=label, formula=True)
    # A turn about the axis: three quarters of a circle, counter-clockwise as seen from the axis's end.
    other = np.cross(axis, [0.0, 0.0, 1.0] if abs(axis[2]) < 0.9 else [1.0, 0.0, 0.0])
    other /= np.linalg.norm(other)
    angles = np.linspace(0.0, 1.5 * np.pi, 25)[:, None]
    circle = 0.085 * size * (np.cos(angles) * other + np.sin(angles) * np.cross(axis, other))
    turn = at + 0.62 * reach * axis + circle
    yield _Spatial(turn[:-1], AXIS, 1.2)
    yield from _arrow(turn[-3], turn[-1], AXIS, 1.2, size)


def _frame(pose: FloatArray, name: str, size: float) -> Iterator[_Spatial]:
    at = pose[:3, 3]
    for k, letter in enumerate("xyz"):
        end = at + 0.2 * size * pose[:3, k]
        yield from _arrow(at, end, FRAME[k], 1.5, size)
        yield _Spatial(np.array([end + 0.05 * size * pose[:3, k]]), FRAME[k], label=letter, formula=True)
    yield _Spatial(np.array([at - 0.07 * size * pose[:3, :3].sum(axis=1)]), AXIS, label=name)


def _arrow(start: FloatArray, end: FloatArray, color: str, width: float, size: float) -> Iterator[_Spatial]:
    yield _Spatial(np.array([start, end]), color, width)
    along = (end - start) / np.linalg.norm(end - start)
    seen = np.array([np.cos(AZIMUTH) * np.cos(ELEVATION), np.sin(AZIMUTH) * np.cos(ELEVATION), np.sin(ELEVATION)])
    aside = np.cross(along, seen)
    back = end - 0.05 * size * along
    for sign in (-1.0, 1.0):
        yield _Spatial(np.array([end, back + sign * 0.022 * size * aside]), color, width)


def _projected(parts: list[_Spatial]) -> Sketch:
    """Seen from afar, fitted into the drawing."""
    right = np.array([-np.sin(AZIMUTH), np.cos(AZIMUTH), 0.0])
    up = np.array([-np.cos(AZIMUTH) * np.sin(ELEVATION), -np.sin(AZIMUTH) * np.sin(ELEVATION), np.cos(ELEVATION)])
    flat = [part.points @ np.stack([right, up], axis=1) for part in parts]
    everything = np.concatenate(flat)
    low, high = everything.min(axis=0), everything.max(axis=0)
    scale = float(min(np.array([WIDTH - 2 * MARGIN, HEIGHT - 2 * MARGIN]) / np.maximum(high - low, 1e-9)))
    width, height = (high - low) * scale + 2 * MARGIN
    lines: list[SketchLine] = []
    labels: list[SketchLabel] = []
    for part, points in zip(parts, flat, strict=True):
        placed = [(float(x), float(y)) for x, y in (points - low) * scale + MARGIN]
        if part.label:
            labels.append(SketchLabel(_free(placed[0], labels), part.label, part.color, part.formula))
        else:
            lines.append(SketchLine(tuple(placed), part.color, part.width, part.dashed))
    return Sketch(tuple(lines), tuple(labels), (float(width), float(height)))


def _free(at: tuple[float, float], labels: list[SketchLabel]) -> tuple[float, float]:
    """The place, or one beside it where another label stands."""
    x, y = at
    for step in range(8):
        moved = (x + _NEAR * (step % 2 + step // 2), y + _NEAR * (step // 2))
        if all(abs(moved[0] - o.at[0]) > 16.0 or abs(moved[1] - o.at[1]) > _NEAR - 1.0 for o in labels):
            return moved
    return at
