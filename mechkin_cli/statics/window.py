"""All equilibria in a window.

Of one freedom: between values of its coordinate, evenly spread over the window, every branch of
every assembly is followed to the next value or to the dead centre before it, and the force is taken
at places along it. Equilibria are where it changes its sign, where it only touches zero, and where
it does so across a dead centre. What closes between two values without coming to either is missed.

Of several freedoms: searches start at places spread over the window, in every assembly there, by
Newton's steps and, in turns, down to a stable place. How likely one more start finds another is
told, as for assembly modes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.kernel import functions
from mechkin_cli.mechanism import Limit, is_angle
from mechkin_cli.record import NamedTuple, dataclass, field, replace
from mechkin_cli.search import all_assemblies, pose_keys, pose_number, same_poses
from mechkin_cli.session import input_number, input_text, input_unit, turn_of
from mechkin_cli.statics.friction import FrictionRest, RestInterval
from mechkin_cli.statics.indifference import Motions, Part
from mechkin_cli.statics.newton import (
    Balancing,
    Search,
    SearchEnd,
    determinant,
    search,
    settle,
    slopes,
)
from mechkin_cli.statics.places import Place, Statics
from mechkin_cli.statics.result import EquilibriumResult
from mechkin_cli.statics.stability import judged

if TYPE_CHECKING:
    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.response import Prepared
    from mechkin_cli.session import Ending
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.statics.forces import FreePlace


def in_window(one: Prepared) -> EquilibriumResult:
    """All equilibria of an entry of the file with a window; its middle need not be assembled."""
    response, session = one.response, one.chosen
    start = replace(one.start, diagnostics=[])
    balancing = Balancing.of(session, response.independent)
    statics = Statics(session, range(len(response.independent)))
    assert response.search is not None
    known = Known(balancing, response.search.window)
    if statics.count == 1:
        curve = _Curve(balancing, statics, known)
        curve.look()
        notes = curve.notes(response)
    else:
        notes = _from_starts(response, balancing, statics, known)
    notes = [*notes, *known.notes(response)]
    judgements = [(found, judged(balancing, found)) for found in known.found]
    judgements.sort(key=lambda pair: pair[1].coordinates.tolist())
    rests: list[RestInterval | None] = []
    if statics.count == 1 and response.frictions:
        rest = FrictionRest(statics, response, response.search.window[0])
        judgements, rests = rest.rows(balancing, judgements, curve.places)
        notes += rest.notes(rests)
    if not judgements:
        notes = [*notes, _none(response)]
    return EquilibriumResult(response, balancing, start, judgements, notes, rests)


MOST_SPANS = 4
"""Parts of a window in which the loads balance all along that are told one by one."""


@dataclass
class Known:
    """The equilibria that are known, each once, within a window."""

    balancing: Balancing
    window: tuple[Limit, ...]
    found: list[Search] = field(default_factory=list)
    is_folded: bool = False
    _counted: int = 0
    _excess: int = 0

    @property
    def excess(self) -> int:
        """How many more of the equilibria have an even number of unstable directions than an odd
        one."""
        for one in self.found[self._counted :]:
            known = slopes(self.balancing.forces, one.place)
            self._excess += 0 if known is None else int(np.sign(determinant(known[1])))
        self._counted = len(self.found)
        return self._excess

    @property
    def ends(self) -> tuple[Floats, Floats]:
        """Least and largest values (free,) of the window, in kernel units."""
        session = self.balancing.chosen
        inputs = session.problem.motion.inputs[: len(self.window)]
        units = np.array([input_unit(session.layout, item) for item in inputs])
        low = np.array([one.low for one in self.window]) / units
        return low, np.array([one.high for one in self.window]) / units

    def add(self, one: Search) -> bool:
        """Takes an equilibrium, if it lies in the window and is not known; whether it is new."""
        inside = self._within(one)
        if inside is None:
            return False
        if self.found:
            layout, limit = self.balancing.chosen.layout, tolerances.SAME_EQUILIBRIUM
            poses = np.stack([other.place.state for other in self.found], axis=1)
            same = same_poses(
                pose_keys(layout, poses), pose_keys(layout, inside.place.state[:, None]), limit
            )[:, 0]
            # the same pose some turns further, where other loads balance, is another equilibrium
            at = self._values(inside)
            for k in np.flatnonzero(same):
                if not np.rint((self._values(self.found[k]) - at) / (2.0 * np.pi)).any():
                    return False
        self.found.append(inside)
        return True

    def _values(self, one: Search) -> Floats:
        return self.balancing.named(one.place)[0]

    def _within(self, one: Search) -> Search | None:
        """An equilibrium whose angles are turned down to the least values in the window, as far as
        the loads and their slopes are the same there; None outside."""
        session, (low, high) = self.balancing.chosen, self.ends
        values, slack = self._values(one).copy(), tolerances.SAME_EQUILIBRIUM
        place, here = one.place, None
        for k, item in enumerate(session.problem.motion.inputs[: values.size]):
            turns = float(np.ceil((low[k] - slack - values[k]) / (2.0 * np.pi)))
            if turns == 0.0 or turn_of(session.problem, item) is None:
                continue
            if here is None:
                here = slopes(self.balancing.forces, place)
            moved = self._turned(place, k, turns)
            there = slopes(self.balancing.forces, moved)
            # a spring on an angle counts its turns: a turn further loads may not balance
            if here is None or there is None or not _are_same(here, there, one.largest):
                continue
            if values[k] <= high[k] + slack and values[k] >= low[k] - slack:
                wide = high[k] - low[k] > 2.0 * np.pi + slack
                self.is_folded = self.is_folded or bool(wide)
            place = moved
            values[k] += 2.0 * np.pi * turns
        if not ((values >= low - slack) & (values <= high + slack)).all():
            return None
        return one._replace(place=place)

    def _turned(self, place: FreePlace, number: int, turns: float) -> FreePlace:
        """A place with one of the window's angles some whole turns further."""
        session = self.balancing.chosen
        item, (edge, freedom) = session.problem.motion.inputs[number], session.graph.inputs[number]
        state, slots = place.state.copy(), place.turns.copy()
        if session.layout.joint_reference[item.joint] >= 0:
            state[session.layout.state(edge, freedom)] += 2.0 * np.pi * turns
        else:
            slot = session.structure.turn_slot(session.problem.quantities()[item.name])
            if slot is not None:
                slots[slot] += 2.0 * np.pi * turns
        return place._replace(state=state, turns=slots)

    def notes(self, response: ResponseProblem) -> list[Diagnostic]:
        """That whole turns were left out."""
        if not self.is_folded:
            return []
        text = (
            "equilibria that whole turns alone tell apart, at which the loads are the same, are "
            "one row, at the least angle in the window"
        )
        return [Diagnostic("window-turns", "note", text, response.place)]


def _are_same(one: tuple[Floats, Floats], other: tuple[Floats, Floats], largest: float) -> bool:
    """Whether forces and their slopes are the same at two places."""
    forces = float(np.max(np.abs(one[0] - other[0])))
    matrices = float(np.max(np.abs(one[1] - other[1])))
    size = max(largest, float(np.max(np.abs(one[1]))))
    return max(forces, matrices) <= tolerances.TURNED_BALANCE * size


class _Stretch(NamedTuple):
    """A branch within a cell of the window: values (samples,), states, turns and forces there, the
    largest force of one load, and the dead centre at its end."""

    values: Floats
    states: Floats
    turns: Floats
    forces: Floats
    largest: Floats
    ending: Ending | None
    is_whole: bool


class _Curve:
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
        self.lost: list[float] = []
        self.at_dead_centres: list[float] = []
        self.motions = Motions(statics, self._inputs)
        self.places: list[tuple[Floats, Floats, Floats]] = []
        self.incomplete = 0.0
        self.largest = 0.0

    def look(self) -> None:
        """Looks at all cells of the window."""
        before = self._assemblies(self.values[0])
        for low, high in zip(self.values[:-1], self.values[1:], strict=True):
            after = self._assemblies(high)
            ways = [self._stretch(low, high, place) for place in before]
            ways += [
                one
                for one in (self._stretch(high, low, place) for place in after)
                if not one.is_whole
            ]
            for one in ways:
                self.places.append((one.values, one.states, one.turns))
                self._look_along(one)
            self._look_across([one for one in ways if not one.is_whole])
            before = after
        self._settle_motions()

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
        ending = None if is_whole else way.ending
        if ending is not None and ending.is_dead_centre and reached:
            fold = float(ending.inputs[self.statics.free[0]])
            gap = fold - values[-1]
            near = values[-1] + gap * np.array([0.0, 0.5, 0.75, 0.9, 0.97, 0.99])
            last_place = Place(self._inputs(values[-1:])[:, 0], states[:, -1], turns[:, -1])
            more = self.statics.way(self._inputs(near), last_place)
            values = np.concatenate([values, near[1 : more.reached]])
            states = np.concatenate([states, more.states[:, 1:]], axis=1)
            turns = np.concatenate([turns, more.turns[:, 1:]], axis=1)
        elif not is_whole:
            self.lost.append(float(values[-1]) if reached else first)
        times = np.full(values.size, self.time)
        inputs = self._inputs(values)
        found = self.statics.forces(inputs, states, turns, times)
        forces = np.where(found.good, found.forces[0], np.nan)
        largest = self.statics.largest_at(inputs, states, turns, times)
        self.largest = max(self.largest, float(largest.max(initial=0.0)))
        return _Stretch(values, found.states, turns, forces, largest, ending, is_whole)

    def _place(self, one: _Stretch, k: int) -> Place:
        inputs = self._inputs(one.values[k : k + 1])[:, 0]
        return Place(inputs, one.states[:, k], one.turns[:, k])

    def _look_along(self, one: _Stretch) -> None:
        """Zeros of the force along a stretch."""
        forces, values = one.forces, one.values
        zero = self._is_zero(forces)
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
            elif one.ending is not None and one.ending.is_dead_centre:
                end = float(one.ending.inputs[self.statics.free[0]])
                centre = one.ending.state
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
            found = self.statics.forces(
                self._inputs(np.array([middle])),
                way.states[:, 1:],
                way.turns[:, 1:],
                np.array([self.time]),
            )
            if found.good.all() and self._is_zero(found.forces)[0, 0]:
                still = middle
            else:
                not_now = middle
        return still

    def _is_zero(self, forces: Floats) -> Bools:
        zero: Bools = np.abs(forces) <= tolerances.EQUILIBRIUM_BALANCE * self.largest
        return zero

    def _settle_motions(self) -> None:
        """One equilibrium for each motion along which the loads balance, in place of all that were
        found on it."""
        starts = self.motions.starts
        if not starts:
            return
        self.known.found = [
            one
            for one in self.known.found
            if not self.motions.has(self.balancing.uncharted(self.statics, one.place))
        ]
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

    def _look_across(self, ends: list[_Stretch]) -> None:
        """Zeros of the force between two stretches that meet at a dead centre: there its part along
        the coordinate has a sign on each side, and the same one where it has a zero between."""
        folds = [one for one in ends if one.ending is not None and one.ending.is_dead_centre]
        layout = self.statics.session.layout
        for number, one in enumerate(folds):
            assert one.ending is not None
            for other in folds[number + 1 :]:
                assert other.ending is not None
                state = one.ending.state
                meets = pose_number(
                    layout, other.ending.state[:, None], state, tolerances.SAME_DEAD_CENTRE
                )
                if meets is None or not one.forces.size or not other.forces.size:
                    continue
                if not one.forces[-1] * other.forces[-1] > 0.0:
                    continue
                fold = float(one.ending.inputs[self.statics.free[0]])
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
            told = [f"from {words(low)} to {words(high)}" for low, high in spans[:MOST_SPANS]]
            if len(spans) > MOST_SPANS:
                told.append(f"in {len(spans) - MOST_SPANS} more parts of the window")
            text = f"the loads balance all along {', '.join(told)}"
            notes.append(Diagnostic("indifferent", "note", text, response.place))
        if self.lost:
            text = "a branch of the mechanism could not be followed through the window"
            hint = "equilibria beyond may be missed: name another coordinate in window:"
            at = f"first lost at {words(self.lost[0])}"
            notes.append(
                Diagnostic("window-branch", "warning", text, response.place, at, hint=hint)
            )
        if self.incomplete > 0.0:
            text = (
                "assemblies in the window were searched for from random starts, which may miss some"
            )
            at = f"a chance of at most {self.incomplete:.1g} that one more start finds another"
            notes.append(Diagnostic("window-modes", "note", text, response.place, at))
        return notes


def _none(response: ResponseProblem) -> Diagnostic:
    """That a window has no equilibrium."""
    assert response.search is not None
    names = " and ".join(one.name for one in response.search.window)
    text = f"no place within the window of {names} was found at which the loads balance"
    hint = "widen the window, or look at the forces of a sweep through it"
    return Diagnostic("no-equilibrium", "error", text, response.place, hint=hint)


def _from_starts(
    response: ResponseProblem, balancing: Balancing, statics: Statics, known: Known
) -> list[Diagnostic]:
    """Searches from places spread over the window; how sure it is that they found all."""
    assert response.search is not None
    low, high = known.ends
    base = statics.session.inputs.values[:, 0]
    least = max(response.search.starts, tolerances.WINDOW_STARTS)
    torus = _is_torus(known)
    starts = ended = since = 0
    chance = 1.0
    while starts < tolerances.MOST_WINDOW_STARTS:
        inputs = base.copy()
        inputs[statics.free] = low + (high - low) * _spread(starts, statics.count)
        reduced, _ = statics.reduced(inputs[:, None])
        for state in all_assemblies(statics.session, reduced[:, 0], thorough=False).states.T:
            try:
                place = balancing.charted(statics, statics.place(inputs, state))
            except ValueError:
                continue
            if starts % 2:
                place = settle(balancing, place)
            found = search(balancing, place)
            if found.end is not SearchEnd.FOUND:
                continue
            ended += 1
            since = 0 if known.add(found) else since + 1
        starts += 1
        # as of assemblies: each of the known ones could have been the last that was missing
        pairs = max(len(known.found) * (len(known.found) + 1), 1)
        chance = min(1.0, float(functions.log(pairs / tolerances.SEARCH_DOUBT)) / max(since, 1))
        enough = chance <= tolerances.WINDOW_CHANCE or (not ended and starts >= 4 * least)
        if starts >= least and enough and not (torus and known.excess):
            break
    count = len(known.found)
    text = (
        f"{count} equilibri{'um' if count == 1 else 'a'} found from {starts} starts; with "
        f"{100.0 * (1.0 - tolerances.SEARCH_DOUBT):g} % confidence one more search that ends at "
        f"one finds another with a chance of at most {chance:.1g}"
    )
    if not ended:
        text = f"none of the searches from {starts} starts ended at an equilibrium"
        return [Diagnostic("window-starts", "note", text, response.place)]
    at = f"{ended} searches ended at an equilibrium, the last {since} of them at known ones"
    hint = "ask for more starts: starts: 1000"
    notes = [Diagnostic("window-starts", "note", text, response.place, at, hint=hint)]
    if torus and known.excess:
        # M. Morse: on a torus minima and saddles of even index are as many as those of odd index
        text = "equilibria are missing: over whole turns those of even and of odd index are as many"
        notes.append(Diagnostic("window-missing", "warning", text, response.place, hint=hint))
    return notes


def _is_torus(known: Known) -> bool:
    """Whether the window has every place of an open chain of joints that turn."""
    session, (low, high) = known.balancing.chosen, known.ends
    inputs = session.problem.motion.inputs[: len(known.window)]
    turns = all(turn_of(session.problem, item) is not None for item in inputs)
    wide = bool((high - low >= 2.0 * np.pi - tolerances.SAME_EQUILIBRIUM).all())
    return turns and wide and not session.graph.closings


def _spread(number: int, count: int) -> Floats:
    """A point of the unit cube (count,) that spreads evenly with its number: multiples of powers of
    the root of x^(count+1) = x + 1 (M. Roberts, 2018), which is the golden ratio for one."""
    root, powers = 2.0, [1.0]
    for _ in range(64):  # by Newton
        powers = np.multiply.accumulate([1.0, *[root] * (count + 1)]).tolist()
        root -= (powers[-1] - root - 1.0) / ((count + 1) * powers[-2] - 1.0)
    return np.array([(0.5 + (number + 1) / powers[k + 1]) % 1.0 for k in range(count)])
