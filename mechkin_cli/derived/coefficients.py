"""Coefficients of the inputs' accelerations in accelerations, reactions and efforts; the powers of
single loads and efforts, at the rates of the rows or along a virtual motion.

Accelerations, reactions and efforts are linear in the inputs' accelerations. A coefficient is what
unit acceleration of its input gives, from rest and without gravity and loads, so nothing is
subtracted; the rest is what the rates and loads of the row give with no acceleration. The friction
of joints is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.derived.basis import BasisQuantities
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
from mechkin_cli.units import FORCE, POWER

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Load
    from mechkin_cli.session import KernelInputs, Session
    from mechkin_cli.show import Floats


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
