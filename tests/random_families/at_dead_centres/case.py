"""Sweeps of random linkages that begin, end or turn back at a dead centre, or come beside it.

A linkage closes a(u) cos phi + b(u) sin phi = c(u) (`random_families.dead_centres`): the output is
atan2(b, a) -+ acos(c / sqrt(a^2 + b^2)), with one sign on all of a branch between two dead centres.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from decimal import Decimal
from functools import partial
from typing import Any, NamedTuple

from oracle import mp
from random_families.dead_centres.case import (
    Linkage,
    Point,
    decimal,
    linkage,
    plane_four_bar,
    rssr_of,
    slider_crank_of,
)

DIGITS = 50
ROUNDINGS = 1e-13
"""Of a closure whose terms are about one."""


class Sweep(NamedTuple):
    """A file, with values of the input and the sign of the output's arc cosine in all rows."""

    linkage: Linkage
    text: str
    values: tuple[float, ...]
    side: int

    def roundings(self, row: int) -> Any:
        """Those of the discriminant: a short arm makes the most of them."""
        a, b, _ = self.linkage.equation(mp.mpf(self.values[row]))
        return ROUNDINGS * max(1, 4 / mp.hypot(a, b))

    def output(self, row: int) -> Any:
        """The output in a row, from the drawing; None where the loop does not close."""
        return output(self.linkage, self.values[row], self.side)


def output(case: Linkage, u: Any, side: int) -> Any:
    a, b, c = case.equation(mp.mpf(u))
    cosine = c / mp.hypot(a, b)
    return None if abs(cosine) > 1 else mp.atan2(b, a) + side * mp.acos(cosine)


def drawn_side(case: Linkage) -> int:
    """The sign on the branch of the drawing, where the output is zero."""
    a, b, c = case.equation(mp.mpf(0))
    off = [abs(mp.sin((mp.atan2(b, a) + s * mp.acos(c / mp.hypot(a, b))) / 2)) for s in (1, -1)]
    return 1 if off[0] < off[1] else -1


def dead_centre_of(case: Linkage, way: int, step: str = "0.004", far: float = 3.1) -> Any:
    """The nearest dead centre of the drawing's branch one way; None where it has none."""
    step, u = mp.mpf(step) * way, mp.mpf(0)
    while abs(u) < far:
        if case.discriminant(u + step) < 0:
            low, high = u, u + step
            for _ in range(170):
                middle = (low + high) / 2
                low, high = (low, middle) if case.discriminant(middle) < 0 else (middle, high)
            return low
        u += step
    return None


def short_crank(rng: random.Random) -> Linkage:
    """A slider moves a crank of a thousandth of the rod."""
    x, y = (f"{rng.uniform(-1, 1) / 1000:.6f}" for _ in range(2))
    end = decimal(rng, 1.5), f"{rng.uniform(-5, 5) / 10000:.6f}", "0"
    return slider_crank_of((x, y, "0"), end)


def short_rocker(rng: random.Random) -> Linkage:
    """A crank whose coupler's end turns by a thousandth of it."""
    start, foot = (
        (decimal(rng, 1.5), decimal(rng, 1.5), "0"),
        (f"{rng.uniform(0.5, 2):.3f}", "0", "0"),
    )
    end = (
        f"{float(foot[0]) + rng.uniform(-1, 1) / 1000:.6f}",
        f"{rng.uniform(-1, 1) / 1000:.6f}",
        "0",
    )
    return plane_four_bar(start, end, foot)


def mechanism(number: int) -> Linkage:
    """One of the families, in turn; each fifth moves its driven link by a short arm."""
    if number % 5 == 4:
        return (short_crank, short_rocker)[number // 5 % 2](random.Random(number))
    return linkage(number - number // 5)


def beside(rng: random.Random, least: int = 14, most: int = 6) -> list[float]:
    """Some distances from a dead centre, from the nearest."""
    return sorted(10 ** rng.uniform(-least, -most) for _ in range(rng.randint(1, 4)))


def _on_the_branch(rng: random.Random, end: float, inward: float) -> float:
    """A value between the drawing and the dead centre, or near it where that is drawn."""
    return end * rng.uniform(0.05, 0.95) if end else inward * rng.uniform(1e-3, 0.02)


def _begins(rng: random.Random, end: float, inward: float) -> list[float]:
    near = beside(rng)
    return [end, *(end + inward * part for part in near if not 0.0 < abs(end) < part)]


def _begins_and_goes_on(rng: random.Random, end: float, inward: float) -> list[float]:
    return [*_begins(rng, end, inward), _on_the_branch(rng, end, inward)]


def _ends(rng: random.Random, end: float, inward: float) -> list[float]:
    return _begins_and_goes_on(rng, end, inward)[::-1]


def _touches(rng: random.Random, end: float, inward: float) -> list[float]:
    return [*_ends(rng, end, inward), *_begins(rng, end, inward)[1:]]


def _touches_far(rng: random.Random, end: float, inward: float) -> list[float]:
    far = [_on_the_branch(rng, end, inward) for _ in range(4)]
    return [far[0], end, far[1], far[2], end, far[3]]


def _alone(rng: random.Random, end: float, inward: float) -> list[float]:
    return [end]


Motion = Callable[[random.Random, float, float], list[float]]
MOTIONS: dict[str, Motion] = {
    "begins": _begins,
    "begins-on": _begins_and_goes_on,
    "ends": _ends,
    "touches": _touches,
    "touches-far": _touches_far,
    "alone": _alone,
}


def sweep(number: int, motion: str) -> Sweep | None:
    """A motion of a linkage from the drawing's branch; None where it has no dead centre."""
    case = mechanism(number)
    rng = random.Random(f"{motion} {number}")
    with mp.workdps(DIGITS):
        way = rng.choice([1, -1])
        end = dead_centre_of(case, way)
        if end is None:
            return None
        values = MOTIONS[motion](rng, float(end), -way)
        text = case.swept(f"values: [{', '.join(map(repr, values))}]")
        return Sweep(case, text, tuple(values), drawn_side(case))


def near_sweep(number: int, motion: str) -> Sweep | None:
    """The same with the assembly named by the output's place at the first row, on either branch."""
    found = sweep(number, motion)
    if found is None:
        return None
    rng = random.Random(f"near {motion} {number}")
    with mp.workdps(DIGITS):
        side = rng.choice([1, -1])
        inward = -1 if found.values[0] > 0 else 1
        at = output(
            found.linkage, found.values[0] + inward * abs(found.values[0]) * mp.mpf("0.1"), side
        )
        if at is None:
            return None
        near = f"assembly: {{near: {{{found.linkage.output}: {float(at)!r}}}}}\n"
        return found._replace(text=found.text + near, side=side)


def in_line(rng: random.Random) -> Linkage:
    """A linkage drawn at a dead centre of its input: coupler and driven arm in line, or for an RSSR
    in a plane with the rocker's axis. All its points are exact."""

    def exact(places: int = 2, size: float = 1.5) -> Decimal:
        return Decimal(decimal(rng, size, places))

    def point(*parts: Decimal) -> Point:
        return tuple(map(str, parts))

    kind, zero = rng.randrange(3), Decimal(0)
    part = rng.choice([Decimal(-1), Decimal(1)]) * Decimal(f"{rng.uniform(0.2, 2):.2f}")
    start = exact(), exact()
    if kind == 0:
        foot = Decimal(f"{rng.uniform(0.5, 2):.2f}"), zero
        arm = foot[0] - start[0], foot[1] - start[1]
        end = start[0] + part * arm[0], start[1] + part * arm[1]
        return plane_four_bar(point(*start, zero), point(*end, zero), point(*foot, zero))
    if kind == 1:
        end = (1 + part) * start[0], (1 + part) * start[1]
        return slider_crank_of(point(*start, zero), point(*end, zero))
    end, foot, axis = (tuple(exact(1) for _ in range(3)) for _ in range(3))
    along = exact(1)
    way = [part * (c - d) + along * n for c, d, n in zip(end, foot, axis, strict=True)]
    start = tuple(c + w for c, w in zip(end, way, strict=True))
    return rssr_of(point(*start), point(*end), point(*foot), point(*axis))


def drawn_sweep(number: int, motion: str) -> Sweep | None:
    """A motion from a drawing at a dead centre, its branch named by the output."""
    rng = random.Random(f"drawn {motion} {number}")
    case = in_line(rng)
    with mp.workdps(DIGITS):
        a, b, _ = case.equation(mp.mpf(0))
        if not 1e-2 < mp.hypot(a, b) < 100:
            return None
        small = mp.mpf("1e-6")
        slope = (case.discriminant(small) - case.discriminant(-small)) / (2 * small)
        if not 0.05 < abs(slope) < 20:
            return None
        inward = 1 if slope > 0 else -1
        values = MOTIONS[motion](rng, 0.0, inward)
        sign = rng.choice([1, -1])
        beside = output(case, inward * mp.mpf("1e-3"), 1)
        side = 1 if mp.sin(beside) * sign > 0 else -1
        near = sign * 0.03 if values[0] == 0.0 else float(output(case, values[0], side))
        text = case.swept(f"values: [{', '.join(map(repr, values))}]")
        text += f"assembly: {{near: {{{case.output}: {near!r}}}}}\n"
        return Sweep(case, text, tuple(values), side)


def _families() -> dict[str, Callable[[int], Sweep | None]]:
    found: dict[str, Callable[[int], Sweep | None]] = {}
    for motion in MOTIONS:
        found[motion] = partial(sweep, motion=motion)
        found[f"near, {motion}"] = partial(near_sweep, motion=motion)
        found[f"drawn, {motion}"] = partial(drawn_sweep, motion=motion)
    return found


FAMILIES = _families()
"""A sweep of each number by how its branch is given and how it moves."""
