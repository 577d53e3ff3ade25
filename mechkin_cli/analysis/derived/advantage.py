"""Mechanical advantage: the rate of the leading input over the rate of a coordinate.

Without losses the powers of input and load are equal, so it is the load that a unit of input effort
balances. It depends on the position alone: the same states are run once with unit rate of that
input, the others held.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.batched import run_reached
from mechkin_cli.analysis.derived.basis import Run
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import OutputPlan
from mechkin_cli.solver.layout import is_slide
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def mechanical_advantages(run: Run, wanted: Sequence[Wanted]) -> list[Floats]:
    """Each quantity's values (rows,) in SI; nan where the coordinate stands still."""
    motion, known = run.problem.motion, run.problem.quantities()
    leading = motion.leading
    assert leading is not None
    plan = run.layout.build()
    outputs = OutputPlan(run.layout, plan, motion.driven)
    names = [f"{quantity.owner}.{quantity.coordinate}_dot" for quantity in wanted]
    for name in (f"{leading.name}_dot", *names):
        outputs.add(known[name])
    rates = np.zeros_like(run.inputs.rates)
    rates[motion.inputs.index(leading)] = 1.0
    unit = run.inputs._replace(rates=rates, accelerations=np.zeros_like(rates))
    values = run_reached(plan, unit, run.rows, Demand.VELOCITY, run.lanes).outputs
    assert values is not None
    lost = ~run.rows.reached | (run.rows.status == Status.rank_unclear)
    given = values[outputs.slots[f"{leading.name}_dot"].first]
    found = []
    for quantity, name in zip(wanted, names, strict=True):
        rate = values[outputs.slots[name].first]
        size = run.layout.length if is_slide(quantity.coordinate) else 1.0
        still = ~(np.abs(rate) > tolerances.STANDS_STILL * size)
        found.append(np.where(lost | still, np.nan, given / rate))
    return found
