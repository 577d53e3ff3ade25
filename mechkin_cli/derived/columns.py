"""The derived quantities of a run as further columns of its outputs: transmission angles, screws
of a link, mechanical advantage.

The transmission angle of a link that is guided on ground by one joint and driven by one other: a
unit load on the coordinate, without masses and other loads, is balanced by the force F of the
driving joint; v is the velocity of that joint's point on the link when the coordinate alone moves.
The angle is asin(|F.v|/(|F||v|)), 90 degrees less the angle between their lines: 90 degrees where
the force does nothing but drive, 0 at the link's dead centre (Sutherland and Roth, A transmission
index for spatial mechanisms, J. Eng. Industry 95, 1973). In a plane four-bar it is the angle
between coupler and rocker.

With the force that the joint really transmits, masses in motion and all loads, the same angle is
the dynamic transmission angle: the static one ignores forces that arise between input and
coordinate (Balli and Chand, Transmission angle in mechanisms, Mech. Mach. Theory 37, 2002).

Screws of a link against ground, of its instant motion (Mozzi) and of its whole displacement from
the drawing (Chasles): instant, with the angular velocity w and the velocity v of a point a, the
axis through a + w x v/w^2 along w, of pitch w.v/w^2 per radian; finite, with the unit axis u and
angle phi of the rotation and the shift d of the point from a0 to a, the axis through (a0 + a)/2 +
cot(phi/2) (u x d)/2, and the slide u.d (Bottema and Roth, Theoretical Kinematics, chapter 3). A
point of an axis is the one nearest to the ground origin.

Mechanical advantage is the rate of the leading input over the rate of a coordinate. Without losses
the powers of input and load are equal, so it is the load that a unit of input effort balances.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.derived.basis import (
    BasisQuantities,
    add,
    angle,
    at_unit_rate,
    basis_of,
    choose,
    continuous_quaternion,
    cross,
    divide,
    dot,
    length,
    parameter_rates,
    quaternion,
    scale,
    square_to,
    subtract,
    turn,
    vector_of,
)
from mechkin_cli.derived.coefficients import coefficients
from mechkin_cli.derived.ledger import ledger
from mechkin_cli.mechanism import (
    COEFFICIENT_KINDS,
    FINITE_KINDS,
    INSTANT_KINDS,
    LEDGER_KINDS,
    QUATERNION,
    REACTION_LEVEL,
    ZERO,
    Joint,
    JointLoad,
    RigidLink,
    Wanted,
    driving_joint,
    is_angle,
    reference_point,
)
from mechkin_cli.record import replace
from mechkin_cli.tape import of_two
from mechkin_cli.units import FORCE, LENGTH
from mechkin_cli.verdict import has_rates

if TYPE_CHECKING:
    from mechkin_cli.derived.basis import RowVector
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats


def transmission_angle(run: BasisQuantities, quantity: Wanted) -> Floats:
    """The angle (rad, 0 to pi/2) of one coordinate over the rows; nan where the force is not
    unique, or where the driving joint's point does not move with the coordinate."""
    problem = run.session.problem
    links = {name: RigidLink(name) for name in problem.mechanism.links}
    loads = (JointLoad(quantity.owner, quantity.coordinate, 1.0),)
    mechanism = replace(
        problem.mechanism, links=links, loads=loads, gravity=ZERO, drives=None, frictions=()
    )
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
    axes = [f"{guide.name}.axis"] if guide.type.axis is not None else []
    # the driving joint may be that of a cylinder or a cable, which has no quantities of its own
    told = [
        Wanted(names[0], "force", driver.name, FORCE, True),
        Wanted(names[1], "joint_point", driver.name, LENGTH, True),
    ]
    wanted = [*told, *(known[name] for name in (names[2], *axes)), REACTION_LEVEL]

    def angle_of(shift: int) -> Floats:
        columns = run.result.evaluated(wanted, session=session, shift=shift)
        force, point, centre = (vector_of(columns[name]) for name in names)
        # that of a pin in a plane is no quantity
        upright = (np.zeros_like(centre[0]), np.zeros_like(centre[0]), np.ones_like(centre[0]))
        axis = vector_of(columns[axes[0]]) if axes else upright
        pushes = length(force) > tolerances.REACTION_ROUNDING * columns[REACTION_LEVEL.name][0]
        force = choose(pushes, force, 0.0)
        arm = subtract(point, centre)
        velocity = _velocity(guide, quantity.coordinate, axis, arm, unit)
        # asin of |F.v|/(|F||v|), accurate at both ends
        along, across = np.abs(dot(force, velocity)), length(cross(force, velocity))
        return np.where((along > 0.0) | (across > 0.0), of_two("ATAN2", along, across), np.nan)

    angles, rows = angle_of(0), run.result.row_states
    lost = ~(rows.reached & has_rates(rows.status))
    for shift in run.result.shifts:
        lost |= ~(np.abs(angle_of(shift) - angles) <= tolerances.UNIQUE_CELL)
    return np.where(lost, np.nan, angles)


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


def instant_screw(run: BasisQuantities, link: str) -> dict[str, RowVector | Floats]:
    """The screw of a link's velocity: unit `axis` along the angular velocity, `point` (m), `pitch`
    (m/rad, right-handed positive).

    A link that only shifts has the direction of its velocity, no point and no pitch; one that
    stands still has nothing.
    """
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
    point = choose(turns, square_to(axis, centre), np.nan)
    return {"axis": axis, "point": point, "pitch": pitch}


def finite_screw(run: BasisQuantities, link: str) -> dict[str, RowVector | Floats]:
    """The screw of a link's displacement from the drawing: unit `axis`, `point` (m), `angle` (rad,
    0 to pi) and `slide` along the axis (m).

    A link that is only shifted has the direction of the shift, no point, angle 0 and the length of
    the shift; one that is where it was drawn has no axis, angle 0 and slide 0.
    """
    q = quaternion(run.rotation(link))
    size = length(q[1:])
    place = run.vector(f"{link} place")
    mechanism = run.session.layout.mechanism
    drawing = reference_point(mechanism, link).vector
    x, y, z = (a + b for a, b in zip(mechanism.datum, drawing, strict=True))
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
    point = choose(turned, square_to(axis, centre), np.nan)
    turn = np.where(known & ~turned, 0.0, angle(q))
    return {"axis": axis, "point": point, "angle": turn, "slide": slide}


def mechanical_advantages(run: BasisQuantities, wanted: Sequence[Wanted]) -> list[Floats]:
    """Each quantity's values (rows,) in SI; nan where the coordinate stands still."""
    problem, layout = run.session.problem, run.session.layout
    known, leading = problem.quantities(), problem.motion.leading
    assert leading is not None
    names = [f"{quantity.owner}.{quantity.coordinate}_dot" for quantity in wanted]
    influence = at_unit_rate(run, [known[name] for name in (f"{leading.name}_dot", *names)])
    driven = influence.scalar(f"{leading.name}_dot")
    advantages = []
    for quantity, name in zip(wanted, names, strict=True):
        rate = influence.scalar(name)
        size = 1.0 if is_angle(quantity.coordinate) else layout.length
        moves = np.abs(rate) > tolerances.STANDS_STILL * size
        advantages.append(np.where(moves, driven / rate, np.nan))
    return advantages


def derived_columns(run: BasisQuantities, wanted: Sequence[Wanted]) -> dict[str, Floats]:
    """Some derived quantities of a run by name, (1, rows) or (3, rows) in SI."""
    with np.errstate(all="ignore"):
        parts = _computed(run, wanted)
        return {q.name: np.stack(own) for q, own in zip(wanted, parts, strict=True)}


def _computed(run: BasisQuantities, wanted: Sequence[Wanted]) -> list[list[Floats]]:
    session, moving = run.session, run
    of_screws = [quantity for quantity in wanted if quantity.kind in INSTANT_KINDS]
    driven = session.problem.motion.leading is not None
    if of_screws and driven and not session.inputs.rates.any():
        # a file without rates has the instant screws of unit rate
        moving = at_unit_rate(run, basis_of(session.problem.mechanism, of_screws))
    quaternion = cache(lambda owner: continuous_quaternion(run, owner))
    instant = cache(lambda owner: instant_screw(moving, owner))
    finite = cache(lambda owner: finite_screw(run, owner))
    of_advantages = [quantity for quantity in wanted if quantity.kind == "mechanical_advantage"]
    advantages = iter(mechanical_advantages(run, of_advantages) if of_advantages else ())
    energies = cache(lambda: ledger(run))
    linear = coefficients(run, [q for q in wanted if q.kind in COEFFICIENT_KINDS])

    def parts(quantity: Wanted) -> list[Floats]:
        owner = quantity.owner
        if quantity.kind == "quaternion":
            return [quaternion(owner)[QUATERNION.index(quantity.coordinate)]]
        if quantity.kind == "turn":
            return [*turn(run, owner)]
        if quantity.kind == "arc_length":
            track = session.problem.mechanism.joints[owner].track
            at = [run.scalar(basis.name) for basis in parameter_rates(quantity)]
            return [
                track.length_rate(quantity.order, at) if quantity.order else track.lengths(at[0])
            ]
        if quantity.kind == "mechanical_advantage":
            return [next(advantages)]
        if quantity.kind == "transmission_angle":
            return [transmission_angle(run, quantity)]
        if quantity.kind == "dynamic_transmission_angle":
            return [dynamic_transmission_angle(run, quantity)]
        if quantity.kind in LEDGER_KINDS:
            return [energies()[quantity.kind.removeprefix("ledger_")]]
        if quantity.kind in COEFFICIENT_KINDS:
            return [*linear[quantity.name]]
        if quantity.kind in INSTANT_KINDS:
            part = instant(owner)[quantity.kind.removeprefix("screw_")]
        else:
            assert quantity.kind in FINITE_KINDS
            part = finite(owner)[quantity.kind.removeprefix("finite_")]
        return [*part] if isinstance(part, tuple) else [part]

    return [parts(quantity) for quantity in wanted]
