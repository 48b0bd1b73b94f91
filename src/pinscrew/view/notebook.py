"""A robot in a notebook."""

from __future__ import annotations

import html as markup

from pinscrew.description.visuals import Looks
from pinscrew.errors import DescriptionError
from pinscrew.robot import Robot
from pinscrew.view.model import Model
from pinscrew.view.prepare import begin, page, prepare

__all__ = ["html"]


def html(robot: Robot) -> str:
    """The page in a frame, for Jupyter; a robot whose meshes can't be had is drawn without any."""
    try:
        model = prepare(robot)
    except DescriptionError:
        model = Model.of(robot, Looks(()), {})
    whole = markup.escape(page(model, begin(model)), quote=True)
    style = "width: 100%; height: 640px; border: 1px solid #d5dbe3"
    title = markup.escape(robot.name, quote=True)
    return f'<iframe title="{title}" sandbox="allow-scripts" style="{style}" srcdoc="{whole}"></iframe>'
