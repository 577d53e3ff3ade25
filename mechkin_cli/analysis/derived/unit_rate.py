"""The rows of a run once more, with unit rate of the leading input and the others held: what
depends on the position alone does not depend on the rates that a file gives."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from mechkin_cli.analysis.batched import run_reached
from mechkin_cli.analysis.derived.basis import Run
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import OutputPlan
from mechkin_cli.status import Status


def at_unit_rate(run: Run, wanted: Iterable[Wanted]) -> Run:
    """The run with other outputs (nan in rows without a clear rank); its motion has an input."""
    motion = run.problem.motion
    leading = motion.leading
    assert leading is not None
    plan = run.layout.build()
    outputs = OutputPlan(run.layout, plan, motion.driven)
    for quantity in wanted:
        outputs.add(quantity)
    rates = np.zeros_like(run.inputs.rates)
    rates[motion.driven.index((leading.joint, leading.coordinate))] = 1.0
    inputs = run.inputs._replace(rates=rates, accelerations=np.zeros_like(rates))
    values = run_reached(plan, inputs, run.rows, Demand.VELOCITY, run.lanes).outputs
    assert values is not None
    values[:, ~run.rows.reached | (run.rows.status == Status.rank_unclear)] = np.nan
    return run._replace(inputs=inputs, values=values, slots=outputs.slots)
