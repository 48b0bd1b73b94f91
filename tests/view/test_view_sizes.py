"""Every size, every eye: phones, dark mode, contrast by WCAG 2.1, and the keyboard."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import pinscrew as ps
from pinscrew.view import prepare

Open = Callable[..., Any]

TEXTS = """() => {
  const values = (text) => (text.match(/[\\d.]+/g) || [0, 0, 0, 0]).map(Number);
  const found = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node; (node = walker.nextNode());) {
    const element = node.parentElement;
    if (!node.textContent.trim() || !element.checkVisibility({ visibilityProperty: true }) ||
        element.closest("script, style, #pane, option")) continue;
    let ground = element, color;
    do { color = values(getComputedStyle(ground).backgroundColor); ground = ground.parentElement; }
    while (ground && color[3] === 0);
    found.push([node.textContent.trim(), values(getComputedStyle(element).color).slice(0, 3), color.slice(0, 3)]);
  }
  return found;
}"""
LABELS = "() => pinscrew.app.stage.texts.map(({ text }) => [text.textContent, getComputedStyle(text).color])"
GROUNDS = {"light": ((251, 252, 253), (219, 226, 235)), "dark": ((28, 32, 38), (41, 46, 54))}
"""What is behind the labels, at the top and at the bottom of the scene."""


def luminance(color: Any) -> float:
    """Relative luminance of an sRGB colour from 0 to 255, WCAG 2.1."""
    c = np.asarray(color, dtype=float) / 255.0
    return float(np.where(c <= 0.03928, c / 12.92, ((c + 0.055) / 1.055) ** 2.4) @ [0.2126, 0.7152, 0.0722])


def contrast(a: Any, b: Any) -> float:
    low, high = sorted((luminance(a), luminance(b)))
    return (high + 0.05) / (low + 0.05)


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    model = prepare.prepare(ps.load("gear_pair"))
    file = tmp_path_factory.mktemp("sizes") / "page.html"
    drawn = ("links", "frames", "screws", "velocity", "circles")
    file.write_text(prepare.page(model, prepare.begin(model, draw=drawn)), encoding="utf-8")
    return file.as_uri()


@pytest.fixture
def schemes(page: Any) -> Iterator[Any]:
    yield lambda scheme: page.emulate_media(color_scheme=scheme)
    page.emulate_media(color_scheme=None)


def test_contrast(open_page: Open, schemes: Any, address: str) -> None:
    """4.5 : 1 for every text, in both schemes, errors and warnings too."""
    page = open_page(address, offline=True)
    page.fill("input[aria-label=joint1]", "2 apples")
    page.keyboard.press("Tab")
    for scheme in ("light", "dark"):
        schemes(scheme)
        for level in ("", "near", "singular"):
            page.evaluate("level => { const w = document.getElementById('warning'); w.className = level; }", level)
            page.evaluate("document.getElementById('warning').textContent = 'near a singularity'")
            texts = page.evaluate(TEXTS)
            assert len(texts) > 40
            assert [text for text in texts if contrast(text[1], text[2]) < 4.5] == []
        labels = [(text, [int(x) for x in color[4:-1].split(",")]) for text, color in page.evaluate(LABELS)]
        assert labels
        assert [x for x in labels if min(contrast(x[1], ground) for ground in GROUNDS[scheme]) < 4.5] == []
    assert page.said == []


def test_the_scheme_is_the_systems(open_page: Open, schemes: Any, address: str) -> None:
    schemes("dark")
    page = open_page(address, offline=True)
    ground = "getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)"
    assert luminance(page.evaluate(ground)) < 0.05
    schemes("light")
    assert luminance(page.evaluate(ground)) > 0.8


@pytest.mark.parametrize(
    ("width", "height", "part"), [(390, 844, 0.5), (844, 390, 0.5), (1000, 750, 0.4), (1280, 800, 0.5)]
)
def test_the_robot_keeps_its_part_of_the_screen(
    width: int, height: int, part: float, open_page: Open, address: str
) -> None:
    """Half of a phone's."""
    page = open_page(address, offline=True, width=width, height=height)
    box = page.locator("#pane canvas").bounding_box()
    assert box["width"] * box["height"] >= part * width * height
    assert (box["x"] + box["width"], box["y"]) == (pytest.approx(width, abs=20), 0)
    assert page.evaluate("document.documentElement.scrollWidth") <= width, "nothing sticks out"
    for name in ("#zero", "#tip", "#jacobian", "#copy-J"):  # all can be reached by scrolling
        page.locator(name).scroll_into_view_if_needed()
        assert page.locator(name).is_visible()


def test_the_camera_by_keys(open_page: Open, address: str) -> None:
    page = open_page(address, offline=True)
    page.focus("#pane")
    camera = lambda: np.array(page.evaluate("pinscrew.app.stage.camera()"))  # noqa: E731
    start = camera()
    away = np.linalg.norm(start[:3] - start[3:])
    for key in ("ArrowRight", "ArrowDown"):
        before = camera()
        page.keyboard.press(key)
        after = camera()
        np.testing.assert_allclose(after[3:], before[3:], atol=1e-12)
        assert np.linalg.norm(after[:3] - after[3:]) == pytest.approx(away)
        turned = np.linalg.norm(after[:3] - before[:3]) / away
        assert 0.05 < turned < 0.13
    page.keyboard.press("+")
    assert np.linalg.norm(camera()[:3] - camera()[3:]) == pytest.approx(0.88 * away)
    page.keyboard.press("0")
    np.testing.assert_allclose(camera(), start, rtol=1e-6, atol=1e-6)


def test_everything_by_keyboard(open_page: Open, address: str) -> None:
    """Tab leads to each control, and each has a name."""
    page = open_page(address, offline=True)
    reached = set()
    for _ in range(60):
        page.keyboard.press("Tab")
        reached.add(
            page.evaluate(
                "document.activeElement.id || document.activeElement.ariaLabel || document.activeElement.name"
            )
        )
    controls = page.evaluate(
        """[...document.querySelectorAll("input, select, button")].filter((one) => one.checkVisibility())
           .map((one) => [one.id || one.ariaLabel || one.name,
             one.ariaLabel || one.textContent.trim() || [...(one.labels || [])].map((l) => l.textContent).join()])"""
    )
    assert {name for name, _ in controls} <= reached
    assert [name for name, label in controls if not label.strip()] == []
    assert "pane" in reached
