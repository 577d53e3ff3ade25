"""Random polynomials of time are enclosed in every row, against fractions; thousands of rows more
with MECHKIN_RANDOM=20.

In the units of the file an angle (degrees), a slide and its rates (mm, s) are rational numbers.
"""

from __future__ import annotations

import os
import random
from fractions import Fraction
from math import perm
from typing import NamedTuple

import numpy as np

import mechkin_cli as mk

COUNT = 60 * int(os.environ.get("MECHKIN_RANDOM", "1"))
FILE = """
format: 1
units: {{angle: deg, length: mm}}
links: {{arm: {{}}, block: {{}}}}
joints:
  O: {{type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}
  S: {{type: P, links: [arm, block], point: [0, 0, 0], axis: [1, 0, 0]}}
motion:
  time: {{from: {first}, to: {last}, count: {count}}}
  inputs:
    O.theta: {{law: polynomial, coefficients: [{angles}]}}
    S.s: {{law: polynomial, coefficients: [{lengths}]}}
"""
QUANTITIES = {"O.theta": 0, "S.s": 0, "S.s_dot": 1, "S.s_ddot": 2, "S.s_dddot": 3}
"""With their orders."""


class Course(NamedTuple):
    """Numbers as the file writes them."""

    first: str
    last: str
    count: int
    coefficients: tuple[str, ...]

    @property
    def text(self) -> str:
        angles, lengths = (
            ", ".join(f"{c} {unit}/s^{k}" if k else f"{c} {unit}" for k, c in self.terms)
            for unit in ("deg", "mm")
        )
        own = self._asdict() | {"angles": angles, "lengths": lengths}
        return FILE.format(**own)

    @property
    def terms(self) -> list[tuple[int, str]]:
        return list(enumerate(self.coefficients))

    def true(self, row: int, order: int) -> Fraction:
        """A derivative in a row, in the file's units."""
        time = (Fraction(self.last) - Fraction(self.first)) * row / (self.count - 1)
        parts = (
            perm(k, order) * Fraction(c) * time ** (k - order) for k, c in self.terms if k >= order
        )
        return sum(parts, Fraction(0))


def course(number: int) -> Course:
    """One that depends on its number alone; its terms nearly cancel here and there."""
    rng = random.Random(number * 1_000_003 + 14)
    first = rng.uniform(0, 1)
    last = first + rng.uniform(0.5, 3)
    terms = [rng.uniform(-90, 90), *(rng.uniform(-20, 20) for _ in range(rng.randint(1, 5)))]
    count = rng.choice([7, 13, 20])
    return Course(f"{first:.3f}", f"{last:.3f}", count, tuple(f"{c:.3f}" for c in terms))


def test_every_row_that_is_proven_is_enclosed() -> None:
    outside = []
    for number in range(COUNT):
        one = course(number)
        proofs = mk.loads(one.text).certify()
        assert (proofs.status == "proven").all()
        for name, order in QUANTITIES.items():
            low, high = proofs.enclosure(name)
            for row in range(one.count):
                bounds = (low[row], high[row])
                if not np.isfinite(bounds).all() or not (
                    Fraction(bounds[0]) <= one.true(row, order) <= Fraction(bounds[1])
                ):
                    outside.append((number, name, row, bounds))
    assert not outside, outside[:10]


def test_another_polynomial_is_outside() -> None:
    one = course(0)
    low, high = mk.loads(one.text).certify().enclosure("O.theta")
    other = one._replace(coefficients=(f"{one.coefficients[0]}000000001", *one.coefficients[1:]))
    row = one.count - 1
    assert low[row] <= float(one.true(row, 0)) <= high[row]
    assert not Fraction(low[row]) <= other.true(row, 0) <= Fraction(high[row])
