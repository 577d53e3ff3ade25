"""Quantities of rows, enclosed over boxes that hold the rows' positions (docs/numerics.md,
Intervals).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import DERIVED_KINDS, LEDGER_KINDS, is_angle
from mechkin_cli.memo import remembered
from mechkin_cli.plan import Demand, demand_of
from mechkin_cli.proofs.boxes import Enclosed, about_high, distance, enclosed_of, input_rounding
from mechkin_cli.proofs.modes import FULL_TURN
from mechkin_cli.record import NamedTuple
from mechkin_cli.tape import TraceLost

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Outputs, Plan
    from mechkin_cli.mechanism import Problem, Wanted
    from mechkin_cli.session import Session
    from mechkin_cli.show import Bools, Floats


class Enclosure(NamedTuple):
    """Numbers that are off high + low by no more than a radius; nothing is known where it is
    infinite. All of the same shape."""

    high: Floats
    low: Floats
    radius: Floats

    @property
    def about_high(self) -> Floats:
        """Radius about the high parts alone."""
        return about_high(self)


class Given(NamedTuple):
    """The inputs of rows, enclosed: high and low parts, and radii about their sums.

    Attributes:
        inputs, rates, accelerations, jerks: (inputs, 3, rows), values without whole turns.
        whole: those turns (inputs, rows).
        constraint_rates: rates of inputs by those that lead them (constraints, 3, rows).
        time: what laws of loads read as time, s (1, 3, rows).
    """

    inputs: Floats
    rates: Floats
    accelerations: Floats
    jerks: Floats
    whole: Floats
    constraint_rates: Floats | None
    time: Floats | None

    @classmethod
    def of(cls, session: Session) -> Given:
        """As the file's text says them; where it cannot be followed to them, as the doubles are."""
        try:
            precise = session.precise.enclosed_inputs(session)
        except (LookupError, ValueError, TraceLost):
            return cls.of_doubles(session)
        time = None if precise.time is None else precise.time[None]
        orders = precise.reduced, precise.rates, precise.accelerations, precise.jerks
        return cls(*orders, precise.whole, precise.constraint_rates, time)

    @classmethod
    def of_doubles(cls, session: Session) -> Given:
        """As the kernel holds them."""
        inputs, moments = session.inputs, session.problem.motion.time
        rates = session.constraint_rates
        return cls(
            _point(inputs.reduced),
            _point(inputs.rates),
            _point(inputs.accelerations),
            _point(inputs.jerks),
            inputs.whole,
            None if rates is None else _point(rates),
            None if moments is None else _point(moments.values[None]),
        )


class Positions(NamedTuple):
    """Where the rows' positions are.

    Attributes:
        plan: the mechanism's plan at its constants' high parts.
        constants: high and low parts and radii about their sums (constants, 3); None: those of the
            plan are exact.
        states: the boxes' middles (states, rows).
        radius: their radii (columns, rows), rad and the kernel's lengths; of orientations those of
            the increments that turn them.
    """

    plan: Plan
    constants: Floats | None
    states: Floats
    radius: Floats


def enclose(
    session: Session,
    positions: Positions,
    given: Given,
    wanted: Iterable[Wanted],
    *,
    turned: Floats | None = None,
) -> Mapping[str, Enclosure]:
    """Enclosures of quantities in SI (width, rows) by name.

    Nothing is known of what goes by friction, by efforts at actuators other than the inputs, or by
    tables of loads. Reactions are those that the closing equations give which are solved for: of
    unique ones, the reactions. Angles are those next to the kernel's, up to whole turns.

    Args:
        turned: the closing joints' angles as following has them (turn slots, rows).
    """
    wanted = tuple(wanted)
    mechanism = session.problem.mechanism
    demand = demand_of(mechanism, wanted)
    readout = session.readout(wanted)
    outputs, constants = _outputs(session, readout.outputs, wanted)
    rows = positions.states.shape[1]
    moving, forces = bool(demand & Demand.VELOCITY), bool(demand & Demand.FORCES)
    accelerating = bool(demand & Demand.ACCELERATION)
    values = np.full((3 * outputs.slots, rows), np.nan)
    _kernel.enclose(
        positions.plan,
        low=_part(positions.constants, 1),
        radii=_part(positions.constants, 2),
        states=np.ascontiguousarray(positions.states),
        inputs=_rows(given.inputs),
        radius=positions.radius,
        contract=1,
        rates=_rows(given.rates) if moving else None,
        accelerations=_rows(given.accelerations) if accelerating else None,
        jerks=_rows(given.jerks) if demand & Demand.JERK else None,
        ties=None if given.constraint_rates is None else _rows(given.constraint_rates),
        time=None if given.time is None else _rows(given.time),
        turned=turned,
        whole=given.whole,
        forces=int(forces),
        outputs=outputs,
        output_low=_part(constants, 1),
        output_radii=_part(constants, 2),
        values=values,
    )
    found = {}
    for quantity in wanted:
        slot = readout.slots[quantity.name]
        parts = values.reshape(-1, 3, rows)[slot.first : slot.first + slot.width]
        known = np.isfinite(parts).all(axis=1)
        radius = np.where(known, parts[:, 2], np.inf)
        found[quantity.name] = Enclosure(parts[:, 0], parts[:, 1], radius)
    return found


def enclose_derivatives(
    positions: Positions, inputs: Floats, number: int
) -> tuple[Enclosure, Enclosure]:
    """First and second derivatives of the columns (columns, places) by one of the inputs, all over
    the boxes.

    Args:
        positions: where the mechanism is.
        inputs: as in `Given` (inputs, 3, places).
        number: of the input that moves.
    """
    columns, places = positions.radius.shape
    rates = np.zeros((inputs.shape[0], places))
    rates[number] = 1.0
    first, second = np.empty((3 * columns, places)), np.empty((3 * columns, places))
    _kernel.enclose(
        positions.plan,
        low=_part(positions.constants, 1),
        radii=_part(positions.constants, 2),
        states=np.ascontiguousarray(positions.states),
        inputs=_rows(inputs),
        radius=np.ascontiguousarray(positions.radius),
        contract=1,
        rates=_rows(_point(rates)),
        accelerations=_rows(_point(np.zeros_like(rates))),
        first=first,
        second=second,
    )
    one, other = (
        Enclosure(*found.reshape(columns, 3, places).transpose(1, 0, 2))
        for found in (first, second)
    )
    return one, other


def _point(values: Floats) -> Floats:
    """Doubles that are exact (numbers, rows)."""
    return np.stack([values, np.zeros_like(values), np.zeros_like(values)], axis=1)


def _rows(parts: Floats) -> Floats:
    """The parts of each number, one row below the other."""
    return np.ascontiguousarray(parts.reshape(-1, parts.shape[2]))


def _part(constants: Floats | None, number: int) -> Floats | None:
    return None if constants is None else np.ascontiguousarray(constants[:, number])


def _outputs(
    session: Session, outputs: Outputs, wanted: tuple[Wanted, ...]
) -> tuple[Outputs, Floats | None]:
    """The outputs with the numbers of the file's text, and all parts of these (constants, 3); as
    they are, and None, where the text cannot be followed to them."""
    try:
        constants = _enclosed_outputs(session, wanted)
    except (LookupError, ValueError, TraceLost):
        return outputs, None
    return outputs.with_constants(np.ascontiguousarray(constants[:, 0])), constants


@remembered
def _enclosed_outputs(session: Session, wanted: tuple[Wanted, ...]) -> Floats:
    return session.precise.enclosed_outputs(session, wanted)


# Quantities of proven rows, enclosed (docs/numerics.md, Intervals).

_OF_ROWS = {"kinetic_energy", "potential_energy"}


def reason_against(quantity: Wanted) -> str:
    """Why a quantity has no enclosure in any mechanism; "" where it can have one."""
    if quantity.kind in LEDGER_KINDS:
        return "a sum over the rows"
    if quantity.kind in DERIVED_KINDS:
        return "computed from other quantities in doubles alone"
    if quantity.owner == "row" and quantity.kind not in _OF_ROWS:
        return "a verdict"
    return ""


def is_angle_of_place(quantity: Wanted) -> bool:
    """Whether it is an angle of a joint, no rate of one."""
    return quantity.kind == "coordinate" and not quantity.order and is_angle(quantity.coordinate)


def reason_unknown(problem: Problem) -> str:
    """Why forces of a mechanism have no enclosure in any row that is proven; "" where they have."""
    if problem.mechanism.frictions:
        return "friction, whose sticking and slipping is decided in doubles"
    if any(law.curve is not None for law in problem.load_laws):
        return "a load that is read from a table, whose curve is known in doubles"
    drives = problem.mechanism.drives
    if drives is not None and drives.actuators:
        return "efforts at actuators other than the inputs, which are solved for in doubles"
    return ""


def bounds(
    problem: Problem, wanted: Wanted, enclosure: Enclosure, known: Floats
) -> tuple[Floats, Floats]:
    """Bounds of a quantity in the file's units, two arrays (width, places); nan where nothing is
    known. Angles are those next to what is `known` in SI, of the same shape; those of threads, of
    which a turn more is another place, are as they are enclosed."""
    seen = list(wanted.places)
    middle, radius = enclosure.high[seen], enclosure.about_high[seen]
    scale = np.abs(middle)
    if is_angle_of_place(wanted) and _is_cyclic(problem, wanted):
        turns = FULL_TURN * np.rint((known - middle) / FULL_TURN)
        middle, scale = middle + turns, scale + np.abs(turns)
    middle, radius, scale = (
        np.asarray(problem.units.from_si(part, wanted.dimension))
        for part in (middle, radius, scale)
    )
    off = radius + tolerances.ENCLOSURE_ROUNDING * (radius + scale)
    off = np.where(np.isfinite(off) & np.isfinite(np.atleast_2d(known)), off, np.nan)
    return middle - off, middle + off


def _is_cyclic(problem: Problem, angle: Wanted) -> bool:
    """Whether a turn more of a joint's angle is the same place."""
    kind = problem.mechanism.joints[angle.owner].type
    return kind.chain[kind.freedom_of[angle.coordinate]].is_cyclic


def inside_boxes(session: Session) -> Bools:
    """Rows whose inputs, as the text says them, are among those that the boxes were proven for."""
    return _are_inside(session, _enclosed(session)[1])


def _enclosed(session: Session) -> tuple[Enclosed, Given]:
    """The mechanism and its inputs, of the text where it can be followed to them."""
    enclosed = enclosed_of(session)
    return enclosed, Given.of(session) if enclosed.of_text else Given.of_doubles(session)


def _are_inside(session: Session, given: Given) -> Bools:
    reduced = session.inputs.reduced
    high, low, radius = given.inputs.transpose(1, 0, 2)
    inside = distance(high, low, reduced) + radius <= input_rounding(session, reduced)
    found: Bools = np.asarray(inside.all(axis=0), dtype=np.bool_)
    return found
