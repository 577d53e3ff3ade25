"""Messages of a sweep about its rows beside their verdicts.

In reading order: turns that do not close, redundant constraints, conditions, inputs without rates,
poses in gimbal lock (where the middle one of three turns is a quarter turn, the others go about one
axis, and their rates are lost), sets of actuators that cannot hold the mechanism, loads without a
value.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly import is_cyclic
from mechkin_cli.diagnostics import Diagnostic, Number, UsageError
from mechkin_cli.expressions import parse
from mechkin_cli.kernel.functions import cos
from mechkin_cli.mechanism import (
    ACTUATION,
    BEARING_KINDS,
    is_written,
    quantities_read,
    undefined_laws,
)
from mechkin_cli.memo import remembered
from mechkin_cli.plan import Demand, demand_of, needs_all_links
from mechkin_cli.record import NamedTuple
from mechkin_cli.row_notes import Found, RowNote
from mechkin_cli.search import pose_keys, same_poses
from mechkin_cli.structure import listed
from mechkin_cli.sweep.rows import RunRows
from mechkin_cli.tables import unique_cells
from mechkin_cli.units import MOMENT
from mechkin_cli.verdict import CONDITION_LIMITS, Status

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from mechkin_cli.mechanism import Joint, Mechanism, Problem, Wanted
    from mechkin_cli.session import Session
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.sweep.rows import SweepRows


LOADS_NAMED = 4
"""Unique bearing loads that are named one by one."""


class FirstRow(NamedTuple):
    """The first row of a run whose one moving input turns: that input, its value there without
    whole turns, and these; the states (states,)."""

    number: int
    reduced: float
    whole: float
    state: Floats


def first_row(session: Session, rows: SweepRows) -> FirstRow | None:
    """That of a run by its session, and the rows from the first on; None where the row is not
    reached, or it is not one input alone that turns, and by a whole turn."""
    number = _turning_input(session)
    if number is None or not rows.reached[0]:
        return None
    inputs = session.inputs
    reduced, whole = float(inputs.reduced[number, 0]), float(inputs.whole[number, 0])
    return FirstRow(number, reduced, whole, np.array(rows.states[:, 0]))


@remembered
def _turning_input(session: Session) -> int | None:
    """The number of the one input that moves, where it turns and comes to whole turns."""
    inputs = session.inputs
    moving = np.flatnonzero(np.ptp(inputs.values, axis=1) > 0.0)
    if moving.size != 1 or not np.ptp(inputs.whole[moving[0]]):
        return None
    name = session.problem.motion.inputs[moving[0]].name
    return int(moving[0]) if is_cyclic(session.problem.mechanism, name) else None


def open_turn_note(session: Session, rows: SweepRows, first: FirstRow | None) -> Diagnostic | None:
    """Rows a full turn of the one moving input from the first at which the mechanism is not the
    same.

    A thread that advances with the turn, and what moves with it, is not meant to be.
    """
    if first is None:
        return None
    turns = session.inputs.whole[first.number] - first.whole
    rest = (session.inputs.reduced[first.number] - first.reduced) / (2.0 * np.pi)
    near = np.abs(rest) <= tolerances.SAME_TURN
    if not np.count_nonzero(near):
        return None
    whole = rows.reached & (turns != 0.0) & near
    if not whole.any():
        return None
    row = int(np.argmax(whole))
    if not stands_elsewhere(session, np.stack([first.state, rows.states[:, row]], axis=1)):
        return None
    count = round(abs(float(turns[row])))
    name = session.problem.motion.inputs[first.number].name
    return Diagnostic(
        "turn-not-closed",
        "note",
        f"after {count} full turn{'s' * (count > 1)} of {name}, in {rows.named([row])}, the "
        "mechanism is not back at its first row's position: it has gone on to another assembly",
        hint="mechkin ranges shows the circuit",
    )


def stands_elsewhere(session: Session, both: Floats) -> bool:
    """Whether the second of two places (states, 2) is not the first; threads may have gone on."""
    both = np.ascontiguousarray(both)
    keys = pose_keys(session.layout, both, left_out=_advanced(session, both))
    return not same_poses(keys[:, :1], keys[:, 1:])[0, 0]


def _advanced(session: Session, both: Floats) -> set[tuple[int, int]]:
    """Unknown freedoms (tree edge, number) of the blocks in which a thread stands elsewhere in the
    second of two places, and of the blocks that depend on them."""
    graph, layout = session.graph, session.layout
    found: set[tuple[int, int]] = set()
    for carrier in layout.carriers:
        for number, freedom in enumerate(carrier.part.type.freedoms):
            if freedom.motion == "thread" or freedom.counted:
                place = both[carrier.state + number]
                if abs(float(place[1] - place[0])) > tolerances.SAME_MODE:
                    found.add((carrier.edge, carrier.first_freedom + number))
    edges = {edge for edge, _ in found}
    for block in graph.blocks:
        if edges & graph.passed(block):
            found.update(block.unknowns)
            edges.update(edge for edge, _ in block.unknowns)
    return found


def redundancy_note(result: RunRows, asked: Sequence[Wanted]) -> RowNote:
    """Redundant constraints leave some reactions arbitrary; which loads of the bearings asked for
    are unique nevertheless."""
    graph = result.graph
    count = sum(block.equations - len(block.unknowns) for block in graph.blocks)
    joints = sorted({graph.edges[k].joint.name for loop in graph.loops for k, _ in loop})
    joints = sorted(filter(is_written, {*joints, *(c.name for c in graph.closings)}))
    constraints = "one redundant constraint" if count == 1 else f"{count} redundant constraints"
    text = (
        f"{constraints} in the loops through {', '.join(joints)}: cells of reactions that depend "
        "on them are not unique and stay empty"
    )
    loads = _loads_beside(result, asked)
    words = partial(_redundancy, text, [load for load, _ in loads])
    marks: list[tuple[str, Bools]] = []
    for load, reaction in loads:
        arbitrary = _is_arbitrary(result, load)
        if arbitrary.any():
            marks.append((load, arbitrary))
        else:
            marks.append((f"reaction of {load}", _is_arbitrary(result, f"norm({reaction})")))
    return RowNote("not-unique", "note", "", result.row_states.reached, words, marks=marks)


def _redundancy(text: str, loads: Sequence[str], found: Found) -> Diagnostic:
    """Names the loads that are unique in every row, of reactions that are not in some."""
    free = "free a joint to make them unique (a sphere for a pin, a cylinder for a slide)"
    unique = [
        load for load in loads if load not in found.marks and f"reaction of {load}" in found.marks
    ]
    if unique:
        more = ", ..." if len(unique) > LOADS_NAMED else ""
        are = "is" if len(unique) == 1 else "are"
        free = f"ask for {', '.join(unique[:LOADS_NAMED])}{more}, which {are} unique; or {free}"
    return Diagnostic("not-unique", "note", text, hint=free)


def _loads_beside(result: RunRows, asked: Sequence[Wanted]) -> list[tuple[str, str]]:
    """The bearing loads of the reactions asked for, with these; along a slide there is none."""
    known, joints = result.problem.quantities(), result.problem.mechanism.joints
    wanted = {quantity.name for quantity in asked}
    found = []
    for load in known.values():
        if load.kind not in BEARING_KINDS or load.owner not in joints:
            continue
        slides = not all(coordinate.is_angle for coordinate in joints[load.owner].type.named)
        reaction = f"{load.owner}.{'moment' if load.dimension == MOMENT else 'force'}"
        if reaction not in wanted or (slides and load.kind == "axial_force"):
            continue
        found.append((load.name, reaction))
    return found


def _is_arbitrary(result: RunRows, text: str) -> Bools:
    """Rows (rows,) in which a quantity is not unique."""
    expression, reached = parse(text), result.row_states.reached

    def values(source: RunRows) -> Floats:
        value = np.asarray(expression.evaluate(source.quantity).value)
        return np.broadcast_to(value, reached.shape)[reached]

    others = [values(other) for other in result.alternatives]
    disturbed = [values(other) for other in result.disturbed]
    arbitrary: Bools = np.zeros(reached.size, dtype=bool)
    arbitrary[reached] = ~np.isfinite(unique_cells(values(result), others, disturbed))
    return arbitrary


def first_order_note(problem: Problem) -> Diagnostic:
    """Freedoms that loops stop, but not to first order: which motion the rows are of."""
    words = "; ".join(dict.fromkeys(one.words for one in problem.stopped))
    return Diagnostic(
        "first-order-motion",
        "note",
        f"{words}, wherever the inputs take it: play in the joints lets it go far, and it needs a "
        "stiff support; the rows are of the motion in which it rests",
        hint="mobility tells which motions meet; a constraint more in that direction stops it",
    )


def condition_notes(rows: SweepRows, condition: Floats) -> list[RowNote]:
    """Rows next to singular positions, or whose rank is unclear; `condition` (rows,)."""
    found = []
    for status in CONDITION_LIMITS:
        there = rows.status == status
        if there.any():
            bad = np.nan_to_num(condition, nan=np.inf, posinf=np.inf)
            words = partial(_condition_note, status)
            found.append(RowNote(status.label, "warning", "", there, words, bad))
    return found


def _condition_note(status: Status, found: Found) -> Diagnostic:
    worst, limit = float(found.told), CONDITION_LIMITS[status]
    cost = (
        "rates and loads there keep fewer than nine digits"
        if status.has_rates
        else "the rank of the constraints cannot be decided there; rates and reactions stay empty"
    )
    verb = "is" if found.rows.size == 1 else "are"
    return Diagnostic(
        status.label,
        "warning",
        f"{found.rows} {verb} {status.label}: {cost}",
        measured=condition_text(worst),
        limit=f"{limit:g}",
        hint="move the sweep by a fraction of its step, or keep away from the singular position",
        numbers=(Number("condition", worst, limit=limit),),
    )


def condition_text(value: float) -> str:
    """A condition as measured; of one beyond the reach of doubles that it is."""
    most = 1.0 / np.finfo(float).eps
    return f"condition {value:.2g}" if value <= most else f"condition above {most:.2g}"


def not_converged_note(rows: SweepRows, residual: Floats) -> RowNote:
    """Rows whose loops did not close."""
    failed = rows.status == Status.not_converged
    bad = np.nan_to_num(residual, nan=np.inf, posinf=np.inf)
    return RowNote("not-converged", "error", "", failed, _not_converged, bad)


def _not_converged(found: Found) -> Diagnostic:
    worst = float(found.told)
    return Diagnostic(
        "not-converged",
        "error",
        f"{found.rows} did not close",
        measured=f"residual {worst:.2g}",
        limit=f"{tolerances.RESIDUAL_ACCEPT:g}",
        hint="this may be a special position; move the sweep by a fraction of its step",
        numbers=(Number("residual", worst, limit=tolerances.RESIDUAL_ACCEPT),),
    )


_WITHOUT_RATES = {"per_acceleration", "dynamic_transmission_angle", "actuation", "power_error"}
"""Kinds of forces that depend on no rate, and the balance of powers, which says nothing at rest."""


def unrated_notes(
    problem: Problem, asked: Sequence[Wanted], unasked: Collection[str]
) -> list[Diagnostic]:
    """Names the inputs whose rates the file leaves out, where loads, masses or quantities need
    them, other than rates that are shown `unasked`."""
    unrated, mechanism = problem.motion.unrated, problem.mechanism
    if not unrated:
        return []
    by_rates = Demand.VELOCITY | Demand.FORCES
    shown = [q for q in asked if q.name not in unasked]
    powers = bool(mechanism.loads) or any(link.has_mass for link in mechanism.links.values())
    rates = [
        q.name
        for q in shown
        if (
            powers
            if q.kind == "power_error"
            else demand_of(mechanism, [q]) & by_rates == Demand.VELOCITY
        )
    ]
    needs = [f"{listed(rates)} {'is' if len(rates) == 1 else 'are'} as at rest"] if rates else []
    forces = [q for q in asked if q.kind not in _WITHOUT_RATES]
    if any(demand_of(mechanism, [q]) & by_rates == by_rates for q in forces):
        needs.append(f"forces are as at rest, without {_of_motion(mechanism)}")
    if not needs:
        return []
    have = "has" if len(unrated) == 1 else "have"
    text = f"{listed(unrated)} {have} no rate, which is taken as zero: {', and '.join(needs)}"
    hint = "give it with rate:, or write rate: 0 where the rows are meant at rest"
    return [Diagnostic("no-rate", "note", text, hint=hint)]


def _of_motion(mechanism: Mechanism) -> str:
    """The forces that there are by rates alone."""
    masses = [link.name for link in mechanism.links.values() if link.has_mass]
    moving = [load for load in mechanism.loads if load.reads_rates]
    parts = {
        f"the inertia forces of {listed(masses)}": bool(masses),
        "those of dampers": any(load.dissipates for load in moving),
        "friction that slides": bool(mechanism.frictions),
        "those of loads that read rates": any(not load.dissipates for load in moving),
    }
    *others, last = (words for words, there in parts.items() if there)
    return f"{', '.join(others)} and {last}" if others else last


_TROUBLE = (Status.branch_lost, Status.near_singular, Status.rank_unclear)


def middle_turn(joint: Joint) -> str | None:
    """The name of the turn between two others, None of a joint that has none."""
    for freedom, step in enumerate(joint.type.steps):
        if step.between:
            names = (n for n, number in joint.type.freedom_of.items() if number == freedom)
            return f"{joint.name}.{next(names)}"
    return None


def locked_in(result: RunRows, rows: Bools) -> str | None:
    """The middle turn of a pose that is a quarter turn in some of the rows."""
    for joint in result.problem.mechanism.joints.values():
        name = middle_turn(joint)
        if name is None:
            continue
        result.read([result.problem.quantities()[name]])
        angles = np.asarray(result.quantity(name).value)[rows & result.row_states.reached]
        if (np.abs(np.asarray(cos(angles))) < tolerances.POSE_LOCKED).any():
            return name
    return None


def locked_pose_notes(result: RunRows) -> list[Diagnostic]:
    """Warns that rows may be lost by gimbal lock of a pose whose turns are not driven."""
    if result.sound or not np.isin(result.status, [int(status) for status in _TROUBLE]).any():
        return []
    driven = {f"{joint}.{coordinate}" for joint, coordinate in result.problem.driven}
    found = []
    for joint in result.problem.mechanism.joints.values():
        name = middle_turn(joint)
        if name is None or name in driven:
            continue
        text = (
            f"where {name} is a quarter turn the turns before and after it go about one axis: "
            f"rows may be lost or singular there by the coordinates of {joint.name} alone"
        )
        hint = f"remove {joint.name} and read points and directions, or drive its turns"
        found.append(Diagnostic("locked-pose", "note", text, hint=hint))
    return found


def watched(problem: Problem, asked: Sequence[Wanted]) -> list[Wanted]:
    """The quantity that shows whether the actuators hold the mechanism, where forces are asked
    for."""
    drives = problem.mechanism.drives
    if drives is None or not drives.actuators:
        return []
    return [ACTUATION] if demand_of(problem.mechanism, asked) & Demand.FORCES else []


def unheld(result: RunRows) -> Bools | None:
    """Rows (rows,) in which the set is singular; None where that was not looked at."""
    if ACTUATION.name not in result.columns:
        return None
    least = result.columns[ACTUATION.name][0]
    return np.asarray(result.solved & ~(least > tolerances.ACTUATORS_AT_REST))


def is_held(result: RunRows) -> bool:
    """Whether the actuators hold the mechanism in every row, as far as that was looked at."""
    lost = unheld(result)
    return lost is None or not lost.any()


def actuation_notes(result: RunRows) -> list[RowNote]:
    """Names the set and the rows where it is singular, or next to that."""
    lost, drives = unheld(result), result.problem.mechanism.drives
    if lost is None or drives is None:
        return []
    least = result.columns[ACTUATION.name][0]
    near = result.solved & ~lost & (least < 1.0 / tolerances.CONDITION_NEAR_SINGULAR)
    names = ", ".join(".".join(pair) for pair in drives.actuators)
    notes = []
    for code, rows, limit, text in (
        (
            "singular-actuators",
            lost,
            tolerances.ACTUATORS_AT_REST,
            f"the actuators {names} are a singular set in {{}}: the mechanism can move there while "
            "all of them rest; their efforts and the reactions stay empty",
        ),
        (
            "near-singular-actuators",
            near,
            1.0 / tolerances.CONDITION_NEAR_SINGULAR,
            f"the actuators {names} are next to a singular set in {{}}: their efforts are large "
            "and keep fewer than nine digits",
        ),
    ):
        if rows.any():
            words = partial(_note, code, text, limit)
            turn = locked_in(result, rows)
            marks = [(turn, rows)] if turn else []
            bad = -np.nan_to_num(least)
            notes.append(RowNote(code, "warning", "", rows, words, bad, least.__getitem__, marks))
    return notes


def _note(code: str, text: str, limit: float, found: Found) -> Diagnostic:
    least = float(found.told)
    hint = "put an actuator elsewhere, add one, or keep away from that position"
    turn = min(found.marks, default=None)
    locked = (
        f"where {turn} is a quarter turn the turns before and after it go about one axis: that is "
        "a matter of the pose's coordinates, not of the actuators"
    )
    return Diagnostic(
        code,
        "warning",
        text.format(found.rows) + (f"; {locked}" if turn else ""),
        measured=f"{least:.2g} of the motion",
        limit=f"{limit:.0e}",
        hint=hint,
        numbers=(Number("actuation", least, limit=limit),),
    )


def undefined_loads(result: RunRows, lost: Bools) -> list[RowNote]:
    """What to say of the rows (rows,) of a result in which some load has no value.

    The laws are evaluated once more, from the same quantities as in the kernel and with the same
    bits, to identify them.
    """
    known = result.problem.quantities()
    result.read([known[name] for name in quantities_read(result.problem)])
    return undefined_laws(result.problem, result.quantity, lost)


def refuse_loaded_spin(session: Session, names: Sequence[str]) -> None:
    """Forces and energies need what spins freely to have no cause to spin.

    Raises:
        UsageError: one of some quantities is such, and something would spin.
    """
    problem = session.problem
    if not names or not problem.has_idle:
        return
    for diagnostic in _causes_of_spin(session):
        known = problem.quantities()
        if needs_all_links(problem.mechanism, [known[name] for name in names]):
            raise UsageError(str(diagnostic))


@remembered
def _causes_of_spin(session: Session) -> list[Diagnostic]:
    from mechkin_cli.idle import spin_errors

    return [diagnostic for _, diagnostic in spin_errors(session.problem)]
