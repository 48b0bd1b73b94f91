"""A page as a picture, by a browser without a window: whichever Chromium or Chrome is installed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Final

from pinscrew.ground.children import program
from pinscrew.ground.errors import ViewError

__all__ = ["BROWSERS", "find_browser", "picture"]

BROWSERS: Final = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "microsoft-edge")
SECONDS: Final = 90.0
"""After which the browser is stopped: a large robot takes 10 s where there is no graphics card."""
_MAC: Final = (
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
)
_FLAGS: Final = (
    "--headless",
    "--disable-gpu",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    "--disable-extensions",
    "--hide-scrollbars",
    "--force-device-scale-factor=1",
    "--virtual-time-budget=3000",
)


def find_browser() -> str:
    """The browser that makes pictures.

    Raises:
        ViewError: if there is none.
    """
    candidates = [shutil.which(name) for name in BROWSERS]
    if sys.platform == "darwin":
        candidates += [path for path in _MAC if Path(path).is_file()]
    for found in candidates:
        if found:
            return found
    raise ViewError(
        "no-browser",
        "a picture needs Chromium or Chrome, and none is on the PATH",
        remedy="install one (Debian: apt install chromium), or save the page with --html and open it",
    )


def picture(html: str, width: int = 1000, height: int = 750, *, seconds: float = SECONDS) -> bytes:
    """The picture of a page, as PNG.

    Args:
        html: the page; it is loaded from a file, so nothing has to be served.
        width: pixels.
        height: pixels.
        seconds: after which the browser is stopped.

    Raises:
        ViewError: if there is no browser, or it fails or does not end in time.
    """
    browser = find_browser()
    with tempfile.TemporaryDirectory(prefix="pinscrew-", ignore_cleanup_errors=True) as name:
        folder = Path(name)
        page, out = folder / "page.html", folder / "picture.png"
        page.write_text(html, encoding="utf-8")
        command = [
            browser,
            *_FLAGS,
            *(["--no-sandbox"] if _is_root() else []),  # Chromium has no sandbox for root; the page is our own
            f"--user-data-dir={folder / 'profile'}",
            f"--window-size={width},{height}",
            f"--screenshot={out}",
            page.as_uri(),
        ]
        # What it leaves in the place for such files when it is stopped goes with the folder.
        words = _run(command, seconds, {**os.environ, "TMPDIR": name})
        if not out.is_file():
            last = next((line for line in reversed(words.splitlines()) if line.strip()), "it says nothing")
            raise ViewError("browser-failed", f"made no picture ({last.strip()})", where=browser)
        return out.read_bytes()


def _is_root() -> bool:
    return hasattr(os, "geteuid") and os.geteuid() == 0


def _run(command: list[str], seconds: float, environment: dict[str, str]) -> str:
    """Run a browser to its end and return what it said; it and its helpers are stopped in any case."""
    with program(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment) as process:
        try:
            words, _ = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            what = f"did not end within {seconds:g} s"
            raise ViewError("browser-failed", what, where=command[0]) from None
    return words.decode("utf-8", errors="replace")
