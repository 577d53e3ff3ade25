"""How a response begins: its place is assembled by the coordinates that its start names, and its
free rates are told along these, or where one of them is at a dead centre along others."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.kernel.functions import RandomStarts
from mechkin_cli.mechanism import ORDERS, eliminated, is_angle
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple
from mechkin_cli.response.integration import Beginning
from mechkin_cli.session import Ask, Chart, RowInputs, Session
from mechkin_cli.sweep import lost_rates

if TYPE_CHECKING:
    from mechkin_cli.mechanism import ResponseProblem, StartValue, Wanted
    from mechkin_cli.show import Bools, Floats


class _UnitRates(NamedTuple):
    """Rows at one place with unit rate of one free direction after the other, then of the driven
    coordinates, and the rates of all columns there, `moved` (directions and coordinates, columns).
    """

    session: Session
    rows: RowInputs
    moved: Floats

    @staticmethod
    def of(session: Session, rows: RowInputs) -> _UnitRates:
        """As the session has them, not finite where they have none."""
        batch = session.run(rows, Ask(Demand.VELOCITY, derivatives=True))
        assert batch.first is not None
        return _UnitRates(session, rows, np.ascontiguousarray(batch.first.T))

    @property
    def are_fixed(self) -> bool:
        """Whether the place has them, beyond rounding."""
        return bool(np.all(np.abs(self.moved) < 1.0 / tolerances.RANK_ZERO))

    def read(self, wanted: Sequence[Wanted]) -> Floats:
        """Some rates in SI (wanted, directions and coordinates)."""
        readout = self.session.readout(wanted)
        batch = self.session.run(self.rows, Ask(Demand.VELOCITY, readout))
        assert batch.outputs is not None
        return np.array([batch.outputs[readout.slots[one.name].start] for one in wanted])


def _by_coordinates(session: Session, state: Floats) -> _UnitRates:
    """The directions are those of the coordinates that the start names, the session's inputs."""
    count = len(session.graph.inputs)
    each = np.zeros(count, dtype=np.intp)
    rows = RowInputs(session.inputs.reduced[:, each], state[:, None][:, each], np.eye(count))
    return _UnitRates.of(session, rows)


def _by_directions(session: Session, free: Session, state: Floats, count: int) -> _UnitRates:
    """Any directions of the `free` motion, which have rates where some coordinate is at a dead
    centre, too; not at a branch point."""
    driven = len(session.graph.inputs) - count
    each = np.zeros(count + driven, dtype=np.intp)
    directions = RandomStarts().between(1.0, count * free.plan.columns)
    units = np.eye(count + driven)
    none = np.zeros((count, count + driven))
    chart = Chart(directions[:, None][:, each], units[:count], none, none[:0])
    inputs, states = session.inputs.reduced[count:, each], state[:, None][:, each]
    return _UnitRates.of(free, RowInputs(inputs, states, units[count:], chart=chart))


def beginning(
    session: Session, free: Session, response: ResponseProblem, state: Floats
) -> Beginning | Diagnostic:
    """How the mechanism moves from an assembly `state` (states,) of a session whose inputs are the
    response's independent coordinates and then its driven ones; `free` is its free motion's."""
    count = len(response.independent)
    begin = state.copy()
    layout = session.layout
    # the whole turns of an angle that the file names stay in its state
    for number, (edge, freedom) in enumerate(session.graph.inputs):
        begin[layout.state(edge, freedom)] = session.inputs.values[number, 0]
    unit = _by_coordinates(session, state)
    if not unit.are_fixed or session.is_redundant:
        others = _by_directions(session, free, begin, count)
        if not unit.are_fixed or (others.are_fixed and _is_dead_centre(session, response, others)):
            unit = others
    if not unit.are_fixed:
        return Diagnostic(
            "start-at-dead-centre",
            "error",
            "the start is a special position, as a branch point, at which rates of the coordinates "
            "that it names do not fix how the mechanism moves on",
            response.place,
            hint="start beside it",
        )
    if unit.session is session:
        rates = _by_named(session, response, state, unit)
    else:
        rates = _at_dead_centre(session, response, unit)
    if isinstance(rates, Diagnostic):
        return rates
    first = np.zeros(unit.moved.shape[1])
    for rate, row in zip(rates, unit.moved, strict=True):
        first = first + rate * row
    return Beginning(begin, first, unit.moved[:count])


def _is_dead_centre(session: Session, response: ResponseProblem, unit: _UnitRates) -> bool:
    """Whether independent coordinates do not tell how it moves along the directions. Where
    constraints are redundant, rates by these coordinates are least squares, and finite there."""
    independent = set(response.independent)
    named = [one for one in response.start if (one.joint, one.coordinate) in independent]
    by_rate, moves = _matrix(session, response, unit, named)
    matrix = np.where(moves, by_rate[:, : len(named)], 0.0)
    return eliminated(matrix.tolist(), [0.0] * len(named), tolerances.RANK_ZERO) is None


def _by_named(
    session: Session, response: ResponseProblem, state: Floats, unit: _UnitRates
) -> Floats | Diagnostic:
    """Rates of all inputs in kernel units: the driven ones by their laws, the independent ones so
    that the coordinates named with a rate have it."""
    rates: Floats = session.inputs.rates[:, 0].copy()
    independent = set(response.independent)
    with_rate = [one for one in response.start if one.rate is not None]
    if any((one.joint, one.coordinate) not in independent for one in with_rate):
        return _solved(session, response, unit, rates, with_rate)
    if not rates.any():
        return rates
    # at its dead centre a coordinate has no rate: any other than zero means infinite ones of others
    lost = lost_rates(session, np.zeros(1, dtype=np.intp), state[:, None])[:, 0]
    # behind the inputs is what is held, at rest
    inputs = session.problem.motion.inputs
    named = [one.name for k, one in enumerate(inputs) if lost[k] and rates[k] != 0.0]
    return _dead_centre_of(named, response) if named else rates


def _at_dead_centre(
    session: Session, response: ResponseProblem, unit: _UnitRates
) -> Floats | Diagnostic:
    """Rates along directions that stand for the independent coordinates, then of the driven ones:
    what the start names without a rate rests."""
    rates: Floats = session.inputs.rates[:, 0].copy()
    free = len(response.independent)
    with_rate = [one for one in response.start if one.rate is not None]
    if not any(one.rate for one in with_rate) and not rates[free:].any():
        rates[:free] = 0.0
        return rates
    still = [one for one in response.start if one.rate is None]
    every = [*with_rate, *still]
    _, moves = _matrix(session, response, unit, every)
    dead = [one.name for one, row in zip(every, moves, strict=True) if one.rate and not row.any()]
    if dead:
        return _dead_centre_of(dead, response)
    # where rates are too few, what is named without one rests, but for what is at its dead centre
    able = [one for one, row in zip(still, moves[len(with_rate) :], strict=True) if row.any()]
    with_rate += able[: max(free - len(with_rate), 0)]
    return _solved(session, response, unit, rates, with_rate)


def _dead_centre_of(names: Sequence[str], response: ResponseProblem) -> Diagnostic:
    return Diagnostic(
        "start-at-dead-centre",
        "error",
        f"the start is a dead centre of {', '.join(names)}: no rate of it is one of the mechanism",
        response.place,
        hint="give the rate of a coordinate that moves there, or start beside it",
    )


def _matrix(
    session: Session, response: ResponseProblem, unit: _UnitRates, named: Sequence[StartValue]
) -> tuple[Floats, Bools]:
    """Rates of some coordinates in SI for unit rates (named, inputs), and which of the free ones
    move them: what does not move in parts of what moves most has no rate but rounding."""
    free, length = len(response.independent), session.layout.length
    known = session.problem.quantities()
    by_rate = unit.read([known[f"{one.name}{ORDERS[1]}"] for one in named])
    largest = np.abs(unit.moved[:free]).max(axis=1)
    units = np.array([1.0 if is_angle(one.coordinate) else length for one in named])
    return by_rate, np.abs(by_rate[:, :free]) > tolerances.RANK_ZERO * units[:, None] * largest


def _solved(
    session: Session,
    response: ResponseProblem,
    unit: _UnitRates,
    rates: Floats,
    with_rate: Sequence[StartValue],
) -> Floats | Diagnostic:
    """Rates of all inputs (inputs,), kernel units, with which some coordinates have their rates.

    Linear in the independent rates: the named rates are read at unit rates of one input after the
    other. `rates` holds those of the driven inputs behind the independent ones.
    """
    free = len(response.independent)
    by_rate, moves = _matrix(session, response, unit, with_rate)
    right = np.array([one.rate or 0.0 for one in with_rate])
    for number in range(free, len(rates)):
        right = right - by_rate[:, number] * rates[number]
    solved = None
    if len(with_rate) == free:
        matrix = np.where(moves, by_rate[:, :free], 0.0)
        solved = eliminated(matrix.tolist(), right.tolist(), tolerances.RANK_ZERO)
    if solved is None:
        names = ", ".join(f"{one.name}_dot" for one in with_rate if one.rate is not None)
        return Diagnostic(
            "start-rates",
            "error",
            f"the rates given at the start ({names}) do not fix how the mechanism moves",
            response.place,
            hint="give the rates of the coordinates that start names, or of others that move "
            "with each of them",
        )
    return np.array([*solved, *rates[free:]])
