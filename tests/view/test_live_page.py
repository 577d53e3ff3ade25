"""Pages that hold the mechanism's in a frame, in a real browser: the server's and a widget's."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from view.browser import Browser
from view.test_following import CRANK
from view.test_server import server as server

import mechkin_cli as mk
from mechkin_cli.view import LiveServer
from mechkin_cli.view.page import waiting_page
from mechkin_cli.view.server import frames_source

ROWS = "window.mechkin.row ? window.mechkin.row() : null"
OFF = "window.mechkin.data ? window.mechkin.data.points[0].place[0] : null"
"""The r of the file that the page shows."""


def eventually(ask: Callable[[], Any], wanted: Any) -> None:
    """Waits for what comes after something else, however slow the machine: a minute is a hang."""
    deadline = time.monotonic() + 60
    found = ask()
    while found != wanted and time.monotonic() < deadline:
        time.sleep(0.02)
        found = ask()
    assert found == wanted


LATE = """(() => {
  const { scene, renderer } = window.mechkin.theatre.stage;
  const users = new Map();
  scene.traverse(({ material }) => {
    const program = material && renderer.properties.get(material).currentProgram;
    if (program) users.set(program, (users.get(program) ?? new Set()).add(material));
  });
  return [users.size > 2, [...users].filter(([program, own]) => program.usedTimes <= own.size)
    .map(([program]) => program.type)];
})()"""
"""Whether several programs draw, and those that the drawing alone uses."""


def test_a_picture_waits_for_no_program(server: LiveServer, browser: Browser) -> None:
    """All programs of the drawing are compiled while its frame waits, so that these are used there,
    too. By software that takes some hundredths of a second for each, at every change of the file.
    """
    # what turns about y has a floor, of lines with colours
    server.follower.path.write_text(CRANK.replace("[0, 0, 1]", "[0, 1, 0]"))
    browser.visit(server.address)
    eventually(lambda: browser.inside("Boolean(window.mechkin.theatre?.stage.floor)"), True)
    eventually(lambda: browser.inside(LATE), [True, []])


def test_the_page_follows_the_file(server: LiveServer, browser: Browser) -> None:
    path = server.follower.path
    browser.visit(server.address)
    eventually(lambda: browser.inside(OFF), 40)
    assert browser.evaluate("document.querySelector('#state').textContent") == "follows the file"
    browser.inside("window.mechkin.seek(2), document.querySelector('#tab-tables').click()")
    browser.inside(
        "window.mechkin.theatre.fitted = null, window.mechkin.theatre.stage.moveTo("
        "{position: [3, 4, 500], up: [0, 1, 0], target: [3, 4, 0]})"
    )
    # a fault beside the picture, shown as text
    path.write_text(CRANK.replace("name: crank", "nam: '<img src=x>'"))
    line = "document.querySelector('#faults pre')?.textContent"
    eventually(lambda: browser.evaluate(line), "2 | nam: '<img src=x>'")
    assert browser.evaluate("document.querySelectorAll('#faults img').length") == 0
    eventually(lambda: browser.inside(OFF), 40)
    # the next picture, where the reader was
    path.write_text(CRANK.replace("40 mm", "41 mm"))
    eventually(lambda: browser.inside(OFF), 41)
    eventually(lambda: browser.evaluate("document.querySelector('#faults').hidden"), True)
    eventually(lambda: browser.inside(ROWS), 2)
    eventually(lambda: browser.inside("document.querySelector('#tables')?.hidden"), False)
    position = "window.mechkin.theatre?.stage.camera.position.toArray()"
    eventually(lambda: browser.inside(position), pytest.approx([3, 4, 500]))
    # what the page is set to is written on request; an expression only when it is named
    eventually(lambda: browser.inside("window.mechkin.dimensions?.parameters.length"), 1)
    browser.inside("window.mechkin.dimensions.set('r', 44)")
    write = "document.querySelector('#write:not([hidden])')?.textContent"
    eventually(lambda: browser.evaluate(write), "Write r into the file")
    browser.click("#write")
    said = "document.querySelector('#said').textContent"
    eventually(lambda: browser.evaluate(said), "written: r: 44 mm")
    assert path.read_text() == CRANK.replace("40 mm", "44 mm")
    eventually(lambda: browser.inside(OFF), 44)
    write_from_the_page(browser, {"e": 30})
    browser.click("#write")
    eventually(lambda: browser.evaluate("document.querySelectorAll('#acts button').length"), 2)
    browser.click("#acts button")
    eventually(lambda: browser.evaluate(said), "written: e: 30 mm")
    assert path.read_text() == CRANK.replace("40 mm", "44 mm").replace("r/2", "30 mm")
    server.close()
    state = "document.querySelector('#state').textContent"
    eventually(lambda: "mechkin has ended" in browser.evaluate(state), True)
    told = browser.told()
    # what is asked of a server that has ended, and no more
    assert all("ERR_" in each for each in told["said"])
    assert all(each.startswith(server.address) for each in told["asked"])


def test_an_end_while_a_picture_is_on_its_way_is_told_last(
    server: LiveServer, browser: Browser
) -> None:
    browser.visit(server.address)
    eventually(lambda: browser.inside(OFF), 40)
    # what is on its way until it is let go
    browser.evaluate(
        "window.fetch = () => new Promise((done) => { window.letGo = () => done({status: 204}) })"
    )
    server.follower.path.write_text(CRANK.replace("40 mm", "41 mm"))
    eventually(lambda: browser.evaluate("Boolean(window.letGo)"), True)
    server.close()
    state = "document.querySelector('#state').textContent"
    eventually(lambda: "mechkin has ended" in browser.evaluate(state), True)
    browser.evaluate("window.letGo(), new Promise((done) => setTimeout(done, 100)).then(() => 1)")
    assert "mechkin has ended" in browser.evaluate(state)


def write_from_the_page(browser: Browser, values: dict[str, float]) -> None:
    """Lets the page tell that it was set to other values, as it does when they are dragged."""
    message = json.dumps({"mechkin": "parameters", "values": values, "texts": {}})
    browser.inside(f"window.parent.postMessage({message}, '*')")
    hidden = "document.querySelector('#write').hidden"
    eventually(lambda: browser.evaluate(hidden), False)


def test_others_are_not_heard(server: LiveServer, browser: Browser) -> None:
    browser.visit(server.address)
    eventually(lambda: browser.inside(OFF), 40)
    message = {"mechkin": "parameters", "values": {"r": 44}}
    browser.evaluate(f"window.postMessage({json.dumps(message)}, '*')")
    browser.evaluate("new Promise((done) => setTimeout(done, 100))")
    assert browser.evaluate("document.querySelector('#write').hidden") is True
    # nor does the frame reach anything
    tries = "try { return String(window.parent.document.title) } catch (e) { return e.name }"
    assert browser.inside(f"(() => {{ {tries} }})()") == "SecurityError"
    asked = f"fetch({server.address!r} + 'news').then(() => 'open', (e) => e.name)"
    assert browser.inside(asked) == "TypeError"


HARNESS = """\
<!doctype html><meta charset="utf-8"><title>notebook</title><div id="cell"></div>
<script type="module">
const given = {given};
const acts = {};
// what anywidget gives a widget: values, saved changes, and who hears of them
const model = {
  get: (name) => given[name],
  set(name, value) {
    if (JSON.stringify(given[name]) === JSON.stringify(value)) return;
    given[name] = value;
    for (const act of acts["change:" + name] ?? []) act();
  },
  save_changes() {
    window.saved = structuredClone({ row: given.row, parameters: given.parameters });
  },
  on: (name, act) => (acts[name] ??= []).push(act),
  off: () => {},
};
const esm = {esm};
const widget = await import(URL.createObjectURL(new Blob([esm], { type: "text/javascript" })));
window.model = model;
window.end = widget.default.render({ model, el: document.querySelector("#cell") });
</script>
"""


def data_of(text: str) -> str:
    page = mk.loads(text).view(modes=False)
    (found,) = re.findall(r'id="mechkin-data">(.*?)</script>', page.html, re.DOTALL)
    return str(found)


def crank(r: float) -> str:
    return data_of(CRANK.replace("40 mm", f"{r} mm"))


def notebook(browser: Browser, folder: Path, row: int) -> None:
    """Opens a page with a widget at a row."""

    def script(value: Any) -> str:
        return json.dumps(value).replace("<", "\\u003c")

    given = {"_page": waiting_page().decode(), "_data": crank(40), "parameters": {"r": 40}}
    page = HARNESS.replace("{given}", script({**given, "row": row}))
    page = page.replace("{esm}", script(frames_source("widget.js")))
    place = folder / "notebook.html"
    place.write_text(page, encoding="utf-8")
    browser.visit(place.as_uri())


def test_a_widget_hands_over_what_changes(browser: Browser, tmp_path: Path) -> None:
    notebook(browser, tmp_path, 1)
    eventually(lambda: browser.inside(ROWS), 1)  # as Python has it
    browser.inside("window.mechkin.seek(2)")
    eventually(lambda: browser.evaluate("window.saved?.row"), 2)
    browser.evaluate("window.model.set('row', 0)")
    eventually(lambda: browser.inside(ROWS), 0)
    message = {"mechkin": "parameters", "values": {"r": 43}}
    browser.inside(f"window.parent.postMessage({json.dumps(message)}, '*')")
    eventually(lambda: browser.evaluate("window.saved.parameters"), {"r": 43})
    # a row that is not there
    browser.evaluate("window.model.set('row', 99)")
    eventually(lambda: browser.evaluate("window.saved.row"), 2)
    eventually(lambda: browser.inside(ROWS), 2)
    browser.evaluate("window.end()")
    assert browser.evaluate("document.querySelectorAll('iframe').length") == 0


def test_new_data_are_shown_where_the_reader_is(browser: Browser, tmp_path: Path) -> None:
    notebook(browser, tmp_path, 0)
    eventually(lambda: browser.inside(ROWS), 0)
    # what Python computes comes in the same moment as the news of the reader's row
    script = "window.model.on('change:row', () => window.next && window.model.set('_data', next))"
    browser.evaluate(f"window.next = {json.dumps(crank(42))}, {script}")
    browser.inside("window.mechkin.seek(2)")
    eventually(lambda: browser.inside(OFF), 42)
    eventually(lambda: browser.inside(ROWS), 2)
    # each of several in the moment when the one before is seen
    rest = json.dumps([crank(r) for r in (51, 52, 53)])
    browser.evaluate(
        f"window.rest = {rest}, new MutationObserver(() => {{ const next = window.rest.shift(); "
        "if (next) window.model.set('_data', next) }).observe(document.body, "
        "{subtree: true, attributeFilter: ['inert']})"
    )
    browser.evaluate(f"window.next = null, window.model.set('_data', {json.dumps(crank(50))})")
    eventually(lambda: browser.inside(OFF), 53)
    # Python, or the reader, goes on while the next page is drawn behind this one
    browser.evaluate(f"window.model.set('_data', {json.dumps(crank(43))})")
    browser.evaluate("window.model.set('row', 1)")
    eventually(lambda: browser.inside(OFF), 43)
    eventually(lambda: browser.inside(ROWS), 1)
    browser.inside(
        "(() => { const go = ({ data }) => { if (data?.mechkin !== 'where') return; "
        "removeEventListener('message', go); window.mechkin.seek(0); }; "
        "addEventListener('message', go); })()"
    )
    browser.evaluate(f"window.model.set('_data', {json.dumps(crank(44))})")
    eventually(lambda: browser.inside(OFF), 44)
    eventually(lambda: [browser.inside(ROWS), browser.evaluate("window.saved.row")], [0, 0])
    # the same place is another row where there are more of them
    browser.inside("window.mechkin.seek(2)")
    text = CRANK.replace("40 mm", "45 mm").replace("step: 45", "step: 15")
    browser.evaluate(f"window.model.set('_data', {json.dumps(data_of(text))})")
    eventually(lambda: browser.inside(OFF), 45)
    eventually(lambda: [browser.inside(ROWS), browser.evaluate("window.saved.row")], [6, 6])
