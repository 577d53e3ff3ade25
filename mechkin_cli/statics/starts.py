"""All equilibria of several freedoms in a window.

Searches start at places spread over the window, in every assembly there, by Newton's steps and, in
turns, down to a stable place. How likely one more start finds another is told, as for assembly
modes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.kernel import functions
from mechkin_cli.plan import home_state
from mechkin_cli.record import NamedTuple
from mechkin_cli.search import free_places
from mechkin_cli.session import lies_in_family, turn_count, turn_of
from mechkin_cli.statics.newton import Balancing, Search, searches, settle
from mechkin_cli.statics.places import Place, Statics

if TYPE_CHECKING:
    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.search import Within
    from mechkin_cli.show import Floats
    from mechkin_cli.statics.forces import FreePlace
    from mechkin_cli.statics.known import Known


def from_starts(
    response: ResponseProblem, balancing: Balancing, statics: Statics, known: Known
) -> list[Diagnostic]:
    """Searches from places spread over the window; how sure it is that they found all."""
    assert response.search is not None
    least = max(response.search.starts, tolerances.WINDOW_STARTS)
    closed: bool | None = None
    places = _Places(balancing, statics, known)
    ended = since = 0
    chance = 1.0
    while places.starts < max(least, tolerances.MOST_WINDOW_STARTS):
        found = [one for one in _searched(balancing, places.next()) if one.found]
        ended += len(found)
        for is_new in known.add_all(found):
            since = 0 if is_new else since + 1
        if found and closed is None:
            closed = _is_closed(known) and known.repeats(found[0])
        # as of assemblies: each of the known ones could have been the last that was missing
        pairs = max(len(known.found) * (len(known.found) + 1), 1)
        chance = min(1.0, float(functions.log(pairs / tolerances.SEARCH_DOUBT)) / max(since, 1))
        if not ended and places.starts >= tolerances.HOPELESS_STARTS:
            break
        enough = places.starts >= least and chance <= tolerances.WINDOW_CHANCE
        if enough and not (closed and _is_odd(known)):
            break
    return _notes(response, known, _Count(places.starts, ended, since, chance), bool(closed))


class _Count(NamedTuple):
    """Starts, searches that ended at an equilibrium, those since the last new one, and the chance
    that one more finds another."""

    starts: int
    ended: int
    since: int
    chance: float


def _notes(response: ResponseProblem, known: Known, told: _Count, closed: bool) -> list[Diagnostic]:
    """How sure it is that all were found."""
    count = len(known.found)
    text = (
        f"{count} equilibri{'um' if count == 1 else 'a'} found from {told.starts} starts; with "
        f"{100.0 * (1.0 - tolerances.SEARCH_DOUBT):g} % confidence one more search that ends at "
        f"one finds another with a chance of at most {told.chance:.1g}"
    )
    if not told.ended:
        text = f"none of the searches from {told.starts} starts ended at an equilibrium"
        return [Diagnostic("window-starts", "note", text, response.place)]
    at = (
        f"{told.ended} searches ended at an equilibrium, the last {told.since} of them at known "
        "ones, or outside the window"
    )
    hint = "ask for more starts: starts: 10000"
    notes = [Diagnostic("window-starts", "note", text, response.place, at, hint=hint)]
    if closed and _is_odd(known):
        text = "equilibria are missing: over whole turns those of even and of odd index are as many"
        if known.balancing.chosen.graph.closings:
            text = (
                "equilibria are missing, or branches of the mechanism cross: over whole turns the "
                "number of equilibria is even"
            )
        notes.append(Diagnostic("window-missing", "warning", text, response.place, hint=hint))
    return notes


def _searched(balancing: Balancing, places: FreePlace) -> list[Search]:
    """Searches from places, some of which first go down: stable places are few, and most are met
    after little of it."""
    if not places.state.shape[1]:
        return []
    some = np.arange(0, places.state.shape[1], tolerances.SETTLED_START)
    lower, _ = settle(balancing, places.at(some))
    for array, new in zip(places, lower, strict=True):
        array[..., some] = new
    return searches(balancing, places)


class _Places:
    """Places spread over the window, a batch of them after the other.

    Of an open chain values of the coordinates spread evenly. Loops close at few of them: random
    starts with the coordinates free end at places in the window or near it, in every assembly.
    """

    def __init__(self, balancing: Balancing, statics: Statics, known: Known) -> None:
        self.balancing, self.statics = balancing, statics
        self.free = balancing.forces.session
        self.low, self.high = known.ends
        self.starts = 0
        self._generator = functions.RandomStarts()

    def next(self) -> FreePlace:
        """The next places, with charts about them."""
        count = tolerances.WINDOW_BATCH
        session, numbers = self.statics.session, self.statics.free
        slots = [session.layout.state(*session.graph.inputs[k]) for k in numbers]
        if any(block.closings for block in self.free.graph.blocks):
            states = free_places(self.free, self._box(slots), self._generator, count)
            states[slots] = self._in_some_turn(states[slots])
        else:
            states = np.repeat(home_state(self.free.layout)[:, None], count, axis=1)
            spread = [_spread(self.starts + k, len(slots)) for k in range(count)]
            states[slots] = self.low[:, None] + (self.high - self.low)[:, None] * np.array(spread).T
        self.starts += count
        inputs = np.repeat(session.inputs.values[:, :1], states.shape[1], axis=1)
        inputs[numbers] = states[slots]
        reduced, _ = self.statics.reduced(inputs)
        batch = session.close(reduced, states)
        good = batch.good
        if session.problem.stopped:
            good = good & lies_in_family(session, reduced[:, 0], batch.states)
        turns = np.zeros((turn_count(session.plan), states.shape[1]))
        places = Place(inputs[:, good], batch.states[:, good], turns[:, good])
        charted, regular = self.balancing.charted_each(self.statics, places)
        charted = charted.at(regular)
        # angles of cut joints are within half a turn of the drawing
        still = np.zeros((self.statics.count, charted.state.shape[1]))
        return charted._replace(turns=self.balancing.forces.at(charted, still).turns)

    def _in_some_turn(self, values: Floats) -> Floats:
        """Values (free, places) of angles, each in one of the turns of the window that have it."""
        turned = values.copy()
        for k, number in enumerate(self.statics.free):
            if not self.statics.cyclic[number]:
                continue
            first = values[k] + 2.0 * np.pi * np.ceil((self.low[k] - values[k]) / (2.0 * np.pi))
            more = np.maximum(np.floor((self.high[k] - first) / (2.0 * np.pi)), 0.0)
            some = np.floor(self._generator.fractions(first.size) * (more + 1.0))
            turned[k] = first + 2.0 * np.pi * some
        return turned

    def _box(self, slots: list[int]) -> Within:
        """Where random starts are taken: the coordinates within the window."""
        centre, radius = (np.full(self.free.layout.states, x) for x in (0.0, np.inf))
        centre[slots] = 0.5 * (self.low + self.high)
        radius[slots] = 0.5 * (self.high - self.low)
        return centre, radius


def _is_closed(known: Known) -> bool:
    """Whether the window has every place of a mechanism whose places are a closed manifold: all
    joints of its tree turn."""
    chosen, (low, high) = known.balancing.chosen, known.ends
    inputs = chosen.problem.motion.inputs[: len(known.window)]
    turns = all(turn_of(chosen.problem, item) is not None for item in inputs)
    wide = bool((high - low >= 2.0 * np.pi - tolerances.SAME_EQUILIBRIUM).all())
    parts = [carrier.part for carrier in known.balancing.forces.session.layout.carriers]
    bounded = all(
        part.track is None
        and (part.type.is_ball or all(freedom.is_cyclic for freedom in part.type.freedoms))
        for part in parts
    )
    return turns and wide and bounded


def _is_odd(known: Known) -> bool:
    """Whether equilibria are missing on a closed manifold.

    M. Morse: those with an even and those with an odd number of unstable directions differ by its
    Euler characteristic. That of a torus, and of all in odd dimensions, is zero; that of regular
    loops is even, since equations in the coordinates of a tree have a trivial normal bundle.
    """
    chosen = known.balancing.chosen
    if chosen.graph.closings and known.balancing.forces.freedoms % 2 == 0:
        return bool(known.excess % 2)
    return known.excess != 0


def _spread(number: int, count: int) -> Floats:
    """A point of the unit cube (count,) that spreads evenly with its number: multiples of powers of
    the root of x^(count+1) = x + 1 (M. Roberts, 2018), which is the golden ratio for one."""
    root, powers = 2.0, [1.0]
    for _ in range(64):  # by Newton
        powers = np.multiply.accumulate([1.0, *[root] * (count + 1)]).tolist()
        root -= (powers[-1] - root - 1.0) / ((count + 1) * powers[-2] - 1.0)
    return np.array([(0.5 + (number + 1) / powers[k + 1]) % 1.0 for k in range(count)])
