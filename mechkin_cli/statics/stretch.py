"""A stretch of rows of a sweep at rest: many rows beyond a known one, predicted and corrected at
once, and as many of them as are surely on the branch of equilibria.

The coordinates at rest are extrapolated by a polynomial in the rows, as far as its last term tells
that it holds. Some of the rows, the nodes, are corrected by Newton's method, each with its own
stiffness, in one call of the kernel for all of them; the rows between follow by interpolation and
two corrections with the stiffness interpolated likewise. What is corrected may lie on another
branch, so each row is judged against the one before it.
"""

from __future__ import annotations

from math import comb
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import eliminated
from mechkin_cli.record import NamedTuple
from mechkin_cli.statics.forces import determinant, summed
from mechkin_cli.statics.places import Place

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.statics.places import Statics

    Rows = NDArray[np.intp]


class Places(NamedTuple):
    """Many places, in kernel units: inputs (inputs, places), states (states, places), turns (turn
    slots, places) and times (places,), s."""

    inputs: Floats
    states: Floats
    turns: Floats
    times: Floats

    @classmethod
    def of(cls, place: Place, time: float) -> Places:
        """One place as many."""
        return cls(
            place.inputs[:, None], place.state[:, None], place.turns[:, None], np.array([time])
        )

    def followed_by(self, others: Places) -> Places:
        """These and others."""
        return Places(*(np.concatenate(parts, axis=-1) for parts in zip(self, others, strict=True)))

    def only(self, which: slice | Rows) -> Places:
        """Some of them."""
        return Places(
            self.inputs[:, which], self.states[:, which], self.turns[:, which], self.times[which]
        )

    def place(self, number: int) -> Place:
        """One of them."""
        return Place(self.inputs[:, number], self.states[:, number], self.turns[:, number])


class Beside(NamedTuple):
    """What is known about places and beside them.

    Attributes:
        forces: (free, places).
        stiffness: (free, free, places).
        pushes: (ways, free, places) what the forces change by along each way.
        states: (states, places) closed.
        good: which of all that have values (places,).
    """

    forces: Floats
    stiffness: Floats
    pushes: Floats
    states: Floats
    good: Bools


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
        self.most = tolerances.MOST_REST_ROWS
        # beside a place along each coordinate at rest (inputs, 1 + 2 free, 1)
        count, h = len(self.free), tolerances.NEWTON_DIFFERENCE
        self._steps = np.zeros((len(values), 1 + 2 * count, 1))
        for number, k in enumerate(self.free):
            self._steps[k, 1 + 2 * number], self._steps[k, 2 + 2 * number] = h, -h
        self.driven = [k for k in range(len(values)) if k not in statics.free]

    def onward(self, place: Place, known: list[int], step: int) -> Taken | None:
        """The next rows, in a direction `step` (1 or -1) from the last of those that are known, at
        `place`; None where not even one is surely on the branch.
        """
        left = self.values.shape[1] - 1 - known[-1] if step > 0 else known[-1]
        most = min(left, self.most, tolerances.MOST_REST_ROWS)
        while True:
            predicted = self._predicted(place, known, known[-1] + step * np.arange(1, most + 1))
            if predicted is None:
                return None
            count = predicted.shape[1]
            rows = known[-1] + step * np.arange(1, count + 1)
            taken = self._taken(place, known, rows, predicted)
            if taken is not None:
                self.most = tolerances.REST_GROWTH * taken.rows.size
                return taken
            if count == 1:
                self.most = 1
                return None
            # nodes far apart may fail where the next row does not
            most = max(1, count // tolerances.REST_GROWTH)

    # How rows are predicted.

    def _predicted(self, place: Place, known: list[int], rows: Rows) -> Floats | None:
        """The coordinates at rest (free, rows) of as many of some rows as can be told from those
        that are known, one at least; None where the forces have no slopes at the place."""
        if len(known) == 1:
            return self._along_rate(place, known[0], rows)
        most = tolerances.REST_POINTS - 1
        apart = max(1, min(len(known) - 1, rows.size) // most)
        points = np.array(known[-1::-apart][: most + 1])
        # Newton's divided differences, and the terms of his polynomial; it ends with the one that
        # leaves most rows told
        differences = self.values[self.free][:, points]
        start, first = differences[:, :1], []
        for k in range(1, points.size):
            differences = (differences[:, 1:] - differences[:, :-1]) / (points[k:] - points[:-k])
            first.append(differences[:, 0])
        ways = np.multiply.accumulate(rows - points[:-1, None], axis=0, dtype=np.float64)
        terms = np.array(first)[:, :, None] * ways[:, None, :]
        moved = np.add.accumulate(terms, axis=0)
        small = np.maximum(
            tolerances.SMOOTH_STEP * np.abs(moved).max(axis=1), tolerances.REST_SMALL
        )
        last = np.abs(terms).max(axis=1)
        near = last <= np.minimum(tolerances.REST_TERM, small)
        told = np.where(near.all(axis=1), rows.size, np.argmin(near, axis=1))
        best = int(np.argmax(told - last[:, 0]))
        return np.asarray((start + moved[best])[:, : max(int(told[best]), 1)])

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

    def _taken(self, place: Place, known: list[int], rows: Rows, free: Floats) -> Taken | None:
        apart = -(-rows.size // tolerances.REST_NODES)
        nodes = np.arange(apart - 1, rows.size, apart)
        predicted = free
        at = self._followed(place, rows[nodes], predicted[:, nodes])
        corrected = self._balanced(place, known[-1], at)
        if corrected is None or not corrected[0].times.size:
            return None
        at, stiffness = corrected
        nodes = nodes[: at.times.size]
        rows, predicted = rows[: nodes[-1] + 1], predicted[:, : nodes[-1] + 1]
        told = np.concatenate([known[-1:], rows[nodes]])
        if apart > 1:
            between = self._between(place, told, rows, at, stiffness)
            if between is None:
                return None
            at = between
        off = np.abs(at.inputs[self.free] - predicted[:, : at.times.size]).max(axis=0)
        count = self._smooth(place, known, at, off)
        if not count:
            return None
        at, count = self._joined(place, known, at.only(slice(0, count)), closed=apart > 1)
        if not count:
            return None
        free = at.inputs[self.free][:, :count]
        last = int(np.searchsorted(nodes, count - 1, side="right"))
        place = at.place(count - 1)
        return Taken(rows[:count], free, place, told[: last + 1], stiffness[:, :, : last + 1])

    def _followed(self, place: Place, rows: Rows, free: Floats) -> Places:
        """Places of rows whose coordinates at rest are given, closed along straight ways from a
        place, as far as the loops can be followed."""
        inputs = self.values[:, rows]
        inputs[self.free] = free
        way = self.statics.way(np.concatenate([place.inputs[:, None], inputs], axis=1), place)
        reached = max(way.reached - 1, 0)
        times = self.times[rows[:reached]]
        return Places(
            inputs[:, :reached],
            way.states[:, 1 : reached + 1],
            way.turns[:, 1 : reached + 1],
            times,
        )

    def _balanced(self, place: Place, row: int, at: Places) -> tuple[Places, Floats] | None:
        """Places beyond a known one after Newton's steps, as many as reach an equilibrium before
        which the determinant of the stiffness keeps its sign, and the stiffness (free, free,
        places + 1) of the known one and theirs."""
        at = Places.of(place, self.times[row]).followed_by(at)
        before: Floats | None = None
        for _ in range(tolerances.MOST_CHORDS):
            found = self.beside(at)
            step = _solved(found.stiffness, -found.forces)
            step[:, 0] = 0.0
            sizes = np.abs(step).max(axis=0)
            # steps shrink by squares, until rounding alone is left
            shrinks = np.isfinite(sizes)
            gain = np.ones(sizes.size)
            if before is not None:
                shrinks = sizes <= tolerances.CHORD_GAIN * before
                gain = sizes / np.maximum(before, tolerances.EQUILIBRIUM_STEP)
            kept = _leading(found.good & (shrinks | (sizes <= tolerances.REST_ROUNDING)))
            if kept < 2:
                return None
            inputs = at.inputs[:, :kept].copy()
            inputs[self.free] += step[:, :kept]
            at = Places(inputs, found.states[:, :kept], at.turns[:, :kept], at.times[:kept])
            before, left = sizes[:kept], (shrinks * (sizes * gain * gain))[:kept]
            if left.max() <= tolerances.EQUILIBRIUM_STEP:
                sides = _sides(found.stiffness[:, :, :kept])
                kept = _leading(sides * sides[0] > 0.0)
                return at.only(slice(1, kept)), found.stiffness[:, :, :kept]
        return None

    def _between(
        self, place: Place, told: Rows, rows: Rows, nodes: Places, stiffness: Floats
    ) -> Places | None:
        """The places of all rows up to the last of some nodes; None where interpolation does not
        lead to them. `told` (nodes + 1,) are the rows of the known place and of the nodes,
        `stiffness` (free, free, nodes + 1) theirs."""
        count = len(self.free)
        free = np.concatenate([place.inputs[self.free][:, None], nodes.inputs[self.free]], axis=1)
        numbers = np.concatenate([free, stiffness.reshape(-1, told.size)])
        found = _interpolated(told, numbers, rows)
        slopes = found[count:].reshape(count, count, -1)
        at = self._followed(place, rows, found[:count])
        if at.times.size < rows.size:
            return None
        before = np.inf
        for _ in range(tolerances.MOST_CHORDS):
            forces = self.statics.forces(*at)
            if not forces.good.all():
                return None
            step = _solved(slopes, -forces.forces)
            size = float(np.abs(step).max())
            grows = not size < tolerances.CHORD_GAIN * before
            if grows and not size <= tolerances.REST_ROUNDING:
                return None
            inputs = at.inputs.copy()
            if not grows:
                inputs[self.free] += step
            at = Places(inputs, forces.states, at.turns, at.times)
            before = size
            if grows or size <= tolerances.EQUILIBRIUM_STEP:
                return at
        return None

    # How they are judged.

    def _smooth(self, place: Place, known: list[int], at: Places, off: Floats) -> int:
        """How many of some rows are as far from where they were predicted as ones on the branch may
        be."""
        moved = np.abs(at.inputs[self.free] - place.inputs[self.free][:, None]).max(axis=0)
        moved, off = np.maximum.accumulate(moved), np.maximum.accumulate(off)
        most = tolerances.REST_MISS if len(known) == 1 else tolerances.SMOOTH_STEP * moved
        return _leading((off <= most) | (off <= tolerances.REST_SMALL))

    def _joined(
        self, place: Place, known: list[int], at: Places, *, closed: bool
    ) -> tuple[Places, int]:
        """Equilibria in the next rows, and how many of them surely lie on one branch with a place,
        that of the last row that is known; they are closed again unless they are `closed`.

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
        slow = (sizes <= tolerances.SHORT_REST) & (
            changes <= tolerances.SLOW_REST * sizes + tolerances.REST_ROUNDING
        )
        judged = np.flatnonzero(~slow) if closed else np.arange(sizes.size)
        if not judged.size:
            return at, sizes.size
        far = np.abs(ways[self.driven]).max(axis=0, initial=0.0)
        near = np.maximum(sizes, far) <= tolerances.LONG_REST
        told, found = self._told(every, ways, judged)
        good = slow.copy()
        good[judged] |= told & near[judged]
        if not closed:
            good &= found.good[judged.size :]
            at = at._replace(states=found.states[:, judged.size :])
        return at, _leading(good)

    def _told(self, every: Places, ways: Floats, judged: Rows) -> tuple[Bools, Beside]:
        """Which of the ways to the places numbered `judged` + 1, each from the one before, are told
        by the rates of the branch at both ends, with a stiffness whose determinant keeps its
        sign; and what is beside the places at their beginnings and ends."""
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
        return told, found

    def beside(self, at: Places, ways: list[tuple[Floats, Floats]] | None = None) -> Beside:
        """Forces and stiffness at places, and what the forces change by along `ways`: those of the
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
            forces[:, 0],
            changes[:, :count],
            np.array(pushes),
            found.states[:, :places],
            np.asarray(found.good.reshape(kinds, places).all(axis=0)),
        )


def _leading(good: Bools) -> int:
    """How many are good before the first that is not."""
    return good.size if good.all() else int(good.argmin())


def _sides(matrices: Floats) -> Floats:
    """The determinants (places,) of matrices (count, count, places)."""
    if len(matrices) == 1:
        return np.asarray(matrices[0, 0])
    return np.array([determinant(matrices[:, :, k]) for k in range(matrices.shape[2])])


def _interpolated(points: Rows, numbers: Floats, rows: Rows) -> Floats:
    """Numbers (numbers, rows) on the polynomials through those (numbers, points) at some evenly
    spaced points, by Lagrange's formula with barycentric weights."""
    away = rows - points[:, None]
    weights = np.array([(1 - 2 * (k % 2)) * comb(points.size - 1, k) for k in range(points.size)])
    met = away == 0
    shares = weights[:, None] / np.where(met, 1.0, away)
    shares = np.where(met.any(axis=0), met, shares)
    total = np.zeros((len(numbers), rows.size))
    for point, share in zip(numbers.T, shares, strict=True):
        total += point[:, None] * share
    return np.asarray(total / summed(shares))


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
