"""A slider-crank whose block is driven from the upright crank to where crank and rod align."""


def pump(torque: str, parameters: str = "") -> str:
    """The file: a torque on the crank, rows at 0 to 40 mm, `parameters` beside r and l."""
    return f"""
format: 1
name: pump
plane: xy
units: {{length: mm, angle: deg}}
parameters: {{r: 30 mm, l: 50 mm{parameters}}}
links: {{crank: {{}}, rod: {{}}, block: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  B: {{type: R, links: [crank, rod], point: [0, r]}}
  C: {{type: R, links: [rod, block], point: ["sqrt(l^2 - r^2)", 0]}}
  D: {{type: P, links: [ground, block], point: ["sqrt(l^2 - r^2)", 0], axis: [1, 0]}}
motion:
  inputs:
    D.s: {{values: [0 mm, 10 mm, 20 mm, 30 mm, 40 mm], rate: 100 mm/s}}
loads:
  - {{type: torque, link: crank, torque: {torque}}}
"""
