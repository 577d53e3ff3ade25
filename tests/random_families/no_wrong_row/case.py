"""One random mechanism with its sweep, from a number."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

import numpy as np
from random_families.no_wrong_row.chains import chained
from random_families.no_wrong_row.design import Impossible, random_unit
from random_families.no_wrong_row.drawing import Drawing
from random_families.no_wrong_row.field import FAST
from random_families.no_wrong_row.loops import LOOPS, crank, in_plane
from random_families.no_wrong_row.more_loops import MORE_LOOPS, platform
from random_families.no_wrong_row.node import Node
from random_families.no_wrong_row.transforms import double
from random_families.no_wrong_row.travel import Travel, travelled, travelled_from


@dataclass
class Case:
    """The text of a file, its linkage as drawn, how the input goes, and the sides of the assembly
    that is asked for if it is not the drawn one."""

    number: int
    drawing: Drawing
    text: str
    travel: Travel
    gaps: list[float]
    sides: dict[str, int]


def random_gap(rng: random.Random) -> float:
    return float(10 ** rng.uniform(-12, -2))


def drawn(number: int, series: int = 1) -> Case:
    """A case that depends on its number and series alone."""
    attempt = 0
    while True:
        rng = random.Random(number * 1_000_003 + attempt + (series - 1) * 10**15)
        attempt += 1
        drawing, gaps = Drawing(rng), []
        crank(drawing, "A", np.zeros(3), random_unit(rng))
        try:
            (_several, _more, _chain)[series - 1](drawing, rng, gaps)
        except Impossible:
            continue
        if series == 1:
            travel, chosen = travelled(rng), {}
        else:
            chosen = _chosen(drawing, rng)
            travel = (travelled if chosen else travelled_from)(rng)
        near = near_of(drawing, chosen)
        return Case(number, drawing, text_of(drawing, travel, near), travel, gaps, chosen)


def _several(drawing: Drawing, rng: random.Random, gaps: list[float]) -> None:
    kind = rng.choice(["same", "planar", "mixed", "mixed"])
    gap = random_gap(rng)
    for k in range(rng.randint(2, 5)):
        gap = gap if kind == "same" else random_gap(rng)
        gaps.append(gap)
        loop = in_plane if kind == "planar" else rng.choice(LOOPS)
        _grown(drawing, rng, loop, f"B{k}", gap)


def _more(drawing: Drawing, rng: random.Random, gaps: list[float]) -> None:
    """Arms, shafts, five-bars and platforms among the loops of the first series."""
    for k in range(rng.choice([1, 1, 2, 3])):
        gaps.append(random_gap(rng))
        loop = platform if k == 0 and rng.random() < 0.2 else rng.choice(MORE_LOOPS)
        _grown(drawing, rng, loop, f"B{k}", gaps[-1])
    if rng.random() < 0.15:
        double(drawing)


def _chain(drawing: Drawing, rng: random.Random, gaps: list[float]) -> None:
    """Dyads on rods and rockers of others."""
    for k in range(rng.choice([1, 2, 2, 3, 4])):
        gaps.append(random_gap(rng))
        _grown(drawing, rng, chained, f"B{k}", gaps[-1])
    if rng.random() < 0.15:
        double(drawing)


def _grown(drawing: Drawing, rng: random.Random, loop: object, name: str, gap: float) -> None:
    state = drawing.state()
    for _ in range(6):
        try:
            return loop(drawing, rng, name, gap)  # type: ignore[operator,no-any-return]
        except Impossible:
            drawing.restore(state)
            state = drawing.state()
    raise Impossible


def _chosen(drawing: Drawing, rng: random.Random) -> dict[str, int]:
    """Sides of another assembly than the drawn one, or none."""
    if rng.random() < 0.75:
        return {}
    sides = {
        body.name: rng.choice([-1, 1])
        for body in drawing.bodies
        if body.rod and not isinstance(body, Node)
    }
    if not sides:
        return {}
    at = drawing.linkage(sides).at(np.zeros(1), FAST)
    return sides if min(float(m[0]) for m in at.margin.values()) > 1e-3 else {}


def near_of(drawing: Drawing, sides: dict[str, int]) -> str:
    """The coordinates of another assembly in the place that is drawn, to three digits."""
    if not sides:
        return ""
    placed = drawing.linkage(sides).at(np.zeros(1), FAST)
    items = []
    for column in drawing.columns:
        value = float(placed.value[column.body][0])
        if ".position" in column.name or column.body in {b.name for b in drawing.driven}:
            continue
        items.append(f"{column.name}: {math.degrees(value) if column.angle else value:.3f}")
    return "assembly: {near: {" + ", ".join(items) + "}}\n" if items else ""


def text_of(
    drawing: Drawing, travel: Travel, near: str = "", more: str = "", *, shuffled: bool = True
) -> str:
    links, joints = drawing.shuffled() if shuffled else (drawing.links, drawing.joints)
    mass = "mass: 1.5, center_of_mass: [0.3, -0.2, 0.4], inertia: {xx: 0.3, yy: 0.2, zz: 0.4}"
    inputs = "".join(f"    {n}: {{with: {v}}}\n" for n, v in drawing.inputs.items())
    return (
        "format: 1\nname: random\nunits: {length: m, angle: deg, mass: kg, force: N}\nlinks:\n"
        + "".join(f"  {link}: {{{mass if link in drawing.heavy else ''}}}\n" for link in links)
        + "joints:\n"
        + "".join(f"  {joint}\n" for joint in joints)
        + ("points:\n" if drawing.marks else "")
        + "".join(f"  {mark}\n" for mark in drawing.marks)
        + f"motion:\n{travel.head}  inputs:\n    A.theta: {travel.text}\n{inputs}{near}{more}"
    )
