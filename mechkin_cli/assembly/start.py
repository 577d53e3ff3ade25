"""The assembly at the first row: continued from another model's, near some coordinates, a named
mode, the home drawing, or the nearest to it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly.fold import judged_off_fold, next_to_fold
from mechkin_cli.assembly.home import (
    NamedModes,
    is_home_assembled,
    is_home_singular,
    name_modes,
    nearest_to_home,
    probe_of,
    rows_from_home,
    two_sides,
)
from mechkin_cli.assembly.near import (
    NEAR,
    AssemblyStart,
    box_about,
    distances_home,
    distances_near,
    distances_of,
    far_notes,
    in_order,
    is_unclear,
    named_by,
    newton_from,
    nothing_found,
    unclear,
)
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, MechkinError
from mechkin_cli.kernel._kernel import Stepper
from mechkin_cli.mechanism import LongRun, dimension_of, is_angle
from mechkin_cli.memo import remembered
from mechkin_cli.plan import TrackEnd, home_inputs, home_state
from mechkin_cli.record import replace
from mechkin_cli.search import (
    Assemblies,
    all_assemblies,
    is_in_reach,
    pose_number,
    with_assemblies,
)
from mechkin_cli.session import (
    Between,
    Continued,
    Followed,
    Session,
    input_numbers,
    input_text,
    step_limits,
)
from mechkin_cli.structure import structure_of
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.show import Floats


HOME = "home"
"""The assembly that is drawn, under any letter."""

MOST_LETTERS = 26
"""Modes whose letters a message lists."""

MOST_TOLD = 3
"""Coordinates that tell motions apart that a message lists."""

MAY_BE_RIGID = "an overconstrained loop moves only if its dimensions are exact (write expressions)"


@remembered
def choose_start(session: Session) -> AssemblyStart:
    """The assembly that the file means, or the one that is continued."""
    few, rows = rows_of_start(session)
    if rows is not None:
        start = choose_start(few)
        return replace(start, row=int(rows[start.row]))
    continued = continued_start(session)
    if continued is not None and continued.chosen is not None and continued.state is not None:
        start = _continued(continued)
        inputs = session.inputs.reduced[:, start.row]
        far = far_notes(session, inputs, continued.state, start.row)
        known = [one for one in start.diagnostics if one.code != "nearest-far"]
        return replace(start, diagnostics=[*known, *far])
    if continued is not None:
        return _continued(continued)
    start = _choose_start(session)
    by_mode = start.mode not in (NEAR, HOME) and session.problem.assembly.mode is not None
    return start if by_mode else judged_off_fold(session, start)


@remembered
def rows_of_start(session: Session) -> tuple[Session, NDArray[np.int64] | None]:
    """The rows among which the first assembly is looked for, and their numbers: all, None, or of a
    long run a sample, with those next to the drawing."""
    motion = session.problem.motion
    if not isinstance(motion, LongRun):
        return session, None
    sample = motion.sample
    rows = motion.sampled
    few = session.moved(replace(session.problem, motion=sample).with_quantities_of(session.problem))
    wanted = session.problem.assembly
    if wanted.mode == HOME or (not wanted.near and wanted.mode is None):
        place = nearest_to_home(few, few.inputs.values)
        low, high = int(rows[max(place - 1, 0)]), int(rows[min(place + 1, rows.size - 1)])
        between = session.part(low, high)
        nearest = low + nearest_to_home(between, between.inputs.values)
        rows = np.unique(np.concatenate([rows, np.arange(max(nearest - 1, low), nearest + 2)]))
        rows = rows[rows < motion.rows]
        problem = replace(session.problem, motion=motion.at(rows))
        few = session.moved(problem.with_quantities_of(session.problem))
    return few, rows


@remembered
def continued_start(session: Session) -> Continued | None:
    """The first assembly of a session that continues another's; None where it is to be chosen:
    nothing is continued, the base has no first assembly, or another structure."""
    return session.first if session.base is None else _brought(session, *session.base)


def _brought(session: Session, base: Session, between: Between) -> Continued | None:
    """The first assembly of the base brought to a session with a plan of its own, along the
    straight line in the parameters: the sessions between are built one by one, and the steps are
    those of every continuation (docs/numerics.md, Variants)."""
    start = choose_start(base)
    if start.state is None or structure_of(session.graph) != structure_of(base.graph):
        return None
    rows = session.problem.motion.rows
    row = start.row if rows == base.problem.motion.rows else 0
    ends = base.inputs.values[:, start.row], session.inputs.values[:, row]
    return Continued(_end_of_line(session, base, between, start.state, ends), row)


def _end_of_line(
    session: Session, base: Session, between: Between, state: Floats, ends: tuple[Floats, Floats]
) -> Floats | None:
    """States at the end of the line from inputs to inputs; None where the branch ends before."""
    first, last = ends
    plans = {0.0: base.plan, 1.0: session.plan}
    structure, unit = structure_of(session.graph), session.layout.length

    def plan(place: float) -> Plan:
        if place not in plans:
            plans[place] = between.plan(place, structure, unit)
        return plans[place]

    def at(place: float) -> tuple[Sequence[float], Sequence[float], Sequence[float]]:
        still = [0.0] * first.size
        return (first + place * (last - first)).tolist(), still, still

    limits = step_limits(tolerances.LONGEST_DIMENSION_STEP)
    try:
        node = Stepper.along(plan, at, True, limits).to_target(state.tolist())
    except MechkinError:
        return None  # what the file says does not hold somewhere on the way
    return None if node is None else np.array(node.state)


def _continued(continued: Continued) -> AssemblyStart:
    """From the variant of the file's own parameters, or from the place that was chosen first."""
    if continued.state is not None and continued.chosen is not None:
        chosen: AssemblyStart = continued.chosen
        own = replace(chosen, state=continued.state, turn=continued.turns, condition=None)
        return replace(own, row=continued.row)
    if continued.state is not None:
        return AssemblyStart(
            continued.state, NEAR, "continued in the parameters", row=continued.row
        )
    diagnostic = Diagnostic(
        "variant-lost",
        "error",
        "the assembly of the file's own parameters ends before it comes to these",
        hint="take parameters nearer to the file's, or choose the assembly in the file itself",
    )
    return AssemblyStart(None, NEAR, "", [diagnostic], Status.branch_lost, continued.row)


def _choose_start(session: Session) -> AssemblyStart:
    # an assembly is the same whole turns of an input away
    path, wanted = session.inputs.reduced, session.problem.assembly
    as_drawn = wanted.mode == HOME or (not wanted.near and wanted.mode is None)
    if as_drawn and is_home_assembled(session):
        return _from_home(session)
    if wanted.near and wanted.mode is None:
        start = _from_near(session, path[:, 0])
        if start is not None:
            return _noted_if_far(session, path[:, 0], start)
    modes = name_modes(session, path[:, 0], thorough=wanted.mode is not None)
    if modes.number == 0:
        beside = next_to_fold(session) if modes.found.free and wanted.mode is None else None
        if beside is None:
            return AssemblyStart(None, "", "", [nothing_found(session, modes.found)])
        return _noted_if_far(session, path[:, 0], beside) if wanted.near else beside
    if wanted.mode is not None:
        return _by_name(modes, wanted.mode)
    home = distances_home(session, modes.points)
    if not wanted.near:
        return _nearest(modes, home, home, "nearest to home")
    start = _nearest(modes, distances_near(session.problem, modes.coordinates), home, "near")
    return _noted_if_far(session, path[:, 0], start)


def mode_letter(session: Session, start: AssemblyStart, *, thorough: bool = True) -> str:
    """The letter of an assembly at the first row, by a search if it is not known yet; `near` or
    `home` where it is on no letter's branch, or where only a `thorough` search finds all modes."""
    if start.mode not in (NEAR, HOME) or start.state is None:
        return start.mode
    few, rows = rows_of_start(session)
    if rows is not None:
        session, start = few, replace(start, row=int(np.searchsorted(rows, start.row)))
    first = session.inputs.reduced[:, 0]
    state = state_at_first_row(session, start)
    if state is None or not (thorough or is_in_reach(session.layout, state)):
        return start.mode
    modes = name_modes(session, first, thorough=thorough)
    if not modes.letters:
        return start.mode
    number = pose_number(session.layout, modes.found.states, state)
    return start.mode if number is None else modes.letters[number]


def state_at_first_row(session: Session, start: AssemblyStart) -> Floats | None:
    """States of the first assembly's branch at the first row; an assembled drawing may be followed
    from another."""
    if start.state is None or start.row == 0:
        return start.state
    values = session.inputs.values
    path = np.stack([values[:, start.row], values[:, 0]], axis=1)
    followed = session.follow(path, start.state)
    return followed.state if followed.end == TrackEnd.FINISHED else None


def _from_near(session: Session, inputs: Floats) -> AssemblyStart | None:
    """By Newton's method: at once if what it finds is proven to be the nearest, else after a search
    about what is named; None where it finds none that narrows the search."""
    named = named_by(session)
    newton = newton_from(session, inputs, named) if named[1] else None
    if newton is None:
        return None
    state, unique, condition = newton
    distance = distances_of(session, inputs, state[:, None])[0][0]
    if (1.0 + tolerances.NEAR_RUNNER_UP) * distance < unique:
        how = (
            f"{distance:.2g} rad or sizes off what near names, found by Newton's method; no other "
            f"within {unique:.2g}"
        )
        return AssemblyStart(state, NEAR, how, off=distance, condition=condition)
    # coordinates that are exact are so but for rounding
    radius = tolerances.NEAR_RUNNER_UP * max(distance, tolerances.SAME_MODE)
    if radius > tolerances.NEAR_BALL:
        return None
    inside = all_assemblies(session, inputs, box_about(session, named, radius), thorough=False)
    return _nearest_about(session, inputs, state, inside, radius)


def _noted_if_far(session: Session, inputs: Floats, start: AssemblyStart) -> AssemblyStart:
    if start.state is None or start.off <= tolerances.NEAR_FAR:
        # no coordinate is off by more than all together
        return start
    notes = far_notes(session, inputs, start.state)
    return replace(start, diagnostics=[*start.diagnostics, *notes])


def _nearest_about(
    session: Session, inputs: Floats, newton: Floats, found: Assemblies, radius: float
) -> AssemblyStart | None:
    """The nearest of all assemblies about as near as the one that Newton's method found."""
    found = with_assemblies(session.layout, session.plan, inputs, found, newton[:, None])
    distances, home = distances_of(session, inputs, found.states)
    order = [i for i in in_order(distances, home) if distances[i] <= radius]
    if not order:
        return None
    best = distances[order[0]]
    how = (
        f"{best:.2g} rad or sizes off what near names, nearest of {len(order)} that "
        f"{found.starts} starts found within {radius:.2g}"
    )
    notes = []
    if len(order) > 1 and is_unclear(best, distances[order[1]]):
        notes.append(unclear("two assemblies", (best, distances[order[1]])))
    condition = float(found.condition[order[0]])
    return AssemblyStart(found.states[:, order[0]], NEAR, how, notes, off=best, condition=condition)


def _from_home(session: Session) -> AssemblyStart:
    """Followed from the drawing to the row whose inputs are nearest to it, or on its other side."""
    singular = is_home_singular(session, tolerances.CONDITION_RANK_UNCLEAR)
    beside = _from_beside_home(session) if singular else []
    # a way that ends in the drawing itself is lost there, unless it is to go straight on
    off = np.abs(session.inputs.values - home_inputs(session.layout)[:, None])
    drawn = bool((np.max(off, axis=0, initial=0.0) <= tolerances.PASSED).any())
    if len(beside) == 1 and (session.problem.assembly.straight or not drawn):
        return replace(beside[0], diagnostics=[_meeting("the rows go on")])
    first = None
    for row, followed, turned in rows_from_home(session):
        if followed.end == TrackEnd.FINISHED:
            how = "followed from the home drawing" + (", whole turns away" if turned else "")
            start = AssemblyStart(followed.state, HOME, how, row=row)
            notes = [_meeting("rows would go on")] if len(beside) == 1 else []
            return replace(start, diagnostics=notes)
        first = first or followed
    assert first is not None
    return _several_motions(session, beside) if beside else _ends_before_rows(session, first)


def _meeting(rows: str) -> Diagnostic:
    """That a drawing lies where motions meet, and in which of them `rows` go on."""
    return Diagnostic(
        "motions-meet",
        "note",
        f"several motions meet in the drawing: {rows} in the only one in which the inputs move",
        hint="assembly: {at_branch_points: straight} goes through the drawing; mobility of the "
        "file without inputs names the motions",
    )


def _from_beside_home(session: Session) -> list[AssemblyStart]:
    """Of a drawing where motions meet: followed from the assemblies next to it that come back to
    it, a little further on the way to the nearest row away from it, on either side; none where some
    assembly there moves with the inputs held, more are there than are listed, or of one it is not
    known whether it comes from the drawing."""
    home, drawn = home_inputs(session.layout), home_state(session.layout)
    left = {session.layout.state(*at) for block in session.graph.blocks for at in block.unknowns}
    about = box_about(session, (drawn, frozenset(left), True), tolerances.HOME_BOX)
    path = session.inputs.values - home[:, None]
    away = np.flatnonzero(np.max(np.abs(path), axis=0, initial=0.0) > tolerances.PASSED)
    for row in two_sides(path, away) if away.size else []:
        way = path[:, row] * min(1.0, tolerances.HOME_STEP / float(np.max(np.abs(path[:, row]))))
        found = all_assemblies(session, home + way)
        # what moves elsewhere with the inputs held does not come from the drawing
        if found.cut or all_assemblies(session, home + way, about).free:
            continue
        come = [_comes_from_home(session, home, way, state) for state in found.states.T]
        if None in come:
            continue
        starts = []
        for state in found.states.T[np.array(come, dtype=bool)]:
            on = session.follow(np.stack([home + way, home + path[:, row]], axis=1), state)
            if on.end == TrackEnd.FINISHED:
                how = "followed from beside the home drawing, where motions meet"
                starts.append(AssemblyStart(on.state, HOME, how, row=row))
        if starts:
            return starts
    return []


def _comes_from_home(session: Session, home: Floats, way: Floats, state: Floats) -> bool | None:
    """Whether an assembly at the inputs home + way lies on a motion that leaves the drawing there;
    None where it is lost on the way back. A coordinate may move far faster than the inputs."""
    drawn = home_state(session.layout)
    off = float(np.max(np.abs(state - drawn)))
    here = way
    for part in tolerances.HOME_PARTS:
        back = session.follow(np.stack([home + here, home + part * way], axis=1), state)
        if back.end != TrackEnd.FINISHED:
            return None
        state, here = back.state, part * way
        if float(np.max(np.abs(state - drawn))) <= 0.5 * min(off, tolerances.HOME_NEAR):
            return True
    return False


def _several_motions(session: Session, starts: Sequence[AssemblyStart]) -> AssemblyStart:
    """No start, since several motions meet in the drawing in which the inputs move; what tells them
    apart at the nearest row is named."""
    states = np.stack([one.state for one in starts if one.state is not None], axis=1)
    inputs = session.inputs.values[:, starts[0].row]
    problem = session.problem
    told = []
    for name, values in probe_of(session).read(inputs, states)[0].items():
        dimension = dimension_of(name.rpartition(".")[2])
        unit = problem.units.label(dimension)
        size = 1.0 if is_angle(name.rpartition(".")[2]) else session.layout.length
        if float(np.ptp(values)) > tolerances.SAME_MODE * size:
            in_file = problem.units.from_si(np.sort(values), dimension).tolist()
            each = [f"{value:.6g}" for value in in_file]
            told.append(f"{name} = {' or '.join(dict.fromkeys(each))} {unit}")
    diagnostic = Diagnostic(
        "several-motions",
        "error",
        f"in the drawing {len(starts)} motions meet in which the inputs move",
        measured=f"at row {starts[0].row + 1} {', '.join(told[:MOST_TOLD])}",
        hint="say which is meant with assembly: {near: ...}",
    )
    return AssemblyStart(None, HOME, "", [diagnostic], Status.branch_lost, stuck=False)


def _ends_before_rows(session: Session, followed: Followed) -> AssemblyStart:
    """Why no row has the assembly of the drawing: how the path to the nearest one ended."""
    places = input_numbers(session.problem, session.layout, followed.inputs)
    rigid = f"; {MAY_BE_RIGID}" if session.is_redundant else ""
    diagnostic = Diagnostic(
        "home-branch-ends",
        "error",
        "the assembly drawn at home ends before it comes to a row",
        measured=f"followed up to {', '.join(map(input_text, places))}",
        hint=f"choose another assembly with assembly: {{near: ...}}{rigid}",
        numbers=places,
    )
    ending = followed.ending
    folds = ending is not None and ending.is_dead_centre
    status = Status.beyond_dead_centre if folds else Status.branch_lost
    stuck = float(np.max(np.abs(followed.inputs), initial=0.0)) <= tolerances.PASSED
    return AssemblyStart(None, HOME, "", [diagnostic], status, stuck=stuck)


def _by_name(modes: NamedModes, name: str) -> AssemblyStart:
    for i, letter in modes.letters.items():
        if letter == name:
            return AssemblyStart(modes.found.states[:, i], name, "by name")
    shown = name[:LONGEST_NAME] or '""'
    diagnostic = Diagnostic(
        "no-such-mode",
        "error",
        f"there is no mode {shown} at the first row",
        measured=f"modes {_letters(list(modes.letters.values()))}",
        hint="take one of these",
    )
    return AssemblyStart(None, name, "", [diagnostic])


def _letters(letters: list[str]) -> str:
    if len(letters) <= MOST_LETTERS:
        return ", ".join(letters)
    first = ", ".join(letters[:MOST_LETTERS])
    return f"{first}, ... {letters[-1]}, {len(letters)} of them"


def _nearest(
    modes: NamedModes, distances: list[float], home: list[float], how: str
) -> AssemblyStart:
    order = in_order(distances, home)
    best, second = order[0], order[1] if len(order) > 1 else None
    notes = []
    if second is not None and is_unclear(distances[best], distances[second]):
        both = "two assemblies"
        if modes.letters:
            both = f"modes {modes.letters[best]} and {modes.letters[second]}"
        notes.append(unclear(both, (distances[best], distances[second])))
    how = f"{how}, 1 of {modes.number} found"
    state, condition = modes.found.states[:, best], float(modes.found.condition[best])
    return AssemblyStart(state, modes.letters.get(best, NEAR), how, notes, condition=condition)
