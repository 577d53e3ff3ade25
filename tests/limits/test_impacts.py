"""Rebounds from limits: a slide and a pendulum by closed forms, a four-bar and a double pendulum by
the dense equations of all bodies with the impulses at their joints."""

from __future__ import annotations

from math import cos, sin, sqrt

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.kernel.functions import widths
from mechkin_cli.response import Impact, ResponseResult

SLIDE = """
format: 1
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{block: {{mass: 2, center_of_mass: [0, 0]}}}}
joints:
  S: {{type: P, links: [ground, block], point: [0, 0], axis: [0, 1]}}
loads: [{{type: gravity, g: [0, -10]}}]
limits: {{S.s: {{min: -2, restitution: {e!r}}}}}
responses: {{fall: {{start: {{S.s: 0}}, time: {{from: 0, to: {to!r}, step: 0.1}}}}}}
"""


def impacts_of(rows: mk.Analysis) -> tuple[Impact, ...]:
    """The impacts of a response."""
    result = rows.result
    assert isinstance(result, ResponseResult)
    return result.impacts


def flights(e: float) -> list[tuple[float, float]]:
    """When the slide comes to its limit, and the rate with which it leaves it."""
    time, rate, found = sqrt(0.4), sqrt(40.0), []
    for _ in range(200):
        rate *= e
        found.append((time, rate))
        time += 2.0 * rate / 10.0
    return found


@pytest.mark.parametrize("e", [1.0, 0.9, 0.5, 0.1])
def test_a_slide_rebounds_to_heights_by_the_square_of_the_restitution(e: float) -> None:
    last = flights(e)[3][0]
    result = mk.loads(SLIDE.format(e=e, to=last)).respond("fall")
    expected = []
    for t in result["time"]:
        passed = [one for one in flights(e) if one[0] <= t]
        if passed:
            since, rate = t - passed[-1][0], passed[-1][1]
            expected.append((-2.0 + rate * since - 5.0 * since**2, rate - 10.0 * since))
        else:
            expected.append((-5.0 * t**2, -10.0 * t))
    away = np.abs(result["time"][:, None] - np.array(flights(e))[None, :, 0]).min(axis=1) > 1e-9
    found = np.column_stack([result["S.s"], result["S.s_dot"]])
    np.testing.assert_allclose(found[away], np.array(expected)[away], atol=1e-11)
    for impact, (time, rate) in zip(impacts_of(result), flights(e), strict=False):
        assert impact.time == pytest.approx(time, rel=1e-12)
        assert impact.impulses[0] == pytest.approx(2.0 * rate * (1.0 + 1.0 / e), rel=1e-11)
    # what is lost: 1 - e^2 of the energy that each impact meets
    assert np.nanmax(result["row.energy_error"]) < 1e-12
    lost = sum(0.5 * 2.0 * r**2 * (1.0 / e**2 - 1.0) for t, r in flights(e) if t < last - 0.1)
    before = result["row.dissipated"][result["time"] < last - 1e-9]
    assert before[-1] == pytest.approx(lost, rel=1e-10, abs=1e-10)


@pytest.mark.parametrize("e", [0.0, 0.5, 0.8])
def test_a_slide_rests_in_finite_time(e: float) -> None:
    result = mk.loads(SLIDE.format(e=e, to=7.0)).respond("fall")
    at = sqrt(0.4) * (1.0 + 2.0 * e / (1.0 - e))
    # a flight no higher than 1e-9 of the size is left out, which lasts 3e-5 s
    assert impacts_of(result)[-1].time == pytest.approx(at, abs=5e-4)
    assert impacts_of(result)[-1].rests
    assert result["time"][-1] == 7.0
    np.testing.assert_allclose(result["S.s"][result["time"] > at], -2.0, atol=1e-11)
    np.testing.assert_allclose(result["S.effort"][result["time"] > at], 20.0, rtol=1e-12)
    (note,) = [d for d in result.diagnostics if d.code == "rests"]
    last = impacts_of(result)[-1].time
    assert note.message.endswith(f"and rests at it from {last:.12g} s on")


@pytest.mark.parametrize("e", [0.0, 0.5])
def test_what_begins_at_a_limit_rests_there(e: float) -> None:
    text = SLIDE.format(e=e, to=1.0).replace("{S.s: 0}", "{S.s: -2}")
    result = mk.loads(text).respond("fall")
    np.testing.assert_array_equal(result["S.s"], np.full(11, -2.0))
    np.testing.assert_array_equal(result["S.s_ddot"], np.zeros(11))
    np.testing.assert_allclose(result["S.effort"], 20.0, rtol=1e-13)
    assert set(result["row.status"]) == {"ok"}


def test_what_begins_at_a_limit_outwards_rebounds_or_ends_at_once() -> None:
    text = SLIDE.format(e=0.5, to=0.5).replace("{S.s: 0}", "{S.s: -2, S.s_dot: -8}")
    result = mk.loads(text).respond("fall")
    time = result["time"][1:]
    np.testing.assert_allclose(result["S.s"][1:], -2.0 + 4.0 * time - 5.0 * time**2, atol=1e-12)
    assert impacts_of(result)[0].impulses[0] == pytest.approx(2.0 * 12.0, rel=1e-13)
    ended = mk.loads(text.replace(", restitution: 0.5", "")).respond("fall")
    assert ended["time"].tolist() == [0.0]
    assert ended["row.event"][0] == "S.s at its limit -2 m"


def test_what_begins_at_a_limit_inwards_goes() -> None:
    text = SLIDE.format(e=0.5, to=0.5).replace("{S.s: 0}", "{S.s: -2, S.s_dot: 4}")
    result = mk.loads(text).respond("fall")
    time = result["time"]
    np.testing.assert_allclose(result["S.s"], -2.0 + 4.0 * time - 5.0 * time**2, atol=1e-12)
    assert not impacts_of(result)


def test_a_pendulum_between_stops_swings_with_the_energy_that_is_left() -> None:
    text = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links: {rod: {mass: 3, center_of_mass: [0, -0.5], inertia: 0.25}}
joints: {O: {type: R, links: [ground, rod], point: [0, 0]}}
loads: [{type: gravity, g: [0, -9.81]}]
limits: {O.theta: {min: -0.2, max: 2, restitution: 0.7}}
responses: {swing: {start: {O.theta: 1}, time: {from: 0, to: 4, step: 0.01}}}
"""
    result = mk.loads(text).respond("swing")
    about = 0.25 + 3.0 * 0.25
    energy = 3.0 * 9.81 * 0.5 * (1.0 - cos(1.0))
    at_stop = 3.0 * 9.81 * 0.5 * (1.0 - cos(0.2))
    impacts = impacts_of(result)
    assert len(impacts) >= 2
    for number, impact in enumerate(impacts[:3]):
        rate = sqrt(2.0 * (energy - at_stop) / about)
        assert impact.rates[0] == pytest.approx(rate, rel=1e-9)
        assert impact.impulses[0] == pytest.approx(about * 1.7 * rate, rel=1e-9)
        energy = at_stop + 0.49 * (energy - at_stop)
        before = impact.time
        after = impacts[number + 1].time if number + 1 < len(impacts) else 4.0
        between = (result["time"] > before + 1e-6) & (result["time"] < after - 1e-6)
        theta, rates = result["O.theta"][between], result["O.theta_dot"][between]
        height = 3.0 * 9.81 * 0.5 * (1.0 - np.cos(theta))
        np.testing.assert_allclose(0.5 * about * rates**2 + height, energy, atol=1e-8)


FOUR_BAR = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  crank: {mass: 1, center_of_mass: [0.1, 0.1], inertia: 0.02}
  rod: {mass: 2, center_of_mass: [0.7, 0.8], inertia: 0.3}
  rocker: {mass: 1.5, center_of_mass: [1.25, 0.5], inertia: 0.15}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [crank, rod], point: [0.2, 0.4]}
  C: {type: R, links: [rod, rocker], point: [1.2, 1]}
  D: {type: R, links: [ground, rocker], point: [1.3, 0]}
points:
  a: {link: crank, at: [0.1, 0.1]}
  b: {link: rod, at: [0.7, 0.8]}
  c: {link: rocker, at: [1.25, 0.5]}
loads: [{type: gravity, g: [0, -9.81]}]
"""
RATES = ["a.velocity", "b.velocity", "c.velocity", "crank.omega", "rod.omega", "rocker.omega"]
PLACES = ["a.position", "b.position", "c.position", "B.point", "C.point"]


def four_bar(limit: str, times: str) -> mk.Analysis:
    """Rows of a four-bar that swings from rest with its crank."""
    run = f"responses: {{swing: {{start: {{A.theta: 0}}, time: {times}}}}}\n"
    model = mk.loads(f"{FOUR_BAR}limits: {{D.theta: {limit}}}\n{run}")
    return model.respond("swing", ["time", *RATES, *PLACES])


def velocities(rows: mk.Analysis, row: int) -> np.ndarray:
    """Velocities of mass centres and angular rates of crank, rod and rocker."""
    parts = [[*rows[v][row], rows[w][row]] for v, w in zip(RATES[:3], RATES[3:], strict=True)]
    return np.concatenate(parts)


def test_an_impact_of_a_four_bar_is_that_of_its_bodies_and_joints() -> None:
    every = "{from: 0, to: 1, step: 0.05}"
    limit, e = 0.5, 0.6
    met = four_bar(f"{{max: {limit}}}", every)
    assert "limit" in met["row.event"][-1]
    at = float(met["time"][-1])
    before = velocities(met, -1)
    bounds = f"{{max: {limit}, restitution: {e}}}"
    step = 1e-6
    later = four_bar(bounds, f"{{values: [0, {at + step!r}, {at + 2 * step!r}]}}")
    (impact,) = impacts_of(later)
    after = 2.0 * velocities(later, 1) - velocities(later, 2)

    centres = [met[name][-1] for name in PLACES[:3]]
    pins = [np.zeros(2), met["B.point"][-1], met["C.point"][-1], np.array([1.3, 0.0])]
    mass = np.diag(np.concatenate([[m, m, i] for m, i in ((1, 0.02), (2, 0.3), (1.5, 0.15))]))
    rows = []
    for pin, (first, second) in zip(pins, ((None, 0), (0, 1), (1, 2), (None, 2)), strict=True):
        for axis in range(2):
            row = np.zeros(9)
            for body, sign in ((first, -1.0), (second, 1.0)):
                if body is None:
                    continue
                arm = pin - centres[body]
                row[3 * body + axis] = sign
                row[3 * body + 2] = sign * (-arm[1] if axis == 0 else arm[0])
            rows.append(row)
    rows.append(np.eye(9)[8])  # the rocker turns by D.theta
    jacobian = np.array(rows)
    # M (v+ - v-) = J^T P, joints closed, and the rocker's rate by the restitution
    system = np.block([[mass, -jacobian.T], [jacobian, np.zeros((9, 9))]])
    right = np.concatenate([mass @ before, np.zeros(8), [-e * before[8]]])
    solved = np.linalg.solve(system, right)
    np.testing.assert_allclose(after, solved[:9], atol=1e-8)
    assert impact.impulses[0] == pytest.approx(-solved[17], rel=1e-9)
    assert impact.rates[0] == pytest.approx(before[8], rel=1e-9)
    told = later.impacts
    assert told is not None
    found = {column.label: column.values for column in told.columns}
    pushed = [found[f"{joint}.impulse.{axis}"][0] for joint in "ABCD" for axis in "xy"]
    np.testing.assert_allclose(pushed, solved[9:17], rtol=1e-8, atol=1e-9)
    np.testing.assert_allclose(found["D.theta.impulse"], solved[17], rtol=1e-9)
    np.testing.assert_allclose(found["time"], at, rtol=1e-9)


DOUBLE = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  upper: {mass: 2, center_of_mass: [0, -0.5], inertia: 0.2}
  lower: {mass: 1, center_of_mass: [0, -1.4], inertia: 0.05}
joints:
  A: {type: R, links: [ground, upper], point: [0, 0]}
  B: {type: R, links: [upper, lower], point: [0, -1]}
loads: [{type: gravity, g: [0, -9.81]}]
"""


def inertia(elbow: float) -> np.ndarray:
    """Reduced inertia of the double pendulum, by A.theta and B.theta."""
    lower = 0.05 + 0.16
    coupled = lower + 0.4 * cos(elbow)
    upper = 0.2 + 2 * 0.25 + 1.0 + 2 * 0.4 * cos(elbow) + lower
    return np.array([[upper, coupled], [coupled, lower]])


def test_an_elbow_that_comes_to_its_stop_moves_both_arms() -> None:
    start = "{A.theta: 0.9, B.theta: 0.3, A.theta_dot: 1, B.theta_dot: 3}"
    bounds = "limits: {B.theta: {max: 0.8, restitution: 0.3}}\n"

    def rows(limits: str, times: str) -> mk.Analysis:
        run = f"responses: {{swing: {{start: {start}, time: {times}}}}}\n"
        return mk.loads(DOUBLE + limits + run).respond("swing")

    met = rows("limits: {B.theta: {max: 0.8}}\n", "{from: 0, to: 2, step: 0.1}")
    at = float(met["time"][-1])
    before = np.array([met["A.theta_dot"][-1], met["B.theta_dot"][-1]])
    step = 1e-6
    later = rows(bounds, f"{{values: [0, {at + step!r}, {at + 2 * step!r}]}}")
    names = ("A.theta_dot", "B.theta_dot")
    after = np.array([2.0 * later[name][1] - later[name][2] for name in names])
    normal = np.linalg.solve(inertia(0.8), [0.0, 1.0])
    push = 1.3 * before[1] / normal[1]
    np.testing.assert_allclose(after, before - push * normal, atol=1e-8)
    assert impacts_of(later)[0].impulses[0] == pytest.approx(push, rel=1e-9)
    assert sin(0.8) > 0.0


def test_a_drive_takes_the_impulse_of_an_elbow_at_its_stop() -> None:
    text = DOUBLE + (
        "limits: {B.theta: {max: 0.8, restitution: 0.3}}\n"
        "responses: {swing: {start: {B.theta: 0.3, B.theta_dot: 6}, "
        "driven: {A.theta: {law: constant-rate, at: 0.2, rate: 1}}, "
        "time: {from: 0, to: 0.5, step: 0.1}}}\n"
    )
    rows = mk.loads(text).respond("swing")
    told = rows.impacts
    assert told is not None
    (impact,) = impacts_of(rows)
    found = {column.label: float(column.values[0]) for column in told.columns if column.unit}
    whole = inertia(0.8)
    jump = -1.3 * impact.rates[0]
    assert found["B.theta.impulse"] == pytest.approx(whole[1, 1] * jump, rel=1e-12)
    assert found["A.effort_impulse"] == pytest.approx(whole[0, 1] * jump, rel=1e-12)
    # the upper arm goes on as it is driven, so both pins take the lower one's momentum: of 1 kg,
    # 0.4 m from its pin, in the direction of both angles
    along = 0.2 + impact.time + 0.8
    change = 0.4 * jump * np.array([cos(along), sin(along)])
    for pin in "AB":
        pushed = [found[f"{pin}.impulse.{axis}"] for axis in "xy"]
        np.testing.assert_allclose(pushed, change, rtol=1e-11)


def test_impulses_that_redundant_pins_share_have_no_cell() -> None:
    # two pins on one axis take the blow together, in shares that rigid links do not tell
    text = """
format: 1
units: {length: m, angle: rad, mass: kg, force: N}
links: {door: {mass: 3, center_of_mass: [0, -0.5, 0], inertia: {xx: 0.25, yy: 0.2, zz: 0.25}}}
joints:
  A: {type: R, links: [ground, door], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [ground, door], point: [0, 0, 1], axis: [0, 0, 1]}
limits: {A.theta: {max: 1, restitution: 0.5}}
responses: {shut: {start: {A.theta: 0, A.theta_dot: 2}, time: {from: 0, to: 1, step: 0.1}}}
"""
    told = mk.loads(text).respond("shut").impacts
    assert told is not None
    found = {column.label: column.values for column in told.columns}
    assert np.isnan(found["A.impulse.x"]).all()
    np.testing.assert_allclose(found["A.theta.impulse"], [-3.0], rtol=1e-12)


def test_rebounds_are_the_same_bits_in_any_lanes() -> None:
    text = SLIDE.format(e=0.5, to=1.5)
    one = mk.loads(text).respond("fall", ["S.s"], lanes=2)
    for lanes in widths():
        other = mk.loads(text).respond("fall", ["S.s"], lanes=lanes)
        assert one["S.s"].tobytes() == other["S.s"].tobytes()


def test_variants_rebound_each_by_its_own_limit() -> None:
    text = SLIDE.format(e=0.5, to=1.5).replace("restitution: 0.5", "restitution: e")
    model = mk.loads(text + "parameters: {e: 0.5}\n")
    found = model.vary({"e": [0.25, 0.5, 1.0]}, ["S.s"], run="fall")
    for number, e in enumerate((0.25, 0.5, 1.0)):
        alone = mk.loads(SLIDE.format(e=e, to=1.5)).respond("fall")["S.s"]
        rows = found["S.s"][number][: len(alone)]
        np.testing.assert_array_equal(rows, alone)


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("restitution: 0.5", "restitution: 1.5", "no-restitution"),
        ("restitution: 0.5", "restitution: -0.1", "no-restitution"),
        ("step: 0.1}", "step: 0.1}, stop: [{value: S.s, at: -1, count: 2}]", "counted-stop"),
    ],
)
def test_what_no_rebound_bears_is_refused(old: str, new: str, code: str) -> None:
    with pytest.raises(mk.InvalidFile) as refused:
        mk.loads(SLIDE.format(e=0.5, to=1.0).replace(old, new))
    assert [d.code for d in refused.value.diagnostics] == [code]


@pytest.mark.parametrize("e", [0.0, 0.3])
def test_a_slide_rests_by_the_limits_force_and_leaves_where_it_would_pull(e: float) -> None:
    effort = 'efforts: {S.s: "10 N*time/(1 s)"}, time: {from: 0, to: 2.6, step: 0.1}'
    text = SLIDE.format(e=e, to=1.0).replace("time: {from: 0, to: 1.0, step: 0.1}", effort)
    result = mk.loads(text).respond("fall")
    time = result["time"]
    at = impacts_of(result)[-1].time
    resting = (time > at) & (time < 2.0)
    assert resting.any()
    np.testing.assert_allclose(result["S.s"][resting], -2.0, atol=1e-11)
    assert (result["S.s_dot"][resting] == 0.0).all()
    assert (result["S.s_ddot"][resting] == 0.0).all()
    # the weight of 20 N, borne by the given force and the limit
    np.testing.assert_allclose(result["S.effort"][resting], 20.0, rtol=1e-12)
    # from 2 s on the given force is above the weight
    after = time - 2.0
    free = after > 1e-9
    np.testing.assert_allclose(result["S.s"][free], -2.0 + 5.0 / 6.0 * after[free] ** 3, atol=1e-11)
    np.testing.assert_allclose(result["S.s_dot"][free], 2.5 * after[free] ** 2, atol=1e-11)
    np.testing.assert_allclose(result["S.effort"][free], 10.0 * time[free], rtol=1e-12)
    assert len(time) == 27
    assert set(result["row.status"]) == {"ok"}
    (note,) = [d for d in result.diagnostics if d.code == "rests"]
    assert note.message.endswith("rests at it, and leaves it again")
    assert np.nanmax(result["row.energy_error"]) < 1e-9


def test_a_four_bar_rests_on_a_limit_of_its_rocker() -> None:
    run = "responses: {swing: {start: {A.theta: 0}, time: {from: 0, to: 3, step: 0.1}}}\n"
    text = f"{FOUR_BAR}limits: {{D.theta: {{min: -0.04, restitution: 0}}}}\n{run}"
    result = mk.loads(text).respond("swing")
    np.testing.assert_allclose(result["D.theta"][5:], -0.04, atol=1e-11)
    sweep = "motion: {inputs: {D.theta: {values: [-0.039999, -0.040001]}}}\n"
    away = mk.loads(f"{FOUR_BAR}assembly: {{near: {{A.theta: -0.2}}}}\n{sweep}")
    potential = away.analyze(["row.potential_energy", "A.theta"])
    slope = np.diff(potential["row.potential_energy"])[0] / -2e-6
    np.testing.assert_allclose(potential["A.theta"], result["A.theta"][-1], atol=1e-4)
    np.testing.assert_allclose(result["D.effort"][5:], slope, rtol=1e-7)


@pytest.mark.parametrize("height", [0.35, 0.55, 1.15, 2.9, 3.35, 4.05, 4.75])
@pytest.mark.parametrize("after", [0.0, 1e-15, 2e-15, 5e-15, 1e-14, 1e-13, 1e-12])
def test_a_last_row_at_the_moment_of_an_impact_is_reached(height: float, after: float) -> None:
    """The step that is left from the fourth impact to the last row is a few roundings of time."""
    last = 7.0 * sqrt(height / 5.0) * (1.0 + after)
    text = SLIDE.format(e=1.0, to=last).replace("step: 0.1", "count: 11")
    text = text.replace("min: -2", "min: 0").replace("S.s: 0}", f"S.s: {height}}}")
    rows = mk.loads(text).respond("fall")
    assert rows.complete
    assert abs(rows["S.s"][-1]) <= 4.0 * (5e-12 + last * after * sqrt(20.0 * height))


WHEELS = """
format: 1
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
links:
  a: {{mass: 1, center_of_mass: [0, 0], inertia: 0.3}}
  b: {{mass: 1, center_of_mass: [1, 0], inertia: 0.2}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0]}}
  B: {{type: R, links: [ground, b], point: [1, 0]}}
couplings: {{K: {{type: gear, joints: [A, B], teeth: [{one}, {other}]}}}}
loads: [{{type: torque, joint: A, value: -0.7}}]
limits: {{A.theta: {{max: 0.6, restitution: 0}}}}
responses: {{r: {{start: {{A.theta: 0, A.theta_dot: 2.2}}, time: {{values: [0, 0.2, 0.7, 1.5]}}}}}}
"""


@pytest.mark.parametrize("one", [13, 17, 19, 23, 29, 31])
@pytest.mark.parametrize("other", [14, 21, 33])
def test_what_a_limit_stops_and_a_load_draws_off_leaves_at_once(one: int, other: int) -> None:
    """The rates that an impact leaves may be rounding of zero, which tells nothing of the way that
    loads make from there to the next row."""
    rows = mk.loads(WHEELS.format(one=one, other=other)).respond("r")
    back = -0.7 / (0.3 + 0.2 * (one / other) ** 2)
    impact = (-2.2 + sqrt(2.2**2 + 2.0 * back * 0.6)) / back
    after = rows["time"][2:] - impact
    np.testing.assert_allclose(rows["A.theta"][2:], 0.6 + back / 2.0 * after**2, rtol=1e-9)
    np.testing.assert_allclose(rows["A.theta_dot"][2:], back * after, rtol=1e-9)


def test_a_response_of_too_many_impacts_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """1 kg pushed by 10 N from 0.1 m below its limit, thrown back as fast, every 2 sqrt(0.02) s."""
    monkeypatch.setattr("mechkin_cli.tolerances.MOST_IMPACTS", 5)
    text = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links: {m: {mass: 1, center_of_mass: [0, 0]}}
joints: {S: {type: P, links: [ground, m], point: [0, 0], axis: [1, 0]}}
loads: [{type: force, joint: S, value: 10}]
limits: {S.s: {max: 0.1, restitution: 1}}
responses: {r: {start: {S.s: 0}, time: {from: 0, to: 9, count: 10}}}
"""
    rows = mk.loads(text).respond("r")
    (told,) = (d for d in rows.diagnostics if d.severity == "warning")
    assert "with its 5 impacts" in told.message
    assert rows["time"][-1] == pytest.approx(11.0 * sqrt(0.02), rel=1e-9)
