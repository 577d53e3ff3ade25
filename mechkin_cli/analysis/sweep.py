"""The sweep: first assembly, skeleton, infill, one batched run of what is demanded, verdict per
row."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.assembly import Start, choose_start
from mechkin_cli.analysis.batched import failed_rows, run_reached
from mechkin_cli.analysis.branch_end import explain_end
from mechkin_cli.analysis.closing_angles import unwrap_closing_angles
from mechkin_cli.analysis.followed import followed_part
from mechkin_cli.analysis.idle import conventional_notes, holding_notes
from mechkin_cli.analysis.notes import not_converged_note, open_turn_note, redundancy_note
from mechkin_cli.analysis.probe import Probe
from mechkin_cli.analysis.problem import Problem
from mechkin_cli.analysis.result import Result
from mechkin_cli.analysis.rows import KernelInputs, RowStates, kernel_inputs
from mechkin_cli.mechanism.derived_quantities import DERIVED_KINDS
from mechkin_cli.mechanism.legs import find_legs
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.solver.batch import Batch
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import WRENCH_KINDS, OutputPlan, demand_of
from mechkin_cli.solver.follow import TrackEnd, follow
from mechkin_cli.solver.graph import SolverGraph, build_graph, is_redundant
from mechkin_cli.solver.layout import Layout
from mechkin_cli.solver.search import wrap_angles
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.analysis.row_loads import RowLoads
    from mechkin_cli.kernel._kernel import Plan

    Floats = NDArray[np.float64]


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
        them). lanes: width of the kernel's packs, 0 for the widest (the answers do not depend on
        it).

    Raises:
        UnsolvableGraph: the mechanism cannot be solved as it is driven.
        KeyError: an unknown quantity.
    """
    known = problem.quantities()
    wanted = [known[name] for name in dict.fromkeys(quantities)]
    graph = build_graph(problem.mechanism, problem.motion.driven, closed_at)
    followed = followed_part(problem, graph, wanted)
    if followed is not problem:
        problem = followed
        graph = build_graph(problem.mechanism, problem.motion.driven, closed_at)
    layout = Layout(problem.mechanism, graph)
    asked = wanted
    derived = [quantity for quantity in wanted if quantity.kind in DERIVED_KINDS]
    if derived:
        from mechkin_cli.analysis.derived import basis_of

        wanted = [quantity for quantity in wanted if quantity.kind not in DERIVED_KINDS]
        wanted += basis_of(problem.mechanism, derived)
    if problem.hold_idle and demand_of(problem.mechanism, wanted) & Demand.FORCES:
        held = {known[f"{leg.body}.holding_moment"] for leg in find_legs(problem.mechanism)}
        wanted += sorted(held.difference(wanted))
    demand = _demand(problem, graph, wanted, verdicts)
    inputs = kernel_inputs(problem, layout)
    probe = Probe(problem, layout)
    start = choose_start(problem, layout, layout.build(), inputs.values, probe)
    size = None if start.state is None else probe.size(inputs.values[:, start.row], start.state)
    plan = layout.build(size)
    outputs = OutputPlan(layout, plan, problem.motion.driven)
    for quantity in wanted:
        outputs.add(quantity)
    rows = _follow(problem, layout, plan, inputs, start)
    loads = _loads(problem, layout, demand, inputs, start, rows, lanes)
    batch = _run_rows(plan, inputs, rows, demand, lanes, loads=loads and loads.columns)
    if (rows.status == Status.not_converged).any():
        # a filled-in row ended away from its guess: take every row as a careful step
        rows = _follow(problem, layout, plan, inputs, start, every_row=True)
        loads = _loads(problem, layout, demand, inputs, start, rows, lanes)
        batch = _run_rows(plan, inputs, rows, demand, lanes, loads=loads and loads.columns)
    values = batch.outputs if batch.outputs is not None else np.empty((0, problem.motion.rows))
    if start.state is not None:
        unwrap_closing_angles(
            layout, outputs, wanted, values, inputs.values, start.state, start.row, rows.reached
        )
    if batch.condition is not None:
        _empty_what_is_unclear(rows, batch.condition, outputs, wanted, values)
    if (rows.status == Status.not_converged).any():
        rows.diagnostics.append(not_converged_note(rows, batch))
    read = [known[name] for law in problem.load_laws if loads for name in law.reads]
    rows.diagnostics += conventional_notes(problem, [*asked, *read])
    if loads:
        rows.diagnostics += loads.diagnostics
    if inputs.values.size:
        note = open_turn_note(problem, layout, inputs.values, batch.states, rows.reached)
        rows.diagnostics += [note] if note else []
    missing = ~rows.reached
    nothing = np.full(problem.motion.rows, np.nan)
    for array in (values.T, batch.residual, batch.condition, batch.power_error):
        if array is not None:
            array[missing] = np.nan
    if problem.hold_idle:
        rows.diagnostics += holding_notes(problem, outputs.slots, values)
    columns = loads and loads.columns
    shifted = _shifted_outputs(
        plan, graph, inputs, rows, demand, lanes, outputs, wanted, values, columns
    )
    balanced = any(quantity.kind == "transmission_angle" for quantity in derived)
    if shifted or (balanced and is_redundant(graph)):
        rows.diagnostics.append(redundancy_note(graph))
    slots = {name: slot for name, slot in outputs.slots.items() if name in known}
    if derived:
        from mechkin_cli.analysis.derived import Run, derived_columns

        run = Run(problem, layout, inputs, start, rows, lanes, values, outputs.slots)
        added, more = derived_columns(run, derived)
        values, slots = np.concatenate((values, added)), slots | more
        shifted = tuple(np.concatenate((other, added)) for other in shifted)
    return Result(
        problem=problem,
        graph=graph,
        demand=demand,
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
        unloaded=loads.lost if loads else None,
        diagnostics=(*problem.diagnostics, *start.diagnostics, *rows.diagnostics),
    )


def _demand(problem: Problem, graph: SolverGraph, wanted: list[Wanted], verdicts: bool) -> Demand:
    demand = demand_of(problem.mechanism, wanted)
    if verdicts and graph.blocks:
        demand |= Demand.CONDITION
    if verdicts and demand & Demand.FORCES and demand & Demand.VELOCITY:
        demand |= Demand.POWER
    return demand


def _loads(
    problem: Problem,
    layout: Layout,
    demand: Demand,
    inputs: KernelInputs,
    start: Start,
    rows: RowStates,
    lanes: int,
) -> RowLoads | None:
    """The loads of the rows, where forces are wanted and some load varies."""
    if not (demand & Demand.FORCES and problem.load_laws):
        return None
    from mechkin_cli.analysis.row_loads import row_loads

    return row_loads(problem, layout, inputs, start, rows, lanes)


def _follow(
    problem: Problem,
    layout: Layout,
    plan: Plan,
    inputs: KernelInputs,
    start: Start,
    *,
    every_row: bool = False,
) -> RowStates:
    count = problem.motion.rows
    status = np.full(count, int(Status.ok), dtype=np.int8)
    if start.state is None:
        status[:] = start.status
        empty = np.zeros((layout.states, count))
        none = np.zeros(count, dtype=bool)
        return RowStates(empty, np.zeros(count), none, status, 0, [], np.arange(count))
    arrays = (np.empty((layout.states, count)), np.empty(count), np.zeros(count, dtype=bool))
    rows = RowStates(*arrays, status, 0, [], np.arange(count))
    onward, backward = slice(start.row, None), slice(start.row, None, -1)
    for way in (backward, onward) if start.row else (onward,):
        path = np.ascontiguousarray(inputs.values[:, way])
        followed = follow(plan, path, start.state, every_row=every_row)
        part = rows.part(way)
        part.guess[:], part.limit[:] = followed.guess, followed.limit
        part.reached[:] = np.arange(part.reached.size) < followed.reached
        rows.nodes += followed.steps
        if followed.end != TrackEnd.FINISHED:
            explain_end(problem, layout, plan, path, followed, part)
    _wrap_from_first(layout, rows)
    return rows


def _wrap_from_first(layout: Layout, rows: RowStates) -> None:
    """Angles are continuous from the first row, which lies in (-180, 180] degrees."""
    if not rows.reached.any():
        return
    first = int(np.argmax(rows.reached))
    before = rows.guess[:, first].copy()
    wrapped = before[:, None].copy()
    wrap_angles(layout, wrapped)
    rows.guess += wrapped - before[:, None]


def _run_rows(
    plan: Plan,
    inputs: KernelInputs,
    rows: RowStates,
    demand: Demand,
    lanes: int,
    shift: int = 0,
    loads: Floats | None = None,
) -> Batch:
    """The batched run of all rows; those that do not close lose their place among the reached."""
    batch = run_reached(plan, inputs, rows, demand, lanes, shift, loads)
    failed = failed_rows(batch, rows)
    rows.status[failed] = Status.not_converged
    rows.reached &= ~failed
    return batch


def _empty_what_is_unclear(
    rows: RowStates, condition: Floats, outputs: OutputPlan, wanted: list[Wanted], values: Floats
) -> None:
    """Verdicts by condition; rates and forces of a row without clear rank are emptied."""
    singular = rows.reached & ~(condition <= tolerances.CONDITION_NEAR_SINGULAR)
    unclear = rows.reached & ~(condition <= tolerances.CONDITION_RANK_UNCLEAR)
    rows.status[singular & (rows.status == Status.ok)] = Status.near_singular
    rows.status[unclear & (rows.status == Status.near_singular)] = Status.rank_unclear
    for quantity in wanted if unclear.any() else ():
        slot = outputs.slots.get(quantity.name)
        if slot is not None and demand_of(outputs.layout.mechanism, [quantity]):
            values[slot.first : slot.first + slot.width, unclear] = np.nan


def _shifted_outputs(
    plan: Plan,
    graph: SolverGraph,
    inputs: KernelInputs,
    rows: RowStates,
    demand: Demand,
    lanes: int,
    outputs: OutputPlan,
    wanted: list[Wanted],
    values: Floats,
    loads: Floats | None,
) -> tuple[Floats, ...]:
    """The outputs for two other reactions in equilibrium, where constraints are redundant."""
    # efforts and what acts on ground are unique where the motion is
    reactions = [quantity for quantity in wanted if quantity.kind in WRENCH_KINDS]
    if not (is_redundant(graph) and reactions and rows.reached.any()):
        return ()
    found = []
    for shift in (1, 2):
        fresh = _run_rows(plan, inputs, rows, demand, lanes, shift, loads).outputs
        assert fresh is not None
        changed = values.copy()
        for slot in (outputs.slots[quantity.name] for quantity in reactions):
            changed[slot.first : slot.first + slot.width] = fresh[
                slot.first : slot.first + slot.width
            ]
        found.append(changed)
    return tuple(found)
