"""How things show themselves in a notebook, hooked in from above.

What draws a robot stands floors above the robot, and Jupyter asks the robot. So a class that wants to be looked at
inherits `Displayed`, and the package's face, which knows both, says in `DRAWN_BY` who draws it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

__all__ = ["DRAWN_BY", "Displayed"]

DRAWN_BY: Final[dict[str, Callable[[Any], str]]] = {}
"""By the name of a class, what makes HTML of an instance."""


class Displayed:
    """Something that Jupyter shows as HTML, if anybody has said in `DRAWN_BY` how."""

    __slots__ = ()

    def _repr_html_(self) -> str | None:
        """The instance as HTML, for Jupyter; None, and so its plain text, where nobody draws it."""
        for kind in type(self).__mro__:
            if kind.__name__ in DRAWN_BY:
                return DRAWN_BY[kind.__name__](self)
        return None
