"""Numbers typed in the page: the dialect of the command line, against Python's own reader of it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import pinscrew as ps
from pinscrew.ground.errors import InputError
from pinscrew.ground.expressions import number
from pinscrew.view import prepare

TEXTS = [
    "0.5",
    "-.5",
    "1e-3",
    "pi/4",
    "45deg",
    "-90deg",
    "2*(pi-1)",
    "0.5rad",
    "2cm",
    "30mm",
    "(1+2)deg",
    "2pi",
    "--1",
    "+3",
    "4/2deg",
    "90deg/2",
    "10deg/5deg",
    "1/3*pi",
    "pi/2+10deg",
    "2cm+1deg",
    "2cm*3mm",
    "1/2cm",
    "1/0",
    "1e999",
    "rad",
    "four",
    "x",
    "1+",
    "(1",
    "1)",
    "1,2",
    "2**3",
    "1..2",
    "deg2",
    "0.3-0.1*(2-5)",
    "__proto__",
    "constructor",
]


def test_it_reads_as_the_command_line_does(open_page: Callable[..., Any], tmp_path: Path) -> None:
    model = prepare.prepare(ps.load("scara"))
    (tmp_path / "page.html").write_text(prepare.page(model, prepare.begin(model)), encoding="utf-8")
    page = open_page((tmp_path / "page.html").as_uri(), offline=True)
    for unit in ("rad", "m", ""):
        for text in ("", "45 deg", "a" * 101, *TEXTS):
            shown = page.evaluate("([text, unit]) => pinscrew.dialect.number(text, unit)", [text, unit])
            try:
                assert shown == {"x": pytest.approx(number(text, unit), rel=1e-15)}, text  # type: ignore[arg-type]
            except InputError:
                assert "write such as" in shown["error"], text
    field = page.locator('input[aria-label="joint1"]')
    for text, value in (("pi/4", 0.7853981633974483), ("90deg", 1.5707963267948966)):
        field.fill(text)
        field.press("Enter")
        assert page.evaluate("pinscrew.app.state.q[0]") == value
        assert page.text_content(".coordinate .error") == ""
    field.fill("2cm")
    field.press("Enter")
    assert page.text_content(".coordinate .error").startswith("a length, where an angle is needed")
    assert page.evaluate("pinscrew.app.state.q[0]") == 1.5707963267948966
    assert page.said == []
