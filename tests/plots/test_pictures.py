"""Pictures as data and as files: what stands against what, what is marked, the same bytes."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
import yaml
from references import FILE_OF, RCSR

import mechkin_cli as mk
from mechkin_cli.plots.curves import PlotCurve, curve_of, drawing, drawn, image, picture

FOUR_BAR = """\
format: 1
name: four-bar
units: {length: mm, angle: deg, force: N}
links: {crank: {mass: 0.4, center_of_mass: [20, 3, 0]}, rod: {}, rocker: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, rod], point: [40, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [rod, rocker], axis: [0, 0, 1],
      point: {rod: [130, 0, 0], rocker: [100, 80, 0]}}
  D: {type: R, links: [ground, rocker], point: [100, 0, 0], axis: [0, 0, 1]}
points: {tip: {link: rod, at: [80, 40, 0]}}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 10, rate: 30 rad/s}}}
tables:
  - {name: sizes, columns: [A.theta, A.effort, B.radial_force, D.theta, B.theta, row.status]}
  - {name: tip, plot: {x: x, y: ["y"]},
     columns: [A.theta, {label: x, value: tip.position.x}, {label: "y", value: tip.position.y}]}
"""


@pytest.fixture(scope="module")
def analysis() -> mk.Analysis:
    return mk.loads(FOUR_BAR).analyze()


@pytest.fixture(scope="module")
def ended() -> mk.Analysis:
    """The RCSR up to 210 degrees, whose branch ends at 205.14."""
    text = RCSR.read_text(encoding="utf-8").replace("to: 202,", "to: 210,")
    return mk.loads(text).analyze(["O4.theta", "O3.force"], tables=[])


def test_a_table_has_a_panel_for_each_unit(analysis):
    found = analysis.picture(table="sizes")
    assert [(p[0].unit, [c.label for c in p]) for p in found.panels] == [
        ("N*mm", ["A.effort"]),
        ("N", ["B.radial_force"]),
        ("deg", ["D.theta", "B.theta"]),
    ]
    (x,) = found.x
    assert (x.words, found.is_plane) == ("A.theta [deg]", False)
    np.testing.assert_array_equal(x.values, np.arange(0.0, 361.0, 10.0))
    np.testing.assert_array_equal(found.panels[0][0].values, analysis["A.effort"])


def test_the_plot_of_a_table_goes_before_that(analysis):
    found = analysis.picture(table="tip")
    assert found.is_plane
    np.testing.assert_array_equal(found.x[0].values, analysis["tip.position.x"])
    np.testing.assert_array_equal(found.panels[0][0].values, analysis["tip.position.y"])


def test_a_point_is_drawn_in_the_plane_of_its_curve(analysis):
    found = analysis.picture(["tip.position"])
    assert (found.x[0].words, found.panels[0][0].words) == (
        "tip.position.x [mm]",
        "tip.position.y [mm]",
    )
    (axes,) = drawn(found).axes
    assert axes.get_aspect() == 1.0
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("tip.position.x [mm]", "tip.position.y [mm]")


def test_named_expressions_are_drawn_by_their_names():
    named = mk.loads(FOUR_BAR + "quantities: {both: A.radial_force + B.radial_force}\n").analyze()
    (panel,) = named.picture(["both"]).panels
    assert panel[0].unit == "N"
    expected = named["A.radial_force"] + named["B.radial_force"]
    np.testing.assert_allclose(panel[0].values, expected, rtol=1e-15)


def test_a_vector_of_a_plane_has_two_components(analysis):
    places = analysis["tip.position"][:, :2]
    found = picture(drawing(analysis, "tip", [PlotCurve("tip.position", "mm", places)]))
    np.testing.assert_array_equal(found.x[0].values, places[:, 0])
    np.testing.assert_array_equal(found.panels[0][0].values, places[:, 1])


def test_forces_of_a_plane_linkage_have_a_polar_diagram_without_their_arbitrary_part(analysis):
    found = analysis.picture(["A.force", "B.force"])
    assert [c.label for c in found.x] == ["A.force.x", "B.force.x"]
    assert np.isfinite(found.panels[0][1].values).all()
    np.testing.assert_array_equal(found.x[1].values, analysis["B.force.x"])


def test_the_same_mechanism_turned_draws_the_same_curve(analysis):
    """About x by 90 degrees: y becomes z."""
    turned = (
        FOUR_BAR.replace("axis: [0, 0, 1]", "axis: [0, -1, 0]")
        .replace("[20, 3, 0]", "[20, 0, 3]")
        .replace("[100, 80, 0]", "[100, 0, 80]")
        .replace("[80, 40, 0]", "[80, 0, 40]")
    )
    other = mk.loads(turned).analyze(tables=[]).picture(["tip.position"])
    own = analysis.picture(["tip.position"])
    assert other.panels[0][0].label == "tip.position.z"
    for mine, its in zip((*own.x, *own.panels[0]), (*other.x, *other.panels[0]), strict=True):
        np.testing.assert_allclose(its.values, mine.values, rtol=0, atol=1e-12 * 100)


def test_a_dead_centre_and_the_rows_beyond_it_are_marked(ended):
    found = ended.picture(["O4.theta"])
    ((place, words),) = found.marks
    assert words.startswith("dead centre: O1.theta = 205.14")
    assert place == pytest.approx(205.143965945, abs=1e-8)
    assert np.isnan(found.panels[0][0].values[~found.solved]).all()
    assert not found.solved.all()
    (axes,) = drawn(found).axes
    legend = [text.get_text() for text in axes.get_legend().get_texts()]
    assert legend == [words, "no position"]
    assert [line.get_xdata()[0] for line in axes.lines[1:]] == [place]
    # in a plane, and over another column, it is the last row before it
    for other in (ended.picture(["O3.force"]), ended.picture(["O1.theta"], "O4.theta")):
        (axes,) = drawn(other).axes
        cross = next(line for line in axes.lines if line.get_marker() == "X")
        last = np.flatnonzero(other.solved)[-1]
        assert cross.get_xdata()[0] == other.x[0].values[last]


def test_rows_that_are_near_singular_are_marked():
    """A slide whose drive is the crank: at 90 degrees the coupler stands square to it."""
    result = mk.loads(FOUR_BAR).analyze(tables=[])
    result.result.row_states.status[4] = mk.Status.near_singular
    found = result.picture(["D.theta"])
    ((words, rows),) = found.doubtful
    assert (words, np.flatnonzero(rows).tolist()) == ("near-singular", [4])
    (axes,) = drawn(found).axes
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["near-singular"]
    hollow = axes.lines[1]
    assert hollow.get_xdata().tolist() == [40.0]


def test_every_doubtful_status_has_a_mark_of_its_own():
    result = mk.loads(FOUR_BAR).analyze(tables=[])
    doubtful = [
        s for s in mk.Status if s.has_solution and s not in {mk.Status.ok, mk.Status.dead_centre}
    ]
    result.result.row_states.status[: len(doubtful)] = doubtful
    (axes,) = drawn(result.picture(["D.theta"])).axes
    legend = axes.get_legend()
    assert [text.get_text() for text in legend.get_texts()] == [s.label for s in doubtful]
    assert len({line.get_marker() for line in axes.lines[1:]}) == len(doubtful)


def test_a_row_between_two_gaps_is_seen(analysis):
    (axes,) = drawn(analysis.picture(["sqrt(sin(3*A.theta) - 0.99)"])).axes
    # only 30, 150 and 270 degrees have a value
    assert axes.lines[1].get_xdata().tolist() == [30.0, 150.0, 270.0]


@pytest.mark.parametrize("ending", ["svg", "png", "pdf"])
def test_the_same_rows_give_the_same_bytes(analysis, ending):
    script = (
        "import sys, mechkin_cli as mk\n"
        "from mechkin_cli.plots.curves import image\n"
        "found = mk.loads(sys.argv[1]).analyze().picture(table='sizes')\n"
        "sys.stdout.buffer.write(image(found, sys.argv[2]))\n"
    )
    command = [sys.executable, "-P", "-c", script, FOUR_BAR, ending]
    there = subprocess.run(
        command, env={**os.environ, "PYTHONHASHSEED": "7"}, check=True, capture_output=True
    )
    here = image(analysis.picture(table="sizes"), ending)
    assert here == there.stdout
    assert len(here) > 1000


@pytest.mark.parametrize(
    ("y", "x", "words"),
    [
        (["row.status"], None, "is words, which cannot be drawn"),
        (["tip.position", "A.effort"], None, "drawn in a plane of its own, without A.effort"),
        (["tip.position"], "A.theta", "without A.theta"),
        (["tip.position", "A.force"], None, "N and mm do not go into one plane"),
        (["A.effort"], "tip.position", "tip.position is a vector"),
    ],
)
def test_what_cannot_be_drawn_says_why(analysis, y, x, words):
    with pytest.raises(mk.UsageError, match=words):
        analysis.picture(y, x)


def test_plot_gives_the_figure_and_writes_it(analysis, tmp_path):
    figure = analysis.plot("A.effort", to=tmp_path / "effort.png")
    assert figure.axes[0].get_ylabel() == "A.effort [N*mm]"
    assert (tmp_path / "effort.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(mk.UsageError, match=r"end in \.svg, \.png, \.pdf"):
        analysis.plot("A.effort", to=tmp_path / "effort.gif")


@pytest.mark.parametrize("ending", ["svg", "png", "pdf"])
@pytest.mark.parametrize(
    "text", ["costs $5 and $6", "$x_{$", "$", "$\\frac{1}$ $", "a_b^c \\alpha", "日本 ⚙ \u0950"]
)
def test_titles_and_labels_are_no_formulas(text, ending, recwarn):
    """Any text of a file stands in pictures as it is written, and nothing is said about fonts."""
    data = yaml.safe_load(FOUR_BAR)
    data["name"] = data["tables"][0]["title"] = text
    data["tables"][0]["columns"] = ["A.theta", {"label": text, "value": "D.theta"}]
    run = mk.load(data).analyze()
    for found in (run.picture(table="sizes"), run.picture(["tip.position"])):
        assert found.title == text
        assert len(image(found, ending)) > 1000
        titles = [axes.get_title() for axes in drawn(found).axes]
        assert titles[0].startswith(text)
    assert not [str(one.message) for one in recwarn.list]


@pytest.mark.parametrize("order", [1, -1])
def test_the_vector_is_named_as_the_vector(analysis, order):
    with pytest.raises(mk.UsageError, match=r"^tip\.position is a vector.* without A\.theta;"):
        analysis.picture(["A.theta", "tip.position"][::order])


def test_what_is_rounding_of_zero_is_drawn_as_zero() -> None:
    """A straight way does not tremble by 1e-14 mm over the whole height of its picture."""
    analysis = mk.load(FILE_OF["cardan_gears"]).analyze()
    assert np.abs(np.asarray(analysis["straight.position.y"])).max() > 0.0
    assert (curve_of(analysis, "straight_y").values == 0.0).all()
    assert curve_of(analysis, "straight_x").values[0] == pytest.approx(60.0)
