"""The triangles of a mesh file, in metres: read here, so that the page gets numbers and never the file itself.

trimesh parses STL, OBJ and COLLADA. What such a file names in turn (materials, images) is not opened, but for a
material library beside an OBJ. A COLLADA file's unit is applied and its up axis is not, as RViz does.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pinscrew.description.packages import Packages, is_file
from pinscrew.description.visuals import Color, Visual
from pinscrew.ground.errors import DescriptionError
from pinscrew.ground.typing import FloatArray

__all__ = ["Mesh", "MeshPart", "load"]

LARGEST: Final = 200 * 2**20
"""Bytes of the largest mesh file that is read."""
_UNIT: Final = re.compile(r"([-+.0-9eE]+) \* meters")


@dataclass(frozen=True, eq=False, slots=True)
class MeshPart:
    """Triangles of one colour.

    Attributes:
        vertices: shape (V, 3), m.
        normals: unit vectors, shape (V, 3).
        faces: indices of vertices, shape (F, 3).
        color: the file's own, or None.
    """

    vertices: FloatArray
    normals: FloatArray
    faces: NDArray[np.int64]
    color: Color | None

    @property
    def bounds(self) -> FloatArray:
        """Least and greatest coordinates, shape (2, 3)."""
        return np.stack([self.vertices.min(axis=0), self.vertices.max(axis=0)])


Mesh: TypeAlias = tuple[MeshPart, ...]


def load(visuals: Iterable[Visual], packages: Packages) -> Mapping[Visual, Mesh]:
    """The meshes of those visuals that are meshes; a file that several use is read once.

    Raises:
        DescriptionError: if a file can't be read as a mesh.
    """
    files: dict[Path, Mesh] = {}
    found = {}
    for visual in visuals:
        file = visual.geometry.file
        if file is None:
            continue
        if file not in files:
            files[file] = _read(file, packages)
        found[visual] = files[file]
    return found


def _read(file: Path, packages: Packages) -> Mesh:
    import trimesh

    if file.stat().st_size > LARGEST:
        raise DescriptionError("too-large", f"larger than {LARGEST // 2**20} MB", file=file)
    kind = file.suffix.lower().removeprefix(".")
    if kind not in ("stl", "obj", "dae"):
        remedy = "convert it to STL, OBJ or COLLADA"
        raise DescriptionError("mesh-format", f"a mesh of the kind {kind!r} can't be drawn", file=file, remedy=remedy)
    try:
        with np.errstate(all="ignore"):  # what is not finite is refused below
            resolver = _materials_beside(file, packages) if kind == "obj" else None
            scene = trimesh.load_scene(
                io.BytesIO(file.read_bytes()), file_type=kind, process=False, resolver=resolver, maintain_order=True
            )
            unit = _UNIT.fullmatch(str(scene.units))
            scale = float(unit[1]) if unit else 1.0
            parts = [
                _part(scene.geometry[name], np.asarray(T, dtype=np.float64), scale)
                for T, name in (scene.graph[node] for node in scene.graph.nodes_geometry)
                if hasattr(scene.geometry[name], "faces")
            ]
    except Exception as error:  # parsers of three formats fail in many ways, and any of them means the same
        what = f"can't be read as a mesh ({type(error).__name__}: {error})"
        raise DescriptionError("mesh-format", what, file=file) from error
    if not all(np.isfinite(part.vertices).all() for part in parts):
        raise DescriptionError("mesh-format", "has vertices that are no finite numbers", file=file)
    found = tuple(part for part in parts if len(part.faces))
    if not found:
        raise DescriptionError("mesh-format", "has no triangles", file=file)
    return found


def _part(geometry: Any, T: FloatArray, scale: float) -> MeshPart:
    flat = "vertex_normals" not in geometry._cache.cache  # the file gave none (STL): each face gets its own
    vertices, faces = np.asarray(geometry.vertices, dtype=np.float64), np.asarray(geometry.faces)
    if flat:
        normals = np.repeat(np.asarray(geometry.face_normals), 3, axis=0)
        if len(geometry.face_normals) != len(faces):
            normals = _face_normals(vertices, faces)
        vertices, faces = vertices[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3)
    else:
        normals = np.asarray(geometry.vertex_normals, dtype=np.float64)
    vertices = (vertices @ T[:3, :3].T + T[:3, 3]) * scale
    # Normals turn with the inverse transpose; where T mirrors, the faces' sense turns too.
    normals = normals @ np.linalg.pinv(T[:3, :3])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = normals / np.where(lengths > 0.0, lengths, 1.0)
    if np.linalg.det(T[:3, :3]) < 0.0:
        faces = faces[:, ::-1]
    return MeshPart(vertices, normals, faces, _color(geometry))


def _face_normals(vertices: FloatArray, faces: NDArray[np.int64]) -> FloatArray:
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.repeat(normals / np.where(lengths > 0.0, lengths, 1.0), 3, axis=0)


def _color(geometry: Any) -> Color | None:
    visual = geometry.visual
    if not getattr(visual, "defined", False):
        return None
    main = visual.material.main_color if hasattr(visual, "material") else visual.main_color
    red, green, blue, opacity = (float(x) / 255.0 for x in main)
    return red, green, blue, opacity


def _materials_beside(file: Path, packages: Packages) -> Any:
    """What trimesh may open for an OBJ: its material library, where that may be read; no images."""
    from trimesh.resolvers import Resolver

    class Beside(Resolver):
        def __init__(self) -> None:
            pass

        def get(self, name: str) -> bytes:
            if not str(name).strip().lower().endswith(".mtl"):
                raise FileNotFoundError(name)
            library = packages.check(file.parent / str(name).strip())
            if not is_file(library):  # a pipe may never end
                raise FileNotFoundError(name)
            return library.read_bytes()

        def write(self, name: str, data: Any) -> None:
            raise NotImplementedError

        def namespaced(self, namespace: str) -> Any:  # noqa: ARG002 (trimesh's signature)
            return self

        def keys(self) -> tuple[str, ...]:
            return ()

    return Beside()
