"""Loops of the second series: chains of Hooke joints, dyads between driven cranks, 3-2-1 legs."""

from __future__ import annotations

import math
import random

import numpy as np
from random_families.no_wrong_row.arms import arm
from random_families.no_wrong_row.bodies import GROUND, Body, Level, Point, Rod
from random_families.no_wrong_row.design import Impossible, Seen, across, on_circle
from random_families.no_wrong_row.drawing import Column, Drawing, floats, text
from random_families.no_wrong_row.loops import (
    PLANAR_RODS,
    crank,
    flat,
    hinged,
    in_plane,
    in_space,
    on_two_legs,
    other_point,
    rod,
    slider,
)
from random_families.no_wrong_row.platforms import platform

FACTORS = (-1.0, 2.0, 0.5, -2.0, 3.0, 0.3, -1.7)


def shafts(drawing: Drawing, rng: random.Random, name: str, gap: float) -> None:
    """Shafts one behind the other on universal joints, with angles up to a right one but a gap."""
    driver = rng.choice([b for b in drawing.bodies if hinged(drawing, b)])
    before = len(drawing.bodies)
    count = rng.randint(1, 4)
    for k in range(count):
        own = f"{name}_{k}"
        away = gap if k == 0 or rng.random() < 0.3 else rng.uniform(0.2, 1.4)
        driver = hooked(drawing, rng, own, driver, math.pi / 2 - away)
    drawing.families.append(f"{len(drawing.bodies) - before} Hooke")


def hooked(drawing: Drawing, rng: random.Random, name: str, driver: Body, angle: float) -> Body:
    """A shaft at an angle to another one; the joint's two arms are at right angles as drawn."""
    first = np.array(driver.axis)
    centre = np.array(driver.foot) + rng.choice([-1, 1]) * rng.uniform(0.3, 1) * first
    axis = math.cos(angle) * first + math.sin(angle) * across(first, rng)
    arm_one = across(first, rng)
    arm_two = np.cross(arm_one, axis)
    if np.linalg.norm(arm_two) < 0.2:
        raise Impossible
    arm_two = arm_two / np.linalg.norm(arm_two)
    level = Level(floats(arm_two), Point(driver.name, floats(arm_one)), free=True)
    body = Body(name, GROUND, False, floats(centre), floats(axis), rod=level)
    drawing.bodies.append(body)
    link = drawing.link(f"link_{name}")
    drawing.link_of[name] = link
    more = f", axis: {text(body.axis)}"
    drawing.joint(name, "R", "ground", link, body.foot, more)
    arms = f", axis: {text(floats(arm_one))}, axis2: {text(floats(arm_two))}"
    drawing.joint(f"U{name}", "U", drawing.link_of[driver.name], link, body.foot, arms)
    drawing.columns.append(Column(f"{name}.theta", name, True))
    return body


def dyad(drawing: Drawing, rng: random.Random, name: str, gap: float) -> None:
    """A second crank tied to the first, and two rods between them: a five-bar."""
    normal = np.array(drawing.bodies[0].axis)
    foot = np.array(drawing.bodies[0].foot) + rng.uniform(0.8, 2.5) * across(normal, rng)
    tied = f"{name}_tied"
    crank(drawing, tied, foot, normal, rng.choice(FACTORS))
    driver = rng.choice([b for b in drawing.bodies[:-1] if flat(drawing, b)])
    other = Point(driver.name, floats(other_point(drawing, rng, driver, rng.uniform(0.3, 1))))
    pin = foot + rng.uniform(0.2, 1) * across(normal, rng)
    far = rng.uniform(0.4, 2)
    own = pin + on_circle(rng, Seen(drawing, other, tied), pin, normal, far, 0.0, gap)
    fixed = Rod(Point(name, floats(own)), other)
    drawing.bodies.append(Body(name, tied, False, floats(pin), floats(normal), rod=fixed))
    drawing.link_of[name] = drawing.link(f"link_{name}")
    more = f", axis: {text(floats(normal))}"
    drawing.joint(name, "R", drawing.link_of[tied], drawing.link_of[name], floats(pin), more)
    drawing.columns.append(Column(f"{name}.theta", name, True))
    kinds = rng.choice(PLANAR_RODS)
    drawing.families.append("five-bar " + "".join(kinds))
    rod(drawing, name, kinds, fixed, floats(normal))


MORE_LOOPS = (arm, arm, arm, shafts, shafts, dyad, dyad, in_plane, in_space, on_two_legs, slider)
__all__ = ["MORE_LOOPS", "platform"]
