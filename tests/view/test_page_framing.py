"""The mechanism stands on the stage with a margin, in every window and in all of its rows."""

from __future__ import annotations

from pathlib import Path

import pytest
from references import FILE_OF, RCSR
from view import seen
from view.browser import Browser
from view.page_data import write_page

import mechkin_cli as mk

WINDOWS = [(1200, 800), (390, 844), (1600, 500)]
LEAST = 0.04
"""Margin on every side, in parts of the stage's width or height."""

MARGINS = """(async () => {
  const {theatre, state} = window.mechkin;
  theatre.setShown('floor', false);
  theatre.setArrows(new Set());
  const from = document.querySelector('#stage canvas'), to = document.createElement('canvas');
  [to.width, to.height] = [from.width, from.height];
  const brush = to.getContext('2d', {willReadFrequently: true});
  let box = [Infinity, -1, Infinity, -1];
  for (const row of [0, Math.floor(state.branch.rows / 2), state.branch.rows - 1]) {
    window.mechkin.seek(row);
    theatre.stage.draw();
    brush.drawImage(from, 0, 0);
    const p = brush.getImageData(0, 0, to.width, to.height).data;
    for (let k = 0; k < p.length; k += 4) {
      if ([0, 1, 2].every((c) => Math.abs(p[k + c] - p[c]) < 40)) continue;
      const [x, y] = [(k / 4) % to.width, Math.floor(k / 4 / to.width)];
      box = [Math.min(box[0], x), Math.max(box[1], x), Math.min(box[2], y), Math.max(box[3], y)];
    }
  }
  const [w, h] = [to.width, to.height];
  return [box[0] / w, 1 - box[1] / w, box[2] / h, 1 - box[3] / h];
})()"""
"""Left, right, above and below, in parts; the first pixel has the background's colour."""


def resized(browser: Browser, width: int, height: int) -> None:
    browser.resize(width, height)
    browser.evaluate("new Promise((done) => setTimeout(done, 100))")


@pytest.mark.parametrize("name", ["rcsr", "stewart", "slider_crank"])
def test_a_margin_in_every_window(browser: Browser, tmp_path: Path, name: str) -> None:
    page = write_page(tmp_path, seen.data(mk.load(FILE_OF[name])))
    browser.open(page, width=WINDOWS[0][0], height=WINDOWS[0][1])
    for window in WINDOWS:
        resized(browser, *window)
        margins = browser.evaluate(MARGINS)
        assert min(margins) > LEAST, (window, margins)
    assert browser.told()["said"] == []


def test_a_view_that_was_turned_stays_when_the_window_changes(
    browser: Browser, tmp_path: Path
) -> None:
    page = write_page(tmp_path, seen.data(mk.load(RCSR)))
    browser.open(page, width=1200, height=800)
    where = "window.mechkin.theatre.stage.camera.position.toArray()"
    browser.evaluate("""(() => {
      const {controls, camera} = window.mechkin.theatre.stage;
      controls.dispatchEvent({type: 'start'});
      camera.position.multiplyScalar(1.1);
    })()""")
    turned = browser.evaluate(where)
    resized(browser, 900, 600)
    assert browser.evaluate(where) == pytest.approx(turned, rel=1e-9)
    browser.press("0")
    resized(browser, 1200, 800)
    assert min(browser.evaluate(MARGINS)) > LEAST


def test_the_header_keeps_its_button_in_a_narrow_window(browser: Browser, tmp_path: Path) -> None:
    page = write_page(tmp_path, seen.data(mk.load(FILE_OF["slider_crank"])))
    browser.open(page, width=390, height=844, touch=True)
    title, button = browser.evaluate("""['#title', '#choices > :last-child'].map((each) => {
      const {left, right, top, bottom} = document.querySelector(each).getBoundingClientRect();
      return {left, right, top, bottom};
    })""")
    assert button["right"] > 390 - 20
    assert button["top"] < title["bottom"]
    assert title["right"] <= button["left"]
