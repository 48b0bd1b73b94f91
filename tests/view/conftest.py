"""A browser for the viewer's tests: one per worker, a fresh profile per test."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from view_support import missing_browser, wait_until

from chromium import BROWSER, FLAGS


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    reason = missing_browser()
    if reason:
        pytest.skip(reason)
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=BROWSER, headless=True, args=list(FLAGS))
        yield launched
        launched.close()


@pytest.fixture
def open_page(browser: Any) -> Iterator[Callable[..., Any]]:
    """Opens an address and waits for the page; ``page.said`` has its errors, ``page.asked`` what it requested."""
    contexts = []

    def opened(url: str, *, offline: bool = False, width: int = 1000, height: int = 750) -> Any:
        context = browser.new_context(viewport={"width": width, "height": height}, offline=offline)
        contexts.append(context)
        page = context.new_page()
        page.said, page.asked = [], []
        page.on("console", lambda message: page.said.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: page.said.append(str(error)))
        page.on("request", lambda request: page.asked.append(request.url))
        page.goto(url)
        wait_until(page, "document.documentElement.dataset.ready === 'true'")
        return page

    yield opened
    for context in contexts:
        context.close()
