"""Energies of a sweep in time over its rows: what efforts and loads put in, and what dampers took.

    T + V - (T + V at the first row) = work - dissipated

T and V are those of each row; work and dissipation are integrals of their powers over the rows
(`quadrature`), so that what is missing shows how well the rows resolve them. Not so where joints
rub: their powers jump where a slip turns round and bend where a contact changes sides, in work and
dissipation alike. There the polynomial through eight rows serves from one row to the next where it
agrees with that through six and no slip turns round; elsewhere the motion is followed at further
moments, parted where the laws of the inputs bend (`running_integrals`), and what these integrals
may be off counts as missing, too.

The rows may come part by part: an interval is known with the samples behind it that it is read
from, so that the last rows of a part wait for those of the next one.
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.derived.basis import BasisQuantities
from mechkin_cli.derived.coefficients import effort_powers, friction_power, load_powers
from mechkin_cli.derived.quadrature import POINTS, IntervalIntegrals, integrals
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.mechanism import with_ends
from mechkin_cli.record import NamedTuple
from mechkin_cli.tolerances import POWER_INTEGRAL
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from mechkin_cli.session import Session
    from mechkin_cli.show import Bools, Floats


class LedgerRows(NamedTuple):
    """Energies of some neighbouring rows (rows,), J: kinetic and potential, this from the run's
    first row on, as the `gained` of both together are; work and dissipation from there on, and how
    far these may be off."""

    kinetic: Floats
    potential: Floats
    gained: Floats
    work: Floats
    dissipated: Floats
    off: Floats

    @property
    def size(self) -> float:
        """The largest of them."""
        sizes = np.abs(np.stack([self.kinetic, self.potential, self.work, self.dissipated]))
        return float(np.max(sizes[np.isfinite(sizes)], initial=0.0))

    def error(self, size: float) -> Floats:
        """What is missing of the balance, or may be off of work or dissipation, in parts of the
        largest energy over all rows; nan where nothing moves or works."""
        rest = np.abs(self.gained - (self.work - self.dissipated)) + self.off
        return np.asarray(rest / size) if size > 0.0 else np.full(rest.size, np.nan)

    def columns(self, size: float) -> dict[str, Floats]:
        """`work`, `dissipated` (J) and `energy_error` (rows,)."""
        return {
            "work": self.work,
            "dissipated": self.dissipated,
            "energy_error": self.error(size),
        }


def ledger(run: BasisQuantities) -> dict[str, Floats]:
    """`work`, `dissipated` (J) and `energy_error` over the rows (rows,).

    Raises:
        UsageError: the rows are those of a part of a run.
    """
    if run.result.row_states.span.rows != run.result.row_states.span.run_rows:
        raise UsageError(
            "row.work, row.dissipated and row.energy_error of a row depend on all rows before it, "
            'which are not held here: name them where the run is asked for, stream(["row.work"])'
        )
    power = largest_power(run, slice(None)) if needs_largest_power(run) else 0.0
    found = RunningLedger(run.session, power)
    (rows,) = found.add(run, slice(None))
    return rows.columns(rows.size)


def needs_largest_power(run: BasisQuantities) -> bool:
    """Whether integrals are made to errors in parts of the largest power of all rows."""
    problem = run.session.problem
    return bool(problem.mechanism.frictions) and run.between is not None


def largest_power(run: BasisQuantities, own: slice) -> float:
    """The largest power of some rows, W."""
    powers = np.abs(_powers(run)[:, own])
    return float(np.max(powers[np.isfinite(powers)], initial=0.0))


class _Waiting(NamedTuple):
    """A part of which some intervals are not known yet: its run, where its rows begin among those
    of the run, and the first and the last (excluded) of those that are in no part before it."""

    run: BasisQuantities
    first: int
    begin: int
    end: int
    kinetic: Floats
    potential: Floats


class RunningLedger:
    """The ledger of rows that come part by part.

    Args:
        session: of the whole run.
        power: the largest of all rows (W), where `needs_largest_power`.
    """

    def __init__(self, session: Session, power: float) -> None:
        motion = session.problem.motion
        moments = with_ends(motion).time
        assert moments is not None
        self._rows, self._power = motion.rows, power
        self._step = float(moments.values[-1] - moments.values[0]) / max(self._rows - 1, 1)
        self._rubs = bool(session.problem.mechanism.frictions) and self._rows > 1
        orders = (POINTS, POINTS - 2, POINTS - 4) if self._rubs else (POINTS,)
        self._integrals = [[IntervalIntegrals(self._rows, n) for _ in range(2)] for n in orders]
        # of intervals from `_done` on: integrals by each order (2, intervals)
        self._parts = [np.empty((2, 0)) for _ in orders]
        self._turns = np.empty(0, dtype=bool)
        self._slips: Floats | None = None
        self._tells: bool | None = None  # whether the motion is known between the rows
        self._done = self._taken = 0
        # nothing is changed by what is added to -0
        self._sums = np.full(3, 0.0 if self._rubs else -0.0)
        self._first: tuple[float, float] | None = None
        self._before: Bools = np.empty(0, dtype=bool)
        self._waiting: deque[_Waiting] = deque()

    def add(self, run: BasisQuantities, own: slice) -> list[LedgerRows]:
        """Takes the rows `own` of a part, which are behind those before; gives those of the parts
        that are now known, in their order."""
        begin, end, _ = own.indices(run.inputs.rates.shape[1])
        self._take_energies(run, begin, end)
        powers = _powers(run)[:, begin:end]
        for number, pair in enumerate(self._integrals):
            new = np.stack([one.add(power) for one, power in zip(pair, powers, strict=True)])
            self._parts[number] = np.concatenate([self._parts[number], new], axis=1)
        if self._tells is None:
            self._tells = run.between is not None
        if self._rubs and self._tells:
            slips = _slips(run)[:, begin:end]
            joined = slips if self._slips is None else np.hstack([self._slips, slips])
            turns = (joined[:, 1:] * joined[:, :-1] <= 0.0).any(axis=0)
            self._turns, self._slips = np.concatenate([self._turns, turns]), joined[:, -1:].copy()
        return [*self._known()]

    def _take_energies(self, run: BasisQuantities, begin: int, end: int) -> None:
        known = run.session.problem.quantities()
        energies = [known["row.kinetic_energy"], known["row.potential_energy"]]
        columns = run.result.evaluated(energies)
        kinetic, potential = (columns[energy.name][0][begin:end].copy() for energy in energies)
        first = self._taken - begin
        self._waiting.append(
            _Waiting(run, first, self._taken, self._taken + end - begin, kinetic, potential)
        )
        if self._first is None:
            self._first = float(kinetic[0]), float(potential[0])
        self._taken += end - begin

    def _known(self) -> Iterator[LedgerRows]:
        """The rows of parts of which all intervals are known, with what their neighbours say."""
        while self._waiting:
            part = self._waiting[0]
            last = max(part.end - 1, 0)  # intervals of the run up to the part's end
            known = self._done + min(each.shape[1] for each in self._parts)
            if known < min(last + self._reach, self._rows - 1):
                return
            self._waiting.popleft()
            yield self._of(part, last - self._done)

    @property
    def _reach(self) -> int:
        """Intervals behind one by which it may be open."""
        return POINTS // 2 if self._rubs else 0

    def _of(self, part: _Waiting, count: int) -> LedgerRows:
        """The rows of a part, of which `count` intervals are the next ones."""
        assert self._first is not None
        if self._rubs:
            parts, off = self._rubbed(part, count)
            added = np.vstack([parts, np.max(off, axis=0)])
            sums = self._summed(added)
        else:
            added = np.vstack([self._parts[0][:, :count], np.zeros((1, count))])
            sums = self._summed(added) * self._step
        if part.begin == 0:  # before the first row there is no interval
            sums = np.concatenate([np.zeros((3, 1)), sums], axis=1)
        self._parts = [each[:, count:] for each in self._parts]
        self._turns = self._turns[count:]
        self._done += count
        kinetic_0, potential_0 = self._first
        risen = part.potential - potential_0
        gained = (part.kinetic - kinetic_0) + risen
        return LedgerRows(part.kinetic, risen, gained, sums[0], sums[1], sums[2])

    def _summed(self, added: Floats) -> Floats:
        """Running sums with those before."""
        sums = np.cumsum(np.concatenate([self._sums[:, None], added], axis=1), axis=1)
        self._sums = sums[:, -1].copy()
        return sums[:, 1:]

    def _rubbed(self, part: _Waiting, count: int) -> tuple[Floats, Floats]:
        """Integrals of the next `count` intervals and how far they may be off (2, intervals)."""
        size = min(each.shape[1] for each in self._parts)
        parts, fewer, least = (each[:, :size] * self._step for each in self._parts)
        off = np.abs(parts - fewer)
        run = part.run
        if not self._tells:
            # at a jump no polynomial is the better one
            off += np.abs(parts - least)
            return parts[:, :count], off[:, :count]
        allowed = POWER_INTEGRAL * self._power * self._step
        wrong = ~(off <= allowed).all(axis=0) | self._turns[:size]
        # those before the next ones stay as far as they reach
        near = _with_neighbours(np.concatenate([self._before, wrong]))
        open_ = near[self._before.size :][:count]
        self._before = np.concatenate([self._before, wrong[:count]])[-(POINTS // 2) :]
        parts, off = parts[:, :count].copy(), off[:, :count].copy()
        reached = run.result.row_states.reached
        # the part may have rows that others have, too; none leads to the first of lost ones
        begin = self._done - part.first
        own = slice(max(begin, 0), begin + count)
        every = np.zeros(max(reached.size - 1, 0), dtype=bool)
        every[own] = open_[max(-begin, 0) :] & (reached[1:] & reached[:-1])[own]
        open_[:] = False
        open_[max(-begin, 0) :] = every[own]
        if open_.any():
            parts[:, open_], off[:, open_] = _between(run, 2, every, allowed / self._step)
        return parts, off


def _powers(run: BasisQuantities) -> Floats:
    """What efforts and loads put in, and what is dissipated (2, rows) in W."""
    put_in, taken = np.zeros((2, run.inputs.rates.shape[1]))
    for power in effort_powers(run, run.session.inputs).values():
        put_in += power
    for load, power in load_powers(run):
        if isinstance(load, str) or load.has_potential:  # gravity has one, too
            continue
        if load.dissipates:
            taken -= power
        else:
            put_in += power
    rubbed = friction_power(run, run.session.inputs)
    if rubbed is not None:
        taken -= rubbed
    return np.stack([put_in, taken])


def _between(
    run: BasisQuantities, count: int, open_: Bools, allowed: float
) -> tuple[Floats, Floats]:
    """`count` integrals and their errors (integrands, open intervals); `allowed` (W) for each."""
    problem, between = run.session.problem, run.between
    course = problem.motion.course
    assert problem.motion.time is not None
    assert course is not None
    assert between is not None
    written = problem.motion.time.written
    bends = np.unique(course.at[course.rows < 0])
    second = float(problem.units.to_si(1.0, TIME))
    low, high, own = _parted(written, np.flatnonzero(open_), bends)

    def sample(moments: Floats) -> tuple[Floats, Floats]:
        result = between(moments)
        other = BasisQuantities(result, {}, result.session.inputs)
        time = result.session.problem.motion.time
        assert time is not None
        rows = np.searchsorted(time.written, moments)
        return _powers(other)[:, rows], _slips(other)[:, rows]

    of_pieces, errors_of_pieces = integrals(low, high, sample, np.full(count, allowed))
    values, errors = np.zeros((2, count, written.size - 1))
    for piece, interval in enumerate(own):
        values[:, interval] += of_pieces[:, piece]
        errors[:, interval] += errors_of_pieces[:, piece]
    return second * values[:, open_], second * errors[:, open_]


def _parted(
    written: Floats, intervals: NDArray[np.intp], bends: Floats
) -> tuple[Floats, Floats, list[int]]:
    """Ends of the pieces between rows and bends, and the interval that each is part of."""
    low, high, own = [], [], []
    for interval in intervals.tolist():
        here, there = float(written[interval]), float(written[interval + 1])
        inside = bends[(bends > here) & (bends < there)].tolist()
        low += [here, *inside]
        high += [*inside, there]
        own += [interval] * (len(inside) + 1)
    return np.array(low), np.array(high), own


def _with_neighbours(open_: Bools) -> Bools:
    """Intervals (intervals,) whose polynomial reads an interval that is open."""
    near = open_.copy()
    for reach in range(1, POINTS // 2 + 1):
        near[reach:] |= open_[:-reach]
        near[:-reach] |= open_[reach:]
    return near


def _slips(run: BasisQuantities) -> Floats:
    """The rates of all coordinates of joints that rub (coordinates, rows)."""
    problem = run.session.problem
    known, joints = problem.quantities(), problem.mechanism.joints
    couplings = problem.mechanism.couplings
    rates = [
        known[f"{name}_dot"]
        for rubbing in problem.mechanism.frictions
        for name in (
            [f"{term.joint.name}.{term.coordinate}" for term in couplings[rubbing.joint].terms]
            if rubbing.loss
            else joints[rubbing.joint].coordinates
        )
    ]
    columns = run.result.evaluated(rates) if rates else {}
    rows = run.inputs.rates.shape[1]
    return np.array([columns[rate.name][0] for rate in rates]).reshape(len(rates), rows)
