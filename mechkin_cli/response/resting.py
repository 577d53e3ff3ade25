"""Rest at limits: coordinates that loads push to their limits stand there, held by the limits'
forces, until one of these would have to pull; what else is free moves on.

Such a motion is integrated on the same tree with the coordinates at rest as inputs, so its states
are those of the free motion. The force of a limit is what a drive would have to give that holds the
coordinate; it is told as effort there, and acts on rows as a load over time.
"""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import (
    CrossingEnd,
    JointLoad,
    LoadLaw,
    Moments,
    Varying,
    effort_quantity,
    is_angle,
    joined_curve,
)
from mechkin_cli.plan import FrictionTold, demand_of
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.response.integration import (
    Beginning,
    driven_laws,
    formula_ends,
    integrate,
    watched_stop,
)
from mechkin_cli.response.march import (
    RowTimes,
    beginning_of,
    first_row,
    marched,
    taken,
    with_columns,
)
from mechkin_cli.response.report import MotionEnd, MotionRows
from mechkin_cli.session import Ask, Chart, KernelInputs
from mechkin_cli.structure import holding

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from mechkin_cli.kernel._kernel import DrivenLaws
    from mechkin_cli.mechanism import Limit, ResponseProblem, SpacedMoments
    from mechkin_cli.response.integration import WatchedStop
    from mechkin_cli.response.march import Taker
    from mechkin_cli.session import Packing, Session
    from mechkin_cli.show import Floats


class Contact(NamedTuple):
    """A rest at a limit: its force along the coordinate (N*m, N) at the moments of rows (s), and
    forces that are as good, where several limits end one freedom."""

    limit: Limit
    times: Floats
    forces: Floats
    others: tuple[Floats, ...] = ()

    def as_other(self, number: int | None) -> Floats:
        """The forces of a number that are as good; its own without so many."""
        if number is None or number >= len(self.others):
            return self.forces
        return self.others[number]


class _Held(NamedTuple):
    """Limits, the session in which their coordinates are inputs, and the laws of its inputs."""

    limits: list[Limit]
    session: Session
    laws: DrivenLaws | None


def _held_at(
    free: Session, response: ResponseProblem, begun: Beginning, stops: Sequence[int]
) -> _Held:
    """The free session with the coordinates of some stops at rest where a motion begins."""
    limits = [
        end.limit
        for end in (response.stops[k] for k in stops)
        if isinstance(end, CrossingEnd) and end.limit is not None
    ]
    places = [_place(free, limit) for limit in limits]
    names = [(limit.joint, limit.coordinate) for limit in limits]
    session = free.exchanged(holding(free.graph, len(response.driven), places, names))
    at = [float(begun.state[free.layout.state(*place)]) for place in places]
    return _Held(limits, session, driven_laws(session, response, at))


def _place(free: Session, limit: Limit) -> tuple[int, int]:
    """The edge and the freedom of a limited coordinate."""
    layout = free.layout
    joint = layout.mechanism.joints[limit.joint]
    return layout.edge_number[limit.joint], joint.freedom_number(limit.coordinate)


class _Leaves(NamedTuple):
    """The moment (s) from which on a limit would pull, and the number of its stop."""

    time: float
    stop: int


class _Look:
    """Looks for the first moment at which a limit pulls, window by window.

    Args:
        pushes: how the limits push (limits, 1) where the motion begins, at the moment `begin` (s).
    """

    def __init__(self, pushes: Floats, begin: float) -> None:
        self._begun, self._last = pushes, begin
        self._most = np.zeros(len(pushes))
        self.found: tuple[float | None, float, int] | None = None

    def over(self, pushes: Floats, times: Floats) -> bool:
        """Adds moments and how limits push there (limits, moments): whether none pulls. Where one
        does, `found` has the moment before it, None where the motion begins with it, its own, and
        the limit's number. What is rounding goes by the largest force up to the window's end."""
        pushes = np.concatenate([self._begun, pushes], axis=1)
        times = np.concatenate([[self._last], times])
        self._most = np.fmax(self._most, np.nanmax(np.abs(pushes), axis=1, initial=0.0))
        least = tolerances.KINK_ROUNDING * self._most
        pulling = np.flatnonzero((pushes < -least[:, None]).any(axis=0))
        self._begun, self._last = pushes[:, -1:], float(times[-1])
        if not pulling.size:
            return True
        k = int(pulling[0])  # 0 in the first window alone: the others begin with what did not pull
        before = float(times[k - 1]) if k else None
        self.found = before, float(times[k]), int(np.argmin(pushes[:, k]))
        return False


class RestingMotion:
    """A motion with some coordinates at rest at their limits.

    Args:
        free: the session of the free motion.
        response: the file's.
        stops: the limits at which they rest, by the numbers of the response's stops.
        beside: other limits that end the same freedoms, whose coordinates rest with those, and the
            one of `stops` that each may stand for.
        begin: the moment at which it begins, s.
        begun: how it begins there, at their limits and along them.
        friction: what the free motion tells of frictions there (numbers,).
        packing: how rows are packed.
    """

    def __init__(
        self,
        free: Session,
        response: ResponseProblem,
        stops: Sequence[int],
        beside: Mapping[int, int],
        begin: float,
        begun: Beginning,
        friction: Floats,
        packing: Packing,
    ) -> None:
        self.free, self.response, self.packing = free, response, packing
        self.stops, self.beside, self.as_free = list(stops), dict(beside), friction
        self.begin, self._ends = begin, formula_ends(response, free.problem.units)
        self.held = _held_at(free, response, begun, self.stops)
        self.others = [
            _held_at(free, response, begun, [one if k == own else k for k in self.stops])
            for one, own in self.beside.items()
        ]
        ends = [response.stops[k] for k in self.stops]
        self.sides = [1.0 if getattr(end, "direction", "") == "up" else -1.0 for end in ends]
        self.columns = [free.layout.column(*_place(free, limit)) for limit in self.held.limits]
        first = begun.first.copy()
        first[self.columns] = 0.0
        self.begun = Beginning(begun.state, first, along(begun.tangents, self.columns))

    def onward(
        self, moments: Moments | SpacedMoments, first: int, start: MotionRows, block: int
    ) -> Iterator[tuple[MotionRows, list[Contact]]]:
        """The motion over the rows of a response from number `first` on, as one of the free
        coordinates and in blocks; up to where a limit would have to pull, which then is its stop.
        And the forces of the limits at the rows: at that of the stop as it comes there."""
        begin, at = self.begin, self._leaves(moments, first, start)
        every = RowTimes(moments, first, moments.rows - first)
        times = every if at is None else _until(every, at.time, begin)
        if not times.size:
            assert at is not None
            moved = self._moved(np.array([begin]))
            yield self._as_free(_left(moved, 0, at.time, at.stop)), []
            return

        def run(block: int, taker: Taker | None) -> MotionRows:
            return self._moved(times, block, taker)

        for moved in marched(run, times.size, block):
            report = moved.report
            rows = min(times.rows, report.rows) - report.first
            own = times.between(report.first, report.first + rows, begin)
            before = own.copy()
            if at is not None and at.time > begin:
                before[own == at.time] = np.nextafter(at.time, begin)
            contacts = self._contacts(own, self._forces(moved, before))
            if report.end is MotionEnd.STOPPED and at is None:
                last, place = np.array([report.time]), [report.rows - report.first]
                contacts += self._contacts(last, self._forces(moved, last, place))
            if at is not None and report.is_over and report.rows == times.size:
                moved = _left(moved, times.rows, at.time, at.stop)
            yield self._as_free(moved), contacts

    def _contacts(self, times: Floats, forces: Sequence[Floats]) -> list[Contact]:
        """The rests at all limits, by forces of the limits that push and of each that others may
        stand for."""
        if not times.size:
            return []
        limits = list(
            dict.fromkeys(each for one in (self.held, *self.others) for each in one.limits)
        )
        none = np.zeros(times.size)
        told = [
            dict(zip(one.limits, each, strict=True))
            for one, each in zip((self.held, *self.others), forces, strict=True)
        ]
        return [
            Contact(
                limit,
                times,
                told[0].get(limit, none),
                tuple(each.get(limit, none) for each in told[1:]),
            )
            for limit in limits
        ]

    def start(self, moments: Moments | SpacedMoments) -> MotionRows:
        """The row in which the motion begins."""
        times = beginning_of(self.begin, moments)
        return first_row(lambda block, taker: self._moved(times, block, taker))

    def _moved(
        self, times: Floats | RowTimes, block: int = 0, taker: Taker | None = None
    ) -> MotionRows:
        """The motion over some moments."""
        (moved,) = integrate(
            [(self.held.session.plan, self.begun)],
            self.begin,
            times,
            self.response,
            stops=[self._watched(number) for number in range(len(self.response.stops))],
            driven=self.held.laws,
            packing=self.packing,
            block=block,
            taker=taker,
        )
        return moved

    def _watched(self, number: int) -> WatchedStop:
        """A stop; that of a limit at which a coordinate rests is out of reach, of one beside it as
        far beyond as is still at the limit."""
        kind, direction, count, at, lengths, rates = watched_stop(self.response.stops[number])
        length, beyond = self.free.layout.length, 0.0
        if number in self.stops:
            beyond = FAR * max(1.0, abs(at), length)
        elif number in self.beside:
            beyond = tolerances.AT_LIMIT * (length if lengths else 1.0)
        return kind, direction, count, at + direction * beyond, lengths, rates

    def _forces(
        self, moved: MotionRows, times: Floats, places: Sequence[int] | None = None
    ) -> list[Floats]:
        """The forces of the limits along their coordinates at rows of a motion (limits, rows); then
        those of each set of others that may push instead."""
        return [self._efforts(one, moved, times, places) for one in (self.held, *self.others)]

    def _efforts(
        self, held: _Held, moved: MotionRows, times: Floats, places: Sequence[int] | None
    ) -> Floats:
        """What holds the coordinates of some limits (limits, rows)."""
        wanted = [effort_quantity(one.joint, one.coordinate) for one in held.limits]
        session, laws, problem = held.session, held.laws, held.session.problem
        rows = np.arange(times.size) if places is None else np.array(places)
        reached = np.isfinite(moved.states[:, rows]).all(axis=0)
        rows, found = rows[reached], np.full((len(wanted), times.size), np.nan)
        if not rows.size:
            return found
        orders = np.zeros((3, len(session.graph.inputs), rows.size))
        if laws is not None:
            orders = self._orders(laws, times[reached])
        inputs = KernelInputs.of(
            problem, orders[0], orders[1], orders[2], np.zeros(orders[0].shape)
        )
        tree = np.zeros((len(session.structure.tree_slots), rows.size))
        turned = np.concatenate([moved.turns[:, rows], tree])
        given = inputs.at(moved.states[:, rows], turned, times[reached])
        readout = session.readout(wanted)
        ask = Ask(demand_of(problem.mechanism, wanted), readout, iterations=0)
        chart = moved.chart.at(rows)
        chart = chart._replace(friction=self._friction(chart.friction))
        batch = session.run(given._replace(chart=chart), ask)
        assert batch.outputs is not None
        for own, quantity in zip(found, wanted, strict=True):
            own[reached] = batch.outputs[readout.slots[quantity.name].start]
        return found

    def _orders(self, laws: DrivenLaws, times: Floats) -> Floats:
        """Values, rates and accelerations of the inputs at some moments (3, inputs, moments): where
        a piece of a law ends the accelerations that the motion comes with, as its rows have."""
        orders = laws.over(np.ascontiguousarray(times))
        for k in np.flatnonzero(np.isin(times, self._ends) & (times > self.begin)):
            before = laws.at(float(np.nextafter(times[k], self.begin)))
            orders[2, :, k] = [second for _, _, second in before]
        return orders

    def _pushes(self, moved: MotionRows, times: Floats) -> Floats:
        """How the limits push at the rows of a motion (limits, rows); nan beyond its end."""
        forces = self._efforts(self.held, moved, times, None)
        return np.array([-side * one for side, one in zip(self.sides, forces, strict=True)])

    def _leaves(
        self, moments: Moments | SpacedMoments, first: int, start: MotionRows
    ) -> _Leaves | None:
        """Where a limit would pull first; None where none does up to the last row."""
        begin = self.begin
        look = _Look(self._pushes(start, np.array([begin])), begin)
        rows, parts = moments.rows - first, _parts(moments)
        times = RowTimes(moments, first, rows, parts)
        near = parts * tolerances.SAME_MOMENT * abs(times.row(0))
        if times.row(0) - begin <= near:
            times = RowTimes(moments, first + 1, rows - 1, parts)

        def look_at(moved: MotionRows) -> bool:
            report = moved.report
            sampled = times.between(report.first, report.rows, begin)
            if report.end is MotionEnd.STOPPED:
                sampled = np.append(sampled, report.time)
            own = with_columns(moved, slice(sampled.size))
            return look.over(self._pushes(own, sampled), sampled)

        if times.size:

            def take(first: int, rows: int, arrays: list[NDArray[Any]]) -> bool:
                return look_at(taken(first, rows, arrays))

            last = self._moved(times, WINDOW, take)
            if look.found is None:
                look_at(last)
        else:
            look.over(np.zeros((len(self.sides), 0)), np.array([]))
        if look.found is None:
            return None
        low, high, which = look.found
        if low is None:
            return _Leaves(begin, self.stops[which])
        while True:
            inner = np.unique(low + (high - low) * np.linspace(0.0, 1.0, SAMPLES + 1))
            if inner.size < 3:
                return _Leaves(high, self.stops[which])
            lead = np.array([begin] if inner[0] > begin else [])
            sampled = np.concatenate([lead, inner])
            found = self._pushes(self._moved(sampled), sampled)[:, lead.size :]
            pulls = np.flatnonzero((found < 0.0).any(axis=0))
            k = int(pulls[0]) if pulls.size else inner.size - 1
            which = int(np.argmin(found[:, k])) if pulls.size else which
            if k == 0 or (float(inner[k - 1]), float(inner[k])) == (low, high):
                return _Leaves(low if k == 0 else high, self.stops[which])
            low, high = float(inner[k - 1]), float(inner[k])

    def _friction(self, told: Floats) -> Floats:
        """What a motion tells of its frictions (numbers, rows), with no force where coordinates at
        rest alone would rub: limits bear all that presses on these. How they would share that with
        friction is not unique."""
        found = told.copy()
        for first in range(0, len(told), 1 + WRENCH):
            if self.as_free[first] != FrictionTold.IMMOBILE:
                still = told[first] == FrictionTold.IMMOBILE
                found[first, still] = FrictionTold.FORCE
                found[first + 1 : first + 1 + WRENCH, still] = 0.0
        return found

    def _as_free(self, moved: MotionRows) -> MotionRows:
        """The rows as those of the free motion: its chart has the coordinates at rest, too."""
        chart, width = moved.chart, moved.states.shape[1]
        none = np.zeros((len(self.columns), width))
        resting = np.zeros((len(self.columns), self.begun.tangents.shape[1], width))
        for number, (column, limit) in enumerate(zip(self.columns, self.held.limits, strict=True)):
            # in parts of the mechanism's size, as the other coordinates of the chart
            resting[number, column] = (
                1.0 if is_angle(limit.coordinate) else 1.0 / self.free.plan.size
            )
        direction = np.concatenate([chart.direction, resting.reshape(-1, width)])
        rates = np.concatenate([chart.rates, none])
        accelerations = np.concatenate([chart.accelerations, none])
        friction = self._friction(chart.friction)
        return replace(moved, chart=Chart(direction, rates, accelerations, friction))


WRENCH = 6
"""Numbers of a moment and a force."""

FAR = 1e3
"""How far the stop of a limit is put away while its coordinate rests, in parts of the mechanism's
size or of a radian: rounding never meets it."""


def _parts(moments: Moments | SpacedMoments) -> int:
    """Parts of each way from row to row at whose ends the forces of limits are looked at: whether a
    limit pulls between two rows must not go by how far these are apart."""
    ways = moments.rows - 1
    longest = moments.duration / ways
    if isinstance(moments, Moments):
        longest = float(np.max(np.diff(moments.values)))
    least = max(SAMPLES, ceil(LEAST_PLACES * longest / moments.duration))
    return max(1, min(least, SAMPLES * tolerances.LONG_RUN // ways))


LEAST_PLACES = 4096
"""Places of a response, however few its rows are, at which the forces of limits are looked at; a
force that changes its sign twice between two of them is not seen to."""

SAMPLES = 16
"""Parts of a step from row to row, and of each bracket, at which forces are looked at; fewer of the
steps of a long run, at a million places in all and at each row."""

WINDOW = 256
"""Moments at which forces are looked at before more are asked for: a rest is short where a limit
soon pulls, and each may be a step."""


def along(tangents: Floats, columns: Sequence[int]) -> Floats:
    """The basis of free rates (freedoms, columns) with some columns at rest: as many rows less, of
    which each takes from the others what moves its column (elimination, the largest entry as
    pivot).

    Args:
        tangents: a basis of free rates (freedoms, columns).
        columns: to be left at rest, independent of one another.
    """
    left = [row.copy() for row in tangents]
    for column in columns:
        most = max(range(len(left)), key=lambda k: abs(float(left[k][column])))
        pivot = left.pop(most)
        for row in left:
            row -= row[column] / pivot[column] * pivot
            row[column] = 0.0
    return np.array(left).reshape(len(left), tangents.shape[1])


def _until(times: RowTimes, at: float, begin: float) -> RowTimes:
    """Those up to a moment, which is the last one."""
    low, high = 0, times.rows
    while low < high:
        middle = (low + high) // 2
        low, high = (middle + 1, high) if times.row(middle) <= at else (low, middle)
    before = times.row(low - 1) if low else begin
    return times._replace(rows=low, last=at if at > before else None)


def _left(moved: MotionRows, rows: int, at: float, stop: int) -> MotionRows:
    """A motion that ends at a stop at some moment, which its last column has, behind some rows."""
    place = rows - moved.report.first
    last = max(min(place, moved.report.rows - moved.report.first - 1), 0)
    columns = [*range(place), last]
    report = moved.report._replace(end=MotionEnd.STOPPED, time=at, stop=stop, rows=rows)
    return replace(with_columns(moved, columns), report=report)


def with_contacts(
    response: ResponseProblem,
    contacts: Sequence[Contact],
    limits: Iterable[Limit],
    times: Floats,
    other: int | None = None,
) -> ResponseProblem:
    """The response with the forces of limits among its efforts: laws that have their values at the
    rows' moments, 0 where nothing rests.

    Args:
        response: the file's.
        contacts: the rests at limits.
        limits: those at which something rests, whether at these rows or not.
        times: moments of the rows (rows,), s.
        other: the number of the forces to take from those that are as good; of a contact without
            so many its own.
    """
    for limit in limits:
        values = np.zeros(times.size)
        own = [one for one in contacts if one.limit == limit]
        if own:
            at = np.concatenate([one.times for one in own])
            forces = np.concatenate([one.as_other(other) for one in own])
            place = np.searchsorted(times, at).clip(max=times.size - 1)
            is_row = times[place] == at
            values[place[is_row]] = forces[is_row]
        # no row is the last point, whose piece would be the one before it
        at = np.append(times, times[-1] + max(1.0, abs(float(times[-1]))))
        values = np.append(values + 0.0, 0.0)
        # within equal ones a straight line has the very value
        bends = np.ones(at.size, dtype=np.bool_)
        bends[1:-1] = (values[1:-1] != values[:-2]) | (values[1:-1] != values[2:])
        curve = joined_curve(at[bends].tolist(), values[bends].tolist(), "linear", "natural")
        law = LoadLaw(("time",), limit.place, curve=curve)
        load = JointLoad(limit.joint, limit.coordinate, Varying(len(response.load_laws)))
        response = replace(
            response,
            efforts=(*response.efforts, load),
            load_laws=(*response.load_laws, law),
            mechanism=replace(response.mechanism, loads=(*response.mechanism.loads, load)),
        )
    return response
