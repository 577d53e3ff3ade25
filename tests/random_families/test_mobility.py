"""Random linkages in special positions, whose mobility closed forms decide.

Where all links of a closed polygon lie on a line (a great circle), its assembled places are, next
to the drawing, those of one quadratic form (Farber, *Invitation to Topological Robotics*, 1.3): an
isolated point if it is definite, else a cone one dimension below the first order.
MECHKIN_RANDOM multiplies the number of cases.
"""

from __future__ import annotations

import os
from itertools import product
from random import Random

import numpy as np
import pytest
import yaml
from classics.drawing import GROUND, platform, ring, rotation
from classics.planes import complete, legs, polygon
from classics.rings import great_circle

import mechkin_cli as mk

NUMBER = 6 * int(os.environ.get("MECHKIN_RANDOM", "1"))
SEEDS = range(NUMBER)
Answer = tuple[tuple[int, ...], int]


def answer(text: str) -> Answer:
    found = mk.loads(text).mobility()
    assert found.diagnostics == ()
    return tuple(d - len(found.idle) for d in found.dimensions), (found.first_order or 0) - len(
        found.idle
    )


def cone(form: np.ndarray, linear: np.ndarray, dimension: int) -> Answer:
    """Of a form on the null space of linear equations of full rank."""
    null = np.linalg.svd(linear)[2][len(linear) :].T
    values = np.linalg.eigvalsh(null.T @ form @ null)
    assert np.abs(values).min() > 1e-6
    definite = bool((values > 0).all() or (values < 0).all())
    return (0 if definite else dimension,), null.shape[1]


def line(random: Random) -> tuple[str, Answer]:
    """A polygon of bars on a line. With vectors l_i along it and bars turned by phi_i: the sum of
    l_i sin phi_i is zero to first order, that of l_i cos phi_i to second."""
    count = random.randint(3, 7)
    places = [random.uniform(-2, 2) for _ in range(count)]
    bars = np.diff([*places, places[0]])  # the last is ground
    form, linear = np.diag(bars[:-1]), bars[None, :-1]
    text = polygon(*((x, 0.0) for x in places))
    return text, cone(form, linear, count - 3)


def circle(random: Random) -> tuple[str, Answer]:
    """A spherical polygon on a great circle: of hinges a_i turned by t_i, the sum of t_i a_i is
    zero to first order, that of t_i t_j a_i x a_j / 2 over i < j to second."""
    count = random.randint(3, 7)
    angles = np.array([random.uniform(0, 2 * np.pi) for _ in range(count)])
    form = np.sin(angles[None] - angles[:, None])
    form = np.triu(form) + np.triu(form).T
    return great_circle(angles), cone(form, np.array([np.cos(angles), np.sin(angles)]), count - 3)


def _feet(random: Random, count: int) -> np.ndarray:
    return np.array([[random.uniform(-1, 1) for _ in range(3)] for _ in range(count)])


def parallel(random: Random) -> tuple[str, Answer]:
    """Equal parallel legs with feet anywhere; S-S or U-S."""
    feet = _feet(random, random.randint(4, 7))
    text = platform(
        feet, feet + _feet(random, 1) + np.array([0.0, 0.0, 2.0]), spin=random.random() < 0.5
    )
    return text, ((2,), 3)


def round_feet(random: Random) -> tuple[str, Answer]:
    """Equal parallel legs whose feet are on a cylinder along them."""
    count = random.randint(5, 7)
    turns = np.array([2 * np.pi * (k + random.uniform(0, 0.6)) / count for k in range(count)])
    feet = np.array([[np.cos(t), np.sin(t), random.uniform(-0.3, 0.3)] for t in turns])
    heads = feet + np.array([0.0, 0.0, random.uniform(0.8, 2)])
    turn = rotation([random.uniform(-1, 1) for _ in range(3)], 1.0)
    return platform(feet @ turn.T, heads @ turn.T), ((2, 1), 3)


def crossing(random: Random) -> tuple[str, Answer]:
    """Six legs that all meet a line: shaky about it."""
    turn = rotation([random.uniform(-1, 1) for _ in range(3)], random.uniform(0, 3))
    on_line = np.array([[0.0, 0.0, random.uniform(-2, 2)] for _ in range(6)])
    away = _feet(random, 6)
    feet, heads = on_line + 1.3 * away, on_line + 0.4 * away
    return platform(feet @ turn.T, heads @ turn.T), ((0,), 1)


def conic(random: Random) -> tuple[str, Answer]:
    """A complete bipartite framework on an ellipse or a hyperbola (Bolker, Roth 1980)."""
    ones, twos = random.choice([(3, 3), (3, 4)])
    hyperbola = random.random() < 0.5
    points = []
    for k in range(ones + twos):
        t = random.uniform(0.2, 0.9) + k if not hyperbola else random.uniform(-1.2, 1.2)
        x, y = (np.cosh(t) * (-1) ** k, np.sinh(t)) if hyperbola else (1.4 * np.cos(t), np.sin(t))
        points.append((float(x), float(0.8 * y)))
    random.shuffle(points)
    return complete(points[:ones], points[ones:]), ((0,), 1)


def dixon(random: Random) -> tuple[str, Answer]:
    """A complete bipartite framework on two lines that are square to each other (Dixon 1899)."""
    ones, twos = random.randint(3, 4), random.randint(3, 4)
    sides = [(-1) ** k * random.uniform(0.4, 1.0) + 0.1 * k for k in range(ones + twos)]
    return complete([(x, 0.0) for x in sides[:ones]], [(0.0, 1.2 * y) for y in sides[ones:]]), (
        (1,),
        1,
    )


def shaky_plate(random: Random) -> tuple[str, Answer]:
    """A plate on three bars that meet in a point."""
    centre = np.array([random.uniform(-1, 1), random.uniform(-1, 1)])
    feet, heads = [], []
    for k in range(3):
        t = 2 * np.pi * (k + random.uniform(0, 0.5)) / 3
        arm = np.array([np.cos(t), np.sin(t)])
        feet.append(centre + random.uniform(1.5, 2.5) * arm)
        heads.append(centre + random.uniform(0.3, 1.0) * arm)
    return legs(feet, heads), ((0,), 1)


def half_turn(random: Random) -> tuple[str, Answer]:
    """Three hinges and their images by a half turn about a line (Bricard)."""
    points, axes = _feet(random, 3), _feet(random, 3)
    image = np.array([-1.0, -1.0, 1.0])
    text = ring("RRRRRR", [*points, *points * image], [*axes, *axes * image])
    return text, ((1,), 1)


FAMILIES = [
    line, circle, parallel, round_feet, crossing, conic, dixon, shaky_plate, half_turn,
]  # fmt: skip


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.__name__)
@pytest.mark.parametrize("seed", SEEDS)
def test_as_the_closed_form_says(family, seed: int) -> None:
    text, wanted = family(Random(seed))
    assert answer(text) == wanted


@pytest.mark.parametrize("seed", SEEDS)
def test_what_stands_on_another_adds_up(seed: int) -> None:
    """Several linkages, the ground of each but the first a link of one before."""
    random = Random(seed)
    chosen = [random.choice([line, circle, round_feet, shaky_plate]) for _ in range(2)]
    drawn = [family(random) for family in chosen]
    joints, links, first = {}, [GROUND], 0
    sums = {0}
    for k, (text, (dimensions, freedom)) in enumerate(drawn):
        document = yaml.safe_load(text)
        base = random.choice(links)
        names = {GROUND: base} | {link: f"m{k}{link}" for link in document["links"]}
        for name, joint in document["joints"].items():
            joints[f"{name}_{k}"] = joint | {"links": [names[link] for link in joint["links"]]}
        links += [names[link] for link in document["links"]]
        sums = {a + b for a, b in product(sums, dimensions)}
        first += freedom
    whole = {"format": 1, "links": {link: {} for link in links[1:]}, "joints": joints}
    text = yaml.safe_dump(whole, sort_keys=False)
    assert answer(text) == (tuple(sorted(sums, reverse=True)), first)
