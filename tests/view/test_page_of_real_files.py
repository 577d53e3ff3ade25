"""Pages of the mechanisms kept here, in a real browser: what is drawn is what the tables say."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from references import FILE_OF, RCSR
from view import seen
from view.browser import Browser
from view.page_data import write_page
from view.watching import SINGLE

import mechkin_cli as mk

NAMES = ["rcsr", "stewart", "rchch", "five_link_suspension", "slider_crank", "rcsr_response"]


Open = Callable[[str], dict[str, Any]]


@pytest.fixture
def opened(browser: Browser, tmp_path: Path) -> Iterator[Open]:
    """Opens a mechanism's page and gives its data; then nothing may have been complained of."""

    def of(name: str) -> dict[str, Any]:
        data = seen.data(mk.load(FILE_OF[name]))
        browser.open(write_page(tmp_path, data))
        return data

    yield of
    assert browser.told()["said"] == []


@pytest.mark.parametrize("name", NAMES)
def test_every_mode_is_drawn_where_the_data_have_it(
    browser: Browser, opened: Open, name: str
) -> None:
    data = opened(name)
    for run in data["runs"]:
        for number, branch in enumerate(run["branches"][:3]):
            poses = seen.poses(data, data["runs"].index(run), number)
            rows = seen.posed_rows(data, data["runs"].index(run), number)
            drawn = browser.evaluate(f"""(() => {{
              const page = window.mechkin;
              page.setRun({run["name"]!r});
              page.setBranch({branch["name"]!r});
              return {rows.tolist()}.map((row) => {{
                page.seek(row);
                return page.data.links.map(({{name}}) => {{
                  const {{t, q}} = page.pose(name);
                  return [...t, ...q];
                }});
              }});
            }})()""")
            np.testing.assert_array_equal(np.array(drawn), poses)


CLOSED = {"R", "S", "U"}
"""Types whose two halves have their points in one place."""


@pytest.mark.parametrize("name", NAMES)
def test_joints_are_together_as_drawn(browser: Browser, opened: Open, name: str) -> None:
    data = opened(name)
    gaps = browser.evaluate("""(() => {
      const {data, state, seek, theatre} = window.mechkin;
      const found = {};
      for (let row = 0; row < state.branch.rows; row += 1) {
        seek(row);
        for (const {name, links, halves} of data.joints) {
          const [a, b] = halves.map(({point}, k) => theatre.mechanism.now(links[k], point));
          found[name] = Math.max(found[name] ?? 0, a.distanceTo(b));
        }
      }
      return found;
    })()""")
    closed = [joint["name"] for joint in data["joints"] if joint["type"] in CLOSED]
    assert closed
    assert max(gaps[joint] for joint in closed) <= 20 * SINGLE * data["size"]


def test_points_are_drawn_where_the_table_prints_them(browser: Browser, opened: Open) -> None:
    data = opened("rcsr")
    link = {point["name"]: point for point in data["points"]}["pm3"]
    rows = printed("table_04")
    drawn = browser.evaluate(f"""(() => {{
      const {{seek, theatre}} = window.mechkin;
      return {list(range(len(rows)))}.map((row) => {{
        seek(row);
        return theatre.mechanism.now({link["link"]}, {link["place"]}).toArray();
      }});
    }})()""")
    expected = [[float(row[f"pm3_{axis}"]) for axis in "xyz"] for row in rows]
    np.testing.assert_allclose(drawn, expected, atol=0.5e-3 + 20 * SINGLE * data["size"])


def printed(table: str) -> list[dict[str, str]]:
    """The rows that the dissertation prints."""
    with (RCSR.parent / "rcsr" / "published" / f"{table}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("name", ["rcsr", "rcsr_response"])
def test_tables_have_the_cells_of_the_files(browser: Browser, opened: Open, name: str) -> None:
    data = opened(name)
    browser.click("#tab-tables")
    shown = browser.evaluate("""[...document.querySelectorAll('tr[data-at]')].map((row) =>
      [...row.children].map((cell) => cell.textContent))""")
    table = data["tables"][0]
    width = len(table["columns"])
    assert [row[:width] for row in shown] == table["rows"][: len(shown)]
    assert len(shown) == len(table["rows"])
