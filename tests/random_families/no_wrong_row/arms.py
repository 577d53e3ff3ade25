"""Six-joint arms with a spherical wrist whose hand is a link that the drawing already moves.

One block of six unknowns with three factors: the wrist's centre comes by the first axis, the elbow
is stretched or folded, the sixth axis comes by the fourth.
"""

from __future__ import annotations

import math
import random
from typing import NamedTuple

import numpy as np
from random_families.no_wrong_row.bodies import GROUND, Aim, Body, Floats, Level, Point, Rod
from random_families.no_wrong_row.design import Impossible, Seen, across, on_circle, random_unit
from random_families.no_wrong_row.drawing import Column, Drawing, Vector, floats, text
from random_families.no_wrong_row.field import FAST

SHOULDERS = ("by the axis", "by the axis", "offset", "away")
WRISTS = ("straight", "straight", "oblique", "away")


class Hand(NamedTuple):
    """The wrist's centre on the link that is the hand, and the sixth axis."""

    centre: Point
    axis: Floats


def unit(v: Vector) -> Vector:
    length = float(np.linalg.norm(v))
    if length < 0.05:
        raise Impossible
    return np.asarray(v / length)


class Near(NamedTuple):
    """What an arm comes near to, in one place, and by how much; the elbow stays away."""

    shoulder: str
    wrist: str
    straight: float


def arm(
    drawing: Drawing, rng: random.Random, name: str, gap: float, near: Near | None = None
) -> None:
    """An arm on ground that holds a link; all of its singular places may be near one place."""
    driver = rng.choice([b for b in drawing.bodies if b.name in drawing.link_of])
    centre = np.array(driver.foot) + rng.uniform(0.4, 1.5) * random_unit(rng)
    hand = Hand(Point(driver.name, floats(centre)), floats(random_unit(rng)))
    seen = Seen(drawing, hand.centre, GROUND)
    place, other = rng.choice(seen.places), rng.choice(seen.places)
    if near or rng.random() < 0.5:
        other = place
    before = len(drawing.bodies)
    kind = near.shoulder if near else rng.choice(SHOULDERS)
    shoulder = shoulder_of(drawing, rng, name, hand, seen, float(place), gap, kind)
    elbow(drawing, rng, name, hand, shoulder, other_gap(rng, gap))
    small = near.straight if near else other_gap(rng, gap)
    kind = near.wrist if near else rng.choice(WRISTS)
    wrist = wrist_of(drawing, rng, name, hand, float(other), small, kind)
    names = [f"{name}_{k}" for k in range(1, 7)]
    drawing.merged.append((names[0], names[1], names[3]))
    drawing.families.append(f"arm {shoulder.kind}, {wrist}")
    links = [
        "ground",
        *(drawing.link(f"link_{n}") for n in names[:5]),
        drawing.link_of[driver.name],
    ]
    for k, body in enumerate(drawing.bodies[before:]):
        more = f", axis: {text(body.axis)}"
        drawing.joint(names[k], "R", links[k], links[k + 1], body.foot, more)
        drawing.columns.append(Column(f"{names[k]}.theta", names[k], True))


def other_gap(rng: random.Random, gap: float) -> float:
    return gap if rng.random() < 0.3 else float(10 ** rng.uniform(-12, -2))


class Shoulder(NamedTuple):
    """The first axis's foot and the normal of the plane of the next two links."""

    kind: str
    foot: Vector
    axis: Vector
    normal: Vector


def shoulder_of(
    drawing: Drawing, rng: random.Random, name: str, hand: Hand, seen: Seen, place: float,
    gap: float, kind: str,
) -> Shoulder:  # fmt: skip
    """The first body: its plane keeps the wrist's centre at its height."""
    here, soon = seen.at(np.array([place, place + 1e-5])).T
    axis = random_unit(rng)
    way = np.cross(axis, soon - here) / 1e-5
    if np.linalg.norm(way) < 0.1:
        raise Impossible
    away = gap if kind == "by the axis" else rng.uniform(0.3, 1.0)
    foot = here + away * unit(way) + rng.uniform(-0.8, 0.8) * axis
    flat = np.array(hand.centre.base) - foot
    flat = flat - (axis @ flat) * axis
    if (reach := float(np.linalg.norm(flat))) < 0.1:
        raise Impossible
    height = {"by the axis": 0.0, "away": rng.uniform(0, 0.2)}.get(kind, 0.0)
    if kind == "offset":
        path = -seen.largest(lambda p: -np.linalg.norm(np.cross(axis, (p.T - foot)), axis=1))
        height = path + rng.choice([-1, -1, -1, 1]) * gap
    if height > 0.9 * reach:
        raise Impossible
    side = rng.choice([-1, 1]) * math.acos(height / reach)
    normal = math.cos(side) * flat / reach + math.sin(side) * np.cross(axis, flat / reach)
    level = Level(floats(normal), hand.centre, free=False)
    drawing.bodies.append(Body(f"{name}_1", GROUND, False, floats(foot), floats(axis), rod=level))
    return Shoulder(kind, foot, axis, normal)


def elbow(
    drawing: Drawing, rng: random.Random, name: str, hand: Hand, shoulder: Shoulder, gap: float
) -> None:
    """The second and the third body, about parallel axes."""
    foot = shoulder.foot + rng.uniform(-0.5, 0.5) * shoulder.axis
    seen = Seen(drawing, hand.centre, f"{name}_1")
    limbs = on_circle(rng, seen, foot, shoulder.normal, rng.uniform(0.5, 2), 0.0, gap) + foot
    axis = floats(shoulder.normal)
    rod = Rod(Point(f"{name}_2", floats(limbs)), hand.centre)
    drawing.bodies.append(Body(f"{name}_2", f"{name}_1", False, floats(foot), axis, rod=rod))
    aim = Aim(hand.centre.base, hand.centre, free=False)
    drawing.bodies.append(Body(f"{name}_3", f"{name}_2", False, floats(limbs), axis, aim=aim))


def wrist_of(
    drawing: Drawing, rng: random.Random, name: str, hand: Hand, place: float, gap: float,
    kind: str,
) -> str:  # fmt: skip
    """The last three bodies; the axes of the fourth and the sixth nearly meet at a place."""
    placed = drawing.linkage().at(np.array([place]), FAST)
    turned = placed.pose[hand.centre.body].along(hand.axis)
    there = np.array([float(x[0]) for x in placed.pose[f"{name}_3"].heading(turned)])
    sixth = np.array(hand.axis)
    fourth = random_unit(rng)
    if kind == "straight":
        fourth = math.cos(gap) * there + math.sin(gap) * across(there, rng)
    fifth = unit(np.cross(fourth, sixth))
    if kind == "oblique":
        fifth = unit(fifth + rng.uniform(-0.4, 0.4) * fourth + rng.uniform(-0.4, 0.4) * sixth)
    at = hand.centre.base
    six = Point(hand.centre.body, hand.axis)
    level = Level(floats(fifth), six, free=True)
    four, five = f"{name}_4", f"{name}_5"
    drawing.bodies.append(Body(four, f"{name}_3", False, at, floats(fourth), rod=level))
    drawing.bodies.append(Body(five, four, False, at, floats(fifth), aim=Aim(hand.axis, six, True)))
    last = floats(across(sixth, rng))
    aim = Aim(last, Point(hand.centre.body, last), free=True)
    drawing.bodies.append(Body(f"{name}_6", five, False, at, hand.axis, aim=aim))
    return f"wrist {kind}"
