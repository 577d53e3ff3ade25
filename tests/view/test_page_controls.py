"""The page in a real browser: everything on it does what it says."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from view.page_data import (
    FourBar,
    four_bar,
    slider,
)
from view.watching import SINGLE, Show, moved, pose, row


def test_the_slider_moves_the_mechanism(show: Show) -> None:
    browser = show(slider())
    browser.fill(".rail input", 20)
    assert row(browser) == 20
    np.testing.assert_allclose(pose(browser, "block")[0], [25, 0, 0], atol=1e-5)
    assert "row 21 of 41" in browser.evaluate("document.querySelector('.where').textContent")


def test_keys(show: Show) -> None:
    browser = show(four_bar())
    seen = []
    for key in (
        "ArrowRight",
        "ArrowRight",
        "ArrowLeft",
        "Shift+ArrowRight",
        "End",
        "ArrowRight",
        "Home",
        "ArrowLeft",
    ):
        browser.press(key)
        seen.append(row(browser))
    assert seen == [1, 2, 1, 11, 72, 72, 0, 0]
    names = []
    for _ in range(2):
        browser.press("m")
        names.append(browser.evaluate("window.mechkin.state.branch.name"))
    assert names == ["mode 2", "mode 1"]
    for shown in (1, 0):
        browser.press("f")
        browser.evaluate("window.mechkin.theatre.stage.draw()")
        assert (
            browser.evaluate("document.querySelectorAll('.name.force:not([hidden])').length")
            == shown
        )


def test_it_plays_and_stops_at_a_row(show: Show) -> None:
    browser = show(four_bar())
    browser.press("Space")
    deadline = time.monotonic() + 60
    while row(browser) < 5 and time.monotonic() < deadline:
        time.sleep(0.05)
    browser.press("Space")
    at = row(browser)
    assert at >= 5
    assert browser.evaluate("window.mechkin.state.place") == at
    bar = FourBar(np.radians([5.0 * at]))
    home = FourBar(np.array([0.0]))
    drawn = moved(pose(browser, "coupler"), home.rocker[0])
    np.testing.assert_allclose(drawn, bar.rocker[0], atol=SINGLE * 300)


def test_a_click_on_a_curve_shows_its_row(show: Show) -> None:
    browser = show(four_bar())
    width = browser.evaluate("document.querySelector('.u-over').getBoundingClientRect().width")
    browser.click(".u-over", at=(0.25 * width, 30))
    assert abs(row(browser) - 18) <= 1


def test_a_click_on_a_table_shows_its_row(show: Show) -> None:
    browser = show(four_bar())
    browser.press("m")
    browser.click("#tab-tables")
    browser.click("tr[data-at='4'] td")
    assert (row(browser), browser.evaluate("window.mechkin.state.branch.name")) == (4, "mode 1")
    cells = browser.evaluate(
        "[...document.querySelectorAll('tr.here td')].map((each) => each.textContent)"
    )
    bar = FourBar(np.radians([20.0]))
    assert cells == [
        "20.00",
        f"{np.degrees(bar.psi[0]):.2f}",
        f"{np.degrees(bar.phi[0]):.2f}",
        "ok",
    ]
    browser.press("End")
    assert browser.evaluate("document.querySelector('tr.here td').textContent") == "360.00"


def test_marks_and_verdicts_are_shown(show: Show) -> None:
    browser = show(four_bar())
    assert (
        browser.evaluate("document.querySelector('.marks').textContent")
        == "dead centre at 180: crank and coupler in line"
    )
    browser.click(".marks button")
    assert row(browser) == 36
    assert (
        browser.evaluate("document.querySelector('.reading .verdict').textContent")
        == "near-singular"
    )
    browser.click("#tab-tables")
    assert browser.evaluate("document.querySelectorAll('tr.doubtful').length") == 3


def test_notes_and_assumptions_are_shown(show: Show) -> None:
    browser = show(four_bar())
    browser.click("#tab-notes")
    text = browser.evaluate("document.querySelector('#notes').innerText")
    for each in ("warning", "the crank is heavy", "four-bar.yaml:3:5", "lengths are in mm"):
        assert each in text


def test_a_second_run_is_shown(show: Show) -> None:
    data = four_bar()
    data["runs"].append({**slider_run(), "name": "release", "kind": "response", "title": "let go"})
    browser = show(data)
    browser.select("#choices select", "release: let go")
    assert browser.evaluate("window.mechkin.state.run.name") == "release"
    assert "t = 0 s" in browser.evaluate("document.querySelector('.where').textContent")
    np.testing.assert_allclose(pose(browser, "crank")[0], 0, atol=1e-6)


def slider_run() -> dict[str, Any]:
    """The four-bar's run against time."""
    return {**four_bar()["runs"][0], "x": {"label": "t", "unit": "s"}}


def test_space_plays_after_any_click(show: Show) -> None:
    browser = show(four_bar())
    for clicked in (".tick input", ".tick span", "#legend button", "#tab-tables", ".theme"):
        browser.click(clicked)
        before = browser.evaluate("document.querySelector('.play').getAttribute('aria-label')")
        browser.press("Space")
        after = browser.evaluate("document.querySelector('.play').getAttribute('aria-label')")
        assert before != after, clicked


def test_keys_reach_what_tab_went_to(show: Show) -> None:
    browser = show(four_bar())
    browser.evaluate("document.querySelector('#tab-tables').focus()")
    browser.press("Space")
    assert browser.evaluate("document.querySelector('.play').getAttribute('aria-label')") == "Play"
