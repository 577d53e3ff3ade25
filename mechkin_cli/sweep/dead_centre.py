"""Rows that stand at a dead centre: there a coordinate goes as the root of what is left of the
input, so that its rates, and what a load costs the input, grow without bound.

Doubles give the position there to half its digits, and of the rates none. So these are not taken
from the row: two places a little before it on its branch show what grows towards it.

Rates of which no digit is left are found in double-double. A row's states x are closed in doubles,
and next to a dead centre a few roundings of that, of the file's constants or of an input are a
large part of the distance from it, with which rates go. How large is seen by one step of Newton's
method with the numbers as the file writes them,

    x + dx,   J dx = -F(x),   F in double-double,

and the rates there. At a dead centre itself J is singular at the true place: the step goes half
the way to it, from wherever rounding has left the row, and all that grows there doubles. Beside
it the step ends at the true place but for its square. A row that has come so near that one
rounding of an input u is as much, |x''| eps against |x'|, may be right by chance, or on the other
branch.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import assembly
from mechkin_cli.assembly import PlacesBefore, at_unit_rate, continued_start, left_for, unit_rates
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.plan import Demand, demand_of
from mechkin_cli.row_notes import Found, RowNote
from mechkin_cli.session import (
    Ask,
    KernelInputs,
    PreciseConstants,
    RowInputs,
    precise_inputs,
)
from mechkin_cli.sweep.messages import condition_text
from mechkin_cli.tape import TraceLost
from mechkin_cli.tolerances import (
    BEFORE_DEAD_CENTRE,
    CONDITION_FEW_DIGITS,
    DEAD_CENTRE_LOST,
    DIGITS_OF_PLACES,
    FEW_DIGITS,
    GROWS_WITHOUT_BOUND,
    ON_FOLD,
    REACTION_ROUNDING,
    RESTS,
)
from mechkin_cli.verdict import CONDITION_LIMITS, Status, has_rates, rates_are_clear

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.session import Batch, Session
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.sweep.rows import SweepRows


def places_before(session: Session, rows: SweepRows, row: int) -> list[PlacesBefore]:
    """The places before a row: followed from another row that is clear of the fold; where there
    is none, left for along the branches that meet in the row: along that of other rows, or that
    which `near` means, or along both."""
    before = _followed(session, rows, row)
    if before is not None:
        return [before]
    return _chosen(session, rows, row, left_for(session, row, rows.states[:, row]))


def _followed(session: Session, rows: SweepRows, row: int) -> PlacesBefore | None:
    """Along the branch of the nearest row that is clear of the fold, towards it or, where that row
    stands nearer, away from it. None where there is no such row, or where the branch does not lead
    there."""
    values = session.inputs.values
    away = values - values[:, [row]]
    distance = np.abs(away).max(axis=0)
    serves = rows.reached & (rows.status == Status.ok) & (rows.section == rows.section[row])
    numbers = np.flatnonzero(serves & (distance > 0.0))
    if not numbers.size:
        return None
    far = distance[numbers] > BEFORE_DEAD_CENTRE[0]
    numbers = numbers[far] if far.any() else numbers
    start = numbers[np.argmin(np.abs(numbers - row))]
    parts = np.array([1.0, *(part / distance[start] for part in BEFORE_DEAD_CENTRE)])
    path = values[:, [row]] + away[:, [start]] * parts
    followed = session.follow(path, rows.states[:, start], every_row=True)
    if followed.reached < parts.size:
        return None
    places = np.ascontiguousarray(path[:, 1:])
    batch = session.close(places, np.ascontiguousarray(followed.guess[:, 1:]))
    return PlacesBefore(row, places, batch.states) if batch.good.all() else None


def _chosen(
    session: Session, rows: SweepRows, row: int, branches: list[PlacesBefore]
) -> list[PlacesBefore]:
    """Of two branches the one on which other rows lie, or which `near` means; both where neither
    decides."""
    if len(branches) < 2:
        return branches
    apart = branches[0].states[:, :1] - branches[1].states[:, :1]
    others = rows.reached & (rows.section == rows.section[row])
    along = _products(apart, rows.states - rows.states[:, [row]])
    seen = np.flatnonzero(others & (np.abs(along) > ON_FOLD * _products(apart, apart)))
    if seen.size:
        nearest = seen[np.argmin(np.abs(seen - row))]
        return [branches[0 if along[nearest] > 0.0 else 1]]
    # a variant's branch is the base's, which `near` names where the base stands
    meant = None if continued_start(session) else assembly.meant_branch(session, branches)
    return branches if meant is None else [meant]


def _products(direction: Floats, states: Floats) -> Floats:
    """Scalar products (places,) with a direction (states, 1), added up in the order of the
    states."""
    total = np.zeros(states.shape[1])
    for along, state in zip(direction[:, 0], states, strict=True):
        total = total + along * state
    return total


def lost_rates(session: Session, rows: NDArray[np.intp], states: Floats) -> Bools:
    """Where the step, or a rounding of the input, changes the rates at an input's unit rate by more
    than a part of themselves.

    Args:
        session: the mechanism as it is driven.
        rows: numbers of some of its rows (places,).
        states: (states, places) closed there in doubles.

    Returns:
        (inputs, places), by each input in turn.
    """
    constants, values = _as_written(session, rows)
    numbers, ask = PreciseConstants(constants), Ask(Demand.VELOCITY, derivatives=True, iterations=1)
    rounded = np.ascontiguousarray(session.inputs.reduced[:, rows])
    lost = np.zeros(rounded.shape, dtype=bool)
    for number, value in enumerate(rounded):
        own = at_unit_rate(session, rounded, states, number)
        moving = RowInputs(values, states, unit_rates(rounded, number))
        closer = session.run(moving, ask, numbers)
        assert own.first is not None
        assert own.second is not None
        assert closer.first is not None
        change = np.abs(closer.first[:, 0] - own.first).max(axis=0)
        rounding = np.spacing(np.maximum(1.0, np.abs(value))) * np.abs(own.second).max(axis=0)
        known = DEAD_CENTRE_LOST * np.abs(own.first).max(axis=0)
        lost[number] = ~((change < known) & (rounding < known))
    return lost


def _as_written(session: Session, rows: NDArray[np.intp]) -> tuple[Floats | None, Floats]:
    """Constants and inputs (inputs, 2, places) as the file writes them; of a session of no file, or
    where a number depends on the text in a way that no tape holds, the doubles that they are."""
    try:
        precise = session.precise
        inputs = precise_inputs(precise, session).reduced[..., rows]
        return precise.constants(session), np.ascontiguousarray(inputs)
    except (TraceLost, LookupError, ValueError):
        return None, np.ascontiguousarray(session.inputs.reduced[:, rows])


def judge_dead_centres(session: Session, rows: SweepRows, condition: Floats) -> None:
    """Finds the rows that stand at a dead centre as nearly as a double can say, among those whose
    condition (rows,) leaves it open, and says so. A free motion has its rates there."""
    judged = np.isin(rows.status, (Status.ok, *CONDITION_LIMITS))
    near = rows.reached & judged & ~rates_are_clear(condition)
    if not near.any() or not session.driven or session.plan.charts:
        return
    for row in np.flatnonzero(near & _is_lost(session, rows, near)).tolist():
        before = [places for places in places_before(session, rows, row) if _grows(session, places)]
        if before:
            rows.dead_centres += before
            rows.status[row] = Status.dead_centre
    if rows.dead_centres:
        rows.diagnostics.append(_note(rows))


def _is_lost(session: Session, rows: SweepRows, near: Bools) -> Bools:
    lost: Bools = np.asarray(rows.status == Status.rank_unclear)
    numbers = np.flatnonzero(near & ~lost)
    if numbers.size:
        states = np.ascontiguousarray(rows.states[:, numbers])
        lost[numbers] = lost_rates(session, numbers, states).any(axis=0)
    return lost


def _grows(session: Session, before: PlacesBefore) -> bool:
    """Whether rates towards a dead centre grow without bound."""
    move = before.inputs[:, 1] - before.inputs[:, 0]
    rates = np.repeat((move / np.abs(move).max())[:, None], 2, axis=1)
    rows = RowInputs(before.inputs, before.states, rates)
    batch = session.run(rows, Ask(Demand.VELOCITY, derivatives=True, iterations=0))
    assert batch.first is not None
    far, close = np.abs(batch.first).max(axis=0)
    return bool(close >= GROWS_WITHOUT_BOUND * far > 0.0)


def put_unbounded(
    session: Session, states: SweepRows, rows: RowInputs, ask: Ask, batch: Batch
) -> None:
    """Puts the infinite with its sign into a run's outputs, in place, where a quantity grows
    without bound towards a row at a dead centre; others that take rates or reactions have no value.

    Args:
        session, states, rows, ask: of the run.
        batch: its result.
    """
    assert batch.outputs is not None
    assert ask.readout is not None
    slots, wanted = ask.readout.slots, ask.readout.wanted
    on_states = ask._replace(iterations=0)
    moving = rows.rates if ask.demand & Demand.VELOCITY else None
    read = [quantity for quantity in wanted if demand_of(session.problem.mechanism, [quantity])]
    forces = [q for q in read if demand_of(session.problem.mechanism, [q]) & Demand.FORCES]
    rates = [q for q in read if q not in forces]
    alike = [_slots(slots, some) for some in (rates, forces) if some]
    put: set[int] = set()
    for before in states.dead_centres if alike else ():
        there = rows.at([before.row] * 2)._replace(inputs=before.inputs, guess=before.states)
        outputs = session.run(there, on_states).outputs
        assert outputs is not None
        rests = _comes_to_rest(moving, before.row)
        for lost in alike:
            far, close = outputs[lost].T
            grows = np.abs(close) >= GROWS_WITHOUT_BOUND * np.abs(far)
            # what is zero but for rounding does not grow with the others; where friction jams,
            # forces have no value even before the dead centre
            level = np.abs(close).max(where=np.isfinite(close), initial=0.0)
            grows &= np.abs(close) > REACTION_ROUNDING * level
            grows &= not rests
            infinite = np.where(grows, np.copysign(np.inf, close), np.nan)
            if before.row in put:
                # of two branches that meet in the row
                infinite[infinite != batch.outputs[lost, before.row]] = np.nan
            batch.outputs[lost, before.row] = infinite
        put.add(before.row)


def _comes_to_rest(rates: Floats | None, row: int) -> bool:
    """Whether the inputs (inputs, rows) rest in a row of a motion: the limits are then those of its
    law, along which rates go to zero with the distance."""
    if rates is None or not rates.any():
        return False
    largest = np.abs(rates).max(axis=1)
    return bool((np.abs(rates[:, row]) <= RESTS * largest).all())


def _slots(slots: Mapping[str, slice], quantities: Sequence[Wanted]) -> list[int]:
    own = [slots[quantity.name] for quantity in quantities]
    return [column for slot in own for column in range(slot.start, slot.stop)]


# How many digits rows have whose condition may leave few.


def few_digits_notes(session: Session, rows: SweepRows, batch: Batch, ask: Ask) -> list[RowNote]:
    """Says how many digits positions, rates, accelerations and forces have, measured in
    double-double, where they are few.

    Args:
        session: the mechanism as it is driven.
        rows: its rows, closed and judged.
        batch: the run that closed them.
        ask: of that run.
    """
    assert batch.condition is not None
    bad = ~(batch.condition <= CONDITION_FEW_DIGITS)
    numbers = np.flatnonzero(rows.reached & bad & has_rates(rows.status))
    if not numbers.size:
        return []
    try:
        wide = _in_double_double(session, rows, ask, numbers)
    except (TraceLost, LookupError, ValueError) as lost:
        return [_not_measured_note(rows, numbers, batch.condition, lost)]
    off = _parts_apart(wide.states, batch.states[:, numbers], largest=1.0)
    digits = {"positions": _digits(off, wide.good)}
    for name, slots in _kinds(session, ask).items():
        assert wide.outputs is not None
        assert batch.outputs is not None
        own = batch.outputs[:, numbers]
        apart = [_parts_apart(wide.outputs[slot], own[slot]) for slot in slots]
        digits[name] = _digits(np.max(apart, axis=0), wide.good)
    few = np.zeros(numbers.size, dtype=bool)
    for name, found in digits.items():
        few |= found < (DIGITS_OF_PLACES if name == "positions" else FEW_DIGITS)
    if not few.any():
        return []
    return [_few_digits_note(rows, numbers, few, digits, batch.condition)]


def _in_double_double(
    session: Session, rows: SweepRows, ask: Ask, numbers: NDArray[np.intp]
) -> Batch:
    """Some rows repeated with the numbers of the text.

    Raises:
        TraceLost, LookupError, ValueError: these cannot be followed.
    """
    precise = session.precise
    of_text = precise_inputs(precise, session)
    orders = (of_text.values, of_text.rates, of_text.accelerations, of_text.jerks)
    inputs = KernelInputs(*orders, of_text.reduced, of_text.whole)
    given = inputs.at(rows.states, rows.turns, of_text.time, of_text.constraint_rates)
    outputs = precise.outputs(session, ask.readout.wanted) if ask.readout else None
    constants = PreciseConstants(precise.constants(session), outputs)
    return session.run(
        given.at(numbers), ask._replace(demand=ask.demand & ~Demand.CONDITION), constants
    )


def _kinds(session: Session, ask: Ask) -> dict[str, list[list[int]]]:
    """The outputs of rates, accelerations and forces, those of one dimension together; without
    forces that double-double does not know better: of friction, and of loads that tables give."""
    problem, found = session.problem, dict[str, dict[object, list[int]]]()
    lost = problem.mechanism.frictions or any(law.curve for law in problem.load_laws)
    for quantity in ask.readout.wanted if ask.readout else ():
        demand = demand_of(problem.mechanism, [quantity])
        if demand & Demand.FORCES:
            name = "" if lost else "forces"
        elif demand & (Demand.ACCELERATION | Demand.JERK):
            name = "jerks" if demand & Demand.JERK else "accelerations"
        else:
            name = "rates" if demand & Demand.VELOCITY else ""
        if name:
            own = found.setdefault(name, {}).setdefault(quantity.dimension, [])
            own += _slots(ask.readout.slots, [quantity])  # type: ignore[union-attr]
    return {name: list(slots.values()) for name, slots in found.items()}


def _parts_apart(wide: Floats, own: Floats, largest: float = 0.0) -> Floats:
    """How far doubles (numbers, rows) are from double-doubles (numbers, 2, rows), in parts of the
    largest number of the row (rows,), which is `largest` at least; 0 where all are zero."""
    off = np.abs((wide[:, 0] - own) + wide[:, 1]).max(axis=0)
    size = np.maximum(np.abs(wide[:, 0]).max(axis=0), largest)
    return np.asarray(np.where(size > 0.0, off / np.where(size > 0.0, size, 1.0), off))


def _digits(parts: Floats, known: Bools) -> NDArray[np.int64]:
    """Whole digits that such parts leave (rows,): none where they are not known."""
    limits = np.array([float(f"1e-{digit}") for digit in range(1, 17)])[:, None]
    return np.where(known, np.count_nonzero(parts <= limits, axis=0), 0)


def _not_measured_note(
    rows: SweepRows, numbers: NDArray[np.intp], condition: Floats, lost: Exception
) -> RowNote:
    """Of rows whose numbers are not in a text, or in it in a way that no tape holds."""
    words = partial(_not_measured, str(lost))
    bad = np.nan_to_num(condition, nan=np.inf, posinf=np.inf)
    return RowNote("few-digits", "note", str(lost), _among(rows, numbers), words, bad)


def _among(rows: SweepRows, numbers: NDArray[np.intp]) -> Bools:
    where: Bools = np.zeros(rows.reached.size, dtype=bool)
    where[numbers] = True
    return where


def _not_measured(lost: str, found: Found) -> Diagnostic:
    return Diagnostic(
        "few-digits",
        "note",
        f"{found.rows} may have few digits of rates, accelerations and forces; how many "
        f"could not be measured: {lost}",
        measured=condition_text(float(found.told)),
        limit=f"{CONDITION_FEW_DIGITS:g}",
        hint="their parts that are wrong are about 1e-16 of the condition's square",
    )


def _few_digits_note(
    rows: SweepRows,
    numbers: NDArray[np.intp],
    few: Bools,
    digits: Mapping[str, NDArray[np.int64]],
    condition: Floats,
) -> RowNote:
    bad = np.zeros(rows.reached.size)
    bad[numbers] = -np.min(list(digits.values()), axis=0)

    def told(row: int) -> tuple[str, float, list[tuple[str, int]]]:
        at = int(np.searchsorted(numbers, row))
        own = [(name, int(found[at])) for name, found in digits.items()]
        return rows.named([row]), float(condition[row]), own

    return RowNote("few-digits", "warning", "", _among(rows, numbers[few]), _few_digits, bad, told)


def _few_digits(found: Found) -> Diagnostic:
    row, condition, digits = found.told
    where = f"{found.rows} {'has' if found.rows.size == 1 else 'have'} few digits"
    if found.rows.size > 1:
        where += f"; fewest has {row}"
    told = ", ".join(f"{name} {count}" for name, count in digits)
    return Diagnostic(
        "few-digits",
        "warning",
        f"{where}: {told}, as measured in double-double, in parts of the largest of each kind in "
        "the row",
        measured=condition_text(condition),
        hint="mechkin analyze --errors measures every cell; drive another coordinate there, or end "
        "the sweep before",
        numbers=tuple(Number(f"digits of {name}", float(count)) for name, count in digits),
    )


def _note(rows: SweepRows) -> RowNote:
    standing = [before.row for before in rows.dead_centres]
    there = _among(rows, np.array(standing))
    # the first row on either of two branches is told
    count = np.bincount(standing, minlength=there.size)

    def told(row: int) -> str:
        return rows.named([row]) if count[row] > 1 else ""

    double = (count > 1).astype(np.float64)
    return RowNote("at-dead-centre", "warning", "", there, _at_dead_centre, double, told)


def _at_dead_centre(found: Found) -> Diagnostic:
    where = f"{found.rows} {'stands' if found.rows.size == 1 else 'stand'}"
    both = ""
    if found.told:
        both = (
            f"; it is undecided on which of two branches {found.told} is, so what is infinite with "
            "another sign on each is empty, too"
        )
    return Diagnostic(
        "at-dead-centre",
        "warning",
        f"{where} at a dead centre of the inputs: cells that grow without bound towards it "
        f"say inf, and others that depend on rates or reactions are empty{both}",
        hint="end the sweep before it, or drive another coordinate",
    )
