"""Browsers that stay open for all tests of the page; where there is none, a word says why."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from view.browser import NO_GL, SOFTWARE_GL, Browser, missing
from view.page_data import write_page
from view.watching import Show


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    yield from opened(SOFTWARE_GL)


@pytest.fixture(scope="module")
def browser_without_gl() -> Iterator[Browser]:
    yield from opened(NO_GL)


@pytest.fixture
def show(browser: Browser, tmp_path: Path) -> Iterator[Show]:
    """Opens data in the browser; afterwards nothing may have been complained of or fetched."""

    def shown(data: Any, **options: Any) -> Browser:
        browser.open(write_page(tmp_path, data), **options)
        return browser

    yield shown
    told = browser.told()
    assert told["said"] == []
    assert len(told["asked"]) == 1, "the page has fetched something"


def opened(flags: list[str]) -> Iterator[Browser]:
    reason = missing()
    if reason:
        pytest.skip(f"the page is not tried in a browser: {reason}")
    found = Browser(flags)
    yield found
    found.close()
