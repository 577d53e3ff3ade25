"""`view:` in a file: what it changes on the page, and how its mistakes are told."""

from __future__ import annotations

import numpy as np
import pytest
from view.files import FOUR_BAR
from view.seen import data, poses

import mechkin_cli as mk
from mechkin_cli.view.scene import page_data

VIEW = """
view:
  colours: {crank: "#C0392b", ground: "#000000"}
  hidden: [rocker]
  shapes:
    coupler: star
    crank: {kind: plate, points: [A, B, [0, 5, 0], [1 cm, 5, 0]]}
    ground: rod
  joint_radius: 2.5
  paths: []
  forces: hidden
  arrow_length: 4 cm
  camera: [0, -2, 0]
  speed: 0.1 min
"""


def test_everything_reaches_the_page() -> None:
    shown = data(mk.loads(FOUR_BAR + VIEW), modes=False)
    links = {one["name"]: one for one in shown["links"]}
    assert links["crank"]["colour"] == "#C0392b"
    assert links["coupler"]["colour"] is None
    assert [name for name, one in links.items() if one["hidden"]] == ["rocker"]
    assert links["coupler"]["shape"]["kind"] == "star"
    assert links["coupler"]["shape"]["centre"] == pytest.approx([50, 10, 0])
    assert links["crank"]["shape"]["points"] == [[0, 0, 0], [20, 0, 0], [0, 5, 0], [10, 5, 0]]
    rod = {"kind": "rod", "points": [[0, 0, 0], [70, 0, 0]], "radius": None}
    assert links["ground"]["shape"] == rod
    assert {one["radius"] for one in shown["joints"]} == {2.5}
    assert [one["path"] for one in shown["points"]] == [False]
    view = {"camera": [0, -1, 0], "speed": 6.0, "forces": False, "arrow_length": 40.0}
    assert shown["view"] == view


SIZED = FOUR_BAR.replace("point: [20, 0, 0]", "point: [r, 0, 0]").replace(
    "joints:", "parameters: {r: 20 mm, d: 3.5*r, h: 5 cm}\njoints:"
)
for old, new in (("[70, 0, 0]", "[d, 0, 0]"), ("[70, 50, 0]", "[d, h, 0]")):
    SIZED = SIZED.replace(old, new)


def test_sliders_go_as_far_as_the_file_says() -> None:
    model = mk.loads(SIZED + "view: {parameters: {r: [1 cm, 24]}}\n")
    shown, _ = page_data([model.analyze()], modes=False)
    ways = {one["name"]: (one["low"], one["high"]) for one in shown["live"]["parameters"]}
    assert ways == {"r": (10, 24), "h": (25, 100)}


PARTS = """
view:
  shapes:
    crank: {kind: wheel, radius: 12}
    coupler: {kind: cylinder, points: [B, [60, 0, 0]], radius: 0.4 cm}
    rocker: {kind: wheel, points: [[70, 50, 0]], axis: [0, 3, 4], radius: 8, width: 3}
  between:
    - {kind: cylinder, points: [p, post], radius: 2}
    - {kind: spring, points: [post, p]}
"""


def test_wheels_cylinders_and_springs_reach_the_page() -> None:
    text = FOUR_BAR.replace("points: {", "points: {post: {link: ground, at: [0, 90, 0]}, ")
    shown = data(mk.loads(text + PARTS), modes=False)
    shape = {one["name"]: one["shape"] for one in shown["links"]}
    wheel = {"kind": "wheel", "points": [[0, 0, 0]], "normal": [0, 0, 1], "radius": 12, "width": 3}
    assert shape["crank"] == wheel
    assert shape["rocker"]["normal"] == pytest.approx([0, 0.6, 0.8])
    assert (shape["rocker"]["radius"], shape["rocker"]["width"]) == (8, 3)
    tube = {"kind": "cylinder", "points": [[20, 0, 0], [60, 0, 0]], "radius": 4}
    assert shape["coupler"] == tube
    cylinder, spring = shown["runs"][0]["ties"]
    assert cylinder == {
        "kind": "cylinder",
        "joint": None,
        "turns": False,
        "links": [2, 0],
        "places": [[50, 30, 0], [0, 90, 0]],
        "radius": 2,
        "stroke": None,
    }
    assert (spring["kind"], spring["links"], spring["radius"]) == ("spring", [0, 2], None)


def test_a_wheel_of_a_plane_turns_about_its_normal() -> None:
    text = """
format: 1
plane: xy
units: {length: mm, angle: deg}
links: {wheel: {}}
joints: {A: {type: R, links: [ground, wheel], point: [5, 0]}}
motion: {inputs: {A.theta: {from: 0, to: 90, step: 10}}}
tables: [{name: t, columns: [A.theta]}]
view: {shapes: {wheel: {kind: wheel, radius: 4}}}
"""
    shape = data(mk.loads(text), modes=False)["links"][1]["shape"]
    assert (shape["points"], shape["normal"]) == ([[5, 0, 0]], [0, 0, 1])


def test_no_number_depends_on_it() -> None:
    plain, seen = mk.loads(FOUR_BAR), mk.loads(FOUR_BAR + VIEW)
    assert plain.analyze().tables[0].columns[1].values.tobytes() == (
        seen.analyze().tables[0].columns[1].values.tobytes()
    )
    np.testing.assert_array_equal(poses(data(plain)), poses(data(seen)))


def test_left_out_nothing_is_asked_for() -> None:
    shown = data(mk.loads(FOUR_BAR), modes=False)
    empty = {"camera": None, "speed": None, "forces": True, "arrow_length": None}
    assert shown["view"] == empty
    assert [one["path"] for one in shown["points"]] == [True]
    assert {one["radius"] for one in shown["joints"]} == {None}
    assert data(mk.loads(FOUR_BAR + "view: {}\n"), modes=False) == shown


def test_a_joint_that_rubs_has_its_radius() -> None:
    text = FOUR_BAR + "loads: [{type: friction, joint: B, coefficient: 0.1, radius: 3}]\n"
    shown = data(mk.loads(text), modes=False)
    assert {one["name"]: one["radius"] for one in shown["joints"]}["B"] == pytest.approx(3.0)


@pytest.mark.parametrize(
    ("view", "place", "words"),
    [
        ("{colours: {crnk: '#000000'}}", "crnk", "did you mean crank"),
        ("{colours: {crank: red}}", "red", "#rrggbb"),
        ("{hidden: [crank, crank]}", "crank", "named twice"),
        ("{hidden: [A]}", "A", "there is no link A"),
        ("{shapes: {crank: ball}}", "ball", "rod"),
        ("{shapes: {crank: {points: [A, p]}}}", "p", "joint or point of crank"),
        ("{shapes: {crank: {points: [A]}}}", "[A]", "2"),
        ("{shapes: {crank: {points: [A, [1, 2]]}}}", "[1, 2]", "3"),
        ("{shapes: {crank: wheel}}", "wheel", "add `radius:`"),
        ("{shapes: {crank: {kind: wheel, radius: 0}}}", "0", "above zero"),
        ("{shapes: {crank: {kind: wheel, radius: 2, points: [[0, 1, 0]]}}}", "{kind", "add `axis"),
        ("{shapes: {crank: {kind: rod, width: 2}}}", "2", "width belongs to kind: wheel"),
        ("{shapes: {crank: {kind: plate, radius: 2}}}", "2", "rod, cylinder or wheel"),
        ("{between: [{kind: spring, points: [p, q]}]}", "q", "there is no point q"),
        ("{between: [{kind: spring, points: [p]}]}", "[p]", "2"),
        ("{joint_radius: 0}", "0", "above zero"),
        ("{joint_radius: 3 deg}", "3 deg", "length"),
        ("{paths: [q]}", "q", "there is no point q"),
        ("{forces: maybe}", "maybe", "shown"),
        ("{camera: [0, 0, 0]}", "[0, 0, 0]", "zero"),
        ("{speed: -1}", "-1", "above zero"),
        ("{parameters: {r: [30, 10]}}", "[30, 10]", "smaller end first"),
        ("{parameters: {r: [30, 1 rad]}}", "1 rad", "length"),
        ("{parameters: {r: [30]}}", "[30]", "2"),
        ("{parameters: {R: [10, 30]}}", "R", "did you mean r"),
        ("{parameters: {d: [10, 50]}}", "d", "follows from r"),
        ("{colors: {crank: '#000000'}}", "colors", "colours"),
    ],
)
def test_mistakes_are_told_at_their_place(view: str, place: str, words: str) -> None:
    text = SIZED + f"view: {view}\n"
    with pytest.raises(mk.InvalidFile) as refused:
        mk.loads(text)
    (error,) = refused.value.diagnostics
    assert words in str(error)
    line = text.splitlines()[error.place.line - 1]
    assert line[error.place.column - 1 :].lstrip("'\"").startswith(place), str(error)
