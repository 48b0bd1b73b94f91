"""Files that a robot's geometry names: found below the declared roots, never fetched, images included."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import unquote

from pinscrew.description import markup
from pinscrew.description.packages import Packages, is_file
from pinscrew.ground.errors import DescriptionError
from pinscrew.ground.words import brief

__all__ = ["mesh_file"]


def mesh_file(uri: str, packages: Packages) -> Path:
    """The file of a mesh, which may be opened: it and the images it names are below the declared roots.

    Args:
        uri: the ``filename`` of a ``<mesh>``.
        packages: the roots.

    Raises:
        DescriptionError: if the mesh or an image of it is outside all roots or elsewhere on the network, its package
            is unknown, or it does not exist.
    """
    path = packages.resolve(uri)
    if not is_file(path):
        what = f"its mesh {brief(uri)!r} is not at {brief(str(path))!r}"
        raise DescriptionError("no-mesh", what, file=packages.file)
    if path.suffix.lower() == ".dae":
        for image in _images(path):
            if "://" in image:
                packages.resolve(image)
            else:
                for name in (image, unquote(image)):
                    packages.check(path.parent / name)
    return path


def _images(path: Path) -> list[str]:
    """The files that a COLLADA document takes images from, and names of images, which do no harm here.

    Viewers find them in their own ways: by ``<init_from>`` in any namespace, or the ``<ref>`` in one.
    """
    found: list[str] = []
    pending = [markup.parse(markup.read(path), path)]
    while pending:
        element = pending.pop()
        if "init_from" in element.tag or element.tag.rpartition(":")[2] == "ref":
            found += {element.text, element.text.strip()} - {""}
        pending.extend(element.children)
    return found
