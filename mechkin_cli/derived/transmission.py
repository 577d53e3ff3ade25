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
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.derived.basis import BasisQuantities, vector_of
from mechkin_cli.derived.rotation import (
    add,
    angle,
    choose,
    cross,
    divide,
    dot,
    length,
    off,
    quaternion,
    scale,
    subtract,
)
from mechkin_cli.mechanism import (
    REACTION_LEVEL,
    ZERO,
    Joint,
    JointLoad,
    Mechanism,
    RigidLink,
    Wanted,
    driving_joint,
    reference_point,
)
from mechkin_cli.tape import of_two
from mechkin_cli.verdict import has_rates

if TYPE_CHECKING:
    from mechkin_cli.derived.basis import RowVector
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats


def transmission_angle(run: BasisQuantities, quantity: Wanted) -> Floats:
    """The angle (rad, 0 to pi/2) of one coordinate over the rows; nan where the force is not
    unique, or where the driving joint's point does not move with the coordinate."""
    problem = run.session.problem
    mechanism = _with_unit_load(problem.mechanism, quantity)
    session = run.session.loaded(replace(problem, mechanism=mechanism, load_laws=()))
    return _angle(run, quantity, session)


def dynamic_transmission_angle(run: BasisQuantities, quantity: Wanted) -> Floats:
    """The same angle of the force that the joint transmits in the row, with all masses, loads,
    rates and accelerations; nan, too, where it transmits none."""
    return _angle(run, quantity, None)


def _angle(run: BasisQuantities, quantity: Wanted, session: Session | None) -> Floats:
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
    lost = ~(rows.reached & has_rates(rows.status))
    for shift in run.result.shifts:
        lost |= ~(np.abs(angle(shift) - found) <= tolerances.UNIQUE_CELL)
    return np.where(lost, np.nan, found)


def _with_unit_load(mechanism: Mechanism, quantity: Wanted) -> Mechanism:
    """The mechanism without masses and loads but one on a coordinate."""
    load = JointLoad(quantity.owner, quantity.coordinate, 1.0)
    links = {name: RigidLink(name) for name in mechanism.links}
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


# Screws of a link against ground: of its instant motion (Mozzi) and of its whole displacement
# from the drawing (Chasles).
#
# Instant: with the angular velocity w and the velocity v of a point a, the axis through a + w x
# v/w^2 along w, of pitch w.v/w^2 per radian. Finite: with the unit axis u and angle phi of the
# rotation and the shift d of the point from a0 to a, the axis through (a0 + a)/2 + cot(phi/2) (u x
# d)/2, and the slide u.d (Bottema and Roth, Theoretical Kinematics, chapter 3). A point of an axis
# is the one nearest to the ground origin.


class InstantScrew(NamedTuple):
    """Unit axis along the angular velocity, point (m), pitch (m/rad, right-handed positive).

    A link that only shifts has the direction of its velocity, no point and no pitch; one that
    stands still has nothing.
    """

    axis: RowVector
    point: RowVector
    pitch: Floats


class FiniteScrew(NamedTuple):
    """Unit axis, point (m), angle (rad, 0 to pi) and slide along the axis (m).

    A link that is only shifted has the direction of the shift, no point, angle 0 and the length of
    the shift; one that is where it was drawn has no axis, angle 0 and slide 0.
    """

    axis: RowVector
    point: RowVector
    angle: Floats
    slide: Floats


def instant_screw(run: BasisQuantities, link: str) -> InstantScrew:
    """The screw of a link's velocity."""
    unit = run.session.layout.length
    omega = run.vector(f"{link}.omega")
    place, velocity = run.vector(f"{link} place"), run.vector(f"{link} velocity")
    rate, speed = length(omega), length(velocity)
    fastest = np.max(np.abs(run.inputs.rates), axis=0, initial=0.0)
    still = tolerances.STANDS_STILL * np.maximum(fastest, np.maximum(rate, speed / unit))
    turns, moves = rate > still, speed > still * unit
    axis = choose(turns, divide(omega, rate), choose(moves, divide(velocity, speed), np.nan))
    centre = add(place, divide(cross(axis, velocity), rate))
    pitch = np.where(turns, dot(axis, velocity) / rate, np.nan)
    return InstantScrew(axis, choose(turns, off(axis, centre), np.nan), pitch)


def finite_screw(run: BasisQuantities, link: str) -> FiniteScrew:
    """The screw of a link's displacement from the drawing."""
    q = quaternion(run.rotation(link))
    size = length(q[1:])
    place = run.vector(f"{link} place")
    x, y, z = reference_point(run.session.layout.mechanism, link).vector
    drawn = (np.full_like(size, x), np.full_like(size, y), np.full_like(size, z))
    shift = subtract(place, drawn)
    distance = length(shift)
    turned = size > tolerances.NO_TURN
    moved = distance > tolerances.NO_TURN * run.session.layout.length
    axis = choose(turned, divide(q[1:], size), choose(moved, divide(shift, distance), np.nan))
    lever = scale(np.abs(q[0]) / size, cross(axis, shift))
    centre = scale(0.5, add(add(drawn, place), lever))
    known = np.isfinite(size)
    slide = np.where(turned, dot(axis, shift), np.where(known & moved, distance, 0.0 * distance))
    return FiniteScrew(
        axis,
        choose(turned, off(axis, centre), np.nan),
        np.where(known & ~turned, 0.0, angle(q)),
        slide,
    )
