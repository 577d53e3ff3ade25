"""The page in a real browser: hostile names, odd numbers, nothing to show, no way to draw."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from view.browser import Browser
from view.page_data import (
    at_rest,
    branch,
    four_bar,
    packed,
    rod,
    slider,
    write_page,
)
from view.watching import Show, colours, row

HOSTILE = (
    '<img src=x onerror="window.hacked=1"></script><script>window.hacked=1</script><!--\'"`&amp;'
)


def poisoned(value: Any) -> Any:
    """The data with every name and text hostile, as a file from anywhere may have them."""
    kept = ("kind", "type", "severity", "words", "f32", "f64", "i32", "u8", "run")
    if isinstance(value, dict):
        return {key: each if key in kept else poisoned(each) for key, each in value.items()}
    if isinstance(value, list):
        return [poisoned(each) for each in value]
    return HOSTILE + value if isinstance(value, str) else value


def test_hostile_names_stay_text(show: Show) -> None:
    data = poisoned(four_bar())
    data["tables"][0]["run"] = data["runs"][0]["name"]
    data["links"][1]["colour"] = "red;background:url(https://example.org/)"
    data["runs"][0]["branches"][0]["marks"][0]["kind"] = HOSTILE
    data["runs"][0]["branches"][0]["status"]["words"][0] = HOSTILE
    data["notes"][0]["severity"] = HOSTILE
    data["joints"][0]["type"] = HOSTILE
    browser = show(data)
    for tab in ("tables", "notes", "help", "curves"):
        browser.click(f"#tab-{tab}")
    browser.press("f")
    browser.press("c")
    assert browser.evaluate("window.hacked ?? null") is None
    assert (
        browser.evaluate(
            "document.querySelectorAll('img:not(#printed), script:not([type]) ~ script').length"
        )
        == 0
    )
    assert browser.evaluate("document.querySelector('#title').textContent") == HOSTILE + "four-bar"


def test_names_of_the_language_are_no_joint_types(show: Show) -> None:
    data = four_bar()
    for joint, name in zip(
        data["joints"], ["constructor", "__proto__", "toString", "R"], strict=True
    ):
        joint["type"] = name
    assert len(colours(show(data))) > 8


def never_assembled() -> dict[str, Any]:
    data = slider()
    none = np.zeros((0, 2, 7))
    data["runs"][0]["branches"] = [
        branch("mode 1", np.arange(5.0), none, rows=[], codes=np.full(5, 2))
    ]
    return data


def single_row() -> dict[str, Any]:
    data = slider()
    one = at_rest(2)[np.newaxis]
    data["runs"][0]["branches"] = [branch("mode 1", np.array([3.0]), one)]
    return data


def without_joints() -> dict[str, Any]:
    return {**slider(), "joints": []}


def without_links_or_size() -> dict[str, Any]:
    data = slider()
    rest = at_rest(3)[:, np.newaxis]
    return {
        **data,
        "links": data["links"][:1],
        "joints": [],
        "size": 0,
        "runs": [{**data["runs"][0], "branches": [branch("mode 1", np.arange(3.0), rest)]}],
    }


def to_and_fro() -> dict[str, Any]:
    data = slider()
    poses = np.tile(at_rest(2), (6, 1, 1))
    column = {
        "label": "s",
        "unit": "mm",
        "table": "t",
        "rounding": 0.0,
        "values": packed("f64", np.arange(6.0)),
    }
    data["runs"][0]["branches"] = [
        branch("mode 1", np.array([0.0, 1, 2, 1, 0, 0]), poses, columns=[column])
    ]
    return data


def falling() -> dict[str, Any]:
    data = slider()
    poses = np.tile(at_rest(2), (4, 1, 1))
    column = {
        "label": "s",
        "unit": "mm",
        "table": "t",
        "rounding": 0.0,
        "values": packed("f64", np.arange(4.0)),
    }
    data["runs"][0]["branches"] = [
        branch("mode 1", np.array([9.0, 5, 2, 1]), poses, columns=[column])
    ]
    return data


def empty_numbers() -> dict[str, Any]:
    data = four_bar()
    for each in data["runs"][0]["branches"]:
        for arrow in each["arrows"]:
            arrow["values"] = packed("f32", np.full((73, 3), np.nan))
        for column in each["columns"]:
            column["values"] = packed("f64", np.full(73, np.nan))
    return data


def flat_shapes() -> dict[str, Any]:
    data = four_bar()
    one = data["links"][2]["shape"]["points"][0]
    data["links"][1]["shape"] = {"kind": "plate", "points": [one, one, one], "normal": [0, 0, 1]}
    data["links"][2]["shape"]["points"] = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]
    data["links"][3]["shape"] = {"kind": "star", "points": [one], "centre": one}
    data["links"][0]["shape"] = rod([0, 0, 0], [0, 0, 0])
    return data


ODD = [
    never_assembled,
    single_row,
    without_joints,
    without_links_or_size,
    to_and_fro,
    falling,
    empty_numbers,
    flat_shapes,
]


@pytest.mark.parametrize("make", ODD, ids=[make.__name__ for make in ODD])
def test_odd_data_are_shown(show: Show, make: Callable[[], dict[str, Any]]) -> None:
    browser = show(make())
    for key in ("f", "c", "m", "End", "Home", "ArrowRight", "0", "x", "Space", "Space"):
        browser.press(key)
    browser.click("#tab-tables")
    shown = browser.evaluate("!document.querySelector('#no-pose').hidden")
    assert shown == (make is never_assembled)
    assert browser.evaluate("document.querySelector('#no-drawing').hidden")


def test_falling_columns_are_plotted_rising(show: Show) -> None:
    browser = show(falling())
    found = browser.evaluate("window.mechkin.curves.plots[0].data.map((each) => [...each])")
    assert found == [[1, 2, 5, 9], [3, 2, 1, 0]]


def test_what_goes_to_and_fro_is_plotted_over_rows(show: Show) -> None:
    browser = show(to_and_fro())
    found = browser.evaluate("window.mechkin.curves.plots[0].data.map((each) => [...each])")
    assert found == [[1, 2, 3, 4, 5, 6], [0, 1, 2, 3, 4, 5]]


def test_without_webgl_curves_and_tables_work(browser_without_gl: Browser, tmp_path: Path) -> None:
    browser = browser_without_gl
    browser.open(write_page(tmp_path, four_bar()))
    words = browser.evaluate("document.querySelector('#no-drawing').innerText")
    assert "no WebGL" in words
    browser.press("ArrowRight")
    assert row(browser) == 1
    assert browser.evaluate("document.querySelectorAll('.uplot').length") == 2
    browser.click("#tab-tables")
    browser.click("tr[data-at='5'] td")
    assert row(browser) == 5


def test_a_page_without_data_says_so(show: Show) -> None:
    browser = show(None)
    assert "no data" in browser.evaluate("document.querySelector('#no-drawing').innerText")


def test_a_file_without_runs_shows_its_notes(show: Show) -> None:
    browser = show({**four_bar(), "runs": [], "tables": []})
    assert "Nothing of this file has been run" in browser.evaluate(
        "document.querySelector('#no-drawing').innerText"
    )
    assert "the crank is heavy" in browser.evaluate("document.querySelector('#notes').innerText")


def test_a_later_format_is_refused_in_words(browser: Browser, tmp_path: Path) -> None:
    with pytest.raises(AssertionError, match="format 2"):
        browser.open(write_page(tmp_path, {**four_bar(), "format": 2}))
    assert "format 2" in browser.evaluate("document.querySelector('#no-drawing').innerText")
