"""Files that a robot's geometry names: found below the declared roots, never fetched, images included."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import unquote

from pinscrew.description import markup
from pinscrew.description.packages import Packages
from pinscrew.errors import DescriptionError

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
    if not path.is_file():
        raise DescriptionError("no-mesh", f"its mesh {uri!r} is not at {str(path)!r}", file=packages.file)
    if path.suffix.lower() == ".dae":
        for image in _images(path):
            if "://" in image:
                packages.resolve(image)
            else:
                packages.check(path.parent / unquote(image))
    return path


def _images(path: Path) -> list[str]:
    """The files that a COLLADA document takes images from: the text of its ``<init_from>`` in ``<image>``s."""
    found: list[str] = []
    pending = [(markup.parse(markup.read(path), path), False)]
    while pending:
        element, in_image = pending.pop()
        in_image = in_image or element.tag == "image"
        if in_image and element.tag in ("init_from", "ref") and element.text.strip():
            found.append(element.text.strip())
        pending.extend((child, in_image) for child in element.children)
    return found
