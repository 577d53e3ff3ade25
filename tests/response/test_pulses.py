"""A load that comes and goes while nothing else happens is not passed over."""

from math import pi, sqrt
from pathlib import Path

import pytest

import mechkin_cli as mk

FILE = """\
format: 1
name: a pulse on a mass at rest
units: {{length: m, angle: rad, mass: kg, force: N}}
links:
  m: {{mass: 2, center_of_mass: [0, 0, 0], inertia: {{xx: 1, yy: 1, zz: 1}}}}
joints:
  A: {{type: P, links: [ground, m], point: [0, 0, 0], axis: [1, 0, 0]}}
loads:
  - type: force
    joint: A
    value: "3 N*exp(-((time - 5 s)/({width} s))*((time - 5 s)/({width} s)))"
responses:
  r: {{start: {{A.s: 0}}, time: {{from: 0, to: 10, step: {step}}}}}
"""


@pytest.mark.parametrize(("width", "step"), [(0.05, 0.1), (0.003, 0.003), (0.3, 10.0)])
def test_a_pulse_gives_its_impulse(tmp_path: Path, width: float, step: float) -> None:
    path = tmp_path / "pulse.yaml"
    path.write_text(FILE.format(width=width, step=step))
    rows = mk.load(path).respond("r", tables=[])
    assert rows["A.s_dot"][-1] == pytest.approx(3.0 * width * sqrt(pi) / 2.0, rel=1e-8)
