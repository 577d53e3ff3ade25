"""Loops that a drawing grows by: each adds one body, or two in one block, and its rods."""

from __future__ import annotations

import math
import random

import numpy as np
from random_families.no_wrong_row.design import (
    Impossible,
    Seen,
    across,
    on_circle,
    on_line,
    random_unit,
)
from random_families.no_wrong_row.drawing import Column, Drawing, Vector, floats, text
from random_families.no_wrong_row.linkage import GROUND, ORIGIN, Body, Floats, Point, Rod

PLANAR_RODS = (
    ("S", "S"), ("R", "R"), ("C", "S"), ("S", "C"), ("R", "S"), ("S", "R"), ("R", "Sg"),
    ("R", "C"), ("C", "R"),
)  # fmt: skip
"""Pairs at the ends of a rod between links that move in one plane."""


def rod(
    drawing: Drawing, name: str, kinds: tuple[str, str], rod_of: Rod, normal: Floats | None
) -> None:
    """A rod of its own link between two points."""
    link = drawing.link(f"rod_{name}")
    ends = ((f"P{name}", rod_of.other, kinds[0]), (f"Q{name}", rod_of.own, kinds[1]))
    for joint, point, kind in ends:
        more = "" if kind == "S" or normal is None else f", axis: {text(normal)}"
        if kind == "Sg":
            more = more.replace("axis", "groove")
        where = floats(drawing.position(point))
        drawing.joint(joint, kind, link_of(drawing, point.body), link, where, more)


def link_of(drawing: Drawing, body: str) -> str:
    return drawing.link_of[body]


def crank(drawing: Drawing, name: str, foot: Vector, axis: Vector, factor: float = 1.0) -> None:
    """A link on ground that an input turns; `factor` is its speed against the first input's."""
    link = drawing.link(f"link_{name}")
    drawing.link_of[name] = link
    drawing.bodies.append(Body(name, GROUND, False, floats(foot), floats(axis), drive=factor))
    drawing.joint(name, "R", "ground", link, floats(foot), f", axis: {text(floats(axis))}")
    drawing.columns.append(Column(f"{name}.theta", name, True))
    if factor != 1.0:
        drawing.inputs[f"{name}.theta"] = f"{factor!r}*A.theta"


def turning(
    drawing: Drawing, name: str, foot: Vector, axis: Vector, other: Point, own: Vector, rods: int,
    kinds: tuple[str, str], normal: Floats | None,
) -> None:  # fmt: skip
    """A rocker on ground with its rod, drawn `rods` times over."""
    fixed = Rod(Point(name, floats(own)), other)
    drawing.bodies.append(Body(name, GROUND, False, floats(foot), floats(axis), rod=fixed))
    more = f", axis: {text(floats(axis))}"
    link = drawing.link(f"link_{name}")
    drawing.link_of[name] = link
    drawing.joint(name, "R", "ground", link, floats(foot), more)
    drawing.columns.append(Column(f"{name}.theta", name, True))
    rod(drawing, name, kinds, fixed, normal)
    for copy in range(1, rods):
        twin = f"{name}_{copy}"
        drawing.link_of[twin] = drawing.link(f"link_{twin}")
        drawing.joint(twin, "R", "ground", drawing.link_of[twin], floats(foot), more)
        drawing.columns.append(Column(f"{twin}.theta", name, True))
        rod(drawing, twin, kinds, Rod(Point(twin, floats(own)), other), normal)


def other_point(drawing: Drawing, rng: random.Random, body: Body, radius: float) -> Vector:
    """A point of a turning body, at a distance from its axis."""
    u = np.array(body.axis)
    return np.array(body.foot) + radius * across(u, rng)


def in_plane(drawing: Drawing, rng: random.Random, name: str, gap: float) -> None:
    """A rocker in the plane of a body that turns about the plane's normal."""
    normal = np.array(drawing.bodies[0].axis)
    driver = rng.choice([b for b in drawing.bodies if flat(drawing, b)])
    radius = rng.choice([0.5, 1.0, rng.uniform(0.3, 1.5)])
    other = Point(driver.name, floats(other_point(drawing, rng, driver, radius)))
    foot = np.array(driver.foot) + rng.choice([1.0, 2.0, rng.uniform(0.5, 3)]) * across(normal, rng)
    seen = Seen(drawing, other, GROUND)
    far = rng.choice([radius, rng.uniform(0.4, 2)])
    own = foot + on_circle(rng, seen, foot, normal, far, 0.0, gap)
    kinds = rng.choice(PLANAR_RODS)
    axis = floats(normal)
    drawing.families.append("planar " + "".join(kinds))
    turning(drawing, name, foot, normal, other, own, rng.choice([1, 1, 2]), kinds, axis)


def flat(drawing: Drawing, body: Body) -> bool:
    """Whether a body turns on ground about the plane's normal."""
    return hinged(drawing, body) and body.axis == drawing.bodies[0].axis


def hinged(drawing: Drawing, body: Body) -> bool:
    """Whether a link turns about an axis of ground alone."""
    return body.parent == GROUND and not body.slides and body.name in drawing.link_of


def in_space(drawing: Drawing, rng: random.Random, name: str, gap: float) -> None:
    """RSSR: a rocker about any axis, on any body."""
    driver = rng.choice([b for b in drawing.bodies if b.name in drawing.link_of])
    other = Point(
        driver.name, floats(np.array(driver.foot) + rng.uniform(0.3, 1.5) * random_unit(rng))
    )
    foot, axis = np.array(driver.foot) + rng.uniform(0.5, 3) * random_unit(rng), random_unit(rng)
    seen = Seen(drawing, other, GROUND)
    height = rng.uniform(-0.5, 0.5)
    own = foot + on_circle(rng, seen, foot, axis, rng.uniform(0.4, 2), height, gap)
    drawing.families.append("RSSR")
    turning(drawing, name, foot, axis, other, own, rng.choice([1, 1, 2]), ("S", "S"), None)


def on_sphere(drawing: Drawing, rng: random.Random, name: str, gap: float) -> None:
    """A spherical four-bar, or two shafts on one universal joint."""
    driver = rng.choice([b for b in drawing.bodies if hinged(drawing, b)])
    u = np.array(driver.axis)
    centre = np.array(driver.foot) + rng.uniform(-1, 1) * u
    first = rng.uniform(0.3, 2.8)
    arm = math.cos(first) * u + math.sin(first) * across(u, rng)
    other = Point(driver.name, floats(centre), floats(arm))
    axis = random_unit(rng)
    seen = Seen(drawing, other, GROUND)
    second = rng.uniform(0.3, 2.8)
    own = on_circle(rng, seen, centre, axis, math.sin(second), math.cos(second), gap)
    place = Point(name, floats(centre), floats(own))
    fixed = Rod(place, other)
    drawing.bodies.append(Body(name, GROUND, False, floats(centre), floats(axis), rod=fixed))
    link = drawing.link(f"link_{name}")
    drawing.link_of[name] = link
    drawing.joint(name, "R", "ground", link, floats(centre), f", axis: {text(floats(axis))}")
    drawing.columns.append(Column(f"{name}.theta", name, True))
    driven = link_of(drawing, driver.name)
    a, b = text(floats(arm)), text(floats(own))
    if rng.random() < 0.5:
        drawing.families.append("spherical U")
        more = f", axis: {a}, axis2: {b}"
        drawing.joint(f"U{name}", "U", driven, link, floats(centre), more)
        return
    drawing.families.append("spherical RR")
    coupler = drawing.link(f"rod_{name}")
    drawing.joint(f"P{name}", "R", driven, coupler, floats(centre), f", axis: {a}")
    drawing.joint(f"Q{name}", "R", coupler, link, floats(centre), f", axis: {b}")


def slider(drawing: Drawing, rng: random.Random, name: str, gap: float) -> None:
    """A slider on a rod, in the plane or in space."""
    normal = np.array(drawing.bodies[0].axis)
    planar = rng.random() < 0.6
    if planar:
        driver = rng.choice([b for b in drawing.bodies if flat(drawing, b)])
        other = Point(driver.name, floats(other_point(drawing, rng, driver, rng.uniform(0.3, 1.5))))
        u = across(normal, rng)
        foot = np.array(driver.foot) + rng.uniform(-0.5, 0.5) * np.cross(normal, u)
        kinds = rng.choice(PLANAR_RODS[:-2])
    else:
        driver = rng.choice([b for b in drawing.bodies if b.name in drawing.link_of])
        at = np.array(driver.foot) + rng.uniform(0.3, 1.5) * random_unit(rng)
        other = Point(driver.name, floats(at))
        u, foot = random_unit(rng), np.array(driver.foot) + rng.uniform(-1, 1) * random_unit(rng)
        kinds = ("S", "S")
    own = on_line(rng, Seen(drawing, other, GROUND), foot, u, gap)
    fixed = Rod(Point(name, floats(own)), other)
    drawing.bodies.append(Body(name, GROUND, True, floats(own), floats(u), rod=fixed))
    link = drawing.link(f"link_{name}")
    drawing.link_of[name] = link
    drawing.joint(name, "P", "ground", link, floats(own), f", axis: {text(floats(u))}")
    drawing.columns.append(Column(f"{name}.s", name, False))
    drawing.families.append("slider " + "".join(kinds))
    rod(drawing, name, kinds, fixed, floats(normal) if planar else None)


def on_two_legs(drawing: Drawing, rng: random.Random, name: str, gap: float) -> None:
    """A body on C or U held by two legs: one leg places its first coordinate, as it ends on the
    axis of the second, and one block of two unknowns has two factors."""
    driver = rng.choice([b for b in drawing.bodies if b.name in drawing.link_of])
    one, two = (
        Point(driver.name, floats(np.array(driver.foot) + rng.uniform(0.3, 1.2) * random_unit(rng)))
        for _ in range(2)
    )
    centre = np.array(driver.foot) + rng.uniform(0.8, 2.5) * random_unit(rng)
    axis = random_unit(rng)
    first = f"{name}_carrier"
    collared = rng.random() < 0.5
    if collared:
        own = on_line(rng, Seen(drawing, one, GROUND), centre, axis, gap)
        second_axis, second_foot = axis, own
        place = Point(first, floats(own))
    else:
        second_axis, second_foot = across(axis, rng), centre
        tilt = rng.uniform(0.4, 1.5)
        second_axis = math.cos(tilt) * axis + math.sin(tilt) * second_axis
        # the leg ends on the second axis, which turns about the first
        own = on_circle(
            rng, Seen(drawing, one, GROUND), centre, axis, math.sin(tilt), math.cos(tilt), gap
        )
        second_axis, place = own, Point(first, floats(centre), floats(own))
    foot = floats(second_foot)
    drawing.bodies.append(Body(first, GROUND, collared, foot, floats(axis), rod=Rod(place, one)))
    try:
        unit = second_axis / np.linalg.norm(second_axis)
        seen = Seen(drawing, two, first)
        end = second_foot + on_circle(
            rng, seen, second_foot, unit, rng.uniform(0.4, 1.5), rng.uniform(-0.5, 0.5), gap
        )
    except Impossible:
        drawing.bodies.pop()
        raise
    fixed = Rod(Point(name, floats(end)), two)
    drawing.bodies.append(Body(name, first, False, foot, floats(second_axis), rod=fixed))
    link = drawing.link(f"link_{name}")
    drawing.link_of[name] = link
    if collared:
        drawing.joint(name, "C", "ground", link, foot, f", axis: {text(floats(axis))}")
        names = (Column(f"{name}.s", first, False), Column(f"{name}.theta", name, True))
    else:
        more = f", axis: {text(floats(axis))}, axis2: {text(floats(second_axis))}"
        drawing.joint(name, "U", "ground", link, foot, more)
        names = (Column(f"{name}.theta1", first, True), Column(f"{name}.theta2", name, True))
    drawing.columns.extend(names)
    drawing.merged.append((first, name))
    drawing.families.append("C two legs" if collared else "U two legs")
    rod(drawing, f"{name}a", ("S", "S"), Rod(Point(name, place.base, place.offset), one), None)
    rod(drawing, f"{name}b", ("S", "S"), fixed, None)


LOOPS = (in_plane, in_plane, in_space, on_sphere, slider, on_two_legs)
__all__ = ["LOOPS", "ORIGIN", "crank"]
