"""Small motions about equilibria: with the statics' own verdicts, and about the squeezer."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk

SPRUNG = """format: 1
units: {angle: rad}
links:
  a: {mass: 2, center_of_mass: [0, -0.25, 0], inertia: {zz: 0.01}}
  b: {mass: 1, center_of_mass: [0.2, -0.6, 0]}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [a, b], point: [0, -0.5, 0], axis: [0, 0, 1]}
points: {tip: {link: b, at: [0.2, -0.9, 0]}}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - {type: spring, joint: A, coordinate: theta, stiffness: 2, free: 0.7}
equilibria:
  all: {window: {A.theta: {from: -3, to: 3}, B.theta: {from: -3, to: 3}}}
"""


def test_frequencies_and_signs_are_those_of_the_verdicts() -> None:
    model = mk.loads(SPRUNG)
    r = model.equilibrium("all", ["row.frequency", "row.least_stiffness"])
    assert r.rows > 1
    seen = set()
    for row, event in enumerate(r["row.event"]):
        v = model.vibration("all", row)
        assert v.diagnostics == ()
        seen.add(event)
        assert v.is_stable == (event == "stable")
        least = np.linalg.eigvalsh(v.stiffness)[0]
        assert r["row.least_stiffness"][row] == pytest.approx(least, rel=1e-8)
        if event == "stable":
            assert r["row.frequency"][row] == pytest.approx(v.frequencies[0], rel=1e-9)
            # by places of its point the motion is the same
            told = model.vibration("all", row, ["A.theta", "B.theta"])
            assert told.frequencies == pytest.approx(v.frequencies, rel=1e-12)
    assert seen == {"stable", "unstable"}


def test_an_equilibrium_is_the_run_that_is_meant() -> None:
    model = mk.loads(SPRUNG + "motion: {inputs: {A.theta: {at: 0.3}, B.theta: {at: 0}}}\n")
    assert model.vibration().frequencies == pytest.approx(model.vibration("all").frequencies)
    # about the sweep's row, constant moments at the joints hold it
    swept = model.vibration("sweep")
    assert np.abs(swept.holding).max() > 0.1
    assert [note.code for note in swept.diagnostics] == ["held-by-efforts"]


def test_sensitivities_follow_the_equilibrium() -> None:
    """A pendulum on a torsion spring that is not free at rest: the place moves with it."""
    text = """format: 1
parameters: {k: 3 N*m/rad}
units: {angle: rad}
links: {bob: {mass: 2, center_of_mass: [0, 0, -0.4]}}
joints: {A: {type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, -1, 0]}}
loads:
  - {type: gravity, g: [0, 0, -9.81]}
  - {type: spring, joint: A, coordinate: theta, stiffness: k, free: 1.5}
equilibria: {rest: {near: {A.theta: 0.5}}}
"""
    v = mk.loads(text).vibration()
    weight, inertia = 2 * 9.81 * 0.4, 2 * 0.4**2

    def frequency(k: float) -> float:
        t = 0.5
        for _ in range(50):
            t -= (weight * np.sin(t) + k * (t - 1.5)) / (weight * np.cos(t) + k)
        return np.sqrt((weight * np.cos(t) + k) / inertia) / (2 * np.pi)

    assert v.frequencies == pytest.approx([frequency(3.0)], rel=1e-11)
    h = 1e-4
    slope = (frequency(3 + h) - frequency(3 - h)) / (2 * h)
    assert v.sensitivity("k") == pytest.approx([slope], rel=1e-7)


LOOP = """format: 1
plane: xy
units: {angle: rad}
links:
  a: {mass: 1, center_of_mass: [0, 0.5]}
  b: {}
  c: {mass: 2, center_of_mass: [1.3, 0.7]}
  base: {}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [a, b], point: [0, 1]}
  C: {type: R, links: [b, c], point: [1.2, 1.4]}
  D: {type: R, links: [base, c], point: [1.6, 0]}
  S: {type: P, links: [ground, base], point: [1.6, 0], axis: [1, 0.5]}
loads:
  - {type: gravity, g: [0, -9.81]}
  - {type: spring, joint: A, coordinate: theta, stiffness: 40}
  - {type: spring, joint: D, coordinate: theta, stiffness: 30, free: 0.1}
equilibria:
  rest: {near: {A.theta: 0}, driven: {S.s: {at: PLACE}}}
"""


@pytest.mark.parametrize("name", ["A.theta", "C.theta"])
def test_a_base_that_moves_inside_a_loop(name: str) -> None:
    """Moved slowly, the loop goes from equilibrium to equilibrium, and its drive feels that."""

    def rests(place: float) -> np.ndarray:
        r = mk.loads(LOOP.replace("PLACE", repr(place))).equilibrium("rest", [name, "S.effort"])
        return np.array([r["A.theta"][0], r["C.theta"][0], r["S.effort"][0]])

    h = 1e-4
    slopes = (8 * (rests(h) - rests(-h)) - (rests(2 * h) - rests(-2 * h))) / (12 * h)
    v = mk.loads(LOOP.replace("PLACE", "0")).vibration(coordinates=[name])
    told = v.response([0.0], "S.s", ["A.theta", "C.theta", "S.effort"])
    assert told.values[:, 0].real == pytest.approx(slopes, rel=1e-7)
    assert told.values[:, 0].imag == pytest.approx(np.zeros(3), abs=1e-12)
    # the state is the coordinate itself, and not what the chart makes of it
    s = v.state_space(["S.s"], [name])
    assert pytest.approx(np.array([[1.0, 0, 0, 0]]), abs=1e-9) == s.C
    assert pytest.approx(np.zeros((1, 1)), abs=1e-9) == s.D
    slope = slopes[0 if name == "A.theta" else 1]
    held = -s.A[2, 1] / s.A[2, 0]
    assert held == pytest.approx(slope, rel=1e-7)
