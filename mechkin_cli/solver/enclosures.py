"""Quantities of rows, enclosed over boxes that hold the rows' positions (docs/numerics.md,
Intervals)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of
from mechkin_cli.tape.traced import TraceLost

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import Outputs, Plan
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.session import Session

ENCLOSED = Demand.VELOCITY | Demand.ACCELERATION | Demand.FORCES
"""What is enclosed beyond positions: no third derivatives, no verdicts."""


class Enclosure(NamedTuple):
    """Numbers between middle - radius and middle + radius; nothing is known where the radius is
    infinite. Both of the same shape."""

    middle: Floats
    radius: Floats


class Given(NamedTuple):
    """The inputs of rows, enclosed.

    Attributes:
        inputs, rates, accelerations: (inputs, rows), values without whole turns.
        whole: those turns (inputs, rows).
        ties: rates of tied inputs by those of their leaders (ties, rows).
        time: what laws of loads read as time, s (1, rows).
    """

    inputs: Enclosure
    rates: Enclosure
    accelerations: Enclosure
    whole: Floats
    ties: Enclosure | None
    time: Enclosure | None

    @classmethod
    def of(cls, session: Session) -> Given:
        """As the file's text says them; where it cannot be followed to them, as the doubles are."""
        try:
            precise = session.precise.enclosed_inputs(session)
        except (LookupError, ValueError, TraceLost):
            return cls.of_doubles(session)
        ties, time = precise.tie_rates, precise.time
        return cls(
            _both(precise.reduced),
            _both(precise.rates),
            _both(precise.accelerations),
            precise.whole,
            None if ties is None else _both(ties),
            None if time is None else _both(time[None]),
        )

    @classmethod
    def of_doubles(cls, session: Session) -> Given:
        """As the kernel holds them."""
        inputs, moments = session.inputs, session.problem.motion.time
        ties = session.tie_rates
        return cls(
            _point(inputs.reduced),
            _point(inputs.rates),
            _point(inputs.accelerations),
            inputs.whole,
            None if ties is None else _point(ties),
            None if moments is None else _point(moments.values[None]),
        )


class Positions(NamedTuple):
    """Where the rows' positions are.

    Attributes:
        plan, radii: the mechanism's plan at its constants' midpoints, and a plan of their radii
            (None: the constants are exact).
        states: the boxes' middles (states, rows).
        radius: their radii (columns, rows), rad and the kernel's lengths; of orientations those of
            the increments that turn them.
    """

    plan: Plan
    radii: Plan | None
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
    if demand & ~ENCLOSED:
        raise ValueError("third derivatives are not enclosed")
    readout = session.readout(wanted)
    outputs, output_radii = _outputs(session, readout.outputs, wanted)
    rows = positions.states.shape[1]
    moving, forces = bool(demand & Demand.VELOCITY), bool(demand & Demand.FORCES)
    accelerating = bool(demand & Demand.ACCELERATION)
    values = np.full((2 * outputs.slots, rows), np.nan)
    _kernel.enclose(
        positions.plan,
        radii=positions.radii,
        states=np.ascontiguousarray(positions.states),
        inputs=_parts(given.inputs),
        radius=positions.radius,
        rates=_parts(given.rates) if moving else None,
        accelerations=_parts(given.accelerations) if accelerating else None,
        ties=None if given.ties is None else _parts(given.ties),
        time=None if given.time is None else _parts(given.time),
        turned=turned,
        whole=given.whole,
        forces=int(forces),
        outputs=outputs,
        output_radii=output_radii,
        values=values,
    )
    found = {}
    for quantity in wanted:
        slot = readout.slots[quantity.name]
        parts = values.reshape(-1, 2, rows)[slot.first : slot.first + slot.width]
        middle, radius = parts[:, 0], parts[:, 1]
        known = np.isfinite(middle) & np.isfinite(radius)
        found[quantity.name] = Enclosure(middle, np.where(known, radius, np.inf))
    return found


def _both(parts: Floats) -> Enclosure:
    """Of (numbers, 2, rows)."""
    return Enclosure(parts[:, 0], parts[:, 1])


def _point(values: Floats) -> Enclosure:
    return Enclosure(values, np.zeros_like(values))


def _parts(enclosure: Enclosure) -> Floats:
    """Midpoint and radius of each number, one row below the other."""
    both = np.stack(enclosure, axis=1)
    return np.ascontiguousarray(both.reshape(-1, both.shape[2]))


def _outputs(
    session: Session, outputs: Outputs, wanted: tuple[Wanted, ...]
) -> tuple[Outputs, Outputs | None]:
    """The outputs with the numbers of the file's text, and with their radii; as they are where the
    text cannot be followed to them."""
    try:
        middle, radius = session.precise.enclosed_outputs(session, wanted).T
    except (LookupError, ValueError, TraceLost):
        return outputs, None
    return (
        outputs.with_constants(np.ascontiguousarray(middle)),
        outputs.with_constants(np.ascontiguousarray(radius)),
    )
