"""A slider-crank with friction at every joint, without redundant constraints."""

TEXT = """
format: 1
name: slider-crank
units: {length: mm, angle: deg, mass: t, force: N}
links:
  crank: {mass: 0.0005, center_of_mass: [20, 0, 0], inertia: {xx: 0.1, yy: 0.2, zz: 0.2}}
  rod: {mass: 0.0008, center_of_mass: [90, 0, 0], inertia: {xx: 0.2, yy: 1.5, zz: 1.5}}
  piston: {mass: 0.0012, center_of_mass: [180, 0, 0], inertia: {xx: 0.3, yy: 0.3, zz: 0.3}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: C, links: [crank, rod], point: [40, 0, 0], axis: [0, 0, 1]}
  C: {type: S, links: [rod, piston], point: [180, 0, 0]}
  D: {type: P, links: [ground, piston], point: [180, 0, 0], axis: [1, 0, 0]}
motion: {inputs: {A.theta: {from: 10, to: 370, step: 15, rate: 20 rad/s}}}
loads:
  - {type: gravity, g: [0, -9810, 0]}
  - {type: force, link: piston, point: [180, 3, 12], force: [-300, 0, 40]}
  - {type: friction, joint: A, coefficient: 0.12, radius: 8, length: 60, collar: 12}
  - type: friction
    joint: B
    coefficient: {static: 0.15, sliding: 0.1, speed: 80}
    radius: 6
    length: 30
  - {type: friction, joint: C, coefficient: 0.15, radius: 5}
  - {type: friction, joint: D, coefficient: 0.08, length: 70, width: 40, across: [0, 0, 1]}
"""
"""Coherent units: t, mm, N, s."""
