"""Half turns within a part of the input that float64 does not hold, in the reference itself.

A shaft on a universal joint has its arm at the angle b of tan(b) = cos(c) tan(a), with c between
the shafts and a the driving arm's angle from their common normal. The ratio of the speeds,
cos(c) / (1 - sin(c)^2 cos(a)^2), keeps its sign: b goes by half a turn with every half turn of a,
the way that the sign says, however near to a right angle c is.
"""

from __future__ import annotations

import math
import random

import numpy as np
from oracle.numerics import mpmath_context as mp
from random_families.no_wrong_row.bodies import Body, Level
from random_families.no_wrong_row.branch import TURN, Undecided, way
from random_families.no_wrong_row.design import Impossible, random_unit
from random_families.no_wrong_row.drawing import Drawing
from random_families.no_wrong_row.loops import crank
from random_families.no_wrong_row.more_loops import hooked

NEAR = 1e-3
"""Rad that a place known to 1e-16 may be off where it is not within a half turn."""


def exact(v: tuple[float, ...]) -> mp.matrix:
    return mp.matrix([mp.mpf(x) for x in v])


def dot(a: mp.matrix, b: mp.matrix) -> mp.mpf:
    return mp.fsum(x * y for x, y in zip(a, b, strict=True))


def cross(a: mp.matrix, b: mp.matrix) -> mp.matrix:
    return mp.matrix([a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)])


def unit(a: mp.matrix) -> mp.matrix:
    return a / mp.sqrt(dot(a, a))


def shaft(driver: Body, body: Body, turned: mp.mpf) -> mp.mpf:
    """The angle of a shaft since the drawing, without jumps, from that of its driver."""
    one, two = unit(exact(driver.axis)), unit(exact(body.axis))
    normal, cosine = unit(cross(one, two)), dot(one, two)
    assert isinstance(body.rod, Level)
    arm = exact(body.rod.other.base)
    drawn = mp.atan2(dot(arm, cross(one, normal)), dot(arm, normal))

    def angle(a: mp.mpf) -> mp.mpf:
        half_turns = mp.nint(a / mp.pi)
        return mp.sign(cosine) * half_turns * mp.pi + mp.atan(cosine * mp.tan(a))

    return angle(drawn + turned) - angle(drawn)


def chain(rng: random.Random) -> Drawing:
    """A crank and shafts one behind the other, all nearly at right angles."""
    while True:
        drawing = Drawing(rng)
        crank(drawing, "A", np.zeros(3), random_unit(rng))
        driver = drawing.bodies[0]
        try:
            for k in range(rng.randint(2, 3)):
                gap = rng.choice([-1, 1]) * 10 ** rng.uniform(-12, -6)
                driver = hooked(drawing, rng, f"B{k}", driver, math.pi / 2 - gap)
        except Impossible:
            continue
        return drawing


def test_half_turns_go_the_way_of_the_ratio() -> None:
    seen = 0
    for seed in range(8):
        drawing = chain(random.Random(seed))
        for sign in (1, -1):
            try:
                one = way(drawing.linkage(), sign, TURN, judging=True)
            except Undecided:
                continue
            for k in range(0, len(one.t), 7):
                turned, driver = sign * mp.mpf(float(one.t[k])), drawing.bodies[0]
                for body in drawing.bodies[1:]:
                    turned, driver = shaft(driver, body, turned), body
                    off = float(one.value[body.name][k] - turned)
                    # within a half turn the place is rounding
                    if abs(off - TURN * round(off / TURN)) < NEAR:
                        assert abs(off) < NEAR, (seed, sign, body.name, one.t[k])
                        seen += 1
    assert seen > 1000
