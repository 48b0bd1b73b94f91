"""Lock files, which keep a robot's mechanism as a small text, so that an edit of its file can be judged.

`fingerprint` and `text` write, `read` and `check` read.
"""

from __future__ import annotations

from pinscrew.lockfile.checking import LockCheck, check
from pinscrew.lockfile.reading import read
from pinscrew.lockfile.writing import fingerprint, text

__all__ = ["LockCheck", "check", "fingerprint", "read", "text"]
