"""`show`: a robot in meshcat's viewer, live from Python, as one HTML file, or as a picture.

The page is the same in all three: it has the robot's screws and computes by itself, so that a slider moves what is
drawn at once. Live, it tells Python where it is and does as Python says.
"""

from __future__ import annotations

import threading
import weakref
from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import Any, Final

import numpy as np

from pinscrew.ground import files
from pinscrew.ground.arrays import numbers
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import KINDS, ArrayLike, FloatArray, KindLike
from pinscrew.robot.loading import RobotLike, robot_of
from pinscrew.view import html, png
from pinscrew.view.document import DEFAULT_DRAW, Animation, State, document
from pinscrew.view.model import Model
from pinscrew.view.prepare import begin, launch, prepare, vector
from pinscrew.view.server import HOST, Server
from pinscrew.view.shapes import GROUPS, Group

__all__ = ["View", "show"]

FASTEST: Final = 240.0


class View:
    """A robot that is being shown. Make one with `show`; it closes with ``with``, `close`, or the process.

    The configuration is the page's: what a person does there is read here, and what is set here shows there.
    """

    def __init__(self, model: Model, state: State, port: int | None = None) -> None:
        """Start to serve; see `show`."""
        self.model = model
        self._state = state
        self._tip = model.tip
        self._lock = threading.Lock()
        owner = weakref.ref(self)  # the server's thread must not keep a view alive that nobody holds
        self._server = Server(
            lambda: _of(owner)._page(live=True),
            lambda: _of(owner)._message("hello"),
            lambda said: _of(owner)._hear(said),
            port,
        )
        self._finalizer = weakref.finalize(self, self._server.close)

    def __repr__(self) -> str:
        return f"<View of {self.model.robot.name!r} at {self.url}>"

    def __enter__(self) -> View:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def url(self) -> str:
        """Where the page is; it can be opened several times."""
        return self._server.url

    @property
    def alive(self) -> bool:
        """Whether the server answers."""
        return self._server.alive

    @property
    def q(self) -> FloatArray:
        """The configuration shown, shape (nq,); set it to move the robot.

        Raises:
            InputError: when set to another shape or to what is no finite number.
            ViewError: when set after the server has stopped.
        """
        with self._lock:
            return self._state.q.copy()

    @q.setter
    def q(self, q: ArrayLike) -> None:
        self._set(q=vector(q, self.model.robot, "q"))

    @property
    def qd(self) -> FloatArray:
        """The velocities shown, shape (nv,); set them as `q`."""
        with self._lock:
            return self._state.qd.copy()

    @qd.setter
    def qd(self, qd: ArrayLike) -> None:
        self._set(qd=vector(qd, self.model.robot, "qd"))

    @property
    def tip(self) -> str:
        """The frame whose pose, Jacobian and velocity are shown."""
        with self._lock:
            return self._tip

    @tip.setter
    def tip(self, tip: str) -> None:
        tip = self.model.robot.frame(tip)
        with self._lock:
            self._tip = tip
        self._server.tell(self._message())

    def animate(self, trajectory: ArrayLike, fps: float = 30.0) -> None:
        """Play configurations one after the other, and end at the last; returns at once.

        Args:
            trajectory: shape (N, nq), rad and m.
            fps: configurations per second.

        Raises:
            InputError: if the shape is another, a number is not finite, or ``fps`` is not within 0 to 240.
            ViewError: if the server has stopped.
        """
        path = numbers(trajectory, "the trajectory", "animate")
        if path.ndim != 2 or len(path) == 0:
            what = f"the trajectory has shape {path.shape}"
            raise InputError("shape", what, where="animate", remedy=f"expected (N, {self.model.robot.nq}), N > 0")
        if not 0.0 < fps <= FASTEST:
            raise InputError("fps", f"fps is {fps}", where="animate", remedy=f"use more than 0, at most {FASTEST:g}")
        path = np.stack([vector(row, self.model.robot, "q") for row in path])
        with self._lock:
            self._state = replace(self._state, q=path[-1], animation=Animation(path, fps))
        self._server.tell({"type": "animate", "animation": {"trajectory": path.tolist(), "fps": fps}})

    def html(self) -> str:
        """The page as it is now, as one file that needs no server and no network."""
        return self._page(live=False)

    def save_html(self, path: str | Path) -> None:
        """Write `html` to a file.

        Raises:
            InputError: if the file can't be written.
        """
        files.write(Path(path), self.html().encode("utf-8"))

    def save_png(self, path: str | Path, width: int = 1000, height: int = 750) -> None:
        """Write a picture of the robot as it is now, from the usual place of the camera.

        Raises:
            ViewError: if there is no browser to make it.
            InputError: if the file can't be written.
        """
        files.check(Path(path))
        files.write(Path(path), png.picture(self._page(live=False, picture=(width, height)), width, height))

    def close(self) -> None:
        """Stop serving; again does nothing. A page that is open works on alone."""
        self._finalizer()

    def _set(self, *, q: FloatArray | None = None, qd: FloatArray | None = None) -> None:
        with self._lock:
            old = self._state
            self._state = replace(old, q=old.q if q is None else q, qd=old.qd if qd is None else qd)
        self._server.tell(self._message())

    def _message(self, kind: str = "state") -> dict[str, Any]:
        with self._lock:
            return {"type": kind, "q": self._state.q.tolist(), "qd": self._state.qd.tolist(), "tip": self._tip}

    def _page(self, *, live: bool, picture: tuple[int, int] | None = None) -> str:
        with self._lock:
            state, tip = self._state, self._tip
        connect = f"ws://{HOST}:{self._server.port} ws://localhost:{self._server.port}" if live else "'none'"
        model = self.model if tip == self.model.tip else replace(self.model, tip=tip)
        return html.page(
            document(model, state, live=self._server.token if live else "", picture=picture), connect=connect
        )

    def _hear(self, said: Mapping[str, Any]) -> dict[str, Any]:
        """Take over what a page says of its state, as far as it makes sense; the state, for the other pages."""
        robot = self.model.robot
        changes: dict[str, Any] = {}
        for name in ("q", "qd"):
            try:
                changes[name] = vector(said.get(name), robot, name)
            except InputError:
                continue
        if said.get("kind") in KINDS:
            changes["kind"] = said["kind"]
        draw = said.get("draw")
        if isinstance(draw, list):
            changes["draw"] = tuple(group for group in GROUPS if group in draw)
        with self._lock:
            self._state = replace(self._state, **changes)
            if said.get("tip") in robot.frame_names:
                self._tip = said["tip"]
        return self._message()


def _of(owner: weakref.ref[View]) -> View:
    view = owner()
    if view is None:
        raise RuntimeError("the view is gone")
    return view


def show(
    robot: RobotLike,
    q: ArrayLike | None = None,
    qd: ArrayLike | None = None,
    *,
    tip: str | None = None,
    kind: KindLike = "spatial",
    draw: Collection[Group] = DEFAULT_DRAW,
    packages: Mapping[str, str | Path] | None = None,
    allow_outside: bool = False,
    port: int | None = None,
    open_browser: bool = True,
) -> View:
    """Show a robot in the browser.

    Args:
        robot: a robot, or a name or path that `load` takes.
        q: configuration, shape (nq,), rad and m; by default zero, or the middle of the limits where they exclude zero.
        qd: velocities, shape (nv,), rad/s and m/s; by default 1 rad/s, and a quarter of the robot's size per second.
        tip: the frame whose velocity is shown; by default the robot's tip, or as `opening.default_tip` chooses.
        kind: the Jacobian in the panel.
        draw: what is drawn at first, of `pinscrew.view.shapes.GROUPS`.
        packages: roots of ROS packages by name, for ``package://`` in meshes.
        allow_outside: let meshes be read from anywhere.
        port: where to look for a free port first; by default 7000.
        open_browser: open the page, if there is a browser with a window.

    Raises:
        DescriptionError: if the robot's looks can't be read; see `visuals.read`.
        InputError: if ``q`` or ``qd`` has another shape or holds what is no finite number, or ``draw`` what can't be
            drawn.
        UnknownNameError: if there is no frame ``tip``.
        ViewError: if the server does not start.
    """
    robot = robot_of(robot)
    model = prepare(robot, tip=tip, packages=packages, allow_outside=allow_outside)
    view = View(model, begin(model, q, qd, kind=kind, draw=draw), port)
    if open_browser:
        launch(view.url)
    return view
