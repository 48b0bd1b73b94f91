"""The page: meshcat's viewer as it is, our style and scripts, and a document, in one file that refers to no other."""

from __future__ import annotations

import base64
import hashlib
import importlib.util
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Final

from pinscrew.ground.errors import MissingExtraError
from pinscrew.ground.escaping import html, json_in_script
from pinscrew.view.document import Json

__all__ = ["page", "viewer_script"]

SCRIPTS: Final = (
    "linear",
    "kinematics",
    "twists",
    "shapes",
    "tree",
    "stage",
    "dress",
    "numbers",
    "dialect",
    "copy",
    "address",
    "panel",
    "live",
    "main",
)
"""In the order in which they need each other."""


def page(document: Json, *, connect: str = "'none'") -> str:
    """The page for a document, as HTML.

    Its policy lets the browser run just these scripts, evaluate no text, and fetch nothing.

    Args:
        document: see `document.document`.
        connect: where the page may connect to, as in a Content-Security-Policy.

    Raises:
        MissingExtraError: if meshcat's viewer is not installed.
    """
    scripts = [viewer_script(), *(_text(f"{name}.js") for name in SCRIPTS)]
    hashes = " ".join(f"'sha256-{_digest(script)}'" for script in scripts)
    policy = (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; img-src data: blob:; "
        f"connect-src {connect}; base-uri 'none'; form-action 'none'"
    )
    values = {
        "policy": html(policy),
        "title": html(f"{document['name']} · pinscrew"),
        "style": _text("page.css"),
        "document": json_in_script(document),
        "scripts": "\n".join(f"<script>{script}</script>" for script in scripts),
    }
    # One pass over the template: what a value contains is never taken for a place.
    pieces = _text("page.html").split("{{")
    out = [pieces[0]]
    for piece in pieces[1:]:
        name, _, rest = piece.partition("}}")
        out += [values[name], rest]
    return "".join(out)


@cache
def viewer_script() -> str:
    """meshcat's viewer, three.js included, as the package has it.

    Raises:
        MissingExtraError: if meshcat is not installed, or not with its viewer.
    """
    found = importlib.util.find_spec("meshcat")  # found, not imported: its import opens sockets' libraries
    for folder in (found.submodule_search_locations or ()) if found else ():
        file = Path(folder) / "viewer" / "dist" / "main.min.js"
        if file.is_file():
            script = file.read_text(encoding="utf-8")
            if "</script" in script.lower():
                raise MissingExtraError("this version of meshcat's viewer can't stand inside a page", "view")
            return script
    raise MissingExtraError("meshcat, or its viewer, is not installed", "view")


@cache
def _text(name: str) -> str:
    return files("pinscrew.view").joinpath("page", name).read_text(encoding="utf-8")


@cache
def _digest(script: str) -> str:
    return base64.b64encode(hashlib.sha256(script.encode("utf-8")).digest()).decode("ascii")
