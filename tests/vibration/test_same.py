"""Small motions do not depend on lanes, units, size, mirror, or the joints that are cut."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.kernel.functions import force_width, widths

LOOP = """format: 1
UNITS
links:
  a: {mass: 1, center_of_mass: [0, SIDE*0.05, 0.4], inertia: {xx: 0.02, yy: 0.03, zz: 0.01}}
  b: {mass: 2, center_of_mass: [0.6, SIDE*0.2, 1.1], inertia: {xx: 0.1, yy: 0.2, zz: 0.15}}
  c: {mass: 1.5, center_of_mass: [1.4, SIDE*0.3, 0.7], inertia: {xx: 0.03, yy: 0.02, zz: 0.04}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 1, 0]}
  B: {type: S, links: [a, b], point: [0, SIDE*0.1, 1]}
  C: {type: U, links: [b, c], point: [1.2, SIDE*0.4, 1.4], axis: [0, 1, 0],
      axis2: [SIDE*1, 0, SIDE*1]}
  D: {type: R, links: [ground, c], point: [1.6, SIDE*0.3, 0], axis: [SIDE*0.2, 1, 0]}
loads:
  - {type: gravity, g: [0, 0, -9.81 m/s^2]}
  - {type: spring, joint: A, coordinate: theta, stiffness: 40 N*m/rad, free: 5 deg}
  - {type: damper, joint: D, coordinate: theta, damping: 0.7 N*m*s/rad}
  - {type: bushing, links: [ground, b], point: [0.6, SIDE*0.2, 1.1],
     stiffness: {x: 30 N/m, z: 50 N/m, ry: 3 N*m/rad}, damping: {x: 1.5 N*s/m}}
motion: {inputs: {A.theta: {values: [0, 12 deg]}}}
"""


def text(mirrored: bool = False, units: str = "units: {length: m}") -> str:
    """In the mirror y turns round, and of axes of turns the other two."""
    return LOOP.replace("UNITS", units).replace("SIDE*", "-" if mirrored else "")


def matrices(v: Any) -> list[np.ndarray]:
    return [v.mass, v.damping, v.stiffness, v.frequencies, v.damping_ratios, v.holding]


def test_lanes() -> None:
    """The same bits at every width."""
    found = []
    try:
        for lanes in widths():
            force_width(lanes)
            v = mk.loads(text()).vibration(row=1)
            s = v.state_space(["A.theta"], ["D.theta", "B.force"])
            found.append([*matrices(v), *s.matrices])
    finally:
        force_width(0)
    assert len(found) == len(widths())
    for others in found[1:]:
        for one, other in zip(found[0], others, strict=True):
            assert (one == other).all()


@pytest.mark.parametrize("row", [0, 1])
def test_mirrored(row: int) -> None:
    """What is mirrored swings alike."""
    one, other = (mk.loads(text(mirrored)).vibration(row=row) for mirrored in (False, True))
    assert other.stiffness == pytest.approx(one.stiffness, rel=1e-11)
    assert other.frequencies == pytest.approx(one.frequencies, rel=1e-11)
    assert other.damping_ratios == pytest.approx(one.damping_ratios, rel=1e-10)


def test_units() -> None:
    """Numbers in SI are the same in a file of other units."""
    lengths = text(units="units: {length: m, angle: rad, time: min, force: kN}")
    one, other = mk.loads(text()).vibration(row=1), mk.loads(lengths).vibration(row=1)
    for a, b in zip(matrices(one), matrices(other), strict=True):
        assert b == pytest.approx(a, rel=1e-13)


def test_other_coordinates_of_the_loop() -> None:
    """The drive at A holds the row, whichever coordinate tells the motion."""
    model = mk.loads(text())
    one = model.vibration(row=1)
    for name in ("D.theta", "C.theta1"):
        other = model.vibration(row=1, coordinates=[name])
        assert other.frequencies == pytest.approx(one.frequencies, rel=1e-10), name
        assert other.damping_ratios == pytest.approx(one.damping_ratios, rel=1e-9), name


def test_a_body_on_cables_is_as_heavy_as_it_is() -> None:
    """Its winches are actuators: what holds it along its own coordinates is its weight."""
    file = Path(__file__).parents[2] / "mechanisms" / "couplings" / "cable_robot.yaml"
    v = mk.load(file).vibration("sweep", row=4)
    assert v.mass == pytest.approx(5.0 * np.eye(3), abs=1e-11)
    assert v.holding == pytest.approx([0.0, 0.0, 5.0 * 9.81], abs=1e-10)
