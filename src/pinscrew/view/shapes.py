"""What a scene is made of: unit primitives, each with a transform that places and stretches it.

Nothing here knows the viewer. The page draws the same primitives (``page/shapes.js``).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final, Literal, TypeAlias

import numpy as np

from pinscrew.description.visuals import Color
from pinscrew.ground.typing import FloatArray

__all__ = ["COLORS", "GROUPS", "Drawable", "Group", "PlacedShape", "Scene", "Shape"]

Kind: TypeAlias = Literal["box", "cylinder", "sphere", "mesh", "rod", "cone", "coil", "label", "line", "points"]

Group: TypeAlias = Literal["links", "frames", "screws", "velocity", "circles", "ellipsoid", "trace", "workspace"]

GROUPS: Final[tuple[Group, ...]] = (
    "links",
    "frames",
    "screws",
    "velocity",
    "circles",
    "ellipsoid",
    "trace",
    "workspace",
)
"""What can be drawn or left out, in the order of the page's check boxes."""

COLORS: Final[Mapping[str, Color]] = MappingProxyType(
    {
        "x": (0.84, 0.16, 0.16, 1.0),
        "y": (0.13, 0.60, 0.20, 1.0),
        "z": (0.13, 0.36, 0.85, 1.0),
        "revolute": (0.93, 0.46, 0.05, 1.0),
        "prismatic": (0.02, 0.56, 0.62, 1.0),
        "compound": (0.45, 0.28, 0.08, 1.0),
        "instantaneous": (0.80, 0.05, 0.38, 1.0),
        "linear": (0.10, 0.55, 0.16, 1.0),
        "angular": (0.72, 0.12, 0.62, 1.0),
        "spatial": (0.11, 0.40, 0.80, 1.0),
        "body": (0.50, 0.22, 0.82, 1.0),
        "manipulability": (0.20, 0.45, 0.90, 0.28),
        "velocity": (0.95, 0.65, 0.10, 0.28),
        "trace": (0.80, 0.05, 0.38, 1.0),
        "workspace": (0.35, 0.42, 0.55, 1.0),
    }
)
"""Colours of what is drawn besides the links; the page gets them with its document."""


@dataclass(frozen=True, slots=True)
class Shape:
    """A primitive of unit size.

    ========  =====================================================================================
    kind      what it is
    ========  =====================================================================================
    box       side 1, centred
    cylinder  radius 1, length 1 along z, centred
    sphere    radius 1, centred
    rod       radius 1, from z = 0 to z = 1
    cone      base of radius 1 at z = 0, apex at z = 1
    coil      tube along (cos θ, sin θ, rise θ), θ from 0 to 2π turns, of radius tube
    label     text at the origin, always of the same size on the screen
    line      straight pieces through points, shape (N, 3)
    points    dots, shape (N, 3)
    mesh      triangles of a file, in its own coordinates
    ========  =====================================================================================

    Attributes:
        parameters: turns, rise and tube of a coil.
        text: of a label.
        points: of a line or a cloud, shape (N, 3).
        mesh: which mesh, in the scene's list.
    """

    kind: Kind
    parameters: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))
    text: str = ""
    points: FloatArray | None = None
    mesh: int = -1


@dataclass(frozen=True, slots=True)
class PlacedShape:
    """A shape with its transform in the frame of whatever it is a part of.

    Attributes:
        name: which part, unique in its owner.
        transform: rotation, stretch and position, shape (4, 4).
    """

    name: str
    shape: Shape
    transform: FloatArray
    color: Color


@dataclass(frozen=True, slots=True)
class Drawable:
    """A shape in the scene.

    Attributes:
        group: which of the things that can be drawn or left out it belongs to.
        owner: the link, joint or coordinate it shows; any text.
        name: which part of it.
        transform: from the unit primitive to the base frame, shape (4, 4).
    """

    group: Group
    owner: str
    name: str
    shape: Shape
    transform: FloatArray
    color: Color

    @property
    def path(self) -> tuple[str, str, str]:
        """Where it is in the tree: group, owner, part."""
        return self.group, self.owner, self.name


@dataclass(frozen=True, slots=True)
class Scene:
    """Everything drawn at one configuration.

    Attributes:
        poses: of each link in the base frame, shape (4, 4).
        drawables: by `Drawable.path`.
    """

    poses: Mapping[str, FloatArray]
    drawables: Mapping[tuple[str, str, str], Drawable]

    def group(self, name: Group) -> tuple[Drawable, ...]:
        """The drawables of one group."""
        return tuple(drawable for drawable in self.drawables.values() if drawable.group == name)


def stretch(x: float, y: float, z: float) -> FloatArray:
    """The transform that stretches along the axes, shape (4, 4)."""
    return np.diag([x, y, z, 1.0])
