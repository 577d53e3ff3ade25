"""The sweep: first assembly, following, one batched run of what is demanded, a verdict per row."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import derived, idle, tolerances
from mechkin_cli.assembly import choose_start, rows_of_start
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.mechanism import (
    COEFFICIENT_KINDS,
    DERIVED_KINDS,
    LEDGER_KINDS,
    TRANSMISSION_KINDS,
    LongRun,
    Moments,
    base_name,
    base_quantity,
    dimension_of,
    quantities_read,
    read_for,
)
from mechkin_cli.memo import remembered
from mechkin_cli.plan import REACTION_KINDS, Demand, demand_of
from mechkin_cli.record import replace
from mechkin_cli.session import Ask, assembly_size
from mechkin_cli.sweep.following import follow_rows, followed_session
from mechkin_cli.sweep.friction import judged_by, lifted, uncounted_notes
from mechkin_cli.sweep.limits import judge_limits, limited
from mechkin_cli.sweep.messages import (
    actuation_notes,
    condition_notes,
    first_order_note,
    first_row,
    locked_pose_notes,
    not_converged_note,
    open_turn_note,
    redundancy_note,
    unrated_notes,
    watched,
)
from mechkin_cli.sweep.parts import Part, has_parts, joined_rows, parts_of
from mechkin_cli.sweep.result import Result
from mechkin_cli.sweep.slopes import bending, slope_notes
from mechkin_cli.units import TIME
from mechkin_cli.verdict import Status, are, by_condition, rates_are_clear

if TYPE_CHECKING:
    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.derived import LedgerRows
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.mechanism import DrivenInput, Problem, Wanted
    from mechkin_cli.row_notes import Note
    from mechkin_cli.session import Batch, Session
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.sweep.messages import FirstRow
    from mechkin_cli.sweep.rows import SweepRows


@remembered
def question(
    session: Session, asked: tuple[Wanted, ...], *, verdicts: bool
) -> tuple[tuple[Wanted, ...], Ask, bool]:
    """The quantities of a sweep.

    Args:
        verdicts: each row's condition, and its power error where forces are computed.

    Returns:
        Those asked for, and those by which the rows are judged beside them; what the run that
        closes the rows computes, no derived quantities; whether some are not unique where reactions
        are not.
    """
    problem, everything = session.problem, list(asked)
    everything += held_moments(problem, everything)
    everything += watched(problem, everything)
    everything += limited(problem)
    everything += bending(problem)
    wanted, demand = at_once(session, everything, verdicts)
    wanted += judged_by(problem, wanted, demand)
    ask = Ask(demand, session.readout(wanted) if wanted else None)
    return tuple(everything), ask, rest_on_reactions(problem, everything)


def held_moments(problem: Problem, asked: Sequence[Wanted]) -> list[Wanted]:
    """The moments that hold idle freedoms, where forces are computed and they are not asked for."""
    if not (problem.hold_idle and demand_of(problem.mechanism, asked) & Demand.FORCES):
        return []
    known = problem.quantities()
    moments = {known[freedom.holding] for freedom in idle.idle_freedoms(problem)}
    return sorted(moments.difference(asked))


def at_once(
    session: Session, asked: Sequence[Wanted], verdicts: bool
) -> tuple[list[Wanted], Demand]:
    """Quantities of the run that closes the rows, and its demand: no derived ones."""
    mechanism = session.problem.mechanism
    wanted = [q for q in asked if q.kind not in DERIVED_KINDS and q.owner != "row"]
    demand = demand_of(mechanism, wanted)
    if verdicts and session.graph.blocks:
        demand |= Demand.CONDITION
    if verdicts and demand & Demand.FORCES and demand & Demand.VELOCITY:
        demand |= Demand.POWER
    return wanted, demand


def rest_on_reactions(problem: Problem, asked: Sequence[Wanted]) -> bool:
    """Whether some quantities are not unique where reactions are not."""
    kinds = {*REACTION_KINDS, *TRANSMISSION_KINDS}
    return any(
        base_quantity(problem.quantities(), base_name(quantity)).kind in kinds
        if quantity.kind in COEFFICIENT_KINDS
        else quantity.kind in kinds
        for quantity in asked
    )


def analyze(
    session: Session,
    quantities: Iterable[str] = (),
    *,
    verdicts: bool = True,
    unasked: Collection[str] = (),
) -> Result:
    """Runs the sweep of a session's problem and reads the quantities asked for.

    Args:
        session: the problem in the kernel.
        quantities: names out of `problem.quantities()`.
        verdicts: compute each row's condition, and its power error where forces are computed.
        unasked: quantities that a run adds by default; their missing rates are not reported.

    Raises:
        KeyError: an unknown quantity.
    """
    return Sweep(session, quantities, verdicts=verdicts, unasked=unasked).run()


@remembered
def _wanted(session: Session, names: tuple[str, ...]) -> list[Wanted]:
    """The quantities of some names, with those that they are read for."""
    known = session.problem.quantities() if names else {}
    return [known[name] for name in read_for(names, known)]


class Sweep:
    """A sweep that is to be run; arguments and errors are those of `analyze`."""

    def __init__(
        self,
        session: Session,
        quantities: Iterable[str] = (),
        *,
        verdicts: bool = True,
        unasked: Collection[str] = (),
    ) -> None:
        rest = session.problem.motion.rest
        if rest is not None and not rest.solved:
            raise UsageError(
                "this sweep has coordinates at rest (motion: rest:), and where they are is found "
                "by analyze()"
            )
        self.asked = _wanted(session, tuple(dict.fromkeys(quantities)))
        self.unasked = unasked
        if session.problem.follow is not None:
            session = followed_session(session, [*self.asked, *limited(session.problem)])
        session, start = first_assembly(session)
        if start.stuck:
            from mechkin_cli.sweep.branch_end import input_faults

            start = replace(start, diagnostics=input_faults(session) or start.diagnostics)
        self.session, self.start = session, start
        self.question = question(session, tuple(self.asked), verdicts=verdicts)

    @property
    def run_rows(self) -> int:
        """Number of rows."""
        return self.session.problem.motion.rows

    def run(self) -> Result:
        """All rows at once.

        Raises:
            UsageError: they do not fit in memory.
        """
        motion = self.session.problem.motion
        if isinstance(motion, LongRun):
            _ = motion.whole  # refused before anything is computed
        if not has_parts(self.session):
            return self._judged(self.session, self.start, None)
        found = list(self.parts(held=True))
        rows = joined_rows(found, self.session)
        result = Result(self.session, self.start, rows, motion_between)
        result.join([part.result for part in found], [part.own for part in found])
        result.read(self.question[0])  # what depends on the rows of the whole run
        return result

    def parts(self, *, held: bool = False) -> Iterator[Part]:
        """The rows in order, part by part; one part, if they are few. `held`: whether all parts are
        held, so that what goes by all rows needs no run of its own."""
        if not has_parts(self.session):
            result = self._judged(self.session, self.start, None)
            yield Part(result, slice(0, result.rows))
            return
        first: FirstRow | None = None
        for part in self._with_energies(held=held):
            rows = part.result.row_states
            if rows.span.first == 0:
                first = first_row(rows_of_start(self.session)[0], rows)
            note = open_turn_note(part.result.session, rows, first)
            rows.diagnostics += [note] if note else []
            # only the first whole turn is told
            first = None if note else first
            yield part

    @property
    def _energies(self) -> list[Wanted]:
        """Those asked for that depend on all rows before a row."""
        return [each for each in self.question[0] if each.kind in LEDGER_KINDS]

    def _with_energies(self, *, held: bool) -> Iterator[Part]:
        """The parts of the run with what depends on the rows before them, and behind them."""
        wanted = self._energies
        if not wanted:
            yield from parts_of(self.session, self.start, self._judged)
            return
        size, ledgers = 0.0, self._ledgers()
        if any(each.kind == "ledger_energy_error" for each in wanted):
            if held:
                every = [*ledgers]
                size = max((rows.size for _, rows in every), default=0.0)
                ledgers = iter(every)
            else:
                size = self._largest_energy
        for part, rows in ledgers:
            begin, end, _ = part.own.indices(part.result.rows)
            found = rows.columns(size)
            for each in wanted:
                column = np.full((1, part.result.rows), np.nan)
                column[0, begin:end] = found[each.kind.removeprefix("ledger_")]
                part.result.take({each.name: column})
            yield part

    def _ledgers(self) -> Iterator[tuple[Part, LedgerRows]]:
        """The parts of the run with their energies: a part waits until those rows of the next one
        are known that its last intervals are read from."""
        ledger = derived.RunningLedger(self.session, self._largest_power)
        waiting: deque[Part] = deque()
        for part in parts_of(self.session, self.start, self._judged):
            waiting.append(part)
            for rows in ledger.add(part.result.basis, part.own):
                yield waiting.popleft(), rows

    @cached_property
    def _largest_power(self) -> float:
        """Of all rows, W, where integrals are made to errors in parts of it: the run is made to
        tell."""
        largest = 0.0
        if not self.session.problem.mechanism.frictions:
            return largest
        for part in parts_of(self.session, self.start, self._judged):
            run = part.result.basis
            if not derived.needs_largest_power(run):
                break
            largest = max(largest, derived.largest_power(run, part.own))
        return largest

    @cached_property
    def _largest_energy(self) -> float:
        """Of all rows, J, in parts of which the error of energies is: the run is made to tell."""
        return max((rows.size for _, rows in self._ledgers()), default=0.0)

    def _judged(self, session: Session, start: AssemblyStart, rows: SweepRows | None) -> Result:
        """The rows of a session, which is all of the run or a part, on the branch through a first
        assembly: closed, read and judged. They are followed here if they are None."""
        wanted, ask, rests_on_reactions = self.question
        result = _closed(session, start, ask, rows)
        is_part = session is not self.session
        if is_part:
            result.run_start = self.session, self.start
            wanted = tuple(each for each in wanted if each.kind not in LEDGER_KINDS)
        result.read(wanted)
        judge_limits(result)
        notes = result.row_states.diagnostics
        notes += row_notes(result, wanted, rests_on_reactions=rests_on_reactions)
        notes += [*actuation_notes(result), *locked_pose_notes(result)]
        notes += slope_notes(result)
        failed = any(note.severity == "error" for note in notes)
        if np.count_nonzero(result.solved) and not failed:
            notes += unrated_notes(session.problem, self.asked, self.unasked)
        return result


def closed_rows(
    session: Session, start: AssemblyStart, asked: Sequence[Wanted] = (), *, verdicts: bool = False
) -> Result:
    """The rows of a session on the branch through the start, with what is asked for and their
    conditions where `verdicts` are, too."""
    wanted, ask, _ = question(session, tuple(asked), verdicts=verdicts)
    result = _closed(session, start, ask)
    result.read(wanted)
    judge_limits(result)
    return result


def first_assembly(session: Session) -> tuple[Session, AssemblyStart]:
    """The first assembly, and the session with residual and condition in parts of its size."""
    start = choose_start(session)
    if start.state is None or session.size is not None:
        return session, start
    return _in_parts_of_its_size(session), start


@remembered
def _in_parts_of_its_size(session: Session) -> Session:
    """The session with residual and condition in parts of the size of its first assembly."""
    start = choose_start(session)
    assert start.state is not None
    few, rows = rows_of_start(session)
    row = start.row if rows is None else int(np.searchsorted(rows, start.row))
    inputs = few.inputs.reduced[:, row]
    return session.sized(assembly_size(session.plan, inputs, start.state))


def _closed(
    session: Session, start: AssemblyStart, ask: Ask, rows: SweepRows | None = None
) -> Result:
    """Closes all rows, which are followed if they are None, and reads what can be read at once."""
    result = _closed_once(session, start, ask, rows or follow_rows(session, start))
    if result.row_states.has_failed:
        # a filled-in row ended away from its guess: take every row as a careful step
        result = _closed_once(session, start, ask, follow_rows(session, start, every_row=True))
    return result


def _closed_once(session: Session, start: AssemblyStart, ask: Ask, rows: SweepRows) -> Result:
    """The same of rows that were followed; those that do not close are no longer marked as
    reached."""
    # of few rows `any` and `all` take five times as long as counting, and short runs are many
    result = Result(session, start, rows, motion_between)
    reached = np.count_nonzero(rows.reached)
    if not reached:
        return result
    batch = result.run(ask)
    if batch.all_closed and reached == rows.reached.size:
        rows.states = batch.states
    else:
        batch = _closed_one_by_one(result, ask, batch)
        reached = np.count_nonzero(rows.reached)
    if reached:
        _judge_inputs(session, rows)
        if rows.dead_centres and ask.readout is not None:
            on_states = ask._replace(iterations=0)
            batch = batch._replace(outputs=result.run(on_states).outputs)
    result.keep(batch, ask)
    return result


def _closed_one_by_one(result: Result, ask: Ask, batch: Batch) -> Batch:
    """What a run found of the rows, which are judged each by itself."""
    session, rows = result.session, result.row_states
    slow = rows.reached & ~batch.good
    near = slow | rows.reached & _is_near_singular(batch)
    if result.graph.blocks and np.count_nonzero(near):
        batch = _closed_on_fold(result, ask)
        # what takes more steps and is no fold had a wrong guess
        slow &= ~_is_near_singular(batch)
    failed = slow | _failed(batch, rows)
    if np.count_nonzero(failed):
        rows.status[failed] = Status.not_converged
        rows.diagnostics.append(not_converged_note(rows, batch.residual))
        rows.reached &= ~failed
    if reached := np.count_nonzero(rows.reached):
        if reached == rows.reached.size:
            rows.states = batch.states
        else:
            rows.states[:, rows.reached] = batch.states[:, rows.reached]
        judge_condition(session, rows, batch, ask)
    return batch


def _is_near_singular(batch: Batch) -> Bools:
    """Rows (rows,) above that condition, as far as it was computed."""
    if batch.condition is None:
        return np.zeros(batch.residual.size, dtype=bool)
    return np.asarray(batch.condition > tolerances.CONDITION_NEAR_SINGULAR)


def _closed_on_fold(result: Result, ask: Ask) -> Batch:
    """The run with so many steps that rows on a fold close, too, where each only halves what is
    left; and with conditions, which show that they do."""
    demand = ask.demand | Demand.CONDITION
    return result.run(ask._replace(demand=demand, iterations=tolerances.FOLD_ITERATIONS))


def _failed(batch: Batch, rows: SweepRows) -> Bools:
    """Rows with a guess that did not close near it, on its side of every fold.

    Sides are there where the run demanded more than positions.
    """
    limit = rows.limit
    failed: Bools = rows.reached & ~(batch.good & (batch.correction <= limit))
    if batch.condition is not None and np.count_nonzero(failed):
        # next to singular places branches may be nearer than a position is known to rounding
        known = np.where(
            batch.condition <= tolerances.CONDITION_RANK_UNCLEAR,
            tolerances.CORRECTION_ROUNDING * batch.condition,
            0.0,
        )
        limit = np.maximum(limit, known)
        on_fold = batch.condition > tolerances.CONDITION_SIDE_UNCLEAR
        limit = np.where(on_fold, tolerances.FOLD_CORRECTION * limit, limit)
        failed = rows.reached & ~(batch.good & (batch.correction <= limit))
    assert batch.side is not None
    if not np.count_nonzero(batch.side != batch.side[:, :1]):
        return failed
    # on a fold or a branch point a sign is rounding
    certain = rows.reached.copy()
    if batch.condition is not None:
        certain &= batch.condition <= tolerances.CONDITION_SIDE_UNCLEAR
    # where a branch point was passed sides change with it: each section has its own
    turned = np.zeros(certain.size, dtype=bool)
    for section in set(rows.section[certain].tolist()):
        own = np.flatnonzero(certain & (rows.section == section))
        turned[own] = (batch.side[:, own] != batch.side[:, own[:1]]).any(axis=0)
    return failed | rows.reached & turned


def judge_condition(
    session: Session, rows: SweepRows, batch: Batch, ask: Ask | None = None
) -> None:
    """Verdicts by condition, and how many digits the rows of a sweep have where it may leave few:
    `ask` is what the batch answers, None of a response."""
    condition = batch.condition
    if condition is None or (condition <= tolerances.CONDITION_FEW_DIGITS).all():
        return
    from mechkin_cli.sweep.dead_centre import few_digits_notes, judge_dead_centres

    if not rates_are_clear(condition).all():
        judged = rows.reached & are(rows.status, Status.ok)
        rows.status[judged] = by_condition(condition[judged])
        judge_dead_centres(session, rows, condition)
        rows.diagnostics += condition_notes(rows, condition)
    if ask is not None:
        rows.diagnostics += few_digits_notes(session, rows, batch, ask)


def _judge_inputs(session: Session, rows: SweepRows) -> None:
    """Names inputs that cannot move; the rates of no row mean anything where they are to move: more
    equations than unknowns leave a least square, whose condition means nothing."""
    if not session.is_redundant or not session.driven or not rows.reached.any():
        return
    from mechkin_cli.session import moves_freely

    row = int(np.argmax(rows.reached))
    if moves_freely(session, session.inputs.values[:, row], rows.states[:, row]):
        return
    from mechkin_cli.sweep.branch_end import input_faults

    faults = input_faults(session)
    rows.diagnostics.extend(fault for fault in faults if fault not in rows.diagnostics)
    if faults and any(moved.any() for moved in session.inputs.orders[1:]):
        rows.status[rows.reached] = Status.rank_unclear
        rows.dead_centres.clear()


def _read_by_loads(result: Result) -> list[Wanted]:
    """What loads that vary read, where forces are computed."""
    if not (result.demand & Demand.FORCES and result.problem.load_laws):
        return []
    known = result.problem.quantities()
    return [known[name] for name in quantities_read(result.problem)]


@remembered
def _conventional_notes(session: Session, read: tuple[Wanted, ...]) -> list[Diagnostic]:
    return idle.conventional_notes(session.problem, read)


def row_notes(result: Result, asked: Sequence[Wanted], *, rests_on_reactions: bool) -> list[Note]:
    """What is conventional, left open by a full turn, held, or not unique."""
    problem, session, rows = result.problem, result.session, result.row_states
    notes: list[Note] = []
    if problem.has_idle:
        notes += idle.nearly_common_notes(problem)
        read = [*asked, *_read_by_loads(result)]
        notes += _conventional_notes(session, tuple(read))
        if problem.hold_idle:
            named = {freedom.holding for freedom in idle.idle_freedoms(problem)}
            found = {q.name: result.columns[q.name] for q in asked if q.name in named}
            notes += idle.holding_notes(problem, found)
    if problem.stopped and rows.reached.any():
        notes.append(first_order_note(problem))
    unclear = are(rows.status, Status.rank_unclear)
    if np.count_nonzero(unclear) and (session.is_redundant or unclear[rows.reached].all()):
        said = {diagnostic.code for diagnostic in rows.diagnostics}
        from mechkin_cli.sweep.branch_end import input_faults

        faults = input_faults(session)
        notes += [fault for fault in faults if fault.code not in said]
        if faults:
            # the condition of what is not driven, or cannot move, says no more
            unsaid = Status.rank_unclear.label
            rows.diagnostics[:] = [d for d in rows.diagnostics if d.code != unsaid]
    if problem.mechanism.frictions and result.demand & Demand.FORCES:
        notes += uncounted_notes(result)
    if rows.span.rows == rows.span.run_rows:
        note = open_turn_note(session, rows, first_row(session, rows))
        notes += [note] if note else []
    notes += lifted(result) if problem.mechanism.couplings else []
    if rests_on_reactions and session.is_redundant and rows.reached.any():
        notes.append(redundancy_note(result, asked))
    return notes


def motion_between(result: Result) -> Callable[[Floats], Result] | None:
    """Gives the sweep at other moments (`_at`); None where the motion is not known between the
    rows: without time, and where several inputs move by one motor, whose rates by it are those of
    the rows."""
    motion = result.problem.motion
    if motion.time is None or motion.course is None or motion.constraints:
        return None
    return partial(_at, result)


def _at(result: Result, written: Floats) -> Result:
    """The sweep at rising moments within its own, in the file's unit, and at that of its first
    assembly, which may be none of them: rows (moments,) or one more."""
    from mechkin_cli.session import places_at

    session, problem, start = result.session, result.problem, result.start
    time, course = problem.motion.time, problem.motion.course
    assert time is not None
    assert course is not None
    first = time.written[start.row]
    moments = np.unique(np.concatenate([written, [first]]))
    motion = problem.motion._replace(
        inputs=tuple(_inputs(result, moments)),
        rows=moments.size,
        time=Moments(problem.units.to_si(moments.copy(), TIME), moments),
    )
    values = np.stack([item.values for item in motion.inputs])
    motion = motion._replace(course=places_at(course, moments, values))
    row = int(np.searchsorted(moments, first))
    return closed_rows(session.moved(replace(problem, motion=motion)), replace(start, row=row))


def _inputs(result: Result, moments: Floats) -> list[DrivenInput]:
    """The inputs at some moments, with no jerk."""
    session, units = result.session, result.problem.units
    inputs, route = result.problem.motion.inputs, session.route
    assert route is not None
    edges = route.course.edges
    cells = np.clip(np.searchsorted(edges, moments) - 1, 0, edges.size - 2)
    jets = np.zeros((moments.size, len(inputs), 4))
    for cell in np.unique(cells):
        here = cells == cell
        jets[here, :, :3] = route.jets(int(cell), moments[here]) * route.units[:, None]
    second, found = float(units.to_si(1.0, TIME)), []
    for k, item in enumerate(inputs):
        written, orders = [], []
        dimension, unit = dimension_of(item.coordinate), 1.0
        for order in range(jets.shape[2]):
            orders.append(jets[:, k, order] / unit)
            written.append(units.from_si(orders[-1].copy(), dimension))
            dimension, unit = dimension / TIME, unit * second
        values, rates, accelerations, jerks = orders
        found.append(
            item._replace(
                values=values,
                rates=rates,
                accelerations=accelerations,
                jerks=jerks,
                written_orders=np.array(written),
            )
        )
    return found
