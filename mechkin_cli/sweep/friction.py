"""Friction in a sweep: rows without an answer, self-locking, loads that it does not count.

Rows are judged when forces are read for the first time (`FrictionRows`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import idle, tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism import (
    REACTION_LEVEL,
    SELF_LOCKING,
    friction_states,
    rubbing_words,
    strands_of,
)
from mechkin_cli.plan import FORCE_KINDS, Demand, FrictionState, is_lifted
from mechkin_cli.row_notes import Found, RowNote
from mechkin_cli.sweep.rows import RunRows
from mechkin_cli.tape import of_two
from mechkin_cli.units import ANGLE, FORCE, LENGTH, MOMENT
from mechkin_cli.verdict import Status, has_rates

if TYPE_CHECKING:
    from mechkin_cli.mechanism import LockedFreedom, Problem, Rubbing, Wanted
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.units import Dimension, UnitSystem


CODE = "friction-undecided"

_WHY = {
    FrictionState.AT_REST: (
        "{} has no direction: nothing slides there, or is about to",
        "give the inputs the rate, or the acceleration, of the motion that is meant; a joint that "
        "never moves needs no friction",
    ),
    FrictionState.NOT_UNIQUE: (
        "{} may jam: no proof that its forces are the only ones",
        "make the coefficient smaller or the bearings longer, or drive the mechanism elsewhere",
    ),
    FrictionState.NOT_SOLVED: (
        "{} has no forces in balance with its reactions",
        "make the coefficient smaller, or move the sweep by a fraction of its step",
    ),
}
"""Why a row has no answer, and what to do."""


FrictionVerdict = tuple["Bools", "Bools", list[RowNote]]
"""Rows (rows,) in which some forces have no value, those of them in which all would be unfounded,
and messages."""


def verdict_quantities(problem: Problem) -> list[Wanted]:
    """What forces with friction are judged by."""
    mechanism = problem.mechanism
    found = [*_stopping(problem), *_strands(problem)]
    if mechanism.frictions:
        found += [*friction_states(mechanism), SELF_LOCKING, *_holding(problem)]
    return [REACTION_LEVEL, *found] if found else []


def _stopping(problem: Problem) -> list[Wanted]:
    """What would hold the freedoms that constraints do not stop to first order."""
    known = problem.quantities()
    return [known[one.holding] for one in problem.stopped]


def _strands(problem: Problem) -> list[Wanted]:
    """What pulls in strands that may go slack."""
    couplings = problem.mechanism.couplings.items()
    return [strand for name, relation in couplings for strand in strands_of(name, relation)]


def slack_quantities(problem: Problem) -> list[Wanted]:
    """What strands that go slack are told by: first what reactions are measured by."""
    strands = _strands(problem)
    return [REACTION_LEVEL, *strands] if strands else []


def _holding(problem: Problem) -> list[Wanted]:
    """What holds the idle freedoms, where the file does not accept that something does."""
    if problem.hold_idle:
        return []
    known = problem.quantities()
    return [known[name] for name in dict.fromkeys(i.holding for i in idle.idle_freedoms(problem))]


def friction_verdict(result: RunRows) -> FrictionVerdict:
    """The verdict on the friction of a result, whose verdict quantities have been read."""
    rows = result.row_states
    judged = rows.reached & has_rates(rows.status)
    lost, unfounded = np.zeros((2, judged.size), dtype=bool)
    notes = []
    for note in _undecided(result, judged):
        lost |= note.where
        notes.append(note)
    for note in (*_not_unique(result, judged), *_spinning(result, judged)):
        unfounded |= note.where
        notes.append(note)
    lost |= unfounded
    locking = judged & (result.columns[SELF_LOCKING.name][0] > 0.0) & ~lost
    if locking.any():
        notes.append(RowNote("self-locking", "note", "", locking, _self_locking))
    return lost, unfounded, notes


def _self_locking(found: Found) -> Diagnostic:
    text = (
        f"in {found.rows.counted} a drive would brake without friction and has to push with it: "
        "the loads alone do not move the mechanism there"
    )
    return Diagnostic("self-locking", "note", text)


def unsupported(result: RunRows) -> FrictionVerdict:
    """Rows (rows,) whose loads push along a motion that constraints do not stop to first order,
    twice, and messages."""
    rows, problem = result.row_states, result.problem
    judged = rows.reached & has_rates(rows.status)
    lost, notes = np.zeros(judged.size, dtype=bool), []
    for one in problem.stopped:
        unit = result.session.layout.length if one.turns else 1.0
        level = result.columns[REACTION_LEVEL.name][0]
        holding = np.abs(result.columns[one.holding][0])
        where = judged & (holding > tolerances.UNIQUE_CELL * level * unit)
        if where.any():
            words = partial(_unsupported, problem, one)
            code = Status.unsupported.label
            notes.append(RowNote(code, "warning", one.holding, where, words, holding))
        lost |= where
    return lost, lost, notes


def _unsupported(problem: Problem, one: LockedFreedom, found: Found) -> Diagnostic:
    dimension = MOMENT if one.turns else FORCE
    most = float(problem.units.from_si(found.told, dimension))
    return Diagnostic(
        Status.unsupported.label,
        "warning",
        f"{one.words}, and the loads push it in {found.rows.counted}: no finite reactions hold it; "
        "forces stay empty",
        measured=f"{most:.6g} {problem.units.label(dimension)}",
        limit=f"{tolerances.UNIQUE_CELL:g} of the largest reaction",
        hint="add a constraint along that motion, or remove that component of the load",
    )


def _slack(result: RunRows, lost: Bools) -> Iterator[RowNote]:
    """Rows in which strands would have to push."""
    rows, problem = result.row_states, result.problem
    strands = _strands(problem)
    for strand in strands:
        level = result.columns[REACTION_LEVEL.name][0]
        tension = result.columns[strand.name][0]
        where = rows.reached & has_rates(rows.status) & ~lost & is_slack(tension, level)
        if where.any():
            words = partial(_goes_slack, problem, strand)
            code, pull = Status.slack.label, tension.__getitem__
            yield RowNote(code, "warning", strand.name, where, words, -tension, pull)


def _goes_slack(problem: Problem, strand: Wanted, found: Found) -> Diagnostic:
    least = float(problem.units.from_si(float(found.told), FORCE))
    return Diagnostic(
        Status.slack.label,
        "warning",
        f"a strand of {strand.owner} goes slack in {found.rows.counted}: its forces are as if it "
        "pushed",
        measured=f"{strand.name} = {least:.6g} {problem.units.label(FORCE)}",
        limit="0",
        hint="give more pretension, or hold the load so that it always pulls",
    )


def lifted(result: RunRows) -> list[RowNote]:
    """Warns of rows in which a cable would leave a pulley, which then are slack, or the plane of
    one."""
    rows, units = result.row_states, result.problem.units
    found = []
    for name, extent, value in result.session.layout.extents(rows.states):
        where = rows.reached & is_lifted(extent, value)
        if where.any():
            rows.status[where & (rows.status == int(Status.ok))] = Status.slack
            what = f"{name} {extent.words} {extent.place}"
            words = partial(_lifts, units, what)
            code = Status.slack.label
            found.append(RowNote(code, "warning", what, where, words, -value, value.__getitem__))
    for name, fleet, value in result.session.layout.fleets(rows.states):
        where = rows.reached & (np.abs(value) > tolerances.FLEET)
        if where.any():
            rows.status[where & (rows.status == int(Status.ok))] = Status.fleet_angle
            what = f"{name} {fleet.words}"
            words = partial(_fleets, units, what)
            code = Status.fleet_angle.label
            found.append(RowNote(code, "warning", what, where, words, np.abs(value)))
    return found


def _lifts(units: UnitSystem, what: str, found: Found) -> Diagnostic:
    least = float(units.from_si(float(found.told), LENGTH))
    text = f"{what} in {found.rows.counted}: it is led as if it stuck there"
    measured = f"{least:.6g} {units.label(LENGTH)}"
    hint = "end the sweep before it, or leave that place out of the cable's path"
    return Diagnostic(Status.slack.label, "warning", text, None, measured, "0", hint)


def _fleets(units: UnitSystem, what: str, found: Found) -> Diagnostic:
    most = float(of_two("ATAN2", found.told, 1.0))
    text = f"{what} in {found.rows.counted}: it is led as if it did not"
    hint = "guide it in that plane, or lead it over a pulley that swivels: swivel: [0, 0, 1]"
    measured = f"fleet angle {units.text(most, ANGLE)}"
    code, limit = Status.fleet_angle.label, units.text(tolerances.FLEET, ANGLE)
    return Diagnostic(code, "warning", text, None, measured, limit, hint)


def is_slack(tension: Floats, level: Floats) -> Bools:
    """Whether strands push, beyond the rounding of reactions, whose largest are `level`."""
    return np.asarray(tension < -tolerances.UNIQUE_CELL * level)


def _undecided(result: RunRows, judged: Bools) -> Iterator[RowNote]:
    frictions = result.problem.mechanism.frictions
    states = [result.columns[q.name][0] for q in friction_states(result.problem.mechanism)]
    for code, (why, cure) in _WHY.items():
        masks = [judged & (state == int(code)) for state in states]
        where = np.any(masks, axis=0)
        if where.any():
            if code is FrictionState.AT_REST and not result.problem.motion.inputs:
                cure = "while all rests, each friction takes what holds it: positions are known"
            words = partial(_without_answer, frictions, why, cure)
            yield RowNote(CODE, "warning", code, where, words, marks=tuple(enumerate(masks)))


def _without_answer(frictions: Sequence[Rubbing], why: str, cure: str, found: Found) -> Diagnostic:
    named = [frictions[number] for number in sorted(found.marks)]
    text = f"{why.format(rubbing_words(named))}; forces stay empty in {found.rows.counted}"
    return Diagnostic(CODE, "warning", text, named[0].place, hint=cure)


def _not_unique(result: RunRows, judged: Bools) -> Iterator[RowNote]:
    """Friction by a reaction that redundant constraints leave arbitrary."""
    known = result.problem.quantities()
    frictions = result.problem.mechanism.frictions if result.shifts else ()
    names = [f"{rubbing.joint}.normal_load" for rubbing in frictions]
    wanted = [known[name] for name in names]
    if not wanted:
        return
    columns = [result.evaluated(wanted, shift=shift) for shift in (0, *result.shifts)]
    level = result.columns[REACTION_LEVEL.name][0]
    lost, named = np.zeros(judged.size, dtype=bool), []
    for number, (rubbing, name) in enumerate(zip(frictions, names, strict=True)):
        own, *others = (np.abs(each[name][0]) for each in columns)
        limit = tolerances.UNIQUE_CELL * np.fmax(own, level)
        is_unique = np.all([np.abs(other - own) <= limit for other in others], axis=0)
        where = judged & np.isfinite(own) & ~is_unique
        if where.any() and rubbing.at_rest != 0.0:
            lost |= where
            named.append((number, where))
    if named:
        words = partial(_arbitrary, frictions)
        yield RowNote("friction-not-unique", "error", "", lost, words, marks=named)


def _arbitrary(frictions: Sequence[Rubbing], found: Found) -> Diagnostic:
    return arbitrary_friction([frictions[number] for number in sorted(found.marks)])


def arbitrary_friction(named: Sequence[Rubbing]) -> Diagnostic:
    """Friction that goes by reactions which are not unique, and how to make them so."""
    lengths = ("length", "collar", "width")
    written = [key for key in lengths if any(getattr(one, key) is not None for one in named)]
    without = f", or leave out {' and '.join(written)}" if written else ""
    return Diagnostic(
        "friction-not-unique",
        "error",
        f"the {rubbing_words(named)} goes by reactions that redundant "
        "constraints leave arbitrary; forces stay empty",
        named[0].place,
        hint=f"free a joint of the loop (a sphere for a pin, a cylinder for a slide){without}",
    )


def _spinning(result: RunRows, judged: Bools) -> Iterator[RowNote]:
    """Friction that would drive an idle freedom."""
    problem = result.problem
    level, length = result.columns[REACTION_LEVEL.name][0], result.session.layout.length
    for freedom in idle.idle_freedoms(problem) if _holding(problem) else ():
        unit = 1.0 if freedom.slides else length
        holding = np.sqrt(sum(part * part for part in result.columns[freedom.holding]))
        where = judged & (holding > tolerances.UNIQUE_CELL * level * unit)
        if where.any():
            words = partial(_spins, problem, freedom)
            yield RowNote("loaded-spin", "error", freedom.holding, where, words, holding)


def _spins(problem: Problem, freedom: idle.Idle, found: Found) -> Diagnostic:
    dimension = FORCE if freedom.slides else MOMENT
    most = float(problem.units.from_si(found.told, dimension))
    motion, what = ("slide", "a force") if freedom.slides else ("spin", "a moment")
    return Diagnostic(
        "loaded-spin",
        "error",
        f"{freedom.words}, and friction drives it in {found.rows.counted}: the {motion} is a "
        "dynamic freedom, forces depend on it",
        measured=f"{most:.6g} {problem.units.label(dimension)}",
        hint=f"{freedom.cure}, or accept {what} that holds it with idle: hold",
    )


def unfounded_in_motion(problem: Problem, *, redundant: bool) -> Diagnostic | None:
    """Why a motion cannot be integrated with its friction: reactions that are arbitrary, or a
    joint that rubs at an idle link."""
    frictions, joints = problem.mechanism.frictions, problem.mechanism.joints
    if frictions and redundant:
        return arbitrary_friction(frictions)
    for freedom in idle.idle_freedoms(problem) if frictions and not problem.hold_idle else ():
        for rubbing in frictions:
            joint = rubbing.loss or joints[rubbing.joint]
            if (joint.first in freedom.links) != (joint.second in freedom.links):
                return Diagnostic(
                    "loaded-spin",
                    "error",
                    f"{freedom.words}, and {rubbing.word} of {rubbing.joint} may drive it: that is "
                    "a dynamic freedom, on which the motion depends",
                    rubbing.place,
                    hint=f"{freedom.cure}, or accept that it is held with idle: hold",
                )
    return None


def uncounted_notes(result: RunRows) -> list[RowNote]:
    """Loads of joints that rub which their friction does not go by, for lack of a length."""
    notes: list[RowNote] = []
    problem, known = result.problem, result.problem.quantities()
    sound = result.solved & (result.status != Status.dead_centre)
    for rubbing in problem.mechanism.frictions:
        law = None if rubbing.loss else problem.mechanism.joints[rubbing.joint].type.friction
        missed = [(k, w) for k, w in law.missed if getattr(rubbing, k) is None] if law else []
        if not missed or result.shifts or rubbing.at_rest == 0.0:
            continue
        wanted = [known[f"{rubbing.joint}.{word}"] for word in ("force", "moment", "axis")]
        columns = result.evaluated([*wanted, REACTION_LEVEL])
        force, moment, axis = (columns[q.name] for q in wanted)
        level = columns[REACTION_LEVEL.name][0]
        for key, load in missed:
            size, dimension = _uncounted(load, force, moment, axis)
            unit = 1.0 if dimension == FORCE else result.session.layout.length
            counts = sound & (size > tolerances.UNIQUE_CELL * level * unit)
            if counts.any():
                words = partial(_uncounted_note, rubbing, key, load, problem.units)
                about = rubbing.joint, load
                notes.append(RowNote("friction-uncounted", "warning", about, counts, words, size))
    return notes


def _uncounted(load: str, force: Floats, moment: Floats, axis: Floats) -> tuple[Floats, Dimension]:
    if load == "axial force":
        return np.abs(_dot(axis, force)), FORCE
    about = _dot(axis, moment)
    if load == "tilting moment":
        across = moment - about * axis
        return np.sqrt(_dot(across, across)), MOMENT
    return np.abs(about), MOMENT


def _dot(a: Floats, b: Floats) -> Floats:
    # what is infinite at a dead centre has no part along an axis
    with np.errstate(invalid="ignore"):
        product: Floats = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return product


def _uncounted_note(
    rubbing: Rubbing, key: str, load: str, units: UnitSystem, found: Found
) -> Diagnostic:
    dimension = FORCE if load == "axial force" else MOMENT
    most = float(units.from_si(found.told, dimension))
    measured = f"at most {most:.6g} {units.label(dimension)}"
    name = "moment about its axis" if load == "moment about it" else load
    return Diagnostic(
        "friction-uncounted",
        "warning",
        f"{rubbing.joint} carries {'an' if name[0] == 'a' else 'a'} {name}, and its friction does "
        "not count it",
        rubbing.place,
        measured=measured,
        hint=f"give the {key} of what takes it, or free the joint of it",
    )


def judged_by(problem: Problem, wanted: Iterable[Wanted], demand: Demand) -> list[Wanted]:
    """Quantities beside reactions by which forces are judged, read in the same run as `wanted`."""
    if not (demand & Demand.FORCES and is_judged(problem)):
        return []
    known = {quantity.name for quantity in wanted}
    return [q for q in verdict_quantities(problem) if q.name not in known]


def is_judged(problem: Problem) -> bool:
    """Whether forces may have no value in rows that have rates, or one that is doubtful."""
    return bool(problem.mechanism.frictions or problem.stopped or _strands(problem))


def _judged(result: RunRows) -> FrictionVerdict:
    """The verdict on all rows, whose statuses and messages the result then has."""
    rows = result.row_states
    loose, unfounded, said = unsupported(result)
    lost = loose
    if result.problem.mechanism.frictions:
        undecided, empty, more = friction_verdict(result)
        rows.status[undecided] = Status.friction_undecided
        lost, unfounded, said = loose | undecided, unfounded | empty, said + more
    rows.status[loose] = Status.unsupported
    for note in _slack(result, lost):
        rows.status[note.where & (rows.status == int(Status.ok))] = Status.slack
        said.append(note)
    rows.diagnostics += said
    return lost, unfounded, said


class FrictionRows:
    """Rows of one result whose forces have no value for their friction, or for want of support."""

    def __init__(self) -> None:
        self.verdict: FrictionVerdict | None = None

    @property
    def is_lost(self) -> bool:
        """Whether a row has no forces."""
        return self.verdict is not None and bool(self.verdict[0].any())

    def join(self, verdicts: Sequence[FrictionVerdict | None], own: Sequence[slice]) -> None:
        """Takes the verdicts on parts of the rows, of which some are their own."""
        known = [verdict for verdict in verdicts if verdict is not None]
        if len(known) == len(own):
            both = zip(known, own, strict=True)
            lost, unfounded = zip(*((v[0][rows], v[1][rows]) for v, rows in both), strict=True)
            said = [note for verdict in known for note in verdict[2]]
            self.verdict = np.concatenate(lost), np.concatenate(unfounded), said

    def beside(self, problem: Problem, wanted: Iterable[Wanted], demand: Demand) -> list[Wanted]:
        """What `judged_by` names, until the rows are judged."""
        return [] if self.verdict is not None else judged_by(problem, wanted, demand)

    def judge(self, result: RunRows, wanted: Iterable[Wanted], demand: Demand) -> None:
        """Judges the rows once; empties forces, new and known, that have no ground."""
        if not (demand & Demand.FORCES and is_judged(result.problem)):
            return
        read = list(wanted)
        is_first = self.verdict is None
        if self.verdict is None:
            self.verdict = _judged(result)
        _, unfounded, _ = self.verdict
        if is_first:
            known = result.problem.quantities()
            read += [known[name] for name in result.columns if name in known]
            if result.power_error.size and unfounded.any():
                result.power_error[unfounded] = np.nan
        for quantity in read:
            if quantity.kind in FORCE_KINDS and quantity.name in result.columns:
                result.columns[quantity.name][:, unfounded] = np.nan
