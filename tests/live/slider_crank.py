"""A slider-crank with parameters whose responses a page computes."""

from __future__ import annotations

SLIDER = """\
format: 1
name: slider-crank with a spring
units: {length: mm, angle: deg}
parameters: {a: 100 mm, b: 300 mm, k: 40 N/m, start: 60 deg, torque: 0.4 N*m, w: 2 rad/s}
links:
  crank: {mass: 1, center_of_mass: [a/2, 0, 0], inertia: {xx: 1000, yy: 1000, zz: 1000}}
  rod: {mass: .5, center_of_mass: [a + b/2, 0, 0], inertia: {xx: 1000, yy: 4000, zz: 4000}}
  slider: {mass: .7, center_of_mass: [a + b, 0, 0], inertia: {xx: 1000, yy: 1000, zz: 1000}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, rod], point: [a, 0, 0], axis: [0, 0, 1]}
  C: {type: S, links: [rod, slider], point: [a + b, 0, 0]}
  D: {type: P, links: [ground, slider], point: [a + b, 0, 0], axis: [1, 0, 0]}
loads:
  - {type: gravity, g: [0, -9810, 0]}
  - {type: spring, joint: D, coordinate: s, stiffness: k}
responses:
  swing:
    start: {A.theta: start}
    near: {D.s: -50}
    time: {from: 0, to: 1, step: 0.25}
  until:
    start: {A.theta: start}
    near: {D.s: -50}
    time: {from: 0, to: 2, step: 0.25}
    stop: [{dead_centre: A.theta}]
  off:
    start: {A.theta: start, A.theta_dot: w}
    near: {D.s: -50}
    efforts: {A.theta: torque*cos(A.theta)}
    time: {from: 0, to: 1, step: 0.125}
tables:
  - name: motion
    run: RUN
    columns:
      - {label: t, value: time}
      - {label: theta, value: A.theta}
      - {label: rate, value: A.theta_dot, decimals: 4}
      - {label: s, value: D.s}
      - {label: effort, value: EFFORT}
      - {label: force, value: norm(C.force)}
      - {label: energy, value: row.kinetic_energy + row.work}
      - {label: error, value: row.energy_error}
      - {label: event, value: row.event}
      - {label: status, value: row.status}
"""


def slider_crank(run: str) -> str:
    """The file with a table of one of its responses."""
    effort = "A.effort" if run == "off" else "A.theta_ddot"
    return SLIDER.replace("RUN", run).replace("EFFORT", effort)


FRICTION = """\
  - {type: friction, joint: A, coefficient: 0.1, radius: 5 mm}
  - {type: friction, joint: D, coefficient: 0.2}
"""
STIFF_DAMPER = """\
  - {type: damper, joint: D, coordinate: s, damping: 1e7 N*s/m}
"""


def rubbing_slider_crank() -> str:
    """With friction, and a C for an R: nothing is held twice, so the reactions are unique."""
    text = slider_crank("swing").replace("B: {type: R", "B: {type: C")
    return text.replace("loads:\n", f"loads:\n{FRICTION}", 1)


def stiff_slider_crank() -> str:
    """With a damper so strong that only an implicit method takes long steps."""
    return slider_crank("swing").replace("loads:\n", f"loads:\n{STIFF_DAMPER}", 1)
