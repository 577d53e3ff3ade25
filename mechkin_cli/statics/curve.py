"""All equilibria of one freedom in a window.

The curve of positions is looked through in cells, between values of the window's coordinate that
are evenly spread over it. Each branch goes from a place to the next value, or to the dead centre
before it, beyond which the curve is followed on the other side; along it the force is taken at many
places. Equilibria are where it changes its sign, where it only touches zero, and where it does so
across a dead centre.

The first places are all assemblies at the values. A circuit that closes between two of them has
none: places at which random starts end, with the coordinate free, tell whether there is one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.kernel import functions
from mechkin_cli.mechanism import is_angle
from mechkin_cli.record import NamedTuple, dataclass, field
from mechkin_cli.search import all_assemblies, free_places, pose_number
from mechkin_cli.session import input_number, input_text
from mechkin_cli.statics.indifference import Motions, Part
from mechkin_cli.statics.newton import Balancing, Search, search
from mechkin_cli.statics.places import Place, Statics

if TYPE_CHECKING:
    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.search import Within
    from mechkin_cli.session import Ending, Session
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.statics.known import Known


class _Stretch(NamedTuple):
    """A branch within a cell of the window: values (samples,), states, turns and forces there, the
    largest force of one load, and the dead centre at its end."""

    values: Floats
    states: Floats
    turns: Floats
    forces: Floats
    largest: Floats
    fold: _Fold | None
    is_whole: bool


@dataclass
class _Fold:
    """A dead centre of the coordinate, its value, and what is known to end there."""

    value: float
    ending: Ending
    ways: list[_Stretch] = field(default_factory=list)
    is_passed: bool = False


class Curve:
    """The configurations of one freedom in a window."""

    def __init__(self, balancing: Balancing, statics: Statics, known: Known) -> None:
        self.balancing, self.statics, self.known = balancing, statics, known
        self.time = balancing.forces.driven.time
        (low,), (high,) = known.ends
        turns = 1
        if is_angle(balancing.coordinates[0][1]):
            turns = max(1, int(np.ceil((high - low) / (2.0 * np.pi) - tolerances.SAME_EQUILIBRIUM)))
        self.values, cell = np.linspace(
            low, high, turns * tolerances.WINDOW_PLACES + 1, retstep=True
        )
        # dead centres like to stand at round values, at which nothing can be followed
        self.values += tolerances.WINDOW_SHIFT * cell
        self.values[0] = low - tolerances.WINDOW_SHIFT * cell
        self.base = statics.session.inputs.values[:, 0]
        self.is_angle = is_angle(balancing.coordinates[0][1])
        self.met: list[list[Floats]] = [[] for _ in self.values]
        self.waiting: list[tuple[Place, int, int]] = []
        self.folds: list[_Fold] = []
        self.tried = self.ended = self.between = 0
        self.chance = 1.0
        self.lost: list[float] = []
        self.at_dead_centres: list[float] = []
        self.motions = Motions(statics, self._inputs)
        # values (places,), rising, states and turns of each branch in a cell
        self.places: list[tuple[Floats, Floats, Floats]] = []
        self.incomplete = 0.0

    def look(self) -> None:
        """Looks at all that is found of the curve within the window."""
        for number, value in enumerate(self.values.tolist()):
            for place in self._assemblies(value):
                self._meet(number, place)
            self._follow_all()
        self._look_between()
        self._settle_motions()

    def _meet(self, number: int, place: Place, coming: int = 0) -> None:
        """Takes a place at a value of the window, to which a branch comes from below (1) or above
        (-1), and follows the curve from there to the sides it does not come from."""
        layout = self.statics.session.layout
        known = self.met[number]
        if known and pose_number(layout, np.stack(known, axis=1), place.state) is not None:
            return
        known.append(place.state)
        if coming >= 0 and number < self.values.size - 1:
            self.waiting.append((place, number, 1))
        if coming <= 0 and number > 0:
            self.waiting.append((place, number - 1, -1))

    def _follow_all(self) -> None:
        """Follows the curve from all places that wait for it, and across all dead centres."""
        while True:
            while self.waiting:
                self._follow(*self.waiting.pop())
            half = [one for one in self.folds if len(one.ways) == 1 and not one.is_passed]
            if not half:
                return
            self._pass(half[0])

    def _follow(self, place: Place, cell: int, direction: int) -> None:
        """Follows the curve from a place of a cell to its end in a direction."""
        end = cell + (direction > 0)
        first = float(place.inputs[self.statics.free[0]])
        way = self._stretch(first, float(self.values[end]), place)
        up = np.s_[..., ::direction]
        self.places.append((way.values[up], way.states[up], way.turns[up]))
        self._look_along(way)
        if way.is_whole:
            inputs = self._inputs(self.values[end : end + 1])[:, 0]
            self._meet(
                end, self.statics.place(inputs, way.states[:, tolerances.WINDOW_SAMPLES]), direction
            )
        elif way.fold is not None:
            for other in way.fold.ways[:1]:
                self._look_across(other, way)
            way.fold.ways.append(way)

    def _fold(self, ending: Ending | None, near: float) -> _Fold | None:
        """The dead centre that is the end of a branch, near a value; None if it is another end."""
        if ending is None or not ending.is_dead_centre:
            return None
        layout, limit = self.statics.session.layout, tolerances.SAME_DEAD_CENTRE
        value = self._beside(float(ending.inputs[self.statics.free[0]]), near)
        for one in self.folds:
            same_turn = self._beside(value, one.value) == value
            state = one.ending.state[:, None]
            if same_turn and pose_number(layout, state, ending.state, limit) is not None:
                return one
        return _Fold(value, ending)

    def _pass(self, fold: _Fold) -> None:
        """Follows the curve on the other side of a dead centre, back to it and on."""
        fold.is_passed = True
        value = self._beside(float(fold.ending.inputs_beyond[self.statics.free[0]]), fold.value)
        place = self._closed(value, fold.ending.beyond)
        if place is not None:
            self._follow_both(place)

    def _follow_both(self, place: Place) -> None:
        """Follows the curve from a place to both ends of its cell."""
        value = float(place.inputs[self.statics.free[0]])
        cell = int(np.searchsorted(self.values, value)) - 1
        if 0 <= cell < self.values.size - 1:
            self._follow(place, cell, -1)
            self._follow(place, cell, 1)

    def _beside(self, value: float, other: float) -> float:
        """A value of the coordinate in the turn in which it is next to another."""
        if not self.is_angle:
            return value
        return value + 2.0 * np.pi * float(np.rint((other - value) / (2.0 * np.pi)))

    def _closed(self, value: float, state: Floats) -> Place | None:
        """The place at a value of the coordinate near some states (states,); None without one."""
        inputs = self._inputs(np.array([value]))
        reduced, _ = self.statics.reduced(inputs)
        batch = self.statics.session.close(reduced, state[:, None])
        if not batch.good[0]:
            return None
        return self.statics.place(inputs[:, 0], batch.states[:, 0])

    def _look_between(self) -> None:
        """Looks for circuits that are not known yet from places at which random starts end."""
        free = self.balancing.forces.session
        (block,) = free.graph.blocks
        if not block.closings or self.statics.session.problem.stopped:
            return
        within = self._box(free)
        generator, since = functions.RandomStarts(), 0
        while self.tried < tolerances.MOST_CIRCUIT_STARTS:
            states = free_places(free, within, generator, tolerances.CIRCUIT_STARTS)
            self.tried += tolerances.CIRCUIT_STARTS
            for state in states.T:
                known = self._is_known(state)
                if known is None:
                    continue
                self.ended += 1
                self.between += not known
                since = since + 1 if known else 0
            pairs = (self.between + 1) * (self.between + 2)
            doubt = float(functions.log(pairs / tolerances.SEARCH_DOUBT))
            self.chance = min(1.0, doubt / max(since, 1))
            if self.chance <= tolerances.CIRCUIT_CHANCE:
                return

    def _box(self, free: Session) -> Within:
        """Where random starts are taken: the coordinate within the window, or a turn of it."""
        session, (number,) = self.statics.session, self.statics.free
        centre, radius = np.zeros(free.layout.states), np.full(free.layout.states, np.inf)
        (low,), (high,) = self.known.ends
        half = 0.5 * float(high - low)
        if self.is_angle:
            half = min(half, np.pi)
        edge, freedom = session.graph.inputs[number]
        slot = session.layout.state(edge, freedom)
        centre[slot], radius[slot] = low + half, half
        return centre, radius

    def _is_known(self, state: Floats) -> bool | None:
        """Whether the curve is known about states (states,) of the free motion, in all turns of the
        window; it is followed where it is not. None for one that is not in the window."""
        session, (number,) = self.statics.session, self.statics.free
        edge, freedom = session.graph.inputs[number]
        value = float(state[session.layout.state(edge, freedom)])
        turns, known = [0.0], None
        low, high = float(self.values[0]), float(self.values[-1])
        if self.is_angle:
            turn = 2.0 * np.pi
            first = np.ceil((low - value) / turn)
            turns = (np.arange(first, np.floor((high - value) / turn) + 1.0) * turn).tolist()
        for turn in turns:
            at = value + turn
            if not low < at < high:
                continue
            place = self._closed(at, state)
            if place is None:
                continue
            known = known is not False
            if not self._leads_to_known(place):
                known = False
                self._follow_both(place)
                self._follow_all()
        return known

    def _leads_to_known(self, place: Place) -> bool:
        """Whether the curve leads from a place to one that is known, or cannot be followed."""
        layout = self.statics.session.layout
        value = float(place.inputs[self.statics.free[0]])
        cell = int(np.searchsorted(self.values, value)) - 1
        for end in (cell, cell + 1):
            way = self.statics.way(self._inputs(np.array([value, self.values[end]])), place)
            if way.reached == 2:
                there = self._closed(float(self.values[end]), way.states[:, 1])
                known = self.met[end]
                if there is None or not known:
                    return there is None
                return pose_number(layout, np.stack(known, axis=1), there.state) is not None
            fold = self._fold(way.ending, value)
            if fold is not None:
                return bool(fold.ways)
        return True

    def _inputs(self, values: Floats) -> Floats:
        inputs = np.repeat(self.base[:, None], values.size, axis=1)
        inputs[self.statics.free] = values
        return inputs

    def _assemblies(self, value: float) -> list[Place]:
        inputs = self._inputs(np.array([value]))
        reduced, _ = self.statics.reduced(inputs)
        found = all_assemblies(self.statics.session, reduced[:, 0])
        if not found.complete:
            self.incomplete = max(self.incomplete, found.chance)
        return [self.statics.place(inputs[:, 0], state) for state in found.states.T]

    def _stretch(self, first: float, last: float, place: Place) -> _Stretch:
        """The branch through a place at the first value, to the last or to its end before it."""
        count = tolerances.WINDOW_SAMPLES
        # one sample more shows what the force does at the end
        values = first + (last - first) * (np.arange(count + 2) / count)
        way = self.statics.way(self._inputs(values), place)
        reached, states, turns = way.reached, way.states, way.turns
        is_whole = reached > count
        values = values[:reached]
        fold = None if is_whole else self._fold(way.ending, first)
        if fold is not None and not fold.ways:
            self.folds.append(fold)
        if fold is not None and reached:
            gap = fold.value - values[-1]
            near = values[-1] + gap * np.array([0.0, 0.5, 0.75, 0.9, 0.97, 0.99])
            last_place = Place(self._inputs(values[-1:])[:, 0], states[:, -1], turns[:, -1])
            more = self.statics.way(self._inputs(near), last_place)
            values = np.concatenate([values, near[1 : more.reached]])
            states = np.concatenate([states, more.states[:, 1:]], axis=1)
            turns = np.concatenate([turns, more.turns[:, 1:]], axis=1)
        elif not is_whole and fold is None:
            self.lost.append(float(values[-1]) if reached else first)
        times = np.full(values.size, self.time)
        inputs = self._inputs(values)
        found = self.statics.forces(inputs, states, turns, times)
        forces = np.where(found.good, found.forces[0], np.nan)
        largest = self.statics.largest_at(inputs, states, turns, times)
        return _Stretch(values, found.states, turns, forces, largest, fold, is_whole)

    def _place(self, one: _Stretch, k: int) -> Place:
        inputs = self._inputs(one.values[k : k + 1])[:, 0]
        return Place(inputs, one.states[:, k], one.turns[:, k])

    def _look_along(self, one: _Stretch) -> None:
        """Zeros of the force along a stretch."""
        forces, values = one.forces, one.values
        zero = _is_zero(forces, one.largest)
        taken = self._take_motions(one, zero)
        for k in range(forces.size - 1):
            if taken[k]:
                continue
            if zero[k]:
                self._search(self._place(one, k), values[max(k - 1, 0)], values[k + 1])
            elif forces[k] * forces[k + 1] < 0.0 and not zero[k + 1]:
                self._between(one, k)
        if forces.size and zero[-1] and not taken[-1]:
            self._search(self._place(one, forces.size - 1), values[-2:][0], values[-1])
        for k in range(1, forces.size - 1):
            a, b, c = forces[k - 1 : k + 2]
            if taken[k] or a * b <= 0.0 or b * c <= 0.0 or abs(b) > min(abs(a), abs(c)):
                continue
            # the least of a parabola through three samples: near zero, or beyond it
            bend, slope = a - 2.0 * b + c, 0.5 * (c - a)
            least = b - 0.5 * slope * slope / bend if bend != 0.0 else b
            if least * b <= abs(b) * tolerances.TOUCHING * abs(b):
                self._search(self._place(one, k), values[k - 1], values[k + 1])

    def _take_motions(self, one: _Stretch, zero: Bools) -> Bools:
        """Takes the parts of a stretch along which the loads balance; which places these are."""
        taken = np.zeros(zero.size, dtype=bool)
        edges = np.flatnonzero(np.diff(np.concatenate([[False], zero, [False]]).astype(np.int8)))
        for first, behind in edges.reshape(-1, 2).tolist():
            if behind - first < 2:
                continue
            part = slice(first, behind)
            taken[part] = True
            begin, end = float(one.values[first]), float(one.values[behind - 1])
            centre = None
            if first > 0:
                begin = self._edge(one, first, first - 1)
            if behind < zero.size:
                end = self._edge(one, behind - 1, behind)
            elif one.fold is not None:
                end = one.fold.value
                centre = one.fold.ending.state
            found = Part(
                one.values[part],
                one.states[:, part],
                one.turns[:, part],
                min(begin, end),
                max(begin, end),
                centre,
            )
            start = self._start_within(one, first, behind - 1)
            if start is not None:
                self.motions.add(found, start)
        return taken

    def _start_within(self, one: _Stretch, first: int, last: int) -> Place | None:
        """The first place within the window of a part of a stretch; None where there is none."""
        (low,), (high,) = self.known.ends
        begin, end = float(one.values[first]), float(one.values[last])
        at = min(max(begin, float(low)), float(high))
        if not min(begin, end) <= at <= max(begin, end):
            return None
        place = self._place(one, first)
        way = self.statics.way(self._inputs(np.array([begin, at])), place)
        if at == begin or way.reached < 2:
            return place
        inputs = self._inputs(np.array([at]))[:, 0]
        return Place(inputs, way.states[:, 1], way.turns[:, 1])

    def _edge(self, one: _Stretch, inside: int, outside: int) -> float:
        """The value, between a sample at which the loads balance and one at which they do not, up
        to which they do."""
        place = self._place(one, inside)
        still, not_now = float(one.values[inside]), float(one.values[outside])
        for _ in range(tolerances.MOST_HALVINGS):
            middle = 0.5 * (still + not_now)
            way = self.statics.way(self._inputs(np.array([one.values[inside], middle])), place)
            if way.reached < 2:
                break
            at = self._inputs(np.array([middle])), way.states[:, 1:], way.turns[:, 1:]
            time = np.array([self.time])
            found, largest = self.statics.forces(*at, time), self.statics.largest_at(*at, time)
            if found.good.all() and _is_zero(found.forces[0], largest)[0]:
                still = middle
            else:
                not_now = middle
        return still

    def _settle_motions(self) -> None:
        """One equilibrium for each motion along which the loads balance, in place of all that were
        found on it."""
        starts = self.motions.starts
        if not starts:
            return
        self.known.leave_out(
            lambda one: self.motions.has(self.balancing.uncharted(self.statics, one.place))
        )
        for place in starts:
            found = self._found(place)
            if found is not None:
                self.known.add(found)

    def _between(self, one: _Stretch, k: int) -> None:
        """The zero between two samples: by Newton from the secant, else by halving."""
        place, low, high = self._place(one, k), one.values[k], one.values[k + 1]
        at, below = float(low), float(one.forces[k])
        end, above = float(high), float(one.forces[k + 1])
        for _ in range(tolerances.MOST_HALVINGS):
            middle = at + (end - at) * (below / (below - above))
            middle = min(max(middle, min(at, end)), max(at, end))
            way = self.statics.way(
                self._inputs(np.array([place.inputs[self.statics.free[0]], middle])), place
            )
            if way.reached < 2:
                return
            there = Place(self._inputs(np.array([middle]))[:, 0], way.states[:, 1], way.turns[:, 1])
            if self._search(there, low, high):
                return
            # not there: halve instead
            middle = 0.5 * (at + end)
            way = self.statics.way(
                self._inputs(np.array([place.inputs[self.statics.free[0]], middle])), place
            )
            if way.reached < 2:
                return
            inputs = self._inputs(np.array([middle]))
            force = self.statics.forces(
                inputs, way.states[:, 1:], way.turns[:, 1:], np.array([self.time])
            )
            if not force.good.all():
                return
            size = float(force.forces[0, 0])
            if size * below > 0.0:
                at, below = middle, size
                place = Place(inputs[:, 0], way.states[:, 1], way.turns[:, 1])
            else:
                end, above = middle, size

    def _found(self, place: Place) -> Search | None:
        """The equilibrium that a search from a place finds; None without one."""
        try:
            found = search(self.balancing, self.balancing.charted(self.statics, place))
        except ValueError:
            return None
        return found if found.found else None

    def _search(self, place: Place, low: float, high: float) -> bool:
        """Takes the equilibrium that a search from a place finds between two values."""
        found = self._found(place)
        if found is None:
            return False
        low, high = min(low, high), max(low, high)
        slack = tolerances.SAME_EQUILIBRIUM
        at = float(self.balancing.named(found.place)[0][0])
        if not low - slack <= at <= high + slack:
            return False
        self.known.add(found)
        return True

    def _look_across(self, one: _Stretch, other: _Stretch) -> None:
        """Zeros of the force between two stretches that meet at a dead centre: there its part along
        the coordinate has a sign on each side, and the same one where it has a zero between."""
        if not one.forces.size or not other.forces.size:
            return
        if not one.forces[-1] * other.forces[-1] > 0.0:
            return
        assert one.fold is not None
        fold = one.fold.value
        found = [
            self._search(self._place(each, each.values.size - 1), each.values[-2:][0], fold)
            for each in (one, other)
        ]
        if not any(found):
            self.at_dead_centres.append(fold)

    def notes(self, response: ResponseProblem) -> list[Diagnostic]:
        """What was missed, or may have been."""
        notes = []
        session, number = self.statics.session, self.statics.free[0]

        def words(value: float) -> str:
            return input_text(input_number(session.problem, session.layout, number, value))

        for value in self.at_dead_centres:
            text = (
                f"an equilibrium lies at a dead centre of the window's coordinate, {words(value)}"
            )
            hint = "name another coordinate in window:, which moves there"
            notes.append(Diagnostic("at-dead-centre", "warning", text, response.place, hint=hint))
        (low,), (high,) = self.known.ends
        spans = self.motions.spans(float(low), float(high))
        if spans:
            told = [
                f"from {words(low)} to {words(high)}" for low, high in spans[: tolerances.MOST_TOLD]
            ]
            if len(spans) > tolerances.MOST_TOLD:
                told.append(f"in {len(spans) - tolerances.MOST_TOLD} more parts of the window")
            text = f"the loads balance all along {', '.join(told)}"
            notes.append(Diagnostic("indifferent", "note", text, response.place))
        if self.lost:
            text = "a branch of the mechanism could not be followed through the window"
            hint = "equilibria beyond may be missed: name another coordinate in window:"
            at = f"first lost at {words(self.lost[0])}"
            notes.append(
                Diagnostic("window-branch", "warning", text, response.place, at, hint=hint)
            )
        if self.tried:
            notes.append(self._between_words(response))
        if self.incomplete > 0.0:
            text = (
                "assemblies in the window were searched for from random starts, which may miss some"
            )
            at = f"a chance of at most {self.incomplete:.1g} that one more start finds another"
            notes.append(Diagnostic("window-modes", "note", text, response.place, at))
        return notes

    def _between_words(self, response: ResponseProblem) -> Diagnostic:
        """How sure it is that no circuit was missed."""
        name = self.statics.session.problem.motion.inputs[self.statics.free[0]].name
        text = (
            f"none of {self.tried} random starts, {name} free, ended at a place within the window: "
            "circuits that are shorter than its parts may be missed"
        )
        at = None
        if self.ended:
            text = (
                f"circuits that are shorter than a part of the window were looked for from "
                f"{self.tried} random starts; with {100.0 * (1.0 - tolerances.SEARCH_DOUBT):g} % "
                f"confidence one more that ends within the window finds another with a chance of "
                f"at most {self.chance:.1g}"
            )
            at = f"{self.ended} ended within the window, {self.between} of them at unknown circuits"
        return Diagnostic("window-circuits", "note", text, response.place, at)


def _is_zero(forces: Floats, largest: Floats) -> Bools:
    """Where forces (places,) are rounding of what balances there: elsewhere loads may be huge, as
    on a branch that runs to infinity."""
    zero: Bools = np.abs(forces) <= tolerances.EQUILIBRIUM_BALANCE * largest
    return zero
