"""Films of oil by Petroff's law, and Stribeck's curve, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile

FILM = "viscosity: 0.03 Pa*s, clearance: 0.05 mm, radius: 20 mm, length: 40 mm"
SHAFT = """
format: 1
plane: xy
units: {length: mm, angle: deg, mass: kg, force: N}
links: {shaft: {mass: 2, center_of_mass: [0, 0], inertia: 400}}
joints: {A: {type: R, links: [ground, shaft], point: [0, 0]}}
"""
TURNED = (
    SHAFT
    + """
motion: {inputs: {A.theta: {from: 0, to: 90, step: 45, rate: RATE rad/s}}}
loads:
  - {type: force, link: shaft, point: [0, 0], force: [300, -400]}
  - {type: friction, joint: A, LAW}
"""
)
PETROFF = 2.0 * np.pi * 0.03 * 0.02**3 * 0.04 / 0.05e-3
"""N m s"""


def turned(law: str, rate: float) -> mk.Analysis:
    return mk.loads(TURNED.replace("LAW", law).replace("RATE", str(rate))).analyze()


@pytest.mark.parametrize("rate", [100.0, -3.0])
def test_a_film_resists_by_its_shear_alone(rate: float) -> None:
    """2 pi mu r^3 l omega / c, whatever the load is."""
    result = turned(f"law: viscous, {FILM}", rate)
    np.testing.assert_allclose(result["A.effort"], 1000.0 * PETROFF * rate, rtol=1e-13)
    assert np.nanmax(result["row.power_error"]) < 1e-14


@pytest.mark.parametrize("rate", [0.05, 1.0, 200.0])
def test_the_curve_of_stribeck_falls_and_rises(rate: float) -> None:
    """The dry part by its speed at the surface, and the film's."""
    law = f"law: stribeck, coefficient: {{static: 0.2, sliding: 0.08, speed: 15 mm/s}}, {FILM}"
    result = turned(law, rate)
    coefficient = 0.08 + 0.12 * np.exp(-((20.0 * rate / 15.0) ** 2))
    moment = coefficient * 500.0 * 20.0 + 1000.0 * PETROFF * rate
    np.testing.assert_allclose(result["A.effort"], moment, rtol=1e-12)
    # beyond where it falls least the film takes over
    lowest = [turned(law, each)["A.effort"][0] for each in (0.02, 2.0, 200.0)]
    assert lowest[1] < lowest[0]
    assert lowest[1] < lowest[2]


def test_a_shaft_runs_down_in_its_film() -> None:
    """omega exp(-t k / I)."""
    text = f"{SHAFT}loads: [{{type: friction, joint: A, law: viscous, {FILM}}}]\n"
    text += "responses: {down: {start: {A.theta: 0, A.theta_dot: 50 rad/s}, "
    text += "time: {from: 0, to: 0.4, count: 5}}}"
    result = mk.loads(text).respond("down")
    times = np.linspace(0.0, 0.4, 5)
    np.testing.assert_allclose(
        result["A.theta_dot"], 50.0 * np.exp(-times * PETROFF / 400e-6), rtol=1e-9
    )


def test_a_rod_turns_and_slides_in_its_film() -> None:
    text = """
format: 1
units: {length: m, angle: rad, mass: kg, force: N}
links: {rod: {}}
joints: {A: {type: C, links: [ground, rod], point: [0, 0, 0], axis: [1, 2, 2]}}
motion: {inputs: {A.theta: {at: 0, rate: 3 rad/s}, A.s: {at: 0, rate: -0.2 m/s}}}
loads:
  - {type: friction, joint: A, law: viscous, FILM}
""".replace("FILM", FILM)
    result = mk.loads(text).analyze()
    np.testing.assert_allclose(result["A.theta.effort"], 3.0 * PETROFF, rtol=1e-13)
    np.testing.assert_allclose(result["A.s.effort"], -0.2 * PETROFF / 0.02**2, rtol=1e-13)


WRONG = {
    "no coefficient": ("radius: 20 mm", "needs a coefficient"),
    "no clearance": ("law: viscous, viscosity: 1 Pa*s", "needs a clearance"),
    "both": (f"law: viscous, coefficient: 0.1, {FILM}", "has no coefficient"),
    "film of dry": ("coefficient: 0.1, radius: 20, viscosity: 1 Pa*s", "has no viscosity"),
    "word": (f"law: petroff, {FILM}", "dry"),
    "zero": (f"law: viscous, {FILM}".replace("0.03", "0"), "the viscosity of the film is 0"),
    "unit": (f"law: viscous, {FILM}".replace("Pa*s", "Pa"), "viscosity"),
}


@pytest.mark.parametrize(("law", "words"), WRONG.values(), ids=WRONG.keys())
def test_laws_that_lack_something_are_refused(law: str, words: str) -> None:
    with pytest.raises(InvalidFile) as told:
        turned(law, 1.0)
    assert any(words in str(d) for d in told.value.diagnostics)
