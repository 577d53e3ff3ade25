"""Rest at limits: coordinates that loads push to their limits stand there, held by the limits'
forces, until one of these would have to pull; what else is free moves on.

Such a motion is integrated on the same tree with the coordinates at rest as inputs, so its states
are those of the free motion. The force of a limit is what a drive would have to give that holds the
coordinate; it is told as effort there, and acts on rows as a load over time.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import (
    CrossingEnd,
    JointLoad,
    LoadLaw,
    Varying,
    effort_quantity,
    joined_curve,
)
from mechkin_cli.plan import FrictionTold, demand_of
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.response.integration import Beginning, driven_laws, integrate, watched_stop
from mechkin_cli.response.report import MotionEnd, MotionRows
from mechkin_cli.session import Ask, Chart, KernelInputs
from mechkin_cli.structure import holding

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from mechkin_cli.kernel._kernel import DrivenLaws
    from mechkin_cli.mechanism import Limit, ResponseProblem
    from mechkin_cli.response.integration import WatchedStop
    from mechkin_cli.session import Packing, Session
    from mechkin_cli.show import Floats


class Contact(NamedTuple):
    """A rest at a limit: its force along the coordinate (N*m, N) at the moments of rows (s), and
    forces that are as good, where several limits end one freedom."""

    limit: Limit
    times: Floats
    forces: Floats
    others: tuple[Floats, ...] = ()


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


class RestingMotion:
    """A motion with some coordinates at rest at their limits.

    Args:
        free: the session of the free motion.
        response: the file's.
        stops: the limits at which they rest, by the numbers of the response's stops.
        beside: other limits that end the same freedoms, whose coordinates rest with those, and the
            one of `stops` that each may stand for.
        begun: how it begins, at their limits and along them.
        friction: what the free motion tells of frictions there (numbers,).
        packing: how rows are packed.
    """

    def __init__(
        self,
        free: Session,
        response: ResponseProblem,
        stops: Sequence[int],
        beside: Mapping[int, int],
        begun: Beginning,
        friction: Floats,
        packing: Packing,
    ) -> None:
        self.free, self.response, self.packing = free, response, packing
        self.stops, self.beside, self.as_free = list(stops), dict(beside), friction
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

    def onward(self, begin: float, times: Floats) -> tuple[MotionRows, list[Contact]]:
        """The motion from a moment (s) on, its first row, over rows at `times` (rows,), as one of
        the free coordinates; up to where a limit would have to pull, which then is its stop. And
        the forces of the limits at its rows."""
        at = self._leaves(begin, times)
        reached = times if at is None else times[times <= at[0]]
        own = np.array([begin, *reached])
        if at is not None and at[0] > own[-1]:
            own = np.append(own, at[0])
        moved = self._moved(own) if at is None else _widened(self._moved(own), times.size + 2)
        forces = self._forces(moved, own)
        if at is not None:
            moved = _left(moved, reached.size + 1, own.size - 1, *at)
        count = 1 + min(reached.size, moved.report.rows - 1)
        contacts = self._contacts(own[:count], [one[:, :count] for one in forces])
        if moved.report.end is MotionEnd.STOPPED and at is None:
            last = np.array([moved.report.time])
            contacts += self._contacts(last, self._forces(moved, last, [moved.report.rows]))
        return self._as_free(moved), contacts

    def _contacts(self, times: Floats, forces: Sequence[Floats]) -> list[Contact]:
        """The rests at all limits, by forces of the limits that push and of each that others may
        stand for."""
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

    def _moved(self, times: Floats) -> MotionRows:
        """The motion from the first of some moments on."""
        (moved,) = integrate(
            [(self.held.session.plan, self.begun)],
            float(times[0]),
            times,
            stops=[self._watched(number) for number in range(len(self.response.stops))],
            driven=self.held.laws,
            tolerance=self.response.tolerance,
            fixed_step=self.response.fixed_step,
            straight=self.free.problem.assembly.straight,
            packing=self.packing,
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
        for column, time in enumerate(times[reached].tolist() if laws else ()):
            assert laws is not None
            orders[:, :, column] = np.array(laws.at(time)).T
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

    def _pushes(self, times: Floats) -> Floats:
        """How the limits push at moments from the first on (limits, moments); nan beyond its
        end."""
        forces = self._efforts(self.held, self._moved(times), times, None)
        return np.array([-side * one for side, one in zip(self.sides, forces, strict=True)])

    def _leaves(self, begin: float, times: Floats) -> tuple[float, int] | None:
        """The first moment up to the last row at which a limit would pull, and the number of its
        stop; None where none does."""
        ends = np.array([begin, *times])
        parts = np.linspace(0.0, 1.0, SAMPLES + 1)[1:]
        sampled = np.concatenate([[begin], *(a + (b - a) * parts for a, b in pairwise(ends))])
        found = self._pushes(sampled)
        least = tolerances.KINK_ROUNDING * np.nanmax(np.abs(found), axis=1, initial=0.0)
        pulling = np.flatnonzero((found < -least[:, None]).any(axis=0))
        if not pulling.size:
            return None
        k = int(pulling[0])
        number = int(np.argmin(found[:, k]))
        if k == 0:
            return begin, self.stops[number]
        low, high = float(sampled[k - 1]), float(sampled[k])
        while True:
            inner = np.unique(low + (high - low) * np.linspace(0.0, 1.0, SAMPLES + 1))
            if inner.size < 3:
                return high, self.stops[number]
            lead = np.array([begin] if inner[0] > begin else [])
            found = self._pushes(np.concatenate([lead, inner]))[:, lead.size :]
            pulls = np.flatnonzero((found < 0.0).any(axis=0))
            k = int(pulls[0]) if pulls.size else inner.size - 1
            number = int(np.argmin(found[:, k])) if pulls.size else number
            if k == 0 or (float(inner[k - 1]), float(inner[k])) == (low, high):
                return (low if k == 0 else high), self.stops[number]
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
        for number, column in enumerate(self.columns):
            resting[number, column] = 1.0
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

SAMPLES = 16
"""Parts of a step from row to row, and of each bracket, at which forces are looked at."""


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


def _widened(moved: MotionRows, width: int) -> MotionRows:
    """With columns up to a width, those more without a row."""

    def wide(array: NDArray[Any]) -> NDArray[Any]:
        none = np.nan if array.dtype == np.float64 else 0
        found = np.full((*array.shape[:-1], max(width, array.shape[-1])), none, dtype=array.dtype)
        found[..., : array.shape[-1]] = array
        return found

    return _each(moved, wide)


def repeated(moved: MotionRows) -> MotionRows:
    """A motion with its first row twice: as the place where it begins, and as the row of the
    response at that moment."""
    more = _each(moved, lambda array: np.concatenate([array[..., :1], array], axis=-1))
    return replace(more, report=moved.report._replace(rows=moved.report.rows + 1))


def _left(moved: MotionRows, rows: int, place: int, at: float, stop: int) -> MotionRows:
    """A motion of some rows that ends at a stop, at the moment of column `place`."""
    if moved.report.rows < place + 1:
        return moved  # it has ended before

    def cut(array: NDArray[Any]) -> NDArray[Any]:
        found = array.copy()
        found[..., rows] = array[..., place]
        return found

    report = moved.report._replace(end=MotionEnd.STOPPED, time=at, stop=stop, rows=rows)
    return replace(_each(moved, cut), report=report)


def _each(moved: MotionRows, change: Any) -> MotionRows:
    chart = Chart(*(change(array) for array in moved.chart))
    states, turns, work = (change(array) for array in (moved.states, moved.turns, moved.work))
    return MotionRows(moved.report, states, chart, turns, work, change(moved.flags))


def with_contacts(
    response: ResponseProblem, contacts: Sequence[Contact], times: Floats, other: int | None = None
) -> ResponseProblem:
    """The response with the forces of limits among its efforts: laws that have their values at the
    rows' moments, 0 where nothing rests.

    Args:
        response: the file's.
        contacts: the rests at limits.
        times: moments of the rows (rows,), s.
        other: the number of the forces to take from those that are as good; of a contact without
            so many its own.
    """
    for limit in dict.fromkeys(one.limit for one in contacts):
        values = np.zeros(times.size)
        for one in contacts:
            if one.limit == limit:
                is_other = other is not None and other < len(one.others)
                forces = one.others[other] if is_other else one.forces  # type: ignore[index]
                values[np.isin(times, one.times)] = forces[np.isin(one.times, times)]
        curve = joined_curve(times.tolist(), values.tolist(), "linear", "natural")
        law = LoadLaw(("time",), limit.place, curve=curve)
        load = JointLoad(limit.joint, limit.coordinate, Varying(len(response.load_laws)))
        response = replace(
            response,
            efforts=(*response.efforts, load),
            load_laws=(*response.load_laws, law),
            mechanism=replace(response.mechanism, loads=(*response.mechanism.loads, load)),
        )
    return response
