"""Impacts at the limits of coordinates that have a restitution: the motion goes on from each.

The kernel ends a motion where a coordinate comes to its limit. With the reduced inertia M, the
rates u of the chart and the outward rate v = n.u of each coordinate that is at its limit, the
limits give impulses P along the coordinates alone, M (u+ - u-) = -sum n P, P >= 0, such that
v+ = -e v- (Newton's law of restitution). From there a new motion begins. Joints take what impulses
the loops ask for; their friction takes none.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from math import isfinite, nan, sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.mechanism import ORDERS, CrossingEnd, Limit, eliminated, is_angle
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.response.integration import Beginning, Impact, Rebound
from mechkin_cli.response.march import with_columns
from mechkin_cli.response.report import MotionEnd, MotionRows, under_way
from mechkin_cli.session import Ask, Chart
from mechkin_cli.units import FORCE, MOMENT, TIME

if TYPE_CHECKING:
    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.response.report import MotionReport
    from mechkin_cli.response.result import ResponseResult
    from mechkin_cli.session import RowInputs
    from mechkin_cli.show import Floats
    from mechkin_cli.units import UnitSystem


class _Touch(NamedTuple):
    """A limit that is touched, the side on which it ends its coordinate, and the number of its
    stop."""

    limit: Limit
    side: float
    stop: int


class Resting(NamedTuple):
    """Stops, by their numbers, of limits at which coordinates do not come off again: those that an
    impact has to `settle` first, and those that then are `held`; others `beside` them end the same
    freedoms, and may stand for one that is held."""

    settles: list[int]
    held: list[int]
    beside: dict[int, int]


def touched_limit(response: ResponseProblem, moved: MotionRows) -> int | None:
    """The number of the stop at a limit with a restitution that has ended a motion; None of any
    other end."""
    if moved.report.end is not MotionEnd.STOPPED:
        return None
    stop = response.stops[moved.report.stop]
    if not isinstance(stop, CrossingEnd) or stop.limit is None:
        return None
    return None if stop.limit.restitution is None else moved.report.stop


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

        first = moved.states[:, 0].tolist()
        report = under_way(0, 1, len(first))._replace(
            end=MotionEnd.STOPPED,
            stop=number,
            time=float(result.response.moments.part(slice(1)).values[0]),
            last=first,
        )
        # the stop's own place, too
        return replace(with_columns(moved, [0, 0]), report=report)
    return moved


class ImpactAt:
    """The impact at a row of a response that a limit has ended.

    Args:
        result: that row.
        number: of the limit's stop.
    """

    def __init__(self, result: ResponseResult, number: int) -> None:
        self.result, self.session = result, result.session
        self.words = result.response.stops[number].words
        self.charts = len(result.chart.rates)
        self.touches = sorted(self._touched(number), key=lambda touch: touch.stop != number)
        known = result.problem.quantities()
        self.rates_of = [known[f"{touch.limit.name}_dot"] for touch in self.touches]
        n = self.charts
        self.before = result.chart.rates[:, 0]
        pairs = [(i, j) for i in range(n) for j in range(i)]
        cases = np.zeros((n, 1 + n + len(pairs)))
        cases[:, 0] = self.before
        for column in range(n):
            cases[column, 1 + column] = 1.0
        for column, pair in enumerate(pairs, 1 + n):
            cases[list(pair), column] = 1.0
        energies, rates, columns = self._read(cases)
        inertia = [[0.0] * n for _ in range(n)]
        for i in range(n):
            inertia[i][i] = 2.0 * float(energies[1 + i])
        for (i, j), both in zip(pairs, energies[1 + n :], strict=True):
            inertia[i][j] = inertia[j][i] = float(both - energies[1 + i] - energies[1 + j])
        self.energy, self.outward = float(energies[0]), [float(row[0]) for row in rates]
        self.tangents = np.ascontiguousarray(columns[:, 1 : 1 + n].T)
        self.onward = self._begun(columns[:, 0])
        normals = [[float(x) for x in row[1 : 1 + n]] for row in rates]
        answers = [eliminated(inertia, normal, tolerances.RANK_ROUNDING) for normal in normals]
        # what a unit impulse makes of the chart's rates, and of the outward ones
        self.answers = [answer for answer in answers if answer is not None]
        self.is_moved = len(self.answers) == len(answers)
        self.matrix = [[_dot(one, made) for made in self.answers] for one in normals]

    def rebound(self, settling: Sequence[int] = ()) -> Rebound | None:
        """How it goes on, with nothing left of the rates at some stops; None where a limit without
        restitution is touched, too, or the inertia is none.

        What settles may be on its way back: one that another throws off by less than what is still
        at its limit.
        """
        if not self.is_moved or any(
            touch.limit.restitution is None and rate > still
            for touch, rate, still in zip(self.touches, self.outward, self._still, strict=True)
        ):
            return None
        right = [
            rate + (bounce * rate if rate > 0.0 else 0.0)
            for rate, bounce in zip(self.outward, self._bounces(settling), strict=True)
        ]
        always = [k for k, touch in enumerate(self.touches) if touch.stop in settling]
        solved = complementary(self.matrix, self.outward, right, always)
        if solved is None or (solved.others and self.session.problem.mechanism.frictions):
            return None
        numbers, pushes, _ = solved
        if not numbers:
            numbers, pushes = [0], [0.0]  # it stands there, and may rest
        after = self.before.copy()
        for number, push in zip(numbers, pushes, strict=True):
            after = after - push * np.array(self.answers[number])
        energy, outward, columns = self._read(after[:, None])
        # an impulse works by the mean of the rates before and after it
        lost = 0.0
        for number, push in zip(numbers, pushes, strict=True):
            lost += 0.5 * push * (self.outward[number] + float(outward[number, 0]))
        work = float(energy[0]) - self.energy + lost
        unit = self.session.layout.length * self.session.layout.length
        met = dict(zip(numbers, pushes, strict=True)) | dict.fromkeys(solved.shared, nan)
        impact = Impact(
            self.time,
            tuple(self.touches[number].limit for number in met),
            tuple(self.outward[number] for number in met),
            tuple(met.values()),
        )
        rows = self._rows(np.zeros((self.charts, 1)), (after - self.before)[:, None])
        none = None if rows.rates is None else np.zeros(rows.rates.shape)
        return Rebound(
            impact,
            self._begun(columns[:, 0]),
            (work / unit, lost / unit),
            rows._replace(rates=none, accelerations=none),
            self._given(dict(zip(numbers, pushes, strict=True))),
            self.words,
            [self._given(other) for other in solved.others],
        )

    def _given(self, pushes: Mapping[int, float]) -> dict[tuple[str, str], float]:
        """The impulses of touches by their numbers, along coordinates (joint, coordinate)."""
        given: dict[tuple[str, str], float] = {}
        for number, push in pushes.items():
            touch = self.touches[number]
            at = touch.limit.joint, touch.limit.coordinate
            given[at] = given.get(at, 0.0) - touch.side * push
        return given

    @property
    def time(self) -> float:
        """Its moment, s."""
        moments = self.result.problem.motion.time
        assert moments is not None
        return float(moments.values[0])

    @property
    def began_resting(self) -> bool:
        """Whether it is the first row of the response, and no coordinate comes to its limit."""
        return not self.result.row_states.span.first and all(
            rate <= still for rate, still in zip(self.outward, self._still, strict=True)
        )

    def resting(self, chart: Chart, left: Sequence[int]) -> Resting | None:
        """Which coordinates stay at their limits behind the impact; None where no forces of limits
        are found, or friction goes by some that are not unique.

        Those that are still there do where the limits' forces push: the outward accelerations
        without them, less what they take, are at most zero, and zero where one pushes. One that
        would come off by less than what is still at its limit settles first.

        Args:
            chart: of the free motion behind the impact, from its first row on.
            left: stops of limits that coordinates are just leaving.
        """
        rates, pushed = self._outward(chart)
        able = [
            k
            for k, touch in enumerate(self.touches)
            if touch.limit.restitution is not None and touch.stop not in left
        ]
        still = [k for k in able if abs(rates[k]) <= self._still[k]]
        if not self.is_moved:
            return None
        matrix = [[self.matrix[i][j] for j in still] for i in still]
        own = [pushed[k] for k in still]
        solved = complementary(matrix, own, own)
        if solved is None or (solved.others and self.session.problem.mechanism.frictions):
            return None
        held = [still[number] for number in solved.numbers]
        beside = {still[k]: still[own] for k, own in solved.replaced.items()}
        settles = []
        for k in able:
            row = [self.matrix[k][j] for j in held]
            coming = pushed[k] - _dot(row, solved.sizes)
            if k not in still and coming > 0.0:
                off = 2.0 * coming * tolerances.AT_LIMIT * self._units[k]
                if rates[k] * rates[k] <= off:
                    settles.append(self.touches[k].stop)
        if settles:
            settles += [self.touches[k].stop for k in (*held, *beside)]
        stops = [touch.stop for touch in self.touches]
        stand_ins = {stops[k]: stops[own] for k, own in beside.items()}
        return Resting(settles, [stops[k] for k in held], stand_ins)

    def limits(self, stops: Sequence[int]) -> tuple[Limit, ...]:
        """Those of some stops."""
        return tuple(touch.limit for touch in self.touches if touch.stop in stops)

    def ends_the_motion(self, met: int) -> list[Diagnostic]:
        """Why nothing goes on from here, where limits were `met` so often; nothing to say where one
        without restitution is touched."""
        limits = list(dict.fromkeys(touch.limit for touch in self.touches))
        if any(limit.restitution is None for limit in limits):
            return []
        at = self.result.units.text(self.time, TIME)
        names = " and ".join(limit.name for limit in limits)
        if met == tolerances.MOST_IMPACTS:
            text = f"the response ends at {at}, at a limit of {names}, with its {met} impacts"
            hint = "end it earlier, or let less of the rates be left by a smaller restitution"
        elif len(limits) > 1 and self.session.problem.mechanism.frictions:
            text = (
                f"the response ends at {at}, where {names} are at limits that end one freedom "
                "together: how these share what they give is not unique, and friction may go by it"
            )
            hint = "give one of them more room, or leave out what rubs"
        else:
            text = (
                f"the response ends at {at}, where no motion behind the limit of {names} is found"
            )
            hint = "give what moves there a mass, or end its drive at the limit"
        place = limits[0].place
        return [Diagnostic("impact-unresolved", "warning", text, place, hint=hint)]

    def _bounces(self, settling: Sequence[int]) -> list[float]:
        return [
            0.0 if touch.stop in settling else touch.limit.restitution or 0.0
            for touch in self.touches
        ]

    @property
    def _units(self) -> list[float]:
        length = self.session.layout.length
        return [1.0 if is_angle(one.limit.coordinate) else length for one in self.touches]

    @property
    def _still(self) -> list[float]:
        """Outward rates that are rounding of zero."""
        parts = [abs(rate) / unit for rate, unit in zip(self.outward, self._units, strict=True)]
        return [tolerances.KINK_ROUNDING * unit * max(1.0, *parts) for unit in self._units]

    def _touched(self, number: int) -> Iterator[_Touch]:
        """The limits that are touched, that of a stop among them."""
        for k, stop in enumerate(self.result.response.stops):
            if not isinstance(stop, CrossingEnd) or stop.limit is None or stop.at is None:
                continue
            side = 1.0 if stop.direction == "up" else -1.0
            value = np.asarray(self.result.quantity(stop.limit.name).value)[0]
            unit = 1.0 if is_angle(stop.limit.coordinate) else self.session.layout.length
            if k == number or side * (float(value) - stop.at) >= -tolerances.AT_LIMIT * unit:
                yield _Touch(stop.limit, side, k)

    def _begun(self, columns: Floats) -> Beginning:
        """How a motion begins here, by the rates of all columns."""
        return Beginning(
            np.ascontiguousarray(self.result.row_states.states[:, 0]),
            np.ascontiguousarray(columns),
            self.tangents,
        )

    def _rows(self, rates: Floats, accelerations: Floats | None = None) -> RowInputs:
        """The row with rates of the chart (charts, cases); drives move in the first case alone."""
        count = rates.shape[1]
        states, turns = self.result.row_states.states, self.result.row_states.turns
        rows = self.session.row_inputs(states, turns, self.session.inputs)
        rows = rows.at(np.zeros(count, dtype=np.intp))
        moving = np.arange(count) == 0
        chart = self.result.chart
        none = np.zeros(rates.shape)
        return rows._replace(
            rates=None if rows.rates is None else np.where(moving, rows.rates, 0.0),
            chart=Chart(
                np.repeat(chart.direction, count, axis=1),
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

    def _outward(self, chart: Chart) -> tuple[list[float], list[float]]:
        """Outward rates and accelerations of all touches in the first row of a chart."""
        known = self.result.problem.quantities()
        names = [one.limit.name for one in self.touches]
        wanted = [known[f"{name}{order}"] for order in ORDERS[1:3] for name in names]
        readout = self.session.readout(list(dict.fromkeys(wanted)))
        rows = self._rows(chart.rates[:, :1])._replace(chart=chart.at([0]))
        batch = self.session.run(
            rows, Ask(Demand.VELOCITY | Demand.ACCELERATION, readout, iterations=0)
        )
        assert batch.outputs is not None
        found = [
            touch.side * float(batch.outputs[readout.slots[one.name].start, 0])
            for touch, one in zip([*self.touches, *self.touches], wanted, strict=True)
        ]
        return found[: len(names)], found[len(names) :]


class Pushes(NamedTuple):
    """Which limits push, by their numbers, and how; and each other one that might push in their
    place, since it ends a freedom that they end, with all pushes that then are as good."""

    numbers: list[int]
    sizes: list[float]
    others: list[dict[int, float]]

    @property
    def shared(self) -> set[int]:
        """Those whose pushes are not unique."""
        own = dict(zip(self.numbers, self.sizes, strict=True))
        return {k for other in self.others for k in other if other[k] != own.get(k)}

    @property
    def replaced(self) -> dict[int, int]:
        """Each that might push in place of others, and the one whose push it takes most of."""
        own = dict(zip(self.numbers, self.sizes, strict=True))
        return {
            next(k for k in other if k not in own): max(own, key=lambda k: abs(own[k] - other[k]))
            for other in self.others
        }


def complementary(
    matrix: Sequence[Sequence[float]],
    outward: Sequence[float],
    right: Sequence[float],
    always: Sequence[int] = (),
) -> Pushes | None:
    """Which limits push, and how: those that coordinates would go beyond by `outward`, such that
    the `matrix` takes away `right` of it where one pushes, and none is left where none does; None
    where no choice is found. Some `always` act, whichever way.

    Limits that end one freedom together share what it takes, in whatever parts: as many push as are
    independent.
    """
    rounding = tolerances.KINK_ROUNDING * max((abs(one) for one in outward), default=0.0)
    active = [k for k, one in enumerate(outward) if one > 0.0 or k in always]
    tried: list[list[int]] = []
    while active not in tried:
        tried.append(active)
        sizes = _pushed(matrix, active, [right[k] for k in active])
        if sizes is None:
            break
        pulling = [
            k for k, push in zip(active, sizes, strict=True) if push < 0.0 and k not in always
        ]
        beyond = [
            k
            for k, one in enumerate(outward)
            if k not in active and one - _dot([matrix[k][j] for j in active], sizes) > rounding
        ]
        if not pulling and not beyond:
            return Pushes(active, sizes, _others(matrix, right, active, sizes, rounding))
        active = sorted({*active, *beyond}.difference(pulling))
    if len(outward) > MOST_TOGETHER:
        return None
    for count in range(len(outward) + 1):
        for chosen in map(list, combinations(range(len(outward)), count)):
            sizes = _pushed(matrix, chosen, [right[k] for k in chosen])
            if sizes is None or any(
                push < 0.0 and k not in always for k, push in zip(chosen, sizes, strict=True)
            ):
                continue
            left = [
                one - _dot([row[j] for j in chosen], sizes)
                for one, row in zip(right, matrix, strict=True)
            ]
            if all(
                k in chosen or (abs(one) if k in always else one) <= rounding
                for k, one in enumerate(left)
            ):
                return Pushes(chosen, sizes, _others(matrix, right, chosen, sizes, rounding))
    return None


MOST_TOGETHER = 10
"""Limits touched at once of which all sets are tried, where some end one freedom together."""


def _pushed(
    matrix: Sequence[Sequence[float]], active: Sequence[int], right: Sequence[float]
) -> list[float] | None:
    """How some limits push that take away all of `right`; None where they are not independent."""
    own = [matrix[k][k] for k in active]
    if not all(size > 0.0 for size in own):
        return None
    roots = [sqrt(size) for size in own]
    inner = [[matrix[i][j] for j in active] for i in active]
    scaled = [
        [x / (a * b) for x, b in zip(row, roots, strict=True)]
        for row, a in zip(inner, roots, strict=True)
    ]
    if eliminated(scaled, right, tolerances.ONE_FREEDOM) is None:
        return None
    return eliminated(inner, right, tolerances.RANK_ROUNDING)


def _others(
    matrix: Sequence[Sequence[float]],
    right: Sequence[float],
    active: Sequence[int],
    sizes: Sequence[float],
    rounding: float,
) -> list[dict[int, float]]:
    """Other pushes with the same effect, of which each lets one limit more push, half as much as it
    may."""
    found = []
    for k, row in enumerate(matrix):
        left = right[k] - _dot([row[j] for j in active], sizes)
        if k in active or abs(left) > rounding or not any(sizes):
            continue
        own = [matrix[j][k] for j in active]
        per = _pushed(matrix, active, own)
        if per is None or abs(row[k] - _dot(own, per)) > tolerances.ONE_FREEDOM * row[k]:
            continue  # it would move what they do not
        # of those that move what it moves; what is smaller is rounding
        least = tolerances.ONE_FREEDOM * sqrt(row[k])
        per = [
            part if abs(part) * sqrt(matrix[j][j]) > least else 0.0
            for j, part in zip(active, per, strict=True)
        ]
        most = [size / part for size, part in zip(sizes, per, strict=True) if part > 0.0]
        amount = 0.5 * min(most, default=max(sizes))
        if amount > 0.0:
            shares = [size - amount * part for size, part in zip(sizes, per, strict=True)]
            found.append({**dict(zip(active, shares, strict=True)), k: amount})
    return found


def _dot(one: Sequence[float], other: Sequence[float]) -> float:
    total = 0.0
    for a, b in zip(one, other, strict=True):
        total += a * b
    return total


def gone_on(before: MotionReport, later: MotionReport) -> MotionReport:
    """The report of a motion with that of the one that goes on from its last place."""
    return later._replace(
        energy=max(before.energy, later.energy),
        stiff=before.stiff or later.stiff,
        stiff_from=before.stiff_from if before.stiff else later.stiff_from,
        evaluations=before.evaluations + later.evaluations,
        steps=before.steps + later.steps,
        rejections=before.rejections + later.rejections,
        crossings=[*before.crossings, *later.crossings],
        touches=[*before.touches, *later.touches],
    )


def impact_notes(
    units: UnitSystem, impacts: Sequence[Impact], at_last: Sequence[Limit]
) -> list[Diagnostic]:
    """How often each coordinate rebounds and with what impulse, and which comes to rest, those
    `at_last` for good."""
    notes = []
    for limit in dict.fromkeys(limit for impact in impacts for limit in impact.limits):
        own = [impact for impact in impacts if limit in impact.limits]
        pushes = [impact.impulses[impact.limits.index(limit)] for impact in own]
        known = [push for push in pushes if isfinite(push)]
        dimension = (MOMENT if is_angle(limit.coordinate) else FORCE) * TIME
        text = _told(units, limit, own, stays=limit in at_last)
        rests = any(limit in impact.held for impact in own)
        name = units.label(dimension)
        numbers = tuple(
            Number(f"impulse at {limit.name}", float(units.from_si(push, dimension)), name)
            for push in known[:MOST_TOLD]
        )
        largest = max(known, default=0.0)
        measured = f"largest impulse {units.text(largest, dimension)}" if largest else None
        if len(known) < len(pushes):
            text += "; another limit ends the same freedom, and how they share it is not unique"
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


def _told(units: UnitSystem, limit: Limit, own: Sequence[Impact], *, stays: bool) -> str:
    """What a coordinate does at its limit, by the impacts in which this pushes: it need not come in
    each, where it rests while another one strikes."""
    came = [impact for impact in own if impact.comes(limit)]
    since = came[-1].time if came else own[0].time
    at_rest = [impact.time for impact in own if limit in impact.held]
    rests = [time for time in at_rest if time >= since] or at_rest or [since]
    begun = units.text(rests[0], TIME)
    if not came:
        if not at_rest:
            return f"{limit.name} is at its limit when another one is struck, at {begun}"
        return f"{limit.name} rests at its limit from {begun} on" + (
            "" if stays else ", and leaves it later"
        )
    times = "once" if len(came) == 1 else f"{len(came)} times, first"
    text = f"{limit.name} comes to its limit {times} at {units.text(came[0].time, TIME)}"
    if stays:
        return f"{text}, and rests at it from {begun} on"
    return f"{text}, rests at it, and leaves it again" if at_rest else text


MOST_TOLD = 16
"""Impulses that a message has as numbers."""
