"""Changed dimensions on the page in a real browser; its kernel is a four-bar in closed form."""

from __future__ import annotations

import base64
import hashlib
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from view.browser import Browser
from view.page_data import FourBar, four_bar, packed, write_page
from view.seen import array
from view.watching import SINGLE, Show, moved, pose, row

KERNEL = Path(__file__).with_name("live_four_bar.js").read_text(encoding="utf-8")
FILE = "# \U0001f600 lengths\nparameters:\n  a: 30 mm   # the crank\n  b: 80\n  c: 6 cm\n"
SPANS = {
    name: [FILE.index(text), FILE.index(text) + len(text)]
    for name, text in (("a", "30 mm"), ("b", "80"), ("c", "6 cm"))
}
SLIDER = "[aria-label='{0} in mm'][type=range]"
FIELD = "[aria-label='{0} in mm, number']"
SETTLED = """new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() =>
  requestAnimationFrame(done))))"""
KEPT = """(() => { window.kept = []; const make = URL.createObjectURL.bind(URL);
  URL.createObjectURL = (blob) => { window.kept.push(blob); return make(blob); }; })()"""

Live = Callable[..., Browser]


@pytest.fixture
def live(show: Show) -> Live:
    def shown(**options: Any) -> Browser:
        data = four_bar()
        data["live"] = {"file": {"text": FILE, "spans": SPANS}}
        browser = show(data, **options)
        browser.evaluate(KERNEL)
        return browser

    return shown


def text(browser: Browser, selector: str) -> str:
    return str(browser.evaluate(f"document.querySelector({selector!r}).textContent"))


def values(browser: Browser) -> dict[str, float]:
    found: dict[str, float] = browser.evaluate("window.mechkin.dimensions.values")
    return found


def set_to(browser: Browser, name: str, value: float) -> None:
    browser.fill(FIELD.format(name), value)
    browser.press("Enter")
    browser.evaluate(SETTLED)


def drawn_tip(browser: Browser, **lengths: float) -> np.ndarray:
    """Where the changed coupler's point is in the picture."""
    home = FourBar(np.zeros(1), **lengths)
    return moved(pose(browser, "coupler"), home.coupler_point[0])


def test_all_follows_a_slider(live: Live) -> None:
    browser = live()
    browser.evaluate("window.mechkin.seek(9)")
    index = browser.evaluate(f'document.querySelector("{SLIDER.format("a")}").value')
    browser.fill(SLIDER.format("a"), int(index) + 40)
    browser.evaluate(SETTLED)
    a = values(browser)["a"]
    assert a == 34
    bar = FourBar(np.radians(np.linspace(0, 360, 73)), a=a)
    tip = bar.coupler_point[9]
    np.testing.assert_allclose(drawn_tip(browser, a=a), tip, atol=SINGLE * 300)
    curves = browser.evaluate("window.mechkin.curves.plots[0].data.map((each) => [...each])")
    np.testing.assert_allclose(curves[1], np.degrees(bar.psi), atol=1e-9)
    old = FourBar(np.radians(np.linspace(0, 360, 73)))
    np.testing.assert_allclose(curves[3], np.degrees(old.psi), atol=1e-9, err_msg="the dashed one")
    assert text(browser, "#curves .remark") == "dashed: original"
    browser.click("#tab-tables")
    cells = browser.evaluate("[...document.querySelectorAll('tr.here td')].map((e) => e.innerText)")
    assert cells[:3] == ["45.00", f"{np.degrees(bar.psi[9]):.2f}", f"{np.degrees(bar.phi[9]):.2f}"]
    browser.click("#tab-peaks")
    peaks = browser.evaluate("[...document.querySelectorAll('.peaks td')].map((e) => e.innerText)")
    highest = [np.degrees(one.psi).max() for one in (old, bar)]
    assert [float(one) for one in peaks[:2]] == pytest.approx(highest, rel=1e-5)
    assert peaks[2] == f"+{100 * (highest[1] / highest[0] - 1):.2f} %"
    browser.click("#tab-curves")
    browser.click(".actions .tick input")
    assert text(browser, "#curves .remark") == "", "without the original"


def test_undo_redo_and_reset(live: Live) -> None:
    browser = live()
    set_to(browser, "a", 33)
    set_to(browser, "b", 85.25)
    assert (values(browser)["a"], values(browser)["b"]) == (33, 85.25)
    browser.evaluate("document.activeElement.blur()")
    browser.press("Control+z")
    browser.evaluate(SETTLED)
    assert (values(browser)["a"], values(browser)["b"]) == (33, 80)
    browser.click("[aria-label^='Undo']")
    assert values(browser)["a"] == 30
    assert browser.evaluate("window.mechkin.state.original") is None
    np.testing.assert_allclose(
        drawn_tip(browser), FourBar(np.zeros(1)).coupler_point[0], atol=SINGLE * 300
    )
    for key in ("Control+Shift+z", "Control+y"):
        browser.press(key)
        browser.evaluate(SETTLED)
    assert (values(browser)["a"], values(browser)["b"]) == (33, 85.25)
    browser.click("[aria-label='Reset a']")
    assert (values(browser)["a"], values(browser)["b"]) == (30, 85.25)
    browser.click("[aria-label^='Reset all']")
    assert values(browser) == {"a": 30, "b": 80, "c": 60, "d": 90}


def test_a_slider_ends_where_the_mechanism_does(live: Live) -> None:
    browser = live()
    set_to(browser, "a", 58)  # Grashof: the crank turns while a + d <= b + c
    assert values(browser)["a"] == 50
    assert text(browser, ".words").startswith("a can go no further than 50 mm. No position at row")
    grey = browser.evaluate(
        "getComputedStyle(document.querySelectorAll('.beyond')[1]).getPropertyValue('--from')"
    )
    assert float(grey) == pytest.approx((50 - 15) / (60 - 15), abs=0.01)
    set_to(browser, "a", 30)
    set_to(browser, "a", 55)
    assert values(browser)["a"] == 50, "known by now"
    set_to(browser, "b", 81)
    set_to(browser, "a", 55)
    assert values(browser)["a"] == 51, "another end with another coupler"


def test_keys_belong_to_the_slider_that_has_the_focus(live: Live) -> None:
    browser = live()
    browser.evaluate(f'document.querySelector("{SLIDER.format("d")}").focus()')
    browser.press("ArrowRight")
    browser.evaluate(SETTLED)
    assert (row(browser), values(browser)["d"]) == (0, 90.2)
    said = browser.evaluate(
        f'document.querySelector("{SLIDER.format("d")}").getAttribute("aria-valuetext")'
    )
    assert said == "90.2 mm"
    unnamed = browser.evaluate(
        """[...document.querySelectorAll('#dimensions input, #dimensions button, .menu button')]
        .filter((each) => !each.getAttribute('aria-label') && !each.innerText
          && !each.textContent && !each.closest('label')).length"""
    )
    assert unnamed == 0


def test_a_mode_that_does_not_follow_is_as_the_file_has_it(live: Live) -> None:
    browser = live()
    set_to(browser, "a", 33)
    browser.evaluate("document.activeElement.blur()")
    browser.press("m")
    assert "cannot be followed to the changed ones" in text(browser, "#dimensions .remark")
    home = FourBar(np.zeros(1))
    other = FourBar(np.zeros(1), -1.0)
    drawn = moved(pose(browser, "coupler"), home.rocker[0])
    np.testing.assert_allclose(drawn, other.rocker[0], atol=SINGLE * 300)
    browser.press("m")
    assert "called by their letters in the file" in text(browser, "#dimensions .remark")


def saved(browser: Browser, name: str) -> bytes:
    """What an entry of the menu writes."""
    browser.evaluate(KEPT)
    browser.evaluate(
        f"[...document.querySelectorAll('.menu button')]"
        f".find((each) => each.textContent === {name!r}).click()"
    )
    found = browser.evaluate(
        """(async () => {
          for (let k = 0; !window.kept.length && k < 400; k += 1)
            await new Promise((done) => setTimeout(done, 20));
          return [...new Uint8Array(await window.kept[0].arrayBuffer())];
        })()"""
    )
    return bytes(found)


def test_what_is_taken_along(live: Live) -> None:
    browser = live()
    for name, value in (("a", 33.5), ("b", 82), ("c", 61)):
        set_to(browser, name, value)
    bar = FourBar(np.radians(np.linspace(0, 360, 73)), a=33.5, b=82, c=61)
    file = saved(browser, "Download file").decode()
    changed = FILE.replace("30 mm", "33.5 mm").replace("80", "82").replace("6 cm", "61 mm")
    assert file == changed
    lines = saved(browser, "Table as CSV").decode().splitlines()
    assert lines[0] == "theta,psi,phi"
    psi = np.array([float(line.split(",")[1]) for line in lines[1:]])
    np.testing.assert_allclose(psi, np.degrees(bar.psi), rtol=1e-13)
    assert saved(browser, "Picture as PNG").startswith(b"\x89PNG")
    for name, least in (("Curves as SVG", 8), ("Picture as SVG", 7)):
        root = ET.fromstring(saved(browser, name))
        assert len(list(root.iter())) > least
    codes = saved(browser, "Picture as DXF").decode("ascii").split("\r\n")
    pairs = list(zip(codes[::2], codes[1::2], strict=False))
    assert pairs[-1] == ("0", "EOF")
    at = [k for k, pair in enumerate(pairs) if pair == ("0", "CIRCLE")]
    centres = [(float(pairs[k + 2][1]), float(pairs[k + 3][1])) for k in at]
    expected = np.array([[0, 0, 0], bar.crank[0], bar.rocker[0], bar.pivot])[:, :2]
    np.testing.assert_allclose(centres, expected, atol=1e-4)


def test_the_motion_is_filmed(live: Live) -> None:
    browser = live()
    browser.evaluate("window.mechkin.data.view.speed = 0.3")
    assert saved(browser, "Motion as film").startswith(b"\x1a\x45\xdf\xa3"), "WebM"
    assert row(browser) == 0, "as before"


def test_a_hostile_page_of_many_rows_and_sixty_parameters(show: Show) -> None:
    hostile = '<img src=x onerror="window.hacked=1">&amp;\u202e</script>'
    data = four_bar(rows=4000, poses=500)
    data["live"] = {"file": {"text": hostile, "spans": {hostile: [0, 4]}}}
    browser = show(data)
    browser.evaluate(
        KERNEL.replace("const parameters = [", "const more = Array.from({ length: 56 }, (_, k) => "
        f"({{ name: {hostile!r} + k, unit: {hostile!r}, value: 0, text: '', low: -1, high: 1 }}));"
        "const parameters = [...more,").replace("rows: Int32Array.from(degrees, (_, k) => k)",
        "rows: own.poses.rows").replace('words: `', f'words: {hostile!r} + `')
    )  # fmt: skip
    assert browser.evaluate("document.querySelectorAll('.dimension').length") == 60
    set_to_first = "window.mechkin.dimensions.set('a', 33)"
    browser.evaluate(f"{set_to_first}; {SETTLED}")
    browser.evaluate("window.mechkin.dimensions.set('a', 58)")
    browser.evaluate(f"window.mechkin.dimensions.set({(hostile + '3')!r}, 0.5); {SETTLED}")
    for tab in ("peaks", "tables", "curves"):
        browser.click(f"#tab-{tab}")
    for name in ("Download file", "Curves as SVG", "Picture as SVG", "Picture as DXF"):
        assert saved(browser, name)
    assert browser.evaluate("window.hacked ?? null") is None
    assert browser.evaluate("document.querySelectorAll('img:not(#printed)').length") == 0


def test_the_parameters_are_copied(live: Live) -> None:
    browser = live()
    browser.evaluate("navigator.clipboard.writeText = async (text) => (window.copied = text)")
    set_to(browser, "b", 82)
    browser.click("[aria-label='Copy as parameters']")
    assert browser.evaluate("window.copied") == "parameters:\n  b: 82\n"
    assert text(browser, "#dimensions .copied") == "copied"


def crank_pin(browser: Browser, degrees: float) -> list[float]:
    """Where on the window the crank's outer end is seen at an angle."""
    x, y = 0.8 * 30 * np.cos(np.radians(degrees)), 0.8 * 30 * np.sin(np.radians(degrees))
    found: list[float] = browser.evaluate(f"""(() => {{
      const {{ stage, mechanism }} = window.mechkin.theatre;
      const at = mechanism.now(0, [{x}, {y}, 0]).project(stage.camera);
      const box = stage.renderer.domElement.getBoundingClientRect();
      return [box.left + (1 + at.x) * box.width / 2, box.top + (1 - at.y) * box.height / 2];
    }})()""")
    return found


@pytest.mark.parametrize("touch", [False, True])
def test_the_driven_link_is_dragged(live: Live, touch: bool) -> None:
    browser = live(touch=touch)
    camera = browser.evaluate("window.mechkin.theatre.stage.camera.position.toArray()")
    way = [crank_pin(browser, angle) for angle in (0, 20, 45, 62)]
    browser.drag(way, touch)
    assert row(browser) in (12, 13)
    assert browser.evaluate("window.mechkin.state.place") == row(browser), "a row that is computed"
    browser.drag([crank_pin(browser, angle) for angle in (60, 30, 0, -20)], touch)
    assert row(browser) == 68, "round a closed cycle"
    now = browser.evaluate("window.mechkin.theatre.stage.camera.position.toArray()")
    assert now == camera, "the view has not turned"


def test_dragging_stops_at_a_dead_centre_and_names_it(show: Show) -> None:
    data = four_bar()
    one = data["runs"][0]["branches"][0]
    rows = np.arange(13)
    poses = array(one["poses"]["values"]).reshape(73, -1)[:13]
    one["poses"] = {"rows": packed("i32", rows), "values": packed("f32", poses)}
    one["marks"] = [{"x": 61.0, "kind": "dead-centre", "text": "coupler and rocker in line"}]
    one["arrows"] = []
    browser = show(data)
    way = [crank_pin(browser, angle) for angle in (0, 30, 60, 90, 120)]
    browser.evaluate("""(() => { window.said = []; new MutationObserver(() =>
      window.said.push(document.querySelector('#said').textContent))
      .observe(document.querySelector('#said'), { childList: true }); })()""")
    browser.drag(way)
    assert row(browser) == 12
    assert "dead centre at A.theta = 61 deg: coupler and rocker in line" in browser.evaluate(
        "window.said"
    )


HOLDER = """<!doctype html><iframe id="page" src="page.html" width="900" height="600"></iframe>
<script>
window.heard = [];
addEventListener("message", (event) => window.heard.push(event.data));
const loaded = new Promise((done) => { document.querySelector("#page").onload = done; });
window.mechkin = { ready: loaded };
</script>"""


def test_the_page_in_a_frame_is_heard_and_set(browser: Browser, tmp_path: Path) -> None:
    """The kernel is put in by a script of the page, as frames from files are closed to others."""
    page = write_page(tmp_path, four_bar())
    script = f"window.mechkin.ready.then(() => {KERNEL.strip()})"
    allowed = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    whole = page.read_text(encoding="utf-8").replace("</body>", f"<script>{script}</script></body>")
    page.write_text(whole.replace("script-src ", f"script-src 'sha256-{allowed}' "), "utf-8")
    holder = tmp_path / "holder.html"
    holder.write_text(HOLDER, encoding="utf-8")
    browser.open(holder)
    heard: dict[str, Any] = browser.evaluate("""(async () => {
      const page = document.querySelector("#page").contentWindow;
      const asked = [{ mechkin: "set-parameters", values: { c: 61, x: 1, a: "2" } },
        { mechkin: "set-row", row: 7 }];
      for (let k = 0; k < 300; k += 1) {
        const found = Object.fromEntries(window.heard.map((each) => [each.mechkin, each]));
        if (found.row && found.parameters) return found;
        asked.forEach((each) => page.postMessage(each, "*"));
        await new Promise((done) => setTimeout(done, 50));
      }
      return {};
    })()""")
    assert heard["row"]["row"] == 7
    assert heard["parameters"]["values"] == {"a": 30, "b": 80, "c": 61, "d": 90}
    assert heard["parameters"]["texts"] == {"a": "30 mm", "b": "80", "c": "61 mm", "d": "90 mm"}
