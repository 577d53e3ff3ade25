"""Rows along which a linkage is swept: everyday ones, and ones that ask for trouble."""

from __future__ import annotations

import random
from typing import Any

import numpy as np
from random_families.proofs.linkage import Linkage, Place

FAR = 400.0
"""Degrees either way in which an end of the branch is looked for."""
SAMPLE = 0.05
DECADES = range(10)


def ways(rng: random.Random, linkage: Linkage) -> tuple[str, list[Place]]:
    """What the rows are called, and their places."""
    if len(linkage.inputs) > 1:
        return "a broken line", _broken_line(rng, len(linkage.inputs))
    low, high = _end(linkage, -1.0), _end(linkage, 1.0)
    first, last = (round(x * rng.uniform(0.2, 0.98), 4) for x in (low, high))
    if rng.random() < 0.5:
        first, last = last, first
    kind = rng.choice([*EVERYDAY, *HOSTILE])
    if kind in EVERYDAY:
        values = list(np.linspace(first, last, rng.randint(3, 25)).round(6))
        return kind, _written(EVERYDAY[kind](rng, values, high))
    return kind, _written(HOSTILE[kind](rng, first, last))


def _end(linkage: Linkage, sense: float) -> float:
    """Where the branch ends, or how far it was followed, in degrees; sharp to rounding."""
    steps = sense * np.arange(0.0, FAR, SAMPLE)
    margin = linkage.margin([np.radians(steps)])
    beyond = np.flatnonzero(~(margin > 0.0))
    if not beyond.size:
        return sense * FAR
    before, after = steps[max(beyond[0] - 1, 0)], steps[beyond[0]]
    for _ in range(60):
        middle = 0.5 * (before + after)
        if linkage.margin([np.radians(np.array([middle]))])[0] > 0.0:
            before = middle
        else:
            after = middle
    return float(before)


def _towards(rng: random.Random, values: list[float], end: float) -> list[float]:
    """Ten rows a decade nearer to an end of the branch each, or away from it."""
    sense = np.sign(end) or 1.0
    near = [end - sense * 10.0**-k for k in DECADES if 10.0**-k < abs(end)]
    return near if rng.random() < 0.5 else near[::-1]


def _beyond(rng: random.Random, values: list[float], end: float) -> list[float]:
    """On beyond the end, and back."""
    return [*values, end + np.sign(end) * rng.choice([1e-6, 0.1, 5.0]), *values[::-1]]


EVERYDAY = {
    "even": lambda rng, values, end: values,
    "shuffled": lambda rng, values, end: rng.sample(values, len(values)),
    "towards an end": _towards,
    "beyond an end": _beyond,
}
HOSTILE = {
    "one row": lambda rng, first, last: [first],
    "repeated": lambda rng, first, last: [first, first, last, last, last, first],
    "constant": lambda rng, first, last: [first] * rng.randint(2, 9),
    "turns apart": lambda rng, first, last: [
        x + 360.0 * rng.choice([1, -10, 25, 100]) for x in (first, last, first, last)
    ],
    "far apart": lambda rng, first, last: [first, last, first + 1e9, last, -1e9, last],
}


def _broken_line(rng: random.Random, inputs: int) -> list[Place]:
    places = [(0.0,) * inputs]
    for _ in range(rng.randint(2, 12)):
        far = rng.choice([1.0, 10.0, 40.0, 360.0])
        places.append(tuple(round(x + rng.uniform(-far, far), 5) for x in places[-1]))
    return [tuple(repr(x) for x in place) for place in places]


def _written(values: list[Any]) -> list[Place]:
    return [(repr(float(x)),) for x in values]
