"""The state that stays: in the page's address, over reloads and restarts; and numbers and pictures to take along."""

from __future__ import annotations

import ast
import base64
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, quote

import numpy as np
import pytest
from view_support import wait_until

import pinscrew as ps
import urdfs
from pinscrew.description.visuals import Looks
from pinscrew.view import prepare
from pinscrew.view.meshcat import View
from pinscrew.view.model import Model

Open = Callable[..., Any]


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The page of a SCARA as a file."""
    model = prepare.prepare(ps.load("scara"))
    file = tmp_path_factory.mktemp("address") / "page.html"
    file.write_text(prepare.page(model, prepare.begin(model)), encoding="utf-8")
    return file.as_uri()


def said(page: Any) -> dict[str, str]:
    """What the address holds, once it does."""
    wait_until(page, "location.hash !== ''")
    page.wait_for_timeout(400)
    return {key: values[0] for key, values in parse_qs(page.url.partition("#")[2]).items()}


def test_what_is_changed_is_in_the_address_and_back_after_a_reload(open_page: Open, address: str) -> None:
    page = open_page(address, offline=True)
    assert page.url == address
    page.evaluate("pinscrew.app.move([0.1, -0.25, 1 / 3])")
    page.evaluate("pinscrew.app.setRate(1, 0.5)")
    page.select_option("#kind", "body")
    page.select_option("#tip", "link2")
    page.click("input[name=circles]")
    found = said(page)
    assert found["q"] == f"0.1,-0.25,{1 / 3!r}"
    assert (found["robot"], found["kind"], found["tip"]) == ("scara_rrp", "body", "link2")
    assert set(found["draw"].split(",")) == {"links", "frames", "screws", "circles"}
    assert "camera" not in found
    state = page.evaluate("JSON.stringify({...pinscrew.app.state, draw: [...pinscrew.app.state.draw].sort()})")
    page.reload()
    wait_until(page, "document.documentElement.dataset.ready === 'true'")
    again = page.evaluate("JSON.stringify({...pinscrew.app.state, draw: [...pinscrew.app.state.draw].sort()})")
    assert again == state
    assert page.input_value("#kind") == "body"
    assert page.said == []


def test_the_camera_stays(open_page: Open, address: str) -> None:
    page = open_page(address, offline=True)
    box = page.locator("#pane canvas").bounding_box()
    page.mouse.move(box["x"] + 300, box["y"] + 200)
    page.mouse.down()
    page.mouse.move(box["x"] + 380, box["y"] + 230, steps=4)
    page.mouse.up()
    assert len(said(page)["camera"].split(",")) == 6
    before = page.evaluate("pinscrew.app.stage.camera()")
    page.reload()
    wait_until(page, "document.documentElement.dataset.ready === 'true'")
    np.testing.assert_allclose(page.evaluate("pinscrew.app.stage.camera()"), before, rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize(
    "fragment",
    [
        "robot=other&q=1,1,1",
        "q=1,1,1",
        "robot=scara_rrp&q=1,1",
        "robot=scara_rrp&q=1,1,NaN&tip=nowhere&kind=analytic",
        "robot=scara_rrp&q=1,,1&qd=&camera=1,2",
        f"robot=scara_rrp&tip={quote('<img src=x onerror=alert(1)>')}&draw={quote('<b>,constructor')}",
    ],
)
def test_what_does_not_fit_is_left_out(fragment: str, open_page: Open, address: str) -> None:
    page = open_page(f"{address}#{fragment}", offline=True)
    assert page.evaluate("pinscrew.app.state.q") == [0, 0, 0]
    assert page.evaluate("pinscrew.app.state.tip") == "tool"
    assert page.evaluate("pinscrew.app.state.kind") == "spatial"
    assert page.said == []


def test_another_process_on_the_port_takes_over(open_page: Open) -> None:
    """What a person has set stays; the page of the new process is loaded, and tells it."""
    model = prepare.prepare(ps.load("scara"))
    view = View(model, prepare.begin(model), 17650)
    page = open_page(view.url)
    wait_until(page, "pinscrew.app.live.connected")
    page.evaluate("pinscrew.app.move([0.3, 0.2, 0.1])")
    said(page)
    view.close()
    wait_until(page, "pinscrew.app.live.connected === false", seconds=5.0)
    with page.expect_navigation(timeout=15_000):
        other = View(model, prepare.begin(model), 17650)
    try:
        assert other.url == view.url
        wait_until(page, "pinscrew.app.live && pinscrew.app.live.connected", seconds=10.0)
        assert page.evaluate("pinscrew.app.state.q") == [0.3, 0.2, 0.1]
        wait_until(page, "document.getElementById('status').textContent === 'live'")
        page.wait_for_timeout(200)
        assert other.q.tolist() == [0.3, 0.2, 0.1]
    finally:
        other.close()


def test_numbers_to_take_along(open_page: Open, address: str) -> None:
    """Every digit, in the formats' own words; numpy's is evaluated, the others are read."""
    page = open_page(address, offline=True)
    q = [0.1, -1.0 / 3.0, 1e-9]
    page.evaluate("q => pinscrew.app.move(q)", q)
    engine = ps.Pinocchio("scara")
    truth = {"q": np.array(q), "T": engine.fk(q), "J": engine.jacobian(q, "tool", "spatial")}

    def text(what: str, form: str) -> str:
        found = page.evaluate("([what, form]) => pinscrew.copy.text(pinscrew.app, what, form)", [what, form])
        assert isinstance(found, str)
        return found

    for what, expected in truth.items():
        literal = text(what, "numpy").removeprefix("np.array(").removesuffix(")")
        np.testing.assert_allclose(ast.literal_eval(literal), expected, rtol=0, atol=1e-15)
        rows = [[float(x) for x in line.split(",")] for line in text(what, "csv").splitlines()]
        np.testing.assert_allclose(np.squeeze(rows), expected, rtol=0, atol=1e-15)
        lines = text(what, "matlab").removeprefix("[").removesuffix("]").split(";")
        np.testing.assert_allclose(
            np.squeeze([[float(x) for x in line.split(",")] for line in lines]), expected, rtol=0, atol=1e-15
        )
        inner = text(what, "latex").removeprefix(r"\begin{bmatrix} ").removesuffix(r" \end{bmatrix}")
        plain = inner.replace(r" \cdot 10^{", "e").replace("}", "")
        rows = [[float(x) for x in row.split("&")] for row in plain.split(r"\\")]
        np.testing.assert_allclose(np.squeeze(rows), expected, rtol=0, atol=1e-15)
    page.evaluate("navigator.clipboard && (navigator.clipboard.writeText = async (words) => { window.words = words; })")
    page.select_option("#copy-format", "csv")
    page.click("#copy-q")
    wait_until(page, "document.getElementById('copied').textContent === 'q copied'")
    if page.evaluate("Boolean(navigator.clipboard)"):
        assert page.evaluate("words") == text("q", "csv")


def test_a_picture_has_the_scene_and_its_labels(open_page: Open, address: str) -> None:
    page = open_page(address, offline=True)
    with page.expect_download() as download:
        page.click("#picture")
    assert download.value.suggested_filename == "scara_rrp.png"
    png = base64.b64decode(page.evaluate("pinscrew.app.stage.picture()").partition(",")[2])
    assert png.startswith(b"\x89PNG")
    assert Path(download.value.path()).read_bytes()[:8] == png[:8]
    with_labels = page.evaluate(
        """async () => {
          const { stage } = pinscrew.app, image = new Image();
          const colours = async () => {
            image.src = stage.picture();
            await image.decode();
            const canvas = document.createElement("canvas");
            [canvas.width, canvas.height] = [image.width, image.height];
            const context = canvas.getContext("2d");
            context.drawImage(image, 0, 0);
            return context.getImageData(0, 0, canvas.width, canvas.height).data;
          };
          const full = await colours(), texts = stage.texts;
          stage.texts = [];
          const bare = await colours();
          stage.texts = texts;
          return full.reduce((count, x, i) => count + (x !== bare[i]), 0);
        }"""
    )
    assert with_labels > 500
    assert page.said == []


def test_the_note_on_where_it_begins_is_for_where_it_begins(open_page: Open, tmp_path: Path) -> None:
    bent = urdfs.joint("bend", "revolute", "base", "tool", limits=(0.5, 1.5))
    model = Model.of(urdfs.load(urdfs.robot(bent, links="base tool")), Looks(()), {})
    for q, shown in ((None, True), ([0.75], False)):
        file = tmp_path / "page.html"
        file.write_text(prepare.page(model, prepare.begin(model, q)), encoding="utf-8")
        assert open_page(file.as_uri(), offline=True).is_visible("#opening") == shown
