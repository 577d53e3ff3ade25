"""Loads by laws of time, place and rate, and springs, in random mechanisms: every quantity lies in
its enclosure. The oracle has neither springs nor time; it is given the same forces as laws of the
coordinates."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from mpmath import mp
from oracle import assemble, newton_euler, read
from properties.cases import case
from properties.expected import expected
from properties.test_enclosures import enclosures, outside

import mechkin_cli as mk

ROW = 3
RATE, BEGIN, END = "2 deg/s", "-4 deg", "4 deg"
SHARED = """
- type: force
  link: L1
  point: [0.1, 0.2, -0.3]
  force: [2 N*sin(3 rad*p1.position.x/(1 m)), 1 N*p2.velocity.y/(1 m/s), 1.3 N*cos(2*D.theta)]
- {type: torque, link: L2, torque: [0.7 N*m*p1.position.y*L1.omega.z/(1 m)/(1 rad/s), 0, 0.2]}
"""
OF_TIME = "- {type: torque, link: L2, torque: [3 N*m*sin(1.3 rad*(TIME)/(1 s)), 0, 0.1 N*m]}\n"
TIME = {"package": "time", "oracle": "(D.theta + 4 deg)/(2 deg/s)"}
POST = (0.9, -1.1, 0.7)
SPRING = "- {type: spring, between: [post, p1], stiffness: 33.3 N/m, free: 0.31 m}\n"
LENGTH = "sqrt({}^2 + {}^2 + {}^2)".format(*(f"(p1.position.{c} - {{}} m)" for c in "xyz")).format(
    *POST
)


def line_force() -> str:
    """The spring's force at p1 as a law: k (free - length) along the line from the post."""
    parts = (
        f"33.3 N/m*(0.31 m - {LENGTH})/{LENGTH}*(p1.position.{c} - {place} m)"
        for c, place in zip("xyz", POST, strict=True)
    )
    return f"- {{type: force, link: L1, point: P1, force: [{', '.join(parts)}]}}\n"


@dataclass(frozen=True)
class Loaded:
    """One mechanism with laws: as the package reads it, and as the oracle does."""

    package: str
    oracle: str


def loaded(name: str) -> Loaded:
    text = case(name).text
    driven = re.search(r"inputs:\s+(\S+)\.theta:", text)
    assert driven is not None
    point = re.search(r"p1:\s+link: L1\s+at: (\[[^\]]+\])", text)
    assert point is not None
    head, rest = text.split("motion:")
    loads = rest.split("loads:")[1].rstrip()
    coordinate = f"{driven[1]}.theta"
    motion = {
        "package": f"time: {{from: 0, to: 4, count: 5}}\n  inputs:\n    {coordinate}: "
        f"{{law: constant-rate, at: {BEGIN}, rate: {RATE}}}\n",
        "oracle": f"inputs:\n    {coordinate}: "
        f"{{from: {BEGIN}, to: {END}, count: 5, rate: {RATE}}}\n",
    }
    post = f"points:\n  post: {{link: ground, at: {list(POST)}}}"
    lines = {"package": SPRING, "oracle": line_force().replace("P1", point[1])}

    def made(which: str) -> str:
        laws = SHARED + OF_TIME.replace("TIME", TIME[which]) + lines[which]
        own = head.replace("points:", post) + f"motion:\n  {motion[which]}loads:{loads}"
        return own + laws.replace("D.theta", coordinate)

    return Loaded(made("package"), made("oracle"))


LAWFUL = ("loop 1", "loop 13", "loop 23", "loop 38")
"""Some that are driven by an angle."""


@pytest.mark.parametrize("name", LAWFUL)
def test_forces_of_laws_are_enclosed(name: str) -> None:
    texts = loaded(name)
    mechanism = read(texts.oracle)
    solution = assemble(mechanism, mechanism.row(ROW))
    true = expected(mechanism, solution, newton_euler(mechanism, solution))
    # a spring pulls at ground, too, and stores energy: a law that acts on one link does neither
    of_springs = ("ground.shaking", "row.potential_energy")
    true = {q: value for q, value in true.items() if not q.startswith(of_springs)}
    _, found = enclosures(texts.package)
    wrong, known = outside(true, found, ROW)
    assert wrong == []
    assert known > 50
    loads = [q for q in found if q.endswith((".force", ".moment", ".effort"))]
    for quantity in loads:
        value, radius = found[quantity].high[:, ROW], found[quantity].radius[:, ROW]
        assert (radius <= 1e-12 * np.abs(value).max(initial=1e-6)).all(), quantity


def test_another_law_is_outside() -> None:
    """The check can fail: a spring that is stiffer by 1e-15 of itself."""
    texts = loaded(LAWFUL[0])
    mechanism = read(texts.oracle.replace("33.3 N/m", "33.30000000000003 N/m"))
    solution = assemble(mechanism, mechanism.row(ROW))
    true: dict[str, Any] = expected(mechanism, solution, newton_euler(mechanism, solution))
    _, found = enclosures(texts.package)
    assert len(outside(true, found, ROW)[0]) > 10


ACROSS = """\
format: 1
units: {length: m, angle: deg}
links:
  one: {mass: 2, center_of_mass: [0, 0, 0], inertia: {xx: 0.01, yy: 0.01, zz: 0.02}}
  two: {}
  slider: {mass: 1.5, center_of_mass: [0.45, 0, 0]}
points:
  p: {link: two, at: [0.2, 0, 0]}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [one, two], point: [0.1, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [two, slider], point: [0.45, 0, 0], axis: [0, 0, 1]}
  D: {type: P, links: [ground, slider], point: [0.45, 0, 0], axis: [1, 0, 0]}
motion: {inputs: {A.theta: {values: [ANGLES]}}}
loads:
  - type: force
    link: slider
    point: [0.45, 0, 0]
    force: [0, "100 N*atan2(p.position.y, -0.1 m)/(1 rad)", 0]
"""
NEAR_HALF_A_TURN = [
    *("180.00000000000003", "179.99999999999997", "180.00000000000001", "179.99999999999999"),
    *("180.000000000000001", "179.999999999999999", "180", "181", "179"),
]


def test_an_angle_near_its_cut_has_its_value_on_either_side() -> None:
    """The rod carries nothing, so that the guide takes all of the load; its point p lies 0.1 m of
    0.35 m along it from the crank."""
    text = ACROSS.replace("ANGLES", ", ".join(NEAR_HALF_A_TURN))
    low, high = mk.loads(text).certify().enclosure("D.total_force")
    with mp.workdps(60):
        for row, angle in enumerate(NEAR_HALF_A_TURN):
            # sin(180 deg) is zero, and what mpmath makes of it is not
            sine = mp.mpf(0) if angle == "180" else mp.sin(mp.radians(mp.mpf(angle)))
            end = mp.mpf("0.1") * sine
            true = -100 * mp.atan2(end * (1 - mp.mpf("0.1") / mp.mpf("0.35")), mp.mpf("-0.1"))
            assert mp.mpf(low[row, 1]) <= true <= mp.mpf(high[row, 1]), angle
    # what is off the cut is known well
    assert (high[-2:, 1] - low[-2:, 1] < 1e-10).all()
