"""Coordinates that move by laws while others are free, against dense Newton-Euler equations."""

from __future__ import annotations

import math

import numpy as np
import pytest
from oracle.dynamics.motion import Course
from oracle.dynamics.response import prepare
from response.motions import off, respond

from mechkin_cli.schema.json_schema import json_schema

FILE = """format: 1
name: slider-crank with a pendulum on its slide
units: {{angle: rad}}
links:
  crank: {{mass: 1, center_of_mass: [0.1, 0, 0], inertia: {{zz: 0.01}}}}
  rod: {{mass: 2, center_of_mass: [0.5, 0, 0.05], inertia: {{xx: 0.01, yy: 0.1, zz: 0.1}}}}
  slide: {{mass: 1, center_of_mass: [0.8, 0, 0]}}
  bob: {{mass: 0.7, center_of_mass: [0.8, -0.3, 0.1], inertia: {{xx: 0.02, yy: 0.02, zz: 0.03}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: S, links: [crank, rod], point: [0.2, 0, 0]}}
  C: {{type: U, links: [rod, slide], point: [0.8, 0, 0], axis: [0, 1, 0], axis2: [0, 0, 1]}}
  D: {{type: P, links: [ground, slide], point: [0.8, 0, 0], axis: [1, 0, 0.1]}}
  E: {{type: R, links: [slide, bob], point: [0.8, 0, 0], axis: [0.2, 0.1, 1]}}
loads:
  - {{type: gravity, g: [0, -9.81, 0]}}
  - {{type: damper, joint: E, coordinate: theta, damping: 0.02}}
responses:
  run:
    start: {{E.theta: 0.4}}
    driven: {{A.theta: {law}}}
    time: {{from: 0, to: 1.5, step: 0.25}}
    tolerance: 1e-13
"""


def cycloid(t: float) -> tuple[float, float, float]:
    height, length = 2 * math.pi, 1.5
    u = min(t / length, 1.0)
    turn = 2 * math.pi * u
    return (
        0.3 + height * (u - math.sin(turn) / (2 * math.pi)),
        height * (1 - math.cos(turn)) / length,
        height * 2 * math.pi * math.sin(turn) / length**2,
    )


def quintic(t: float) -> tuple[float, float, float]:
    """A rise by 3-4-5 over half a second, a rest of half a second, and back by a cycloid."""
    if t <= 0.5:
        u = 2.0 * t
        return (
            0.3 + 2.0 * u**3 * (10.0 - 15.0 * u + 6.0 * u * u),
            4.0 * 30.0 * u * u * (1.0 - u) ** 2,
            8.0 * 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u),
        )
    if t <= 1.0:
        return 2.3, 0.0, 0.0
    turn = 4.0 * math.pi * (t - 1.0)
    return (
        2.3 - 2.0 * (2.0 * (t - 1.0) - math.sin(turn) / (2.0 * math.pi)),
        -4.0 * (1.0 - math.cos(turn)),
        -16.0 * math.pi * math.sin(turn),
    )


LAWS: dict[str, Course] = {
    "{law: constant-rate, at: 0.3, rate: 5 rad/s}": lambda t: (0.3 + 5 * t, 5.0, 0.0),
    "{law: polynomial, coefficients: [0.3, 4 rad/s, -1 rad/s^2, 2 rad/s^3]}": lambda t: (
        0.3 + 4 * t - t**2 + 2 * t**3,
        4 - 2 * t + 6 * t**2,
        -2 + 12 * t,
    ),
    f"{{law: cycloidal, from: 0.3, to: {0.3 + 2 * math.pi!r}}}": cycloid,
    "{law: sine, amplitude: 0.5, frequency: 2 Hz, offset: 0.3}": lambda t: (
        0.3 + 0.5 * math.sin(4 * math.pi * t),
        2 * math.pi * math.cos(4 * math.pi * t),
        -8 * math.pi**2 * math.sin(4 * math.pi * t),
    ),
    "{law: sequence, from: 0.3, segments: [{for: 0.5, to: 2.3, law: 3-4-5}, "
    "{for: 0.5, law: dwell}, {for: 0.5, to: 0.3, law: cycloidal}]}": quintic,
}


@pytest.mark.parametrize("law", LAWS)
def test_a_pendulum_on_a_driven_slide(law: str) -> None:
    text = FILE.format(law=law)
    found = respond(text)
    exact = prepare(text, courses={"A.theta": LAWS[law]}).run()
    for name in ("A.theta", "D.s", "E.theta", "C.theta1", "E.theta_dot", "D.s_dot", "E.theta_ddot"):
        assert off(found[name], exact[name]) < 1e-10, name
    for component in "xyz":
        name = f"D.force.{component}"
        assert off(found[name], exact[name]) < 1e-9, name


@pytest.mark.parametrize("law", LAWS)
def test_a_law_counts_from_the_first_moment(law: str) -> None:
    """No load reads the time: the same motion takes place whenever it begins."""
    text = FILE.format(law=law)
    first = respond(text)
    later = respond(text.replace("{from: 0, to: 1.5,", "{from: 0.25, to: 1.75,"))
    assert later["time"][0] == 0.25
    values = [LAWS[law](float(t) - 0.25)[0] for t in later["time"]]
    assert off(later["A.theta"], np.array(values)) < 1e-13
    for name in ("E.theta", "E.theta_dot", "D.s", "D.force.y"):
        assert off(later[name], first[name]) < 1e-10, name


def test_the_format_says_from_when_a_polynomial_counts() -> None:
    found = json_schema()["$defs"]["Polynomial"]
    assert "from the first moment of `time`" in found["properties"]["coefficients"]["description"]


@pytest.mark.parametrize("row", [0.5, 1.0])
def test_a_row_where_a_law_begins_or_ends_tells_of_one_side(row: float) -> None:
    """Its acceleration jumps there: all cells are those of the motion that comes to the row, so the
    powers balance."""
    law = "{law: harmonic, from: 0, to: 1, start: 0.5, duration: 0.5}"
    text = (
        FILE.format(law=law).replace("driven: {A.", "driven: {E.").replace("{E.theta: 0.4}", START)
    )
    text = text.replace("{from: 0, to: 1.5, step: 0.25}", f"{{values: [0, {row}, 1.2]}}")
    found = respond(text)
    just_before = respond(text.replace(f"{row},", f"{row * (1 - 1e-9)!r},"))
    for name in ("E.theta_ddot", "A.theta_ddot", "E.effort", "C.force"):
        assert off(found[name][1], just_before[name][1]) < 1e-6, name
    assert found["row.power_error"][1] < 1e-13


START = "{A.theta: 0.3, A.theta_dot: 1 rad/s}"


def test_a_law_in_a_loop_that_begins_after_the_start() -> None:
    """Before, the loop rests: what the law would be there by its later formula is never asked."""
    law = "{law: harmonic, from: 0.3, to: 1, start: 0.5, duration: 0.5}"
    text = FILE.format(law=law).replace(
        "{from: 0, to: 1.5, step: 0.25}", "{values: [0, 0.4, 0.75]}"
    )
    found = respond(text)
    assert found["A.theta"] == pytest.approx([0.3, 0.3, 0.65], abs=1e-12)
