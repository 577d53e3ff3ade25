"""The page in a real browser: what is drawn is the data, and everything on it does what it says."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from view.browser import Browser
from view.page_data import (
    TYPES,
    FourBar,
    four_bar,
    one_of_every_type,
    slider,
    write_page,
)

SINGLE = 2.0**-22
"""Poses are written in single precision: so far may lengths of a few hundred be off, in parts."""

Show = Callable[..., Browser]


@pytest.fixture
def show(browser: Browser, tmp_path: Path) -> Show:
    """Opens data in the browser; afterwards nothing may have been complained of or fetched."""

    def opened(data: Any, **options: Any) -> Browser:
        browser.open(write_page(tmp_path, data), **options)
        return browser

    return opened


@pytest.fixture(autouse=True)
def _quiet(request: pytest.FixtureRequest) -> Any:
    yield
    if "show" in request.fixturenames:
        told = request.getfixturevalue("browser").told()
        assert told["said"] == []
        assert len(told["asked"]) == 1, "the page has fetched something"


def row(browser: Browser) -> int:
    return int(browser.evaluate("window.mechkin.row()"))


def pose(browser: Browser, link: str) -> tuple[np.ndarray, np.ndarray]:
    found = browser.evaluate(f"window.mechkin.pose({link!r})")
    return np.array(found["t"]), np.array(found["q"])


def moved(found: tuple[np.ndarray, np.ndarray], place: np.ndarray) -> np.ndarray:
    """R(q) place + t."""
    t, (w, *v) = found
    twice = 2 * np.cross(v, place)
    return place + w * twice + np.cross(v, twice) + t


CURVES = "window.mechkin.curves.plots.reduce((sum, plot) => sum + plot.series.length - 1, 0)"


def colours(browser: Browser) -> dict[str, int]:
    """How many points of the canvas have each colour, of a few thousand."""
    found: dict[str, int] = browser.evaluate("""(() => {
      window.mechkin.theatre.stage.draw();
      const from = document.querySelector('#stage canvas'), to = document.createElement('canvas');
      [to.width, to.height] = [100, 75];
      const brush = to.getContext('2d'), counts = {};
      brush.drawImage(from, 0, 0, 100, 75);
      const p = brush.getImageData(0, 0, 100, 75).data;
      for (let k = 0; k < p.length; k += 4) {
        const key = `${p[k] >> 4},${p[k + 1] >> 4},${p[k + 2] >> 4}`;
        counts[key] = (counts[key] ?? 0) + 1;
      }
      return counts;
    })()""")
    return found


@pytest.mark.parametrize("sign", [1.0, -1.0], ids=["own mode", "other mode"])
def test_links_are_drawn_where_closed_forms_have_them(show: Show, sign: float) -> None:
    browser = show(four_bar())
    home = FourBar(np.array([0.0]))
    if sign < 0:
        browser.evaluate("window.mechkin.setBranch('mode 2')")
    for at in (0, 7, 36, 51, 72):
        browser.evaluate(f"window.mechkin.seek({at})")
        bar = FourBar(np.radians([5.0 * at]), sign)
        drawn = [
            (moved(pose(browser, "crank"), home.crank[0]), bar.crank[0]),
            (moved(pose(browser, "coupler"), home.crank[0]), bar.crank[0]),
            (moved(pose(browser, "coupler"), home.rocker[0]), bar.rocker[0]),
            (moved(pose(browser, "rocker"), home.rocker[0]), bar.rocker[0]),
            (moved(pose(browser, "rocker"), home.pivot), home.pivot),
            (moved(pose(browser, "ground"), home.pivot), home.pivot),
        ]
        for found, expected in drawn:
            np.testing.assert_allclose(found, expected, rtol=0, atol=SINGLE * 300)


def test_something_is_drawn_and_each_link_in_its_colour(show: Show) -> None:
    browser = show(four_bar())
    full = colours(browser)
    assert len(full) > 12
    for link in range(1, 4):
        browser.evaluate(f"window.mechkin.theatre.setLinkVisible({link}, false)")
        assert colours(browser) != full
    browser.evaluate("window.mechkin.theatre.setLinkVisible(0, false)")
    browser.evaluate("window.mechkin.theatre.setShown('paths', false)")
    assert len(colours(browser)) <= 2, "an empty stage has one colour"


@pytest.mark.parametrize("letter", [letter for letter in TYPES if letter != "F"])
def test_both_halves_of_every_type_are_drawn(show: Show, letter: str) -> None:
    browser = show(one_of_every_type())
    bulk = browser.evaluate(f"""['holder_', 'mover_'].map((side) => {{
      const {{data, theatre}} = window.mechkin;
      const at = (name) => data.links.findIndex((each) => each.name === name);
      const count = (name) =>
        theatre.mechanism.links[at(name)].children[0].geometry.attributes.position.count;
      return count(side + {letter!r}) - count(side + 'F');
    }})""")
    assert min(bulk) > 30, "no more than the rod of a link without a joint"


def test_the_slider_moves_the_mechanism(show: Show) -> None:
    browser = show(slider())
    browser.fill(".rail input", 20)
    assert row(browser) == 20
    np.testing.assert_allclose(pose(browser, "block")[0], [25, 0, 0], atol=1e-5)
    assert "row 21 of 41" in browser.evaluate("document.querySelector('.where').textContent")


def test_a_row_without_position_is_told_and_pale(show: Show) -> None:
    browser = show(slider())
    opacity = "window.mechkin.theatre.mechanism.links[1].children[0].material.opacity"
    assert browser.evaluate(opacity) == 1
    browser.press("End")
    assert row(browser) == 40
    assert (
        browser.evaluate("document.querySelector('.reading .verdict').textContent")
        == "beyond-dead-centre"
    )
    assert browser.evaluate(opacity) < 0.5
    np.testing.assert_allclose(pose(browser, "block")[0], [50 * 35 / 40, 0, 0], atol=1e-5)
    browser.press("Home")
    assert browser.evaluate(opacity) == 1


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
    deadline = time.monotonic() + 20
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


def test_modes_are_switched_and_compared(show: Show) -> None:
    browser = show(four_bar())
    browser.evaluate("window.mechkin.seek(10)")
    browser.select(".modes select", "mode 2")
    assert (row(browser), browser.evaluate("window.mechkin.state.branch.name")) == (10, "mode 2")
    alone = browser.evaluate(CURVES)
    before = colours(browser)
    browser.click(".modes input")
    assert browser.evaluate("window.mechkin.theatre.ghosts.length") == 1
    assert browser.evaluate(CURVES) > alone
    assert colours(browser) != before
    ghost = browser.evaluate(
        "window.mechkin.theatre.ghosts[0].mechanism.links[3].quaternion.toArray()"
    )
    bar, home = FourBar(np.radians([50.0])), FourBar(np.array([0.0]))
    half = (bar.psi - home.psi)[0] / 2
    np.testing.assert_allclose(ghost, [0, 0, np.sin(half), np.cos(half)], atol=1e-6)


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


def test_arrows_are_to_scale(show: Show) -> None:
    browser = show(four_bar())
    browser.press("f")
    lengths = []
    for at in (0, 18):  # 100 N along x, 60 N along y
        browser.evaluate(f"window.mechkin.seek({at})")
        lengths.append(
            browser.evaluate("""(() => {
          const {group, tip} = window.mechkin.theatre.arrows.all[0];
          return tip.clone().sub(group.position).toArray();
        })()""")
        )
    along, across = (np.array(each) for each in lengths)
    np.testing.assert_allclose(along[1:], 0, atol=1e-4)
    np.testing.assert_allclose(across[0], 0, atol=1e-4)
    np.testing.assert_allclose(across[1] / along[0], 0.6, rtol=1e-5)


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
    data["tables"][0]["rows"][0] = ["0.1234567890123", "-1.5", "1.23456789e-05"]
    browser = show(data, dark=True)
    first = (
        "[...document.querySelector('tr[data-at=\"0\"]').children].map((each) => each.textContent)"
    )
    assert browser.evaluate(first)[:3] == data["tables"][0]["rows"][0]
    browser.media(media="print")
    assert browser.evaluate(first)[:3] == ["0.123457", "-1.5", "0.0000123457"]
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


@pytest.mark.parametrize("width", [360, 768])
def test_a_phone_has_all_of_it_by_touch(show: Show, width: int) -> None:
    browser = show(four_bar(), width=width, height=740, touch=True)
    assert browser.evaluate("document.documentElement.scrollWidth") <= width
    browser.tap(".play")
    deadline = time.monotonic() + 20
    while row(browser) == 0 and time.monotonic() < deadline:
        time.sleep(0.05)
    browser.tap(".play")
    assert row(browser) > 0
    browser.tap("#tab-tables")
    assert browser.evaluate("document.documentElement.scrollWidth") <= width
    browser.tap("tr[data-at='3'] td")
    assert row(browser) == 3


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


@pytest.mark.parametrize(("rows", "seconds"), [(361, 10), (20_000, 20)])
def test_it_loads_and_plays_fast(
    show: Show, capsys: pytest.CaptureFixture[str], rows: int, seconds: float
) -> None:
    data = four_bar(rows, min(rows, 2000))
    start = time.monotonic()
    browser = show(data)
    loaded = time.monotonic() - start
    browser.click("#tab-tables")
    count = browser.evaluate("document.querySelectorAll('tr[data-at]').length")
    assert count < 80, "only the rows that are seen are elements"
    browser.click("#tab-curves")
    frames = browser.evaluate("""(async () => {
      const {info} = window.mechkin.theatre.stage.renderer;
      window.mechkin.play();
      const [first, start] = [info.render.frame, performance.now()];
      await new Promise((done) => setTimeout(done, 3000));
      window.mechkin.pause();
      return (info.render.frame - first) / (performance.now() - start) * 1000;
    })()""")
    with capsys.disabled():
        print(f"\n{rows} rows: loaded in {loaded:.2f} s, {frames:.1f} frames a second by software")
    assert loaded < seconds
    assert frames > 0
    each = browser.evaluate("""(() => {
      const start = performance.now();
      for (let k = 0; k < 100; k += 1) window.mechkin.seek(3 * k + 0.5);
      return (performance.now() - start) / 100;
    })()""")
    assert each < 16, "a row must be shown within a frame, whatever else the machine does"
    browser.press("End")
    assert row(browser) == rows - 1
