"""Responses with friction: dry, by a speed and of oil films; they slide, stick and break away."""

from __future__ import annotations

from pathlib import Path

from friction.slider_crank import TEXT
from references import FILE_OF

UNITS = "format: 1\nunits: {length: m, angle: rad, mass: kg, force: N}\n"

INCLINE = (
    UNITS
    + """
parameters: {mu: 0.4, more: 0.1, slope: 35 deg, w: 3 m/s, m: 2 kg, push: 2 N/s}
links: {block: {mass: m, center_of_mass: [0, 0, 0]}}
joints: {B: {type: P, links: [ground, block], point: [0, 0, 0], axis: [cos(slope), sin(slope), 0]}}
responses:
  go: {start: {B.s: 0, B.s_dot: w}, efforts: {B.s: push*time}, time: {from: 0, to: 2, step: 0.1}}
loads:
  - {type: gravity, g: [0, -9.80665, 0]}
  - {type: friction, joint: B, coefficient: {static: mu + more, sliding: mu}}
tables:
  - {name: t, run: go, columns: [time, B.s, B.s_dot, B.s_ddot, norm(B.force), row.dissipated]}
"""
)
PENDULUM = (
    UNITS
    + """
parameters: {mu: 0.3, r: 0.2 m, start: 1 rad, l: 1 m, m: 1 kg}
links: {bob: {mass: m, center_of_mass: [0, -l, 0]}}
joints: {A: {type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 0, 1]}}
responses: {go: {start: {A.theta: start}, time: {from: 0, to: 8, step: 0.25}}}
loads:
  - {type: gravity, g: [0, -9.80665, 0]}
  - {type: friction, joint: A, coefficient: mu, radius: r}
tables:
  - name: t
    run: go
    columns: [time, A.theta, A.theta_dot, A.theta_ddot, norm(A.friction_moment), row.dissipated]
"""
)
NUT = (
    UNITS
    + """
parameters: {mu: 0.12, r: 10 mm, pitch: 12 mm, flank: 0.2 rad, twist: 0.1 N*m/s, load: 1 kg}
links: {nut: {mass: load, center_of_mass: [0, 0, 0], inertia: {xx: 0.001, yy: 0.001, zz: 0.001}}}
joints: {H: {type: H, links: [ground, nut], point: [0, 0, 0], axis: [0, 0, 1], lead: pitch}}
loads:
  - {type: gravity, g: [0, 0, -9.81]}
  - {type: friction, joint: H, coefficient: mu, radius: r, flank: flank}
  - {type: torque, joint: H, value: twist*time}
responses: {go: {start: {H.theta: 0, H.theta_dot: 0}, time: {from: 0, to: 4, step: 0.1}}}
tables: [{name: t, run: go, columns: [time, H.theta, H.s, H.theta_dot, row.dissipated]}]
"""
)
STRIBECK = (
    UNITS
    + """
parameters: {oil: 0.03 Pa*s, c: 0.05 mm, r: 20 mm, mu: 0.08, w: 50 rad/s, v: 15 mm/s}
links: {shaft: {mass: 2, center_of_mass: [0, 0, 0], inertia: {xx: 1, yy: 1, zz: 0.0004}}}
joints: {A: {type: R, links: [ground, shaft], point: [0, 0, 0], axis: [0, 0, 1]}}
loads:
  - {type: force, link: shaft, point: [0, 0, 0], force: [3, -4, 0]}
  - type: friction
    joint: A
    law: stribeck
    coefficient: {static: 0.2, sliding: mu, speed: v}
    viscosity: oil
    clearance: c
    radius: r
    length: 40 mm
responses: {go: {start: {A.theta: 0, A.theta_dot: w}, time: {from: 0, to: 0.4, step: 0.02}}}
tables:
  - name: t
    run: go
    columns: [time, A.theta, A.theta_dot, norm(A.friction_moment), row.dissipated]
"""
)
ARM = (
    UNITS
    + """
parameters: {mu: 0.3, r: 0.15 m, l: 0.7 m, first: -2 rad, w: 3 rad/s, m: 2 kg}
links:
  upper: {mass: m, center_of_mass: [0.4, 0, 0], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
  lower: {mass: 1, center_of_mass: [l + 0.3 m, 0, 0], inertia: {xx: 0.05, yy: 0.05, zz: 0.05}}
joints:
  A: {type: R, links: [ground, upper], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [upper, lower], point: [l, 0, 0], axis: [0, 0, 1]}
loads:
  - {type: gravity, g: [0, -9.80665, 0]}
  - {type: friction, joint: A, coefficient: {static: mu + 0.05, sliding: mu}, radius: r}
  - {type: friction, joint: B, coefficient: {static: 0.3, sliding: 0.2}, radius: 0.1}
responses:
  go:
    start: {A.theta: first, B.theta: 0.3, A.theta_dot: w, B.theta_dot: -2 rad/s}
    time: {from: 0, to: 2, step: 0.1}
tables:
  - name: t
    run: go
    columns: [time, A.theta, B.theta, B.theta_dot, norm(A.friction_moment), row.dissipated]
"""
)
CRANK = (
    TEXT.replace("links:\n", "parameters: {mu: 0.12, r: 8 mm, a: 40 mm, w: 30 rad/s}\nlinks:\n", 1)
    .replace("coefficient: 0.12, radius: 8", "coefficient: mu, radius: r")
    .replace("point: [40, 0, 0]", "point: [a, 0, 0]")
    .replace("motion: {inputs: {A.theta: {from: 10, to: 370, step: 15, rate: 20 rad/s}}}\n", "")
    + """
responses: {go: {start: {A.theta: 20, A.theta_dot: w}, time: {from: 0, to: 1, step: 0.05}}}
tables:
  - name: t
    run: go
    columns: [time, A.theta, D.s, A.theta_dot, norm(B.friction_moment), row.dissipated]
"""
)
RCSR = (
    Path(FILE_OF["rcsr_response"])
    .read_text(encoding="utf-8")
    .replace("parameters:\n", "parameters:\n  mu: 0.1\n", 1)
    .replace(
        "directions:\n",
        "loads: [{type: friction, joint: O1, coefficient: mu, radius: 0.2, length: 3}]\n\n"
        "directions:\n",
        1,
    )
)

PUSHED = INCLINE.partition("tables:")[0]
"""Its own tables are those that the command writes by itself, with the effort that is given."""

WAYS = (
    UNITS
    + """
parameters: {mu: 0.3, r: 0.3 m, w: 1.5 m/s, m: 2 kg, first: 0.5 rad}
links:
  a: {mass: m, center_of_mass: [-0.4, 0.3, 0]}
  b: {mass: 1, center_of_mass: [0, 0, -5.5], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
joints:
  A: {type: C, links: [ground, a], point: [0, 0, 0], axis: [3, 4, 0]}
  T: {type: Sp, links: [a, ground], point: [-0.8, 0.6, 0], normal: [0, 0, 1]}
  B: {type: R, links: [ground, b], point: [0, 0, -5], axis: [1, 0, 0]}
loads:
  - {type: gravity, g: [0, 0, -10]}
  - {type: friction, joint: T, coefficient: mu}
  - {type: friction, joint: A, coefficient: mu, radius: r}
responses:
  go:
    start: {A.s: 0, A.s_dot: w, B.theta: first, B.theta_dot: 0}
    time: {from: 0, to: 2, count: 21}
"""
)
"""Of which no table asks for forces, so that nothing is said of what friction leaves undecided."""

RESPONSES = {
    "incline": (INCLINE, "go"),
    "pendulum": (PENDULUM, "go"),
    "nut": (NUT, "go"),
    "stribeck": (STRIBECK, "go"),
    "arm": (ARM, "go"),
    "crank": (CRANK, "go"),
    "rcsr": (RCSR, "response"),
    "pushed": (PUSHED, "go"),
    "ways": (WAYS, "go"),
}
"""The text of a file and its response, by name."""
