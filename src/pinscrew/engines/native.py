"""What C and C++ write, which Python's streams know nothing of."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["standard_error_to"]


@contextmanager
def standard_error_to(descriptor: int) -> Iterator[None]:
    """Send there what C and C++ write to standard error; urdfdom's reasons go nowhere else."""
    sys.stderr.flush()
    kept = os.dup(2)
    os.dup2(descriptor, 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
