"""A browser for the viewer's tests: one per worker, and in it one page for all tests.

A page opens twice as fast where one was before. It keeps nothing that the next could see: no storage, no cookies.
"""

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


@pytest.fixture(scope="session")
def page(browser: Any) -> Iterator[Any]:
    context = browser.new_context()
    page = context.new_page()
    page.said, page.asked = [], []
    page.on("console", lambda message: page.said.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: page.said.append(str(error)))
    page.on("request", lambda request: page.asked.append(request.url))
    yield page
    context.close()


@pytest.fixture
def open_page(page: Any) -> Iterator[Callable[..., Any]]:
    """Opens an address and waits for the page; ``page.said`` has its errors, ``page.asked`` what it requested.

    A test has one page: a second address takes the place of the first.
    """

    def opened(url: str, *, offline: bool = False, width: int = 1000, height: int = 750) -> Any:
        page.said, page.asked = [], []
        page.context.set_offline(offline)
        page.set_viewport_size({"width": width, "height": height})
        page.goto(url)
        wait_until(page, "document.documentElement.dataset.ready === 'true'")
        return page

    yield opened
    page.context.set_offline(False)
    page.goto("about:blank")
