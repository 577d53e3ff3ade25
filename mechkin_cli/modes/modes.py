"""All assembly modes: at the first row, or at other inputs with the first row's letters.

Letters belong to the first row. Elsewhere a mode has the letter of the first row's mode whose
branch, followed along the straight path of the inputs, arrives there; one that no branch reaches
has the name `-`.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly import (
    NamedModes,
    choose_start,
    is_cyclic,
    name_modes,
    nothing_found,
    probe_of,
    state_at_first_row,
    wrapped,
)
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism import Problem, dimension_of
from mechkin_cli.plan import TrackEnd
from mechkin_cli.proofs import ModeProofs, prove_modes
from mechkin_cli.record import NamedTuple, dataclass, replace
from mechkin_cli.search import Assemblies, all_assemblies, pose_number, with_assemblies
from mechkin_cli.session import Session, input_numbers, input_text, kernel_inputs
from mechkin_cli.show import Floats, Listed, Listing

UNNAMED = "-"
"""Name of a mode that no branch from the first row reaches."""


class Mode(NamedTuple):
    """One assembly; coordinates in the file's units, angles in (-180, 180] degrees but
    for threads."""

    name: str
    coordinates: dict[str, float]
    residual: float
    condition: float


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
        names = tuple(self.modes[0].coordinates)
        rows = tuple(
            (
                f"{mode.name}{'*' if mode.name == self.picked else ''}",
                *(f"{mode.coordinates[name]:.6g}" for name in names),
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
            text += f"; threads within {self.turns}.5 turns to either side"
        return text


def find_modes(
    session: Session, at: Mapping[str, float] | None = None, *, certify: bool = False
) -> Modes:
    """The assembly modes at the first row, or with the inputs `at` (by name, in the file's units)
    in place of the values there; with proofs if they are to be certified."""
    layout = session.layout
    first = session.inputs.values[:, 0]
    named = name_modes(session, first)
    start = choose_start(session)
    state = state_at_first_row(session, start)
    chosen = None if state is None else pose_number(layout, named.found.states, state)
    letter = UNNAMED if chosen is None else named.letters[chosen]
    if at is None:
        notes = start.diagnostics
        names = [named.letters[i] for i in range(named.number)]
        return _result(session, first, {}, named.found, names, letter, notes, certify)
    place = _inputs_at(session, at)
    ends, notes = _follow_all(session, first, place, named)
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


def _inputs_at(session: Session, at: Mapping[str, float]) -> Floats:
    """Inputs (inputs,) in kernel units."""
    problem = session.problem
    inputs = []
    for item in problem.motion.inputs:
        value = float(item.values[0])
        if item.name in at:
            value = float(problem.units.to_si(at[item.name], dimension_of(item.coordinate)))
        inputs.append(item._replace(values=np.full(problem.motion.rows, value)))
    changed = replace(problem, motion=problem.motion._replace(inputs=tuple(inputs)))
    return kernel_inputs(changed, session.layout).values[:, 0]


def _follow_all(
    session: Session, first: Floats, place: Floats, named: NamedModes
) -> tuple[dict[str, Floats], list[Diagnostic]]:
    """States at `place` by letter, of the branches that arrive there; a note for each that does
    not."""
    ends: dict[str, Floats] = {}
    notes = []
    path = np.stack([first, place], axis=1)
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
    notes = [*notes, *_search_notes(assemblies)]
    inputs = {
        item.name: at.get(item.name, float(item.written[0])) for item in problem.motion.inputs
    }
    coordinates, _ = probe_of(session).read(place, assemblies.states)
    order = sorted(
        range(assemblies.number), key=lambda i: (names[i] == UNNAMED, len(names[i]), names[i])
    )
    modes = tuple(
        Mode(
            names[i],
            {n: _shown(problem, inputs, n, float(v[i])) for n, v in coordinates.items()},
            float(assemblies.residual[i]),
            float(assemblies.condition[i]),
        )
        for i in order
    )
    threads = any(joint.type.is_threaded for joint in problem.mechanism.joints.values())
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
        diagnostics=(*problem.diagnostics, *notes),
        proofs=prove_modes(session, place, assemblies.states[:, order]) if certify else None,
    )


def _shown(problem: Problem, inputs: Mapping[str, float], name: str, value: float) -> float:
    """A coordinate in the file's units; that of an input as the file or the caller has it."""
    turned = wrapped(value) if is_cyclic(problem.mechanism, name) else value
    if name in inputs and turned == value:
        return inputs[name]
    return float(problem.units.from_si(turned, dimension_of(name.rpartition(".")[2])))


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
