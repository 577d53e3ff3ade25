"""The sweep: first assembly, skeleton, infill, one batched run of what is demanded, verdict per
row."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.batched import failed_rows, run_reached
from mechkin_cli.analysis.closing_angles import unwrap_closing_angles
from mechkin_cli.analysis.notes import not_converged_note, open_turn_note, redundancy_note
from mechkin_cli.analysis.other_reactions import other_reactions
from mechkin_cli.analysis.result import Result
from mechkin_cli.analysis.rows import RowStates
from mechkin_cli.analysis.setup import Setup, prepare
from mechkin_cli.analysis.skeleton import follow_rows
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism.legs import find_legs
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.solver.batch import Batch
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of
from mechkin_cli.solver.graph import is_redundant
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from mechkin_cli.analysis.row_loads import RowLoads
    from mechkin_cli.arrays import Floats


def analyze(
    problem: Problem,
    quantities: Iterable[str] = (),
    *,
    verdicts: bool = True,
    closed_at: list[str] | None = None,
    lanes: int = 0,
) -> Result:
    """Runs the sweep of a problem and computes the quantities asked for.

    Args:
        problem: the mechanism and its motion.
        quantities: names out of `problem.quantities()`.
        verdicts: compute each row's condition, and its power error where forces are computed.
        closed_at: closing joints to use instead of the best ones (the answers do not depend on
            them).
        lanes: width of the kernel's packs, 0 for the widest (the answers do not depend on it).

    Raises:
        UnsolvableGraph: the mechanism cannot be solved as it is driven.
        KeyError: an unknown quantity.
    """
    setup = prepare(problem, quantities, verdicts=verdicts, closed_at=closed_at, lanes=lanes)
    run = _run(setup)
    if run.has_failed:
        # a filled-in row ended away from its guess: take every row as a careful step
        run = _run(setup, every_row=True)
    unwrap_closing_angles(setup, run.values, run.rows.reached)
    _judge_condition(setup, run)
    if run.has_failed:
        run.rows.diagnostics.append(not_converged_note(run.rows, run.batch))
    _empty_missing_rows(run)
    run.rows.diagnostics += _notes(setup, run)
    shifted = other_reactions(setup, run.rows, run.values, run.loads and run.loads.columns)
    balanced = any(quantity.kind == "transmission_angle" for quantity in setup.derived)
    if shifted or (balanced and is_redundant(setup.graph)):
        run.rows.diagnostics.append(redundancy_note(setup.graph))
    return _result(setup, run, shifted)


class _Run(NamedTuple):
    """One run of all rows: their verdicts, varying loads, what the kernel found, and its outputs
    `values` (slots, rows) in SI."""

    rows: RowStates
    loads: RowLoads | None
    batch: Batch
    values: Floats

    @property
    def has_failed(self) -> bool:
        """Whether some row did not close."""
        return bool((self.rows.status == Status.not_converged).any())


def _run(setup: Setup, *, every_row: bool = False) -> _Run:
    """The batched run of all rows; those that do not close lose their place among the reached."""
    rows = follow_rows(setup, every_row=every_row)
    loads = _loads(setup, rows)
    batch = run_reached(setup, rows, loads=loads and loads.columns)
    failed = failed_rows(batch, rows)
    rows.status[failed] = Status.not_converged
    rows.reached &= ~failed
    assert batch.outputs is not None
    return _Run(rows, loads, batch, batch.outputs)


def _loads(setup: Setup, rows: RowStates) -> RowLoads | None:
    """The loads of the rows, where forces are wanted and some load varies."""
    if not (setup.demand & Demand.FORCES and setup.problem.load_laws):
        return None
    from mechkin_cli.analysis.row_loads import row_loads

    return row_loads(setup, rows)


def _judge_condition(setup: Setup, run: _Run) -> None:
    """Verdicts by condition; rates and forces of a row without clear rank are emptied."""
    rows, condition = run.rows, run.batch.condition
    if condition is None:
        return
    singular = rows.reached & ~(condition <= tolerances.CONDITION_NEAR_SINGULAR)
    unclear = rows.reached & ~(condition <= tolerances.CONDITION_RANK_UNCLEAR)
    rows.status[singular & (rows.status == Status.ok)] = Status.near_singular
    rows.status[unclear & (rows.status == Status.near_singular)] = Status.rank_unclear
    for quantity in setup.wanted if unclear.any() else ():
        slot = setup.outputs.slots.get(quantity.name)
        if slot is not None and demand_of(setup.problem.mechanism, [quantity]):
            run.values[slot.first : slot.first + slot.width, unclear] = np.nan


def _empty_missing_rows(run: _Run) -> None:
    batch, missing = run.batch, ~run.rows.reached
    for array in (run.values.T, batch.residual, batch.condition, batch.power_error):
        if array is not None:
            array[missing] = np.nan


def _notes(setup: Setup, run: _Run) -> list[Diagnostic]:
    """What is conventional, lost with a load, left open by a full turn, or held."""
    problem, known = setup.problem, setup.problem.quantities()
    has_legs = bool(find_legs(problem.mechanism))
    notes: list[Diagnostic] = []
    if has_legs:
        from mechkin_cli.analysis.idle import conventional_notes

        read = [known[name] for law in problem.load_laws if run.loads for name in law.reads]
        notes += conventional_notes(problem, [*setup.asked, *read])
    if run.loads:
        notes += run.loads.diagnostics
    note = open_turn_note(setup, run.batch.states, run.rows.reached)
    notes += [note] if note else []
    if has_legs and problem.hold_idle:
        from mechkin_cli.analysis.idle import holding_notes

        notes += holding_notes(problem, setup.outputs.slots, run.values)
    return notes


def _result(setup: Setup, run: _Run, shifted: tuple[Floats, ...]) -> Result:
    rows, batch, start = run.rows, run.batch, setup.start
    known = setup.problem.quantities()
    values = run.values
    slots = {name: slot for name, slot in setup.outputs.slots.items() if name in known}
    if setup.derived:
        from mechkin_cli.analysis.derived import FinishedRun, derived_columns

        added, more = derived_columns(FinishedRun(setup, rows, values), setup.derived)
        values, slots = np.concatenate((values, added)), slots | more
        shifted = tuple(np.concatenate((other, added)) for other in shifted)
    nothing = np.full(setup.problem.motion.rows, np.nan)
    return Result(
        problem=setup.problem,
        graph=setup.graph,
        demand=setup.demand,
        mode=start.mode,
        how=start.how,
        status=rows.status,
        residual=batch.residual,
        condition=nothing if batch.condition is None else batch.condition,
        power_error=nothing if batch.power_error is None else batch.power_error,
        outputs=values,
        slots=slots,
        nodes=rows.nodes,
        shifted=shifted,
        unloaded=run.loads.lost if run.loads else None,
        diagnostics=(*setup.problem.diagnostics, *start.diagnostics, *rows.diagnostics),
    )
