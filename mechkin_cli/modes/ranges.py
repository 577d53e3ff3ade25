"""Ranges of an input: from where to where each mode assembles, what ends it, what turns fully, and
which modes belong to one circuit.
"""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly import (
    NamedModes,
    is_home_assembled,
    name_modes,
    nearest_to_home,
    nothing_found,
)
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, UsageError
from mechkin_cli.mechanism import Problem, Wanted, dimension_of
from mechkin_cli.modes.circuits import Branch, Circuit, End, Walker, is_open, joined, undecided
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple, dataclass, replace
from mechkin_cli.search import pose_number
from mechkin_cli.session import (
    Ask,
    RowInputs,
    Session,
    followers_of,
    input_number,
    input_path,
)
from mechkin_cli.show import Floats, Listed, Listing

if TYPE_CHECKING:
    from collections.abc import Sequence


class Limit(NamedTuple):
    """An end of a range in the file's units; `kind` as in `End`."""

    kind: str
    value: float


class OutputExtreme(NamedTuple):
    """A dead centre of an output: its value, and the input's, in the file's units."""

    output: str
    value: float
    input: float


@dataclass(frozen=True)
class Range:
    """The range of one mode of the first row, and the number of its circuit, from 1.

    `turns` after which a fully turning input comes back to this assembly, 0 for one that does not
    turn fully.
    """

    mode: str
    lower: Limit
    upper: Limit
    turns: int
    circuit: int
    extremes: tuple[OutputExtreme, ...]


@dataclass(frozen=True, repr=False)
class Ranges(Listed):
    """Ranges of `input` with all others held as in the first row.

    `circuits` are the modes joined in one circuit: each is reached from the others by moving the
    input to and fro. A warning `circuits-undecided` names those that may be one.
    """

    input: str
    unit: str
    at: dict[str, float]
    ranges: tuple[Range, ...]
    circuits: tuple[tuple[str, ...], ...]
    diagnostics: tuple[Diagnostic, ...]

    @property
    def listing(self) -> Listing:
        """The ranges, a line each, and the dead centres of outputs below them."""
        held = "".join(f", {name} held at {value:.9g}" for name, value in self.at.items())
        rows = tuple(
            (
                item.mode,
                *(
                    "turns fully" if item.turns else f"{end.value:.9g} ({end.kind})"
                    for end in (item.lower, item.upper)
                ),
                str(item.circuit),
            )
            for item in self.ranges
        )
        notes = tuple(
            f"{extreme.output} is extreme in mode {item.mode}: {extreme.value:.9g} at "
            f"{self.input} = {extreme.input:.9g}"
            for item in self.ranges
            for extreme in item.extremes
        )
        unit = f" [{self.unit}]" if self.unit else ""
        labels = ("mode", "from", "to", "circuit")
        return Listing(f"Ranges of {self.input}{unit}{held}", labels, rows, notes)


def find_ranges(session: Session, name: str | None = None, outputs: tuple[str, ...] = ()) -> Ranges:
    """The ranges of the input `name` (the first that the file sweeps), with the extremes of some
    coordinates.

    Modes are those of the first row; where it has none, of the row nearest to an assembled drawing.

    Raises:
        UsageError: no input, or an unknown input or coordinate.
    """
    problem = session.problem
    number = _input_number(problem, name)
    for output in outputs:
        if output not in problem.mechanism.coordinates:
            raise UsageError(
                f"there is no coordinate {output[:LONGEST_NAME]}; coordinates are "
                f"{', '.join(problem.mechanism.coordinates)}"
            )
    path, row = session.inputs.values, 0
    named = name_modes(session, path[:, row])
    if named.number == 0 and is_home_assembled(session):
        row = nearest_to_home(session, path)
        named = name_modes(session, path[:, row])
    item, first = problem.motion.inputs[number], path[:, row]
    leader, moved = _leader(session, number)
    at = {
        i.name: float(i.written[row])
        for i in problem.motion.inputs
        if i is not item and i.name not in moved
    }
    unit = problem.units.label(dimension_of(item.coordinate))
    if named.number == 0:
        note = nothing_found(session, named.found)
        return Ranges(item.name, unit, at, (), (), (*problem.diagnostics, note))
    walker = Walker(session, leader, first, input_path(session, leader, row))
    ranges, circuits = _Survey(session, named, walker, number, outputs).ranges()
    notes = (
        *problem.diagnostics,
        *_leader_note(problem, number, leader),
        *undecided(circuits, item.name),
    )
    return Ranges(item.name, unit, at, ranges, tuple(one.shown for one in circuits), notes)


def _leader(session: Session, number: int) -> tuple[int, set[str]]:
    """The input that moves where the range of `number` is requested, and all that move with it."""
    if not session.problem.motion.paths:
        return number, set()
    names = [item.name for item in session.problem.motion.inputs]
    followers = followers_of(session)
    leader = followers.get(names[number], names[number])
    moved = input_path(session, names.index(leader))
    return names.index(leader), {leader, *(moved.followers if moved else ())}


def _leader_note(problem: Problem, number: int, leader: int) -> list[Diagnostic]:
    if number == leader:
        return []
    name, moved = problem.motion.inputs[number].name, problem.motion.inputs[leader].name
    text = f"{name} follows {moved}, which is moved; values are those of {name} on that way"
    return [Diagnostic("tied-input", "note", text)]


def _input_number(problem: Problem, name: str | None) -> int:
    inputs = problem.motion.inputs
    if not inputs:
        raise UsageError("the file drives no input, so there is no range")
    names = [item.name for item in inputs]
    if name is None:
        swept = [k for k, item in enumerate(inputs) if item.values.min() < item.values.max()]
        return swept[0] if swept else 0
    if name not in names:
        raise UsageError(f"there is no input {name[:LONGEST_NAME]}; inputs are {', '.join(names)}")
    return names.index(name)


def _lost_ends(item: Range) -> int:
    """Ends of a range at which following stopped without a reason."""
    return sum(end.kind == "branch-lost" for end in (item.lower, item.upper))


class _Survey:
    """The circuits of all modes, one after the other; values are those of the input `shown`."""

    def __init__(
        self,
        session: Session,
        named: NamedModes,
        walker: Walker,
        shown: int,
        outputs: Sequence[str],
    ) -> None:
        self.session, self.problem, self.layout = session, session.problem, session.layout
        self.named, self.walker, self.shown = named, walker, shown
        quantities = self.problem.quantities()
        self.outputs = [quantities[name] for name in outputs]

    def ranges(self) -> tuple[tuple[Range, ...], list[Circuit]]:
        """The ranges in the order of the letters, and the circuits."""
        ranges: dict[str, Range] = {}
        circuits: list[Circuit] = []
        for number, letter in self.named.letters.items():
            if letter in ranges:
                continue
            branches = self.walker.circuit(self.named.found.states[:, number])
            members: dict[str, tuple[Branch, float]] = {}
            for branch in branches:
                for value, state in branch.places:
                    mode = pose_number(self.layout, self.named.found.states, state)
                    if mode is not None:
                        members.setdefault(self.named.letters[mode], (branch, value))
            members[letter] = (branches[0], float(self.walker.inputs[self.walker.number]))
            circuits = joined([*circuits, Circuit(frozenset(members), is_open(branches))])
            for name, (branch, value) in members.items():
                known = ranges.get(name)
                if known is None or _lost_ends(known) > 0:
                    seen = self._range(name, branch, value)
                    ranges[name] = min((r for r in (known, seen) if r), key=_lost_ends)
        names = list(self.named.letters.values())
        ordered = sorted(circuits, key=lambda one: min(names.index(name) for name in one.modes))
        number_of = {name: k for k, one in enumerate(ordered, 1) for name in one.modes}
        return tuple(replace(ranges[name], circuit=number_of[name]) for name in names), ordered

    def _range(self, name: str, branch: Branch, value: float) -> Range:
        """The branch's range, in the turn in which it has this mode at `value`."""
        origin, period = float(self.walker.inputs[self.walker.number]), self.walker.period
        shift = value - origin
        extremes = self._extremes(branch, shift)
        if branch.upper.kind == "full-turn" and period is not None:
            limit = self._limit(End("full-turn", origin), 0.0)
            turns = round((branch.upper.value - branch.lower.value) / period)
            return Range(name, limit, limit, turns, 0, extremes)
        lower, upper = (self._limit(end, shift) for end in (branch.lower, branch.upper))
        if self.shown != self.walker.number and lower.value > upper.value:
            # an input that follows may fall while the other rises
            lower, upper = upper, lower
        return Range(name, lower, upper, 0, 0, extremes)

    def _limit(self, end: End, shift: float) -> Limit:
        return Limit(end.kind, self._limit_value(end.value - shift))

    def _extremes(self, branch: Branch, shift: float) -> tuple[OutputExtreme, ...]:
        """Dead centres of the outputs along a branch: where their rate by the input vanishes."""
        extremes = []
        for wanted in self.outputs if branch.places else ():
            for at, value in _Stationary(self, branch, wanted).places():
                output = float(self.problem.units.from_si(value, wanted.dimension))
                extremes.append(OutputExtreme(wanted.name, output, self._limit_value(at - shift)))
        return tuple(extremes)

    def _limit_value(self, value: float) -> float:
        if self.shown != self.walker.number:
            value = float(self.walker.at(np.array([value]))[0, self.shown, 0]) + 0.0
        return input_number(self.problem, self.layout, self.shown, value).value


class _Stationary:
    """Zeros of an output's rate along a branch: signs at many places, then Newton."""

    def __init__(self, survey: _Survey, branch: Branch, wanted: Wanted) -> None:
        self.walker, self.branch = survey.walker, branch
        self.session, known = survey.session, survey.problem.quantities()
        orders = [known[wanted.name + suffix] for suffix in ("", "_dot", "_ddot")]
        self.readout = self.session.readout(orders)
        self.slots = [self.readout.slots[quantity.name].start for quantity in orders]

    def places(self) -> list[tuple[float, float]]:
        """(input, output) in kernel units and SI."""
        start = self.branch.places[0]
        ends = (self.branch.lower.value, self.branch.upper.value)
        places: list[tuple[float, float]] = []
        if not all(isfinite(end) for end in ends):
            return places
        for first, last in ((start.value, ends[0]), (start.value, ends[1])):
            if first == last:
                continue
            parts = np.linspace(0.0, 1.0, tolerances.RANGE_SAMPLES + 1)[:-1]
            steps = first + (last - first) * parts
            followed = self.walker.follow(steps, start.state)
            count = followed.reached
            rates = self._derivatives(steps[:count], followed.guess[:, :count])[1]
            for k in np.flatnonzero(rates[:-1] * rates[1:] <= 0.0):
                place = self._refined(followed.guess[:, k], steps[k], steps[k + 1])
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

    def _refined(self, guess: Floats, first: float, last: float) -> tuple[float, float] | None:
        """Newton within a bracket of the rate's zero, by bisection where it would leave it."""
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
