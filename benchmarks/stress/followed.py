"""Loops without a closed form: followed from the drawing in doubles, closed in double-double.

A loop gives the gaps of its closing equations at any unknowns, over any numbers. Along its inputs
it is followed in small steps as long as it stays far from its singular places: no other assembly is
near there, so that the one that Newton's method closes is that of the drawing. The derivatives are
those of Taylor series of the gaps; values, rates and accelerations are refined together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from benchmarks.stress.linkages.moving import Field
from benchmarks.stress.numbers.double_double import DoubleDouble
from benchmarks.stress.numbers.doubles import Doubles
from benchmarks.stress.numbers.series import Number, Series
from benchmarks.stress.quantity import Mask, Rows

STEPS = 120
"""From the drawing to the farthest place, the first ones short: drawings may be next to singular
places."""
CLEAR = 0.1
"""What the tangent's miss times the inverse may be: Newton's method from there has one solution
within reach where that, times the bend of the equations, some units, is below a half
(Kantorovich)."""
REFINEMENTS = 6
"""By an inverse in doubles: each adds 14 digits to the values; the rates follow one behind."""
CLOSED = 1e-26
"""The last refinement, where all is well."""


class Loop(Protocol):
    """Mechanisms of one make."""

    @property
    def unknowns(self) -> int:
        """How many equations and unknowns, rad and sizes, there are."""
        ...

    def inputs(self, places: Rows, field: Field) -> list[Series]:
        """Those at places (mechanisms, rows), with their rates in time; `field` makes numbers of
        doubles."""
        ...

    def gaps(
        self, inputs: Sequence[Number], unknowns: Sequence[Number], field: Field
    ) -> list[Number]:
        """What is left of the closing equations, in rad and sizes."""
        ...


@dataclass(frozen=True)
class Way:
    """A loop followed to places (mechanisms, STEPS + 1), with its unknowns there (mechanisms,
    STEPS + 1, unknowns), and how many of them are clear (mechanisms,)."""

    loop: Loop
    places: Rows
    states: Rows
    clear: Rows

    def guess(self, places: Rows) -> list[Rows]:
        """The unknowns at places (mechanisms, rows) in between, by straight lines."""
        found = np.empty((*places.shape, self.loop.unknowns))
        for k, own in enumerate(self.places):
            at = np.sqrt(np.clip(places[k] / own[-1], 0.0, 1.0)) * STEPS
            below = np.minimum(at.astype(int), STEPS - 1)
            part = (at - below)[:, None]
            found[k] = (1.0 - part) * self.states[k, below] + part * self.states[k, below + 1]
        return [found[..., n] for n in range(self.loop.unknowns)]

    def closed(self, places: Rows, field: Field) -> tuple[list[Series], Mask]:
        """The unknowns at places in double-double, with their rates, and whether they are sure."""
        loop, count = self.loop, self.loop.unknowns
        inputs = loop.inputs(places, field)
        zeros = np.zeros(places.shape)
        guess = self.guess(places)
        inverse = np.linalg.inv(_jacobian(loop, [_doubles(x) for x in inputs], guess)[1])
        found = [Series(DoubleDouble(q), DoubleDouble(zeros), DoubleDouble(zeros)) for q in guess]
        last = zeros
        for turn in range(REFINEMENTS):
            if turn == 2:
                near = [q.value.high for q in found]
                at = [_doubles(x) for x in inputs]
                inverse = np.linalg.inv(_jacobian(loop, at, near)[1])
            gaps = loop.gaps(inputs, found, field)
            steps = [_step(inverse, gaps, n) for n in range(count)]
            found = [q - step for q, step in zip(found, steps, strict=True)]
            last = np.max([np.abs(step.value.high) for step in steps], axis=0)
        within = np.abs(places) <= np.abs(self._last())
        return found, within & (last < CLOSED)

    def _last(self) -> Rows:
        """The farthest clear place of each mechanism (mechanisms, 1)."""
        last = np.maximum(self.clear - 1, 0)
        return np.take_along_axis(self.places, last[:, None], axis=1)

    def farthest(self) -> Rows:
        """How far each mechanism goes and stays clear (mechanisms,)."""
        return self._last()[:, 0]


def follow(loop: Loop, farthest: Rows) -> Way:
    """From the drawing, where all unknowns are zero, towards the farthest places (mechanisms,
    1)."""
    places = farthest * (np.arange(STEPS + 1) / STEPS) ** 2
    rows = [x.value.high for x in loop.inputs(places, DoubleDouble)]
    count = len(places)
    states = np.zeros((count, STEPS + 1, loop.unknowns))
    clear, going = np.zeros(count, int), np.ones(count, bool)
    state = states[:, 0]
    for k in range(STEPS + 1):
        here = [x[:, k : k + 1] for x in rows]
        for _ in ("tangent", "miss"):
            guess = [state[:, n : n + 1] for n in range(loop.unknowns)]
            gap, matrix = _jacobian(loop, here, guess)
            inverse = np.linalg.inv(_regular(matrix[:, 0]))
            step = np.einsum("mij,mj->mi", inverse, gap[:, 0])
            state = state - np.where(np.isfinite(step), step, 0.0)
        reach = np.abs(inverse).sum(axis=2).max(axis=1)
        going &= reach * np.abs(step).max(axis=1) < CLEAR
        clear += going
        # those that are lost stay where they are
        state = np.where(going[:, None], state, states[:, max(k - 1, 0)])
        states[:, k] = state
    return Way(loop, places, states, clear)


def _jacobian(loop: Loop, inputs: Sequence[Rows], unknowns: Sequence[Rows]) -> tuple[Rows, Rows]:
    """The gaps (mechanisms, rows, equations) and their derivatives (mechanisms, rows, equations,
    unknowns) in doubles: one series for each unknown, side by side."""
    count, shape = loop.unknowns, unknowns[0].shape
    each = np.eye(count)

    def beside(rows: Rows) -> Rows:
        return np.repeat(rows, count, axis=1)

    zeros = Doubles(0.0)
    moving = [
        Series(Doubles(beside(q)), Doubles(np.tile(each[n], shape[1])[None, :]), zeros)
        for n, q in enumerate(unknowns)
    ]
    driven = [Series(Doubles(beside(x)), zeros, zeros) for x in inputs]
    gaps = loop.gaps(driven, moving, Doubles)
    wide = (shape[0], shape[1], count)
    values = [np.broadcast_to(g.value.high, (shape[0], shape[1] * count)) for g in gaps]
    rates = [np.broadcast_to(g.rate.high, (shape[0], shape[1] * count)) for g in gaps]
    value = np.stack([v.reshape(wide)[..., 0] for v in values], axis=-1)
    return value, np.stack([r.reshape(wide) for r in rates], axis=-2)


def _step(inverse: NDArray[Any], gaps: Sequence[Series], n: int) -> Series:
    """What the gaps ask of unknown n; the inverse is one of doubles, and so need not be exact."""
    total: Series | None = None
    for m, gap in enumerate(gaps):
        part = gap * inverse[..., n, m]
        total = part if total is None else total + part
    assert total is not None
    return total


def _doubles(series: Series) -> Rows:
    value: Rows = series.value.high
    return value


def _regular(matrix: Rows) -> Rows:
    """Singular ones are told by a large inverse, and not by an error."""
    good = np.isfinite(matrix).all(axis=(1, 2)) & (np.abs(np.linalg.det(matrix)) > 0.0)
    return np.where(good[:, None, None], matrix, np.eye(matrix.shape[1]) * 1e-30)
