"""All assembly modes, and the ranges of an input in which they assemble.

Modes (`find_modes`): at the first row, or at other inputs with the first row's letters. Letters
belong to the first row. Elsewhere a mode has the letter of the first row's mode whose branch,
followed along the straight path of the inputs, arrives there; one that no branch reaches has the
name `-`.

Ranges (`find_ranges`): from where to where each mode assembles, what ends it, what turns fully, and
which modes belong to one circuit.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import nan
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly import (
    NamedModes,
    choose_start,
    is_cyclic,
    is_home_assembled,
    name_modes,
    nearest_to_home,
    nothing_found,
    probe_of,
    state_at_first_row,
    telling_points,
    wrapped,
)
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, UsageError
from mechkin_cli.mechanism import Problem, dimension_of
from mechkin_cli.mobility import hold_ends
from mechkin_cli.modes.circuits import (
    Branch,
    Circuit,
    End,
    Stationary,
    Walker,
    is_open,
    joined,
    undecided,
)
from mechkin_cli.modes.limits import LimitedWalk, LimitsMet, beyond_notes, limited_ends
from mechkin_cli.plan import TrackEnd
from mechkin_cli.proofs import ModeProofs, prove_modes
from mechkin_cli.record import NamedTuple, dataclass, replace
from mechkin_cli.search import Assemblies, all_assemblies, pose_number, with_assemblies
from mechkin_cli.session import (
    KernelInputs,
    Session,
    followers_of,
    input_number,
    input_numbers,
    input_path,
    input_text,
    kernel_inputs,
    turn_of,
)
from mechkin_cli.show import Floats, Listed, Listing
from mechkin_cli.units import LENGTH

if TYPE_CHECKING:
    from collections.abc import Sequence


UNNAMED = "-"
"""Name of a mode that no branch from the first row reaches."""


class Mode(NamedTuple):
    """One assembly; coordinates in the file's units, angles in (-180, 180] degrees but
    for threads.

    Where coordinates tell not all modes apart, as with ball joints, which have none, `places` has
    those of joints' points that do: their components in ground axes, `A.point.x`, file's units.
    """

    name: str
    coordinates: dict[str, float]
    residual: float
    condition: float
    places: dict[str, float]

    @property
    def numbers(self) -> dict[str, float]:
        """What tells it from others: coordinates and places."""
        return self.coordinates | self.places


@dataclass(frozen=True, repr=False)
class Modes(Listed):
    """The assembly modes at `inputs` (file's units) and how the search went.

    `picked` is the name of the mode that the file's `assembly:` takes, None where it takes none or
    its branch does not come here. `closed` of `starts` random starts closed; that one more that
    closes finds another mode has a chance of at most `chance`, with confidence `confidence`;
    `stopped`: the search ended at its most starts before that chance was small. `complete`: these
    are all modes, proven: as many as such loops have at most (`bound`, if one is known), or as the
    loops' equations have real roots; `is_cut`: there are more than are listed. `turns` are the
    turns of threads searched to either side, None without threads. `proofs` of the modes' existence
    are in the order of `modes`, where they were requested.
    """

    modes: tuple[Mode, ...]
    inputs: dict[str, float]
    picked: str | None
    starts: int
    closed: int
    chance: float
    confidence: float
    stopped: bool
    complete: bool
    is_cut: bool
    bound: int | None
    turns: int | None
    diagnostics: tuple[Diagnostic, ...]
    proofs: ModeProofs | None = None

    @property
    def listing(self) -> Listing:
        """The modes, a line each, with what is known of their completeness."""
        place = ", ".join(f"{name} = {value:.9g}" for name, value in self.inputs.items())
        head = f"Modes{' at ' if place else ''}{place}: {self.sentence}"
        if not self.modes:
            return Listing(head)
        names = tuple(self.modes[0].numbers)
        rows = tuple(
            (
                f"{mode.name}{'*' if mode.name == self.picked else ''}",
                *(f"{mode.numbers[name]:.6g}" for name in names),
                f"{mode.residual:.1e}",
            )
            for mode in self.modes
        )
        notes = [f"* mode {self.picked} is the one that the file takes"] if self.picked else []
        notes += [f"proofs: {self.proofs.sentence}"] if self.proofs is not None else []
        return Listing(head, ("mode", *names, "residual"), rows, tuple(notes))

    @property
    def sentence(self) -> str:
        """What is known of completeness."""
        count = len(self.modes)
        noun = "mode" if count == 1 else "modes"
        if not self.starts and not self.complete:
            return f"{count} {noun}: without loops there is no other"
        if self.complete and not count:
            return "no mode: the equations of a loop have no real root"
        if self.complete and count == self.bound:
            return f"{count} {noun}: all, no loop of these pairs has more"
        if self.complete:
            return f"{count} {noun}: all, the loops' equations have no other real root"
        if self.is_cut:
            return f"{count} {noun} listed of many more"
        known = f", no loop of these pairs has more than {self.bound}" if self.bound else ""
        if not count:
            text = "no mode found: the random starts of a loop did not close, with "
            text += f"{100.0 * self.confidence:g} % confidence one more does with a chance of at "
            return text + f"most {self.chance:.1g}"
        text = f"{count} {noun} found{known}; {self.closed} of {self.starts} random starts closed, "
        text += f"with {100.0 * self.confidence:g} % confidence one more that closes finds another "
        text += f"with a chance of at most {self.chance:.1g}"
        if self.turns is not None:
            text += f"; what counts its turns within {self.turns}.5 of them to either side"
        return text


def find_modes(
    session: Session, at: Mapping[str, float] | None = None, *, certify: bool = False
) -> Modes:
    """The assembly modes at the first row, or with the inputs `at` (by name, in the file's units)
    in place of the values there; with proofs if they are to be certified."""
    layout = session.layout
    # an assembly is the same whole turns of an input away; a way to it is not
    first = session.inputs.reduced[:, 0]
    named = name_modes(session, first)
    start = choose_start(session)
    state = state_at_first_row(session, start)
    chosen = None if state is None else pose_number(layout, named.found.states, state)
    letter = UNNAMED if chosen is None else named.letters[chosen]
    if at is None:
        notes = start.diagnostics
        names = [named.letters[i] for i in range(named.number)]
        return _result(session, first, {}, named.found, names, letter, notes, certify)
    inputs = _inputs_at(session, at)
    way = np.stack([session.inputs.values[:, 0], inputs.values[:, 0]], axis=1)
    ends, notes = _follow_all(session, way, named)
    place = inputs.reduced[:, 0]
    assemblies = all_assemblies(session, place)
    if ends:
        states = np.stack([*ends.values()], axis=1)
        assemblies = with_assemblies(layout, session.plan, place, assemblies, states)
    if assemblies.number == 0:
        notes = [nothing_found(session, assemblies, "there")]
    names = [UNNAMED] * assemblies.number
    for name, end in ends.items():
        number = pose_number(layout, assemblies.states, end)
        if number is not None:
            names[number] = name
    return _result(session, place, at, assemblies, names, letter, notes, certify)


def _inputs_at(session: Session, at: Mapping[str, float]) -> KernelInputs:
    """The inputs of the first row with those `at` in their place, in all rows."""
    problem = session.problem
    inputs = []
    for item in problem.motion.inputs:
        written = item.written_orders.copy()
        written[0] = at.get(item.name, item.written[0])
        values = problem.units.to_si(written[0].copy(), dimension_of(item.coordinate))
        inputs.append(item._replace(values=np.asarray(values), written_orders=written))
    changed = replace(problem, motion=problem.motion._replace(inputs=tuple(inputs)))
    return kernel_inputs(changed, session.layout)


def _follow_all(
    session: Session, path: Floats, named: NamedModes
) -> tuple[dict[str, Floats], list[Diagnostic]]:
    """States by letter of the branches that arrive at the path's end, from the first row's modes at
    its beginning; a note for each that does not."""
    ends: dict[str, Floats] = {}
    notes = []
    for number, letter in named.letters.items():
        followed = session.follow(path, named.found.states[:, number])
        if followed.end == TrackEnd.FINISHED:
            ends[letter] = followed.state
            continue
        places = input_numbers(session.problem, session.layout, followed.inputs)
        notes.append(
            Diagnostic(
                "branch-ends",
                "note",
                f"mode {letter} of the first row ends on the way",
                measured=f"followed up to {', '.join(map(input_text, places))}",
                numbers=places,
            )
        )
    return ends, notes


def _result(
    session: Session,
    place: Floats,
    at: Mapping[str, float],
    assemblies: Assemblies,
    names: list[str],
    letter: str,
    notes: list[Diagnostic],
    certify: bool,
) -> Modes:
    problem = session.problem
    notes = [*notes, *_search_notes(assemblies), *_family_notes(problem)]
    inputs = {
        # a tie by a negative factor has -0
        item.name: at.get(item.name, float(item.written[0])) + 0.0
        for item in problem.motion.inputs
    }
    probe = probe_of(session)
    found, points = probe.read(place, assemblies.states)
    coordinates = {name: found[name] for name in problem.mechanism.coordinates}
    telling = telling_points(coordinates, points)
    axes = "xy" if problem.mechanism.plane else "xyz"
    order = sorted(
        range(assemblies.number), key=lambda i: (names[i] == UNNAMED, len(names[i]), names[i])
    )
    shown = {n: _shown(problem, inputs, n, values) for n, values in coordinates.items()}
    modes = tuple(
        Mode(
            names[i],
            {name: values[i] for name, values in shown.items()},
            float(assemblies.residual[i]),
            float(assemblies.condition[i]),
            {
                f"{probe.joints[k]}.point.{axis}": float(problem.units.from_si(value, LENGTH))
                for k in telling
                for axis, value in zip(axes, points[k, :, i].tolist(), strict=False)
            },
        )
        for i in order
    )
    beyond = beyond_notes(
        problem,
        [names[i] for i in order],
        {name: values[order] for name, values in coordinates.items()},
        session.layout.length,
    )
    threads = any(joint.type.counts_turns for joint in problem.mechanism.joints.values())
    return Modes(
        modes=modes,
        inputs=inputs,
        picked=letter if letter != UNNAMED and letter in names else None,
        starts=assemblies.starts,
        closed=assemblies.closed,
        chance=assemblies.chance,
        confidence=1.0 - tolerances.SEARCH_DOUBT,
        stopped=assemblies.stopped,
        complete=bool(session.graph.blocks) and assemblies.complete,
        is_cut=assemblies.cut,
        bound=assemblies.bound,
        turns=problem.assembly.turns if threads else None,
        diagnostics=(*problem.diagnostics, *notes, *beyond),
        proofs=prove_modes(session, place, assemblies.states[:, order]) if certify else None,
    )


def _shown(problem: Problem, inputs: Mapping[str, float], name: str, values: Floats) -> list[float]:
    """Values (assemblies,) of a coordinate in the file's units; that of an input as the file or the
    caller has it."""
    turned = wrapped(values) if is_cyclic(problem.mechanism, name) else values
    shown = problem.units.from_si(turned, dimension_of(name.rpartition(".")[2]))
    if name in inputs:
        shown = np.where(turned == values, inputs[name], shown)
    found: list[float] = shown.tolist()
    return found


def _family_notes(problem: Problem) -> list[Diagnostic]:
    """Of which motion the modes are, where several motions have assemblies."""
    words = "; ".join(dict.fromkeys(one.words for one in problem.stopped))
    text = f"{words}: the modes are those of the motion in which it rests, others are not sought"
    hint = "mobility tells which motions meet"
    return [Diagnostic("family-modes", "note", text, hint=hint)] if words else []


def _search_notes(assemblies: Assemblies) -> list[Diagnostic]:
    notes = []
    if assemblies.free and assemblies.number:
        notes.append(
            Diagnostic(
                "free-assembly",
                "note",
                "some starts ended where the loops still move with the inputs held, or in a "
                "singular position; these are not listed",
                measured=f"{assemblies.free} of {assemblies.starts} starts",
            )
        )
    if assemblies.stopped and assemblies.cut:
        notes.append(
            Diagnostic(
                "search-stopped",
                "warning",
                "the loops have more modes together than are listed",
                measured=f"{assemblies.number} listed, nearest to the drawing",
                hint="ask for parts of the mechanism, or choose the assembly with assembly: near",
            )
        )
    elif assemblies.stopped:
        notes.append(
            Diagnostic(
                "search-stopped",
                "warning",
                "the search ended at its most starts, or modes, before it could tell that few are "
                "left",
                measured=f"{assemblies.starts} starts, a chance of at most {assemblies.chance:.1g} "
                "that one more finds a new mode",
                limit=f"{tolerances.SEARCH_NEW_MODE_CHANCE:g}",
                hint="more modes may exist; fewer turns under assembly: leave fewer for threads",
            )
        )
    return notes


class Limit(NamedTuple):
    """An end of a range in the file's units; `kind` as in `End`, `nowhere` has the value nan."""

    kind: str
    value: float

    @property
    def words(self) -> str:
        """Its value and its kind."""
        return self.kind if self.kind == "nowhere" else f"{self.value:.9g} ({self.kind})"


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
                *("turns fully" if item.turns else end.words for end in (item.lower, item.upper)),
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
    path, row = session.inputs.reduced, 0
    named = name_modes(session, path[:, row])
    if named.number == 0 and is_home_assembled(session):
        row = nearest_to_home(session, path)
        named = name_modes(session, path[:, row])
    item = problem.motion.inputs[number]
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
    way = input_path(session, leader, row)
    # inputs that follow others do so with their whole turns
    first = path[:, row] if way is None else session.inputs.values[:, row]
    walker = Walker(session, leader, first, way)
    left_out = 0.0 if way else float(session.inputs.whole[number, row])
    survey = _Survey(session, named, walker, number, left_out, outputs)
    ranges, circuits = survey.ranges()
    # in the order of the letters: A, B, ..., AA
    shown = tuple(tuple(sorted(modes, key=lambda m: (len(m), m))) for modes, _ in circuits)
    notes = (
        *problem.diagnostics,
        *_leader_note(problem, number, leader),
        *undecided(circuits, item.name),
        *_hold_notes(walker),
        *survey.met.notes(list(named.letters.values())),
    )
    return Ranges(item.name, unit, at, ranges, shown, notes)


def _hold_notes(walker: Walker) -> list[Diagnostic]:
    """That ends of ranges are those of what holds idle freedoms, and not of the mechanism."""
    if not walker.lost_holds:
        return []
    text, hint = hold_ends(walker.lost_holds.values())
    return [Diagnostic("hold-ends", "warning", text, hint=hint)]


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
    """The circuits of all modes, one after the other; values are those of the input `shown`, which
    stands the whole `turns` farther than the walker has it."""

    def __init__(
        self,
        session: Session,
        named: NamedModes,
        walker: Walker,
        shown: int,
        turns: float,
        outputs: Sequence[str],
    ) -> None:
        self.session, self.problem, self.layout = session, session.problem, session.layout
        self.named, self.walker, self.shown = named, walker, shown
        turn = turn_of(self.problem, self.problem.motion.inputs[shown])
        self.farther = turns * float(turn) if turn else 0.0
        quantities = self.problem.quantities()
        self.outputs = [quantities[name] for name in outputs]
        known = self.problem.quantities()  # without plays that a sweep stands amid
        self.limited = [
            LimitedWalk(walker, each) for each in self.problem.limits if each.name in known
        ]
        self.met = LimitsMet()

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
            circuits = joined([*circuits, (frozenset(members), is_open(branches))])
            for name, (branch, value) in members.items():
                known = ranges.get(name)
                if known is None or _lost_ends(known) > 0:
                    seen = self._range(name, branch, value)
                    ranges[name] = min((r for r in (known, seen) if r), key=_lost_ends)
        names = list(self.named.letters.values())
        ordered = sorted(circuits, key=lambda one: min(map(names.index, one[0])))
        number_of = {name: k for k, (modes, _) in enumerate(ordered, 1) for name in modes}
        return tuple(replace(ranges[name], circuit=number_of[name]) for name in names), ordered

    def _range(self, name: str, branch: Branch, value: float) -> Range:
        """The branch's range, in the turn in which it has this mode at `value`."""
        origin, period = float(self.walker.inputs[self.walker.number]), self.walker.period
        shift = value - origin
        extremes = self._extremes(branch, shift)
        ends = self._within_limits(name, branch, value)
        if ends is None and branch.upper.kind == "full-turn" and period is not None:
            limit = self._limit(End("full-turn", origin), 0.0)
            turns = round((branch.upper.value - branch.lower.value) / period)
            return Range(name, limit, limit, turns, 0, extremes)
        lower, upper = (self._limit(end, shift) for end in ends or (branch.lower, branch.upper))
        if self.shown != self.walker.number and lower.value > upper.value:
            # an input that follows may fall while the other rises
            lower, upper = upper, lower
        return Range(name, lower, upper, 0, 0, extremes)

    def _within_limits(self, name: str, branch: Branch, value: float) -> tuple[End, End] | None:
        """The ends of a branch about a place where limits of coordinates end it; None where they do
        not."""
        start = next((place for place in branch.places if place[0] == value), None)
        if start is None or not self.limited:
            return None
        ends = branch.lower, branch.upper
        if branch.upper.kind == "full-turn":
            turned = branch.upper.value - branch.lower.value
            ends = End("far", value - turned), End("far", value + turned)
        found = limited_ends(name, self.limited, start, ends, self.met)
        return found if found != ends else None

    def _limit(self, end: End, shift: float) -> Limit:
        value = nan if end.kind == "nowhere" else self._limit_value(end.value - shift)
        return Limit(end.kind, value)

    def _extremes(self, branch: Branch, shift: float) -> tuple[OutputExtreme, ...]:
        """Dead centres of the outputs along a branch: where their rate by the input vanishes."""
        extremes = []
        for wanted in self.outputs if branch.places else ():
            for at, value in Stationary(self.walker, wanted).places(branch):
                output = float(self.problem.units.from_si(value, wanted.dimension))
                extremes.append(OutputExtreme(wanted.name, output, self._limit_value(at - shift)))
        return tuple(extremes)

    def _limit_value(self, value: float) -> float:
        if self.shown != self.walker.number:
            value = float(self.walker.at(np.array([value]))[0, self.shown, 0]) + 0.0
        return input_number(self.problem, self.layout, self.shown, value).value + self.farther
