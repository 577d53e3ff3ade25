"""Balances and `coefficients:` of mechanisms with couplings."""

from __future__ import annotations

import numpy as np
import pytest
from random_families.coupled import draw, text_of

import mechkin_cli as mk
from mechkin_cli.balances.newton_euler import dense_system
from mechkin_cli.building.tables import unknown_names

GEARED = """
format: 1
plane: xy
units: {length: mm, angle: deg, mass: kg, force: N}
links:
  motor: {mass: 1, center_of_mass: [-60, 0], inertia: 40 kg*mm^2}
  crank: {mass: 2, center_of_mass: [20, 0]}
  rod: {mass: 1, center_of_mass: [80, 0]}
  slider: {mass: 3, center_of_mass: [140, 0]}
joints:
  M: {type: R, links: [ground, motor], point: [-60, 0]}
  O: {type: R, links: [ground, crank], point: [0, 0]}
  A: {type: R, links: [crank, rod], point: [40, 0]}
  B: {type: R, links: [rod, slider], point: [140, 0]}
  S: {type: P, links: [ground, slider], point: [140, 0], axis: [1, 0]}
couplings: {G: {type: gear, joints: [M, O], teeth: [20, 60], pressure_angle: 20}}
loads: [{type: force, joint: S, value: "-30 N - 20 N*sin(O.theta)"}]
motion: {inputs: {M.theta: {from: 0, to: 1080, count: 73, rate: 30 rad/s}}}
balances:
  - {name: h, type: harmonics, of: [M.effort], orders: [1/3, 2/3, 1]}
  - {name: w, type: flywheel, unevenness: 0.02}
"""


def test_three_turns_of_a_pinion_are_a_cycle() -> None:
    """Its orders are thirds of the crank's, its efforts, too; the wheel has no inertia, so that the
    flywheel at the pinion needs a ninth of the crank's, less the pinion's."""
    lines = GEARED.splitlines()
    alone = "\n".join(
        line for line in lines if not line.startswith(("  motor:", "  M:", "couplings"))
    )
    alone = alone.replace(
        "M.theta: {from: 0, to: 1080, count: 73, rate: 30",
        "O.theta: {from: 0, to: -360, count: 73, rate: -10",
    )
    alone = alone.replace("M.effort", "O.effort").replace("1/3, 2/3, 1]", "1, 2, 3]")
    one, other = (mk.loads(text).analyze().balances for text in (GEARED, alone))
    np.testing.assert_allclose(
        one["h"]["cosine"], -other["h"]["cosine"] / 3.0, rtol=1e-9, atol=1e-12
    )
    np.testing.assert_allclose(one["h"]["sine"], other["h"]["sine"] / 3.0, rtol=1e-9, atol=1e-12)
    wheels = one["w"]["flywheel"][0], other["w"]["flywheel"][0]
    assert wheels[0] == pytest.approx(wheels[1] / 9.0 - 40.0, rel=1e-9)


def test_a_turn_of_a_pinion_is_no_cycle() -> None:
    result = mk.loads(
        GEARED.replace("to: 1080", "to: 360").replace("1/3, 2/3, 1]", "1, 2, 3]")
    ).analyze()
    assert any(
        d.code == "cycle-not-closed" and "not back at the last row" in d.message
        for d in result.diagnostics
    )


@pytest.mark.parametrize("seed", [0, 1, 3, 5, 8])
def test_the_dense_system_of_coefficients_has_what_couplings_transmit(seed: int) -> None:
    model = mk.loads(text_of(draw(seed))[0])
    result = model.analyze()
    system = dense_system(result.result, 1)
    assert {u.group for u in system.unknowns} == set(unknown_names(model.problem))
    matrix, right = np.array(system.coefficients), np.array(system.right)
    values, *_ = np.linalg.lstsq(
        matrix, right, rcond=None
    )  # a loop in a plane is redundant in space
    np.testing.assert_allclose(matrix @ values, right, atol=1e-9)
    for unknown, value in zip(system.unknowns, values, strict=True):
        if unknown.rank == 4:
            assert value == pytest.approx(result[unknown.name][1], rel=1e-9, abs=1e-9)
