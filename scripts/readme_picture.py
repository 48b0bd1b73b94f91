"""Draw docs/verify.svg, the picture in the README: what `pinscrew verify` prints, as it prints it."""

from __future__ import annotations

import io
import os
import re
from pathlib import Path
from unittest import mock

from rich.console import Console

from pinscrew.cli import command, output

PICTURE = Path(__file__).resolve().parents[1] / "docs" / "verify.svg"


def main() -> None:
    """Run the command with a console that records."""
    recorder = Console(record=True, width=72, file=io.StringIO(), force_terminal=True, highlight=False)
    recorder.print("$ pinscrew verify")

    def record(text: str = "", *, err: bool = False) -> None:
        if not err:
            recorder.print(text)

    with mock.patch.object(output, "console", return_value=recorder), mock.patch("click.echo", record):
        command(["verify"], standalone_mode=False)
    svg = recorder.export_svg(title="pinscrew")
    offline = re.sub(r"\s*@font-face \{.*?\}", "", svg, flags=re.DOTALL)  # rich would load fonts from a server
    PICTURE.write_text(offline, encoding="utf-8")


if __name__ == "__main__":
    os.environ["TERM"] = "xterm-256color"
    main()
