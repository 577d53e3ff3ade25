"""Impacts at the limits of coordinates that have a restitution: the motion goes on from each.

The kernel ends a motion where a coordinate comes to its limit. With the reduced inertia M, the
rates u of the chart and the outward rate v = n.u of each coordinate that is at its limit, the
limits give impulses P along the coordinates alone, M (u+ - u-) = -sum n P, P >= 0, such that
v+ = -e v- (Newton's law of restitution). From there a new motion begins. Joints take what impulses
the loops ask for; their friction takes none.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.mechanism import ORDERS, CrossingEnd, Limit, eliminated, is_angle
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple
from mechkin_cli.response.integration import (
    Beginning,
    Impact,
    MotionEnd,
    MotionRows,
    Rebound,
)
from mechkin_cli.session import Ask, Chart
from mechkin_cli.units import FORCE, MOMENT, TIME

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.response.result import ResponseResult
    from mechkin_cli.session import RowInputs
    from mechkin_cli.show import Floats


class _Touch(NamedTuple):
    """A limit that is touched, and the side on which it ends its coordinate."""

    limit: Limit
    side: float


def touched_limit(response: ResponseProblem, moved: MotionRows) -> CrossingEnd | None:
    """The limit with a restitution that has ended a motion; None of any other end."""
    if moved.report.end is not MotionEnd.STOPPED:
        return None
    stop = response.stops[moved.report.stop]
    if not isinstance(stop, CrossingEnd) or stop.limit is None:
        return None
    return None if stop.limit.restitution is None else stop


def stopped_at_start(result: ResponseResult, moved: MotionRows) -> MotionRows:
    """A motion that begins at a limit and would go beyond it, as one that the limit ends at once;
    else the motion itself."""
    for number, stop in enumerate(result.response.stops):
        if not isinstance(stop, CrossingEnd) or stop.limit is None or stop.at is None:
            continue
        side = 1.0 if stop.direction == "up" else -1.0
        value, rate, pushed = (
            side * float(np.asarray(result.quantity(f"{stop.limit.name}{order}").value)[0])
            for order in ORDERS[:3]
        )
        unit = 1.0 if is_angle(stop.limit.coordinate) else result.session.layout.length
        still = tolerances.KINK_ROUNDING * unit
        outward = rate > still or (abs(rate) <= still and pushed > still)
        if abs(value - side * stop.at) > tolerances.AT_LIMIT * unit or not outward:
            continue

        def cut(array: NDArray[Any]) -> NDArray[Any]:
            found = np.array(array)
            found[..., 1] = found[..., 0]  # the stop's own place
            if found.dtype == np.float64:
                found[..., 2:] = np.nan
            return found

        report = moved.report._replace(
            end=MotionEnd.STOPPED,
            stop=number,
            rows=1,
            time=float(result.response.moments.values[0]),
            crossings=[],
            touches=[],
        )
        chart = Chart(*(cut(array) for array in moved.chart))
        states, turns, work = (cut(array) for array in (moved.states, moved.turns, moved.work))
        return MotionRows(report, states, chart, turns, work, cut(moved.flags))
    return moved


class ImpactAt:
    """The impact at the last row of a response that a limit has ended.

    Args:
        result: the rows up to it.
        stop: of the limit.
    """

    def __init__(self, result: ResponseResult, stop: CrossingEnd) -> None:
        assert stop.limit is not None
        self.result, self.session, self.stop = result, result.session, stop
        self.row, self.charts = result.rows - 1, len(result.chart.rates)
        self.first = _Touch(stop.limit, 1.0 if stop.direction == "up" else -1.0)
        self.touches = [self.first, *self._beside()]
        known = result.problem.quantities()
        self.rates_of = [known[f"{touch.limit.name}_dot"] for touch in self.touches]

    def rebound(self) -> Rebound | None:
        """How it goes on; None where a limit without restitution is touched, too, or the inertia is
        none."""
        n = self.charts
        before = self.result.chart.rates[:, self.row]
        pairs = [(i, j) for i in range(n) for j in range(i)]
        cases = np.zeros((n, 1 + n + len(pairs)))
        cases[:, 0] = before
        for column in range(n):
            cases[column, 1 + column] = 1.0
        for column, pair in enumerate(pairs, 1 + n):
            cases[list(pair), column] = 1.0
        energies, rates, _ = self._read(cases)
        inertia = [[0.0] * n for _ in range(n)]
        for i in range(n):
            inertia[i][i] = 2.0 * float(energies[1 + i])
        for (i, j), both in zip(pairs, energies[1 + n :], strict=True):
            inertia[i][j] = inertia[j][i] = float(both - energies[1 + i] - energies[1 + j])
        solved = self._pushes(inertia, rates)
        if solved is None:
            return None
        numbers, pushes, answers = solved
        after = before.copy()
        for push, answer in zip(pushes, answers, strict=True):
            after = after - push * np.array(answer)
        energy, outward, columns = self._read(after[:, None])
        # an impulse works by the mean of the rates before and after it
        lost = 0.0
        for number, push in zip(numbers, pushes, strict=True):
            lost += 0.5 * push * float(rates[number, 0] + outward[number, 0])
        work = float(energy[0] - energies[0]) + lost
        unit = self.session.layout.length * self.session.layout.length
        impact = Impact(
            self._time(),
            tuple(self.touches[number].limit for number in numbers),
            tuple(float(rates[number, 0]) for number in numbers),
            tuple(pushes),
        )
        direction = self.result.chart.direction[:, self.row]
        begun = Beginning(
            np.ascontiguousarray(self.result.row_states.states[:, self.row]),
            np.ascontiguousarray(columns[:, 0]),
            np.ascontiguousarray(direction.reshape(n, -1)),
        )
        if any(touch.limit.restitution is None for touch in self._pushing(numbers)):
            return None
        still = np.zeros((n, 1))
        rows = self._rows(still, (after - before)[:, None])
        none = None if rows.rates is None else np.zeros(rows.rates.shape)
        given: dict[tuple[str, str], float] = {}
        for number, push in zip(numbers, pushes, strict=True):
            touch = self.touches[number]
            at = touch.limit.joint, touch.limit.coordinate
            given[at] = given.get(at, 0.0) - touch.side * push
        return Rebound(
            impact,
            begun,
            (work / unit, lost / unit),
            rows._replace(rates=none, accelerations=none),
            given,
            self.stop.words,
        )

    @property
    def may_rest(self) -> bool:
        """Whether a rest is computed: of one freedom that nothing drives."""
        return self.charts == 1 and not self.result.response.driven

    def lever(self) -> float:
        """The outward rate of the coordinate per that of the start's coordinate."""
        ((joint, coordinate),) = self.result.response.independent
        known = self.result.problem.quantities()
        wanted = [known[f"{joint}.{coordinate}_dot"], self.rates_of[0]]
        readout = self.session.readout(wanted)
        batch = self.session.run(
            self._rows(np.ones((1, 1))), Ask(Demand.VELOCITY, readout, iterations=0)
        )
        assert batch.outputs is not None
        own, limited = (float(batch.outputs[readout.slots[one.name].start, 0]) for one in wanted)
        return self.first.side * limited / own if own != 0.0 else 0.0

    def rests(self, rates: Floats, accelerations: Floats) -> bool:
        """Whether the coordinate does not come off its limit by more than what is still at it, by
        the chart's rates and accelerations (charts,) behind the impact."""
        known = self.result.problem.quantities()
        names = [f"{self.first.limit.name}{order}" for order in ("_dot", "_ddot")]
        wanted = [known[name] for name in names]
        readout = self.session.readout(wanted)
        rows = self._rows(rates[:, None], accelerations[:, None])
        batch = self.session.run(
            rows, Ask(Demand.VELOCITY | Demand.ACCELERATION, readout, iterations=0)
        )
        assert batch.outputs is not None
        rate, pushed = (
            self.first.side * float(batch.outputs[readout.slots[one.name].start, 0])
            for one in wanted
        )
        unit = 1.0 if is_angle(self.first.limit.coordinate) else self.session.layout.length
        return pushed > 0.0 and rate * rate <= 2.0 * pushed * tolerances.AT_LIMIT * unit

    def _time(self) -> float:
        moments = self.result.problem.motion.time
        assert moments is not None
        return float(moments.values[self.row])

    def _pushing(self, numbers: Sequence[int]) -> list[_Touch]:
        return [self.touches[number] for number in numbers]

    def _beside(self) -> list[_Touch]:
        """Other limits that are touched."""
        found = []
        for stop in self.result.response.stops:
            if not isinstance(stop, CrossingEnd) or stop.limit is None or stop.at is None:
                continue
            touch = _Touch(stop.limit, 1.0 if stop.direction == "up" else -1.0)
            value = np.asarray(self.result.quantity(stop.limit.name).value)[self.row]
            unit = 1.0 if is_angle(stop.limit.coordinate) else self.session.layout.length
            near = touch.side * (float(value) - stop.at) >= -tolerances.AT_LIMIT * unit
            if near and touch != self.first:
                found.append(touch)
        return found

    def _rows(self, rates: Floats, accelerations: Floats | None = None) -> RowInputs:
        """The row with rates of the chart (charts, cases); drives move in the first case alone."""
        count = rates.shape[1]
        states, turns = self.result.row_states.states, self.result.row_states.turns
        rows = self.session.row_inputs(states, turns, self.session.inputs)
        rows = rows.at(np.full(count, self.row))
        moving = np.arange(count) == 0
        chart = self.result.chart
        none = np.zeros(rates.shape)
        return rows._replace(
            rates=None if rows.rates is None else np.where(moving, rows.rates, 0.0),
            chart=Chart(
                np.repeat(chart.direction[:, [self.row]], count, axis=1),
                rates,
                none if accelerations is None else accelerations,
                np.zeros((len(chart.friction), count)),
            ),
        )

    def _read(self, rates: Floats) -> tuple[Floats, Floats, Floats]:
        """Kinetic energies (cases,), outward rates (touches, cases) and rates of all columns."""
        energy = self.result.problem.quantities()["row.kinetic_energy"]
        readout = self.session.readout([energy, *self.rates_of])
        ask = Ask(Demand.VELOCITY, readout, derivatives=True, iterations=0)
        batch = self.session.run(self._rows(rates), ask)
        assert batch.outputs is not None
        assert batch.first is not None
        outward = [
            touch.side * batch.outputs[readout.slots[one.name].start]
            for touch, one in zip(self.touches, self.rates_of, strict=True)
        ]
        energies = batch.outputs[readout.slots[energy.name].start]
        return energies, np.array(outward), batch.first

    def _pushes(
        self, inertia: list[list[float]], rates: Floats
    ) -> tuple[list[int], list[float], list[list[float]]] | None:
        """Which limits push, their impulses, and what a unit impulse makes of the chart's rates."""
        n = self.charts
        normals = [[float(x) for x in row[1 : 1 + n]] for row in rates]
        answers = [eliminated(inertia, normal, tolerances.RANK_ROUNDING) for normal in normals]
        if any(answer is None for answer in answers):
            return None
        made = [answer for answer in answers if answer is not None]
        outward = [float(row[0]) for row in rates]
        active = [k for k, rate in enumerate(outward) if rate > 0.0]
        if not active:
            return [0], [0.0], made[:1]  # it stands there, and may rest
        tried: list[list[int]] = []
        while active and active not in tried:
            tried.append(active)
            matrix = [[_dot(normals[i], made[j]) for j in active] for i in active]
            right = []
            for k in active:
                bounce = self.touches[k].limit.restitution or 0.0
                right.append(outward[k] + (bounce * outward[k] if outward[k] > 0.0 else 0.0))
            pushes = eliminated(matrix, right, tolerances.RANK_ROUNDING)
            if pushes is None:
                return None
            pulling = [k for k, push in zip(active, pushes, strict=True) if push < 0.0]
            after = [
                rate - _dot(pushes, [_dot(normals[k], made[j]) for j in active])
                for k, rate in enumerate(outward)
            ]
            beyond = [k for k, rate in enumerate(after) if k not in active and rate > 0.0]
            if not pulling and not beyond:
                return active, pushes, [made[k] for k in active]
            active = sorted({*active, *beyond}.difference(pulling))
        return None


def _dot(one: Sequence[float], other: Sequence[float]) -> float:
    total = 0.0
    for a, b in zip(one, other, strict=True):
        total += a * b
    return total


def joined(before: MotionRows, later: MotionRows, work: tuple[float, float]) -> MotionRows:
    """A motion and the one that goes on from its last place, whose first row is that place, or
    already the next row; `work` is what the impact between them put in and lost."""
    own, more, last = before.report, later.report, before.count - 1
    rows = own.rows
    known = later.states.shape[-1] - (before.states.shape[-1] - rows)
    put = np.array(work)[:, None] + before.work[:, [last]]

    def both(first: NDArray[Any], second: NDArray[Any]) -> NDArray[Any]:
        found = np.array(first)
        found[..., rows:] = second[..., known:]
        return found

    offset = before.turns[:, [last]] - later.turns[:, [0]]
    report = more._replace(
        rows=rows + more.rows - known,
        energy=max(own.energy, more.energy),
        stiff=own.stiff or more.stiff,
        stiff_from=own.stiff_from if own.stiff else more.stiff_from,
        evaluations=own.evaluations + more.evaluations,
        steps=own.steps + more.steps,
        rejections=own.rejections + more.rejections,
        crossings=[*own.crossings, *more.crossings],
        touches=[*own.touches, *more.touches],
    )
    chart = Chart(*(both(a, b) for a, b in zip(before.chart, later.chart, strict=True)))
    return MotionRows(
        report,
        both(before.states, later.states),
        chart,
        both(before.turns, later.turns + offset),
        both(before.work, later.work + put),
        both(before.flags, later.flags),
    )


def impact_notes(
    result: ResponseResult, impacts: Sequence[Impact], *, ended: bool
) -> list[Diagnostic]:
    """How often each coordinate rebounds and with what impulse, and which comes to rest."""
    units, notes = result.units, []
    for limit in dict.fromkeys(limit for impact in impacts for limit in impact.limits):
        own = [impact for impact in impacts if limit in impact.limits]
        at = [units.text(impact.time, TIME) for impact in own]
        pushes = [impact.impulses[impact.limits.index(limit)] for impact in own]
        dimension = (MOMENT if is_angle(limit.coordinate) else FORCE) * TIME
        times = "once" if len(own) == 1 else f"{len(own)} times, first"
        text = f"{limit.name} comes to its limit {times} at {at[0]}"
        rests = impacts[-1].rests and impacts[-1].limits[0] == limit
        if len(impacts) == tolerances.MOST_IMPACTS and impacts[-1] in own:
            text += f"; the response ends with {tolerances.MOST_IMPACTS} impacts"
        if rests:
            text += f", and rests at it from {at[-1]} on"
            text += ": the response ends there" if ended else ""
        name = units.label(dimension)
        numbers = tuple(
            Number(f"impulse at {limit.name}", float(units.from_si(push, dimension)), name)
            for push in pushes[:MOST_TOLD]
        )
        measured = f"largest impulse {units.text(max(pushes), dimension)}"
        notes.append(
            Diagnostic(
                "rests" if rests else "rebounds",
                "note",
                text,
                limit.place,
                measured,
                numbers=numbers,
            )
        )
    return notes


MOST_TOLD = 16
"""Impulses that a message has as numbers."""
