"""Mechanisms whose motion is prescribed elsewhere than where the efforts act, as texts."""

from __future__ import annotations

from references import FILE_OF

POSE = ("x", "y", "z", "rz", "ry", "rx")
LEGS = tuple(f"L{k}.s" for k in range(1, 7))

ARM = """
format: 1
name: arm
units: {length: m, angle: rad, mass: kg, force: N}
links:
  one: {mass: 2, center_of_mass: [0.5, 0, 0], inertia: {xx: .1, yy: .2, zz: .3}}
  two: {mass: 1, center_of_mass: [1.4, 0, 0.05], inertia: {xx: .05, yy: .1, zz: .12, xz: .01}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [one, two], point: [1, 0, 0], axis: [0, 0, 1]}
points: {tip: {link: two, at: [1.8, 0, 0]}}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - {type: force, link: two, point: [1.8, 0, 0], force: [3, -20, 0]}
assembly: {near: {A.theta: -0.2, B.theta: 1.3}}
"""
"""Two links of 1 m and 0.8 m on parallel pins."""

FIVE_BAR = """
format: 1
name: five-bar
units: {length: m, angle: deg, mass: kg, force: N}
links:
  one: {mass: 1, center_of_mass: [-.1, .15, 0], inertia: {xx: .01, yy: .01, zz: .01}}
  two: {mass: 2, center_of_mass: [0.05, .4, 0], inertia: {xx: .02, yy: .02, zz: .02}}
  three: {mass: 1.5, center_of_mass: [.35, .4, 0], inertia: {xx: .03, yy: .03, zz: .03}}
  four: {mass: 1, center_of_mass: [.5, .15, 0], inertia: {xx: .01, yy: .01, zz: .01}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [one, two], point: [-.2, .3, 0], axis: [0, 0, 1]}
  C: {type: S, links: [two, three], point: [.2, .55, 0]}
  D: {type: C, links: [three, four], point: [.6, .3, 0], axis: [0, 0, 1]}
  E: {type: R, links: [ground, four], point: [.4, 0, 0], axis: [0, 0, 1]}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
motion:
  inputs:
    A.theta: {from: -10, to: 10, count: 5, rate: 2 rad/s, acceleration: 3}
    E.theta: {from: 15, to: -5, count: 5, rate: -1 rad/s, acceleration: -2}
"""
"""Closed by a ball and a sleeve, so that no constraint is redundant."""

SLIDER_CRANK = """
format: 1
name: slider-crank
units: {length: m, angle: deg, mass: kg, force: N}
links:
  one: {mass: 2, center_of_mass: [0.05, 0.01, 0], inertia: {xx: 0.02, yy: 0.02, zz: 0.02}}
  two: {mass: 1, center_of_mass: [0.3, 0, 0], inertia: {xx: 0.01, yy: 0.01, zz: 0.01}}
  slider: {mass: 1.5, center_of_mass: [0.45, 0, 0]}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [one, two], point: [0.1, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [two, slider], point: [0.45, 0, 0], axis: [0, 0, 1]}
  D: {type: P, links: [ground, slider], point: [0.45, 0, 0], axis: [1, 0, 0]}
points: {wrist: {link: slider, at: [0.45, 0, 0]}, pin: {link: two, at: [0.1, 0, 0]}}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
"""

GEARED = """
format: 1
name: geared
units: {length: m, angle: rad, mass: kg, force: N}
links:
  one: {mass: 1, center_of_mass: [0.3, 0, 0], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
  two: {mass: 2, center_of_mass: [2, 0.4, 0], inertia: {xx: 0.2, yy: 0.2, zz: 0.2}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [ground, two], point: [2, 0, 0], axis: [0, 0, 1]}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
motion:
  inputs:
    A.theta: {from: 0, to: 2, count: 5, rate: 3 rad/s, acceleration: 1}
    B.theta: {with: 2*A.theta + 0.1*sin(A.theta)*1 rad, drive: DRIVE}
"""
"""Two arms that a belt of varying ratio joins."""


def platform(inputs: str, actuators: str = "") -> str:
    """The Stewart platform with its pose as coordinates, and other inputs."""
    text = FILE_OF["stewart"].read_text(encoding="utf-8")
    head = text[: text.index("motion:")].replace("angle: deg", "angle: rad")
    pose = "  pose: {type: F, links: [ground, platform], point: [0.02, 0.01, h]}\n\npoints:"
    head = head.replace("points:", pose, 1)
    load = "loads:\n  - {type: gravity, g: [0, 0, -9.81]}\n"
    return f"{head}motion:\n  inputs:\n{inputs}{load}{actuators}"
