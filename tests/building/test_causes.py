"""Messages at the cause: what is wrong with a parameter is told once, where it is written."""

from __future__ import annotations

import pytest

import mechkin_cli as mk

FILE = """\
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
parameters: {r: 40, n: 3, big: 2 mm}
links:
  crank: {mass: 0.4, center_of_mass: [r/2, 0, 0], inertia: {xx: 80, yy: 20, zz: 90}}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
points:
  a: {link: crank, at: [r, 0, 0]}
  b: {link: crank, at: [2*r + big, r, -r]}
loads:
  - {type: force, link: crank, point: [r, 0, 0], force: [1, 0, 0]}
motion: {inputs: {O.theta: {from: 0, to: n*10 deg, count: 5}}}
"""


def errors_of(text: str) -> str:
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(text)
    return str(caught.value)


def test_a_parameter_without_a_unit_is_told_once() -> None:
    told = errors_of(FILE)
    assert told.count("error:") == 1
    assert "text:3:17: error: r is used as a length and has no unit; write 40 mm" in told
    assert mk.loads(FILE.replace("r: 40", "r: 40 mm")).analyze()["a.position.x"][0] == 40.0


def test_what_is_wrong_otherwise_keeps_its_place() -> None:
    """An angle for a length, and a length lacking another factor, are no matter of a unit."""
    assert "error: expected a length, found an angle" in errors_of(
        FILE.replace("r: 40", "r: 40 deg")
    )
    told = errors_of(FILE.replace("r: 40", "r: 40 mm").replace("at: [r, 0, 0]", "at: [r*r, 0, 0]"))
    assert "text:9:25: error: expected a length, found an area" in told
    told = errors_of(FILE.replace("r: 40", "r: 40 mm").replace("[1, 0, 0]}", "[n*r, 0, 0]}"))
    assert "expected a force, found a length" in told


def test_torsional_stiffness_is_per_angle() -> None:
    spring = "loads:\n  - {type: spring, joint: O, coordinate: theta, stiffness: 5 N*m}"
    told = errors_of(FILE.replace("r: 40", "r: 40 mm").replace("loads:", spring))
    assert "it is per angle: write its unit as N*mm/rad" in told
