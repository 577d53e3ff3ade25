"""Where friction holds a mechanism of one freedom: the interval of its coordinate in which it
rests.

At each place the kernel tells which part of their friction all joints need at once, so that nothing
has to drive the mechanism (kernel/core/forces/rest_share.hpp). It is zero where the loads balance,
and the mechanism rests as far as its size is at most one. From a place that rests, the branch is
followed to both sides, up to where it slips, or to what else ends the interval.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism import REST_SHARE, is_angle, rubbing_words
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.search import pose_number
from mechkin_cli.session import Ask, input_number, input_text, input_unit
from mechkin_cli.statics.places import Place, Statics
from mechkin_cli.statics.stability import held
from mechkin_cli.sweep import SHIFTS, unfounded_in_motion

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from mechkin_cli.mechanism import Limit, ResponseProblem
    from mechkin_cli.session import Ending
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.statics.newton import Balancing, Search
    from mechkin_cli.statics.stability import Verdict


class RestEnd(Enum):
    """What ends an interval of rest, in words of a message."""

    SLIPS = "beyond which it slips"
    LIMIT = "the limit of the coordinate"
    WINDOW = "the end of the window"
    DEAD_CENTRE = "a dead centre of the coordinate"
    BRANCH_ENDS = "beyond which the mechanism cannot be followed"
    UNKNOWN = "beyond which the friction has no answer"
    TURN = "a turn further"
    FAR = "as far as it was followed"


class RestInterval(NamedTuple):
    """Values of the coordinate, in kernel units, between which friction holds the mechanism, and
    what ends them below and above; places in it: values (places,), rising, with states and
    turns."""

    low: float
    high: float
    ends: tuple[RestEnd, RestEnd]
    values: Floats
    states: Floats
    turns: Floats


class _Side(NamedTuple):
    """Places from one on towards an end, in the order in which they come."""

    values: Floats
    states: Floats
    turns: Floats
    end: float
    why: RestEnd


class FrictionRest:
    """Rest by friction about places of a session whose first input nothing drives.

    Args:
        statics: of the mechanism without friction, one coordinate of which is free.
        response: the run, with its frictions.
        window: within which intervals are looked for; None: a turn, or far, from a place.
    """

    def __init__(
        self, statics: Statics, response: ResponseProblem, window: Limit | None = None
    ) -> None:
        problem = statics.session.problem
        rubbing = replace(problem.mechanism, frictions=response.frictions)
        self.statics, self.response = statics, response
        self.session = statics.session.loaded(replace(problem, mechanism=rubbing))
        self.time = float(response.moments.values[0])
        self.free = statics.free[0]
        item = problem.motion.inputs[self.free]
        unit = input_unit(self.session.layout, item)
        self.turns = is_angle(item.coordinate)
        self.bounds: list[tuple[float, float, RestEnd]] = []
        if window is not None:
            self.bounds.append((window.low / unit, window.high / unit, RestEnd.WINDOW))
        self.bounds += [
            (one.low / unit, one.high / unit, RestEnd.LIMIT)
            for one in problem.limits
            if (one.joint, one.coordinate) == (item.joint, item.coordinate)
        ]
        self.base = statics.session.inputs.values[:, 0]
        self.unfounded = unfounded_in_motion(self.session.problem, redundant=False)

    def inputs(self, values: Floats) -> Floats:
        """All inputs (inputs, places) at values of the coordinate."""
        inputs = np.repeat(self.base[:, None], values.size, axis=1)
        inputs[self.free] = values
        return inputs

    def shares(self, values: Floats, states: Floats, turns: Floats) -> Floats:
        """Which part of friction holds the mechanism at places (places,), positive where the loads
        push the coordinate forward; nan where that is not known."""
        if not values.size:
            return np.zeros(0)
        rows = Statics(self.session, [self.free]).rows(
            self.inputs(values), states, turns, np.full(values.size, self.time)
        )
        # nothing moves yet: the acceleration tells the way, and is too small for any force
        ahead = np.zeros_like(rows.inputs)
        ahead[self.free] = tolerances.ABOUT_TO_MOVE
        rows = rows._replace(accelerations=ahead)
        readout = self.session.readout([REST_SHARE])
        demand = Demand.VELOCITY | Demand.ACCELERATION | Demand.FORCES
        slot = readout.slots[REST_SHARE.name].start
        found: Floats | None = None
        for shift in (0, *(SHIFTS if self.session.is_redundant else ())):
            batch = self.session.run(rows, Ask(demand, readout, shift=shift))
            assert batch.outputs is not None
            own = np.where(batch.good, batch.outputs[slot], np.nan)
            if batch.undefined is not None:
                own = np.where(batch.undefined != 0, np.nan, own)
            if found is None:
                found = own
                continue
            # reactions that are not unique leave friction open that goes by them
            both_far = np.isinf(found) & (found == own)
            with np.errstate(invalid="ignore"):
                same = np.abs(own - found) <= tolerances.UNIQUE_CELL * np.fmax(1.0, np.abs(found))
            found = np.where(same | both_far, found, np.nan)
        assert found is not None
        return found

    def holds(self, place: Place) -> bool:
        """Whether friction holds the mechanism at a place."""
        return bool(_rests(self._shares_at(place))[0])

    def _shares_at(self, place: Place) -> Floats:
        values = place.inputs[self.free : self.free + 1]
        return self.shares(values, place.state[:, None], place.turns[:, None])

    def interval(self, place: Place) -> RestInterval | None:
        """The interval about a place at which friction holds the mechanism; None where it does
        not, or where that is not known."""
        if not self.holds(place):
            return None
        below, above = self._side(place, -1.0), self._side(place, 1.0)
        if below.why is above.why is RestEnd.UNKNOWN:
            return None
        at = place.inputs[self.free]
        values = np.concatenate([below.values[::-1], [at], above.values])
        states, turns = (
            np.concatenate([one[:, ::-1], here[:, None], other], axis=1)
            for one, here, other in (
                (below.states, place.state, above.states),
                (below.turns, place.turns, above.turns),
            )
        )
        return RestInterval(below.end, above.end, (below.why, above.why), values, states, turns)

    def _bound(self, at: float, sign: float) -> tuple[float, RestEnd]:
        """How far an interval may reach from a place to one side, and why."""
        reach = 2.0 * np.pi if self.turns else tolerances.FAR_EQUILIBRIUM
        ends = [(at + sign * reach, RestEnd.TURN if self.turns else RestEnd.FAR)]
        if any(why is RestEnd.WINDOW for *_, why in self.bounds):
            ends = []
        ends += [(high if sign > 0.0 else low, why) for low, high, why in self.bounds]
        return min(ends, key=lambda pair: sign * pair[0])

    def _side(self, place: Place, sign: float) -> _Side:
        """From a place that rests on to one side."""
        at = start = float(place.inputs[self.free])
        bound, why = self._bound(at, sign)
        step = tolerances.REST_INTERVAL_STEP
        parts: list[tuple[Floats, Floats, Floats]] = []
        count = tolerances.REST_INTERVAL_PLACES

        def taken(end: float, reason: RestEnd) -> _Side:
            none = np.zeros(0), np.zeros((place.state.size, 0)), np.zeros((place.turns.size, 0))
            values, states, turns = zip(*(none, *parts), strict=True)
            return _Side(
                np.concatenate(values),
                np.concatenate(states, axis=1),
                np.concatenate(turns, axis=1),
                end,
                reason,
            )

        while sign * (bound - at) > 0.0:
            values: Floats = at + (sign * step) * np.arange(1.0, count + 1.0)
            inner = sign * (bound - values) > 0.0
            values = values[inner] if inner.all() else np.append(values[inner], bound)
            way = self.statics.way(self.inputs(np.append(at, values)), place)
            states, turns = way.states[:, 1:], way.turns[:, 1:]
            ends_there = way.reached <= values.size
            values = values[: max(way.reached - 1, 0)]
            if ends_there:
                last = self._at(values, states, turns, values.size - 1) if values.size else place
                values, states, turns = self._towards(last, way.ending, (values, states, turns))
            rests = _rests(self.shares(values, states, turns))
            held = int(np.argmin(np.append(rests, False)))
            parts.append((values[:held], states[:, :held], turns[:, :held]))
            last = self._at(values, states, turns, held - 1) if held else place
            if held < values.size:
                return taken(*self._edge(last, float(values[held])))
            if ends_there and way.ending is not None and way.ending.is_dead_centre:
                return taken(float(way.ending.inputs[self.free]), RestEnd.DEAD_CENTRE)
            if ends_there:
                return taken(float(last.inputs[self.free]), RestEnd.BRANCH_ENDS)
            place, at = last, float(values[-1])
            # slides without an end in sight are looked at in parts of the way gone
            if not self.turns and why is RestEnd.FAR:
                step = max(step, abs(at - start) / count)
        return taken(bound, why)

    def _towards(
        self, last: Place, ending: Ending | None, places: tuple[Floats, Floats, Floats]
    ) -> tuple[Floats, Floats, Floats]:
        """Places, and more of them towards the dead centre beyond the last one."""
        if ending is None or not ending.is_dead_centre:
            return places
        at = float(last.inputs[self.free])
        gap = float(ending.inputs[self.free]) - at
        halves = np.multiply.accumulate(np.full(tolerances.REST_DEAD_CENTRE_PLACES, 0.5))
        near: Floats = at + gap * (1.0 - 2.0 * halves)
        more = self.statics.way(self.inputs(near), last)
        added = near[1 : more.reached], more.states[:, 1:], more.turns[:, 1:]
        values, states, turns = (
            np.concatenate([one, other], axis=-1) for one, other in zip(places, added, strict=True)
        )
        return values, states, turns

    def _at(self, values: Floats, states: Floats, turns: Floats, k: int) -> Place:
        return Place(self.inputs(values[k : k + 1])[:, 0], states[:, k], turns[:, k])

    def _edge(self, inside: Place, outside: float) -> tuple[float, RestEnd]:
        """Up to where friction holds the mechanism, between a place where it does and a value where
        it does not, or where that is not known."""
        low, high = float(inside.inputs[self.free]), outside
        below, above = abs(float(self._shares_at(inside)[0])) - 1.0, np.nan
        for _ in range(tolerances.MOST_HALVINGS):
            parts = np.arange(1, 8) / 8.0
            if 0.0 < above < np.inf:
                # where a line through both ends of the bracket is one, and beside it
                root = below / (below - above)
                beside = root + np.array([-1.0, 0.0, 1.0]) * tolerances.REST_EDGE_PART
                parts = np.concatenate([parts, beside[(beside > 0.0) & (beside < 1.0)]])
            values = np.unique(low + (high - low) * parts)
            values = values[(values - low) * (values - high) < 0.0]
            if not values.size:
                break
            values = values if high > low else values[::-1]
            way = self.statics.way(self.inputs(np.append(inside.inputs[self.free], values)), inside)
            reached = max(way.reached - 1, 0)
            states, turns = way.states[:, 1:], way.turns[:, 1:]
            shares = np.full(values.size, np.nan)
            shares[:reached] = self.shares(values[:reached], states, turns)
            k = int(np.argmin(np.append(_rests(shares), False)))
            if k < values.size:
                high, above = float(values[k]), abs(float(shares[k])) - 1.0
            if k:
                low, below = float(values[k - 1]), abs(float(shares[k - 1])) - 1.0
                inside = self._at(values, states, turns, k - 1)
        return low, RestEnd.UNKNOWN if np.isnan(above) else RestEnd.SLIPS

    def _closed(self, value: float, near: Place) -> Place | None:
        """The place at a value of the coordinate that is followed from one nearby."""
        at = near.inputs[self.free]
        way = self.statics.way(self.inputs(np.array([at, value])), near)
        if way.reached < 2:
            return None
        inputs = self.inputs(np.array([value]))
        times = np.array([self.time])
        found = self.statics.forces(inputs, way.states[:, 1:], way.turns[:, 1:], times)
        return Place(inputs[:, 0], found.states[:, 0], way.turns[:, 1])

    def covers(self, interval: RestInterval, place: Place) -> bool:
        """Whether a place lies in an interval, or whole turns from such a place."""
        layout, limit = self.session.layout, tolerances.SAME_DEAD_CENTRE
        slack = tolerances.SAME_EQUILIBRIUM
        value = float(place.inputs[self.free])
        if self.turns and self.statics.cyclic[self.free]:
            value += 2.0 * np.pi * np.ceil((interval.low - slack - value) / (2.0 * np.pi))
        if not interval.low - slack <= value <= interval.high + slack:
            return False
        k = int(np.argmin(np.abs(interval.values - value)))
        near = self._at(interval.values, interval.states, interval.turns, k)
        there = self._closed(min(max(value, interval.low), interval.high), near)
        if there is None or pose_number(layout, there.state[:, None], place.state, limit) is None:
            return False
        # a spring that counts turns holds it elsewhere in each
        off = self._shares_at(there) - self._shares_at(place)
        return bool(np.abs(off)[0] <= tolerances.SAME_REST_SHARE)

    def middle(self, interval: RestInterval) -> Place:
        """The place in the middle of an interval."""
        value = 0.5 * (interval.low + interval.high)
        k = int(np.argmin(np.abs(interval.values - value)))
        near = self._at(interval.values, interval.states, interval.turns, k)
        return self._closed(value, near) or near

    def others(
        self,
        stretches: Iterable[tuple[Floats, Floats, Floats]],
        known: Sequence[RestInterval | None],
    ) -> list[RestInterval]:
        """Intervals in which friction holds the mechanism along branches, each given by values,
        states and turns, beside those that are known."""
        found = [one for one in known if one is not None]
        count = len(found)
        low, high = self._bound(0.0, -1.0)[0], self._bound(0.0, 1.0)[0]
        for values, states, turns in stretches:
            rests = _rests(self.shares(values, states, turns))
            rests = rests & (values >= low) & (values <= high)
            starts = np.flatnonzero(rests & ~np.append(False, rests[:-1]))
            for k in starts.tolist():
                place = self._at(values, states, turns, k)
                if any(self.covers(one, place) for one in found):
                    continue
                one = self.interval(place)
                if one is not None:
                    found.append(one)
        return found[count:]

    def about(self, places: Iterable[Place]) -> list[RestInterval | None]:
        """The intervals about places, each of which is searched for once."""
        found: list[RestInterval | None] = []
        for place in places:
            if self.unfounded is not None:
                found.append(None)
                continue
            known = (one for one in found if one is not None and self.covers(one, place))
            found.append(next(known, None) or self.interval(place))
        return found

    def rows(
        self,
        balancing: Balancing,
        judgements: list[tuple[Search, Verdict]],
        stretches: Iterable[tuple[Floats, Floats, Floats]],
    ) -> tuple[list[tuple[Search, Verdict]], list[RestInterval | None]]:
        """The equilibria of a window with their intervals, and a row in the middle of each interval
        in which there is none, along the branches of the window (`others`)."""
        places = (balancing.uncharted(self.statics, one.place) for one, _ in judgements)
        rests = self.about(places)
        rows = list(zip(judgements, rests, strict=True))
        for one in [] if self.unfounded is not None else self.others(stretches, rests):
            try:
                place = balancing.charted(self.statics, self.middle(one))
            except ValueError:
                continue  # the coordinate stands there
            rows.append((held(balancing, place), one))
        rows.sort(key=lambda row: row[0][1].coordinates.tolist())
        return [row for row, _ in rows], [one for _, one in rows]

    def notes(self, intervals: Sequence[RestInterval | None]) -> list[Diagnostic]:
        """What ends each interval; that one is not told, and why."""
        session, response = self.session, self.response
        words = rubbing_words(response.frictions)
        if self.unfounded is not None or any(one is None for one in intervals):
            why = "reactions by which it goes are not unique"
            hint: str | None = (
                "free a joint of the loop (a sphere for a pin, a cylinder for a slide)"
            )
            if self.unfounded is not None:
                why, hint = self.unfounded.message, self.unfounded.hint
            elif not session.is_redundant:
                why, hint = "it has no answer there", "make the coefficient smaller"
            text = f"where {words} holds the mechanism is not told: {why}"
            return [Diagnostic("rest-interval", "warning", text, response.place, hint=hint)]

        def at(value: float) -> str:
            return input_text(input_number(session.problem, session.layout, self.free, value))

        told: dict[str, None] = {}
        for one in intervals:
            assert one is not None
            low, high = (
                at(value) + ("" if end is RestEnd.SLIPS else f" ({end.value})")
                for value, end in zip((one.low, one.high), one.ends, strict=True)
            )
            told[f"from {low} to {high}"] = None
        if not told:
            return []
        shown = list(told)[: tolerances.MOST_TOLD]
        more = len(told) - len(shown)
        shown += [f"in {more} more intervals"] if more else []
        text = f"{words} holds the mechanism {', and '.join(shown)}"
        return [Diagnostic("rest-interval", "note", text, response.place)]


def friction_left_out(response: ResponseProblem) -> list[Diagnostic]:
    """That no interval of rest is told where several freedoms are free and joints rub."""
    if not response.frictions or response.rubs_at_rest:
        return []
    text = "friction is left out: the loads balance without it"
    hint = (
        "of several freedoms it holds the mechanism in a region about this place; a response that "
        "starts at rest tells whether it stays"
    )
    return [Diagnostic("friction-left-out", "note", text, response.place, hint=hint)]


def _rests(shares: Floats) -> Bools:
    with np.errstate(invalid="ignore"):
        rests: Bools = np.abs(shares) <= 1.0
    return rests
