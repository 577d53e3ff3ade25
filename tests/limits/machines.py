"""Machines with limits that several modules test."""

from __future__ import annotations

TOGETHER = """
format: 1
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
links:
  bed: {{mass: 1, center_of_mass: [0, 0]}}
  a: {{mass: 2, center_of_mass: [0, 0]}}
  b: {{mass: 3, center_of_mass: [1, 0]}}
joints:
  X: {{type: P, links: [ground, bed], point: [0, 0], axis: [1, 0]}}
  S: {{type: P, links: [bed, a], point: [0, 0], axis: [0, 1]}}
  T: {{type: P, links: [bed, b], point: [1, 0], axis: [0, 1]}}
couplings: {{K: {{type: linear, terms: {{S.s: 1, T.s: -1}}}}}}
loads: [{{type: gravity, g: [0, -10]}}MORE]
limits: {{S.s: {{min: -2{one}}}, T.s: {{min: -2{other}}}}}
responses:
  fall:
    start: {{S.s: 0, X.s: 0, X.s_dot: 0.5}}
    efforts: {{S.s: "20 N*max(0, time/(1 s) - 4)"}}
    time: {{from: 0, to: 8, step: 0.1}}
"""
"""Two blocks that a coupling lets fall as one, each to a limit of its own at the same place."""

PLATFORM = """format: 1
units: {{length: m, angle: rad, mass: kg, force: N}}
links:
  p: {{mass: 1, center_of_mass: [0, 0, 0]}}
  b: {{mass: 2, center_of_mass: [0, 0, 0]}}
joints:
  D: {{type: P, links: [ground, p], point: [0, 0, 0], axis: [0, 0, 1]}}
  S: {{type: P, links: [p, b], point: [0, 0, 0], axis: [0, 0, 1]}}
limits: {{S.s: {{min: 0, restitution: {bounce}}}}}
loads:
  - {{type: gravity, g: [0, 0, -8]}}
  - {{type: force, joint: S, value: "{load}"}}
responses: {{run: {{start: {{S.s: {start}}}, time: {time}, driven: {{D.s: {drive}}}}}}}
tables:
  - {{name: t, run: run, columns: [time, D.s_ddot, S.s_ddot, D.effort, S.effort, row.condition]}}
"""


def on_a_platform(**parts: str) -> str:
    """A mass that rests on a driven platform, or falls onto it."""
    still = {"bounce": "0", "load": "0 N", "start": "0", "drive": "{at: 0}"}
    return PLATFORM.format(**(still | {"time": "{from: 0, to: 3, step: 0.5}"} | parts))
