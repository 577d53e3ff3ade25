"""Circuits: all that a mechanism reaches by moving one input to and fro, without taking it apart.

A branch is followed up and down from a place. Where it folds, the motion goes on along the branch
on the other side of the dead centre, with the input turning back; so branch after branch, until the
first one comes again or something else ends the walk (`Walker`). Modes that share a branch are in
one circuit (`joined`); where a walk is lost, that two circuits differ is not known (`undecided`).
Along a branch, `Stationary` finds the dead centres of outputs.
"""

from __future__ import annotations

from math import isfinite, pi, sqrt
from typing import TYPE_CHECKING, Literal

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.kernel.functions import RandomStarts
from mechkin_cli.mobility import lost_holds
from mechkin_cli.plan import Demand, TrackEnd
from mechkin_cli.record import NamedTuple, dataclass, field
from mechkin_cli.search import pose_number
from mechkin_cli.session import Ask, Ending, RowInputs, Runaway, find_limit

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.mechanism import LockedFreedom, Wanted
    from mechkin_cli.session import Followed, InputPath, Session
    from mechkin_cli.show import Floats

EndKind = Literal[
    "dead-centre",
    "branch-point",
    "hold-ends",
    "unbounded",
    "branch-lost",
    "full-turn",
    "far",
    "limit",
    "nowhere",
]


class End(NamedTuple):
    """Where a branch ends: the input there (kernel units), and what may lie beyond.

    `hold-ends`: a coordinate that holds an idle freedom cannot be kept beyond it, where the
    mechanism itself is regular; `unbounded`: a slide grew out of bounds before it; `full-turn`: it
    came to an assembly that was met before, turns ago; `far`: not found within the reach that is
    looked over; `limit`: a coordinate comes to its limit; `nowhere`: along the whole branch one is
    beyond it.
    """

    kind: EndKind
    value: float
    fold: Ending | None = None


Passage = tuple[float, "Floats"]
"""The value of the input and the states (states,) where it has its first value, or whole turns
more."""


@dataclass
class Branch:
    """A stretch of one input between two ends, with the places where it passes the first value."""

    lower: End
    upper: End
    places: list[Passage] = field(default_factory=list)


def is_open(branches: Sequence[Branch]) -> bool:
    """Whether a walk through branches may have missed some of their circuit: one could not be
    followed to its end, or there are too many."""
    lost = any("branch-lost" in (one.lower.kind, one.upper.kind) for one in branches)
    return lost or len(branches) > tolerances.MOST_BRANCHES


class Walker:
    """Walks along the branches of one input; the other inputs are held, or follow it.

    Args:
        session: the mechanism as it is driven.
        number: the input that moves.
        inputs: (inputs,) where places are taken.
        path: all inputs along it, where some follow it.
    """

    def __init__(
        self, session: Session, number: int, inputs: Floats, path: InputPath | None = None
    ) -> None:
        self.session, self.number, self.inputs, self.path = session, number, inputs, path
        layout = session.layout
        edge, freedom = layout.graph.inputs[number]
        joint = layout.graph.edges[edge].joint
        self.lost_holds: dict[str, LockedFreedom] = {}
        counts = any(joint.counted for joint in session.problem.mechanism.joints.values())
        self.most = tolerances.MOST_COUPLED_TURNS if counts else tolerances.MOST_TURNS
        self.period = 2.0 * pi if joint.type.chain[freedom].motion == "turn" else None

    def circuit(self, state: Floats) -> list[Branch]:
        """All branches of the circuit through an assembly at the first value, that one first."""
        origin = float(self.inputs[self.number])
        start = origin, state
        upper, above = self._climb(start, 1.0, start)
        beside = None if upper.kind != "branch-lost" or above else self._beside(state)
        if beside is not None:
            start = beside
            upper, above = self._climb(start, 1.0, start, is_beside=True)
        if upper.kind == "full-turn":
            return [Branch(upper._replace(value=origin), upper, [start, *above])]
        lower, below = self._climb(start, -1.0, start, is_beside=beside is not None)
        first = Branch(lower, upper, [*below[::-1], start, *above])
        onward, closed = self._walk(first, upper, 1.0)
        if closed:
            return [first, *onward]
        backward, _ = self._walk(first, lower, -1.0)
        return [first, *onward, *backward]

    def _beside(self, state: Floats) -> Passage | None:
        """A place next to an assembly that stands exactly at a dead centre, from which no step is
        sure; None where none is found."""
        origin, off = float(self.inputs[self.number]), tolerances.BESIDE_DEAD_CENTRE
        # next to a dead centre places go with the root of the way to it
        sizes = sqrt(off) * np.array(tolerances.BESIDE_DEAD_CENTRE_GUESSES)
        values = origin + np.repeat([off, -off], sizes.size)
        moves = RandomStarts().between(1.0, state.size * values.size).reshape(state.size, -1)
        guesses = state[:, None] + np.tile(sizes, 2) * moves
        batch = self.session.run(RowInputs(self.at(values)[0], guesses), Ask())
        for k in np.flatnonzero(batch.good):
            found = np.ascontiguousarray(batch.states[:, k])
            if self._is_same(found, state, tolerances.MOST_BESIDE_DEAD_CENTRE):
                return float(values[k]), found
        return None

    def end(self, start: Passage, direction: float) -> End:
        """Where the branch through a place ends in a direction."""
        return self._climb(start, direction, start)[0]

    def _walk(self, first: Branch, end: End, direction: float) -> tuple[list[Branch], bool]:
        """The branches beyond an end of the first one; whether they lead back to its other end."""
        walked: list[Branch] = []
        goal = first.lower if direction > 0.0 else first.upper
        while end.fold is not None and len(walked) < tolerances.MOST_BRANCHES:
            start = float(end.fold.inputs_beyond[self.number]), end.fold.beyond
            direction = -direction
            far, places = self._climb(start, direction, None)
            places = [*self._back_to(end, start, direction), *places]
            ends = (end, far) if direction > 0.0 else (far, end)
            walked.append(Branch(*ends, places if direction > 0.0 else places[::-1]))
            if far.fold is not None and goal.fold is not None:
                states = far.fold.state, goal.fold.state
                if self._is_same(*states, tolerances.SAME_DEAD_CENTRE):
                    return walked, True
            end = far
        return walked, False

    def _back_to(self, fold: End, start: Passage, direction: float) -> list[Passage]:
        """The place between a dead centre and the first place of the branch beyond it."""
        begin, state = start
        value = self._next(begin, -direction, here=True)
        if (fold.value - value) * -direction <= 0.0:
            return []
        if value == begin:
            return [start]
        followed = self.follow(np.array([begin, value]), state)
        return [(value, followed.state)] if followed.end == TrackEnd.FINISHED else []

    def _climb(
        self,
        start: Passage,
        direction: float,
        first: Passage | None,
        *,
        is_beside: bool = False,
    ) -> tuple[End, list[Passage]]:
        """Follows a branch in a direction to its end; the places passed. From
        beside a dead centre at the first value it goes on beyond that: no step ends in it."""
        value, state = start
        places: list[Passage] = []
        for _ in range(self.most):
            target = self._next(value, direction)
            if is_beside and value == start[0] and target == self.inputs[self.number]:
                target = self._next(target, direction)
            followed = self.follow(np.array([value, target]), state)
            if followed.end != TrackEnd.FINISHED:
                limit = find_limit(self.session, followed)
                return self._end_at(followed, limit), places
            value, state = target, followed.state
            if self.period is None and target != self.inputs[self.number]:
                return End("far", target), places
            if first is not None and self._is_same(state, first[1]):
                return End("full-turn", target), places
            places.append((value, state))
        return End("far", value), places

    def _end_at(self, followed: Followed, limit: Ending | Runaway | None) -> End:
        """The end at which following stopped."""
        at = limit if isinstance(limit, Ending) else followed
        held = lost_holds(self.session, at.inputs, at.state)
        self.lost_holds |= {one.name: one for one in held}
        value = float(at.inputs[self.number])
        fold = limit if isinstance(limit, Ending) and limit.is_dead_centre else None
        kind: EndKind = "dead-centre" if fold else "branch-point"
        if held:
            kind = "hold-ends"
        elif not isinstance(limit, Ending):
            kind = "unbounded" if limit else "branch-lost"
        return End(kind, value, fold)

    def follow(self, values: Floats, state: Floats) -> Followed:
        """The branch through a state along values of the input."""
        if self.path is not None:
            return self.session.follow_way(self.path.way(values), state)
        return self.session.follow(np.ascontiguousarray(self.at(values)[0]), state)

    def at(self, values: Floats) -> Floats:
        """All inputs, and first and second derivatives by the one that moves, (3, inputs,
        places)."""
        if self.path is not None:
            return self.path.derivatives(values)
        inputs = np.zeros((3, self.inputs.size, values.size))
        inputs[0] = self.inputs[:, None]
        inputs[0, self.number], inputs[1, self.number] = values, 1.0
        return inputs

    def _next(self, value: float, direction: float, *, here: bool = False) -> float:
        """The next value in a direction at which a place is taken, or the end of the reach; `here`:
        the value itself if it is one.

        Values are compared as they are: a range may be narrower than any tolerance.
        """
        origin = float(self.inputs[self.number])

        def is_ahead(place: float) -> bool:
            return (place - value) * direction > 0.0 or (here and place == value)

        if self.period is None:
            return origin if is_ahead(origin) else value + direction * tolerances.FAR_INPUT
        whole = float(np.floor((value - origin) / self.period * direction)) - 1.0
        while not is_ahead(origin + direction * whole * self.period):
            whole += 1.0
        return origin + direction * whole * self.period

    def _is_same(self, one: Floats, other: Floats, limit: float = tolerances.SAME_MODE) -> bool:
        return pose_number(self.session.layout, one[:, None], other, limit) is not None


Circuit = tuple[frozenset[str], bool]
"""Modes that are reached from one another, and whether others may be reached, too: no walk through
them came to all of its ends."""


def joined(circuits: Sequence[Circuit]) -> list[Circuit]:
    """Circuits that share a mode with the last are one with it: a walk may end early on one side of
    a narrow place and get through from the other, and one that came to all ends knows them all."""
    *before, (modes, open_) = circuits
    apart = [one for one in before if not one[0] & modes]
    same = [one for one in before if one[0] & modes]
    return [
        *apart,
        (modes.union(*(others for others, _ in same)), open_ and all(other for _, other in same)),
    ]


def undecided(circuits: Sequence[Circuit], name: str) -> list[Diagnostic]:
    """A warning that circuits may be one: those of which no walk came to all ends; a closed one has
    no part in the others."""
    numbers = [str(number) for number, (_, open_) in enumerate(circuits, 1) if open_]
    if len(numbers) < 2:
        return []
    *first, last = numbers
    text = (
        f"whether circuits {', '.join(first)} and {last} are one is not known: moving {name}, a "
        "branch of each could not be followed to its end"
    )
    hint = "begin at another value of it"
    return [Diagnostic("circuits-undecided", "warning", text, hint=hint)]


class Stationary:
    """Zeros of an output's rate along branches: signs at many places, then Newton."""

    def __init__(self, walker: Walker, wanted: Wanted) -> None:
        self.walker = walker
        self.session, known = walker.session, walker.session.problem.quantities()
        orders = [known[wanted.name + suffix] for suffix in ("", "_dot", "_ddot")]
        self.readout = self.session.readout(orders)
        self.slots = [self.readout.slots[quantity.name].start for quantity in orders]

    def places(self, branch: Branch) -> list[tuple[float, float]]:
        """(input, output) in kernel units and SI, along a branch."""
        begin, state = branch.places[0]
        ends = (branch.lower.value, branch.upper.value)
        places: list[tuple[float, float]] = []
        if not all(isfinite(end) for end in ends):
            return places
        for first, last in ((begin, ends[0]), (begin, ends[1])):
            if first == last:
                continue
            parts = np.linspace(0.0, 1.0, tolerances.RANGE_SAMPLES + 1)[:-1]
            steps = first + (last - first) * parts
            followed = self.walker.follow(steps, state)
            count = followed.reached
            rates = self._derivatives(steps[:count], followed.guess[:, :count])[1]
            for k in np.flatnonzero(rates[:-1] * rates[1:] <= 0.0):
                place = self.between(followed.guess[:, k], steps[k], steps[k + 1])
                if place is not None and not any(place[0] == other[0] for other in places):
                    places.append(place)
        return sorted(places)

    def _derivatives(self, values: Floats, guess: Floats) -> Floats:
        """The output and its first two derivatives by the input, (3, places)."""
        inputs, rates, accelerations = np.ascontiguousarray(self.walker.at(values))
        rows = RowInputs(inputs, guess, rates, accelerations)
        ask = Ask(Demand.VELOCITY | Demand.ACCELERATION, self.readout)
        batch = self.session.run(rows, ask)
        assert batch.outputs is not None
        return batch.outputs[self.slots]

    def between(self, guess: Floats, first: float, last: float) -> tuple[float, float] | None:
        """The zero (input, output) of a rate that changes its sign between two inputs, the first
        with the state (states,) `guess`: by Newton, or by bisection where that would leave the
        bracket; None where it does not converge."""
        low, high = min(first, last), max(first, last)
        value = 0.5 * (low + high)
        sign_low: float | None = None
        for _ in range(tolerances.DEAD_CENTRE_ITERATIONS):
            places = np.array([first, value])
            state = self.walker.follow(places, guess).state
            output, rate, bend = self._derivatives(places[1:], state[:, None])[:, 0].tolist()
            if sign_low is None:
                ends = self._derivatives(places[:1], guess[:, None])[1, 0]
                sign_low = float(ends) if first == low else -float(ends)
            low, high = (value, high) if rate * sign_low > 0.0 else (low, value)
            step = -rate / bend if bend != 0.0 else np.inf
            following = value + step
            if not low < following < high:
                following = 0.5 * (low + high)
            if abs(following - value) <= tolerances.DEAD_CENTRE_STEP:
                return following, output
            value = following
        return None
