"""The rows along a cycle: the inputs' rates along it, and whether it is closed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.sweep.notes import stands_elsewhere
from mechkin_cli.diagnostics import Diagnostic

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.result import Result
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.balance import AnyBalance, Cycle
    from mechkin_cli.solver.inputs import KernelInputs


def rates_along(result: Result, cycle: Cycle) -> KernelInputs:
    """The inputs with their rates per unit of the cycle's name (rad or s): with those of time, or
    with unit rate of the input and those of the inputs that follow it."""
    session = result.session
    if cycle.number is None:
        return session.inputs.without_accelerations()
    along = session.inputs.at_unit_rate(cycle.number)
    motion = session.problem.motion
    if motion.time is not None:
        # equal steps of time and of the input: it turns at one rate
        rates = session.inputs.rates / session.inputs.rates[cycle.number]
        return along._replace(rates=rates)
    tie = session.tie(cycle.number)
    if tie is not None:
        rates = tie.derivatives(session.inputs.values[cycle.number])[1]
        rates[cycle.number] = 1.0
        along = along._replace(rates=np.ascontiguousarray(rates))
    return along


def cycle_fault(result: Result, balance: AnyBalance) -> Diagnostic | None:
    """Why the rows are no closed cycle; None where they are."""
    cycle, rows = balance.cycle, result.row_states
    lost = np.flatnonzero(~result.solved)
    if lost.size:
        text = f"{balance.name}: row {lost[0] + 1} of the cycle has no solution"
        hint = "balances need every row; move or turn the sweep so that all have one"
        return _fault("balance-undefined", balance, text, hint)
    if stands_elsewhere(result.session, rows.states[:, [0, -1]]):
        text = f"{balance.name}: the mechanism is not back at the last row where it was at first"
        again = (cycle.turns + 1) if cycle.number is not None else 2
        hint = f"let the rows go over more turns, such as {again}; mechkin ranges shows the circuit"
        return _fault("cycle-not-closed", balance, text, hint)
    moving = result.problem.motion.inputs
    along = rates_along(result, cycle).rates
    for number, item in enumerate(moving):
        if np.ptp(item.values) and not along[number].any():
            text = f"{balance.name}: {item.name} moves, too, but does not follow {cycle.name}"
            hint = f"tie it with {{with: an expression of {cycle.name}}}, or give the sweep a time:"
            return _fault("no-cycle", balance, text, hint)
    return None


def repeated(values: Floats) -> bool:
    """Whether the last of some samples is the first again, and all are numbers."""
    if not np.isfinite(values).all():
        return False
    size = float(np.max(np.abs(values)))
    return bool(abs(values[-1] - values[0]) <= tolerances.REPEATS * size)


def sample_fault(balance: AnyBalance, what: str, values: Floats) -> Diagnostic:
    """Why samples over the rows are no cycle."""
    lost = np.flatnonzero(~np.isfinite(values))
    if lost.size:
        text = f"{balance.name}: {what} has no value in row {lost[0] + 1}"
        return _fault("balance-undefined", balance, text, "see what is said of that row, and of it")
    text = f"{balance.name}: {what} is not at the last row what it was at the first"
    hint = "what depends on time, or on an angle with its turns, does not repeat; use wrap(angle)"
    measured = f"{values[-1]:.6g} for {values[0]:.6g}"
    return _fault("cycle-not-closed", balance, text, hint, measured)


def _fault(
    code: str, balance: AnyBalance, text: str, hint: str, measured: str | None = None
) -> Diagnostic:
    return Diagnostic(code, "error", text, balance.place, measured=measured, hint=hint)
