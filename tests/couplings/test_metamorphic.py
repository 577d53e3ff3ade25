"""What must not change an answer: mechanisms with couplings on a drawing that is turned and
shifted, in other units, with other names, and with their joints and links in another order."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np
import pytest

import mechkin_cli as mk

COUPLINGS = {
    "gear": (
        "G: {{type: gear, joints: [{A}, {B}], teeth: [20, 45], pressure_angle: 0.35 rad}}",
        "R",
    ),
    "belt": ("G: {{type: belt, joints: [{A}, {B}], radii: [15 mm, 35 mm]}}", "R"),
    "crossed belt": (
        "G: {{type: belt, joints: [{A}, {B}], radii: [15 mm, 35 mm], crossed: true}}",
        "R",
    ),
    "linear": ("G: {{type: linear, terms: {{{A}.theta: 2, {B}.theta: 3}}}}", "R"),
    "rack": ("G: {{type: rack, joints: [{A}, {B}], radius: 20 mm, pressure_angle: 0.35 rad}}", "P"),
    "function": (
        "G: {{type: function, of: {A}.theta, gives: {B}.s, "
        'value: "12 mm*(1 - cos({A}.theta)) + 3 mm*sin(2*{A}.theta)"}}',
        "P",
    ),
}
NAMES = {"A": "A", "B": "B", "one": "one", "two": "two"}
OTHER_NAMES = {"A": "drive", "B": "Zylinder", "one": "wheel", "two": "a_part"}


def text_of(
    name: str,
    *,
    turn: float = 0.0,
    shift: Sequence[float] = (0.0, 0.0),
    names: dict[str, str] = NAMES,
    backwards: bool = False,
    units: str = "{length: mm, angle: rad, mass: kg, force: N}",
) -> str:
    """A file with one coupling between A and B, drawn turned about the origin and then shifted."""
    coupling, letter = COUPLINGS[name]

    def way(x: float, y: float, unit: str = "") -> str:
        u, v = cos(turn) * x - sin(turn) * y, sin(turn) * x + cos(turn) * y
        return f"[{u!r}{unit}, {v!r}{unit}]"

    def place(x: float, y: float) -> str:
        u, v = cos(turn) * x - sin(turn) * y, sin(turn) * x + cos(turn) * y
        return f"[{u + shift[0]!r} mm, {v + shift[1]!r} mm]"

    # a rack above its pinion slides along x
    at_b = place(65.0, 0.0) if letter == "R" else place(0.0, 20.0)
    axis = "" if letter == "R" else f", axis: {way(1.0, 0.0)}"
    links = [
        f"  {names['one']}: {{mass: 0.4 kg, center_of_mass: {place(4, 3)}, inertia: 2e-4 kg*m^2}}",
        f"  {names['two']}: {{mass: 0.7 kg, center_of_mass: {place(61, 5)}, inertia: 5e-4 kg*m^2}}",
    ]
    joints = [
        f"  {names['A']}: {{type: R, links: [ground, {names['one']}], point: {place(0, 0)}}}",
        f"  {names['B']}: {{type: {letter}, links: [ground, {names['two']}], point: {at_b}{axis}}}",
    ]
    if backwards:
        links.reverse()
        joints.reverse()
    force = way(30.0, -50.0, " N")
    return "\n".join(
        [
            "format: 1\nplane: xy",
            f"units: {units}",
            "links:",
            *links,
            "joints:",
            *joints,
            "couplings:",
            "  " + coupling.format(**names),
            "loads:",
            f"  - {{type: force, link: {names['two']}, point: {place(70, 20)}, force: {force}}}",
            "motion:",
            f"  inputs: {{{names['A']}.theta: {{from: 0 rad, to: 1.2 rad, count: 7, "
            "rate: 8 rad/s, acceleration: 5 rad/s^2, jerk: 3 rad/s^3}}",
        ]
    )


def scalars(name: str, names: dict[str, str]) -> list[str]:
    letter = COUPLINGS[name][1]
    coordinate = "theta" if letter == "R" else "s"
    follows = [f"{names['B']}.{coordinate}{order}" for order in ("", "_dot", "_ddot", "_dddot")]
    return [*follows, f"{names['A']}.effort", "G.power"]


def alike(one: object, other: object) -> None:
    known = np.asarray(one)
    size = max(float(np.abs(known).max()), 1e-12)
    np.testing.assert_allclose(np.asarray(other), known, rtol=1e-10, atol=1e-11 * size)


@pytest.mark.parametrize("name", COUPLINGS)
def test_a_drawing_turned_and_shifted(name: str) -> None:
    """Coordinates, effort and power are the same; bearings turn with the drawing."""
    turn = 2.1
    one = mk.loads(text_of(name)).analyze()
    other = mk.loads(text_of(name, turn=turn, shift=(37.0, -81.0))).analyze()
    assert set(one["row.status"]) == {"ok"} == set(other["row.status"])
    for quantity in scalars(name, NAMES):
        alike(one[quantity], other[quantity])
    c, s = cos(turn), sin(turn)
    for joint in "AB":
        force = np.asarray(one[f"{joint}.force"])
        alike(force @ np.array([[c, s], [-s, c]]), other[f"{joint}.force"])


@pytest.mark.parametrize("name", COUPLINGS)
def test_other_names_and_another_order(name: str) -> None:
    one = mk.loads(text_of(name)).analyze()
    other = mk.loads(text_of(name, names=OTHER_NAMES, backwards=True)).analyze()
    for quantity, known in zip(scalars(name, OTHER_NAMES), scalars(name, NAMES), strict=True):
        alike(one[known], other[quantity])
    for joint in "AB":
        alike(one[f"{joint}.force"], other[f"{OTHER_NAMES[joint]}.force"])


UNITS = "{length: in, angle: deg, mass: lbm, force: lbf}"
INCH, POUND_FORCE = 25.4, 0.45359237 * 9.80665


@pytest.mark.parametrize("name", COUPLINGS)
def test_other_units(name: str) -> None:
    """In inches, degrees, pounds and pounds of force."""
    one = mk.loads(text_of(name)).analyze()
    other = mk.loads(text_of(name, units=UNITS)).analyze()
    place, *rates, effort, _ = scalars(name, NAMES)
    slides = place.endswith(".s")
    alike(one[place], np.asarray(other[place]) * (INCH if slides else pi / 180.0))
    for quantity in rates:
        alike(one[quantity], np.asarray(other[quantity]) * (INCH if slides else 1.0))
    alike(one[effort], np.asarray(other[effort]) * INCH * POUND_FORCE)
    for joint in "AB":
        alike(one[f"{joint}.force"], np.asarray(other[f"{joint}.force"]) * POUND_FORCE)
