"""Things in a notebook."""

from __future__ import annotations

from pinscrew.description.visuals import Looks
from pinscrew.ground.errors import DescriptionError
from pinscrew.ground.escaping import html
from pinscrew.robot.robot import Robot
from pinscrew.view.model import Model
from pinscrew.view.prepare import begin, page, prepare

__all__ = ["robot"]


def robot(shown: Robot) -> str:
    """The page in a frame, for Jupyter; a robot whose meshes can't be had is drawn without any."""
    try:
        model = prepare(shown)
    except DescriptionError:
        model = Model.of(shown, Looks(()), {})
    whole = html(page(model, begin(model)))
    style = "width: 100%; height: 640px; border: 1px solid #d5dbe3"
    title = html(shown.name)
    return f'<iframe title="{title}" sandbox="allow-scripts" style="{style}" srcdoc="{whole}"></iframe>'
