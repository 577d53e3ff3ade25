"""Whole files that once were answered wrong, lost or in silence, each against what is right."""

from __future__ import annotations

import subprocess
import sys
from math import acos, cos, degrees, hypot, pi, radians, sin, sqrt
from pathlib import Path

import numpy as np
import pytest
from random_families.rubbing_loops import judge

import mechkin_cli as mk

HERE = Path(__file__).parent


def _load(name: str) -> mk.Model:
    return mk.load(HERE / name)


FALL = sqrt(0.8)
"""When what falls from 5 m with g = 10 passes 1 m."""

STOPS = {
    "plain": FALL,
    "iff": FALL,
    "iff1": FALL,
    "cond": FALL,
    "andd": FALL,
    "window": FALL,
    "kink": FALL,
    "flo": sqrt(2 * (5 - 3) / 10),  # the floor falls to 2 where s passes 3
    "flo25": sqrt(2 * (5 - 3) / 10),
    "sgn": 1.0,
    "kink2": sqrt(2 * (5 - 1.001) / 10),
    "kink3": sqrt(2 * (5 - 1.0000001) / 10),
}


@pytest.mark.parametrize("name", STOPS)
def test_stops_at_jumps(name: str) -> None:
    rows = _load("stops_that_jump.yaml").respond(name, tables=[])
    end = STOPS[name]
    assert rows["row.status"][-1] == "ok"
    assert rows["time"][-1] == pytest.approx(end, abs=1e-9)
    assert rows["P.s"][-1] == pytest.approx(5 - 5 * end * end, abs=1e-8)


def test_an_arm_with_friction_in_all_its_joints_moves_on() -> None:
    found = judge((HERE / "friction_hangs.json").read_text(encoding="utf-8"))
    assert (found.word, found.fault) == ("ok", "")
    assert found.error < 1e-9


def test_ten_parallelograms_pass_where_all_lie_flat() -> None:
    rows = _load("ten_parallelograms.yaml").analyze()
    assert set(rows["row.status"]) == {"ok"}
    last = rows.tables["t"].columns[-1]
    assert np.abs(np.asarray(last.values) - rows["A0.theta"]).max() < 1e-12


@pytest.mark.parametrize("name", ["table_on_four_legs.yaml", "table_moved.yaml"])
def test_a_table_on_four_legs_keeps_parallel(name: str) -> None:
    rows = _load(name).analyze(["c.position"])
    assert set(rows["row.status"]) == {"ok"}
    x, y, z = rows["c.position"].T
    assert np.abs(z + np.sqrt(1 - x * x - y * y)).max() < 1e-14
    assert _load(name).mobility().fixed == ()


def test_a_touched_dead_centre_is_left_on_the_same_branch() -> None:
    rows = _load("touched_dead_centre.yaml").analyze()
    # the crank of 3 is drawn upright, the rod of 5 ends at (4 + s, 0)
    right = [degrees(acos((9 + (4 + s) ** 2 - 25) / (6 * (4 + s)))) - 90 for s in (0, 2, 4, 2, 0)]
    assert np.abs(rows["O.theta"] - np.array(right)).max() < 1e-6
    assert [d.code for d in rows.diagnostics if d.severity == "error"] == []


def test_rates_that_are_not_given_are_told() -> None:
    model = _load("no_rate.yaml")
    assert "no-rate" in [d.code for d in model.analyze().diagnostics]


def test_the_transmission_angle_of_a_plane_four_bar() -> None:
    rows = _load("transmission_angle.yaml").analyze()
    rod, rocker = hypot(80, 90), hypot(10, 90)
    for theta, angle in zip(rows["A.theta"], rows["D.theta.transmission_angle"], strict=True):
        x, y = 40 * cos(radians(theta)), 40 * sin(radians(theta))
        base = hypot(110 - x, y)
        inside = degrees(acos((rod**2 + rocker**2 - base**2) / (2 * rod * rocker)))
        assert min(inside, 180 - inside) == pytest.approx(min(angle, 180 - angle), abs=1e-9)


def test_one_mistake_in_the_inputs_is_one_error() -> None:
    with pytest.raises(mk.InvalidFile) as refused:
        _load("inputs_of_two_lengths.yaml")
    assert len(refused.value.diagnostics) == 1
    assert "equally many rows" in refused.value.diagnostics[0].message


def test_no_response_leaves_a_tie_out() -> None:
    with pytest.raises(mk.InvalidFile, match=r"B.theta is tied to A.theta under motion:"):
        _load("geared_shafts.yaml")


def test_a_tie_to_what_is_not_driven_says_what_to_do() -> None:
    with pytest.raises(mk.InvalidFile, match="drive it, too; there are no other inputs"):
        _load("gears_spun_up.yaml")


@pytest.mark.parametrize(
    ("one", "other", "form"),
    [
        ("A.theta", "S.s", "{K: {type: rack, joints: [A, S], radius: ...}}"),
        ("S.s", "A.theta", "{K: {type: rack, joints: [A, S], radius: ...}}"),
        ("S.s", "T.s", "{K: {type: linear, terms: {S.s: ..., T.s: ...}}}"),
    ],
)
def test_a_tie_is_answered_by_the_coupling_to_write(one: str, other: str, form: str) -> None:
    scale = {"A": "1 rad", "S": "1 m", "T": "1 m"}
    text = f"""
format: 1
plane: xy
units: {{length: m, angle: rad}}
links: {{a: {{}}, s: {{}}, t: {{}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0]}}
  S: {{type: P, links: [ground, s], point: [0, 1], axis: [1, 0]}}
  T: {{type: P, links: [ground, t], point: [0, 2], axis: [1, 0]}}
motion:
  inputs:
    {one}: {{from: 0, to: 1, count: 3}}
    {other}: {{with: "{one}*({scale[other[0]]})/({scale[one[0]]})", drive: tie}}
    FREE: {{at: 0}}
tables: [{{name: t, columns: [{other[0]}.force.x]}}]
"""
    free = {"A", "S", "T"}.difference((one[0], other[0])).pop()
    text = text.replace("FREE", f"{free}.{'theta' if free == 'A' else 's'}")
    with pytest.raises(mk.InvalidFile) as told:
        mk.loads(text)
    assert f"take {other} out of inputs: and write couplings: {form}" in str(told.value)


def test_what_transmits_a_tie_is_not_left_out_of_bearings() -> None:
    """100 N at the rim of the wheel are 100 N in both bearings; a tie alone does not say so."""
    text = (HERE / "spur_pair.yaml").read_text()
    form = r"take B.theta out of inputs: and write couplings: \{K: \{type: gear, joints: \[A, B\]"
    with pytest.raises(mk.InvalidFile, match=rf"what transmits that is not said.*{form}"):
        mk.loads(text)
    rubbing = "loads: [{type: friction, joint: A, coefficient: 0.1, radius: 2}, {type: torque"
    columns = "columns: [A.theta, A.effort, norm(A.force), norm(B.force)]"
    alone = text.replace(columns, "columns: [A.effort]")
    assert mk.loads(alone).analyze()["A.effort"] == pytest.approx(-2000.0)
    with pytest.raises(mk.ExpressionError, match="what transmits that is not said"):
        mk.loads(alone).analyze()["B.radial_force"]
    with pytest.raises(mk.InvalidFile, match=f"how that loads A is not said; {form}"):
        mk.loads(alone.replace("loads: [{type: torque", rubbing))
    own = text.replace("drive: tie", "drive: own")
    assert mk.loads(own).analyze()["norm(B.force)"] == pytest.approx(0.0)
    for angle, force in (("0", 100.0), ("20 deg", 100.0 / cos(radians(20)))):
        gear = text.replace("    B.theta: {with: -A.theta/2, drive: tie}\n", "")
        gear += (
            f"couplings: {{G: {{type: gear, joints: [A, B], teeth: [20, 40], "
            f"pressure_angle: {angle}}}}}\n"
        )
        result = mk.loads(gear).analyze()
        for joint in ("A", "B"):
            assert result[f"norm({joint}.force)"] == pytest.approx(force, rel=1e-12)


def test_a_rack_in_a_loop_is_a_coupling() -> None:
    text = (HERE / "rack_in_a_loop.yaml").read_text()
    with pytest.raises(mk.InvalidFile, match=r"a gear or rack between S.s and P.theta"):
        mk.loads(text)
    text = text.replace("    P.theta: {with: S.s/20, drive: tie}\n", "")
    result = mk.loads(
        text + "couplings: {K: {type: rack, joints: [P, S], radius: 20 mm}}\n"
    ).analyze()
    assert set(result["row.status"]) == {"ok"}
    # its pitch line goes through S, below the pinion: it turns as S slides
    assert result["P.theta"] == pytest.approx(result["S.s"] / 20 * 180 / pi, abs=1e-12)


def test_shafts_of_a_response_are_coupled() -> None:
    """The tie's right form, under couplings."""
    text = (HERE / "geared_shafts.yaml").read_text()
    text = text.replace(
        "motion: {inputs: {A.theta: {at: 0}, B.theta: {with: -2*A.theta, drive: tie}}}", ""
    )
    text += "couplings: {K: {type: linear, terms: {A.theta: 2, B.theta: 1}}}\n"
    with pytest.raises(mk.InvalidFile, match=r"leave out B.theta|B.theta follows"):
        mk.loads(text).respond("r")
    text = text.replace("A.theta: 0, B.theta: 0", "A.theta: 0")
    assert mk.loads(text).respond("r")["A.theta"][-1] == pytest.approx(0.25, rel=1e-9)


def test_a_freedom_left_undriven_in_space_is_the_one_error() -> None:
    """Five parallel axes: three constraints are redundant, and one freedom is not driven."""
    places = {"A": [0, 0, 0], "B": [0, 1, 0], "C": [1, 2, 0], "D": [2, 1, 0], "E": [2, 0, 0]}
    links = ["ground", "a", "b", "c", "d", "ground"]
    joints = {
        name: {"type": "R", "links": links[k : k + 2], "point": place, "axis": [0, 0, 1]}
        for k, (name, place) in enumerate(places.items())
    }
    file = {
        "format": 1,
        "units": {"length": "m", "angle": "deg"},
        "links": {link: {} for link in "abcd"},
        "joints": joints,
        "motion": {"inputs": {"A.theta": {"from": 0, "to": 140, "step": 10}}},
    }
    found = mk.load(file).analyze().diagnostics
    assert [d.code for d in found if d.severity != "note"] == ["undriven-freedom"]


def test_the_drawn_mode_and_its_letter_are_one() -> None:
    model = _load("transmission_angle.yaml")
    drawn = model.analyze()
    for mode in ("home", "B"):
        assert np.abs(model.analyze(mode=mode)["D.theta"] - drawn["D.theta"]).max() < 1e-12
    with pytest.raises(mk.UsageError, match="there is no mode Z at the first row: modes A, B"):
        model.analyze(mode="Z")


def test_one_folder_holds_one_run(tmp_path: Path) -> None:
    command = [sys.executable, "-P", "-m", "mechkin_cli", "analyze", HERE / "quick_return.yaml"]
    own = tmp_path / "notes.txt"
    own.write_text("mine", encoding="utf-8")
    for more in ([], ["--set", "r=70 mm", "--format", "tex"]):
        subprocess.run([*command, "--out", tmp_path, "--quiet", *more], check=True)
    shown = {path.name for path in tmp_path.iterdir() if not path.name.startswith(".")}
    assert shown == {"drive.tex", "rows.csv", "notes.txt"}
    assert own.read_text(encoding="utf-8") == "mine"
