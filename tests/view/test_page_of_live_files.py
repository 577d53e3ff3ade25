"""Pages that compute, of the mechanisms kept here: the files they give have the command's bytes."""

from __future__ import annotations

import csv
import io
import os
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from live.test_cells import with_values
from live.test_left import driven
from references import FILE_OF, SWEPT
from view.browser import Browser
from view.test_live_page import eventually
from view.watching import SINGLE

import mechkin_cli as mk
from mechkin_cli.tables.csv import csv_bytes
from mechkin_cli.verdict import SWEEP
from mechkin_cli.view.joints import link_poses
from mechkin_cli.view.page import Lengths
from mechkin_cli.view.scene import page_data

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
FEW = ["planar_four_bar", "rcsr", "walking_leg", "lecture_ex3_3_translation"]
NAMES = [*([path.stem for path in SWEPT] if TIMES > 1 else FEW), "rcsr_response"]

# values of a page's parameters, some steps of their sliders away, with which it computes all rows
VARIED = """(async (steps) => {
  const { dimensions } = window.mechkin;
  const values = {};
  dimensions.parameters.forEach(({ name, value }, k) => {
    const grid = dimensions.grids.get(name);
    const changed = { ...values, [name]: grid.at(grid.indexOf(value) + steps[k % steps.length]) };
    if (dimensions.run.compute(changed).end === 'complete') Object.assign(values, changed);
  });
  dimensions.setAll(values);
  for (let k = 0; k < 3; k += 1) await new Promise((done) => requestAnimationFrame(done));
  return dimensions.values;
})"""


def told(browser: Browser) -> dict[str, str]:
    """The tables of the first run as CSV, by name."""
    found: dict[str, str] = browser.evaluate("""Object.fromEntries(window.mechkin.state.tables
      .map((table, k) => [table, k])
      .filter(([table]) => table.run === window.mechkin.state.data.runs[0].name)
      .map(([table, k]) => [table.name, window.mechkin.csv(k)]))""")
    return found


def columns(text: str, without: list[str]) -> list[list[str]]:
    """The cells of the columns that a page fills."""
    header, *rows = csv.reader(io.StringIO(text))
    kept = [k for k, label in enumerate(header) if label not in without]
    return [[row[k] for k in kept] for row in (header, *rows)]


@pytest.mark.parametrize("name", NAMES)
def test_tables_and_poses_are_those_of_the_command(
    browser: Browser, tmp_path: Path, name: str
) -> None:
    model = mk.load(FILE_OF[name])
    page = model.view(tmp_path / "page.html", modes=False)
    browser.open(page)
    if not browser.evaluate("Boolean(window.mechkin.data.live)"):
        pytest.skip("nothing of it can be changed in a page")
    leaves = browser.evaluate("window.mechkin.data.live.left")
    rng = np.random.default_rng(len(name))
    for case in range(1 + TIMES):
        values: dict[str, Any] = {}
        if case > 0:
            values = browser.evaluate(f"{VARIED}({rng.integers(-9, 9, 5).tolist()})")
        varied = with_values(model, values)
        analysis = varied.analyze() if SWEEP in model.runs else varied.respond()
        mine = told(browser)
        for table in analysis.tables:
            theirs = csv_bytes(table).decode()
            left = [one["label"] for one in leaves if one["table"] == table.name] if values else []
            if left:
                assert columns(mine[table.name], left) == columns(theirs, left), values
            else:
                assert mine[table.name] == theirs, (name, table.name, values)
        links = browser.evaluate("window.mechkin.data.links.map(({ name }) => name)")
        poses = browser.evaluate("[...window.mechkin.state.branch.values]")
        expected = link_poses(analysis.result, links)
        expected[:, :, :3] = Lengths(model.problem.units).array(expected[:, :, :3])
        shown = np.array(poses, dtype=float).reshape(expected.shape)
        turned = np.sign(np.einsum("plk,plk->pl", shown[..., 3:], expected[..., 3:]))
        shown[..., 3:] *= turned[..., None]
        size = np.abs(expected[..., :3]).max()
        np.testing.assert_allclose(shown[..., 3:], expected[..., 3:], atol=4 * SINGLE)
        np.testing.assert_allclose(shown[..., :3], expected[..., :3], atol=4 * SINGLE * (size + 1))
    assert browser.told()["said"] == []


def test_another_mode_follows_when_it_is_shown(browser: Browser, tmp_path: Path) -> None:
    browser.open(mk.load(FILE_OF["planar_four_bar"]).view(tmp_path / "page.html"))
    shown = browser.evaluate(f"""(async () => {{
      const {{ state }} = window.mechkin;
      const changed = await {VARIED}([3]);
      window.mechkin.setBranch(state.branches()[1].name);
      return [Object.keys(changed), state.branch.own, state.original !== null,
        state.branch.values.some((each, k) => each !== state.original.values[k]),
        document.querySelector('#dimensions .remark').textContent];
    }})()""")
    remark = (
        "Assembly modes are called by their letters in the file; with the changed dimensions they "
        "may have others."
    )
    assert shown == [["a", "b", "c", "d"], False, True, True, remark]


def test_an_empty_column_says_why(browser: Browser, tmp_path: Path) -> None:
    browser.open(mk.load(FILE_OF["planar_four_bar"]).view(tmp_path / "page.html", modes=False))
    browser.click("#tab-tables")
    tables = browser.evaluate("window.mechkin.state.tables.map(({ name }) => name)")
    browser.evaluate(f"""(() => {{
      const choice = document.querySelector('#tables select');
      choice.selectedIndex = {tables.index("rows")};
      choice.dispatchEvent(new Event('change'));
    }})()""")
    cells = """[...document.querySelectorAll('#tables th, #tables tr[data-at="0"] td')]
      .filter((_, k, all) => k % (all.length / 2) === 2)
      .map((cell) => [cell.textContent, cell.title])"""
    eventually(lambda: browser.evaluate(cells), [["mode", ""], ["B", ""]])
    browser.evaluate("window.mechkin.dimensions.set('a', 41)")
    why = (
        "empty with changed dimensions: only a search of all assembly modes tells the letter of one"
    )
    eventually(lambda: browser.evaluate(cells), [["mode", why], ["", why]])
    listed = "document.querySelector('#dimensions details:last-of-type').textContent"
    assert "mode of rows" in browser.evaluate(listed)
    assert "mechkin analyze planar_four_bar.yaml --set a=41" in browser.evaluate(listed)
    browser.evaluate("window.mechkin.dimensions.reset('a')")
    eventually(lambda: browser.evaluate(cells), [["mode", ""], ["B", ""]])


def test_curves_that_hardly_differ_are_drawn(browser: Browser, tmp_path: Path) -> None:
    """The block's speed in the tackle changes by less than 1e-9 of it."""
    text = (
        FILE_OF["tackle"]
        .read_text(encoding="utf-8")
        .replace("[300, 20], axis", "[300, 20.5361], axis")
    )
    browser.open(mk.loads(text).view(tmp_path / "page.html", modes=False))
    changed = browser.evaluate("""(async () => {
      const { dimensions, curves } = window.mechkin;
      dimensions.set('points.d.at.y', 0.00979684);
      for (let k = 0; k < 5; k += 1) await new Promise((done) => requestAnimationFrame(done));
      return [dimensions.changed, curves.plots.map(({ scales }) => scales.y.max > scales.y.min)];
    })()""")
    assert changed[0]
    assert set(changed[1]) == {True}
    assert browser.told()["said"] == []


@pytest.mark.parametrize(
    ("name", "words"),
    [
        (
            "rcsr_csr_loop_one",
            "They cannot be changed in this page: the file leaves loops out, and which ones "
            "depends on what is asked for. mechkin analyze rcsr_csr_loop_one.yaml --set NAME=VALUE "
            "computes it with others.",
        ),
        (
            "gear_play",
            "They cannot be changed in this page: something in it rebounds, by a restitution. Name "
            "the numbers under parameters: in the file, and set them by mechkin analyze "
            "gear_play.yaml --set NAME=VALUE",
        ),
    ],
)
def test_a_page_that_computes_nothing_says_why(
    browser: Browser, tmp_path: Path, name: str, words: str
) -> None:
    browser.open(mk.load(FILE_OF[name]).view(tmp_path / "page.html", modes=False))
    shown = "document.querySelector('#dimensions:not([hidden]) .remark')?.textContent"
    eventually(lambda: browser.evaluate(shown), words)


def test_a_run_that_does_not_follow_says_why_where_it_is_shown(
    browser: Browser, tmp_path: Path
) -> None:
    browser.open(driven().view(tmp_path / "page.html", modes=False))
    remark = "document.querySelector('#dimensions .remark').textContent"
    browser.evaluate("window.mechkin.dimensions.set('m', 0.8)")
    eventually(lambda: browser.evaluate("window.mechkin.dimensions.changed"), True)
    assert browser.evaluate(remark) == ""
    browser.evaluate("window.mechkin.setRun('run')")
    words = "This run is shown with the file's dimensions: laws of time drive coordinates in it."
    eventually(lambda: browser.evaluate(remark), words)
    browser.evaluate("window.mechkin.setRun('free')")
    eventually(lambda: browser.evaluate(remark), "")


def test_a_browser_that_refuses_the_solver_is_named(browser: Browser, tmp_path: Path) -> None:
    page = mk.load(FILE_OF["planar_four_bar"]).view(tmp_path / "page.html", modes=False)
    text = page.read_text(encoding="utf-8")
    spoiled, count = re.subn(r'(<script[^>]*id="mechkin-kernel"[^>]*>)[^<]*', r"\1AAAA", text)
    assert count == 1
    page.write_text(spoiled, encoding="utf-8")
    browser.open(page)
    words = "They cannot be changed in this page: this browser cannot run the solver"
    shown = "document.querySelector('#dimensions:not([hidden]) .remark')?.textContent"
    eventually(lambda: (browser.evaluate(shown) or "")[: len(words)], words)


LEVER = """
format: 1
plane: xy
units: {length: mm, angle: deg}
links: {arm: {}}
joints: {O: {type: R, links: [ground, arm], point: [0, 0]}}
points: {tip: {link: arm, at: [50, 0]}}
motion: {inputs: {tip.position.y: {from: -40, to: 60, step: 2}}}
tables: [{name: t, columns: [tip.position.y, O.theta]}]
view: {shapes: {arm: none}, paths: []}
"""


def test_a_point_that_is_driven_is_dragged_to_its_dead_centre(
    browser: Browser, tmp_path: Path
) -> None:
    page = mk.loads(LEVER).view(tmp_path / "page.html", modes=False)
    browser.open(page)
    browser.evaluate("""(() => { window.said = []; new MutationObserver(() =>
      window.said.push(document.querySelector('#said').textContent))
      .observe(document.querySelector('#said'), { childList: true }); })()""")

    def seen(degrees: float, radius: float = 50.0) -> list[float]:
        x, y = radius * np.cos(np.radians(degrees)), radius * np.sin(np.radians(degrees))
        found: list[float] = browser.evaluate(f"""(() => {{
          const {{ stage, mechanism }} = window.mechkin.theatre;
          const at = mechanism.now(0, [{x}, {y}, 0]).project(stage.camera);
          const box = stage.renderer.domElement.getBoundingClientRect();
          return [box.left + (1 + at.x) * box.width / 2, box.top + (1 - at.y) * box.height / 2];
        }})()""")
        return found

    first = float(np.degrees(np.arcsin(-0.8)))
    browser.drag([seen(first), seen(-10), seen(np.degrees(np.arcsin(0.4)), 60.0)])
    assert browser.evaluate("window.mechkin.row()") == 30, "where the tip is nearest, y = 20 mm"
    browser.drag([seen(np.degrees(np.arcsin(0.4))), seen(60), seen(80), seen(100), seen(120)])
    assert browser.evaluate("window.mechkin.row()") in (44, 45)
    said = browser.evaluate("window.said")
    assert any(text.startswith("dead centre at tip.position.y = 50 mm") for text in said), said


BELT = """
format: 1
plane: xy
units: {length: mm, angle: deg, force: N}
parameters: {d: 200 mm, r: 30 mm, q: 60 mm}
links: {small: {}, large: {}}
joints:
  A: {type: R, links: [ground, small], point: [0, 0]}
  B: {type: R, links: [ground, large], point: [d, 20]}
couplings: {K: {type: belt, joints: [A, B], radii: [r, q], crossed: false}}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 90}}}
tables: [{name: t, columns: [A.theta, B.theta]}]
"""


@pytest.mark.parametrize("crossed", ["false", "true"])
def test_a_belt_is_laid_anew_over_its_pulleys(
    browser: Browser, tmp_path: Path, crossed: str
) -> None:
    text = BELT.replace("crossed: false", f"crossed: {crossed}")
    browser.open(mk.loads(text).view(tmp_path / "page.html", modes=False))
    line = browser.evaluate("""(async () => {
      const { dimensions, state } = window.mechkin;
      dimensions.setAll({ d: 260, q: 45 });
      for (let k = 0; k < 4; k += 1) await new Promise((done) => requestAnimationFrame(done));
      return state.drawn.belts[0].line;
    })()""")
    other = text.replace("d: 200 mm", "d: 260 mm").replace("q: 60 mm", "q: 45 mm")
    data, _ = page_data([mk.loads(other).analyze()], modes=False)
    theirs = np.array(data["belts"][0]["line"])
    # both are polygons on the same line: corners lie within an arc's rise of the other's sides
    rise = 60.0 * (1.0 - np.cos(np.radians(6.0)))
    for one, ring in ((np.array(line), theirs), (theirs, np.array(line))):
        sides = np.roll(ring, -1, axis=0) - ring
        square = np.maximum(np.einsum("ij,ij->i", sides, sides), 1e-30)
        for corner in one:
            share = np.clip(np.einsum("ij,ij->i", corner - ring, sides) / square, 0.0, 1.0)
            off = np.linalg.norm(ring + share[:, None] * sides - corner, axis=1)
            assert off.min() < rise, corner
