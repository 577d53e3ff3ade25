"""Play between flanks: two wheels by closed forms of momentum and free flight, their bearings by
the momentum of both bodies, a geared linkage by the dense equations of all bodies."""

from __future__ import annotations

import random
from dataclasses import dataclass
from itertools import pairwise
from math import sqrt, tan
from typing import Any

import numpy as np
import pytest
import yaml
from couplings.dense import Dense, State

import mechkin_cli as mk
from mechkin_cli.balances.newton_euler import dense_system
from mechkin_cli.building.tables import unknown_names
from mechkin_cli.kernel.functions import widths
from mechkin_cli.response import Impact, ResponseResult

R1, R2, I1, I2, BACKLASH = 0.1, 0.2, 0.02, 0.03, 0.002
PAIR = """
format: 1
units: {length: m, angle: rad, mass: kg, force: N}
links:
  one: {mass: 1, center_of_mass: [0, 0, 0], inertia: {xx: 0.01, yy: 0.01, zz: 0.02}}
  two: {mass: 2, center_of_mass: [0.3, 0, 0], inertia: {xx: 0.02, yy: 0.02, zz: 0.03}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [ground, two], point: [0.3, 0, 0], axis: [0, 0, 1]}
"""
GEAR = "{type: gear, joints: [A, B], teeth: [20, 40], pressure_angle: 20 deg, backlash: 2 mm"


def pair(coupling: str, run: str, joints: str = PAIR) -> mk.Analysis:
    """The response of two wheels."""
    model = mk.loads(f"{joints}couplings: {{K: {coupling}}}\nresponses: {{run: {run}}}\n")
    return model.respond("run")


def impacts_of(rows: mk.Analysis) -> tuple[Impact, ...]:
    """The impacts of a response."""
    result = rows.result
    assert isinstance(result, ResponseResult)
    return result.impacts


def cells_of(rows: mk.Analysis) -> dict[str, np.ndarray]:
    """The columns of the table of impacts, but for events."""
    told = rows.impacts
    assert told is not None
    return {column.label: np.asarray(column.values) for column in told.columns}


@dataclass
class Flight:
    """Two masses on the pitch circle, the first under a force, from an impact on: its moment, the
    speeds of both behind it and what the first had given."""

    at: float
    first: float
    second: float
    impulse: float


def flights(force: float, one: float, two: float, room: float, e: float) -> list[Flight]:
    """The impacts of a mass that a force drives against another, both at rest in the middle of
    some room, by the conservation of momentum and Newton's restitution."""
    acceleration = force / one
    at = sqrt(2.0 * (0.5 * room) / acceleration)
    first, second = acceleration * at, 0.0
    found = []
    for _ in range(40):
        closing = first - second
        impulse = (1.0 + e) * closing * one * two / (one + two)
        first, second = first - impulse / one, second + impulse / two
        found.append(Flight(at, first, second, impulse))
        back = 2.0 * e * closing / acceleration
        at, first = at + back, first + acceleration * back
    return found


@pytest.mark.parametrize("e", [0.4, 0.8])
def test_wheels_spun_up_meet_and_rebound_as_masses_on_the_pitch_circle(e: float) -> None:
    run = (
        "{start: {A.theta: 0, B.theta: 0}, efforts: {A.theta: 1}, "
        "time: {from: 0, to: 0.25, step: 0.004}}"
    )
    rows = pair(f"{GEAR}, restitution: {e}}}", run)
    one, two, force = I1 / R1**2, I2 / R2**2, 1.0 / R1
    expected = flights(force, one, two, BACKLASH, e)
    met = impacts_of(rows)
    assert len(met) > 8
    for number, (impact, flight) in enumerate(zip(met[:5], expected, strict=False)):
        # how far flanks part again becomes less by e^2, and their place is known to 1e-12
        near = 1e-10 / e ** (2 * number)
        assert impact.time == pytest.approx(flight.at, rel=near)
        assert impact.impulses[0] == pytest.approx(flight.impulse, rel=near)
    time = rows["time"]
    for before, after in pairwise(expected[:6]):
        between = (time > before.at + 1e-9) & (time < after.at - 1e-9)
        since = time[between] - before.at
        speed = before.first + force / one * since
        np.testing.assert_allclose(rows["A.theta_dot"][between], speed / R1, rtol=1e-9)
        np.testing.assert_allclose(rows["B.theta_dot"][between], -before.second / R2, rtol=1e-9)
        relative = before.first - before.second
        play = 0.5 * BACKLASH + relative * since + 0.5 * force / one * since**2
        np.testing.assert_allclose(rows["K.play"][between], play, atol=1e-13)
        rate = relative + force / one * since
        np.testing.assert_allclose(rows["K.play_dot"][between], rate, atol=1e-10)
        np.testing.assert_allclose(rows["K.torque"][between], 0.0, atol=1e-14)
    # at last both turn as one gear: all the momentum that the force has given
    speed = force * time / (one + two)
    rest = time > met[-1].time
    assert rest.any()
    assert met[-1].rests
    np.testing.assert_allclose(rows["A.theta_dot"][rest], speed[rest] / R1, rtol=1e-10)
    np.testing.assert_allclose(rows["B.theta_dot"][rest], -speed[rest] / R2, rtol=1e-10)
    np.testing.assert_allclose(rows["K.play"][rest], 0.5 * BACKLASH, atol=1e-10)
    transmitted = force * two / (one + two)
    np.testing.assert_allclose(rows["K.torque"][rest], -transmitted * R1, rtol=1e-12)
    teeth = transmitted * np.array([tan(np.radians(20.0)), 1.0, 0.0])
    np.testing.assert_allclose(rows["K.tooth_force"][rest], teeth + 0.0 * time[rest][:, None])
    np.testing.assert_allclose(rows["A.force"][rest], rows["K.tooth_force"][rest], atol=1e-12)
    assert np.nanmax(rows["row.energy_error"]) < 1e-12
    assert set(rows["row.status"]) == {"ok"}


def test_flanks_without_restitution_stay_together_at_once() -> None:
    run = (
        "{start: {A.theta: 0, B.theta: 0}, efforts: {A.theta: 1}, "
        "time: {from: 0, to: 0.1, step: 0.01}}"
    )
    rows = pair(f"{GEAR}}}", run)
    (impact,) = impacts_of(rows)
    assert impact.rests
    one, two, force = I1 / R1**2, I2 / R2**2, 1.0 / R1
    assert impact.time == pytest.approx(sqrt(BACKLASH * one / force), rel=1e-12)
    after = rows["time"] > impact.time
    speed = force * rows["time"][after] / (one + two)
    np.testing.assert_allclose(rows["A.theta_dot"][after], speed / R1, rtol=1e-12)


def test_flanks_lose_where_they_bear_alone() -> None:
    """The second wheel's inertia by its efficiency at the first; in flight nothing is lost, and no
    efficiency is told."""
    run = (
        "{start: {A.theta: 0, B.theta: 0}, efforts: {A.theta: 1}, "
        "time: {from: 0, to: 0.1, step: 0.005}}"
    )
    rows = pair(f"{GEAR}, restitution: 0.4, efficiency: 0.9}}", run)
    time, rest = rows["time"], impacts_of(rows)[-1].time
    turning = 1.0 / (I1 + I2 * (R1 / R2) ** 2 / 0.9)
    np.testing.assert_allclose(rows["A.theta_ddot"][time > rest], turning, rtol=1e-11)
    np.testing.assert_allclose(rows["K.efficiency"][time > rest], 0.9, rtol=1e-12)
    assert np.isnan(rows["K.efficiency"][time < rest]).all()
    flown = time < 0.02
    np.testing.assert_allclose(rows["row.dissipated"][flown], 0.0, atol=1e-15)
    assert np.nanmax(rows["row.energy_error"]) < 1e-12


def test_a_reversed_moment_crosses_the_play() -> None:
    """The moment 1 - 10 t reverses at 0.1 s: the flank lets go there, the second wheel goes on as
    it is, and the first one crosses by the third power of time."""
    run = (
        "{start: {A.theta: 0, K.play: 0.001}, efforts: {A.theta: 1 N*m - 10 N*m*time/(1 s)}, "
        "time: {from: 0, to: 0.24, step: 0.005}}"
    )
    rows = pair(f"{GEAR}, restitution: 0.3}}", run)
    one, two, time = I1 / R1**2, I2 / R2**2, rows["time"]
    touching = time < 0.1 - 1e-9
    np.testing.assert_allclose(rows["K.play"][touching], 0.001, atol=1e-15)
    gained = (time - 5.0 * time**2) / R1 / (one + two)
    np.testing.assert_allclose(rows["B.theta_dot"][touching], -gained[touching] / R2, atol=1e-12)
    np.testing.assert_allclose(
        rows["K.torque"][touching], -(1.0 - 10.0 * time[touching]) * two / (one + two), atol=1e-12
    )
    across = 0.1 + (6.0 * BACKLASH * one * R1 / 10.0) ** (1.0 / 3.0)
    met = [impact for impact in impacts_of(rows) if impact.rates[0] > 1e-6]
    assert met[0].time == pytest.approx(across, rel=1e-7)
    assert met[0].limits[0].name == "K.play"
    free = (time > 0.1 + 1e-9) & (time < across - 1e-9)
    since = time[free] - 0.1
    play = 0.001 - 10.0 / R1 / one * since**3 / 6.0
    np.testing.assert_allclose(rows["K.play"][free], play, atol=1e-12)
    np.testing.assert_allclose(rows["B.theta_dot"][free], -0.05 / R1 / (one + two) / R2, rtol=1e-10)
    rate = 5.0 / R1 / one * (across - 0.1) ** 2
    assert met[0].rates[0] == pytest.approx(rate, rel=1e-6)
    impulse = 1.3 * rate * one * two / (one + two)
    assert met[0].impulses[0] == pytest.approx(impulse, rel=1e-6)
    # the other flank pushes the other way
    cells = cells_of(rows)
    row = int(np.argmin(np.abs(cells["time"] - across)))
    np.testing.assert_allclose(cells["K.tooth_impulse.y"][row], -impulse, rtol=1e-6)
    assert cells["K.tooth_impulse.x"][row] > 0.0
    assert np.nanmax(rows["row.energy_error"]) < 1e-9


def sweep(coupling: str, inputs: str) -> mk.Analysis:
    """Rows of two wheels whose inputs are swept."""
    text = f"{PAIR}couplings: {{K: {coupling}}}\nmotion: {{inputs: {inputs}}}\n"
    return mk.loads(text).analyze()


def test_a_sweep_stands_in_the_middle_of_the_play() -> None:
    moved = "{A.theta: {from: 0, to: 1, step: 0.1, rate: 1, acceleration: 2}}"
    rows = sweep(f"{GEAR}}}", moved)
    np.testing.assert_allclose(rows["B.theta"], -0.5 * rows["A.theta"], atol=1e-15)
    np.testing.assert_allclose(rows["A.effort"], 2.0 * (I1 + I2 / 4.0), rtol=1e-13)
    assert [d.code for d in rows.diagnostics] == ["mid-play"]


def test_without_a_sweep_the_play_is_a_freedom() -> None:
    run = "{start: {A.theta: 0, B.theta: 0}, time: {from: 0, to: 0.1, step: 0.01}}"
    coupled = [GEAR, GEAR.replace(", backlash: 2 mm", "")]
    runs = [run, run.replace(", B.theta: 0", "")]
    found = [
        mk.loads(f"{PAIR}couplings: {{K: {k}}}}}\nresponses: {{run: {r}}}\n").mobility().mobility
        for k, r in zip(coupled, runs, strict=True)
    ]
    assert found == [2, 1]


def test_a_sweep_whose_play_is_an_input_stands_on_a_flank() -> None:
    moved = "{A.theta: {from: 0, to: 1, step: 0.1, rate: 1, acceleration: 2}, K.play: {at: 1 mm}}"
    rows = sweep(f"{GEAR}}}", moved)
    np.testing.assert_allclose(rows["B.theta"], -(R1 * rows["A.theta"] - 0.001) / R2, atol=1e-15)
    np.testing.assert_allclose(rows["A.effort"], 2.0 * (I1 + I2 / 4.0), rtol=1e-13)
    # what pushes the play, which the second wheel's acceleration asks for
    np.testing.assert_allclose(rows["K.play.effort"], -I2 * 1.0 / R2, rtol=1e-12)
    np.testing.assert_allclose(rows["K.tooth_force.y"], I2 * 1.0 / R2, rtol=1e-12)
    assert set(rows["row.status"]) == {"ok"}


def test_wheels_that_are_both_inputs_go_as_far_as_their_play() -> None:
    moved = (
        "{A.theta: {from: 0, to: 0.02, step: 0.005, rate: 1, acceleration: 2}, B.theta: {at: 0}}"
    )
    rows = sweep(f"{GEAR}}}", moved)
    np.testing.assert_allclose(rows["K.play"], [0.0, 0.0005, 0.001, 0.0015, 0.002], atol=1e-17)
    assert list(rows["row.status"]) == ["ok", "ok", "ok", "beyond-limit", "beyond-limit"]
    np.testing.assert_allclose(rows["K.torque"], 0.0, atol=1e-17)
    np.testing.assert_allclose(rows["A.effort"], 2.0 * I1, rtol=1e-13)


@pytest.mark.parametrize(
    ("coupling", "code", "words"),
    [
        (f"{GEAR.replace('2 mm', '0')}}}", "no-backlash", "leave it out"),
        (f"{GEAR.replace('2 mm', '2 kg')}}}", "expression", "length"),
        (f"{GEAR}, restitution: 2}}", "no-restitution", "part of the rate"),
        ("{type: gear, joints: [A, B], teeth: [2, 4], restitution: 1}", "missing-key", "backlash"),
        (
            "{type: gear, joints: [A, B], teeth: [2, 4], ideal: true, backlash: 1 mm}",
            "no-radii",
            "backlash: 0.1 deg",
        ),
        (
            "{type: chain, joints: [A, B], teeth: [17, 20], pitch: 12.7 mm, pretension: 9, "
            "backlash: 1 mm}",
            "tight-chain",
            "leave out pretension",
        ),
        ("{type: gear, joints: [A, B], teeth: [2, 4], play: 1 mm}", "unknown-key", "backlash"),
        ("{type: gear, joints: [A, B], teeth: [2, 4], clearance: 1}", "unknown-key", "backlash"),
        ("{type: belt, joints: [A, B], radii: [0.1, 0.1], backlash: 1}", "unknown-key", "no play"),
        ("{type: linear, terms: {A.theta: 1, B.theta: 2}, slack: 1}", "unknown-key", "backlash"),
    ],
)
def test_play_that_is_none_is_refused_with_the_form_that_runs(
    coupling: str, code: str, words: str
) -> None:
    with pytest.raises(mk.InvalidFile) as refused:
        sweep(coupling, "{A.theta: {at: 0}}")
    (found,) = refused.value.diagnostics
    assert found.code == code
    assert words in f"{found.message} {found.hint}"
    assert found.place is not None


PLANE = """
format: 1
plane: xy
units: {units}
links:
  one: {{mass: 1 kg, center_of_mass: [0 m, 0 m], inertia: 0.02 kg*m^2}}
  two: {{mass: 2 kg, center_of_mass: [0.3 m, 0 m], inertia: 0.03 kg*m^2}}
joints:
  A: {{type: R, links: [ground, one], point: [0 m, 0 m]}}
  B: {{type: R, links: [ground, two], point: [0.3 m, 0 m]}}
"""


@pytest.mark.parametrize(
    ("coupling", "play", "per_first"),
    [
        ("{type: gear, joints: [A, B], teeth: [20, 40], backlash: 2", "K.play", R1),
        ("{type: gear, joints: [A, B], teeth: [20, 40], backlash: 2 deg", "K.lash", 1.0),
        (
            "{type: gear, joints: [A, B], teeth: [20, 40], ideal: true, backlash: 2 deg",
            "K.lash",
            1.0,
        ),
        ("{type: linear, terms: {A.theta: 3, B.theta: 6}, backlash: 2", "K.lash", 1.0),
        (
            "{type: chain, joints: [A, B], teeth: [11, 22], pitch: 12 mm, backlash: 2",
            "K.play",
            0.132 / (2.0 * np.pi),
        ),
    ],
)
def test_play_is_measured_as_it_is_written(coupling: str, play: str, per_first: float) -> None:
    """In millimetres and degrees, where a bare number is a length, of a sum of turns an angle."""
    run = (
        "{start: {A.theta: 0, B.theta: 0}, efforts: {A.theta: 1 N*m}, "
        "time: {from: 0, to: 0.5, step: 0.01}}"
    )
    units = PLANE.format(units="{length: mm, angle: deg, mass: kg, force: N}")
    rows = pair(f"{coupling}, restitution: 0.5}}", run, units)
    turn = np.radians(rows["A.theta"])
    other = np.radians(rows["B.theta"]) * (-2.0 if "chain" in coupling else 2.0)
    unit = 1e-3 if play == "K.play" else np.pi / 180.0
    np.testing.assert_allclose(rows[play] * unit, per_first * (turn + other), atol=1e-12)
    assert rows[play].max() == pytest.approx(1.0, rel=1e-7)
    # one mass against the other, as on the pitch circle, by moments and turns of the first wheel
    force, one, two = 1.0 / per_first, I1 / per_first**2, 0.25 * I2 / per_first**2
    flight = flights(force, one, two, 2.0 * unit, 0.5)[0]
    (impact, *_) = impacts_of(rows)
    assert impact.time == pytest.approx(flight.at, rel=1e-9)
    assert impact.impulses[0] == pytest.approx(flight.impulse, rel=1e-9)


SLIDES = """
format: 1
units: {length: m, angle: rad, mass: kg, force: N}
links:
  one: {mass: 1, center_of_mass: [0, 0, 0], inertia: {xx: 0.01, yy: 0.01, zz: 0.02}}
  bar: {mass: 2, center_of_mass: [0, -0.1, 0]}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  S: {type: P, links: [ground, bar], point: [0, -0.1, 0], axis: AXIS}
"""


@pytest.mark.parametrize(
    ("coupling", "axis", "per_turn", "way"),
    [
        ("{type: rack, joints: [A, S], radius: 0.1", "[1, 0, 0]", 0.1, 1.0),
        ("{type: screw, joints: [A, S], lead: 0.02", "[0, 0, 1]", 0.01 / np.pi, -1.0),
        ("{type: screw, joints: [A, S], lead: -0.02", "[0, 0, 1]", 0.01 / np.pi, 1.0),
    ],
)
def test_racks_and_nuts_have_play_along_their_slide(
    coupling: str, axis: str, per_turn: float, way: float
) -> None:
    run = (
        "{start: {A.theta: 0, S.s: 0}, efforts: {A.theta: 1}, time: {from: 0, to: 0.3, step: 0.01}}"
    )
    rows = pair(f"{coupling}, backlash: 2 mm, restitution: 0}}", run, SLIDES.replace("AXIS", axis))
    play = per_turn * rows["A.theta"] - way * rows["S.s"]
    np.testing.assert_allclose(rows["K.play"], play, atol=1e-14)
    one, force = I1 / per_turn**2, 1.0 / per_turn
    at = sqrt(0.002 * one / force)
    (impact,) = impacts_of(rows)
    assert impact.time == pytest.approx(at, rel=1e-9)
    after = rows["time"] > at + 1e-9
    speed = force * rows["time"][after] / (one + 2.0)
    np.testing.assert_allclose(rows["S.s_dot"][after], way * speed, rtol=1e-10)
    np.testing.assert_allclose(rows["K.force"][after], way * 2.0 * force / (one + 2.0), rtol=1e-10)


OFF_CENTRE = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  one: {mass: 1, center_of_mass: [0.02, -0.03], inertia: 0.02}
  two: {mass: 2, center_of_mass: [0.33, 0.05], inertia: 0.03}
joints:
  A: {type: R, links: [ground, one], point: [0, 0]}
  B: {type: R, links: [ground, two], point: [0.3, 0]}
"""


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_bearings_of_a_pair_take_the_momentum_of_both_wheels(side: float) -> None:
    """Six momenta, five conditions: both bearings and the teeth, whose force leans away from either
    axis by the pressure angle whichever flank bears."""
    run = (
        f"{{start: {{A.theta: 0, B.theta: 0, A.theta_dot: {2.0 * side}}}, "
        "time: {from: 0, to: 0.03, step: 0.001}}"
    )
    rows = pair(f"{GEAR}, restitution: 0.4}}", run, OFF_CENTRE)
    (impact, *_) = impacts_of(rows)
    assert impact.time == pytest.approx(0.001 / (R1 * 2.0), rel=1e-12)
    turn = side * 0.001 / R1
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    arms = rotation @ [0.02, -0.03], np.array([0.03, 0.05])
    mass = np.diag([1.0, 1.0, 0.02, 2.0, 2.0, 0.03])
    jacobian = np.zeros((5, 6))  # of bearings, and of what flanks part by
    for k, (x, y) in enumerate(arms):
        jacobian[2 * k, 3 * k : 3 * k + 3] = 1.0, 0.0, y
        jacobian[2 * k + 1, 3 * k : 3 * k + 3] = 0.0, 1.0, -x
    pitch = np.array([0.1, 0.0])
    lean = side * tan(np.radians(20.0))
    act = jacobian.T.copy()
    for k, (arm, sign, axis) in enumerate(zip(arms, (-1.0, 1.0), (0.0, 0.3), strict=True)):
        lever = pitch - [axis, 0.0] - arm
        force = sign * np.array([lean, 1.0])  # on this wheel per unit along the second one's way
        act[3 * k : 3 * k + 3, 4] = [*force, lever[0] * force[1] - lever[1] * force[0]]
    jacobian[4, [2, 5]] = R1, R2
    x, y = arms[0]
    before = np.array([-2.0 * side * y, 2.0 * side * x, 2.0 * side, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(jacobian[:4] @ before, 0.0, atol=1e-15)
    system = np.block([[mass, -act], [jacobian, np.zeros((5, 5))]])
    right = np.concatenate([mass @ before, np.zeros(4), [-0.4 * 0.2 * side]])
    solved = np.linalg.solve(system, right)
    cells = cells_of(rows)
    found = [cells[f"{joint}.impulse.{axis}"][0] for joint in "AB" for axis in "xy"]
    np.testing.assert_allclose(found, solved[6:10], rtol=1e-10)
    teeth = [cells[f"K.tooth_impulse.{axis}"][0] for axis in "xy"]
    np.testing.assert_allclose(teeth, solved[10] * np.array([lean, 1.0]), rtol=1e-10)
    np.testing.assert_allclose(impact.impulses[0], abs(solved[10]), rtol=1e-10)
    np.testing.assert_allclose(cells["K.play.impulse"][0], -solved[10], rtol=1e-10)
    after = (rows["time"] > impact.time) & (rows["time"] < impact.time + 0.002)
    np.testing.assert_allclose(rows["A.theta_dot"][after], solved[2], rtol=1e-10)
    np.testing.assert_allclose(rows["B.theta_dot"][after], solved[5], rtol=1e-10)


LINKAGE = {
    "plane": "xy",
    "links": {
        "motor": {"mass": 1.0, "center_of_mass": [-0.29, 0.02], "inertia": 0.02},
        "crank": {"mass": 1.0, "center_of_mass": [0.05, 0.1], "inertia": 0.02},
        "rod": {"mass": 2.0, "center_of_mass": [0.7, 0.8], "inertia": 0.3},
        "rocker": {"mass": 1.5, "center_of_mass": [1.25, 0.5], "inertia": 0.15},
    },
    "joints": {
        "M": {"type": "R", "links": ["ground", "motor"], "point": [-0.3, 0.0]},
        "A": {"type": "R", "links": ["ground", "crank"], "point": [0.0, 0.0]},
        "B": {"type": "R", "links": ["crank", "rod"], "point": [0.2, 0.4]},
        "C": {"type": "R", "links": ["rod", "rocker"], "point": [1.2, 1.0]},
        "D": {"type": "R", "links": ["ground", "rocker"], "point": [1.3, 0.0]},
    },
    "loads": [{"type": "gravity", "g": [0.0, -9.81]}],
}
TOOTHED = {"K": {"type": "gear", "joints": ["M", "A"], "teeth": [20, 40], "pressure_angle": 0.35}}
"""A wheel drives the crank of a four-bar."""
LASHED = {"K": {**TOOTHED["K"], "backlash": 0.002, "restitution": 0}}
UNITS = {"length": "m", "angle": "rad", "mass": "kg", "force": "N"}


def struck(whole: Dense, state: State, e: float) -> tuple[State, dict[str, np.ndarray]]:
    """The state behind an impact of the flanks; what teeth give, as K, and what joints do, forces
    and moments about the origin."""
    conditions, owners = whole.conditions(state)
    keep = whole.kept
    jacobian = np.array([c.by for c in conditions])[:, keep]
    mass, _ = whole.applied(state, {})
    mesh = whole.teeth("K", state)
    assert mesh is not None
    one, other, at, along, away = mesh
    act = np.array([c.by for c in conditions]).T
    row = owners.index("K")
    # flanks part by what the force along them works on
    flank = whole.pushed(other, along, at, state) + whole.pushed(one, -along, at, state)
    jacobian[row] = flank[keep]
    rate = float(flank @ state.rates)
    assert rate == pytest.approx(float(conditions[row].rate), rel=1e-9, abs=1e-12)
    # the flank of the impact: the multiplier is the moment on the first wheel, against its turn
    side = -np.sign(rate)
    force = along + side * away
    act[:, row] = whole.pushed(other, force, at, state) + whole.pushed(one, -force, at, state)
    count, size = len(conditions), len(keep)
    matrix = np.zeros((size + count, size + count))
    matrix[:size, :size] = mass[np.ix_(keep, keep)]
    matrix[:size, size:] = -act[keep]
    matrix[size:, :size] = jacobian
    right = np.concatenate([mass[np.ix_(keep, keep)] @ state.rates[keep], np.zeros(count)])
    right[size + row] = -e * rate
    solved = np.linalg.solve(matrix, right)
    rates = np.zeros(whole.width)
    rates[keep] = solved[:size]
    given = {"K": solved[size + row] * force}
    for number, owner in enumerate(owners):
        if owner != "K":
            wrench = solved[size + number] * whole.wrench(owner, act[:, number], state)
            given[owner] = given.get(owner, np.zeros(6)) + wrench
    return State(state.centres, state.turns, rates, state.angles), given


@pytest.mark.parametrize("e", [0.0, 0.5])
def test_a_gear_with_play_in_a_linkage_is_that_of_all_its_bodies(e: float) -> None:
    """Flight, impact, and flight again or contact up to where the flanks would pull, each by the
    dense equations without the teeth or with them."""
    loose, whole = Dense(LINKAGE), Dense({**LINKAGE, "couplings": TOOTHED})
    efforts = {"M.theta": 3.0}

    def play(state: State) -> float:
        return float(0.1 * (state.angles["M"] + 2.0 * state.angles["A"]))

    def beyond(state: State) -> float:
        return abs(play(state)) - 0.001

    times = np.linspace(0.0, 0.1, 11).tolist()
    start = loose.with_rates(loose.at_home(), {"M.theta": 0.0, "A.theta": 0.0})
    *flown, met = loose.followed(start, efforts, times, beyond)
    at = loose.ended
    assert at is not None
    after, given = struck(whole, met, e)
    written = yaml.safe_dump({"format": 1, "units": UNITS, **LINKAGE, "couplings": LASHED})
    written = written.replace("restitution: 0", f"restitution: {e}")
    later = np.linspace(at, at + 0.05, 11).tolist()
    text = (
        f"{written}\nresponses: {{run: {{start: {{M.theta: 0, A.theta: 0}}, "
        f"efforts: {{M.theta: 3}}, time: {{values: {[*times[: len(flown)], *later[1:]]}}}}}}}\n"
    )
    rows = mk.loads(text).respond("run")
    impact = impacts_of(rows)[0]
    assert impact.time == pytest.approx(at, rel=1e-9)
    cells = cells_of(rows)
    for name in ("K.tooth_impulse", "A.impulse", "C.impulse"):
        told = [cells[f"{name}.{axis}"][0] for axis in "xy"]
        np.testing.assert_allclose(told, given[name[0]][:2], rtol=1e-8)
    names = ["M.theta", "A.theta", "B.theta", "D.theta"]
    solver = loose if e > 0.0 else whole
    going = solver.followed(after, efforts, later, beyond if e > 0.0 else None)
    expected = [loose.solved(s, efforts) for s in flown]
    expected += [solver.solved(s, efforts) for s in going[1:11]]
    reached = len(expected)
    assert reached >= len(flown) + 3
    for row, solved in enumerate(expected[: reached - (e > 0.0)]):
        for name in names:
            value, rate, acceleration = solved.coordinates[name]
            assert rows[name][row] == pytest.approx(value, abs=1e-9)
            assert rows[f"{name}_dot"][row] == pytest.approx(rate, abs=1e-8)
            assert rows[f"{name}_ddot"][row] == pytest.approx(acceleration, rel=1e-7, abs=1e-6)
        np.testing.assert_allclose(
            rows["A.force"][row], solved.wrenches["A"][:2], rtol=1e-7, atol=1e-6
        )
        if e == 0.0 and row >= len(flown):
            np.testing.assert_allclose(rows["K.tooth_force"][row], solved.teeth["K"][:2], rtol=1e-7)
    assert np.nanmax(rows["row.energy_error"]) < 1e-10


HELICAL = {
    "links": {
        "one": {
            "mass": 1.0,
            "center_of_mass": [0.02, -0.03, 0.01],
            "inertia": {"xx": 0.01, "yy": 0.015, "zz": 0.02},
        },
        "two": {
            "mass": 2.0,
            "center_of_mass": [0.33, 0.05, -0.02],
            "inertia": {"xx": 0.02, "yy": 0.025, "zz": 0.03},
        },
    },
    "joints": {
        "A": {"type": "R", "links": ["ground", "one"], "point": [0, 0, 0], "axis": [0, 0, 1]},
        "B": {"type": "C", "links": ["ground", "two"], "point": [0.3, 0, 0], "axis": [0, 0, -1]},
    },
}


@pytest.mark.parametrize("rate", [2.0, -2.0])
def test_helical_teeth_strike_along_their_flank(rate: float) -> None:
    """A wheel that may slide along its axis is thrown along it, too."""
    gear: dict[str, Any] = {"type": "gear", "joints": ["A", "B"], "teeth": [20, 40]}
    gear |= {"pressure_angle": 0.35, "helix": 0.3}
    loose, whole = Dense(HELICAL), Dense({**HELICAL, "couplings": {"K": gear}})
    # the flanks of a pinion with r = 0.1 meet after half of 2 mm
    turn = np.sign(rate) * 0.001 / R1
    place = loose.closed(loose.at_home(), {"A.theta": turn, "B.theta": 0.0, "B.s": 0.0})
    met = loose.with_rates(place, {"A.theta": rate, "B.theta": 0.0, "B.s": 0.0})
    after, given = struck(whole, met, 0.4)
    lashed = {**gear, "backlash": 0.002, "restitution": 0.4}
    text = yaml.safe_dump({"format": 1, "units": UNITS, **HELICAL, "couplings": {"K": lashed}})
    run = (
        f"responses: {{run: {{start: {{A.theta: 0, B.theta: 0, B.s: 0, A.theta_dot: {rate}}}, "
        "time: {from: 0, to: 0.006, step: 0.001}}}\n"
    )
    rows = mk.loads(text + run).respond("run")
    (impact,) = impacts_of(rows)
    assert impact.time == pytest.approx(0.005, rel=1e-12)
    cells = cells_of(rows)
    teeth = [cells[f"K.tooth_impulse.{axis}"][0] for axis in "xyz"]
    np.testing.assert_allclose(teeth, given["K"], rtol=1e-9)
    for joint in "AB":
        impulse = np.array([cells[f"{joint}.impulse.{axis}"][0] for axis in "xyz"])
        np.testing.assert_allclose(impulse, given[joint][:3], rtol=1e-9, atol=1e-12)
        angular = [cells[f"{joint}.angular_impulse.{axis}"][0] for axis in "xyz"]
        moment = angular + np.cross(rows[f"{joint}.point"][5], impulse)
        np.testing.assert_allclose(moment, given[joint][3:], rtol=1e-8, atol=1e-10)
    for name in ("A.theta", "B.theta", "B.s"):
        rate_after = whole.coordinate(name, after).rate
        assert rows[f"{name}_dot"][-1] == pytest.approx(float(rate_after), rel=1e-9)


def swinging(rng: random.Random) -> dict[str, Any]:
    """Two wheels, one of which may be a ring, on an arm that swings about another axis."""

    def body(x: float) -> dict[str, Any]:
        centre = [x + rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05)]
        inertia = {axis: rng.uniform(0.02, 0.04) for axis in ("xx", "yy", "zz")}
        return {"mass": rng.uniform(0.5, 3.0), "center_of_mass": centre, "inertia": inertia}

    ends, axis = rng.choice([["arm", "two"], ["two", "arm"]]), rng.choice([1, -1])
    gear: dict[str, Any] = {"type": "gear", "joints": ["A", "B"], "internal": rng.random() < 0.3}
    gear |= {"teeth": [rng.choice([15, 20, 25]), rng.choice([30, 41, 52])]}
    gear |= {"pressure_angle": rng.uniform(0.0, 0.4), "helix": rng.uniform(-0.4, 0.4)}
    return {
        "links": {"arm": body(0.1), "one": body(0.05), "two": body(0.35)},
        "joints": {
            "O": {
                "type": "R",
                "links": ["ground", "arm"],
                "point": [-0.1, 0.05, 0.0],
                "axis": [0.0, 0.3, 1.0],
            },
            "A": {"type": "R", "links": ["arm", "one"], "point": [0, 0, 0], "axis": [0, 0, 1]},
            "B": {"type": "R", "links": ends, "point": [0.3, 0, 0], "axis": [0, 0, axis]},
        },
        "couplings": {"K": gear},
    }


@pytest.mark.parametrize("seed", range(16))
def test_random_wheels_on_a_swinging_arm_strike_as_all_their_bodies(seed: int) -> None:
    rng = random.Random(seed)
    data = swinging(rng)
    gear = data["couplings"]["K"]
    one, other = gear["teeth"]
    radius = 0.3 * one / (other - one if gear["internal"] else one + other)
    loose, whole = Dense({**data, "couplings": {}}), Dense(data)
    rates = {f"{joint}.theta": rng.uniform(-2.0, 2.0) for joint in "OAB"}
    efforts = {f"{joint}.theta": rng.uniform(-2.0, 2.0) for joint in "OA"}
    e = rng.uniform(0.0, 1.0)
    terms = whole.terms("K")

    def beyond(state: State) -> float:
        turns = (factor * state.angles[name[0]] for name, factor in terms.items())
        return abs(radius * sum(turns)) - 0.001

    start = loose.with_rates(loose.at_home(), rates)
    met = loose.followed(start, efforts, [0.0, 0.5], beyond)[-1]
    assert loose.ended is not None
    _, given = struck(whole, met, e)
    lashed = {"K": {**gear, "backlash": 0.002, "restitution": e}}
    text = yaml.safe_dump({"format": 1, "units": UNITS, **data, "couplings": lashed})
    begun = ", ".join(f"{name}: 0, {name}_dot: {rate!r}" for name, rate in rates.items())
    acting = ", ".join(f"{name}: {effort!r}" for name, effort in efforts.items())
    rows = mk.loads(
        f"{text}responses: {{run: {{start: {{{begun}}}, efforts: {{{acting}}}, "
        f"time: {{values: [0, {loose.ended + 1e-3!r}]}}}}}}\n"
    ).respond("run")
    impact = impacts_of(rows)[0]
    assert impact.time == pytest.approx(loose.ended, rel=1e-9)
    cells, size = cells_of(rows), float(np.abs(given["K"]).max())
    for name in ("K.tooth_impulse", "O.impulse", "A.impulse", "B.impulse"):
        told = [cells[f"{name}.{axis}"][0] for axis in "xyz"]
        np.testing.assert_allclose(told, given[name[0]][:3], rtol=0, atol=1e-8 * size)


@pytest.mark.parametrize(
    ("coupling", "links", "factors"),
    [
        (GEAR, "[one, ground]", (R1, -R2)),
        (
            GEAR.replace("[A, B]", "[B, A]").replace("[20, 40]", "[40, 20]"),
            "[one, ground]",
            (-R1, R2),
        ),
        (
            "{type: linear, terms: {A.theta: -2, B.theta: 3}, backlash: 1",
            "[ground, one]",
            (1.0, -1.5),
        ),
    ],
)
def test_play_is_positive_where_the_first_coordinate_is_ahead(
    coupling: str, links: str, factors: tuple[float, float]
) -> None:
    joints = PAIR.replace("links: [ground, one]", f"links: {links}")
    run = (
        "{start: {A.theta: 0, B.theta: 0, A.theta_dot: 0.1, B.theta_dot: 0.03}, "
        "time: {from: 0, to: 0.02, step: 0.01}}"
    )
    rows = pair(f"{coupling}}}", run, joints)
    name = "K.lash" if "linear" in coupling else "K.play"
    play = factors[0] * rows["A.theta"] + factors[1] * rows["B.theta"]
    np.testing.assert_allclose(rows[name], play, atol=1e-16)


def test_a_smaller_and_smaller_play_comes_to_the_gear() -> None:
    run = (
        "{start: {A.theta: 0, B.theta: 0}, efforts: {A.theta: 1}, "
        "time: {from: 0, to: 0.1, step: 0.01}}"
    )
    tight = pair(f"{GEAR.replace(', backlash: 2 mm', '')}}}", run.replace(", B.theta: 0", ""))
    off = []
    for backlash in (1e-3, 1e-4, 1e-5):
        rows = pair(f"{GEAR.replace('2 mm', f'{backlash!r}')}}}", run)
        off.append(np.abs(rows["A.theta"] - tight["A.theta"])[2:].max())
        np.testing.assert_allclose(rows["A.theta_dot"][5:], tight["A.theta_dot"][5:], rtol=1e-9)
        np.testing.assert_allclose(rows["A.force"][5:], tight["A.force"][5:], rtol=1e-9)
    # no farther than the play lets the wheel turn
    assert all(
        one <= 0.5 * b / R1 * (1.0 + 1e-9) for one, b in zip(off, (1e-3, 1e-4, 1e-5), strict=True)
    )


FLANK = (
    "motion: {inputs: {A.theta: {from: 0, to: 1, step: 0.25, rate: 1, acceleration: 2}, "
    "K.play: {at: 1 mm}}}\n"
)


def test_the_dense_system_of_a_row_on_a_flank_has_what_pushes_the_play() -> None:
    model = mk.loads(f"{OFF_CENTRE}couplings: {{K: {GEAR}}}}}\n{FLANK}")
    result = model.analyze()
    system = dense_system(result.result, 1)
    assert {u.group for u in system.unknowns} == set(unknown_names(model.problem))
    matrix, right = np.array(system.coefficients), np.array(system.right)
    values = np.linalg.solve(matrix, right)
    asked = ["A.theta.effort", "K.play.effort", "K.torque"]
    found = {u.name: v for u, v in zip(system.unknowns, values, strict=True)}
    for name in asked:
        assert found[name] == pytest.approx(result[name][1], rel=1e-11)
    turns = result["A.theta"], result["B.theta"]
    np.testing.assert_allclose(R1 * turns[0] + R2 * turns[1], 0.001, atol=1e-15)


def test_rows_on_a_flank_are_proven_bounded_and_ranged_by_the_play() -> None:
    text = f"{OFF_CENTRE}couplings: {{K: {GEAR}}}}}\n{FLANK}"
    columns = "tables: [{name: t, columns: [B.theta, K.torque, A.effort, K.tooth_force.x]}]\n"
    model = mk.loads(text + columns)
    result = model.analyze()
    assert set(result.result.proof) == {2}
    assert (result.errors.digits or 0) >= 13
    (ends,) = model.ranges("K.play").ranges
    assert (ends.lower.value, ends.upper.value) == pytest.approx((-0.001, 0.001), rel=1e-12)
    assert model.mobility().mobility == 2


def test_play_is_the_same_in_any_lanes_and_in_variants() -> None:
    run = (
        "{start: {A.theta: 0, B.theta: 0}, efforts: {A.theta: 1}, "
        "time: {from: 0, to: 0.05, step: 0.005}}"
    )
    coupling = f"{GEAR.replace('2 mm', 'b')}, restitution: 0.4}}"
    text = f"{PAIR}couplings: {{K: {coupling}}}\nresponses: {{run: {run}}}\n"
    names = ["A.theta", "K.play", "K.tooth_force"]
    model = mk.loads(f"{text}parameters: {{b: 2 mm}}\n")
    one = model.respond("run", names, lanes=2, threads=1)
    for lanes, threads in zip(widths(), (2, 1, 2), strict=False):
        other = model.respond("run", names, lanes=lanes, threads=threads)
        for name in names:
            assert one[name].tobytes() == other[name].tobytes()
    plays = [0.001, 0.002, 0.004]
    found = model.vary({"b": plays}, ["A.theta"], run="run")
    for number, width in enumerate(plays):
        alone = mk.loads(f"{text}parameters: {{b: {width} m}}\n").respond("run", names)
        np.testing.assert_array_equal(found["A.theta"][number], alone["A.theta"])


def test_what_pushes_wheels_apart_rubs_in_bearings_with_play_too() -> None:
    """A bearing with friction on a flank: 1 N m less friction turns I1 + I2/4, the bearing carries
    F and F tan(alpha), F = I2 a/4/r."""
    text = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  a: {mass: 1, center_of_mass: [0, 0], inertia: .02}
  b: {mass: 1, center_of_mass: [.06, 0], inertia: .05}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [ground, b], point: [.06, 0]}
couplings: {K: {type: gear, joints: [A, B], teeth: [20, 40], pressure_angle: .35, backlash: 0.5 mm}}
loads: [{type: friction, joint: A, coefficient: .5, radius: 5 mm}]
responses:
  r:
    start: {A.theta: 0.0125, A.theta_dot: 0, B.theta: 0, B.theta_dot: 0}
    efforts: {A.theta: 1 N*m}
    time: {from: 0, to: 1, count: 4}
"""
    rows = mk.loads(text).respond("r")
    per = sqrt(1.0 + tan(0.35) ** 2) * 0.05 / 4 / 0.02  # bearing force by acceleration
    rate = 1.0 / (0.02 + 0.05 / 4 + 0.5 * 0.005 * per)
    assert set(rows["row.status"]) == {"ok"}
    np.testing.assert_allclose(rows["A.theta_ddot"][1:], rate, rtol=1e-9)
    np.testing.assert_allclose(rows["norm(A.force)"][1:], per * rate, rtol=1e-9)
    np.testing.assert_allclose(rows["A.normal_load"][1:], per * rate, rtol=1e-9)


def test_ranges_are_those_of_wheels_amid_their_play() -> None:
    text = """
format: 1
plane: xy
units: {length: m, angle: rad}
links: {a: {}, b: {}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [ground, b], point: [.06, 0]}
couplings: {K: {type: gear, joints: [A, B], teeth: [20, 40], backlash: 0.5 mm}}
limits: {B.theta: [-1, 0.5]}
motion: {inputs: {A.theta: {from: 0, to: 1, count: 3}}}
"""
    (found,) = mk.loads(text).ranges().ranges
    assert (found.lower.value, found.upper.value) == pytest.approx((-1.0, 2.0), abs=1e-9)
