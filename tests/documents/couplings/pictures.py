"""A small mechanism with each coupling of `docs/couplings.md`, whose picture the page shows."""

from __future__ import annotations

from typing import Final

import mechkin_cli as mk
from mechkin_cli.view import mechanism_picture

PLANE = "format: 1\nplane: xy\nunits: {length: mm, angle: deg, force: N}\n"
SPACE = "format: 1\nunits: {length: mm, angle: deg, force: N}\n"
MOVED = "motion: {inputs: {A.theta: {from: 0, to: 90, step: 10}}}\n"


def _wheels(distance: float) -> str:
    """Two wheels on the ground."""
    return f"""{PLANE}{MOVED}links: {{one: {{}}, two: {{}}}}
joints:
  A: {{type: R, links: [ground, one], point: [0, 0]}}
  B: {{type: R, links: [ground, two], point: [{distance}, 0]}}
"""


def _in_space(point: str, axis: str) -> str:
    return f"""{SPACE}{MOVED}links: {{one: {{}}, two: {{}}}}
joints:
  A: {{type: R, links: [ground, one], point: [0, 0, 0], axis: [1, 0, 0]}}
  B: {{type: R, links: [ground, two], point: {point}, axis: {axis}}}
"""


def _slide(start: str) -> str:
    return f"""{PLANE}{MOVED}links: {{one: {{}}, bar: {{}}}}
joints:
  A: {{type: R, links: [ground, one], point: [0, 0]}}
  S: {{type: P, links: [ground, bar], point: {start}, axis: [1, 0]}}
"""


SCREW = f"""{SPACE}{MOVED}links: {{one: {{}}, nut: {{}}}}
joints:
  A: {{type: R, links: [ground, one], point: [0, 0, 0], axis: [1, 0, 0]}}
  S: {{type: P, links: [ground, nut], point: [60, 0, 0], axis: [1, 0, 0]}}
points: {{end: {{link: one, at: [90, 0, 0]}}}}
"""
DIFFERENTIAL = f"""{SPACE}motion:
  inputs: {{A.theta: {{from: 0, to: 90, step: 10}}, B.theta: {{with: A.theta/2}}}}
links: {{one: {{}}, two: {{}}, three: {{}}}}
joints:
  A: {{type: R, links: [ground, one], point: [0, 0, 0], axis: [1, 0, 0]}}
  B: {{type: R, links: [ground, two], point: [60, 0, 0], axis: [1, 0, 0]}}
  C: {{type: R, links: [ground, three], point: [120, 0, 0], axis: [1, 0, 0]}}
view:
  shapes:
    one: {{kind: wheel, radius: 30}}
    two: {{kind: wheel, radius: 30}}
    three: {{kind: wheel, radius: 30}}
"""
CAM = f"""{_slide("[48, 0]")}points: {{end: {{link: bar, at: [110, 0]}}}}
"""
HOIST = f"""{PLANE}motion: {{inputs: {{C.s: {{from: 0, to: 40, step: 10}}}}}}
links: {{block: {{mass: 1, center_of_mass: [20, -90]}}, cart: {{}}}}
loads: [{{type: gravity, g: [0, -9.81 m/s^2]}}]
joints:
  B: {{type: P, links: [ground, block], point: [20, -90], axis: [0, 1]}}
  C: {{type: P, links: [ground, cart], point: [110, -60], axis: [0, -1]}}
points:
  a: {{link: ground, at: [0, 0]}}
  b: {{link: block, at: [20, -90]}}
  d: {{link: ground, at: [70, 0]}}
  c: {{link: cart, at: [110, -60]}}
"""
SEVERAL = f"""{PLANE}{MOVED}links: {{one: {{}}, two: {{}}, three: {{}}, four: {{}}}}
joints:
  A: {{type: R, links: [ground, one], point: [0, 0]}}
  B: {{type: R, links: [ground, two], point: [150, 10]}}
  C: {{type: R, links: [ground, three], point: [105, 75]}}
  D: {{type: R, links: [ground, four], point: [60, 130]}}
"""
ROBOT = f"""{SPACE}motion:
  inputs: {{Y.s: {{from: 0, to: 60, step: 10}}, Z.s: {{with: Y.s/2}}}}
links: {{cart: {{}}, body: {{}}, winch: {{}}}}
joints:
  Y: {{type: P, links: [ground, cart], point: [100, 0, -80], axis: [0, 1, 0]}}
  Z: {{type: P, links: [cart, body], point: [100, 0, -80], axis: [0, 0, 1]}}
  S: {{type: P, links: [ground, winch], point: [0, 0, -90], axis: [0, 0, 1]}}
points:
  a: {{link: winch, at: [0, 0, -90]}}
  b: {{link: ground, at: [0, 0, 0]}}
  c: {{link: body, at: [100, 0, -80]}}
"""

PICTURES: Final[dict[str, tuple[str, str, str]]] = {
    "spur": (
        "spur gears",
        _wheels(60),
        "{type: gear, joints: [A, B], teeth: [20, 40], module: 2 mm, pressure_angle: 20 deg}",
    ),
    "ring": (
        "a ring and its pinion",
        _wheels(30),
        "{type: gear, joints: [A, B], teeth: [50, 20], internal: true}",
    ),
    "bevel": (
        "bevel gears",
        _in_space("[0, 50, 0]", "[0, 1, 0]").replace("point: [0, 0, 0]", "point: [20, 0, 0]"),
        "{type: gear, joints: [A, B], teeth: [40, 16], radii: [50 mm, 20 mm]}",
    ),
    "worm": (
        "a worm and its wheel",
        _in_space("[0, 0, -100]", "[0, 1, 0]"),
        "{type: gear, joints: [A, B], teeth: [2, 40], radii: [20 mm, 80 mm], helix: atan(5)}",
    ),
    "rack": (
        "a rack and its pinion",
        _slide("[-10, -20]"),
        "{type: rack, joints: [A, S], radius: 20 mm, pressure_angle: 20 deg}",
    ),
    "belt": (
        "a belt",
        _wheels(150),
        "{type: belt, joints: [A, B], radii: [30 mm, 50 mm], pretension: 200 N}",
    ),
    "crossed": (
        "a crossed belt",
        _wheels(150),
        "{type: belt, joints: [A, B], radii: [30 mm, 50 mm], crossed: true}",
    ),
    "chain": (
        "a chain",
        _wheels(300),
        "{type: chain, joints: [A, B], teeth: [17, 38], pitch: 12.7 mm}",
    ),
    "serpentine": (
        "a belt over several pulleys",
        SEVERAL,
        "{type: belt, joints: [A, B, C, D], radii: [40 mm, 25 mm, 15 mm, 30 mm], outside: [C], "
        "tensioner: C, pretension: 200 N}",
    ),
    "cable": (
        "a cable",
        HOIST,
        "{type: cable, path: [a, {pulley: b, radius: 20 mm, side: right}, "
        "{pulley: d, radius: 30 mm, side: left}, c]}",
    ),
    "swivel": (
        "a pulley that swivels",
        ROBOT,
        "{type: cable, path: [a, {pulley: b, radius: 20 mm, swivel: [0, 0, 1]}, c]}",
    ),
    "tackle": ("a tackle", HOIST, "{type: cable, path: [a, b, a, b, d, c]}"),
    "screw": ("a screw and its nut", SCREW, "{type: screw, joints: [A, S], lead: 5 mm}"),
    "linear": (
        "a differential",
        DIFFERENTIAL,
        "{type: linear, terms: {A.theta: 2, B.theta: -1, C.theta: -1}}",
    ),
    "function": (
        "a function",
        CAM,
        '{type: function, of: A.theta, gives: S.s, value: "10 mm*(1 - cos(2*theta))", '
        "follower: {type: translating, contact: roller, radius: 8 mm, base_radius: 40 mm}}",
    ),
}
"""By file name: what it shows, a mechanism without its coupling, and the coupling."""


def model(name: str) -> mk.Model:
    """The mechanism of a picture."""
    _, text, coupling = PICTURES[name]
    return mk.loads(f"{text}couplings:\n  K: {coupling}\n")


def picture(name: str) -> str:
    """Its first position."""
    made = model(name)
    return mechanism_picture(made.analyze().result, made.view_settings)
