"""A browser for the tests of pages: the distribution's Chromium, driven by Playwright, offline.

One browser serves all tests of a process. Where there is no Chromium, or no Playwright, they are
skipped with the reason.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

Open = Callable[..., "Page"]

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
"""What the program is called, by distribution."""


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """Chromium, started once."""
    driver = pytest.importorskip("playwright.sync_api", reason="Playwright is not installed")
    program = next(filter(None, map(shutil.which, NAMES)), None)
    if program is None:
        pytest.skip(f"no Chromium is installed here: none of {', '.join(NAMES)} is on PATH")
    with driver.sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=program)
        yield chromium
        chromium.close()


@pytest.fixture
def show(browser: Browser, tmp_path: Path) -> Iterator[Open]:
    """Open a page, given as text, at a `#step=`; options are those of a browser context.

    When the test ends, the page must have asked for nothing but its file, and complained of
    nothing.
    """
    complaints: list[str] = []
    contexts: list[Any] = []

    def show(text: str, *, at: str = "", width: int = 1400, height: int = 900, **more: Any) -> Page:
        file = tmp_path / f"{len(contexts)}.html"
        file.write_text(text, encoding="utf-8")
        viewport: Any = {"width": width, "height": height}
        # Reduced motion: what is shown stands at once.
        options: Any = {"reduced_motion": "reduce", "offline": True, **more}
        context = browser.new_context(viewport=viewport, **options)
        contexts.append(context)
        page = context.new_page()
        page.on("console", lambda said: complaints.append(f"{said.type}: {said.text}"))
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on(
            "request",
            lambda asked: (
                None
                if asked.url.startswith((file.as_uri(), "data:image/svg+xml;base64,"))
                else complaints.append(asked.url)
            ),
        )
        page.goto(f"{file.as_uri()}{at}")
        return page

    yield show
    for context in contexts:
        context.close()
    assert not complaints
