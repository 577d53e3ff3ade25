"""Where the rows of a family lie, and what a linkage says of them."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from benchmarks.stress.draws import uniform
from benchmarks.stress.family import Block
from benchmarks.stress.linkages.moving import turning
from benchmarks.stress.linkages.train import Train
from benchmarks.stress.linkages.writing import decimals
from benchmarks.stress.numbers.double_double import DEGREE, radians
from benchmarks.stress.numbers.series import Number
from benchmarks.stress.quantity import Quantity, Rows, Truth
from benchmarks.stress.reach import Margin, Reach, reach

PAST_END = 1.15
"""Sweeps go up to this part of the way to a dead centre."""
FULL = 400.0
"""Degrees that are swept where there is no dead centre."""


class Driven(Protocol):
    """A linkage that is driven at A.theta."""

    def quantities(self, angle: Number) -> tuple[Quantity, ...]:
        """The coordinates at the crank's angle in rad."""
        ...

    def as_written(self) -> Driven:
        """The same of the numbers that its files say, in place of their doubles."""
        ...

    def size(self) -> Rows:
        """What lengths are taken by, in m."""
        ...


class Linkage(Driven, Protocol):
    """One with a single discriminant."""

    def margin(self, angle: Number) -> Margin:
        """The discriminant at the crank's angle in rad."""
        ...

    def text(self, k: int, name: str, degrees: Rows) -> str:
        """Mechanism k as a file."""
        ...


def block(linkage: Linkage, name: str, found: Reach, degrees: Rows) -> Block:
    """The linkage's mechanisms at these rows, each of which begins at the drawing."""
    texts = [linkage.text(k, name, row) for k, row in enumerate(degrees)]

    def truth(places: Rows) -> Truth:
        exists, decided = found.decide(radians(places))
        return Truth(linkage.quantities(turning(places)), exists, decided, linkage.size())

    return Block(texts, degrees, truth, written_truth(linkage))


def written_truth(linkage: Driven) -> Callable[[Rows], Truth]:
    """What is true at places in degrees that exist, of the numbers that the files say."""
    exact = linkage.as_written()

    def truth(places: Rows) -> Truth:
        every = np.ones(places.shape, bool)
        return Truth(exact.quantities(turning(decimals(places))), every, every, linkage.size())

    return truth


def through(linkage: Linkage, name: str, generators: Sequence[random.Random], count: int) -> Block:
    """Rows of `swept`."""
    return block(linkage, name, *swept(linkage, generators, count))


def swept(linkage: Linkage, generators: Sequence[random.Random], count: int) -> tuple[Reach, Rows]:
    """How far the branches go, and rows (mechanisms, count) in degrees from the drawing towards an
    end of the branch, some beyond it, or a full turn."""
    found = reach(linkage.margin, len(generators))
    sense, ends = towards(found, generators)
    last = []
    for rng, s, end in zip(generators, sense[:, 0], ends, strict=True):
        part = uniform(rng, 0.2, PAST_END)
        last.append([end * part if np.isfinite(end) else s * FULL * part])
    steps = np.arange(count) / (count - 1)
    return found, np.array(last) * steps


def towards(found: Reach, generators: Sequence[random.Random]) -> tuple[Rows, Rows]:
    """A sense (mechanisms, 1), and the end of the branch that way in degrees (mechanisms,), nan
    where there is none."""
    sense = np.array([[rng.choice((-1.0, 1.0))] for rng in generators])
    ends = found.ends(sense) / DEGREE
    return sense, ends.high[:, 0]


def turning_truth(train: Train) -> Callable[[Rows], Truth]:
    """What is true of drag links at places in degrees."""
    exists, decided = train.turns_fully()

    def truth(places: Rows) -> Truth:
        every = np.ones(places.shape, bool)
        return Truth(
            train.quantities(turning(places)), exists & every, decided & every, train.size()
        )

    return truth
