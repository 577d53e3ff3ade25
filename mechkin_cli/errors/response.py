"""The rows of a free motion in double-double; those of a response: its motion repeated from the
numbers of the text.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.errors.motion import (
    ROUGH,
    Fineness,
    ForcedMotion,
    LegendreStep,
    Marching,
    MotionPlaces,
    orthonormal,
)
from mechkin_cli.errors.rows import (
    AS_DRIVEN,
    OTHER_RATES,
    STOP,
    TABLE_LOADS,
    KernelRows,
    NotRepeated,
    Repeated,
    as_number,
    as_parts,
    reason_of,
)
from mechkin_cli.expressions import Quantity, exact_literal
from mechkin_cli.mechanism import Varying, response_quantities
from mechkin_cli.plan import Demand
from mechkin_cli.response import ResponseResult, integrate, prepare
from mechkin_cli.session import Ask, Chart, PreciseConstants, PreciseInputs, RowInputs
from mechkin_cli.tape import DoubleDoubles, double_doubles, exactly

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.response import Beginning, FreeResult
    from mechkin_cli.session import KernelInputs, Precise, Session
    from mechkin_cli.show import Bools, Floats


DENSE = 16
"""Moments to a step of the run in doubles at which the turns of cut joints are looked up: they
move by much less than half a turn in between."""


class FreeRows(KernelRows):
    """The rows of a free motion in double-double, at places that are found anew."""

    result: FreeResult

    @cached_property
    def places(self) -> tuple[MotionPlaces, Bools]:
        """The rows with their rates and accelerations, and which of them are known."""
        raise NotImplementedError

    @cached_property
    def first(self) -> PreciseInputs:
        """The start's inputs, and behind them the locked idle freedoms."""
        return self.precise.inputs(self.result.chosen)

    @cached_property
    def held(self) -> Floats:
        """What is driven and the locked idle freedoms (held inputs, 2), kernel units."""
        independent = len(self.result.response.independent)
        held: Floats = np.ascontiguousarray(self.first.values[independent:, :, 0])
        return held

    @cached_property
    def motion(self) -> ForcedMotion:
        """What moves."""
        return ForcedMotion(self.result.session, self.precise, self.held)

    @cached_property
    def charts(self) -> Floats:
        """The run's chart about each row (freedoms, columns, rows)."""
        freedoms = self.result.session.plan.charts
        charts: Floats = self.result.chart.direction.reshape(freedoms, -1, self.result.rows)
        return charts

    def of_moments(self, in_si: Floats, written: Floats) -> PreciseInputs:
        """What is held in all rows, at moments (2, rows) in s and in the file's unit."""
        count = self.result.rows
        held = np.repeat(self.held[:, :, None], count, axis=2)
        still = np.zeros(held.shape)
        whole = np.zeros((len(held), count))
        return PreciseInputs(held, still, still, still, held, whole, in_si, None, {"time": written})

    def efforts_along(self, wanted: Wanted) -> list[Any]:
        """The run's efforts along the coordinate of a quantity, in SI."""
        response = self.precise.problem.response
        assert response is not None
        at = (wanted.owner, wanted.coordinate)
        amounts = [e.amount for e in response.efforts if e.acts_at == at]
        constant = [amount for amount in amounts if not isinstance(amount, Varying)]
        numbers = iter(double_doubles(self.precise.tape(constant)))
        return [
            amount if isinstance(amount, Varying) else DoubleDoubles(*next(numbers))
            for amount in amounts
        ]

    @property
    def known(self) -> Bools:
        """Rows that are repeated (rows,)."""
        return self.places[1]

    def _row_inputs(self, inputs: KernelInputs, session: Session) -> RowInputs:
        places = self.places[0]
        if not session.plan.charts:
            raise NotRepeated(AS_DRIVEN)
        rates, seconds = (as_parts(self.motion.along(self.charts, part)) for part in places[2:4])
        nothing = np.zeros((0, self.result.rows))
        chart = Chart(self.result.chart.direction, rates, seconds, nothing)
        rows = super()._row_inputs(inputs, session)
        return rows._replace(guess=as_parts(places.states), chart=chart)

    def unknown(self) -> MotionPlaces:
        """Rows of which nothing is known yet."""
        count, plan = self.result.rows, self.result.session.plan
        time, states, rates, seconds = (
            DoubleDoubles(np.full(shape, np.nan))
            for shape in ((count,), (plan.states, count), *[(plan.columns, count)] * 2)
        )
        return MotionPlaces(time, states, rates, seconds, self.result.row_states.turns)


class RepeatedFree(Repeated):
    """As `Repeated`; with the efforts that the run gives."""

    result: FreeResult
    wide: FreeRows

    def quantity(self, name: str) -> Quantity:
        """As `Repeated.quantity`."""
        wanted = self.problem.quantities().get(name)
        if wanted is not None and self.result.is_given(wanted):
            return Quantity(self._effort(wanted), wanted.dimension)  # type: ignore[arg-type]
        return super().quantity(name)

    def read(self, wanted: Iterable[Wanted]) -> None:
        """As `Repeated.read`, without what needs no run."""
        super().read(q for q in wanted if not self.result.is_given(q))

    def _effort(self, wanted: Wanted) -> DoubleDoubles:
        """The sum of the response's efforts along a coordinate."""
        total = DoubleDoubles(np.zeros(self.rows))
        for amount in self.wide.efforts_along(wanted):
            if isinstance(amount, Varying):
                law = self.problem.load_laws[amount.number]
                if law.expression is None:
                    raise NotRepeated(TABLE_LOADS)
                effort = law.expression.evaluate(self.quantity, self.units, exact_literal)
                total = total + exactly(effort.value)
            else:
                total = total + amount
        total[~self.wide.known] = np.nan
        return total


class ResponseRows(FreeRows):
    """The rows of a response in double-double.

    Args:
        result: the response.
        precise: the numbers of its session's text.
        fineness: of the steps.
    """

    result: ResponseResult

    def __init__(self, result: ResponseResult, precise: Precise, fineness: Fineness) -> None:
        self.fineness = fineness
        super().__init__(result, precise)

    @cached_property
    def rough(self) -> ResponseRows:
        """The same, repeated less finely."""
        return ResponseRows(self.result, self.precise, ROUGH)

    @cached_property
    def of_text(self) -> PreciseInputs:
        """The moments of the rows, nan for a stop's, which no text has; and the locked idle
        freedoms."""
        moments, count = self.precise.moments, self.result.rows
        in_si, written = np.full((2, 2, count), np.nan)
        for own, numbers in zip((in_si, written), moments, strict=True):
            own[:, : self._requested] = numbers[:, : self._requested]
        return self.of_moments(in_si, written)

    @cached_property
    def _requested(self) -> int:
        """How many rows are at moments of the text."""
        own, requested = self.result.problem.motion.time, self.result.response.moments.values
        assert own is not None
        count = min(own.values.size, requested.size)
        return int(np.count_nonzero(own.values[:count] == requested[:count]))

    @cached_property
    def _begun(self) -> Beginning:
        """How the motion begins in doubles."""
        chosen = self.result.chosen
        prepared = prepare(chosen.problem, self.result.response, session=chosen)
        if prepared.begun is None:
            raise NotRepeated("there is no first assembly")
        return prepared.begun

    @cached_property
    def march(self) -> tuple[list[LegendreStep], str]:
        """The motion up to the last row at a moment of the text: its steps, and why they end
        before it."""
        reached = self.result.row_states.reached[: self._requested]
        last = int(np.flatnonzero(reached)[-1]) if reached.any() else 0
        end, begin = self._times(np.array([last])), self._beginning()
        if last == 0:
            return [], ""
        layout = self.result.session.layout
        marching = Marching(self.motion, layout, self._turned_at, self.fineness)
        return marching.march(begin, orthonormal(self._begun.tangents[:, :, None]), end)

    def _times(self, rows: Any) -> DoubleDoubles:
        time = self.of_text.time
        assert time is not None
        return DoubleDoubles(time[0, rows], time[1, rows])

    def _beginning(self) -> MotionPlaces:
        """The first moment, at rest or with the rates of the start."""
        chosen, first, begun = self.result.chosen, self.first, self._begun
        state = self.result.start.state
        assert state is not None
        count = len(first.values)
        copies = np.zeros(count + 1, dtype=np.intp)
        unit = np.concatenate([np.zeros((count, 1)), np.eye(count)], axis=1)
        batch = chosen.run(
            RowInputs(first.reduced[:, :, copies], state[:, None][:, copies], unit),
            Ask(Demand.VELOCITY, derivatives=True),
            PreciseConstants(self.precise.constants(chosen)),
        )
        assert batch.first is not None
        if not (batch.good.all() or chosen.is_redundant):
            raise NotRepeated("the start does not close in double-double")
        states = as_number(batch.states)[:, :1].copy()
        for number, (edge, freedom) in enumerate(chosen.graph.inputs):
            place = chosen.layout.state(edge, freedom)
            states[place] = as_number(first.values)[number]
        moved = as_number(batch.first)[:, 1:]
        independent = set(self.result.response.independent)
        for one in self.result.response.start:
            if one.rate is not None and (one.joint, one.coordinate) not in independent:
                raise NotRepeated(OTHER_RATES)
        rates = as_number(first.rates)[:, 0]
        total = rates[0] * moved[:, 0]
        for k in range(1, count):
            total = total + rates[k] * moved[:, k]
        still = DoubleDoubles(np.zeros((begun.first.size, 1)))
        times = self._times(np.zeros(1, dtype=np.intp))
        return MotionPlaces(times, states, total[:, None], still, self._turned_at(times.high))

    def _turned_at(self, times: Floats) -> Floats:
        """Turns of cut joints at some moments in s, of no whole turns of the tree's angles."""
        closing, moments = self._closing_turns
        turns = np.zeros((self.result.row_states.turns.shape[0], times.size))
        if len(closing):
            nearest = np.searchsorted(moments, times).clip(1, moments.size - 1)
            nearest -= times - moments[nearest - 1] < moments[nearest] - times
            turns[: len(closing)] = closing[:, nearest]
        return turns

    @cached_property
    def _closing_turns(self) -> tuple[Floats, Floats]:
        """Turns of cut joints (slots, moments) of the run in doubles, at many moments."""
        result = self.result
        slots = result.row_states.turns.shape[0] - len(result.session.structure.tree_slots)
        assert result.report is not None
        begin, end = result.response.moments.values[0], result.report.time
        if not slots or not end > begin:
            return np.zeros((0, 0)), np.zeros(0)
        moments = np.linspace(begin, end, DENSE * result.report.steps + 2)
        (rows,) = integrate(
            [(result.session.plan, self._begun)],
            float(begin),
            moments,
            result.response,
            packing=result.session.packing,
        )
        return rows.turns[:slots, : rows.report.rows], moments[: rows.report.rows]

    @cached_property
    def _rows(self) -> tuple[MotionPlaces, DoubleDoubles, Bools]:
        """Rows on the motion, work put in and lost up to each (2, rows); and which are known."""
        result, (steps, _) = self.result, self.march
        count = result.rows
        known = np.zeros(count, dtype=np.bool_)
        turns, every = result.row_states.turns, self.unknown()
        work, times = DoubleDoubles(np.full((2, count), np.nan)), self._times(slice(None))

        def put(some: Any, places: MotionPlaces, own: DoubleDoubles) -> None:
            for part, new in zip(every[1:4], places[1:4], strict=True):
                part[:, some] = new
            every.time[some], work[:, some], known[some] = places.time, own, True

        rows = np.flatnonzero(result.row_states.reached[: self._requested])
        begin = self._beginning()
        before = DoubleDoubles(np.zeros((2, 1)))
        if rows.size and rows[0] == 0:
            put(rows[:1], begin, before)
        for step in steps:
            until = (step.begin.time + step.length).high[0]
            behind = times.high[rows] > step.begin.time.high[0]
            inside = rows[behind & (times.high[rows] <= until)]
            end = self._turned_at(np.array([until]))
            _, gained = step.at(step.begin.time + step.length, end)
            if inside.size:
                at = DoubleDoubles(times.high[inside], times.low[inside])
                places, own = step.at(at, np.ascontiguousarray(turns[:, inside]))
                put(inside, places, before + own)
            before = before + gained
        return self._settled(every, known), work, known

    def _settled(self, places: MotionPlaces, known: Bools) -> MotionPlaces:
        """The rows closed along their charts, with their true accelerations."""
        rows = np.flatnonzero(known)
        if not rows.size:
            return places
        closed, good = self.motion.settled(places.at(rows), self.charts[:, :, rows])
        for part, new in zip(places[1:4], closed[1:4], strict=True):
            part[:, rows] = new
        known[rows] = good
        return places

    @cached_property
    def places(self) -> tuple[MotionPlaces, Bools]:
        """The rows on the motion."""
        return self._rows[0], self._rows[2]

    @cached_property
    def exchanged(self) -> DoubleDoubles:
        """Work put in and lost up to each row (2, rows), J."""
        length = self.result.session.layout.length
        return self._rows[1] * (length * length)

    @property
    def lost_why(self) -> str:
        """Why rows are not repeated; "" where all are."""
        return self.march[1] or (STOP if self._requested < self.result.rows else "")


class RepeatedResponse(RepeatedFree):
    """As `Repeated`; with work, what is dissipated, and the response's efforts."""

    result: ResponseResult
    wide: ResponseRows

    @property
    def rough(self) -> RepeatedResponse:
        """The same, its motion repeated less finely."""
        return RepeatedResponse(self.result, self.wide.rough)

    @property
    def lost_why(self) -> str:
        """Why rows are not repeated."""
        return self.wide.lost_why

    def quantity(self, name: str) -> Quantity:
        """As `Repeated.quantity`."""
        own = response_quantities().get(name)
        if own is not None:
            reason = reason_of(self.problem, own)
            if reason:
                raise NotRepeated(reason)
            value: Any = self.wide.exchanged[0 if own.kind == "work" else 1]
            return Quantity(value, own.dimension)
        return super().quantity(name)

    def read(self, wanted: Iterable[Wanted]) -> None:
        """As `Repeated.read`, without what needs no run."""
        own = response_quantities()
        super().read(q for q in wanted if q.name not in own)
