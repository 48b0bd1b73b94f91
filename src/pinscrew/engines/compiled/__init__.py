"""The compiled engine's parts.

From the robot's screws to constants (`chain`), the arithmetic with them (`walk`, `rows`), its vector instructions
(`lanes`), the loop around it (`kernel`), and the function to call (`machine`).
"""

from __future__ import annotations

import warnings
from functools import lru_cache
from importlib.util import find_spec

from pinscrew.ground.errors import PinscrewWarning

__all__ = ["can_compile", "say_slow"]


def can_compile() -> bool:
    """Whether llvmlite is there."""
    try:
        return find_spec("llvmlite") is not None
    except ValueError:  # what stands in sys.modules is no module
        return False


@lru_cache(maxsize=1)
def say_slow() -> None:
    """Warn, once, that nothing is compiled."""
    message = 'Batch computes with numpy; to compile it, install: pip install "pinscrew[fast]"'
    warnings.warn(PinscrewWarning("no-compiler", message), stacklevel=3)
