"""Dyads of a plane on rods and rockers of others: chains whose loops are solved one by one.

A rod is a body here: it is aimed at its rocker's pin. A rocker's own hinge is on ground or on a
link that moves itself.
"""

from __future__ import annotations

import random

import numpy as np
from random_families.no_wrong_row.bodies import GROUND, Aim, Body, Point, Rod
from random_families.no_wrong_row.design import Seen, across, on_circle
from random_families.no_wrong_row.drawing import Column, Drawing, Vector, floats, text
from random_families.no_wrong_row.loops import (
    PLANAR_RODS,
    in_plane,
    in_space,
    other_point,
    rod,
    slider,
)
from random_families.no_wrong_row.more_loops import dyad

STEADY_RODS = tuple(kinds for kinds in PLANAR_RODS if kinds not in (("S", "S"), ("R", "Sg")))
"""Pairs between which a rod does not spin: it can carry others."""


def hung(drawing: Drawing, rng: random.Random, name: str, gap: float) -> None:
    """A rod on any link of the plane, and its rocker."""
    normal = np.array(drawing.bodies[0].axis)
    links = [body for body in drawing.bodies if in_the_plane(drawing, body)]
    driver = rng.choice(links[-4:])
    other = Point(driver.name, floats(pin_of(drawing, rng, driver)))
    parents = [b.name for b in links if b is not driver and driver.parent != b.name]
    parent = rng.choice([GROUND] * 3 + parents[-2:])
    near = np.array(other.base) + rng.uniform(0.5, 2.5) * across(normal, rng)
    pivot = Point(parent, floats(near))
    seen = Seen(drawing, other, parent)
    far = rng.uniform(0.4, 2)
    own = near + on_circle(rng, seen, near, normal, far, 0.0, gap)
    fixed = Rod(Point(name, floats(own)), other)
    axis = floats(normal)
    drawing.bodies.append(Body(name, parent, False, pivot.base, axis, rod=fixed))
    drawing.link_of[name] = drawing.link(f"link_{name}")
    between = drawing.link_of[parent], drawing.link_of[name]
    drawing.joint(name, "R", *between, pivot.base, f", axis: {text(axis)}")
    drawing.columns.append(Column(f"{name}.theta", name, True))
    kinds = rng.choice(PLANAR_RODS)
    rod(drawing, name, kinds, fixed, axis)
    drawing.families.append(f"{''.join(kinds)} on {driver.name} and {parent}")
    if kinds in STEADY_RODS:
        carrier = f"{name}_rod"
        aim = Aim(floats(own), Point(name, floats(own)), free=False)
        drawing.bodies.append(Body(carrier, driver.name, False, other.base, axis, aim=aim))
        drawing.link_of[carrier] = f"rod_{name}"
        if kinds[0] == "R":
            drawing.columns.append(Column(f"P{name}.theta", carrier, True))


def in_the_plane(drawing: Drawing, body: Body) -> bool:
    """Whether a link turns about the plane's normal, on ground or on a link that does."""
    normal = drawing.bodies[0].axis
    return body.name in drawing.link_of and not body.slides and body.axis == normal


def pin_of(drawing: Drawing, rng: random.Random, driver: Body) -> Vector:
    """A place on a link: a new one, or the pin that it has already."""
    if isinstance(driver.rod, Rod) and rng.random() < 0.3:
        return drawing.position(driver.rod.own)
    return other_point(drawing, rng, driver, rng.choice([0.5, 1.0, rng.uniform(0.3, 1.5)]))


def chained(drawing: Drawing, rng: random.Random, name: str, gap: float) -> None:
    """Mostly a dyad of the chain; sometimes a five-bar, or a loop beside it."""
    rng.choice([hung] * 8 + [dyad, in_plane, in_space, slider])(drawing, rng, name, gap)
