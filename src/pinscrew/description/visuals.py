"""What a file says its links look like: the ``<visual>`` elements, with their materials and the files of their meshes.

Kinematics never reads this: a robot whose looks are wrong can be loaded, but not drawn.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, Literal, TypeAlias

import numpy as np

from pinscrew.description import markup, orientation
from pinscrew.description.markup import Element
from pinscrew.description.meshes import mesh_file
from pinscrew.description.model import Description, read_only
from pinscrew.description.packages import Packages
from pinscrew.description.values import numbers
from pinscrew.ground.errors import DescriptionError, PinscrewWarning
from pinscrew.ground.typing import FloatArray

__all__ = ["DEFAULT_COLOR", "Color", "Geometry", "Looks", "Visual", "read"]

Color: TypeAlias = tuple[float, float, float, float]
"""Red, green, blue and opacity, each from 0 to 1."""

DEFAULT_COLOR: Final[Color] = (0.62, 0.65, 0.69, 1.0)
"""Of a visual without a material."""

_SIZES: Final[dict[str, dict[str, int]]] = {
    "box": {"size": 3},
    "cylinder": {"radius": 1, "length": 1},
    "sphere": {"radius": 1},
    "capsule": {"radius": 1, "length": 1},
}


@dataclass(frozen=True, slots=True)
class Geometry:
    """A solid, centred on its own frame; those with a length have it along z.

    Attributes:
        kind: a capsule is a cylinder with a half sphere at each end.
        size: lengths (m) by kind: x, y, z of a box; radius of a sphere; radius and length of a cylinder or
            capsule; the scale along x, y, z of a mesh.
        file: where a mesh is.
    """

    kind: Literal["box", "cylinder", "sphere", "capsule", "mesh"]
    size: tuple[float, ...]
    file: Path | None = None


@dataclass(frozen=True, eq=False, slots=True)
class Visual:
    """A solid on a link.

    Attributes:
        T_link_visual: its pose in the link's frame, shape (4, 4).
        color: None where the file gives none, so that a mesh may keep its own.
    """

    link: str
    geometry: Geometry
    T_link_visual: FloatArray = field(repr=False)
    color: Color | None = None


@dataclass(frozen=True, slots=True)
class Looks:
    """All visuals of a robot, and the links that lack some because a mesh is not there."""

    visuals: tuple[Visual, ...]
    incomplete: tuple[str, ...] = ()


def read(description: Description, packages: Packages) -> Looks:
    """The visuals of a robot, in the order of its links.

    A mesh that is not there is left out, with one warning for all of them.

    Args:
        description: whose text is read.
        packages: where its meshes may be.

    Raises:
        DescriptionError: if a number is none, a visual has no geometry that is known, or a mesh is outside the
            declared roots or on the network.
    """
    root = markup.parse(description.text, description.file)
    return _Reader(description.file, packages).run(root, description.links)


class _Reader:
    def __init__(self, file: str, packages: Packages) -> None:
        self.file = file
        self.packages = packages
        self.missing: list[DescriptionError] = []
        self.materials: dict[str, Color] = {}

    def run(self, root: Element, links: tuple[str, ...]) -> Looks:
        elements = {element.attributes.get("name", ""): element for element in root.all("link")}
        # A material is defined at the top or in any visual, and used by name in others, before or after.
        inline = (m for e in elements.values() for visual in e.all("visual") for m in visual.all("material"))
        for material in (*root.all("material"), *inline):
            color = self._own_color(material)
            name = material.attributes.get("name", "")
            if color is not None and name:
                self.materials.setdefault(name, color)
        visuals: list[Visual] = []
        incomplete: list[str] = []
        for link in links:
            if link not in elements:  # the universe of a floating base
                continue
            for element in elements[link].all("visual"):
                visual = self._visual(link, element)
                if visual is not None:
                    visuals.append(visual)
                elif link not in incomplete:
                    incomplete.append(link)
        if self.missing:
            first, count = self.missing[0], len(self.missing)
            more = f" (the first of {count} that are missing)" if count > 1 else ""
            whose = ", ".join(incomplete[:5]) + ", …" * (len(incomplete) > 5)
            what = f"{first.what}{more}; instead, frames are drawn of {whose}"
            warnings.warn(PinscrewWarning("no-mesh", what, file=self.file), stacklevel=2)
        return Looks(tuple(visuals), tuple(incomplete))

    def _error(self, code: str, link: str, element: Element, what: str, remedy: str = "") -> DescriptionError:
        return DescriptionError(
            code, what, file=self.file, line=element.line, element=f"visual of link {link!r}", remedy=remedy
        )

    def _visual(self, link: str, element: Element) -> Visual | None:
        solids = [child for holder in element.all("geometry") for child in holder.children]
        if len(solids) != 1 or solids[0].tag not in (*_SIZES, "mesh"):
            found = ", ".join(f"<{solid.tag}>" for solid in solids) or "none"
            remedy = f"give it one of {', '.join(f'<{kind}>' for kind in (*_SIZES, 'mesh'))}"
            raise self._error("geometry", link, element, f"its <geometry> has {found}", remedy)
        geometry = self._geometry(link, solids[0])
        if geometry is None:
            return None
        color = None
        for material in element.all("material"):
            color = self._own_color(material) or self.materials.get(material.attributes.get("name", ""))
        return Visual(link, geometry, self._origin(link, element), color)

    def _geometry(self, link: str, solid: Element) -> Geometry | None:
        if solid.tag != "mesh":
            counts = _SIZES[solid.tag].items()
            size = [x for attribute, count in counts for x in self._lengths(link, solid, attribute, count)]
            return Geometry(solid.tag, tuple(size))  # type: ignore[arg-type]  # a key of _SIZES
        uri = solid.attributes.get("filename", "").strip()
        if not uri:
            raise self._error("geometry", link, solid, "its <mesh> has no filename", 'write <mesh filename="..."/>')
        scale = self._numbers(link, solid, "scale", 3) or (1.0, 1.0, 1.0)
        try:
            return Geometry("mesh", tuple(scale), mesh_file(uri, self.packages))
        except DescriptionError as error:
            if error.code not in ("no-mesh", "unknown-package"):
                raise
            self.missing.append(error)
            return None

    def _origin(self, link: str, element: Element) -> FloatArray:
        T = np.eye(4)
        for origin in element.all("origin"):
            T[:3, 3] = self._numbers(link, origin, "xyz", 3) or (0.0, 0.0, 0.0)
            T[:3, :3] = orientation.of_rpy(*(self._numbers(link, origin, "rpy", 3) or (0.0, 0.0, 0.0)))
            quaternion = self._numbers(link, origin, "quat_xyzw", 4)
            if quaternion is not None and any(quaternion):
                T[:3, :3] = orientation.of_quaternion(quaternion)
        return read_only(T)

    def _own_color(self, material: Element) -> Color | None:
        for color in material.all("color"):
            rgba = self._numbers(material.attributes.get("name", ""), color, "rgba", 4)
            if rgba is not None:
                red, green, blue, opacity = (min(max(value, 0.0), 1.0) for value in rgba)
                return red, green, blue, opacity
        return None

    def _lengths(self, link: str, element: Element, attribute: str, count: int) -> tuple[float, ...]:
        values = self._numbers(link, element, attribute, count)
        remedy = f'write {attribute}="{" ".join(["0.1"] * count)}"'
        if values is None:
            raise self._error("geometry", link, element, f"its <{element.tag}> has no {attribute}", remedy)
        if min(values) < 0.0:
            raise self._error("geometry", link, element, f"<{element.tag} {attribute}> is negative", remedy)
        return values

    def _numbers(self, link: str, element: Element, attribute: str, count: int) -> tuple[float, ...] | None:
        """The numbers in an attribute, or None where it is absent."""

        def refuse(code: str, what: str, remedy: str) -> DescriptionError:
            return self._error(code, link, element, what, remedy)

        values = numbers(element, attribute, count, refuse)
        return None if values is None else tuple(values)
