"""Platforms on six telescopic legs that move together: three to one point, two to another, one to
a third. Each point is at three known distances from what is placed before it."""

from __future__ import annotations

import random

import numpy as np
from random_families.no_wrong_row.bodies import GROUND, Floats, Point
from random_families.no_wrong_row.branch import TURN
from random_families.no_wrong_row.design import Impossible
from random_families.no_wrong_row.drawing import Column, Drawing, floats, text
from random_families.no_wrong_row.field import FAST
from random_families.no_wrong_row.linkage import Linkage
from random_families.no_wrong_row.node import Leg, Node

HALVINGS = 60


def platform(drawing: Drawing, rng: random.Random, name: str, gap: float) -> None:
    """Strokes are chosen so that one of the points nearly comes into the plane of its feet."""

    def point(low: float, high: float) -> Floats:
        return rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(low, high)

    feet = [Point(GROUND, point(-0.3, 0.3)) for _ in range(6)]
    heads = [point(0.5, 1.2) for _ in range(3)]
    names = [f"{name}_{letter}" for letter in "ABC"]
    turns = rng.choice([1, 1, 2])
    strokes = [rng.choice([0.0, rng.uniform(-0.15, 0.15)]) for _ in range(6)]
    near = rng.randrange(3)
    leg = (0, 3, 5)[near]

    def nodes(stroke: float) -> list[Node]:
        all_strokes = [*strokes[:leg], stroke, *strokes[leg + 1 :]]
        legs = [Leg(foot, s, turns) for foot, s in zip(feet, all_strokes, strict=True)]
        one, two = Point(names[0], heads[0]), Point(names[1], heads[1])
        groups = (tuple(legs[:3]), (*legs[3:5], Leg(one)), (legs[5], Leg(one), Leg(two)))
        return [Node(n, h, g) for n, h, g in zip(names, heads, groups, strict=True)]  # type: ignore[arg-type]

    crank, grid = drawing.bodies[0], np.linspace(0, TURN, 721)

    def least(stroke: float) -> float:
        placed = Linkage([crank, *nodes(stroke)], 1.0).at(grid, FAST)
        return min(float(placed.margin[n].min()) for n in names[: near + 1])

    sign = rng.choice([-1, 1])
    if least(0.0) < 1e-3 or not least(0.9 * sign) < 0:
        raise Impossible
    low, high = 0.0, 0.9
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if least(sign * middle) > 0 else (low, middle)
    found = nodes(sign * (low - gap if rng.random() < 0.85 else high + gap))
    if min(float(np.linalg.norm(np.subtract(a, b))) for a, b in pairs(heads)) < 0.3:
        raise Impossible
    written(drawing, name, found)
    drawing.merged.append(tuple(names))
    drawing.families.append(f"platform near {names[near][-1]}")


def pairs(heads: list[Floats]) -> list[tuple[Floats, Floats]]:
    return [(heads[0], heads[1]), (heads[0], heads[2]), (heads[1], heads[2])]


def written(drawing: Drawing, name: str, nodes: list[Node]) -> None:
    """Bodies, links, joints and inputs of a platform."""
    body = drawing.link(f"link_{name}")
    k = 0
    for node in nodes:
        drawing.bodies.append(node)
        drawing.marks.append(f"{node.name}: {{link: {body}, at: {text(node.drawn)}}}")
        drawing.columns.extend(
            Column(f"{node.name}.position.{x}", f"{node.name}.{x}", False) for x in "xyz"
        )
        for leg in node.rod:
            if leg.other.body != GROUND:
                continue
            k += 1
            foot = leg.other.base
            rod = drawing.link(f"rod_{name}{k}")
            head, foot_joint = f"H{name}{k}", f"F{name}{k}"
            if not leg.stroke:
                drawing.joint(foot_joint, "S", "ground", rod, foot)
                drawing.joint(head, "S", rod, body, node.drawn)
                continue
            tube = drawing.link(f"tube_{name}{k}")
            axis = np.subtract(node.drawn, foot)

            drawing.joint(foot_joint, "S", "ground", tube, foot)
            drawing.joint(f"L{name}{k}", "P", tube, rod, foot, f", axis: {text(floats(axis))}")
            drawing.joint(head, "S", rod, body, node.drawn)
            angle = "A.theta" if leg.turns == 1 else f"{leg.turns}*A.theta"
            drawing.inputs[f"L{name}{k}.s"] = f'"{leg.stroke!r} m*sin({angle})"'
