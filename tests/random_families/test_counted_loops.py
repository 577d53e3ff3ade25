"""Loops whose number of assemblies is a closed form: all are found, and said to be all.

Planar four-bars and slider-cranks, Hooke's joint, spherical 4R, RSSR, RSSP and RCCC, in any
position in space.
`MECHKIN_RANDOM` multiplies the number of cases.
"""

from __future__ import annotations

import math
import os
import random
from collections import Counter
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.search.search import all_assemblies
from mechkin_cli.session.session import Session
from mechkin_cli.structure.graph import UnsolvableGraph

CASES = 12 * int(os.environ.get("MECHKIN_RANDOM", "1"))
NEAR = 1e-3
"""Cases as near to the border between two numbers are drawn again."""

Z = np.array([0.0, 0.0, 1.0])


class Case(NamedTuple):
    """Links and joints of a file with the driven joint first, and the number of assemblies."""

    links: list[str]
    joints: list[str]
    count: int
    at: float = 0.0


def rotation(rng: random.Random) -> np.ndarray:
    q, r = np.linalg.qr([[rng.gauss(0, 1) for _ in range(3)] for _ in range(3)])
    q = q * np.sign(np.diag(r))
    return q * np.sign(np.linalg.det(q))


def about(axis: np.ndarray, angle: float, vector: np.ndarray) -> np.ndarray:
    axis = axis / np.linalg.norm(axis)
    along = axis * (axis @ vector)
    across = np.cross(axis, vector)
    return along + math.cos(angle) * (vector - along) + math.sin(angle) * across


def direction(rng: random.Random) -> np.ndarray:
    v = np.array([rng.gauss(0, 1) for _ in range(3)])
    return v / np.linalg.norm(v)


def place(rng: random.Random) -> np.ndarray:
    return np.array([rng.uniform(-1, 1) for _ in range(3)])


def written(value: np.ndarray) -> str:
    return str([float(x) for x in value])


def lies_between(value: float, low: float, high: float) -> int | None:
    """2 inside, 0 outside, None near the ends."""
    if min(abs(value - low), abs(value - high)) < NEAR:
        return None
    return 2 if low < value < high else 0


def planar(rng: random.Random, slider: bool) -> Case | None:
    a, b, c = (rng.uniform(0.3, 1.5) for _ in range(3))
    turn, shift = rotation(rng), place(rng)

    def at(x: float, y: float) -> str:
        return written(turn @ [x, y, 0.0] + shift)

    n = written(turn @ Z)
    pivot = (rng.uniform(-2, 2), rng.uniform(-2, 2))
    joints = [
        f"{{type: R, links: [ground, L1], point: {at(0, 0)}, axis: {n}}}",
        f"{{type: R, links: [L1, L2], point: {at(a, 0)}, axis: {n}}}",
        f"{{type: R, links: [L2, L3], point: {{L2: {at(a + b, 0)}, "
        f"L3: {at(pivot[0] + c, pivot[1])}}}, axis: {n}}}",
    ]
    if slider:
        angle = rng.uniform(0, math.tau)
        along = np.array([math.cos(angle), math.sin(angle)])
        axis = written(turn @ [*along, 0.0])
        joints.append(f"{{type: P, links: [ground, L3], point: {at(*pivot)}, axis: {axis}}}")
        off = np.array([pivot[0] + c - a, pivot[1]])
        # the rod's other end runs on a line at this distance from the crank's end
        count = lies_between(abs(off[0] * along[1] - off[1] * along[0]), 0.0, b)
        count = 0 if count == 0 else count
    else:
        joints.append(f"{{type: R, links: [ground, L3], point: {at(*pivot)}, axis: {n}}}")
        distance = math.hypot(pivot[0] - a, pivot[1])
        count = lies_between(distance, abs(b - c), b + c)
    return None if count is None else Case(["L1", "L2", "L3"], joints, count)


def spherical(rng: random.Random, slides: bool) -> Case | None:
    """4R about one point; as RCCC the directions are the same and the axes lie anywhere."""
    first, second, third, last = (direction(rng) for _ in range(4))
    elsewhere = direction(rng)
    centre = place(rng)
    kinds = "RCCC" if slides else "RRRR"
    points = [place(rng) if slides else centre + rng.uniform(-1, 1) * z for z in (first, second)]
    points.append(place(rng) if slides else centre)
    points.append(place(rng) if slides else centre + rng.uniform(-1, 1) * last)
    joints = [
        f"{{type: R, links: [ground, L1], point: {written(points[0])}, axis: {written(first)}}}",
        f"{{type: {kinds[1]}, links: [L1, L2], point: {written(points[1])}, "
        f"axis: {written(second)}}}",
        f"{{type: {kinds[2]}, links: [L2, L3], point: {written(points[2])}, "
        f"axis: {{L2: {written(third)}, L3: {written(elsewhere)}}}}}",
        f"{{type: {kinds[3]}, links: [ground, L3], point: {written(points[3])}, "
        f"axis: {written(last)}}}",
    ]
    coupler = math.acos(second @ third)
    rocker = math.acos(elsewhere @ last)
    gap = math.acos(second @ last)
    whole = coupler + rocker
    count = lies_between(gap, abs(coupler - rocker), min(whole, math.tau - whole))
    return None if count is None else Case(["L1", "L2", "L3"], joints, count)


def leg(rng: random.Random, slider: bool) -> Case | None:
    """RSSR and RSSP: a rod from the crank's end to a circle or a line."""
    axes, points = [direction(rng) for _ in range(2)], [place(rng) for _ in range(4)]
    length = rng.uniform(0.2, 1.5)
    start, end = points[1], points[2]
    drawn = start + length * direction(rng)
    kind = "P" if slider else "R"
    joints = [
        f"{{type: R, links: [ground, L1], point: {written(points[0])}, axis: {written(axes[0])}}}",
        f"{{type: S, links: [L1, L2], point: {written(start)}}}",
        f"{{type: S, links: [L2, L3], point: {{L2: {written(drawn)}, L3: {written(end)}}}}}",
        f"{{type: {kind}, links: [ground, L3], point: {written(points[3])}, "
        f"axis: {written(axes[1])}}}",
    ]
    z = axes[1]
    if slider:
        reach = np.linalg.norm(np.cross(end - start, z))
        count = 0 if reach > length + NEAR else 2 if reach < length - NEAR else None
    else:
        arm = (end - points[3]) - z * (z @ (end - points[3]))
        centre = end - arm
        off = start - centre
        flat = np.linalg.norm(off - z * (z @ off))
        height, radius = z @ off, np.linalg.norm(arm)
        least, most = math.hypot(height, flat - radius), math.hypot(height, flat + radius)
        count = lies_between(length, least, most)
    return None if count is None else Case(["L1", "L2", "L3"], joints, count)


def inverted(rng: random.Random) -> Case | None:
    """RRPR: a link slides on the coupler, whose line passes the rocker's pivot at an offset."""
    turn, shift, a = rotation(rng), place(rng), rng.uniform(0.3, 1.5)
    pivot = np.array([rng.uniform(-2, 2), rng.uniform(-2, 2)])
    angle = rng.uniform(0, math.tau)
    across = np.array([-math.sin(angle), math.cos(angle)])
    points = [np.array([rng.uniform(-1.5, 1.5), rng.uniform(-1.5, 1.5)]) for _ in range(2)]

    def at(xy: np.ndarray) -> str:
        return written(turn @ [*xy, 0.0] + shift)

    n, along = written(turn @ Z), written(turn @ [math.cos(angle), math.sin(angle), 0.0])
    end = np.array([a, 0.0])
    joints = [
        f"{{type: R, links: [ground, L1], point: {at(np.zeros(2))}, axis: {n}}}",
        f"{{type: R, links: [L1, L2], point: {at(end)}, axis: {n}}}",
        f"{{type: P, links: [L2, L3], point: {{L2: {at(points[0])}, L3: {at(points[1])}}}, "
        f"axis: {along}}}",
        f"{{type: R, links: [ground, L3], point: {at(pivot)}, axis: {n}}}",
    ]
    offset = across @ (end - points[0]) - across @ (pivot - points[1])
    count = lies_between(abs(offset), -1.0, float(np.linalg.norm(end - pivot)))
    return None if count is None else Case(["L1", "L2", "L3"], joints, count)


def hooke(rng: random.Random) -> Case | None:
    """R-U-R with oblique axes: their drawn angle, at another input than drawn."""
    shafts, cross = [direction(rng) for _ in range(2)], [direction(rng) for _ in range(2)]
    centre, at = place(rng), rng.uniform(0, 360)
    places = [centre + rng.uniform(-1, 1) * shaft for shaft in shafts]
    joints = [
        f"{{type: R, links: [ground, L1], point: {written(places[0])}, "
        f"axis: {written(shafts[0])}}}",
        f"{{type: U, links: [L1, L2], point: {written(centre)}, axis: {written(cross[0])}, "
        f"axis2: {written(cross[1])}}}",
        f"{{type: R, links: [ground, L2], point: {written(places[1])}, "
        f"axis: {written(shafts[1])}}}",
    ]
    turned = about(shafts[0], math.radians(at), cross[0])
    one, other = math.acos(turned @ shafts[1]), math.acos(cross[1] @ shafts[1])
    drawn, whole = math.acos(cross[0] @ cross[1]), one + other
    count = lies_between(drawn, abs(one - other), min(whole, math.tau - whole))
    return None if count is None else Case(["L1", "L2"], joints, count, at)


FAMILIES: dict[str, Callable[[random.Random], Case | None]] = {
    "planar 4R": lambda rng: planar(rng, slider=False),
    "planar RRRP": lambda rng: planar(rng, slider=True),
    "planar RRPR": inverted,
    "Hooke": hooke,
    "spherical 4R": lambda rng: spherical(rng, slides=False),
    "RCCC": lambda rng: spherical(rng, slides=True),
    "RSSR": lambda rng: leg(rng, slider=False),
    "RSSP": lambda rng: leg(rng, slider=True),
}


def cases(family: str, count: int) -> list[Case]:
    rng, found = random.Random(family), []
    while len(found) < count:
        case = FAMILIES[family](rng)
        if case is not None:
            found.append(case)
    return found


def text(parts: list[Case], order: random.Random | None = None) -> str:
    """The mechanisms beside each other; shuffled, and renamed, with `order`."""
    links, joints, inputs = [], [], []
    for number, part in enumerate(parts):
        names = {name: f"{name}_{number}" for name in part.links}
        if order is not None:
            names = {name: f"{'zyxw'[number]}{order.randrange(1000)}{name}" for name in part.links}
        links += names.values()
        for k, joint in enumerate(part.joints):
            for name, new in names.items():
                joint = joint.replace(name, new)
            joints.append(f"  J{number}_{k}: {joint}")
        inputs.append(f"J{number}_0.theta: {{at: {part.at}}}")
    if order is not None:
        order.shuffle(links)
        order.shuffle(joints)
    return (
        f"format: 1\nlinks: {{{', '.join(f'{name}: {{}}' for name in links)}}}\njoints:\n"
        + "\n".join(joints)
        + f"\nmotion: {{inputs: {{{', '.join(inputs)}}}}}\n"
    )


@pytest.mark.parametrize("family", FAMILIES)
def test_all_assemblies_are_found_and_said_to_be_all(family: str) -> None:
    counts: Counter[int] = Counter()
    for case in cases(family, CASES):
        found = mk.loads(text([case])).modes()
        assert len(found.modes) == case.count, text([case])
        assert found.complete, text([case])
        assert found.bound == 2
        assert found.starts <= 512
        counts[case.count] += 1
    assert set(counts) == {0, 2}


@pytest.mark.parametrize("family", FAMILIES)
def test_the_closing_joint_does_not_change_the_count(family: str) -> None:
    told = 0
    for case in cases(family, 6):
        problem = mk.loads(text([case])).problem
        for k in range(1, len(case.joints)):
            try:
                session = Session.of(problem, closed_at=[f"J0_{k}"])
            except UnsolvableGraph:
                continue
            found = all_assemblies(session, session.inputs.values[:, 0])
            assert found.number == case.count, (k, text([case]))
            told += found.complete
    assert told >= 6


def angles(model: mk.Model, number: int) -> set[tuple[tuple[str, float], ...]]:
    """The modes as sets of wrapped coordinates of one of the mechanisms."""
    found = model.modes()
    assert found.complete
    keep = f"J{number}_"
    return {
        tuple(
            sorted(
                (name.removeprefix(keep), round(value % 360 if "theta" in name else value, 6) + 0.0)
                for name, value in mode.coordinates.items()
                if name.startswith(keep)
            )
        )
        for mode in found.modes
    }


@pytest.mark.parametrize("family", FAMILIES)
def test_two_mechanisms_beside_each_other_multiply(family: str) -> None:
    """Twice the same, another one beside it, renamed, in another order: the product of both."""
    some = cases(family, 6)
    other = next(case for case in cases("RSSR", 20) if case.count)
    for number, case in enumerate(some):
        alone = angles(mk.loads(text([case])), 0)
        assert len(alone) == case.count
        for partner in (case, other):
            both = mk.loads(text([case, partner]))
            assert len(both.modes().modes) == case.count * partner.count
            shuffled = mk.loads(text([case, partner], random.Random(number)))
            assert len(shuffled.modes().modes) == case.count * partner.count
            if case.count and partner.count:
                assert angles(both, 0) == alone == angles(shuffled, 0)
