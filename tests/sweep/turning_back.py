"""Mechanisms whose listed inputs come to a dead centre or a branch point, and back."""

from __future__ import annotations

SLIDER_CRANK = """format: 1
plane: xy
units: {{length: m, angle: deg}}
links: {{crank: {{}}, rod: {{}}, slider: {{}}}}
joints:
  O: {{type: R, links: [ground, crank], point: [0, 0]}}
  A: {{type: R, links: [crank, rod], point: [{ax!r}, {ay!r}]}}
  B: {{type: R, links: [rod, slider], point: [{x!r}, 0]}}
  S: {{type: P, links: [ground, slider], point: [{x!r}, 0], axis: [1, 0]}}
motion: {{inputs: {{S.s: {{values: {values}}}}}}}
"""
FOUR_BAR = """format: 1
plane: xy
units: {{length: m, angle: rad}}
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  B: {{type: R, links: [crank, coupler], point: [{bx!r}, {by!r}]}}
  C: {{type: R, links: [coupler, rocker], point: [{cx!r}, {cy!r}]}}
  D: {{type: R, links: [ground, rocker], point: [{d!r}, 0]}}
motion: {{inputs: {{A.theta: {{values: {values}}}}}}}
"""
