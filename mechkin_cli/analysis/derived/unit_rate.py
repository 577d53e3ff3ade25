"""The rows of a run once more, with unit rate of the leading input and the others held: what
depends on the position alone does not depend on the rates that a file gives."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from mechkin_cli.analysis.batched import run_reached
from mechkin_cli.analysis.derived.basis import FinishedRun
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.solver.codes import Demand
from mechkin_cli.status import Status


def at_unit_rate(run: FinishedRun, wanted: Iterable[Wanted]) -> FinishedRun:
    """The run with other outputs (nan in rows without a clear rank); its motion has an input."""
    motion = run.problem.motion
    leading = motion.leading
    assert leading is not None
    rates = np.zeros_like(run.inputs.rates)
    rates[motion.driven.index((leading.joint, leading.coordinate))] = 1.0
    inputs = run.inputs._replace(rates=rates, accelerations=np.zeros_like(rates))
    setup = replace(run.setup.reading(wanted, Demand.VELOCITY), inputs=inputs)
    values = run_reached(setup, run.rows).outputs
    assert values is not None
    values[:, ~run.rows.reached | (run.rows.status == Status.rank_unclear)] = np.nan
    return run._replace(setup=setup, values=values)
