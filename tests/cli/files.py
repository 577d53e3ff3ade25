"""Small mechanism files for the command line."""

from references import RCSR

CRANK = """\
format: 1
name: crank
parameters: {r: 2 m}
links: {arm: {mass: 1, center_of_mass: [r, 0, 0]}}
joints: {O: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}
points: {tip: {link: arm, at: [r, 0, 0]}}
motion: {inputs: {O.theta: {from: 0, to: 90, step: 45, rate: 3 rad/s}}}
"""
TABLES = """\
tables:
  - {name: tip, title: The tip, columns: [O.theta, {label: x, value: tip.position.x, decimals: 2}]}
  - {name: drive, columns: [{label: "torque, motor", value: O.effort}]}
"""
"""The arm has no weight and turns steadily: x = r cos(theta), torque 0."""

INVALID = CRANK.replace("links: [ground, arm]", "links: [ground, amr]")
UNPHYSICAL = CRANK.replace("[r, 0, 0]}}\n", "[r, 0, 0], inertia: {xx: 1}}}\n", 1)

WITHOUT_ASSEMBLY = """\
format: 1
links: {crank: {}, rod: {}, slider: {}}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  A: {type: S, links: [crank, rod], point: [0, 1, 0]}
  B: {type: R, links: [rod, slider], point: {rod: [0.5, 0, 0], slider: [9, 9, 0]}, axis: [0, 0, 1]}
  D: {type: C, links: [ground, slider], point: [9, 9, 0], axis: [1, 0, 0]}
motion: {inputs: {O.theta: {from: 0, to: 10, step: 5}}}
"""
"""A rod of 1.118 from a crank of 1 never reaches the slider's line 9 away."""


def beyond_dead_centre() -> str:
    """The RCSR file swept to 210 degrees; its branch ends at 205.14."""
    text = RCSR.read_text(encoding="utf-8")
    assert text.count("to: 202,") == 1
    return text.replace("to: 202,", "to: 210,")
