"""What can go wrong in showing a robot, besides what can with its description."""

from __future__ import annotations

from pinscrew.errors import PinscrewError

__all__ = ["ViewError"]


class ViewError(PinscrewError, RuntimeError):
    """A robot can't be shown: its server or the browser fails."""
