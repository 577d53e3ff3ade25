"""Coefficients of the inputs' accelerations in accelerations, reactions and efforts; the powers of
single loads and efforts, at the rates of the rows or along a virtual motion.

Accelerations, reactions and efforts are linear in the inputs' accelerations. A coefficient is what
unit acceleration of its input gives, from rest and without gravity and loads, so nothing is
subtracted; the rest is what the rates and loads of the row give with no acceleration. The friction
of joints is left out.

Energy of a sweep in time (`ledger`): what efforts and loads put in, and what dampers took.

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

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.derived.basis import BasisQuantities
from mechkin_cli.derived.quadrature import POINTS, integrals, interval_integrals, running_integral
from mechkin_cli.mechanism import (
    GROUND_NAME,
    REACTION_LEVEL,
    ZERO,
    Input,
    RigidLink,
    Wanted,
    accelerated,
    base_name,
    base_quantity,
    effort_quantity,
)
from mechkin_cli.memo import remembered
from mechkin_cli.plan import REACTION_KINDS
from mechkin_cli.record import replace
from mechkin_cli.tolerances import POWER_INTEGRAL
from mechkin_cli.units import FORCE, POWER, TIME

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Load
    from mechkin_cli.session import KernelInputs, Session
    from mechkin_cli.show import Bools, Floats


def coefficients(run: BasisQuantities, wanted: Sequence[Wanted]) -> dict[str, Floats]:
    """Coefficients by name, (1, rows) or (3, rows) in SI; nan where reactions are not unique."""
    columns: dict[str, Floats] = {}
    known = run.session.problem.quantities()

    def group(quantity: Wanted) -> tuple[Input | None, bool]:
        return accelerated(quantity), base_name(quantity) in known

    for by, acts in dict.fromkeys(map(group, wanted)):
        own = [quantity for quantity in wanted if group(quantity) == (by, acts)]
        values = _values(run, by, [base_name(quantity) for quantity in own], at_inputs=not acts)
        columns |= {q.name: value for q, value in zip(own, values, strict=True)}
    return columns


def _values(
    run: BasisQuantities, by: Input | None, names: Sequence[str], *, at_inputs: bool
) -> list[Floats]:
    """The named quantities where one input, or none, is accelerated; `at_inputs`: efforts of inputs
    in whose place actuators act."""
    session, inputs, unit = run.session, run.session.inputs.without_accelerations(), 1.0
    known = session.problem.quantities()
    bases = list(dict.fromkeys(base_quantity(known, name) for name in names))
    other = without_friction(session)
    if by is not None:
        number = session.driven.index(by)
        joint = session.problem.mechanism.joints[by[0]]
        unit = joint.unit_of(by[1], session.layout.length)
        inputs = session.inputs.at_unit_acceleration(number)
        other = unloaded(session, at_inputs=at_inputs)
    reactions = [base for base in bases if base.kind in REACTION_KINDS]
    shifts = run.result.shifts if reactions else ()
    bases += [REACTION_LEVEL] if shifts else []
    columns = run.result.evaluated(bases, session=other, inputs=inputs)
    others = [run.result.evaluated(bases, session=other, inputs=inputs, shift=s) for s in shifts]
    if shifts:
        # of forces; a row without any has the rounding of the null space
        level = columns[REACTION_LEVEL.name][0]
        largest = np.full(level.shape, np.max(level[np.isfinite(level)], initial=0.0))
        for other_columns in others:
            at_other = np.fmax(largest, other_columns[REACTION_LEVEL.name][0])
            largest[level == 0.0] = at_other[level == 0.0]
        rounding = tolerances.REACTION_ROUNDING * largest
        for base in reactions:
            off = rounding * (1.0 if base.dimension == FORCE else session.layout.length)
            columns[base.name] = _unique(columns, others, base.name, off)
    return [columns[name] / unit for name in names]


@remembered
def unloaded(session: Session, *, at_inputs: bool) -> Session:
    """The mechanism with its masses alone, its efforts where they act or at the inputs."""
    problem = session.problem
    drives = None if at_inputs else problem.mechanism.drives
    mechanism = replace(problem.mechanism, loads=(), gravity=ZERO, frictions=(), drives=drives)
    return session.loaded(replace(problem, mechanism=mechanism, load_laws=()))


@remembered
def without_friction(session: Session, *, at_inputs: bool = False) -> Session | None:
    """The mechanism without the friction of its joints, which is linear in nothing, its efforts
    where they act or at the inputs; None where it has none."""
    mechanism = session.problem.mechanism
    if not mechanism.frictions:
        return None
    drives = None if at_inputs else mechanism.drives
    smooth = replace(mechanism, frictions=(), drives=drives)
    return session.loaded(replace(session.problem, mechanism=smooth))


def _unique(
    columns: dict[str, Floats], others: Sequence[dict[str, Floats]], name: str, off: Floats
) -> Floats:
    """A reaction (3, rows) with nan where others in equilibrium are not the same."""
    value = columns[name]
    sizes = np.abs(np.stack([value, *(other[name] for other in others)]))
    largest = np.max(np.where(np.isfinite(sizes), sizes, 0.0), axis=(0, 2), initial=0.0)
    limit = np.fmax(tolerances.UNIQUE_CELL * largest[:, None], off)
    for other in others:
        value = np.where(np.abs(other[name] - columns[name]) <= limit, value, np.nan)
    return value


GRAVITY = "gravity"


def effort_powers(run: BasisQuantities, along: KernelInputs) -> dict[str, Floats]:
    """Of every effort (W, rows) by its name, as it acts in the rows, at the rates of `along`."""
    problem = run.session.problem
    known, acting = problem.quantities(), problem.acting
    efforts = [effort_quantity(*pair) for pair in acting]
    rates = [known[f"{joint}.{coordinate}_dot"] for joint, coordinate in acting]
    columns = run.result.evaluated(efforts)
    moving = run.result.evaluated(rates, inputs=along)
    return {
        effort.name: _power(columns[effort.name][0], moving[rate.name][0])
        for effort, rate in zip(efforts, rates, strict=True)
    }


def power_against(
    run: BasisQuantities, along: KernelInputs, loaded: Session, inputs: KernelInputs | None = None
) -> Floats:
    """Of what acts in a session that differs in masses and loads (W, rows): against the efforts
    that the inputs would need, at the rates of `inputs`, by the rates of `along`."""
    session = run.session
    efforts = [effort_quantity(*driven) for driven in session.problem.motion.driven]
    columns = run.result.evaluated(efforts, session=loaded, inputs=inputs)
    power = np.zeros(along.rates.shape[1])
    for number, effort in enumerate(efforts):
        joint = session.problem.mechanism.joints[effort.owner]
        unit = joint.unit_of(effort.coordinate, session.layout.length)
        power = power - _power(columns[effort.name][0], along.rates[number] * unit)
    return power


def friction_power(run: BasisQuantities, along: KernelInputs) -> Floats | None:
    """Of the friction of all joints (W, rows) by the rates of `along`: what efforts need less
    without it; None where nothing rubs."""
    smooth = without_friction(run.session, at_inputs=True)
    if smooth is None:
        return None
    power = -power_against(run, along, smooth)
    for own in effort_powers(run, along).values():
        power = power - own
    return power


def _power(effort: Floats, rate: Floats) -> Floats:
    """Zero of what stands still, whatever its effort is."""
    return np.where(rate == 0.0, 0.0, effort * rate)


def load_powers(run: BasisQuantities) -> list[tuple[Load | str, Floats]]:
    """Of gravity and every load (W, rows) at the rates of the rows."""
    loads = _numbered(run)
    wanted = [
        Wanted(f"power of load {k}", "load_power", GROUND_NAME, POWER, False, str(k))
        for _, k in loads
    ]
    columns = run.result.evaluated(wanted) if wanted else {}
    return [(load, columns[own.name][0]) for (load, _), own in zip(loads, wanted, strict=True)]


def load_powers_along(run: BasisQuantities, along: KernelInputs) -> list[tuple[Load | str, Floats]]:
    """Of gravity and every load, with the forces of the rows and the rates of `along`: against the
    efforts that hold it alone."""
    powers = []
    for load, number in _numbered(run):
        session = _with_load(run.session, number)
        still = run.inputs.at_rest() if number < 0 else None
        powers.append((load, power_against(run, along, session, still)))
    return powers


def _numbered(run: BasisQuantities) -> list[tuple[Load | str, int]]:
    """Gravity, where there is some, as -1, and the loads by their numbers."""
    mechanism = run.session.problem.mechanism
    gravity = [(GRAVITY, -1)] if mechanism.gravity != ZERO else []
    return [*gravity, *((load, k) for k, load in enumerate(mechanism.loads))]


@remembered
def _with_load(session: Session, number: int) -> Session:
    """The mechanism with one load alone; with gravity, its masses are at rest."""
    problem = session.problem
    mechanism = replace(problem.mechanism, drives=None, frictions=())
    if number < 0:
        mechanism = replace(mechanism, loads=())
    else:
        links = {name: RigidLink(name) for name in mechanism.links}
        loads = (mechanism.loads[number],)
        mechanism = replace(mechanism, links=links, loads=loads, gravity=ZERO)
    return session.loaded(replace(problem, mechanism=mechanism))


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
