"""A robot made ready to be shown: its looks read, its state checked, its page or picture made and written."""

from __future__ import annotations

import os
import sys
import webbrowser
from collections.abc import Collection, Mapping
from pathlib import Path

import numpy as np

from pinscrew.description import visuals
from pinscrew.description.packages import Packages
from pinscrew.ground.arrays import numbers
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import ArrayLike, FloatArray, KindLike, jacobian_kind
from pinscrew.robot.manifold import quaternion_starts
from pinscrew.robot.robot import Robot
from pinscrew.view import html, mesh_files, opening, png, scene
from pinscrew.view.document import DEFAULT_DRAW, State, document
from pinscrew.view.model import Model
from pinscrew.view.shapes import GROUPS, Group

__all__ = ["begin", "launch", "page", "picture", "prepare", "vector"]


def prepare(
    robot: Robot,
    *,
    tip: str | None = None,
    packages: Mapping[str, str | Path] | None = None,
    allow_outside: bool = False,
) -> Model:
    """The robot with its looks, ready to be drawn; arguments and errors as of `pinscrew.show`."""
    roots = {name: Path(root) for name, root in (packages or {}).items()}
    place = Packages(Path(robot.description.file), roots, allow_outside)
    looks = visuals.read(robot.description, place)
    return Model.of(robot, looks, mesh_files.load(looks.visuals, place), tip)


def begin(
    model: Model,
    q: ArrayLike | None = None,
    qd: ArrayLike | None = None,
    *,
    kind: KindLike = "spatial",
    draw: Collection[Group] = DEFAULT_DRAW,
) -> State:
    """How a page begins; arguments and errors as of `pinscrew.show`."""
    robot = model.robot
    unknown = [group for group in draw if group not in GROUPS]
    if unknown:
        raise InputError("draw", f"there is no {unknown[0]!r} to draw", remedy=f"use some of {', '.join(GROUPS)}")
    return State(
        q=opening.configuration(robot) if q is None else vector(q, robot, "q"),
        qd=scene.default_rates(model) if qd is None else vector(qd, robot, "qd"),
        kind=jacobian_kind(kind),
        draw=tuple(draw),
    )


def page(model: Model, state: State) -> str:
    """The page as one HTML file that needs no server and no network."""
    return html.page(document(model, state))


def picture(model: Model, state: State, width: int = 1000, height: int = 750) -> bytes:
    """The robot as a picture, PNG.

    Raises:
        ViewError: if there is no browser to make it.
    """
    return png.picture(html.page(document(model, state, picture=(width, height))), width, height)


def launch(url: str) -> bool:
    """Open a page in the browser with a window, if there is one, and say whether there was."""
    windows = sys.platform in ("darwin", "win32") or any(os.environ.get(n) for n in ("DISPLAY", "WAYLAND_DISPLAY"))
    # Without a display, Python would start a browser for terminals.
    return bool(windows or os.environ.get("BROWSER")) and webbrowser.open(url)


def vector(values: ArrayLike | None, robot: Robot, symbol: str) -> FloatArray:
    """One finite vector of the robot's coordinates or velocities, with quaternions of norm 1."""
    names = robot.coordinate_names if symbol == "q" else robot.velocity_names
    array = np.array(numbers(values, symbol, robot.name)) if values is not None else np.empty(0)
    if array.shape != (len(names),):
        remedy = f"expected ({len(names)},): {', '.join(names) or 'the robot has no coordinates'}"
        raise InputError("shape", f"{symbol} has shape {array.shape}", where=robot.name, remedy=remedy)
    if not np.isfinite(array).all():
        raise InputError(
            "not-finite", f"{symbol} holds NaN or infinity", where=robot.name, remedy="give finite numbers"
        )
    if symbol == "q":
        for start in quaternion_starts(robot):
            norm = np.linalg.norm(array[start : start + 4])
            if norm == 0.0:
                raise InputError(
                    "quaternion", "a quaternion (x, y, z, w) is zero", where=robot.name, remedy="use norm 1"
                )
            array[start : start + 4] /= norm
    return array
