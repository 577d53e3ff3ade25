"""A stretch of rows of a sweep at rest: many rows beyond a known one, predicted and corrected at
once, and as many of them as are surely on the branch of equilibria.

The coordinates at rest are extrapolated by a polynomial in the rows, as far as its last term tells
that it holds. Some of the rows, the nodes, are corrected by Newton's method, each with its own
stiffness, in one call of the kernel for all of them; the rows between follow by interpolation and
two corrections with the stiffness interpolated likewise. What is corrected may lie on another
branch, so each row is judged against the one before it.
"""

from __future__ import annotations

from functools import cache
from math import comb
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import eliminated
from mechkin_cli.record import NamedTuple
from mechkin_cli.statics.forces import determinant
from mechkin_cli.statics.places import Places

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.statics.places import Place, Statics

    Rows = NDArray[np.intp]


class Beside(NamedTuple):
    """What is known about places and beside them.

    Attributes:
        stiffness: (free, free, places).
        pushes: (ways, free, places) what the forces change by along each way.
        good: which of all that have values (places,).
    """

    stiffness: Floats
    pushes: Floats
    good: Bools


class Span(NamedTuple):
    """Rows of a stretch that were predicted together, of which some, the nodes, are corrected.

    Attributes:
        told: numbers of the known row before it and of the nodes, evenly spaced (1 + nodes,).
        places: of all these.
        stiffness: (free, free, 1 + nodes).
    """

    told: Rows
    places: Places
    stiffness: Floats

    @property
    def size(self) -> int:
        """Number of its rows up to the last node."""
        return abs(int(self.told[-1]) - int(self.told[0]))


class Taken(NamedTuple):
    """Rows that are surely on the branch.

    Attributes:
        rows: their numbers, onward from the known one.
        free: the coordinates at rest there (free, rows).
        place: the last of them.
        nodes: numbers of rows whose stiffness is known, the known one first.
        stiffness: (free, free, nodes).
    """

    rows: Rows
    free: Floats
    place: Place
    nodes: Rows
    stiffness: Floats


class Stretches:
    """Stretches of the rows of a sweep at rest.

    Args:
        statics: the forces about its places.
        values: all inputs (inputs, rows), kernel units; those of the coordinates at rest count in
            rows that are known.
        times: of the rows (rows,), s.
    """

    def __init__(self, statics: Statics, values: Floats, times: Floats) -> None:
        self.statics, self.values, self.times = statics, values, times
        self.free = statics.free
        self.most, self.most_spans = tolerances.MOST_REST_ROWS, tolerances.MOST_REST_SPANS
        # beside a place along each coordinate at rest (inputs, 1 + 2 free, 1)
        count, h = len(self.free), tolerances.NEWTON_DIFFERENCE
        self._steps = np.zeros((len(values), 1 + 2 * count, 1))
        for number, k in enumerate(self.free):
            self._steps[k, 1 + 2 * number], self._steps[k, 2 + 2 * number] = h, -h
        self._free_rows = np.array(self.free)[:, None]
        self.driven = [k for k in range(len(values)) if k not in statics.free]

    def onward(self, place: Place, known: list[int], step: int) -> Taken | None:
        """The next rows, in a direction `step` (1 or -1) from the last of those that are known, at
        `place`; None where not even one is surely on the branch.
        """
        while True:
            spans = self._spans(place, known, step)
            if not spans:
                return None
            taken = self._filled(place, known, spans)
            if taken is not None:
                return taken
            if len(spans) == 1 and spans[0].size == 1:
                return None
            self.most, self.most_spans = max(1, spans[0].size // tolerances.REST_GROWTH), 1

    def _spans(self, place: Place, known: list[int], step: int) -> list[Span]:
        """The next spans, each from the last node of the one before; their nodes are put into
        `values`."""
        spans: list[Span] = []
        told = known[0] + step * np.arange(len(known))
        while len(spans) < self.most_spans:
            span = self._span(place, told, step)
            if span is None:
                break
            spans.append(span)
            place, nodes = span.places.place(-1), span.told[1:]
            for number in self.free:
                self.values[number, nodes] = span.places.inputs[number, 1:]
            told = np.concatenate([told, nodes])
        return spans

    def _span(self, place: Place, told: Rows, step: int) -> Span | None:
        """The next span from the last of some rows whose coordinates at rest are told; None at the
        end of the rows, or where not even one is told."""
        here = int(told[-1])
        left = self.values.shape[1] - 1 - here if step > 0 else here
        most = min(left, self.most, tolerances.MOST_REST_ROWS)
        while most:
            predicted = self._predicted(place, told, here + step * np.arange(1, most + 1))
            if predicted is None:
                break
            count = predicted.shape[1]
            apart = -(-count // tolerances.REST_NODES)
            ahead = np.arange(apart, count + 1, apart)
            nodes, free = here + step * ahead, predicted[:, ahead - 1]
            guesses = self._followed(place, told[-1:], nodes, free)
            at, stiffness = self.statics.balanced(guesses, known=True)
            if at.times.size > 1:
                good = self._smooth(place, at.only(slice(1, None)), free, first=told.size == 1)
                if good:
                    self.most = tolerances.REST_GROWTH * int(ahead[good - 1])
                    rows = np.concatenate([told[-1:], nodes[:good]])
                    return Span(rows, at.only(slice(0, good + 1)), stiffness[:, :, : good + 1])
            # rows far apart may fail where the next one does not
            most = max(1, count // tolerances.REST_GROWTH) if count > 1 else 0
        self.most = 1
        return None

    # How rows are predicted.

    def _predicted(self, place: Place, told: Rows, rows: Rows) -> Floats | None:
        """The coordinates at rest (free, rows) of as many of some rows as can be extrapolated from
        those that are told, one at least; None where the forces have no slopes at the place."""
        if told.size == 1:
            return self._along_rate(place, int(told[0]), rows)
        points = self._points(told, rows.size)
        values = self.values[self._free_rows, points]
        # the terms of Newton's polynomial; it ends with the one that leaves most rows told
        differences = [_divided(own, points.tolist()) for own in values.tolist()]
        start = values[:, :1]
        ways = np.multiply.accumulate(rows - points[:-1, None], axis=0, dtype=np.float64)
        terms = np.array(differences).T[:, :, None] * ways[:, None, :]
        moved = np.add.accumulate(terms, axis=0)
        small = np.maximum(
            tolerances.SMOOTH_STEP * np.abs(moved).max(axis=1), tolerances.REST_SMALL
        )
        last = np.abs(terms).max(axis=1)
        near = last <= np.minimum(tolerances.REST_TERM, small)
        told = np.where(near.all(axis=1), rows.size, np.argmin(near, axis=1))
        best = int(np.argmax(told - last[:, 0]))
        return np.asarray((start + moved[best])[:, : max(int(told[best]), 1)])

    @staticmethod
    def _points(told: Rows, count: int) -> Rows:
        """Rows among those that are told through which the next `count` ones are extrapolated, the
        last one first, about as far apart as their number goes."""
        most = tolerances.REST_POINTS - 1
        before = told[: -2 - max(count, most) : -1]
        ago = np.abs(before - told[-1])
        apart = max(1, min(int(ago[-1]), count) // most)
        wanted = np.searchsorted(ago, apart * np.arange(most + 1)).tolist()
        return before[[number for number in dict.fromkeys(wanted) if number < before.size]]

    def _along_rate(self, place: Place, row: int, rows: Rows) -> Floats | None:
        """The same where one row alone is known, by the rate of the branch there."""
        way = self.values[:, rows[0]] - place.inputs
        way[self.free] = 0.0
        pace = self.times[rows[:1]] - self.times[row]
        here = Places.of(place, self.times[row])
        found = self.beside(here, [(way[:, None], pace)])
        if not found.good[0]:
            return None
        rate = _solved(found.stiffness, -found.pushes[0])
        ahead = np.arange(1, rows.size + 1)
        moved = rate * ahead
        if not np.isfinite(rate).all():
            return place.inputs[self.free][:, None]
        far = np.maximum(np.max(np.abs(moved), axis=0), np.max(np.abs(way)) * ahead)
        told = max(1, _leading(far <= tolerances.REST_REACH))
        return (place.inputs[self.free][:, None] + moved)[:, :told]

    # How they are corrected.

    def _followed(self, place: Place, row: Rows, rows: Rows, free: Floats) -> Places:
        """A place, that of one `row` (1,), and those of rows whose coordinates at rest are given,
        closed along straight ways from it, as far as the loops can be followed."""
        every = np.concatenate([row, rows])
        inputs = self.values[:, every]
        inputs[:, 0] = place.inputs
        inputs[self.free, 1:] = free
        way = self.statics.way(inputs, place)
        reached = max(way.reached, 1)
        return Places(inputs[:, :reached], way.states, way.turns, self.times[every[:reached]])

    def _filled(self, place: Place, known: list[int], spans: list[Span]) -> Taken | None:
        """The rows of some spans, those between their nodes by interpolation and corrections with
        the stiffness interpolated likewise, as many as are surely on the branch; None where not
        even the first one is."""
        count = len(self.free)
        step = 1 if spans[0].told[1] > spans[0].told[0] else -1
        rows = np.arange(known[-1] + step, int(spans[-1].told[-1]) + step, step)
        between = []
        for span in spans:
            own = rows[abs(int(span.told[0]) - known[-1]) :][: span.size]
            numbers = [span.places.inputs[self.free], span.stiffness.reshape(-1, span.told.size)]
            between.append(_interpolated(span.told, np.concatenate(numbers), own))
        found = np.concatenate(between, axis=1)
        free, slopes = found[:count], found[count:].reshape(count, count, -1)
        at = self._followed(place, spans[0].told[:1], rows, free).only(slice(1, None))
        at, _ = self.statics.balanced(at, slopes[:, :, : at.times.size])
        good = self._smooth(place, at, free, first=len(known) == 1)
        good = self._joined(place, known, at.only(slice(0, good))) if good else 0
        if not good:
            return None
        if good == rows.size:
            self.most_spans = min(2 * self.most_spans, tolerances.MOST_REST_SPANS)
        else:
            self.most, self.most_spans = tolerances.REST_GROWTH * good, 1
        nodes = np.concatenate([known[-1:], *(span.told[1:] for span in spans)])
        stiffness = [spans[0].stiffness[:, :, :1], *(span.stiffness[:, :, 1:] for span in spans)]
        last = int(np.count_nonzero(np.abs(nodes - known[-1]) <= good))
        # the place of the last row is followed on from
        return Taken(
            rows[:good],
            at.inputs[self.free][:, :good],
            at.place(good - 1),
            nodes[:last],
            np.concatenate(stiffness, axis=2)[:, :, :last],
        )

    # How they are judged.

    def _smooth(self, place: Place, at: Places, free: Floats, *, first: bool) -> int:
        """How many places were corrected from `free` (free, places) by no more than ones on the
        branch may be, the `first` rows of which no rate is known before."""
        moved = np.abs(at.inputs[self.free] - place.inputs[self.free][:, None]).max(axis=0)
        off = np.abs(at.inputs[self.free] - free[:, : moved.size]).max(axis=0)
        moved, off = np.maximum.accumulate(moved), np.maximum.accumulate(off)
        most = tolerances.REST_MISS if first else tolerances.SMOOTH_STEP * moved
        return _leading((off <= most) | (off <= tolerances.REST_SMALL))

    def _joined(self, place: Place, known: list[int], at: Places) -> int:
        """How many equilibria in the next rows surely lie on one branch with a place, that of the
        last row that is known.

        Short steps that change slowly do: before a fold they grow from row to row. Others do if
        they are those that the rates of the branch at both ends tell.
        """
        here = Places.of(place, self.times[known[-1]])
        every = here.followed_by(at)
        ways = every.inputs[:, 1:] - every.inputs[:, :-1]
        steps = ways[self.free]
        sizes = np.abs(steps).max(axis=0)
        first = place.inputs[self.free]
        earlier = first if len(known) < 2 else self.values[self.free, known[-2]]
        before = np.concatenate([(first - earlier)[:, None], steps[:, :-1]], axis=1)
        changes = np.abs(steps - before).max(axis=0)
        good = (sizes <= tolerances.SHORT_REST) & (
            changes <= tolerances.SLOW_REST * sizes + tolerances.REST_ROUNDING
        )
        judged = np.flatnonzero(~good)
        if judged.size:
            far = np.abs(ways[self.driven]).max(axis=0, initial=0.0)
            near = np.maximum(sizes, far) <= tolerances.LONG_REST
            good[judged] = near[judged] & self._told(every, ways, judged)
        return _leading(good)

    def _told(self, every: Places, ways: Floats, judged: Rows) -> Bools:
        """Which of the ways to the places numbered `judged` + 1, each from the one before, are told
        by the rates of the branch at both ends, with a stiffness whose determinant keeps its
        sign."""
        count, ends = judged.size, np.concatenate([judged, judged + 1])
        along = ways[:, judged]
        steps = along[self.free]
        along[self.free] = 0.0
        paces = every.times[judged + 1] - every.times[judged]
        pairs = [(np.concatenate([along, along], axis=1), np.concatenate([paces, paces]))]
        found = self.beside(every.only(ends), pairs)
        rates = _solved(found.stiffness, -found.pushes[0])
        sides = _sides(found.stiffness)
        begin, end = rates[:, :count], rates[:, count:]
        off = np.abs(steps - 0.5 * (begin + end)).max(axis=0)
        most = np.maximum(np.abs(begin), np.abs(end)).max(axis=0)
        told: Bools = (
            found.good[:count]
            & found.good[count:]
            & (sides[:count] * sides[count:] > 0.0)
            & (off <= tolerances.JOINED_REST * most + tolerances.REST_ROUNDING)
        )
        return told

    def beside(self, at: Places, ways: list[tuple[Floats, Floats]] | None = None) -> Beside:
        """The stiffness at places, and what the forces change by along `ways`: those of the
        inputs (inputs, places) and of time (places,)."""
        count, h = len(self.free), tolerances.NEWTON_DIFFERENCE
        places, ways = at.times.size, ways or []
        inputs = [at.inputs[:, None] + self._steps]
        times = [at.times] * (1 + 2 * count)
        sizes = []
        for way, pace in ways:
            size = np.maximum(np.abs(way).max(axis=0), tolerances.LEAST_REST_WAY)
            part = h / size
            inputs.append(at.inputs[:, None] + np.stack([way * part, -way * part], axis=1))
            times += [at.times + pace * part, at.times - pace * part]
            sizes.append(size)
        kinds = len(times)
        found = self.statics.forces(
            np.concatenate(inputs, axis=1).reshape(len(self.values), -1),
            np.concatenate([at.states] * kinds, axis=1),
            np.concatenate([at.turns] * kinds, axis=1),
            np.concatenate(times),
        )
        forces = found.forces.reshape(count, kinds, places)
        changes = (forces[:, 1::2] - forces[:, 2::2]) / (2.0 * h)
        pushes = [changes[:, count + k] * size for k, size in enumerate(sizes)]
        return Beside(
            changes[:, :count],
            np.array(pushes),
            np.asarray(found.good.reshape(kinds, places).all(axis=0)),
        )


def _divided(values: list[float], points: list[int]) -> list[float]:
    """Newton's divided differences of values at some points, from the first order on."""
    found = []
    for k in range(1, len(points)):
        values = [
            (values[i + 1] - values[i]) / (points[i + k] - points[i])
            for i in range(len(values) - 1)
        ]
        found.append(values[0])
    return found


def _leading(good: Bools) -> int:
    """How many are good before the first that is not."""
    return good.size if good.all() else int(good.argmin())


def _sides(matrices: Floats) -> Floats:
    """The determinants (places,) of matrices (count, count, places)."""
    if len(matrices) == 1:
        return np.asarray(matrices[0, 0])
    return np.array([determinant(matrices[:, :, k]) for k in range(matrices.shape[2])])


@cache
def _weights(count: int) -> Floats:
    """The barycentric weights of evenly spaced points."""
    return np.array([(1 - 2 * (k % 2)) * comb(count - 1, k) for k in range(count)], dtype=float)


def _interpolated(points: Rows, numbers: Floats, rows: Rows) -> Floats:
    """Numbers (numbers, rows) on the polynomials through those (numbers, points) at some evenly
    spaced points, by Lagrange's formula with barycentric weights."""
    away = rows - points[:, None]
    met = away == 0
    shares = _weights(points.size)[:, None] / np.where(met, 1.0, away)
    shares = np.where(met.any(axis=0), met, shares)
    total, whole = np.zeros((len(numbers), rows.size)), np.zeros(rows.size)
    for point, share in zip(numbers.T, shares, strict=True):
        total += point[:, None] * share
        whole += share
    return total / whole


def _solved(matrices: Floats, right: Floats) -> Floats:
    """The solutions (count, places) of systems (count, count, places), each by elimination; nan
    where one is singular."""
    count = right.shape[0]
    if count == 1:
        pivots = matrices[0, 0]
        safe = np.where(pivots == 0.0, np.nan, pivots)
        return np.asarray(right / safe)
    found = np.full(right.shape, np.nan)
    for k in range(right.shape[1]):
        if np.isfinite(matrices[:, :, k]).all() and np.isfinite(right[:, k]).all():
            solved = eliminated(matrices[:, :, k].tolist(), right[:, k].tolist(), 0.0)
            if solved is not None:
                found[:, k] = solved
    return found
