"""Responses of which more than the rows of a block must be known: their rows are `count: 41`."""

from __future__ import annotations

from response.motions import PLANAR

REDUNDANT = (
    PLANAR.replace("  - LOAD\n", "").replace("[0.3, 0.3, 0]", "[0.3, 0.3, 0.1]")
    + """\
responses: {run: {start: {A.theta: 0, A.theta_dot: 3 rad/s}, time: {from: 0, to: 2, count: 41}}}
tables:
  - {name: t, run: run, columns: [time, D.theta, B.force.x, B.force.z, C.moment.x, norm(D.force)]}
"""
)
"""Which reactions are unique is told by others in equilibrium."""

BENT = """format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  wheel: {mass: 1, center_of_mass: [0, 0], inertia: 0.5}
  slide: {mass: 1, center_of_mass: [0, 0]}
joints:
  A: {type: R, links: [ground, wheel], point: [0, 0]}
  B: {type: P, links: [ground, slide], point: [0, 0], axis: [1, 0]}
couplings:
  K: {type: function, of: A.theta, gives: B.s, value: "0.3 m/rad*abs(theta - 0.1 rad)"}
loads: [{type: torque, joint: A, value: 1}]
responses: {r: {start: {A.theta: -1, A.theta_dot: 1}, time: {from: 0, to: 2, count: 41}}}
tables: [{name: t, run: r, columns: [time, A.theta, B.s_dot, K.force, row.status]}]
"""
"""The slope of a function jumps where the motion may come to."""
