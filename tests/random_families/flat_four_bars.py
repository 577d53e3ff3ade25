"""Four-bars drawn flat, where two motions meet, against the circles of their pins.

`python -m tests.random_families.flat_four_bars 0:1000`: exit code 1 where a row that is `ok` is no
assembly, or lies on one of two motions in which the crank leaves the drawing.
"""

from __future__ import annotations

import math
import random
import sys
from collections import Counter
from typing import NamedTuple

import mechkin_cli as mk

FILE = """\
format: 1
plane: xy
units: {{length: m, angle: rad}}
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  B: {{type: R, links: [crank, coupler], point: [{b!r}, 0]}}
  C: {{type: R, links: [coupler, rocker], point: [{c!r}, 0]}}
  D: {{type: R, links: [ground, rocker], point: [{d!r}, 0]}}
motion: {{inputs: {{A.theta: {{values: {angles}}}}}}}
"""
KINDS = ("parallelogram", "nearly rhombus", "rhombus", "kite", "change point")


class FlatFourBar(NamedTuple):
    """Lengths of crank, coupler, rocker and ground, whether crank, coupler and rocker point along
    the ground (1) or against it (-1), and the crank's angles in rad."""

    kind: str
    lengths: tuple[float, float, float, float]
    senses: tuple[int, int, int]
    angles: list[float]

    @property
    def text(self) -> str:
        crank, _, rocker, ground = self.lengths
        first, _, last = self.senses
        b, c = crank * first, ground + rocker * last
        return FILE.format(b=b, c=c, d=ground, angles=self.angles)

    def rocker_angles(self, angle: float) -> list[float]:
        """D.theta of both assemblies."""
        crank, coupler, rocker, ground = self.lengths
        x, y = (self.senses[0] * crank * f(angle) for f in (math.cos, math.sin))
        way = math.hypot(ground - x, y)
        along = (way * way + coupler * coupler - rocker * rocker) / (2.0 * way)
        square = coupler * coupler - along * along
        if square < -1e-9 * coupler * coupler:
            return []
        off = math.sqrt(max(square, 0.0))
        ex, ey = (ground - x) / way, -y / way
        found = []
        for side in (off, -off):
            cx, cy = x + along * ex - side * ey, y + along * ey + side * ex
            sense = self.senses[2]
            found.append(math.atan2(sense * cy, sense * (cx - ground)))
        return found

    @property
    def leaving(self) -> int:
        """Motions in which the crank leaves the drawing: of both assemblies a hair from it those
        that are next to it."""
        way = math.copysign(1e-9, self.angles[0])
        return sum(abs(angle) < 1e-3 for angle in self.rocker_angles(way))


def drawn(number: int) -> FlatFourBar:
    rng = random.Random(number)
    kind = rng.choice(KINDS)
    a, b = (round(rng.uniform(0.3, 2.0), 3) for _ in range(2))
    lengths = (a, b, a, b)
    if kind == "nearly rhombus":
        b = a * (1.0 + rng.choice([-1, 1]) * 10.0 ** -rng.randint(1, 4))
        lengths = (a, b, a, b)
    elif kind == "rhombus":
        lengths = (a, a, a, a)
    elif kind == "kite":
        lengths = rng.choice([(a, a, b, b), (a, b, b, a)])
    elif kind == "change point":
        c = round(rng.uniform(0.3, 2.0), 3)
        lengths = (a, b, c, a + b - c if a + b - c > 0.1 else a + b + c)
    signs = [(i, j, k) for i in (1, -1) for j in (1, -1) for k in (1, -1)]
    crank, coupler, rocker, ground = lengths
    closed = [
        (i, j, k) for i, j, k in signs if abs(i * crank + j * coupler - ground - k * rocker) < 1e-12
    ]
    sense, step = rng.choice([1, -1]), rng.uniform(0.02, 0.3)
    first = rng.choice([0.02, 0.1, 0.3])
    angles = [round(sense * (first + step * k), 6) for k in range(4)]
    return FlatFourBar(kind, lengths, rng.choice(closed), angles)


def judge(case: FlatFourBar) -> str:
    """`right`, `refused`, or what is wrong."""
    analysis = mk.loads(case.text).analyze(["D.theta"])
    rows = zip(case.angles, analysis["row.status"].tolist(), analysis["D.theta"], strict=True)
    solved = [(angle, value) for angle, status, value in rows if status == "ok"]
    for angle, value in solved:
        off = [abs(math.remainder(value - one, math.tau)) for one in case.rocker_angles(angle)]
        if not off or min(off) > 1e-7:
            return f"wrong: no assembly at {angle}"
    if solved and case.leaving > 1:
        return f"wrong: one of {case.leaving} motions taken"
    return "right" if solved else "refused"


def main() -> int:
    first, last = map(int, sys.argv[1].split(":"))
    words: Counter[str] = Counter()
    for number in range(first, last):
        case = drawn(number)
        word = judge(case)
        words[f"{case.kind}, {case.leaving} leave: {word.partition(':')[0]}"] += 1
        if word.startswith("wrong"):
            print(f"{number}: {word}\n{case.text}")
    print("\n".join(f"{count:6d} {word}" for word, count in sorted(words.items())))
    return int(any("wrong" in word for word in words))


if __name__ == "__main__":
    sys.exit(main())
