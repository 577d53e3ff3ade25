"""Sweeps at rest against closed forms, equilibria row by row, and the same sweep driven."""

from __future__ import annotations

import re
from itertools import product
from math import radians, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import optimize

import mechkin_cli as mk
from mechkin_cli.kernel.functions import widths

G = 9.81

LEVER = Path("benchmarks/mechanisms/lever.yaml").read_text(encoding="utf-8")
MOTION = "motion: {inputs: {A.theta: {from: 0, to: 360, step: 5}}, rest: [E.theta]}\n"


def test_the_rows_at_rest_are_the_equilibria_of_held_rows() -> None:
    m = mk.loads(LEVER + MOTION)
    r = m.analyze()
    assert r["row.status"].tolist() == ["ok"] * 73
    assert r["A.theta"].tolist() == [5.0 * k for k in range(73)]
    for row in (3, 20, 41, 60):
        angle, near = r["A.theta"][row], r["E.theta"][row] + 3
        held = f"{{near: {{E.theta: {near}}}, driven: {{A.theta: {{at: {angle}}}}}}}"
        text = LEVER + f"equilibria: {{one: {held}}}\n"
        one = mk.loads(text).equilibrium("one")
        assert one["E.theta"][0] == pytest.approx(r["E.theta"][row], abs=1e-9)
        assert one["A.effort"][0] == pytest.approx(r["A.effort"][row], rel=1e-9, abs=1e-9)


def test_what_holds_the_input_is_the_slope_of_the_energy() -> None:
    r = mk.loads(LEVER + MOTION.replace("step: 5", "step: 0.5")).analyze()
    energy = r["row.potential_energy"]  # N*mm
    slope = (energy[:-4] - 8 * energy[1:-3] + 8 * energy[3:-1] - energy[4:]) / (12 * radians(0.5))
    assert r["A.effort"][2:-2] == pytest.approx(slope, abs=2e-5 * np.ptp(energy))


def test_the_driven_sweep_of_the_same_places_needs_no_effort() -> None:
    m = mk.loads(LEVER + MOTION)
    r = m.analyze()
    values = [float(value) for value in r["E.theta"]]
    inputs = f"{{A.theta: {{from: 0, to: 360, step: 5}}, E.theta: {{values: {values}}}}}"
    motion = f"motion: {{inputs: {inputs}}}\n"
    driven = mk.loads(LEVER + motion).analyze(["E.effort", "A.effort", "D.force"])
    assert np.abs(driven["E.effort"]).max() < 1e-9 * np.abs(driven["A.effort"]).max()
    assert driven["D.force"] == pytest.approx(r["D.force"], rel=1e-9, abs=1e-9)
    assert not r["E.theta_dot"].any()


def test_a_row_does_not_depend_on_the_rows_beside_it() -> None:
    fine = mk.loads(LEVER + MOTION).analyze()
    coarse = mk.loads(LEVER + MOTION.replace("step: 5", "step: 40")).analyze()
    assert coarse["E.theta"] == pytest.approx(fine["E.theta"][::8], abs=1e-9)


def test_lanes_and_threads_do_not_matter() -> None:
    m = mk.loads(LEVER + MOTION)
    one = m.analyze(lanes=2, threads=1)
    for lanes, threads in product(widths(), (1, 2)):
        other = m.analyze(lanes=lanes, threads=threads)
        for name in ("E.theta", "A.effort", "B.force"):
            assert one[name].tobytes() == other[name].tobytes()


BLOCK: dict[str, Any] = {
    "format": 1,
    "links": {"block": {"mass": 2, "center_of_mass": [0, 0, 0]}},
    "joints": {
        "S": {"type": "P", "links": ["ground", "block"], "point": [0, 0, 0], "axis": [0, 1, 0]}
    },
    "loads": [
        {"type": "gravity", "g": [0, -G, 0]},
        {"type": "spring", "joint": "S", "coordinate": "s", "stiffness": 400},
        {"type": "force", "joint": "S", "value": "1 N/s*time"},
    ],
}


def test_a_block_on_a_spring_goes_with_its_load() -> None:
    motion = {"time": {"from": 0, "to": 100, "step": 5}, "rest": ["S.s"]}
    r = mk.load(BLOCK | {"motion": motion}).analyze()
    assert r["S.s"] == pytest.approx((r["time"] - 2 * G) / 400, abs=1e-14)


def test_an_unstable_branch_is_followed_and_told() -> None:
    """The upright pendulum on a spring, beyond the load at which it forks."""
    standing = {
        "format": 1,
        "plane": "xy",
        "links": {"arm": {}},
        "joints": {"A": {"type": "R", "links": ["ground", "arm"], "point": [0, 0]}},
        "points": {"P": {"link": "arm", "at": [0, 0.1]}},
        "loads": [
            {"type": "spring", "joint": "A", "coordinate": "theta", "stiffness": 0.1},
            {"type": "force", "link": "arm", "point": "P", "force": [0, "-0.02 N/s*time"]},
        ],
        "motion": {"time": {"from": 0, "to": 98, "step": 7}, "rest": ["A.theta"]},
    }
    r = mk.load(standing).analyze()
    assert np.abs(r["A.theta"]).max() < 1e-9
    (note,) = (one for one in r.diagnostics if one.code == "unstable")
    assert "rows 9 to 15" in note.message
    # it forks where the load is stiffness by length: 0.1 N*m/rad over 0.1 m, after 50 s
    (fork,) = (one for one in r.diagnostics if one.code == "equilibria-cross")
    told = re.search(r"time = ([\d.]+) s", fork.measured or "")
    assert told is not None
    assert float(told[1]) == pytest.approx(50, rel=1e-6)
    # the branch beside it, down to where it meets the upright one
    standing["assembly"] = {"near": {"A.theta": 100}}
    standing["motion"] = {"time": {"from": 98, "to": 14, "step": -7}, "rest": ["A.theta"]}
    standing["motion"] = {"time": {"from": 56, "to": 98, "step": 7}, "rest": ["A.theta"]}
    r = mk.load(standing).analyze()
    for time, angle in zip(r["time"], np.radians(r["A.theta"]), strict=True):
        beside = optimize.brentq(lambda x, t=time: x - 0.02 * t * sin(x), 1e-2, 3.1)
        assert abs(angle) == pytest.approx(beside, abs=1e-9)


def test_no_equilibrium_in_the_first_row() -> None:
    falls = BLOCK | {"loads": BLOCK["loads"][:1]}
    motion = {"time": {"from": 0, "to": 10, "step": 5}, "rest": ["S.s"]}
    r = mk.load(falls | {"motion": motion}).analyze()
    assert set(r["row.status"]) == {"no-equilibrium"}
    assert "no-equilibrium" in [one.code for one in r.diagnostics]


@pytest.mark.parametrize(
    ("motion", "words"),
    [
        ("{inputs: {A.theta: {from: 0, to: 9, step: 1}}, rest: [A.theta]}", "cannot rest"),
        ("{inputs: {A.theta: {from: 0, to: 9, step: 1}}, rest: [X.theta]}", "not a coordinate"),
        ("{inputs: {A.theta: {from: 0, to: 9, step: 1}}, rest: [E.theta, E.theta]}", "twice"),
        ("{inputs: {A.theta: {from: 0, to: 9, step: 1}}, rest: [D.theta]}", "driven"),
    ],
)
def test_a_sweep_that_cannot_rest(motion: str, words: str) -> None:
    with pytest.raises(mk.InvalidFile, match=words):
        mk.loads(LEVER + f"motion: {motion}\n").analyze()


def test_what_does_not_take_a_sweep_at_rest_says_so() -> None:
    m = mk.loads(LEVER.replace("format: 1", "format: 1\nparameters: {k: 3}") + MOTION)
    r = m.analyze(errors=True)
    assert all(why for why in r.errors.why.values())


def test_blocks_of_a_stream_end_where_the_branch_does() -> None:
    text = Path("mechanisms/statics/toggle.yaml").read_text(encoding="utf-8")
    m = mk.loads(text.replace("to: 18", "to: 24"))
    whole = m.analyze()
    for rows in (3, 5, 100):
        blocks = list(m.stream(["A.theta", "row.status"], rows=rows))
        angles = np.concatenate([block["A.theta"] for block in blocks])
        assert angles.tobytes() == whole["A.theta"].tobytes()
        status = np.concatenate([block["row.status"] for block in blocks])
        assert status.tolist() == whole["row.status"].tolist()


def test_a_platform_on_six_springs() -> None:
    """Five of its legs rest while the sixth is driven: as where that one is held."""
    text = Path("mechanisms/classics/stewart.yaml").read_text(encoding="utf-8")
    head = text[: text.index("\nmotion:")] + "\nloads:\n  - {type: gravity, g: [0, 0, -9.81]}\n"
    for k in range(1, 7):
        head += f"  - {{type: spring, joint: L{k}, coordinate: s, stiffness: 20000}}\n"
    legs = [f"L{k}.s" for k in range(1, 6)]
    near = ", ".join(f"{leg}: 0" for leg in legs)
    held = f"equilibria: {{one: {{near: {{{near}}}, driven: {{L6.s: {{at: 0.04}}}}}}}}\n"
    rest = f"{{inputs: {{L6.s: {{from: 0, to: 0.1, step: 0.02}}}}, rest: [{', '.join(legs)}]}}"
    one = mk.loads(head + held).equilibrium("one")
    rows = mk.loads(head + f"motion: {rest}\n").analyze()
    for name in (*legs, "L6.effort"):
        assert rows[name][2] == pytest.approx(one[name][0], rel=1e-9)
    # with all six free, the legs alike, each pushes along itself
    free = ", ".join(f"L{k}.s: 0" for k in range(1, 7))
    r = mk.loads(head + f"equilibria: {{all: {{near: {{{free}}}}}}}\n").equilibrium("all")
    pushes = [-20000 * r[f"L{k}.s"][0] for k in range(1, 7)]
    assert pushes == pytest.approx([pushes[0]] * 6, rel=1e-9)
    lean = (r["B1.point.z"] - r["A1.point.z"]) / np.linalg.norm(r["B1.point"] - r["A1.point"])
    assert 6 * pushes[0] * lean[0] == pytest.approx(60 * G, rel=1e-9)


def test_actuators_do_not_go_with_what_rests() -> None:
    with pytest.raises(mk.InvalidFile, match="actuators"):
        mk.loads(LEVER + MOTION + "actuators: [A.theta, E.theta]\n")


@pytest.mark.parametrize("turn", [0, 360])
def test_an_equilibrium_far_from_where_near_starts_is_told_as_its_row_is(turn: int) -> None:
    """The spring holds the arm half a turn from where the search starts."""
    file = {
        "format": 1,
        "plane": "xy",
        "links": {"base": {}, "arm": {}},
        "joints": {
            "A": {"type": "R", "links": ["ground", "base"], "point": [0, 0]},
            "B": {"type": "R", "links": ["base", "arm"], "point": [1, 0]},
        },
        "loads": [
            {
                "type": "spring",
                "joint": "B",
                "coordinate": "theta",
                "stiffness": 1,
                "free": f"{turn + 200} deg",
            }
        ],
        "assembly": {"near": {"B.theta": turn + 20}},
        "motion": {"inputs": {"A.theta": {"from": 0, "to": 10, "count": 3}}, "rest": ["B.theta"]},
    }
    r = mk.load(file).analyze(["B.theta"])
    assert r["B.theta"] == pytest.approx(turn + 200, abs=1e-9)
    (note,) = (note for note in r.diagnostics if note.code == "nearest-far")
    assert "equilibrium" in note.message
    assert note.numbers[0].value == pytest.approx(r["B.theta"][0], abs=1e-9)
