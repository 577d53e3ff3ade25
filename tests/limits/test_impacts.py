"""Rebounds from limits: a slide and a pendulum by closed forms, a four-bar and a double pendulum by
the dense equations of all bodies with the impulses at their joints."""

from __future__ import annotations

from math import cos, sin, sqrt

import numpy as np
import pytest

import mechkin_cli as mk
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
    result = mk.loads(SLIDE.format(e=e, to=20.0)).respond("fall")
    at = sqrt(0.4) * (1.0 + 2.0 * e / (1.0 - e))
    # a flight no higher than 1e-9 of the size is left out, which lasts 3e-5 s
    assert result["time"][-1] == pytest.approx(at, abs=5e-4)
    assert result["row.event"][-1] == "S.s rests at its limit"
    assert result["S.s"][-1] == pytest.approx(-2.0, abs=1e-12)
    assert "rests" in {d.code for d in result.diagnostics}


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


def test_rebounds_are_the_same_bits_in_any_lanes() -> None:
    text = SLIDE.format(e=0.5, to=1.5)
    one = mk.loads(text).respond("fall", ["S.s"], lanes=2)
    for lanes in (4, 8):
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
