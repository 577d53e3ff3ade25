"""Browsers that stay open for all tests of the page; where there is none, a word says why."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from view.browser import NO_GL, SOFTWARE_GL, Browser, missing


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    yield from opened(SOFTWARE_GL)


@pytest.fixture(scope="module")
def browser_without_gl() -> Iterator[Browser]:
    yield from opened(NO_GL)


def opened(flags: list[str]) -> Iterator[Browser]:
    reason = missing()
    if reason:
        pytest.skip(f"the page is not tried in a browser: {reason}")
    found = Browser(flags)
    yield found
    found.close()
