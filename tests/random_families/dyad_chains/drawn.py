"""Random chains, the places on their branch where it ends or nearly does, and rows about these."""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from decimal import Decimal
from typing import Any, NamedTuple

import numpy as np
from random_families.dyad_chains.case import DIRECTIONS, Chain, Dyad, Link, Long, Point, Z

ZERO = Decimal(0)
GRID = 801


class Place(NamedTuple):
    """Where the discriminant of a dyad is zero or least; `left` of it in parts of its uncertainty,
    and the way on which the branch is, 0 on both."""

    at: float
    left: float
    inward: int
    dyad: int = 0


class Sweep(NamedTuple):
    """Rows of a chain: its file, the values of its input, from where the branch is followed, the
    places between them, and whether branch points are passed straight."""

    chain: Chain
    text: str
    values: tuple[float, ...]
    start: float
    places: tuple[Place, ...]
    straight: bool
    what: str


def sweep(number: int, rows: int = 40) -> Sweep | None:
    """The sweep of a number; None where the chain drawn has no place of its kind."""
    rng = random.Random(f"dyads {number}")
    count = rng.randint(1, 6)
    folding = rng.randrange(count) if rng.random() < 0.4 else -1
    chain = _chain(rng, count, folding)
    if chain is None:
        return None
    span = 3.1 if chain.first.turns else 2.5
    start = Long(0) if folding < 0 else _clear(rng, chain, span)
    if start is None:
        return None
    places = places_of(chain, start, span)
    near = [place for place in places if folding < 0 or not place.inward]
    if not near:
        return None
    place = rng.choice(near)
    values, what = _rows(rng, place, float(start), rows, places)
    text = ""
    if folding >= 0 or rng.random() < 0.5:
        # a little inside, where the two branches of a dead centre are told
        beside = place.at + (values[0] - place.at) * 1.01
        known = chain.judged(np.array([Long(values[0]), Long(beside)]))
        k = 0 if known[2][:, 0].min() > 1e6 else 1
        if not known[2][:, k].min() > 1e6:
            return None
        text = ", ".join(f"{chain.name(j + 1)}: {float(x)!r}" for j, x in enumerate(known[0][:, k]))
        what += ", near"
    listed = ", ".join(map(repr, values))
    straight = rng.random() < 0.5
    file = chain.text(f"values: [{listed}]", text, straight)
    what = f"{'-'.join(d.kind for d in chain.dyads)} {what}"
    begun = values[0] if text else 0.0
    return Sweep(chain, file, tuple(values), begun, tuple(places), straight, what)


def _rows(
    rng: random.Random, place: Place, start: float, rows: int, places: list[Place]
) -> tuple[list[float], str]:
    """Values about a place, in an order of motion."""
    ends = sorted([one.at for one in places if one.inward])
    inward = place.inward or rng.choice([1, -1])

    def side(way: int, most: float) -> list[float]:
        """Values on a side of the place, from far to near."""
        beyond = [abs(end - place.at) for end in ends if (end - place.at) * way > 0]
        far = min([0.9 * x for x in beyond] + [most])
        parts = [10 ** rng.uniform(-14, -1) for _ in range(rows // 3)]
        return [place.at + way * x for x in sorted((x for x in parts if x < far), reverse=True)]

    if not place.inward:
        inward = 1 if start > place.at else -1
    way = start + (place.at - start) * rng.random() * 0.5
    here, there = side(inward, 1.0), side(-inward, 0.3)
    kind = rng.choice(["begins", "ends", "touches", "passes", "comes back"])
    if kind == "begins":
        return [place.at, *here[::-1], way], kind
    if kind == "ends":
        return [way, *here, place.at], kind
    if kind == "touches":
        return [way, *here, place.at, *side(inward, 1.0)[::-1]], kind
    if kind == "passes":
        return [way, *here, place.at, *there[::-1]], kind
    turn = there[rng.randrange(len(there))] if there else place.at
    return [way, *here, turn, *side(inward, 1.0)[::-1]], kind


def places_of(chain: Chain, start: Long, span: float) -> list[Place]:
    """The ends of the branch through a value, and between them where it nearly ends."""
    found: list[Place] = []
    for way in (1, -1):
        grid = start + way * np.linspace(Long(0), Long(span), GRID)
        some, last = _places_on(chain, grid, way)
        if last < GRID:
            # what lies between the last places of the grid and the end
            end = some[-1].at if some and some[-1].inward else float(grid[last])
            near = np.linspace(grid[max(last - 3, 0)], Long(repr(end)), GRID)
            more, _ = _places_on(chain, near, way)
            nearest = [one for one in more if one.inward] or [one for one in some if one.inward]
            some = [one for one in [*some, *more] if not one.inward] + nearest
            far = abs(nearest[0].at - float(start)) if nearest else np.inf
            some = [one for one in some if abs(one.at - float(start)) <= far]
        found += some
    return found


def _places_on(chain: Chain, grid: Any, way: int) -> tuple[list[Place], int]:
    """Those on a grid of values up to the first end, which is the last of them, and the number of
    the grid's value behind it."""
    found = []
    left = chain.discriminants(grid)
    over = np.flatnonzero(~(left.min(axis=0) >= 0))
    last = int(over[0]) if over.size else grid.size
    end = None if not over.size else _zero(chain, grid[last - 1], grid[last])
    for k in range(len(chain.dyads)):
        row = left[k, :last]
        least = np.flatnonzero((row[1:-1] <= row[:-2]) & (row[1:-1] < row[2:])) + 1
        for i in least[row[least] < 0.1].tolist():
            if i >= last:
                break
            u, value = _least(chain, k, grid[i - 1], grid[i + 1])
            if value < -3:
                end, last = _zero(chain, grid[i - 1], u), i + 1
                break
            found.append(Place(float(u), float(value), 0, k))
    if end is None:
        return found, last
    found = [one for one in found if (float(end) - one.at) * way >= 0]
    return [*found, Place(float(end), 0.0, -way)], last


def _least(chain: Chain, k: int, low: Long, high: Long) -> tuple[Long, Long]:
    for _ in range(22):
        grid = np.linspace(low, high, 25)
        left = chain.discriminants(grid)[k]
        at = int(np.nanargmin(left))
        low, high = grid[max(at - 1, 0)], grid[min(at + 1, 24)]
    return grid[at], chain.judged(grid[at : at + 1])[2][k, 0]


def _zero(chain: Chain, inside: Long, outside: Long) -> Long:
    for _ in range(16):
        grid = np.linspace(inside, outside, 33)
        left = chain.discriminants(grid)
        over = np.flatnonzero(~(left.min(axis=0) >= 0))
        at = int(over[0]) if over.size else 32
        inside, outside = grid[max(at - 1, 0)], grid[at]
    return inside


def _clear(rng: random.Random, chain: Chain, span: float) -> Long | None:
    """A value at which all dyads close well, within reach of the branch point at zero."""
    for _ in range(20):
        u = Long(repr(rng.choice([-1, 1]) * rng.uniform(0.1, 0.8)))
        if chain.discriminants(np.array([u])).min() > 0.01:
            return u
    return None


def _chain(rng: random.Random, count: int, folding: int) -> Chain | None:
    planar = rng.random() < 0.5
    turns = rng.random() < 0.75 or folding == 0
    first = Link(turns, (ZERO, ZERO, ZERO), Z if turns else _direction(rng))
    link, at, size = first, first.foot, Decimal(1)
    dyads: list[Dyad] = []
    for k in range(count):
        size *= Decimal(10) ** rng.choice([0, 0, 0, -1, 1])
        dyad = None
        for _ in range(60):
            last = k + 1 == folding
            tried = (
                _folding(rng, link, at, size, count > 1)
                if k == folding
                else _drawn(rng, link, at, size, planar or k < folding, last)
            )
            u = np.zeros(1, Long)
            if k == folding or (tried.discriminant(u)[0] > 0.05 and tried.roundings(u)[0] < 1e-11):
                dyad = tried
                break
        if dyad is None:
            return None
        dyads.append(dyad)
        link, at = dyad.output, dyad.output.foot if dyad.output.turns else dyad.end
    return Chain(first, tuple(dyads))


def _decimal(rng: random.Random, most: float, size: Decimal) -> Decimal:
    return Decimal(f"{rng.uniform(-most, most):.3f}") * size


def _point(parts: Iterable[Decimal]) -> Point:
    x, y, z = parts
    return x, y, z


def _direction(rng: random.Random) -> Point:
    x, y = rng.choice(DIRECTIONS)
    return Decimal(x), Decimal(y), ZERO


def _drawn(
    rng: random.Random, link: Link, at: Point, size: Decimal, planar: bool, turning: bool
) -> Dyad:
    """A dyad drawn closed."""

    def beside(point: Point, most: float) -> Point:
        flat = [_decimal(rng, most, size) for _ in range(3)]
        return point[0] + flat[0], point[1] + flat[1], ZERO if planar else point[2] + flat[2]

    kinds = ["RRR", "RPR"] if planar else ["SSR", "SCR"]
    kind = rng.choice(kinds if turning else [*kinds, kinds[0][:2] + "P"])
    start, foot = beside(at, 1.5), beside(at, 2)
    end = beside(foot, 1.5)
    turns = kind[2] == "R"
    axis: Sequence[Decimal] = Z if turns else _direction(rng)
    along: Sequence[Decimal] = _direction(rng)
    if not planar:
        axis, along = ([_decimal(rng, 1, Decimal(1)) for _ in range(3)] for _ in range(2))
    if kind[1] == "C":
        # on the axis of the cylinder, through the output's foot
        part = Decimal(rng.choice(["0.5", "1", "-0.75"])) * size
        end = _point(f + part * x for f, x in zip(foot, along, strict=True))
    dyad = Dyad(kind, link, Link(turns, foot, _point(axis)), start, end, None, _point(along), 1)
    return dyad._replace(side=dyad.drawn_side())


def _folding(rng: random.Random, link: Link, at: Point, size: Decimal, tilted: bool) -> Dyad:
    """A four-bar that lies in line at zero, its rod too long or too short by a part."""
    x, y = map(Decimal, rng.choice(DIRECTIONS))
    crank, rocker, ground = (Decimal(f"{rng.uniform(0.3, 1.5):.3f}") * size for _ in range(3))
    foot = at[0] + ground * x, at[1] + ground * y, at[2]
    way = rng.choice([1, -1])
    start = at[0] + crank * x, at[1] + crank * y, at[2]
    end = foot[0] + way * rocker * x, foot[1] + way * rocker * y, at[2]
    rod = abs(ground + way * rocker - crank)
    part = rng.choice([0.0, 1.0, 1.0, 1.0, -1.0]) * 10 ** rng.uniform(-14, -1)
    rod *= 1 + Decimal(f"{part:.3e}")
    side = rng.choice([1, -1])
    return Dyad("RRR", link, Link(True, foot, Z), start, end, rod, (ZERO,) * 3, side)
