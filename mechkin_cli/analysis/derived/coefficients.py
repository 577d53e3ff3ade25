"""Coefficients of the inputs' accelerations in accelerations, reactions and efforts.

All of these are linear in the inputs' accelerations. A coefficient is what unit acceleration of its
input gives, from rest and without gravity and loads, so nothing is subtracted; the rest is what the
rates and loads of the row give with no acceleration. The friction of joints is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.derived.basis import Reading
from mechkin_cli.mechanism.coefficient_quantities import (
    Input,
    accelerated,
    base_name,
    base_quantity,
)
from mechkin_cli.mechanism.quantities import REACTION_LEVEL, Wanted
from mechkin_cli.mechanism.vectors import ZERO
from mechkin_cli.solver.demand import WRENCH_KINDS
from mechkin_cli.units import FORCE

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.session import Session


def coefficients(run: Reading, wanted: Sequence[Wanted]) -> dict[str, Floats]:
    """Coefficients by name, (1, rows) or (3, rows) in SI; nan where reactions are not unique."""
    found: dict[str, Floats] = {}
    known = run.session.problem.quantities()

    def group(quantity: Wanted) -> tuple[Input | None, bool]:
        return accelerated(quantity), base_name(quantity) in known

    for by, acts in dict.fromkeys(map(group, wanted)):
        own = [quantity for quantity in wanted if group(quantity) == (by, acts)]
        values = _values(run, by, [base_name(quantity) for quantity in own], at_inputs=not acts)
        found |= {q.name: value for q, value in zip(own, values, strict=True)}
    return found


def _values(
    run: Reading, by: Input | None, names: Sequence[str], *, at_inputs: bool
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
        inputs, other = (
            session.inputs.at_unit_acceleration(number),
            unloaded(session, at_inputs=at_inputs),
        )
    reactions = [base for base in bases if base.kind in WRENCH_KINDS]
    shifts = run.result.shifts if reactions else ()
    bases += [REACTION_LEVEL] if shifts else []
    columns = run.result.evaluated(bases, session=other, inputs=inputs)
    others = [run.result.evaluated(bases, session=other, inputs=inputs, shift=s) for s in shifts]
    if shifts:
        rounding = _rounding([each[REACTION_LEVEL.name][0] for each in (columns, *others)])
        for base in reactions:
            off = rounding * (1.0 if base.dimension == FORCE else session.layout.length)
            columns[base.name] = _unique(columns, others, base.name, off)
    return [columns[name] / unit for name in names]


def unloaded(session: Session, *, at_inputs: bool) -> Session:
    """The mechanism with its masses alone, its efforts where they act or at the inputs."""

    def made() -> Session:
        problem = session.problem
        drives = None if at_inputs else problem.mechanism.drives
        bare = replace(problem.mechanism, loads=(), gravity=ZERO, frictions=())
        mechanism = replace(bare, drives=drives)
        return session.loaded(replace(problem, mechanism=mechanism, load_laws=()))

    return session.once(("unloaded", at_inputs), made)


def without_friction(session: Session, *, at_inputs: bool = False) -> Session | None:
    """The mechanism without the friction of its joints, which is linear in nothing, its efforts
    where they act or at the inputs; None where it has none."""
    mechanism = session.problem.mechanism
    if not mechanism.frictions:
        return None
    drives = None if at_inputs else mechanism.drives
    bare = replace(mechanism, frictions=(), drives=drives)
    smooth = replace(session.problem, mechanism=bare)
    return session.once(("without friction", at_inputs), lambda: session.loaded(smooth))


def _rounding(levels: Sequence[Floats]) -> Floats:
    """Rounding of reactions (rows,), of forces; a row without any has that of the null space."""
    own, *others = levels
    largest = np.full(own.shape, np.max(own[np.isfinite(own)], initial=0.0))
    for other in others:
        largest[own == 0.0] = np.fmax(largest, other)[own == 0.0]
    rounding: Floats = tolerances.REACTION_ROUNDING * largest
    return rounding


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
