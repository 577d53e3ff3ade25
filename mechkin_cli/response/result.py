"""The rows of a response, read as those of a sweep are."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly import mode_letter
from mechkin_cli.expressions import Quantity
from mechkin_cli.mechanism import (
    DRIVEN_KINDS,
    ORDERS,
    DrivenInput,
    MotionInputs,
    Varying,
    dimension_of,
    law_value,
    response_quantities,
)
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.response.impulses import impact_table
from mechkin_cli.session import RowInputs
from mechkin_cli.sweep import Result, SweepRows
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.mechanism import Amount, ResponseProblem, Wanted
    from mechkin_cli.response.integration import Impact, Rebound
    from mechkin_cli.response.report import MotionReport
    from mechkin_cli.session import Chart, KernelInputs, Session
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.tables import Columns


def _as_input(response: FreeResult, joint: str, coordinate: str) -> DrivenInput:
    """A coordinate with its rates and accelerations, zero in rows without a solution."""
    rows, dimension, orders = response.rows, dimension_of(coordinate), []
    for suffix in ORDERS[:3]:
        quantity = response.quantity(f"{joint}.{coordinate}{suffix}")
        value = np.asarray(quantity.value, dtype=np.float64)
        orders.append(np.where(response.solved, np.broadcast_to(value, (rows,)), 0.0))
    values, rates, accelerations, jerks = *orders, np.zeros(rows)
    written = np.array(
        [
            response.units.from_si(numbers.copy(), dimension / TIME**order)
            for order, numbers in enumerate((values, rates, accelerations, jerks))
        ]
    )
    return DrivenInput(joint, coordinate, values, rates, accelerations, jerks, written)


OtherLoads = tuple["Session", "ResponseProblem"]
"""The free motion's session and its response with loads that differ from those of the rows in
nothing but reactions."""

OTHER_LOADS = 100
"""The first shift that stands for other loads; those before it are parts of the null space."""

ENERGIES = ("row.kinetic_energy", "row.potential_energy")


class Energies(NamedTuple):
    """The balance of energies over many rows, J: kinetic and potential energy of the first row with
    a position; the largest part of the balance, the largest potential energy, and the most that is
    missing in any row."""

    kinetic: float
    potential: float
    largest: float = 0.0
    level: float = 0.0
    missing: float = 0.0

    def error(self, missing: Floats) -> Floats | None:
        """What is missing beyond rounding in parts of the largest; None where nothing moves or
        works."""
        if not self.largest > 0.0:
            return None
        rounding = tolerances.ENERGY_ROUNDING * self.level
        found: Floats = np.maximum(missing - rounding, 0.0) / self.largest
        return found

    def between(self, report: MotionReport, length: float) -> Energies:
        """With the largest kinetic energy between the rows of a motion; `length` in m."""
        return self._replace(largest=max(self.largest, length * length * report.energy))


class FreeResult(Result):
    """Rows in which loads and given efforts decide where what is free is, or how it moves.

    Args:
        session: of what is free, with the driven coordinates at the rows.
        start: the first assembly, of a session `chosen` with the start's coordinates as inputs.
        rows: the rows.
        chart: about each row.
        response: the file's.
    """

    def __init__(
        self,
        session: Session,
        start: AssemblyStart,
        rows: SweepRows,
        *,
        chosen: Session,
        chart: Chart,
        response: ResponseProblem,
    ) -> None:
        super().__init__(session, start, rows)
        self.chosen, self.chart, self.response = chosen, chart, response
        self.measure = "energy_error" if response.search is None else "imbalance"

    @cached_property
    def solved(self) -> Bools:
        """Rows that were reached and have a position (rows,)."""
        return self.row_states.reached & super().solved

    @cached_property
    def mode(self) -> str:
        """The letter of the first assembly where a short search proves it; else `near` or
        `home`."""
        return mode_letter(self.chosen, self.start, thorough=False)

    @cached_property
    def letter(self) -> str:
        """The letter of the first assembly, searched for if it is not known yet."""
        return mode_letter(self.chosen, self.start)

    def _row_inputs(self, session: Session, inputs: KernelInputs) -> RowInputs:
        chart = self.chart
        if not session.problem.mechanism.frictions:  # nothing rubs in that session
            chart = chart._replace(friction=chart.friction[:0])
        return super()._row_inputs(session, inputs)._replace(chart=chart)

    @cached_property
    def as_driven(self) -> Result:
        """The same rows as a sweep of the start's coordinates, by whose accelerations the
        coefficients of the equations of motion are; near a dead centre of them there are none: a
        sweep with these states, rates and accelerations, on the same tree."""
        own, moving = self.row_states, self.problem.motion
        free = [_as_input(self, *at) for at in self.response.independent]
        motion = MotionInputs((*free, *moving.inputs), moving.rows, moving.time, moving.course)
        session = self.chosen.moved(replace(self.chosen.problem, motion=motion))
        rows = SweepRows.without_guesses(own.states.shape[0], 0, moving.rows)
        rows.states, rows.reached, rows.status = own.states, own.reached, own.status
        # cut joints have the same turns; the tree's angles have theirs in the states
        closing = own.turns[: own.turns.shape[0] - len(self.session.structure.tree_slots)]
        still = np.zeros((len(session.structure.tree_slots), moving.rows))
        rows.turns = np.concatenate([closing, still])
        return Result(session, self.start, rows)

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by name, in SI.

        Raises:
            UnknownName: nothing has this name.
        """
        wanted = self.problem.quantities().get(name)
        if wanted is not None and wanted.kind in DRIVEN_KINDS:
            return self.as_driven.quantity(name)
        if wanted is not None and self.is_given(wanted):
            return Quantity(self._effort(wanted), wanted.dimension)
        return super().quantity(name)

    def read(self, wanted: Iterable[Wanted]) -> None:
        """Evaluates the quantities that have not been read yet."""
        super().read(
            one for one in wanted if one.kind not in DRIVEN_KINDS and not self.is_given(one)
        )

    def is_given(self, quantity: Wanted) -> bool:
        """Whether a quantity is one of the efforts that the file gives."""
        return quantity.kind == "effort" and bool(self._amounts(quantity))

    @property
    def _loads(self) -> ResponseProblem:
        """The run with the loads of the rows."""
        return self.response

    def _amounts(self, wanted: Wanted) -> list[Amount]:
        at = (wanted.owner, wanted.coordinate)
        return [e.amount for e in self._loads.efforts if e.acts_at == at]

    def _effort(self, wanted: Wanted) -> Floats:
        """The sum of the given efforts along a coordinate over the rows."""
        total = np.zeros(self.rows)
        for amount in self._amounts(wanted):
            if isinstance(amount, Varying):
                law = self._loads.load_laws[amount.number]
                total = total + law_value(law, self.quantity, self.rows)
            else:
                total = total + amount
        return np.where(self.solved, total, np.nan)


class ResponseResult(FreeResult):
    """The rows of a response with a position and a verdict each.

    Args:
        session: of the free motion, with the driven coordinates at the rows' moments.
        start: the first assembly, of a session `chosen` with the start's coordinates as inputs.
        rows: the rows.
        chart: about each row.
        work: put in and lost up to each row (2, rows), J.
        events: the stop that each row is at, empty for a moment of the file.
        response: the file's.
        report: how the motion ended.
        rebounds: at limits of coordinates, in order.

    `run_energies` gives those of the whole run, where these are some of its rows.
    """

    def __init__(
        self,
        session: Session,
        start: AssemblyStart,
        rows: SweepRows,
        *,
        chosen: Session,
        chart: Chart,
        work: Floats,
        events: Sequence[str],
        response: ResponseProblem,
        report: MotionReport | None,
        rebounds: Sequence[Rebound] = (),
    ) -> None:
        super().__init__(session, start, rows, chosen=chosen, chart=chart, response=response)
        self.exchanged = work
        self.events, self.report = tuple(events), report
        self.rebounds = tuple(rebounds)
        self.other_loads: tuple[OtherLoads, ...] = ()
        self.run_energies: Callable[[], Energies | None] | None = None

    def take_others(self, others: Sequence[OtherLoads]) -> None:
        """Takes loads that are as good as those of the rows, as of limits that share a freedom:
        reactions which they change are not unique."""
        self.other_loads = tuple(others)
        self.shifts = (*self.shifts, *range(OTHER_LOADS, OTHER_LOADS + len(others)))
        self._shifted = tuple({} for _ in self.shifts)

    def evaluated(
        self,
        wanted: Sequence[Wanted],
        *,
        session: Session | None = None,
        inputs: KernelInputs | None = None,
        demand: Demand = Demand.POSITION,
        shift: int = 0,
    ) -> dict[str, Floats]:
        """As of a sweep; a shift may stand for other loads, of which another session has none."""
        if shift >= OTHER_LOADS:
            session = session or self.other_loads[shift - OTHER_LOADS][0]
            shift = 0
        return super().evaluated(wanted, session=session, inputs=inputs, demand=demand, shift=shift)

    @property
    def impacts(self) -> tuple[Impact, ...]:
        """What limits gave, in order."""
        return tuple(one.impact for one in self.rebounds)

    @property
    def impact_table(self) -> Columns | None:
        """The impacts with what joints transmit; None without any."""
        if not self.rebounds:
            return None
        return impact_table(self.session, self.response.name, self.rebounds)

    @cached_property
    def input_rates(self) -> Mapping[str, Floats]:
        """As of a sweep; and the start's coordinates, which the first row has as the file writes
        them."""
        rates = dict(super().input_rates)
        if self.row_states.span.first or not self.solved[:1].all():
            return rates
        for one in self.response.start:
            for name, first in ((one.name, one.value), (one.name + ORDERS[1], one.rate)):
                if first is not None:
                    rates[name] = self._as_written(name, first)
        return rates

    def _as_written(self, name: str, first: float) -> Floats:
        """A quantity in the file's units, its first value the shortest number that is `first` in
        SI."""
        quantity, units = self.quantity(name), self.units
        rows = np.array(np.broadcast_to(np.asarray(quantity.value, dtype=np.float64), (self.rows,)))
        column = np.array(units.from_si(rows, quantity.dimension), dtype=np.float64)
        short = float(f"{column[0]:.15g}")
        if float(units.to_si(short, quantity.dimension)) == first:
            column[0] = short
        return column

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by name, in SI.

        Raises:
            UnknownName: nothing has this name.
        """
        of_response = response_quantities().get(name)
        if of_response is not None:
            return Quantity(getattr(self, of_response.kind), of_response.dimension)
        return super().quantity(name)

    def read(self, wanted: Iterable[Wanted]) -> None:
        """Evaluates the quantities that have not been read yet."""
        own = response_quantities()
        super().read(quantity for quantity in wanted if quantity.name not in own)

    def is_given(self, quantity: Wanted) -> bool:
        """Whether a quantity is one of the response's efforts."""
        if quantity.kind != "effort":
            return False
        at = (quantity.owner, quantity.coordinate)
        return bool(self._amounts(quantity)) or at in self.response.rebounding

    @property
    def work(self) -> Floats:
        """Work put in up to each row, J (rows,)."""
        return np.asarray(self.exchanged[0])

    @property
    def dissipated(self) -> Floats:
        """What was lost up to each row, J (rows,)."""
        return np.asarray(self.exchanged[1])

    @cached_property
    def energy_error(self) -> Floats:
        """|T + V - T0 - V0 - work + dissipated| beyond the rounding of V, in parts of the largest
        of them over all rows and of T between them (rows,); nan where nothing moves or works."""
        if self.report is None:
            return self._nothing
        found = self.run_energies() if self.run_energies else self.energies_with(None)
        if found is None:
            return self._nothing
        found = found.between(self.report, self.session.layout.length)
        error = found.error(self._missing(found))
        return self._nothing if error is None else error

    def _missing(self, since: Energies) -> Floats:
        """|T + V - T0 - V0 - work + dissipated| of the rows (rows,), J."""
        kinetic, potential = self._mechanical
        work, lost = self.exchanged
        gained = potential - since.potential
        missing: Floats = np.abs(((kinetic - since.kinetic) + gained) - (work - lost))
        return missing

    @property
    def _mechanical(self) -> tuple[Floats, Floats]:
        """Kinetic and potential energy of the rows (rows,), J."""
        kinetic, potential = (
            np.asarray(super(ResponseResult, self).quantity(name).value, dtype=np.float64)
            for name in ENERGIES
        )
        return kinetic, potential

    def energies_with(self, before: Energies | None) -> Energies | None:
        """The energies of these rows and of those before them; None without any."""
        solved = np.flatnonzero(self.solved)
        if not solved.size:
            return before
        kinetic, potential = (energy[solved] for energy in self._mechanical)
        first = before or Energies(float(kinetic[0]), float(potential[0]))
        work, lost = self.exchanged[:, solved]
        parts = np.abs([kinetic, potential - first.potential, work, lost])
        missing = self._missing(first)
        return first._replace(
            largest=max(first.largest, float(parts.max())),
            level=max(first.level, float(np.abs(potential).max())),
            missing=max(first.missing, float(missing[solved].max())),
        )

    @property
    def _loads(self) -> ResponseProblem:
        """The response with the rows' loads, or with the others of an alternative."""
        shift = 0 if self._alternative is None else self.shifts[self._alternative]
        return self.response if shift < OTHER_LOADS else self.other_loads[shift - OTHER_LOADS][1]
