"""The RCSR mechanism of the dissertation on successive screws, in numbers for the peers and as a
file.

O1 (R) turns the crank, O2 (C) carries the coupler on it, O3 (S) joins the coupler to the rocker,
which turns in O4 (R). Sections 2.6 (kinematics) and 3.4 (kinetostatics); the source's inches stand
here as metres, times a scale.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

RATE = 0.1
"""Rate of the input, rad/s."""

ACCELERATION = 0.2
"""Acceleration of the input, rad/s^2."""

TORQUE = 10.0
"""Torque on the rocker about O4 at scale 1, N m."""

ALPHA1, ALPHA4 = 12, 15
"""Angles of the axes of O2 and O4 against x, degrees."""

MASSES = {"crank": 2.0, "coupler": 5.0, "rocker": 5.0}
"""Masses, kg."""

TENSORS = {
    "crank": {"xx": 0.02, "xy": 0.05, "xz": 0.1},
    "coupler": {"xx": 0.01, "yy": 0.2, "zz": 0.2, "xy": 0.05, "xz": 0.4},
    "rocker": {"xx": 0.02, "yy": 0.3, "zz": 0.4, "xy": 0.5, "xz": 0.2},
}
"""Inertia tensors about the mass centres in the pair axes at scale 1, kg m^2."""

SPAN = (150.0, 202.0)
"""The sweep of the source, degrees of O1."""

JOINTS = ("O1", "O2", "O3", "O4")
COORDINATES = ("O2.theta", "O2.s", "O4.theta")
WRENCHES = tuple(f"{joint}.{part}" for joint in JOINTS for part in ("force", "moment"))
LOADS = ("O1.effort", *WRENCHES)

_TEXT = """\
format: 1
name: RCSR
units: {{length: m, angle: rad, mass: kg, force: N}}
parameters: {{alpha1: {alpha1} deg, alpha4: {alpha4} deg, P1: {P1!r} m, P2: {P2!r} m, P3: {P3!r} m,
  P4: {P4!r} m, s1: {s1!r} m, s4: {s4!r} m, cx: {cx!r} m, cy: {cy!r} m, cz: {cz!r} m}}
links:
  crank: {{mass: {crank!r}, center_of_mass: [cx - s1, cy, cz], inertia: {{{crank_tensor}}}}}
  coupler:
    mass: {coupler!r}
    center_of_mass:
      [cos(alpha1)*cx - sin(alpha1)*cz - s1, cy - P1, sin(alpha1)*cx + cos(alpha1)*cz]
    inertia: {{{coupler_tensor}, axes: {{x: [cos(alpha1), 0, sin(alpha1)], y: [0, 1, 0]}}}}
  rocker:
    mass: {rocker!r}
    center_of_mass:
      [cos(alpha4)*(s4 + cx) + sin(alpha4)*cz, P4 + cy, cos(alpha4)*cz - sin(alpha4)*(s4 + cx)]
    inertia: {{{rocker_tensor}, axes: {{x: [cos(alpha4), 0, -sin(alpha4)], y: [0, 1, 0]}}}}
accept: [unphysical-inertia]
joints:
  O1: {{type: R, links: [ground, crank], point: [-s1, 0, 0], axis: [-1, 0, 0]}}
  O2:
    type: C
    links: [crank, coupler]
    point: [-s1, -P1, 0]
    axis: [-cos(alpha1), 0, -sin(alpha1)]
  O3:
    type: S
    links: [coupler, rocker]
    point: {{coupler: [-s1, -P1 - P2, 0], rocker: [s4*cos(alpha4), P4 + P3, -s4*sin(alpha4)]}}
  O4:
    type: R
    links: [ground, rocker]
    point: [s4*cos(alpha4), P4, -s4*sin(alpha4)]
    axis: [cos(alpha4), 0, -sin(alpha4)]
motion:
  inputs:
    O1.theta: {{{motion}, rate: {rate!r} rad/s, acceleration: {acceleration!r} rad/s^2}}
assembly: {{near: {{O2.theta: -104 deg, O2.s: {near!r}, O4.theta: 37 deg}}}}
loads:
  - {{type: torque, joint: O4, value: {torque!r}}}
"""


MOTOR = """\
  motor: {mass: 1, center_of_mass: [-s1, 0.9 m, 0], inertia: {xx: .01, yy: .01, zz: .01}}
"""
"""A wheel beside the crank, among the links."""

WHEELS = """\
couplings: {G: {type: gear, joints: [M, O1], teeth: [20, 40], pressure_angle: 20 deg}}
joints:
  M: {type: R, links: [ground, motor], point: [-s1, 0.9, 0], axis: [-1, 0, 0]}
"""
"""How it turns the crank, with the head of the joints."""


@dataclass(frozen=True)
class Dimensions:
    """Lengths in m, tensors in kg m^2 and the torque in N m."""

    P1: float
    P2: float
    P3: float
    P4: float
    s1: float
    s4: float
    cx: float
    cy: float
    cz: float
    torque: float
    tensors: dict[str, dict[str, float]]
    near_slide: float

    def text(self, motion: str) -> str:
        """The mechanism file; `motion` gives the values of O1.theta, as `values: [2.6, 2.7]`
        (rad)."""
        return _TEXT.format(
            **{name: value for name, value in vars(self).items() if isinstance(value, float)},
            **MASSES,
            **{f"{link}_tensor": _entries(tensor) for link, tensor in self.tensors.items()},
            alpha1=ALPHA1,
            alpha4=ALPHA4,
            rate=RATE,
            acceleration=ACCELERATION,
            near=self.near_slide,
            motion=motion,
        )


def dimensions(scale: float = 1.0) -> Dimensions:
    """The mechanism with all lengths times `scale`, moments and tensors times its square."""
    square = scale * scale
    return Dimensions(
        P1=0.5 * scale,
        P2=0.8 * scale,
        P3=0.4 * scale,
        P4=0.5 * scale,
        s1=5.0 * scale,
        s4=4.0 * scale,
        cx=0.5 * scale,
        cy=1.0 * scale,
        cz=1.0 * scale,
        torque=TORQUE * square,
        tensors={
            link: {name: value * square for name, value in tensor.items()}
            for link, tensor in TENSORS.items()
        },
        near_slide=-9.0 * scale,
    )


def _entries(tensor: dict[str, float]) -> str:
    return ", ".join(f"{name}: {value!r}" for name, value in tensor.items())


def behind_wheels(motion: str) -> str:
    """The file of RCSR at scale 1 whose crank a motor turns through wheels of 20 and 40 teeth;
    `motion` gives the values of M.theta, -2 times those of O1.theta."""
    law = f"rate: {-2.0 * RATE!r} rad/s, acceleration: {-2.0 * ACCELERATION!r} rad/s^2"
    text = dimensions().text("")
    text = re.sub(r"O1\.theta: \{.*\}", f"M.theta: {{{motion}, {law}}}", text)
    text = text.replace("links:\n", f"links:\n{MOTOR}", 1)
    return text.replace("joints:\n", WHEELS, 1)
