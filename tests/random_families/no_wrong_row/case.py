"""One random mechanism with its sweep, from a number."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from random_families.no_wrong_row.design import Impossible, random_unit
from random_families.no_wrong_row.drawing import Drawing
from random_families.no_wrong_row.loops import LOOPS, crank, in_plane

Array = NDArray[np.float64]
MOST_ROWS = 400


@dataclass
class Case:
    """The text of a file, its linkage as drawn, and the input's values in degrees, by row."""

    number: int
    drawing: Drawing
    text: str
    rows: Array
    gaps: list[float]

    @property
    def span(self) -> float:
        """The largest way of the input from the drawing, rad."""
        return math.radians(float(np.abs(self.rows).max()))


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
        rows, motion = _sweep(rng)
        return Case(number, drawing, text_of(drawing, motion), rows, gaps)


def _grown(drawing: Drawing, rng: random.Random, loop: object, name: str, gap: float) -> None:
    for _ in range(6):
        try:
            return loop(drawing, rng, name, gap)  # type: ignore[operator,no-any-return]
        except Impossible:
            pass
    raise Impossible


def _sweep(rng: random.Random) -> tuple[Array, str]:
    """Rows in degrees from the drawing on: coarse or fine, either way, up to ten turns."""
    step = rng.choice([0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 60.0, 90.0])
    step = rng.choice([step, round(10 ** rng.uniform(-1, 1.95), 3)])
    span = min(rng.choice([90, 200, 360, 360, 400, 720, 3600]), step * MOST_ROWS)
    way = rng.choice([-1, 1])
    count = int(span / step + 1e-9) + 1
    end = way * (count - 1) * step
    rows = np.array([way * step * k for k in range(count)])
    return rows, f"{{from: 0, to: {end!r}, step: {step!r}}}"


def text_of(drawing: Drawing, motion: str) -> str:
    links, joints = drawing.shuffled()
    inputs = "".join(f"    {n}: {{with: {v}}}\n" for n, v in drawing.inputs.items())
    return (
        "format: 1\nname: random\nunits: {length: m, angle: deg, mass: kg, force: N}\nlinks:\n"
        + "".join(f"  {link}: {{}}\n" for link in links)
        + "joints:\n"
        + "".join(f"  {joint}\n" for joint in joints)
        + f"motion:\n  inputs:\n    A.theta: {motion}\n{inputs}"
    )
