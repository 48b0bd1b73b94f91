"""How much memory is free."""

from __future__ import annotations

import os
import re
from pathlib import Path

__all__ = ["free_bytes"]


def free_bytes() -> int:
    """Bytes that can be used without swapping; where the system does not say, all that the machine has."""
    try:
        text = Path("/proc/meminfo").read_text(encoding="ascii")
    except OSError:
        text = ""
    found = re.search(r"^MemAvailable:\s+(\d+) kB$", text, re.MULTILINE)
    if found:
        return int(found[1]) * 1024
    return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
