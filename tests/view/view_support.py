"""What the viewer's tests share: robots, processes and listening sockets as the system has them, a browser."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import urdfs
from chromium import BROWSER

ARMS = (
    "spherical_rrp",
    "planar_2r",
    "scara_rrp",
    "stanford_rrp",
    "planar_rrr",
    "drone",
    "anthropomorphic_rrr",
    "one_joint",
    "two_joint",
    "gear_pair",
    "bevel_pair",
    "lead_screw",
)

MIXED = urdfs.robot(
    urdfs.joint("turn", "continuous", "base", "a", xyz="0.1 0 0.2", rpy="0.3 0.1 -0.2", axis="0 0.6 0.8"),
    urdfs.joint("slide", "prismatic", "a", "b", xyz="0.3 0 0.1", axis="1 0 0", limits=(-0.4, 0.6)),
    urdfs.joint("elbow", "revolute", "b", "c", xyz="0 0.2 0", rpy="0 0.5 0", axis="0 1 0"),
    urdfs.joint("follow", "revolute", "c", "d", xyz="0.2 0 0", axis="0 0 1", mimic=("elbow", -1.5, 0.3)),
    urdfs.joint("push", "prismatic", "d", "tool", xyz="0 0 0.3", axis="0 0 1", mimic=("follow", 0.2, -0.1)),
    urdfs.joint("side", "revolute", "b", "e", xyz="0 0 0.4", axis="1 0 0"),
    links="base a b c d e tool",
)
"""Continuous, prismatic and revolute joints in a tree, and mimics of a mimic with offsets."""

FREE = urdfs.robot(
    urdfs.joint("float", "floating", "base", "body", xyz="0.1 0.2 0.3", rpy="0.2 0 0.1"),
    urdfs.joint("sweep", "planar", "body", "plate", xyz="0 0 0.5"),
    urdfs.joint("arm", "revolute", "plate", "tool", xyz="0.4 0 0", axis="0 1 0"),
    links="base body plate tool",
)
"""A floating and a planar joint."""


def missing_browser() -> str:
    """Why there can be no test in a browser, or ``""``; in CI there must be one."""
    if os.environ.get("CI"):
        return ""
    if not Path(BROWSER).is_file():
        return "there is no Chromium at /usr/bin/chromium"
    try:
        import playwright  # noqa: F401
    except ImportError:
        return "playwright is not installed"
    return ""


def listening(pid: int) -> list[tuple[str, int]]:
    """Address and port of every TCP socket on which a process listens."""
    inodes = set()
    for entry in Path(f"/proc/{pid}/fd").iterdir():
        with contextlib.suppress(OSError):
            inodes.add(str(entry.readlink()))
    found = []
    for table in ("tcp", "tcp6"):
        path = Path(f"/proc/{pid}/net/{table}")
        lines = path.read_text().splitlines()[1:] if path.exists() else []
        for fields in (line.split() for line in lines):
            if fields[3] == "0A" and f"socket:[{fields[9]}]" in inodes:
                address, port = fields[1].split(":")
                found.append((address, int(port, 16)))
    return found


LOOPBACK = "0100007F"
"""127.0.0.1 as /proc/net/tcp writes it."""


def children(pid: int) -> list[int]:
    """The processes that a process has started."""
    found: list[int] = []
    for task in Path(f"/proc/{pid}/task").iterdir():
        found += map(int, (task / "children").read_text().split())
    return found


@contextlib.contextmanager
def command(*words: str) -> Iterator[subprocess.Popen[str]]:
    """``pinscrew show`` as a process of its own."""
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    with subprocess.Popen(
        [sys.executable, "-m", "pinscrew", "show", *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def wait_until(page: Any, expression: str, value: Any = None, seconds: float = 20.0) -> None:
    """Wait until an expression holds in a page; ``value`` is its ``value``.

    Playwright's own wait evaluates text inside the page, which the page's policy forbids.
    """
    for _ in range(int(50 * seconds)):
        if page.evaluate(f"value => {expression}", value):
            return
        page.wait_for_timeout(20)
    raise AssertionError(f"it never came to hold: {expression}")
