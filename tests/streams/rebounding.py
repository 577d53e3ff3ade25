"""Responses with impacts and rests at limits, whose time is written `TIME`, with a table of what
limits act on."""

from __future__ import annotations

from limits.machines import TOGETHER
from streams.motions import BENT, REDUNDANT

HEAD = """format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
"""
WORK = "row.event, row.work, row.dissipated, row.energy_error"
BALL = (
    HEAD
    + f"""\
links: {{ball: {{mass: 2, center_of_mass: [0, 0]}}}}
joints: {{S: {{type: P, links: [ground, ball], point: [0, 0], axis: [0, 1]}}}}
loads: [{{type: gravity, g: [0, -10]}}]
limits: {{S.s: {{min: 0, restitution: 0.5}}}}
responses: {{r: {{start: {{S.s: 2, S.s_dot: 0}}, time: TIME}}}}
tables: [{{name: t, run: r, columns: [time, S.s, S.s_dot, S.effort, {WORK}]}}]
"""
)
"""It bounces to rest."""

SPRING = (
    HEAD
    + f"""\
links: {{slider: {{mass: 2, center_of_mass: [0, 0]}}}}
joints: {{S: {{type: P, links: [ground, slider], point: [0, 0], axis: [1, 0]}}}}
loads: [{{type: spring, joint: S, coordinate: s, stiffness: 50, free: 0.02}}]
limits: {{S.s: {{min: -0.1, max: 0.15, restitution: 0.8}}}}
responses: {{r: {{start: {{S.s: 0, S.s_dot: 2}}, time: TIME}}}}
tables: [{{name: t, run: r, columns: [time, S.s, S.s_dot, S.effort, {WORK}]}}]
"""
)
"""Between two limits; it comes to both again and again, and then to none."""

ENDING = (
    HEAD
    + f"""\
links: {{slider: {{mass: 2, center_of_mass: [0, 0]}}, other: {{mass: 1, center_of_mass: [0, 0]}}}}
joints:
  S: {{type: P, links: [ground, slider], point: [0, 0], axis: [1, 0]}}
  X: {{type: P, links: [ground, other], point: [0, 0], axis: [1, 0]}}
loads: [{{type: spring, joint: S, coordinate: s, stiffness: 50, free: 0.02}}]
limits: {{S.s: {{min: -0.1, max: 0.15, restitution: 0.9}}, X.s: {{max: 0.3}}}}
responses:
  r: {{start: {{S.s: 0, S.s_dot: 2, X.s: 0, X.s_dot: 0.1}}, time: TIME}}
tables: [{{name: t, run: r, columns: [time, S.s, X.s, S.effort, {WORK}]}}]
"""
)
"""Beside it another one comes to a limit without restitution, which ends the motion."""

PLATFORM = (
    HEAD
    + f"""\
links:
  platform: {{mass: 3, center_of_mass: [0, 0]}}
  mass: {{mass: 2, center_of_mass: [0, 0]}}
joints:
  P: {{type: P, links: [ground, platform], point: [0, 0], axis: [0, 1]}}
  S: {{type: P, links: [platform, mass], point: [0, 0], axis: [0, 1]}}
loads: [{{type: gravity, g: [0, -10]}}]
limits: {{S.s: {{min: 0, restitution: 0}}}}
responses:
  r:
    start: {{S.s: 0}}
    driven: {{P.s: {{law: sine, amplitude: 0.1, frequency: 2 Hz}}}}
    time: TIME
tables: [{{name: t, run: r, columns: [time, P.s, S.s, S.s_dot, S.effort, P.effort, {WORK}]}}]
"""
)
"""A platform that throws off what rests on it, turn after turn."""

LIFTED = BALL.replace("restitution: 0.5", "restitution: 0").replace(
    "{S.s: 2, S.s_dot: 0},", '{S.s: 0}, efforts: {S.s: "30 N*sin(2*pi*time/(1 s))"},'
)
"""A force that lifts it off its limit turn after turn, so that it rests in between."""

SPRUNG = (
    PLATFORM.replace("{mass: 3,", "{mass: 1000,")
    .replace(
        "loads: [",
        "loads: [{type: spring, joint: P, coordinate: s, stiffness: 158000, free: 0.06}, ",
    )
    .replace("    driven: {P.s: {law: sine, amplitude: 0.1, frequency: 2 Hz}}\n", "")
    .replace("start: {S.s: 0}", "start: {P.s: -0.1, S.s: 0}")
    .replace(" P.effort,", "")
)
"""The same on a spring, so heavy that it is not driven."""

SHARED = (
    TOGETHER.format(one=", restitution: 0.5", other=", restitution: 0.5")
    .replace("MORE", "")
    .replace("fall:", "r:")
    .replace("{from: 0, to: 8, step: 0.1}", "TIME")
    + f"""\
tables:
  - {{name: t, run: r, columns: [time, X.s, S.s, S.effort, T.effort, S.force.y, X.force.y, {WORK}]}}
"""
)
"""Two limits end one freedom, whose shares of the force are not unique."""

RUBBING = (
    HEAD
    + f"""\
links:
  carriage: {{mass: 3, center_of_mass: [0, 0]}}
  block: {{mass: 2, center_of_mass: [0, 0]}}
joints:
  X: {{type: P, links: [ground, carriage], point: [0, 0], axis: [1, 0]}}
  Y: {{type: P, links: [carriage, block], point: [0, 0], axis: [0, 1]}}
loads:
  - {{type: gravity, g: [0, -10]}}
  - {{type: friction, joint: X, coefficient: 0.1}}
limits: {{Y.s: {{min: -2, restitution: 0.4}}}}
responses:
  r:
    start: {{X.s: 0, X.s_dot: 3, Y.s: 0}}
    time: TIME
    stop: [STOP]
tables: [{{name: t, run: r, columns: [time, X.s, X.s_dot, Y.s, Y.effort, X.force.y, {WORK}]}}]
"""
)
"""A carriage that rubs, and more so while what bounces on it lies on its limit."""

PENDULUM = (
    HEAD
    + f"""\
links:
  upper: {{mass: 2, center_of_mass: [0, -0.5], inertia: 0.2}}
  lower: {{mass: 1, center_of_mass: [0, -1.4], inertia: 0.05}}
joints:
  A: {{type: R, links: [ground, upper], point: [0, 0]}}
  B: {{type: R, links: [upper, lower], point: [0, -1]}}
loads: [{{type: gravity, g: [0, -9.81]}}, {{type: torque, joint: B, value: 6}}]
limits:
  A.theta: {{min: -0.5, restitution: 0.5}}
  B.theta: {{min: -0.3, max: 0.8, restitution: 0}}
responses: {{r: {{start: {{A.theta: 0.9, B.theta: 0.3, B.theta_dot: 3}}, time: TIME}}}}
tables: [{{name: t, run: r, columns: [time, A.theta, B.theta, B.effort, A.force.x, {WORK}]}}]
"""
)
"""Rests of one arm while the other swings to its own limit."""


def timed(text: str, to: float, count: int, stop: str = "") -> str:
    """A text with so many rows up to a moment in s."""
    return text.replace("TIME", f"{{from: 0, to: {to}, count: {count}}}").replace("STOP", stop)


DWELLS = """driven:
      P.s:
        law: sequence
        from: 0
        segments:
          - {for: 0.3, to: 0.2, law: cycloidal}
          - {for: 0.3, law: dwell}
          - {for: 0.3, to: 0, law: cycloidal}
          - {for: 0.3, law: dwell}
          - {for: 0.3, to: 0.2, law: harmonic}
          - {for: 0.3, law: dwell}
          - {for: 1.2, to: 0, law: harmonic}"""

TEXTS = {
    "a ball that comes to rest": timed(BALL, 3, 61),
    # thrown up with 4.5 m/s it is back after 0.9 s, at the last row of a block of 10
    "an impact at a row": timed(BALL.replace("S.s: 2, S.s_dot: 0", "S.s: 0, S.s_dot: 4.5"), 3, 31),
    "an impact at a border": timed(BALL.replace("S.s: 2, S.s_dot: 0", "S.s: 0, S.s_dot: 5"), 3, 31),
    "a rest from a row on": timed(
        BALL.replace("S.s: 2, S.s_dot: 0", "S.s: 0, S.s_dot: 4.5").replace("0.5}", "0}"), 3, 31
    ),
    "many impacts between rows": timed(BALL, 4, 9),
    "a ball that begins at rest": timed(BALL.replace("S.s: 2", "S.s: 0"), 1, 23),
    "a ball that begins with an impact": timed(
        BALL.replace("S.s: 2, S.s_dot: 0", "S.s: 0, S.s_dot: -3"), 1, 23
    ),
    "a slider between two limits": timed(SPRING, 4, 81),
    "a mass that is thrown off": timed(PLATFORM, 3, 91),
    "a mass that is lifted off": timed(LIFTED, 4, 81),
    "a mass on a sprung platform": timed(SPRUNG, 3, 91),
    "limits that share a force": timed(SHARED, 6, 61),
    "friction": timed(RUBBING, 3, 61),
    "a stop behind impacts": timed(RUBBING, 3, 61, "{value: X.s, at: 2}"),
    "rests beside a motion": timed(PENDULUM, 3, 121),
    "a platform that stands in between": timed(PLATFORM, 3, 91).replace(
        "driven: {P.s: {law: sine, amplitude: 0.1, frequency: 2 Hz}}", DWELLS
    ),
    "a slope that jumps behind an impact": BENT.replace(
        "{A.theta: -1, A.theta_dot: 1}", "{A.theta: -1, A.theta_dot: -1}"
    ).replace("loads:", "limits: {A.theta: {min: -1.2, restitution: 0.5}}\nloads:"),
    "redundant constraints": REDUNDANT.replace(
        "responses:", "limits: {D.theta: {min: -0.2, max: 0.3, restitution: 0.3}}\nresponses:"
    )
    .replace("responses: {run:", "responses: {r:")
    .replace("run: run", "run: r"),
    "a limit without restitution behind impacts": timed(ENDING, 4, 81),
}
