"""What a sweep has to say of friction: rows without an answer, self-locking, loads not counted."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism import REACTION_LEVEL, SELF_LOCKING, friction_states
from mechkin_cli.plan import FORCE_KINDS, Demand, FrictionState
from mechkin_cli.units import FORCE, MOMENT
from mechkin_cli.verdict import Status, has_rates

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Problem, Rubbing, Wanted
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.sweep.rows import RunRows
    from mechkin_cli.units import Dimension


CODE = "friction-undecided"

_WHY = {
    FrictionState.AT_REST: (
        "friction of {} has no direction: nothing slides there, or is about to",
        "give the inputs the rate, or the acceleration, of the motion that is meant; a joint that "
        "never moves needs no friction",
    ),
    FrictionState.NOT_UNIQUE: (
        "friction of {} may jam: no proof that its forces are the only ones",
        "make the coefficient smaller or the bearings longer, or drive the mechanism elsewhere",
    ),
    FrictionState.NOT_SOLVED: (
        "friction of {} has no forces in balance with its reactions",
        "make the coefficient smaller, or move the sweep by a fraction of its step",
    ),
}
"""What is said of a row without an answer, and what to do."""


class FrictionVerdict(NamedTuple):
    """Rows (rows,) in which some forces have no value, those of them in which all would be
    unfounded, and what to say."""

    lost: Bools
    unfounded: Bools
    diagnostics: list[Diagnostic]


def verdict_quantities(problem: Problem) -> list[Wanted]:
    """What forces with friction are judged by."""
    mechanism = problem.mechanism
    if not mechanism.frictions:
        return []
    return [*friction_states(mechanism), SELF_LOCKING, REACTION_LEVEL, *_holding(problem)]


def _holding(problem: Problem) -> list[Wanted]:
    """What holds the idle freedoms, where the file does not accept that something does."""
    from mechkin_cli.idle import idle_freedoms

    if problem.hold_idle:
        return []
    known = problem.quantities()
    return [known[name] for name in dict.fromkeys(i.holding for i in idle_freedoms(problem))]


def friction_verdict(result: RunRows) -> FrictionVerdict:
    """The verdict on the friction of a result, whose verdict quantities have been read."""
    rows, problem = result.row_states, result.problem
    judged = rows.reached & has_rates(rows.status)
    lost, unfounded = np.zeros((2, judged.size), dtype=bool)
    diagnostics = []
    for where, diagnostic in _undecided(result, judged):
        lost |= where
        diagnostics.append(diagnostic)
    for where, diagnostic in (*_not_unique(result, judged), *_spinning(result, judged)):
        unfounded |= where
        diagnostics.append(diagnostic)
    lost |= unfounded
    locking = judged & (result.columns[SELF_LOCKING.name][0] > 0.0) & ~lost
    if locking.any():
        diagnostics.append(_self_locking(problem, locking))
    return FrictionVerdict(lost, unfounded, diagnostics)


Finding = Iterator[tuple["Bools", Diagnostic]]


def _undecided(result: RunRows, judged: Bools) -> Finding:
    frictions = result.problem.mechanism.frictions
    states = [result.columns[q.name][0] for q in friction_states(result.problem.mechanism)]
    for code, (why, cure) in _WHY.items():
        found = [judged & (state == int(code)) for state in states]
        named = [one for one, where in zip(frictions, found, strict=True) if where.any()]
        if named:
            where = np.any(found, axis=0)
            if code is FrictionState.AT_REST and not result.problem.motion.inputs:
                cure = "while all rests, each friction takes what holds it: positions are known"
            text = f"{why.format(_list(named))}; forces stay empty in {_rows(where)}"
            yield where, Diagnostic(CODE, "warning", text, named[0].place, hint=cure)


def _list(named: Sequence[Rubbing]) -> str:
    return ", ".join(one.joint for one in named)


def _not_unique(result: RunRows, judged: Bools) -> Finding:
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
    for rubbing, name in zip(frictions, names, strict=True):
        own, *others = (np.abs(each[name][0]) for each in columns)
        limit = tolerances.UNIQUE_CELL * np.fmax(own, level)
        where = judged & np.isfinite(own) & ~_all_near(own, others, limit)
        if where.any() and rubbing.at_rest != 0.0:
            lost |= where
            named.append(rubbing)
    if named:
        yield lost, arbitrary_friction(named)


def _all_near(own: Floats, others: Sequence[Floats], limit: Floats) -> Bools:
    near = np.ones(own.size, dtype=bool)
    for other in others:
        near &= np.abs(other - own) <= limit
    return near


def arbitrary_friction(named: Sequence[Rubbing]) -> Diagnostic:
    """Friction that goes by reactions which are not unique, and how to make them so."""
    lengths = ("length", "collar", "width")
    given = [key for key in lengths if any(getattr(one, key) is not None for one in named)]
    without = f", or leave out {' and '.join(given)}" if given else ""
    return Diagnostic(
        "friction-not-unique",
        "error",
        f"the friction of {_list(named)} goes by reactions that redundant "
        "constraints leave arbitrary; forces stay empty",
        named[0].place,
        hint=f"free a joint of the loop (a sphere for a pin, a cylinder for a slide){without}",
    )


def _spinning(result: RunRows, judged: Bools) -> Finding:
    """Friction that would drive an idle freedom."""
    from mechkin_cli.idle import idle_freedoms

    problem = result.problem
    level, length = result.columns[REACTION_LEVEL.name][0], result.session.layout.length
    for idle in idle_freedoms(problem) if _holding(problem) else ():
        unit = 1.0 if idle.slides else length
        holding = np.sqrt(sum(part * part for part in result.columns[idle.holding]))
        where = judged & (holding > tolerances.UNIQUE_CELL * level * unit)
        if where.any():
            dimension = FORCE if idle.slides else MOMENT
            most = float(problem.units.from_si(float(np.max(holding[where])), dimension))
            motion, what = ("slide", "a force") if idle.slides else ("spin", "a moment")
            yield (
                where,
                Diagnostic(
                    "loaded-spin",
                    "error",
                    f"{idle.words}, and friction drives it in {_rows(where)}: the {motion} is a "
                    "dynamic freedom, forces depend on it",
                    measured=f"{most:.6g} {problem.units.label(dimension)}",
                    hint=f"{idle.cure}, or accept {what} that holds it with idle: hold",
                ),
            )


def unfounded_in_motion(problem: Problem, *, redundant: bool) -> Diagnostic | None:
    """Why a motion cannot be integrated with its friction: reactions that are arbitrary, or a
    joint that rubs at an idle link."""
    from mechkin_cli.idle import idle_freedoms

    frictions, joints = problem.mechanism.frictions, problem.mechanism.joints
    if frictions and redundant:
        return arbitrary_friction(frictions)
    for idle in idle_freedoms(problem) if frictions and not problem.hold_idle else ():
        for rubbing in frictions:
            joint = joints[rubbing.joint]
            if (joint.first in idle.links) != (joint.second in idle.links):
                return Diagnostic(
                    "loaded-spin",
                    "error",
                    f"{idle.words}, and friction of {joint.name} may drive it: that is a dynamic "
                    "freedom, on which the motion depends",
                    rubbing.place,
                    hint=f"{idle.cure}, or accept that it is held with idle: hold",
                )
    return None


def _self_locking(problem: Problem, locking: Bools) -> Diagnostic:
    return Diagnostic(
        "self-locking",
        "note",
        f"in {_rows(locking)} a drive would brake without friction and has to push with it: the "
        "loads alone do not move the mechanism there",
    )


def uncounted_notes(result: RunRows) -> list[Diagnostic]:
    """Loads of joints that rub which their friction does not go by, for lack of a length."""
    notes: list[Diagnostic] = []
    problem, known = result.problem, result.problem.quantities()
    sound = result.solved & (result.status != Status.dead_centre)
    for rubbing in problem.mechanism.frictions:
        law = problem.mechanism.joints[rubbing.joint].type.friction
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
                most = float(problem.units.from_si(float(np.max(size[counts])), dimension))
                measured = f"at most {most:.6g} {problem.units.label(dimension)}"
                notes.append(_uncounted_note(rubbing, key, load, measured))
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


def _uncounted_note(rubbing: Rubbing, key: str, load: str, measured: str) -> Diagnostic:
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


def _rows(where: Bools) -> str:
    numbers = np.flatnonzero(where) + 1
    if numbers.size == 1:
        return f"row {numbers[0]}"
    if numbers.size == where.size:
        return "all rows"
    return f"{numbers.size} rows, first in row {numbers[0]}"


# The rows' verdict on friction, found when forces are read for the first time.


def judged_by(problem: Problem, wanted: Iterable[Wanted], demand: Demand) -> list[Wanted]:
    """What forces with friction are judged by, to be read in the run of `wanted`."""
    if not (demand & Demand.FORCES and problem.mechanism.frictions):
        return []

    known = {quantity.name for quantity in wanted}
    return [q for q in verdict_quantities(problem) if q.name not in known]


class FrictionRows:
    """What friction makes of the rows of one result."""

    def __init__(self) -> None:
        self.verdict: FrictionVerdict | None = None

    @property
    def is_lost(self) -> bool:
        """Whether a row has no forces for want of a friction."""
        return self.verdict is not None and bool(self.verdict.lost.any())

    def beside(self, problem: Problem, wanted: Iterable[Wanted], demand: Demand) -> list[Wanted]:
        """What `judged_by` names, until the rows are judged."""
        return [] if self.verdict is not None else judged_by(problem, wanted, demand)

    def judge(self, result: RunRows, wanted: Iterable[Wanted], demand: Demand) -> None:
        """Judges the rows once; empties forces, new and known, that have no ground."""
        if not (demand & Demand.FORCES and result.problem.mechanism.frictions):
            return
        read = list(wanted)
        if self.verdict is None:
            self.verdict, rows = friction_verdict(result), result.row_states
            rows.diagnostics += self.verdict.diagnostics
            rows.status[self.verdict.lost] = Status.friction_undecided
            known = result.problem.quantities()
            read += [known[name] for name in result.columns if name in known]
            if result.power_error.size and self.verdict.unfounded.any():
                result.power_error[self.verdict.unfounded] = np.nan
        for quantity in read:
            if quantity.kind in FORCE_KINDS and quantity.name in result.columns:
                result.columns[quantity.name][:, self.verdict.unfounded] = np.nan
