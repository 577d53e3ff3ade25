"""The rows of a run once more, with unit rate of the leading input and the others held: what
depends on the position alone does not depend on the rates that a file gives."""

from __future__ import annotations

from collections.abc import Iterable

from mechkin_cli.analysis.derived.basis import Reading
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.solver.codes import Demand


def at_unit_rate(run: Reading, wanted: Iterable[Wanted]) -> Reading:
    """Other quantities of the run (nan in rows without a clear rank); its motion has an input."""
    session = run.session
    motion = session.problem.motion
    leading = motion.leading
    assert leading is not None
    number = motion.driven.index((leading.joint, leading.coordinate))
    inputs = session.inputs.at_unit_rate(number)
    columns = run.result.evaluated(list(wanted), inputs=inputs, demand=Demand.VELOCITY)
    return Reading(run.result, columns, inputs)
