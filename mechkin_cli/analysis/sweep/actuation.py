"""Rows in which the actuators cannot hold the mechanism, whatever their efforts are."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.sweep.locked_poses import locked_in
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.mechanism.quantities import ACTUATION
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.analysis.sweep.result import Result
    from mechkin_cli.arrays import Bools
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.quantities import Wanted

SHOWN = 6
"""Rows that a message names one by one."""


def watched(problem: Problem, asked: Sequence[Wanted]) -> list[Wanted]:
    """What tells whether the actuators hold the mechanism, where forces are asked for."""

    drives = problem.mechanism.drives
    if drives is None or not drives.actuators:
        return []
    return [ACTUATION] if demand_of(problem.mechanism, asked) & Demand.FORCES else []


def unheld(result: Result) -> Bools | None:
    """Rows (rows,) in which the set is singular; None where that was not looked at."""
    if ACTUATION.name not in result.columns:
        return None
    least = result.columns[ACTUATION.name][0]
    return np.asarray(result.solved & ~(least > tolerances.ACTUATORS_AT_REST))


def is_held(result: Result) -> bool:
    """Whether the actuators hold the mechanism in every row, as far as that was looked at."""
    lost = unheld(result)
    return lost is None or not lost.any()


def actuation_notes(result: Result) -> list[Diagnostic]:
    """Names the set and the rows where it is singular, or next to that."""
    lost, drives = unheld(result), result.problem.mechanism.drives
    if lost is None or drives is None:
        return []
    least = result.columns[ACTUATION.name][0]
    near = result.solved & ~lost & (least < 1.0 / tolerances.CONDITION_NEAR_SINGULAR)
    names = ", ".join(".".join(pair) for pair in drives.actuators)
    notes = []
    if lost.any():
        text = (
            f"the actuators {names} are a singular set in {_rows(lost)}: the mechanism can move "
            f"there while all of them rest; their efforts and the reactions stay empty"
        )
        notes.append(_note("singular-actuators", result, lost, text, tolerances.ACTUATORS_AT_REST))
    if near.any():
        text = (
            f"the actuators {names} are next to a singular set in {_rows(near)}: their efforts "
            "are large and keep fewer than nine digits"
        )
        limit = 1.0 / tolerances.CONDITION_NEAR_SINGULAR
        notes.append(_note("near-singular-actuators", result, near, text, limit))
    return notes


def _note(code: str, result: Result, rows: Bools, text: str, limit: float) -> Diagnostic:
    least = float(np.min(result.columns[ACTUATION.name][0][rows]))
    hint = "put an actuator elsewhere, add one, or keep away from that position"
    turn = locked_in(result, rows)
    locked = (
        f"where {turn} is a quarter turn the turns before and after it go about one axis: that is "
        "a matter of the pose's coordinates, not of the actuators"
    )
    return Diagnostic(
        code,
        "warning",
        text + (f"; {locked}" if turn else ""),
        measured=f"{least:.2g} of the motion",
        limit=f"{limit:.0e}",
        hint=hint,
        numbers=(Number("actuation", least, limit=limit),),
    )


def _rows(rows: Bools) -> str:
    numbers = [str(int(k) + 1) for k in np.flatnonzero(rows)]
    if len(numbers) == 1:
        return f"row {numbers[0]}"
    if len(numbers) <= SHOWN:
        return f"rows {', '.join(numbers[:-1])} and {numbers[-1]}"
    return f"{len(numbers)} rows, the first is row {numbers[0]}"
