"""Ranges and circuits of one loop against the zeros of its discriminant.

Both assemblies at the drawn input have the same discriminant, and so the same range: up to its next
zeros, where they meet and are one circuit, or the whole turn, and two circuits.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

import numpy as np
from oracle.numerics import Number, mp
from random_families.no_wrong_row.branch import TURN, Undecided, Way, way
from random_families.no_wrong_row.case import random_gap, text_of
from random_families.no_wrong_row.design import Impossible, random_unit
from random_families.no_wrong_row.drawing import Drawing
from random_families.no_wrong_row.field import EXACT
from random_families.no_wrong_row.loops import crank, in_plane, in_space, on_sphere
from random_families.no_wrong_row.travel import monotone

import mechkin_cli as mk

LOOPS = (in_plane, in_space, on_sphere)
DEAD_CENTRE = 1e-9
"""Degrees that a dead centre may be off, but for what a rounding of the discriminant moves it."""


@dataclass
class Loop:
    """A file with one loop, and the way of its assemblies up and down."""

    what: str
    text: str
    drawing: Drawing
    up: Way
    down: Way

    def shift(self, one: Way) -> float:
        """How far roundings of the discriminant's terms move an end, in degrees."""
        linkage, name = self.drawing.linkage(), one.folds

        def margin(t: Number) -> Number:
            return linkage.at(one.sign * t, EXACT, name).margin[name]

        end, step = mp.mpf(one.end), mp.mpf(10) ** -20
        slope = (margin(end + step) - margin(end - step)) / (2 * step)
        return math.degrees(5e-15 / abs(float(slope)))


def looped(number: int) -> Loop:
    """A loop that depends on its number alone; half of those near a change point do not turn."""
    attempt = 0
    while True:
        rng = random.Random(number * 1_000_003 + attempt + 7 * 10**15)
        attempt += 1
        drawing = Drawing(rng)
        crank(drawing, "A", np.zeros(3), random_unit(rng))
        gap = rng.choice([-1, 1]) * random_gap(rng)
        try:
            LOOPS[number % 3](drawing, rng, "B", gap)
            up, down = (way(drawing.linkage(), sign, TURN) for sign in (1, -1))
        except (Impossible, Undecided):
            continue
        if len(drawing.columns) > 2 or (up.folds is None) != (down.folds is None):
            continue
        rows = monotone(np.array([0.0, 1.0]), "{from: 0, to: 1, step: 1}")
        return Loop(drawing.families[0], text_of(drawing, rows), drawing, up, down)


def contradiction(loop: Loop) -> str:
    """What `ranges` says otherwise; "" if nothing."""
    found = mk.loads(loop.text).ranges()
    if len(found.ranges) != 2:
        return f"{len(found.ranges)} modes for 2"
    sizes = sorted(len(circuit) for circuit in found.circuits)
    if sizes != ([1, 1] if loop.up.folds is None else [2]):
        return f"circuits of {sizes} modes; {ends(loop)}"
    for item in found.ranges:
        if loop.up.folds is None:
            if item.turns != 1:
                return f"mode {item.mode} turns fully after {item.turns} turns for 1; {ends(loop)}"
            continue
        for limit, one in ((item.upper, loop.up), (item.lower, loop.down)):
            want = math.degrees(one.sign * one.end)
            if limit.kind != "dead-centre":
                return f"mode {item.mode} ends by {limit.kind}; {ends(loop)}"
            if not abs(limit.value - want) <= DEAD_CENTRE + loop.shift(one):
                return f"mode {item.mode} ends at {limit.value:.15g}; {ends(loop)}"
    return ""


def ends(loop: Loop) -> str:
    if loop.up.folds is None:
        return "both modes turn fully"
    down, up = (math.degrees(one.sign * one.end) for one in (loop.down, loop.up))
    return f"both go from {down:.15g} to {up:.15g}"
