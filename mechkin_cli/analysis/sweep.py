"""The sweep: first assembly, skeleton, infill, one batched run of what is demanded, verdict per
row."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.assembly import Probe, Start, choose_start
from mechkin_cli.analysis.problem import Problem
from mechkin_cli.analysis.result import Result
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.solver.batch import Batch, run
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.dead_centre import DeadCentre, locate
from mechkin_cli.solver.demand import OutputPlan, demand_of
from mechkin_cli.solver.follow import Followed, TrackEnd, follow
from mechkin_cli.solver.graph import build_graph
from mechkin_cli.solver.layout import Layout
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.kernel._kernel import Plan

    Floats = NDArray[np.float64]


@dataclass
class _Rows:
    """Guesses for the rows and what is known about those that have none."""

    guess: Floats
    limit: Floats
    reached: NDArray[np.bool_]
    status: NDArray[np.int8]
    nodes: int
    diagnostics: list[Diagnostic]


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
    graph = build_graph(problem.mechanism, problem.motion.driven, closed_at)
    layout = Layout(problem.mechanism, graph)
    known = problem.quantities()
    wanted = [known[name] for name in dict.fromkeys(quantities)]
    demand = _demand(problem, wanted, verdicts)
    inputs = _kernel_inputs(problem, layout)
    probe = Probe(problem, layout)
    start = choose_start(problem, layout, layout.build(), inputs.values[:, 0], probe)
    size = None if start.state is None else probe.size(inputs.values[:, 0], start.state)
    plan = layout.build(size)
    outputs = OutputPlan(layout, plan, problem.motion.driven)
    for quantity in wanted:
        outputs.add(quantity)
    rows = _follow(problem, layout, plan, inputs, start)
    batch = _run_rows(plan, inputs, rows, demand, lanes)
    if (rows.status == Status.not_converged).any():
        # a filled-in row ended away from its guess: take every row as a careful step
        rows = _follow(problem, layout, plan, inputs, start, every_row=True)
        batch = _run_rows(plan, inputs, rows, demand, lanes)
    values = batch.outputs if batch.outputs is not None else np.empty((0, problem.motion.rows))
    _unwrap_closing_angles(layout, outputs, wanted, values, rows.reached)
    if batch.condition is not None:
        singular = rows.reached & (batch.condition > tolerances.CONDITION_NEAR_SINGULAR)
        rows.status[singular & (rows.status == Status.ok)] = Status.near_singular
    missing = ~rows.reached
    nothing = np.full(problem.motion.rows, np.nan)
    for array in (values.T, batch.residual, batch.condition, batch.power_error):
        if array is not None:
            array[missing] = np.nan
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
        slots=outputs.slots,
        nodes=rows.nodes,
        diagnostics=(*problem.diagnostics, *start.diagnostics, *rows.diagnostics),
    )


def _demand(problem: Problem, wanted: list[Wanted], verdicts: bool) -> Demand:
    demand = demand_of(problem.mechanism, wanted)
    if verdicts:
        demand |= Demand.CONDITION
        if demand & Demand.FORCES and demand & Demand.VELOCITY:
            demand |= Demand.POWER
    return demand


@dataclass(frozen=True)
class _Inputs:
    """Values, rates and accelerations (inputs, rows) in kernel units."""

    values: Floats
    rates: Floats
    accelerations: Floats


def _kernel_inputs(problem: Problem, layout: Layout) -> _Inputs:
    """Inputs as the kernel takes them: slides in length units, a helical joint by its angle."""
    inputs, rows = problem.motion.inputs, problem.motion.rows

    def table(name: str) -> Floats:
        columns = []
        for item in inputs:
            joint = problem.mechanism.joints[item.joint]
            unit = 1.0
            if item.coordinate == "s":
                unit = joint.lead / (2.0 * pi) if joint.letter == "H" else layout.length
            columns.append(getattr(item, name) / unit)
        return np.ascontiguousarray(np.stack(columns)) if columns else np.empty((0, rows))

    return _Inputs(table("values"), table("rates"), table("accelerations"))


def _follow(
    problem: Problem,
    layout: Layout,
    plan: Plan,
    inputs: _Inputs,
    start: Start,
    *,
    every_row: bool = False,
) -> _Rows:
    count = problem.motion.rows
    status = np.full(count, int(Status.ok), dtype=np.int8)
    if start.state is None:
        status[:] = start.status
        states = sum(edge.joint.type.states for edge in layout.graph.edges)
        empty = np.zeros((states, count))
        return _Rows(empty, np.zeros(count), np.zeros(count, dtype=bool), status, 0, [])
    followed = follow(plan, inputs.values, start.state, every_row=every_row)
    reached = np.arange(count) < followed.reached
    rows = _Rows(followed.guess, followed.limit, reached, status, followed.steps, [])
    if followed.end != TrackEnd.FINISHED:
        _explain_end(problem, layout, plan, inputs, followed, rows)
    return rows


def _explain_end(
    problem: Problem, layout: Layout, plan: Plan, inputs: _Inputs, followed: Followed, rows: _Rows
) -> None:
    """Finds why a branch ended; rows before a dead centre get their guesses from its shape."""
    moving = np.flatnonzero(followed.direction)
    fold = None
    if moving.size == 1:
        first = _derivatives(plan, followed)
        number = int(moving[0])
        if first is not None:
            fold = locate(
                layout, problem.motion.driven, number, followed.inputs, followed.state, first
            )
        if fold is not None and _lies_ahead(fold, followed, number):
            _fill_before(fold, inputs, followed, number, rows)
            rows.status[~rows.reached] = Status.beyond_dead_centre
            rows.diagnostics.append(_dead_centre_note(problem, layout, fold, number, rows))
            return
    rows.status[~rows.reached] = Status.branch_lost
    rows.diagnostics.append(_lost_note(problem, layout, followed, rows))


def _derivatives(plan: Plan, followed: Followed) -> Floats | None:
    rates = followed.direction[:, None]
    batch = run(
        plan,
        followed.inputs[:, None],
        followed.state[:, None],
        rates=np.ascontiguousarray(rates),
        accelerations=np.zeros_like(rates),
        demand=Demand.VELOCITY | Demand.ACCELERATION,
        derivatives=True,
    )
    return batch.first[:, 0] if batch.good[0] and batch.first is not None else None


def _lies_ahead(fold: DeadCentre, followed: Followed, number: int) -> bool:
    """Whether the fold is where the branch was going, next to where it could not be followed."""
    ahead = (fold.value - float(followed.inputs[number])) * float(followed.direction[number])
    curvature = float(fold.second[fold.exchanged.input_column]) * float(followed.direction[number])
    return ahead >= -1e-9 and curvature < 0.0


def _fill_before(
    fold: DeadCentre, inputs: _Inputs, followed: Followed, number: int, rows: _Rows
) -> None:
    row = followed.reached
    while row < rows.reached.size:
        guess = fold.guess(float(inputs.values[number, row]), followed.state)
        if guess is None:
            return
        rows.guess[:, row] = guess
        rows.limit[row] = tolerances.JUMP_LIMIT
        rows.reached[row] = True
        row += 1


def _in_file_units(problem: Problem, layout: Layout, number: int, value: float) -> str:
    from mechkin_cli.units import ANGLE, LENGTH

    item = problem.motion.inputs[number]
    if item.coordinate == "theta":
        dimension, si = ANGLE, value
    else:
        joint = problem.mechanism.joints[item.joint]
        dimension = LENGTH
        si = value * (joint.lead / (2.0 * pi) if joint.letter == "H" else layout.length)
    return f"{float(problem.units.from_si(si, dimension)):.12g} {problem.units.label(dimension)}"


def _row_span(rows: _Rows) -> str:
    missing = np.flatnonzero(~rows.reached) + 1
    return f"row {missing[0]}" if missing.size == 1 else f"rows {missing[0]} to {missing[-1]}"


def _dead_centre_note(
    problem: Problem, layout: Layout, fold: DeadCentre, number: int, rows: _Rows
) -> Diagnostic:
    name = problem.motion.inputs[number].name
    return Diagnostic(
        "dead-centre",
        "warning",
        f"the branch ends at a dead centre; {_row_span(rows)} lie beyond it and stay empty",
        measured=f"{name} = {_in_file_units(problem, layout, number, fold.value)}",
        hint="end the sweep before it, or choose another assembly",
    )


def _lost_note(problem: Problem, layout: Layout, followed: Followed, rows: _Rows) -> Diagnostic:
    places = ", ".join(
        f"{item.name} = {_in_file_units(problem, layout, k, float(followed.inputs[k]))}"
        for k, item in enumerate(problem.motion.inputs)
    )
    return Diagnostic(
        "branch-lost",
        "error",
        f"the branch could not be followed further; {_row_span(rows)} stay empty",
        measured=f"last place {places}",
        hint="this may be a branch point or a special position; sweep from its other side",
    )


def _run_rows(plan: Plan, inputs: _Inputs, rows: _Rows, demand: Demand, lanes: int) -> Batch:
    """The batched run of all rows; rows without a guess repeat a neighbour's and are emptied
    later."""
    values, guess = inputs.values, rows.guess
    if not rows.reached.all():
        if not rows.reached.any():
            return _no_rows(plan, rows.reached.size)
        stand_in = np.where(
            rows.reached, np.arange(rows.reached.size), int(np.argmax(rows.reached))
        )
        values, guess = values[:, stand_in], guess[:, stand_in]
    batch = run(
        plan,
        np.ascontiguousarray(values),
        np.ascontiguousarray(guess),
        rates=inputs.rates,
        accelerations=inputs.accelerations,
        demand=demand,
        outputs=True,
        lanes=lanes,
    )
    failed = rows.reached & (~batch.good | (batch.correction > rows.limit))
    rows.status[failed] = Status.not_converged
    rows.reached &= ~failed
    return batch


def _no_rows(plan: Plan, count: int) -> Batch:
    nothing = np.full(count, np.nan)
    return Batch(
        states=np.empty((plan.states, count)),
        outputs=np.full((plan.slots, count), np.nan),
        first=None,
        second=None,
        residual=nothing,
        correction=nothing.copy(),
        condition=nothing.copy(),
        power_error=nothing.copy(),
        flags=np.zeros(count, dtype=np.uint8),
    )


def _unwrap_closing_angles(
    layout: Layout,
    outputs: OutputPlan,
    wanted: list[Wanted],
    values: Floats,
    reached: NDArray[np.bool_],
) -> None:
    """Makes the angles of closing joints, which come from an arctangent, continuous over the
    rows."""
    for quantity in wanted:
        closing = quantity.kind == "coordinate" and layout.joint_reference[quantity.owner] < 0
        if not closing or quantity.coordinate != "theta" or quantity.order:
            continue
        row = values[outputs.slots[quantity.name].first]
        angles = row[reached]
        turns = np.cumsum(np.rint(np.diff(angles, prepend=angles[:1]) / (2.0 * pi)))
        row[reached] = angles - turns * (2.0 * pi)
