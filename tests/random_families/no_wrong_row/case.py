"""One random mechanism with its sweep, from a number."""

from __future__ import annotations

import random
from dataclasses import dataclass

import numpy as np
from random_families.no_wrong_row.design import Impossible, random_unit
from random_families.no_wrong_row.drawing import Drawing
from random_families.no_wrong_row.loops import LOOPS, crank, in_plane
from random_families.no_wrong_row.travel import Travel, travelled


@dataclass
class Case:
    """The text of a file, its linkage as drawn, and how the input goes."""

    number: int
    drawing: Drawing
    text: str
    travel: Travel
    gaps: list[float]


def random_gap(rng: random.Random) -> float:
    return float(10 ** rng.uniform(-12, -2))


def drawn(number: int) -> Case:
    """A case that depends on its number alone."""
    attempt = 0
    while True:
        rng = random.Random(number * 1_000_003 + attempt)
        attempt += 1
        drawing, gaps = Drawing(rng), []
        crank(drawing, "A", np.zeros(3), random_unit(rng))
        kind = rng.choice(["same", "planar", "mixed", "mixed"])
        gap = random_gap(rng)
        try:
            for k in range(rng.randint(2, 5)):
                gap = gap if kind == "same" else random_gap(rng)
                gaps.append(gap)
                loop = in_plane if kind == "planar" else rng.choice(LOOPS)
                _grown(drawing, rng, loop, f"B{k}", gap)
        except Impossible:
            continue
        travel = travelled(rng)
        return Case(number, drawing, text_of(drawing, travel), travel, gaps)


def _grown(drawing: Drawing, rng: random.Random, loop: object, name: str, gap: float) -> None:
    for _ in range(6):
        try:
            return loop(drawing, rng, name, gap)  # type: ignore[operator,no-any-return]
        except Impossible:
            pass
    raise Impossible


def text_of(drawing: Drawing, travel: Travel) -> str:
    links, joints = drawing.shuffled()
    inputs = "".join(f"    {n}: {{with: {v}}}\n" for n, v in drawing.inputs.items())
    return (
        "format: 1\nname: random\nunits: {length: m, angle: deg, mass: kg, force: N}\nlinks:\n"
        + "".join(f"  {link}: {{}}\n" for link in links)
        + "joints:\n"
        + "".join(f"  {joint}\n" for joint in joints)
        + f"motion:\n{travel.head}  inputs:\n    A.theta: {travel.text}\n{inputs}"
    )
