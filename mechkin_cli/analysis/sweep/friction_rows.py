"""The rows' verdict on friction, found when forces are read for the first time."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import FORCE_KINDS
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.friction import FrictionVerdict
    from mechkin_cli.analysis.sweep.result import Result
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.quantities import Wanted


def judged_by(problem: Problem, wanted: Iterable[Wanted], demand: Demand) -> list[Wanted]:
    """What forces with friction are judged by, to be read in the run of `wanted`."""
    if not (demand & Demand.FORCES and problem.mechanism.frictions):
        return []
    from mechkin_cli.analysis.sweep.friction import verdict_quantities

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

    def judge(self, result: Result, wanted: Iterable[Wanted], demand: Demand) -> None:
        """Judges the rows once; empties forces, new and known, that have no ground."""
        if not (demand & Demand.FORCES and result.problem.mechanism.frictions):
            return
        read = list(wanted)
        if self.verdict is None:
            from mechkin_cli.analysis.sweep.friction import friction_verdict

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
