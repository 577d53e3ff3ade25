"""The rows of a response in double-double: its motion repeated from the numbers of the text."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.errors.motion import (
    FINE,
    ROUGH,
    Fineness,
    ForcedMotion,
    March,
    Marching,
    MotionPlaces,
    orthonormal,
)
from mechkin_cli.errors.rows import (
    CROSSED,
    FRICTION,
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
from mechkin_cli.response import MotionStart, integrate, prepare, watched_stop
from mechkin_cli.session import Ask, Chart, PreciseConstants, PreciseInputs, RowInputs
from mechkin_cli.tape import DoubleDoubles, TraceLost, double_doubles, exactly

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.response import Beginning, ResponseResult
    from mechkin_cli.session import KernelInputs, Precise, Session
    from mechkin_cli.show import Bools, Floats


DENSE = 16
"""Moments to a step of the run in doubles at which the turns of closing joints are looked up: they
move by much less than half a turn in between."""


def response_rows(result: ResponseResult) -> ResponseRows:
    """What repeats the rows of a response.

    Raises:
        NotRepeated: why it cannot be.
    """
    if result.problem.mechanism.frictions:
        raise NotRepeated(FRICTION)
    if result.report is not None and result.report.crossings:
        raise NotRepeated(CROSSED)
    try:
        precise = result.chosen.precise
        return ResponseRows(result, precise, FINE)
    except (TraceLost, LookupError, ValueError) as lost:
        raise NotRepeated(str(lost)) from None


class ResponseRows(KernelRows):
    """The rows of a response in double-double, as `repeated.WideRun`.

    Args:
        result: the response.
        precise: the numbers of its session as the text says them.
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

    @property
    def given(self) -> PreciseInputs:
        """The moments of the rows, and what holds idle freedoms."""
        return self._given

    @cached_property
    def _given(self) -> PreciseInputs:
        result, moments = self.result, self.precise.moments
        assert moments is not None
        count = result.rows
        in_si, written = (self._with_stop(numbers) for numbers in moments)
        held = np.repeat(self._held[:, :, None], count, axis=2)
        still = np.zeros(held.shape)
        whole = np.zeros((len(held), count))
        return PreciseInputs(held, still, still, still, held, whole, in_si, None, {"time": written})

    def _with_stop(self, numbers: Floats) -> Floats:
        """Of as many rows as there are; nan for a stop's, whose moment no text says."""
        count = self.result.rows
        found = np.full((2, count), np.nan)
        found[:, : self._asked] = numbers[:, : self._asked]
        return found

    @cached_property
    def _asked(self) -> int:
        """How many rows are at moments that were asked for."""
        own, asked = self.result.problem.motion.time, self.result.response.moments.values
        assert own is not None
        count = min(own.values.size, asked.size)
        return int(np.count_nonzero(own.values[:count] == asked[:count]))

    @cached_property
    def _first(self) -> PreciseInputs:
        """The start's inputs, and behind them what holds idle freedoms."""
        return self.precise.inputs(self.result.chosen)

    @cached_property
    def _held(self) -> Floats:
        return np.ascontiguousarray(
            self._first.values[len(self.result.response.independent) :, :, 0]
        )

    @cached_property
    def _begun(self) -> Beginning:
        """How the motion begins in doubles."""
        prepared = prepare(
            self.result.chosen.problem, self.result.response, session=self.result.chosen
        )
        if prepared.begun is None:
            raise NotRepeated("there is no first assembly")
        return prepared.begun

    @cached_property
    def _motion(self) -> ForcedMotion:
        return ForcedMotion(self.result.session, self.precise, self._held)

    @cached_property
    def march(self) -> March:
        """The motion up to the last row that was asked for."""
        result, asked = self.result, self._asked
        reached = result.row_states.reached[:asked]
        last = int(np.flatnonzero(reached)[-1]) if reached.any() else 0
        end = self._times(np.array([last]))
        begin = self._beginning()
        if last == 0:
            return March([], float(end.high[0]), "")
        marching = Marching(self._motion, result.session.layout, self._turned_at, self.fineness)
        return marching.march(begin, orthonormal(self._begun.tangents[:, :, None]), end)

    def _times(self, rows: Any) -> DoubleDoubles:
        time = self.given.time
        assert time is not None
        return DoubleDoubles(time[0, rows], time[1, rows])

    def _beginning(self) -> MotionPlaces:
        """The first moment, at rest or with the rates of the start."""
        chosen, first, begun = self.result.chosen, self._first, self._begun
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
        rates = self._rates(as_number(first.rates)[:, 0])
        total = rates[0] * moved[:, 0]
        for k in range(1, count):
            total = total + rates[k] * moved[:, k]
        still = DoubleDoubles(np.zeros((begun.first.size, 1)))
        times = self._times(np.zeros(1, dtype=np.intp))
        return MotionPlaces(times, states, total[:, None], still, self._turned_at(times.high))

    def _rates(self, own: DoubleDoubles) -> DoubleDoubles:
        """The rates of the inputs, those of other coordinates solved for."""
        response = self.result.response
        independent = set(response.independent)
        others = [
            one
            for one in response.start
            if one.rate is not None and (one.joint, one.coordinate) not in independent
        ]
        if others:
            raise NotRepeated(OTHER_RATES)
        return own

    def _turned_at(self, times: Floats) -> Floats:
        """Turns of closing joints at some moments in s, of no whole turns of the tree's angles."""
        closing, moments = self._closing_turns
        found = np.zeros((self.result.row_states.turns.shape[0], times.size))
        if len(closing):
            nearest = np.searchsorted(moments, times).clip(1, moments.size - 1)
            nearest -= times - moments[nearest - 1] < moments[nearest] - times
            found[: len(closing)] = closing[:, nearest]
        return found

    @cached_property
    def _closing_turns(self) -> tuple[Floats, Floats]:
        """Turns of closing joints (slots, moments) of the run in doubles, at many moments."""
        result = self.result
        slots = result.row_states.turns.shape[0] - len(result.session.turn_slots.tree)
        assert result.report is not None
        begin, end = result.response.moments.values[0], result.report.time
        if not slots or not end > begin:
            return np.zeros((0, 0)), np.zeros(0)
        moments = np.linspace(begin, end, DENSE * result.report.steps + 2)
        start = MotionStart(result.session.plan, *self._begun)
        (rows,) = integrate(
            [start],
            float(begin),
            moments,
            stops=[watched_stop(stop) for stop in result.response.stops],
            tolerance=result.response.tolerance,
            fixed_step=result.response.fixed_step,
            packing=result.session.packing,
        )
        return rows.turns[:slots, : rows.report.rows], moments[: rows.report.rows]

    @cached_property
    def _rows(self) -> tuple[MotionPlaces, DoubleDoubles, Bools]:
        """Rows on the motion, work put in and lost up to each (2, rows); and which are known."""
        result, march = self.result, self.march
        count, plan = result.rows, result.session.plan
        known = np.zeros(count, dtype=np.bool_)

        def nothing(*shape: int) -> DoubleDoubles:
            return DoubleDoubles(np.full((*shape, count), np.nan))

        columns = (nothing(plan.columns), nothing(plan.columns))
        found_at = MotionPlaces(nothing(), nothing(plan.states), *columns, result.row_states.turns)
        work = nothing(2)
        times = self._times(slice(None))
        rows = np.flatnonzero(result.row_states.reached[: self._asked])
        begin = self._beginning()
        before = DoubleDoubles(np.zeros((2, 1)))
        if rows.size and rows[0] == 0:
            _put(found_at, work, rows[:1], begin, before)
            known[0] = True
        for step in march.steps:
            until = (step.begin.time + step.length).high[0]
            behind = times.high[rows] > step.begin.time.high[0]
            inside = rows[behind & (times.high[rows] <= until)]
            end = self._turned_at(np.array([until]))
            _, gained = step.at(step.begin.time + step.length, end)
            if inside.size:
                at = DoubleDoubles(times.high[inside], times.low[inside])
                found, own = step.at(at, np.ascontiguousarray(result.row_states.turns[:, inside]))
                _put(found_at, work, inside, found, before + own)
                known[inside] = True
            before = before + gained
        return self._settled(found_at, known), work, known

    def _settled(self, places: MotionPlaces, known: Bools) -> MotionPlaces:
        """The rows closed along their charts, with their true accelerations."""
        rows = np.flatnonzero(known)
        if not rows.size:
            return places
        closed, good = self._motion.settled(places.at(rows), self._charts[:, :, rows])
        for part, new in zip(places[1:4], closed[1:4], strict=True):
            part[:, rows] = new
        known[rows] = good
        return places

    @cached_property
    def _charts(self) -> Floats:
        """The run's chart about each row (freedoms, columns, rows)."""
        freedoms = self.result.session.plan.charts
        return self.result.chart.direction.reshape(freedoms, -1, self.result.rows)

    @cached_property
    def exchanged(self) -> DoubleDoubles:
        """Work put in and lost up to each row (2, rows), J."""
        length = self.result.session.layout.length
        return self._rows[1] * (length * length)

    @property
    def lost_why(self) -> str:
        """Why rows are not repeated; "" where all are."""
        if self.march.why:
            return self.march.why
        return STOP if self._asked < self.result.rows else ""

    def efforts_along(self, wanted: Wanted) -> list[Any]:
        """The response's efforts along the coordinate of a quantity, in SI."""
        response = self.precise.problem.response
        assert response is not None
        at = (wanted.owner, wanted.coordinate)
        given = [e.amount for e in response.efforts if (e.joint, e.coordinate) == at]
        constant = [amount for amount in given if not isinstance(amount, Varying)]
        numbers = iter(double_doubles(self.precise.tape(constant)))
        return [
            amount if isinstance(amount, Varying) else DoubleDoubles(*next(numbers))
            for amount in given
        ]

    @property
    def known(self) -> Bools:
        """Rows that are repeated (rows,)."""
        return self._rows[2]

    def _row_inputs(self, inputs: KernelInputs, session: Session) -> RowInputs:
        places = self._rows[0]
        if not session.plan.charts:
            raise NotRepeated("read as if the start's coordinates were driven")
        rates, seconds = (as_parts(self._motion.along(self._charts, part)) for part in places[2:4])
        nothing = np.zeros((0, self.result.rows))
        chart = Chart(self.result.chart.direction, rates, seconds, nothing)
        found = super()._row_inputs(inputs, session)
        return found._replace(guess=as_parts(places.states), chart=chart)


def _put(
    places: MotionPlaces, work: DoubleDoubles, rows: Any, found: MotionPlaces, own: DoubleDoubles
) -> None:
    for part, new in zip(places[1:4], found[1:4], strict=True):
        part[:, rows] = new
    places.time[rows] = found.time
    work[:, rows] = own


# A response in double-double: its rows on the motion that `response_rows` repeats.


def repeated_response(result: ResponseResult) -> RepeatedResponse:
    """A response in double-double.

    Raises:
        NotRepeated: why it is not repeated.
    """
    return RepeatedResponse(result, response_rows(result))


class RepeatedResponse(Repeated):
    """As `Repeated`; with work, what is dissipated, and the efforts that a response gives."""

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
        wanted = self.problem.quantities().get(name)
        if wanted is not None and self.result.is_given(wanted):
            return Quantity(self._given_effort(wanted), wanted.dimension)  # type: ignore[arg-type]
        return super().quantity(name)

    def read(self, wanted: Iterable[Wanted]) -> None:
        """As `Repeated.read`, without what needs no run."""
        own = response_quantities()
        super().read(q for q in wanted if q.name not in own and not self.result.is_given(q))

    def _given_effort(self, wanted: Wanted) -> DoubleDoubles:
        """The sum of the response's efforts along a coordinate, as its text says them."""
        total = DoubleDoubles(np.zeros(self.rows))
        for amount in self.wide.efforts_along(wanted):
            if isinstance(amount, Varying):
                law = self.problem.load_laws[amount.number]
                if law.expression is None:
                    raise NotRepeated(TABLE_LOADS)
                found = law.expression.evaluate(self.quantity, self.units, exact_literal)
                total = total + exactly(found.value)
            else:
                total = total + amount
        total[~self.wide.known] = np.nan
        return total
