"""Rows that are missing, marks of dead centres, branch points and events, and what is thinned."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from references import FILE_OF
from view.files import FOUR_BAR, SLIDER_CRANK
from view.seen import array, branch, column, data, moved, number_of, posed_rows, poses

import mechkin_cli as mk
from mechkin_cli.view.page import (
    MOST_CELLS,
    MOST_MODES,
    MOST_POSES,
    MOST_ROWS,
    ShownRun,
    script_json,
    shares,
    thinned,
    turning_points,
)
from mechkin_cli.view.scene import view_scene

ROCKING = (
    FOUR_BAR.replace("[20, 0, 0]", "[60, 0, 0]")
    .replace("[80, 0, 0]", "[120, 0, 0]")
    .replace("from: 0, to: 360, step: 10", "from: 20, to: 200, step: 5")
)
"""Crank 60, coupler 60, rocker 50, ground 70: the crank cannot go round."""
PARALLELOGRAM = FILE_OF["parallelogram"].read_text(encoding="utf-8")


def test_rows_beyond_a_dead_centre_have_no_pose_and_a_mark() -> None:
    shown = data(mk.loads(ROCKING))
    own = branch(shown)
    codes = array(own["status"]["codes"])
    words = own["status"]["words"]
    missing = codes == words.index("beyond-dead-centre")
    assert missing.any()
    np.testing.assert_array_equal(posed_rows(shown), np.flatnonzero(~missing))
    # B is as far from D as coupler and rocker are long: 70^2 + 60^2 - 2 70 60 cos = 110^2
    limit = np.degrees(np.arccos((70**2 + 60**2 - 110.0**2) / (2 * 70 * 60)))
    (mark,) = [one for one in own["marks"] if one["kind"] == "dead-centre"]
    assert mark["x"] == pytest.approx(limit, abs=1e-8)
    assert "A.theta" in mark["text"]
    assert np.isnan(column(shown, "p.position.x")[missing]).all()
    rows = next(one for one in shown["tables"] if one["name"] == "curve")["rows"]
    assert rows[-1][1:] == ["", "", ""]


def test_every_verdict_has_a_colour_by_what_its_rows_have() -> None:
    status = branch(data(mk.loads(ROCKING)))["status"]
    assert dict(zip(status["words"], status["doubts"], strict=True)) == {
        **dict.fromkeys(["near-singular", "rank-unclear", "dead-centre"], 1),
        **dict.fromkeys(["friction-undecided", "unsupported", "beyond-limit"], 1),
        **dict.fromkeys(["slack", "fleet-angle"], 1),
        **dict.fromkeys(["beyond-dead-centre", "branch-lost", "not-converged"], 2),
        **dict.fromkeys(["not-assembled", "singular-inertia", "step-limit"], 2),
        **dict.fromkeys(["no-equilibrium", "snapped-through"], 2),
        "ok": 0,
    }


def test_nothing_assembled_is_a_page_without_poses() -> None:
    far = FOUR_BAR.replace("point: [70, 0, 0]", "point: [700, 0, 0]")
    shown = data(mk.loads(far.replace("rocker: [70, 50, 0]", "rocker: [700, 50, 0]")))
    assert posed_rows(shown).size == 0
    assert {one["severity"] for one in shown["notes"]} >= {"error"}
    assert shown["size"] > 0


def test_branch_points_that_are_passed_are_marked_where_the_links_lie_in_line() -> None:
    head, _, _ = PARALLELOGRAM.partition("motion:")
    swept = f"""{head}motion: {{inputs: {{A.theta: {{from: 30, to: 390, step: 10}}}}}}
assembly: {{near: {{B.theta: -30, D.theta: 30}}, at_branch_points: straight}}
"""
    shown = data(mk.loads(swept), modes=False)
    marks = sorted(one["x"] for one in branch(shown)["marks"])
    assert marks == pytest.approx([180.0, 360.0], abs=1e-6)
    timed = swept.replace(
        "{inputs: {A.theta: {from: 30, to: 390, step: 10}}}",
        "{time: {from: 0, to: 1, count: 74}, inputs: {A.theta: {with: 30 deg + 360 deg/s*time}}}",
    )
    shown = data(mk.loads(timed), modes=False)
    assert shown["runs"][0]["x"] == {"label": "time", "unit": "s"}
    marks = sorted(one["x"] for one in branch(shown)["marks"])
    assert marks == pytest.approx([150 / 360, 330 / 360], abs=1e-6)


def test_events_of_a_response_are_marked_at_their_moment() -> None:
    text = SLIDER_CRANK.replace(
        "motion: {inputs: {A.theta: {from: 0, to: 360, step: 5, rate: 10 rad/s}}}",
        "responses: {fall: {start: {A.theta: 60}, time: {from: 0, to: 5, step: 0.01}, "
        "stop: [{value: A.theta, at: 0, direction: down}]}}",
    ).replace("assembly: {near: {D.s: 0}}\n", "")
    text = text.replace("links: {crank: {}", "links: {crank: {mass: 1, center_of_mass: [15, 0, 0]}")
    model = mk.loads(text)
    shown = data(model, modes=False)
    (run,) = shown["runs"]
    assert (run["kind"], run["x"]) == ("response", {"label": "time", "unit": "s"})
    analysis = model.respond()
    (mark,) = [one for one in branch(shown)["marks"] if one["kind"] == "event"]
    row = int(np.flatnonzero(analysis["row.event"] != "")[0])
    assert mark == {"x": analysis["time"][row], "kind": "event", "text": analysis["row.event"][row]}
    pose = poses(shown)[:, number_of(shown, "crank")]
    theta = np.radians(analysis["A.theta"])
    tip = np.stack([30 * np.cos(theta), 30 * np.sin(theta), 0 * theta], axis=1)
    assert np.abs(moved(pose, (30, 0, 0)) - tip[posed_rows(shown)]).max() <= 1e-6 * shown["size"]


def test_a_response_and_a_sweep_are_two_runs() -> None:
    text = (
        SLIDER_CRANK
        + "responses: {go: {start: {A.theta: 60}, time: {from: 0, to: 0.1, step: 0.01}}}\n"
    )
    text = text.replace("links: {crank: {}", "links: {crank: {mass: 1, center_of_mass: [15, 0, 0]}")
    shown = data(mk.loads(text), modes=False)
    assert [run["kind"] for run in shown["runs"]] == ["sweep", "response"]
    assert shown["up"] == pytest.approx([0.0, 1.0, 0.0])
    only = data(mk.loads(text), modes=False, run="go")
    assert [run["name"] for run in only["runs"]] == ["go"]


def test_twenty_thousand_rows_keep_curves_and_thin_poses() -> None:
    text = FOUR_BAR.replace("step: 10", "step: 0.018")
    model = mk.loads(text)
    scene, notes = view_scene(model.analyses())
    shown = scene.record()
    own = shown["runs"][0]["branches"][0]
    assert model.analyze().rows == 20001
    assert own["rows"] == MOST_ROWS
    posed = array(own["poses"]["rows"])
    assert posed.size == MOST_POSES
    assert (posed[0], posed[-1]) == (0, own["rows"] - 1)
    assert np.diff(posed).max() <= 12
    (note,) = notes
    assert note.code == "view-thinned"
    assert "20001 rows (limit 20000 in curves and tables, 2000 poses" in str(note)
    assert len(script_json(shown)) < 7_000_000


def test_many_columns_and_modes_share_a_page() -> None:
    """The RCSR's 92 columns in two modes, 20 001 rows: the cells of one branch, and as many of all
    other modes together."""
    text = FILE_OF["rcsr"].read_text(encoding="utf-8")
    model = mk.loads(text.replace("to: 202, step: 2", "to: 202, count: 20001"))
    scene, _ = view_scene(model.analyses())
    shown = scene.record()
    columns = sum(len(table.columns) for table in model.analyze().tables)
    for one in shown["runs"][0]["branches"]:
        assert one["rows"] == MOST_CELLS // columns
        assert array(one["poses"]["rows"]).size == MOST_POSES
    (table, *_) = shown["tables"]
    x = array(shown["runs"][0]["branches"][0]["x"])
    first = branch(shown)["columns"][0]
    assert (first["table"], first["label"]) == (table["name"], "theta1")
    assert array(first["values"]).tolist() == x.tolist()
    assert len(table["rows"]) == x.size
    assert len(script_json(shown)) < 22_000_000


def test_shares_of_many_modes_are_never_nothing() -> None:
    tables = (SimpleNamespace(columns=range(1000)),)
    branches = dict.fromkeys("ABCDEFGHIJKLMNOPQ", SimpleNamespace(tables=tables))
    found = shares(ShownRun("sweep", "", branches))
    assert found[0] == (400, MOST_POSES)
    assert set(found[1:]) == {(200, 500)}


def test_a_pose_is_kept_on_both_sides_of_what_happens() -> None:
    text = ROCKING.replace("from: 20, to: 200, step: 5", "from: 20, to: 200, step: 0.01")
    shown = data(mk.loads(text), modes=False)
    codes, posed = array(branch(shown)["status"]["codes"]), posed_rows(shown)
    last = int(np.flatnonzero(np.diff(codes))[0])
    assert posed[-1] == last
    assert posed.size <= MOST_POSES


def test_more_modes_than_a_page_holds_are_named_in_a_note(monkeypatch) -> None:
    monkeypatch.setattr("mechkin_cli.view.scene.MOST_MODES", 2)
    model = mk.load(FILE_OF["phchc"])
    scene, notes = view_scene(model.analyses())
    assert len(scene.runs[0].branches) == 3
    (note,) = notes
    left = model.modes().modes
    assert note.code == "view-modes-left-out"
    assert len(note.message.rpartition(": ")[2].split(", ")) == len(left) - 3
    assert str(note) in {str(one) for one in scene.notes}
    assert MOST_MODES > 2


def test_without_modes_none_are_looked_for(monkeypatch) -> None:
    monkeypatch.setattr("mechkin_cli.modes.find_modes", lambda *_, **__: pytest.fail("searched"))
    shown = data(mk.load(FILE_OF["rcsr"]), modes=False)
    assert len(shown["runs"][0]["branches"]) == 1


@pytest.mark.parametrize("stem", ["rcsr", "rcsr_response", "stewart"])
def test_modes_are_all_there_is_and_each_once(stem: str) -> None:
    model = mk.load(FILE_OF[stem])
    found = model.modes()
    shown = data(model)
    names = [one["name"] for one in shown["runs"][0]["branches"]]
    assert names[0] == f"mode {found.picked}"
    assert sorted(names) == sorted(f"mode {one.name}" for one in found.modes)


def test_a_mode_asked_for_is_the_own_one() -> None:
    model = mk.load(FILE_OF["rcsr"])
    scene, _ = view_scene(model.analyses(mode="A"))
    assert list(scene.runs[0].branches) == ["mode A", "mode B"]


def test_loops_that_are_not_followed_are_hidden() -> None:
    shown = data(mk.load(FILE_OF["rcsr_csr_loop_one"]))
    assert [one["name"] for one in shown["links"] if one["hidden"]] == ["arm", "output"]
    assert any("left out" in one["text"] for one in shown["notes"])


@pytest.mark.parametrize("rows", [0, 1, 2, 5, 100, 1001])
@pytest.mark.parametrize("most", [2, 3, 7, 50])
def test_thinning_keeps_the_ends_and_what_must_not_be_missed(rows: int, most: int) -> None:
    rng = np.random.default_rng(rows * 100 + most)
    numbers = np.flatnonzero(rng.random(rows * 2) < 0.5)
    keep = rng.choice(numbers, min(numbers.size, most // 2), replace=False) if numbers.size else []
    found = thinned(numbers, most, keep)
    assert found.size <= most
    assert set(found) <= set(numbers)
    if numbers.size:
        assert (found[0], found[-1]) == (numbers[0], numbers[-1])
    assert set(sorted(keep)[: (most - 2) // 2]) <= set(found)
    if numbers.size <= most:
        assert found.tolist() == numbers.tolist()


def test_turning_points_are_the_rows_beside_a_change() -> None:
    assert turning_points([]).tolist() == []
    assert turning_points([1]).tolist() == []
    assert turning_points([1, 1, 0, 1]).tolist() == [1, 2, 3]
