"""Transmission angle of a link that is guided on ground by one joint and driven by one other.

A unit load on the coordinate, without masses and other loads, is balanced by the force F of the
driving joint; v is the velocity of that joint's point on the link when the coordinate alone moves.
The angle is asin(|F.v|/(|F||v|)), 90 degrees less the angle between their lines: 90 degrees where
the force does nothing but drive, 0 at the link's dead centre (Sutherland and Roth, A transmission
index for spatial mechanisms, J. Eng. Industry 95, 1973). In a plane four-bar it is the angle
between coupler and rocker.

With the force that the joint really transmits, masses in motion and all loads, the same angle is
the dynamic transmission angle: the static one says nothing of forces that arise between input and
coordinate (Balli and Chand, Transmission angle in mechanisms, Mech. Mach. Theory 37, 2002).
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.derived.basis import Reading, vector_of
from mechkin_cli.analysis.derived.row_vectors import (
    add,
    choose,
    cross,
    dot,
    length,
    scale,
    subtract,
)
from mechkin_cli.mechanism.derived_quantities import driving_joint
from mechkin_cli.mechanism.model import Joint, JointLoad, Link, Mechanism
from mechkin_cli.mechanism.quantities import REACTION_LEVEL, Wanted
from mechkin_cli.mechanism.vectors import ZERO
from mechkin_cli.status import Status
from mechkin_cli.tape.scalars import of_two

if TYPE_CHECKING:
    from mechkin_cli.analysis.derived.row_vectors import RowVector
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.session import Session


def transmission_angle(run: Reading, quantity: Wanted) -> Floats:
    """The angle (rad, 0 to pi/2) of one coordinate over the rows; nan where the force is not
    unique, or where the driving joint's point does not move with the coordinate."""
    problem = run.session.problem
    mechanism = _with_unit_load(problem.mechanism, quantity)
    session = run.session.loaded(replace(problem, mechanism=mechanism, load_laws=()))
    return _angle(run, quantity, session)


def dynamic_transmission_angle(run: Reading, quantity: Wanted) -> Floats:
    """The same angle of the force that the joint transmits in the row, with all masses, loads,
    rates and accelerations; nan, too, where it transmits none."""
    return _angle(run, quantity, None)


def _angle(run: Reading, quantity: Wanted, session: Session | None) -> Floats:
    """Of the driving joint's force in the run, or in a session that differs in loads."""
    problem = run.session.problem
    guide = problem.mechanism.joints[quantity.owner]
    driver = driving_joint(problem.mechanism, guide)
    assert driver is not None
    known, unit = problem.quantities(), run.session.layout.length
    names = (f"{driver.name}.force", f"{driver.name}.point", f"{guide.name}.point")
    wanted = [*(known[name] for name in (*names, f"{guide.name}.axis")), REACTION_LEVEL]

    def angle(shift: int) -> Floats:
        columns = run.result.evaluated(wanted, session=session, shift=shift)
        force, point, centre = (vector_of(columns[name]) for name in names)
        axis = vector_of(columns[f"{guide.name}.axis"])
        pushes = length(force) > tolerances.REACTION_ROUNDING * columns[REACTION_LEVEL.name][0]
        force = choose(pushes, force, 0.0)
        arm = subtract(point, centre)
        return _between(force, _velocity(guide, quantity.coordinate, axis, arm, unit))

    found, rows = angle(0), run.result.row_states
    lost = ~rows.reached | np.isin(rows.status, (Status.rank_unclear, Status.dead_centre))
    for shift in run.result.shifts:
        lost |= ~(np.abs(angle(shift) - found) <= tolerances.UNIQUE_CELL)
    return np.where(lost, np.nan, found)


def _with_unit_load(mechanism: Mechanism, quantity: Wanted) -> Mechanism:
    """The mechanism without masses and loads but one on a coordinate."""
    load = JointLoad(quantity.owner, quantity.coordinate, 1.0)
    links = {name: Link(name) for name in mechanism.links}
    bare = replace(mechanism, links=links, loads=(load,), gravity=ZERO)
    return replace(bare, drives=None, frictions=())


def _velocity(
    guide: Joint, coordinate: str, axis: RowVector, arm: RowVector, unit: float
) -> RowVector:
    """Velocity of a point of the link, up to its sense, in lengths per length or rad; zero where it
    is zero to rounding."""
    if guide.type.chain[guide.type.freedom_of[coordinate]].is_slide:
        return axis
    around = cross(axis, arm)
    if guide.type.is_threaded:
        around = add(around, scale(guide.pitch, axis))
    return choose(length(around) > tolerances.STANDS_STILL * unit, around, 0.0)


def _between(force: RowVector, velocity: RowVector) -> Floats:
    """asin of |F.v|/(|F||v|), accurate at both ends; nan where either is zero."""
    along, across = np.abs(dot(force, velocity)), length(cross(force, velocity))
    return np.where((along > 0.0) | (across > 0.0), of_two("ATAN2", along, across), np.nan)
