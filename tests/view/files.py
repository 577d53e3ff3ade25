"""Mechanism files of these tests, as texts."""

from __future__ import annotations

FOUR_BAR = """
format: 1
name: four-bar
units: {length: mm, angle: deg}
links: {crank: {}, coupler: {}, rocker: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, coupler], point: [20, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [coupler, rocker], point: {coupler: [80, 0, 0], rocker: [70, 50, 0]},
      axis: [0, 0, 1]}
  D: {type: R, links: [ground, rocker], point: [70, 0, 0], axis: [0, 0, 1]}
points: {p: {link: coupler, at: [50, 30, 0]}}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 10, rate: 3 rad/s}}}
assembly: {near: {D.theta: 0}}
tables:
  - {name: curve, columns: [A.theta, p.position.x, p.position.y, p.position.z]}
"""

SLIDER_CRANK = """
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
links: {crank: {}, rod: {}, slider: {mass: 2, center_of_mass: [130, 10, 0]}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, rod], point: [30, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [rod, slider], point: {rod: [130, 0, 0], slider: [130, 10, 0]},
      axis: [0, 0, 1]}
  D: {type: P, links: [ground, slider], point: [130, 10, 0], axis: [1, 0, 0]}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 5, rate: 10 rad/s}}}
assembly: {near: {D.s: 0}}
loads: [{type: gravity, g: [0, -9.81 m/s^2, 0]}]
"""
