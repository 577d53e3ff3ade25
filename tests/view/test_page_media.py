"""The page in a real browser: light and dark, paper, phones, many rows."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from view.browser import Browser
from view.page_data import four_bar, packed
from view.watching import Show, colours, row


def test_dark_and_light(show: Show) -> None:
    def background(browser: Browser) -> int:
        text = browser.evaluate("getComputedStyle(document.body).backgroundColor")
        return int(text.split("(")[1].split(",")[0])

    browser = show(four_bar(), dark=True)
    assert background(browser) < 60
    dark = max(colours(browser).items(), key=lambda each: each[1])[0]
    browser.click(".theme")
    assert background(browser) > 200
    assert max(colours(browser).items(), key=lambda each: each[1])[0] != dark
    browser.click(".theme")
    browser.media(media="print")
    assert background(browser) > 200, "paper is light"


def test_print_shows_picture_and_all_panels(show: Show, tmp_path: Path) -> None:
    data = four_bar()
    data["tables"][0]["rows"][0] = ["0.123457", "-1.5", "1.23457e-05"]
    first_row = (0.1234567890123, -1.5, 1.23456789e-5)
    for column, value in zip(data["tables"][0]["columns"], first_row, strict=True):
        column["exact"] = packed("f64", np.full(73, value))
    browser = show(data, dark=True)
    first = (
        "[...document.querySelector('tr[data-at=\"0\"]').children].map((each) => each.textContent)"
    )
    assert browser.evaluate(first)[:3] == data["tables"][0]["rows"][0]
    titles = browser.evaluate(first.replace("textContent", "title"))
    assert titles[:3] == ["0.1234567890123", "", "0.0000123456789"]
    browser.media(media="print")
    assert browser.evaluate(first)[:3] == data["tables"][0]["rows"][0]
    shown = "getComputedStyle(document.querySelector('{0}')).display"
    assert browser.evaluate(shown.format("#printed")) == "block"
    assert browser.evaluate("document.querySelector('#printed').src.length") > 5000
    assert [
        browser.evaluate(shown.format(each)) for each in ("#curves", "#tables", "#notes", "#tools")
    ] == ["block"] * 3 + ["none"]
    assert browser.evaluate("document.querySelectorAll('#tables tr[data-at]').length") == 73
    browser.pdf(tmp_path / "page.pdf")
    assert (tmp_path / "page.pdf").read_bytes().startswith(b"%PDF")
    browser.media(media="screen")
    assert browser.evaluate(shown.format("#printed")) == "none"


def test_paper_has_the_names_that_the_screen_has(show: Show) -> None:
    pictures = []
    for names in (True, False):
        browser = show(four_bar())
        browser.evaluate(f"window.mechkin.theatre.setShown('names', {str(names).lower()})")
        browser.evaluate("window.mechkin.theatre.stage.draw()")
        browser.media(media="print")
        pictures.append(browser.evaluate("document.querySelector('#printed').src"))
        browser.media(media="screen")
    assert pictures[0] != pictures[1]


@pytest.mark.parametrize("width", [360, 768])
def test_a_phone_has_all_of_it_by_touch(show: Show, width: int) -> None:
    browser = show(four_bar(), width=width, height=740, touch=True)
    assert browser.evaluate("document.documentElement.scrollWidth") <= width
    browser.tap(".play")
    deadline = time.monotonic() + 60
    while row(browser) == 0 and time.monotonic() < deadline:
        time.sleep(0.05)
    browser.tap(".play")
    assert row(browser) > 0
    browser.tap("#tab-tables")
    assert browser.evaluate("document.documentElement.scrollWidth") <= width
    browser.tap("tr[data-at='3'] td")
    assert row(browser) == 3


def test_many_rows_load_and_play_as_few_do(show: Show, capsys: pytest.CaptureFixture[str]) -> None:
    """Only the rows that are seen are elements, and to show a row takes no longer."""
    shown = []
    for rows in (361, 20_000):
        start = time.monotonic()
        browser = show(four_bar(rows, min(rows, 2000)))
        loaded = time.monotonic() - start
        browser.click("#tab-tables")
        count = browser.evaluate("document.querySelectorAll('tr[data-at]').length")
        assert count < 80
        browser.click("#tab-curves")
        frames = browser.evaluate("""(async () => {
          const {info} = window.mechkin.theatre.stage.renderer;
          window.mechkin.play();
          const [first, start] = [info.render.frame, performance.now()];
          await new Promise((done) => setTimeout(done, 1000));
          window.mechkin.pause();
          return (info.render.frame - first) / (performance.now() - start) * 1000;
        })()""")
        assert frames > 0
        each = """(() => {
          const start = performance.now();
          for (let k = 0; k < 100; k += 1) window.mechkin.seek(3 * k + 0.5);
          return (performance.now() - start) / 100;
        })()"""
        shown.append(min(browser.evaluate(each) for _ in range(5)))
        with capsys.disabled():
            print(
                f"\n{rows} rows: loaded in {loaded:.2f} s, {frames:.1f} frames a second by software"
            )
        browser.press("End")
        assert row(browser) == rows - 1
    # 55 times the rows
    assert shown[1] < 10 * shown[0], f"{shown[1]:.2f} ms for {shown[0]:.2f} ms"
