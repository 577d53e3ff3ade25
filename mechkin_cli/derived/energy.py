"""The energy ledger of a sweep in time: what efforts and loads put in, and what dampers took.

    T + V - (T + V at the first row) = work - dissipated

T and V are those of each row; work and dissipation are integrals of their powers over the rows
(`quadrature`), so that what is missing shows how well the rows resolve them. Not so where joints
rub: their powers jump where a slip turns round and bend where a contact changes sides, in work and
dissipation alike. There the polynomial through eight rows serves from one row to the next where it
agrees with that through six and no slip turns round; elsewhere the motion is followed at further
moments, parted where the laws of the inputs bend (`running_integrals`), and what these integrals
may be off counts as missing, too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.derived.basis import BasisQuantities
from mechkin_cli.derived.coefficients import (
    dissipates,
    effort_powers,
    friction_power,
    is_stored,
    load_powers,
)
from mechkin_cli.derived.quadrature import POINTS, integrals, interval_integrals, running_integral
from mechkin_cli.tolerances import POWER_INTEGRAL
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Bools, Floats


def ledger(run: BasisQuantities) -> dict[str, Floats]:
    """`work`, `dissipated` (J) and `energy_error` over the rows (rows,)."""
    problem = run.session.problem
    time = problem.motion.time
    assert time is not None
    known = problem.quantities()
    energies = [known["row.kinetic_energy"], known["row.potential_energy"]]
    columns = run.result.evaluated(energies)
    kinetic, potential = (columns[energy.name][0] for energy in energies)
    powers, moments = _powers(run), time.values
    step = float(moments[-1] - moments[0]) / max(moments.size - 1, 1)
    if problem.mechanism.frictions and moments.size > 1:
        (work, dissipated), off = running_integrals(run, powers, step)
    else:
        work, dissipated = (running_integral(power, step) for power in powers)
        off = np.zeros(work.size)
    return {"work": work, "dissipated": dissipated} | {
        "energy_error": _missing(kinetic, potential - potential[0], work, dissipated, off)
    }


def _powers(run: BasisQuantities) -> Floats:
    """What efforts and loads put in, and what is dissipated (2, rows) in W."""
    put_in, taken = np.zeros((2, run.inputs.rates.shape[1]))
    for power in effort_powers(run, run.session.inputs).values():
        put_in += power
    for load, power in load_powers(run):
        if dissipates(load):
            taken -= power
        elif not is_stored(load):
            put_in += power
    rubbed = friction_power(run, run.session.inputs)
    if rubbed is not None:
        taken -= rubbed
    return np.stack([put_in, taken])


def _missing(
    kinetic: Floats, potential: Floats, work: Floats, dissipated: Floats, off: Floats
) -> Floats:
    """What is missing of the balance, or may be `off` of work or dissipation, in parts of the
    largest energy over all rows; nan where nothing moves or works."""
    rest = np.abs((kinetic - kinetic[0]) + potential - (work - dissipated)) + off
    sizes = np.abs(np.stack([kinetic, potential, work, dissipated]))
    size = float(np.max(sizes[np.isfinite(sizes)], initial=0.0))
    return np.asarray(rest / size) if size > 0.0 else np.full(rest.size, np.nan)


def running_integrals(run: BasisQuantities, powers: Floats, step: float) -> tuple[Floats, Floats]:
    """From the first row to each: integrals (integrands, rows) of the `powers` of the rows, and how
    far the worst may be off (rows,)."""
    parts, fewer, least = (
        np.stack([interval_integrals(p, points) for p in powers]) * step
        for points in (POINTS, POINTS - 2, POINTS - 4)
    )
    off = np.abs(parts - fewer)
    if run.between is not None:
        size = np.max(np.where(np.isfinite(powers), np.abs(powers), 0.0), initial=0.0) * step
        allowed = POWER_INTEGRAL * size
        slips = _slips(run)
        turns_round = (slips[:, 1:] * slips[:, :-1] <= 0.0).any(axis=0)
        open_ = _with_neighbours(~(off <= allowed).all(axis=0) | turns_round)
        reached = run.result.row_states.reached
        open_ &= reached[1:] & reached[:-1]
        if open_.any():
            parts[:, open_], off[:, open_] = _between(run, powers.shape[0], open_, allowed / step)
    else:
        # at a jump no polynomial is the better one
        off += np.abs(parts - least)
    worst = np.max(off, axis=0)
    zero = np.zeros((powers.shape[0] + 1, 1))
    sums = np.cumsum(np.concatenate([zero, np.vstack([parts, worst])], axis=1), axis=1)
    return sums[:-1], sums[-1]


def _between(
    run: BasisQuantities, count: int, open_: Bools, allowed: float
) -> tuple[Floats, Floats]:
    """`count` integrals and their errors (integrands, open intervals); `allowed` (W) for each."""
    problem, between = run.session.problem, run.between
    assert problem.motion.time is not None
    assert between is not None
    written = problem.motion.time.written
    second = float(problem.units.to_si(1.0, TIME))
    low, high, own = _parted(written, np.flatnonzero(open_), between.bends)

    def sample(moments: Floats) -> tuple[Floats, Floats]:
        result = between.at(moments)
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
    rates = [
        known[f"{name}_dot"]
        for rubbing in problem.mechanism.frictions
        for name in joints[rubbing.joint].coordinates
    ]
    columns = run.result.evaluated(rates) if rates else {}
    rows = run.inputs.rates.shape[1]
    return np.array([columns[rate.name][0] for rate in rates]).reshape(len(rates), rows)
