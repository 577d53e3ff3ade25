"""Mechanisms whose last row, or first, is exactly a dead centre, as files; sizes in mm and deg."""

from __future__ import annotations

FIVE_BAR = """
format: 1
name: five-bar
plane: xy
units: {length: mm, angle: deg, force: N}
parameters: {r: 40 mm, l: 70 mm, d: 100 mm, h: "r + sqrt(l^2 - d^2/4)"}
links: {c1: {}, r1: {}, r2: {}, c2: {}}
joints:
  A: {type: R, links: [ground, c1], point: [0, 0]}
  E: {type: R, links: [ground, c2], point: [d, 0]}
  B: {type: R, links: [c1, r1], point: [0, r]}
  D: {type: R, links: [c2, r2], point: [d, r]}
  C: {type: R, links: [r1, r2], point: [d/2, h]}
motion:
  inputs:
    A.theta: {from: 0, to: 30, count: 4, rate: 1 rad/s}
    E.theta: {from: 0, to: -30, count: 4, rate: -2 rad/s}
loads:
  - {type: force, link: r1, point: [d/2, h], force: [10 N, 20 N]}
"""
"""Cranks of 40 at both ends of 100, rods of 70: they lie in line where the cranks lean apart by 30
degrees each, from upright."""

CRANK_AND_ROCKER = """
format: 1
name: crank and rocker
units: {{length: mm, angle: deg, force: N}}
parameters: {{r: 30 mm, l: 50 mm, R: 20 mm, z0: 10 mm, d: {d} mm, phi: {phi} deg,
  x: d + R*cos(phi), z: z0 + R*sin(phi), c: "acos({cosine})"}}
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{{pair}, links: [crank, coupler], point: [r*cos(c), r*sin(c), 0]}}
  C: {{type: S, links: [coupler, rocker], point: [x, 0, z]}}
  D: {{type: R, links: [ground, rocker], point: [d, 0, z0], axis: [0, -1, 0]}}
motion:
  inputs:
    D.theta: {{values: [{values}], rate: -1 rad/s}}
loads:
  - {{type: torque, link: crank, torque: [0, 0, 3 N*m]}}
tables:
  - name: t
    title: to the dead centre
    columns:
      - {{label: phi, value: D.theta, decimals: 0}}
      - {{label: omega, value: A.theta_dot, decimals: 2}}
      - {{label: M, value: D.effort, decimals: 0}}
    summary: [max, min, mean, rms, range, peak]
"""
PAIRS = {
    "RSSR": ("type: S", 70, "(x^2 + z^2 + r^2 - l^2)/(2*r*x)"),
    "RCSR": ("type: C, axis: [0, 0, 1]", 80, "(x^2 + r^2 - l^2)/(2*r*x)"),
}
"""The pair between crank and coupler, and where the rocker's pivot makes the upright rocker a dead
centre: its end then stands over 70 at 30 (rod of 50, crank of 30: 30 + 40), or, where the coupler
slides along z, over 30 + 50."""


def spatial(kind: str, phi: float = 120.0, values: str = "0, -10, -20, -30", more: str = "") -> str:
    """An RSSR or RCSR driven at its rocker, drawn at the angle `phi`; loads `more`."""
    pair, d, cosine = PAIRS[kind]
    text = CRANK_AND_ROCKER.format(pair=pair, d=d, cosine=cosine, phi=phi, values=values)
    return text.replace("tables:", f"{more}tables:")
