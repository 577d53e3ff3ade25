"""The page in a real browser: what is drawn is the data."""

from __future__ import annotations

import numpy as np
import pytest
from view.page_data import (
    TYPES,
    FourBar,
    about_z,
    at_rest,
    branch,
    four_bar,
    half,
    joint,
    link,
    one_of_every_type,
    packed,
    page_data,
    rod,
    slider,
)
from view.watching import CURVES, SINGLE, Show, colours, moved, pose, row


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
    for number in range(1, 4):
        browser.evaluate(f"window.mechkin.theatre.setLinkVisible({number}, false)")
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


def test_all_modes_are_compared(show: Show) -> None:
    data = four_bar()
    branches = data["runs"][0]["branches"]
    branches += [{**branches[1], "name": f"mode {k}"} for k in range(3, 14)]
    browser = show(data)
    browser.press("c")
    assert browser.evaluate("window.mechkin.theatre.ghosts.length") == 12
    assert browser.evaluate("document.querySelector('#curves .remark').textContent").endswith(
        "mode 13"
    )


def test_values_of_many_arrows_are_written_or_counted(show: Show) -> None:
    data = four_bar()
    for one in data["runs"][0]["branches"]:
        arrow = one["arrows"][0]
        one["arrows"] = [{**arrow, "name": f"A{k}.force"} for k in range(30)]
    browser = show(data)
    browser.press("f")
    browser.evaluate("window.mechkin.theatre.stage.draw()")
    written = browser.evaluate("document.querySelectorAll('.name.force:not([hidden])').length")
    told = browser.evaluate("document.querySelector('#no-room').textContent")
    assert written > 0
    assert told.startswith(f"{30 - written} of 30 values have no room")


@pytest.mark.parametrize("width", [390, 1280])
def test_nothing_that_is_read_lies_under_tools_or_legend(show: Show, width: int) -> None:
    data = four_bar()
    data["view"]["camera"] = [0, 0, 1]
    for one in data["runs"][0]["branches"]:
        arrow = one["arrows"][0]
        one["arrows"] = [{**arrow, "name": f"A{k}.force"} for k in range(40)]
    browser = show(data, width=width)
    browser.press("f")
    for at in (0, 18, 36):
        browser.evaluate(f"window.mechkin.seek({at})")
        browser.evaluate("window.mechkin.theatre.stage.draw()")
        browser.evaluate("window.mechkin.theatre.stage.draw()")
        boxes = """[...document.querySelectorAll('SELECTOR')].map((each) => {
          const { left, top, right, bottom } = each.getBoundingClientRect();
          return [left, top, right, bottom];
        })"""
        read = browser.evaluate(boxes.replace("SELECTOR", ".name:not([hidden]), #no-room"))
        over = browser.evaluate(boxes.replace("SELECTOR", "#tools > *, #legend > *"))
        assert len(read) > 3
        for a in read:
            for b in over:
                apart = a[2] <= b[0] + 1 or b[2] <= a[0] + 1 or a[3] <= b[1] + 1 or b[3] <= a[1] + 1
                assert apart, (at, a, b)


def test_rounding_is_read_as_zero(show: Show) -> None:
    data = four_bar()
    own = data["runs"][0]["branches"][0]
    values = 100.0 * np.sin(np.radians(np.arange(0, 361, 5)))
    own["columns"] = [{**own["columns"][0], "values": packed("f64", values)}]
    browser = show(data)
    browser.evaluate("window.mechkin.seek(36)")  # 100 sin(pi) is 1.2e-14
    assert "psi 0 deg" in browser.evaluate("document.querySelector('#curves').innerText")
    browser.evaluate("window.mechkin.seek(6)")
    assert "psi 50 deg" in browser.evaluate("document.querySelector('#curves').innerText")


def test_a_column_of_rounding_alone_is_a_line_at_zero(show: Show) -> None:
    data = four_bar()
    own = data["runs"][0]["branches"][0]
    values = 1e-14 * np.sin(np.radians(np.arange(0, 361, 5)))
    column = {**own["columns"][0], "rounding": 1e-12, "values": packed("f64", values)}
    own["columns"] = [column]
    browser = show(data)
    browser.evaluate("window.mechkin.seek(6)")
    assert "psi 0 deg" in browser.evaluate("document.querySelector('#curves').innerText")
    labels = browser.evaluate("window.mechkin.curves.plots[0].data[1].every((each) => each === 0)")
    assert labels is True


def test_a_path_through_few_rows_of_a_circle_is_round(show: Show) -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 11)
    circle = 20.0 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    poses = about_z(angle, np.array([20.0, 0, 0]), circle)
    data = page_data(
        "circle",
        [link("ground"), link("arm", rod([0, 0, 0], [20, 0, 0]))],
        [joint("A", "R", (0, 1), half([0, 0, 0]))],
        [branch("own", np.degrees(angle), np.stack([at_rest(11), poses], axis=1))],
        size=40.0,
        centre=[0.0, 0.0, 0.0],
        points=[{"name": "tip", "link": 1, "place": [20, 0, 0], "path": True}],
    )
    browser = show(data)
    drawn = np.array(
        browser.evaluate(
            "[...window.mechkin.theatre.paths.object.children.find((each) => each.isLine)"
            ".geometry.attributes.position.array]"
        )
    ).reshape(-1, 3)
    assert len(drawn) > 60
    np.testing.assert_allclose(np.hypot(drawn[:, 0], drawn[:, 1]), 20.0, rtol=2e-5)
    between = 0.5 * (drawn[1:] + drawn[:-1])
    assert np.hypot(between[:, 0], between[:, 1]).min() > 0.998 * 20.0


def test_a_spring_ends_at_its_points(show: Show) -> None:
    data = four_bar()
    tie = {"joint": None, "turns": False, "links": [0, 1], "radius": None, "stroke": None}
    tie["places"] = [[0, 50, 0], [30, 0, 0]]
    kinds = ("spring", "damper", "cylinder")
    data["runs"][0]["ties"] = [{**tie, "kind": kind} for kind in kinds]
    browser = show(data)
    bar = FourBar(np.radians([90.0]))
    browser.evaluate("window.mechkin.seek(18)")
    for k in range(3):
        ends = browser.evaluate(f"""(() => {{
          const {{ group, coil, rod, least }} = window.mechkin.theatre.ties.all[{k}];
          group.updateMatrixWorld(true);
          const end = coil ? coil.scale.z * least : rod.position.z + rod.scale.z;
          const place = (z) => group.position.clone().set(0, 0, z);
          const at = (z) => place(z).applyMatrix4(group.matrixWorld).toArray();
          return [at(0), at(end)];
        }})()""")
        np.testing.assert_allclose(ends, [[0, 50, 0], bar.crank[0]], atol=SINGLE * 300)


def test_a_piston_stays_in_its_tube(show: Show) -> None:
    data = four_bar()
    tie = {"joint": None, "turns": False, "links": [0, 1], "places": [[0, 50, 0], [30, 0, 0]]}
    data["runs"][0]["ties"] = [{**tie, "kind": k, "radius": None} for k in ("damper", "cylinder")]
    browser = show(data)
    for at in range(0, 37, 6):
        browser.evaluate(f"window.mechkin.seek({at})")
        for k in (0, 1):
            start, piston, end, rod = browser.evaluate(f"""(() => {{
              const {{ cup, piston, rod }} = window.mechkin.theatre.ties.all[{k}];
              return [cup[0], piston.position.z, cup[1], rod.position.z + rod.scale.z];
            }})()""")
            assert start < piston < end < rod


@pytest.mark.parametrize("kind", ["spring", "damper"])
def test_what_is_about_a_pin_turns_with_it(show: Show, kind: str) -> None:
    data = four_bar()
    tie = {"kind": kind, "joint": 0, "turns": True, "links": [0, 1], "places": [], "radius": None}
    tie["stroke"] = None
    data["runs"][0]["ties"] = [tie]
    browser = show(data)
    for at in (0, 3, 9, 15):
        browser.evaluate(f"window.mechkin.seek({at})")
        found = browser.evaluate("window.mechkin.theatre.ties.all[0].angle")
        assert found == pytest.approx(np.radians(5.0 * at), abs=1e-5)
