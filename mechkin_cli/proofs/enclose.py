"""Quantities enclosed by the kernel over boxes that hold the positions (docs/numerics.md,
Intervals), with the inputs and constants of the file's text enclosed as well.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.memo import remembered
from mechkin_cli.plan import Demand, demand_of
from mechkin_cli.proofs.boxes import about_high
from mechkin_cli.record import NamedTuple
from mechkin_cli.tape import TraceLost

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Outputs, Plan
    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats


# what boxes hold, by which they are drawn together: a zero of as many equations as there are
# unknowns, or a position at which all of them hold
_SOLVED, _CLOSED = 1, 2


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


class EnclosedInputs(NamedTuple):
    """The inputs of rows: high and low parts, and radii about their sums.

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
    def of(cls, session: Session) -> EnclosedInputs:
        """Of the file's text; where it cannot be followed to them, of the doubles."""
        try:
            precise = session.precise.enclosed_inputs(session)
        except (LookupError, ValueError, TraceLost):
            return cls.of_doubles(session)
        time = None if precise.time is None else precise.time[None]
        orders = precise.reduced, precise.rates, precise.accelerations, precise.jerks
        return cls(*orders, precise.whole, precise.constraint_rates, time)

    @classmethod
    def of_doubles(cls, session: Session) -> EnclosedInputs:
        """As the kernel has them."""
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
    inputs: EnclosedInputs,
    wanted: Iterable[Wanted],
    *,
    turned: Floats | None = None,
    closed: bool = False,
) -> Mapping[str, Enclosure]:
    """Enclosures of quantities in SI (width, rows) by name.

    Nothing is known of what goes by friction, or by efforts at actuators other than the inputs.
    Reactions are those that the closing equations give which are solved for: of
    unique ones, the reactions. Angles are those next to the kernel's, up to whole turns.

    Args:
        turned: the cut joints' angles as following has them (turn slots, rows).
        closed: every closing equation holds at the positions, also those that are not solved for.
    """
    wanted = tuple(wanted)
    demand = demand_of(session.problem.mechanism, wanted)
    readout = session.readout(wanted)
    outputs: Outputs = readout.outputs
    constants = _enclosed_outputs(session, wanted)
    if constants is not None:
        outputs = outputs.with_constants(np.ascontiguousarray(constants[:, 0]))
    rows = positions.states.shape[1]
    values = np.full((3 * outputs.slots, rows), np.nan)
    _kernel.enclose(
        positions.plan,
        **_boxes(positions, inputs.inputs),
        contract=_CLOSED if closed else _SOLVED,
        rates=_rows(inputs.rates) if demand & Demand.VELOCITY else None,
        accelerations=_rows(inputs.accelerations) if demand & Demand.ACCELERATION else None,
        jerks=_rows(inputs.jerks) if demand & Demand.JERK else None,
        constraint_rates=None
        if inputs.constraint_rates is None
        else _rows(inputs.constraint_rates),
        time=None if inputs.time is None else _rows(inputs.time),
        turned=turned,
        whole=inputs.whole,
        forces=int(bool(demand & Demand.FORCES)),
        outputs=outputs,
        output_low=_part(constants, 1),
        output_radii=_part(constants, 2),
        values=values,
    )
    enclosures = {}
    for quantity in wanted:
        slot = readout.slots[quantity.name]
        parts = values.reshape(-1, 3, rows)[slot]
        known = np.isfinite(parts).all(axis=1)
        radius = np.where(known, parts[:, 2], np.inf)
        enclosures[quantity.name] = Enclosure(parts[:, 0], parts[:, 1], radius)
    return enclosures


def _boxes(positions: Positions, inputs: Floats) -> dict[str, Any]:
    """What the kernel is given of boxes: the second and third parts of the constants, the middles
    and radii, and the inputs (inputs, 3, rows)."""
    return {
        "low": _part(positions.constants, 1),
        "radii": _part(positions.constants, 2),
        "states": np.ascontiguousarray(positions.states),
        "inputs": _rows(inputs),
        "radius": np.ascontiguousarray(positions.radius),
    }


def enclose_positions(positions: Positions, inputs: Floats, *, closed: bool) -> Enclosure:
    """The positions by columns (columns, rows), in rad and the kernel's lengths; of orientations
    the increments that turn that of the boxes' middles to them.

    Args:
        positions: boxes that hold them.
        inputs: as in `EnclosedInputs` (inputs, 3, rows).
        closed: as in `enclose`.
    """
    columns, rows = positions.radius.shape
    found = np.empty((3 * columns, rows))
    _kernel.enclose(
        positions.plan,
        **_boxes(positions, inputs),
        contract=_CLOSED if closed else _SOLVED,
        position=found,
    )
    return Enclosure(*found.reshape(columns, 3, rows).transpose(1, 0, 2))


def enclose_derivatives(
    positions: Positions, inputs: Floats, number: int
) -> tuple[Enclosure, Enclosure]:
    """First and second derivatives of the columns (columns, places) by one of the inputs, all over
    the boxes.

    Args:
        positions: where the mechanism is.
        inputs: as in `EnclosedInputs` (inputs, 3, places).
        number: of the input that moves.
    """
    columns, places = positions.radius.shape
    rates = np.zeros((inputs.shape[0], places))
    rates[number] = 1.0
    first, second = np.empty((3 * columns, places)), np.empty((3 * columns, places))
    _kernel.enclose(
        positions.plan,
        **_boxes(positions, inputs),
        contract=_SOLVED,
        rates=_rows(_point(rates)),
        accelerations=_rows(_point(np.zeros_like(rates))),
        first=first,
        second=second,
    )
    slope, bend = (
        Enclosure(*parts.reshape(columns, 3, places).transpose(1, 0, 2))
        for parts in (first, second)
    )
    return slope, bend


def _point(values: Floats) -> Floats:
    """Doubles that are exact (numbers, rows)."""
    return np.stack([values, np.zeros_like(values), np.zeros_like(values)], axis=1)


def _rows(parts: Floats) -> Floats:
    """The parts of each number, one row below the other."""
    return np.ascontiguousarray(parts.reshape(-1, parts.shape[2]))


def _part(constants: Floats | None, number: int) -> Floats | None:
    return None if constants is None else np.ascontiguousarray(constants[:, number])


@remembered
def _enclosed_outputs(session: Session, wanted: tuple[Wanted, ...]) -> Floats | None:
    """The outputs' constants of the file's text, in parts (constants, 3); None where it cannot be
    followed to them."""
    try:
        return session.precise.enclosed_outputs(session, wanted)
    except (LookupError, ValueError, TraceLost):
        return None
