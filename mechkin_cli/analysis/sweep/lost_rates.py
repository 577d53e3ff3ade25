"""Rates of which no digit is left, measured in double-double.

A row's states x are closed in doubles, and next to a dead centre a few roundings of that, of the
file's constants or of an input are a large part of the distance from it, with which rates go. How
large is seen by one step of Newton's method with the numbers as the file writes them,

    x + dx,   J dx = -F(x),   F in double-double,

and the rates there. At a dead centre itself J is singular at the true place: the step goes half the
way to it, from wherever rounding has left the row, and all that grows there doubles. Beside it the
step ends at the true place but for its square. A row that has come so near that one rounding of an
input u is as much, |x''| eps against |x'|, may be right by chance, or on the other branch.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.assembly.off_fold import at_unit_rate, unit_rates
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.precise_inputs import precise_inputs
from mechkin_cli.tape.traced import TraceLost
from mechkin_cli.tolerances import DEAD_CENTRE_LOST

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.solver.session import Session


def lost_rates(session: Session, rows: NDArray[np.intp], states: Floats) -> Bools:
    """Where the step, or a rounding of the input, changes the rates at an input's unit rate by more
    than a part of themselves.

    Args:
        session: the mechanism as it is driven.
        rows: numbers of some of its rows (places,).
        states: (states, places) closed there in doubles.

    Returns:
        (inputs, places), by each input in turn.
    """
    constants, values = _as_written(session, rows)
    rounded = np.ascontiguousarray(session.inputs.reduced[:, rows])
    lost = np.zeros(rounded.shape, dtype=bool)
    for number, value in enumerate(rounded):
        own = at_unit_rate(session, rounded, states, number)
        closer = session.run_precise(
            values,
            states,
            constants=constants,
            rates=unit_rates(rounded, number),
            demand=Demand.VELOCITY,
            derivatives=True,
            iterations=1,
        )
        assert own.first is not None
        assert own.second is not None
        assert closer.first is not None
        change = np.abs(closer.first[:, 0] - own.first).max(axis=0)
        rounding = np.spacing(np.maximum(1.0, np.abs(value))) * np.abs(own.second).max(axis=0)
        known = DEAD_CENTRE_LOST * np.abs(own.first).max(axis=0)
        lost[number] = ~((change < known) & (rounding < known))
    return lost


def _as_written(session: Session, rows: NDArray[np.intp]) -> tuple[Floats | None, Floats]:
    """Constants and inputs (inputs, 2, places) as the file writes them; of a session of no file, or
    where a number depends on the text in a way that no tape holds, the doubles that they are."""
    try:
        precise = session.precise
        inputs = precise_inputs(precise, session).reduced[..., rows]
        return precise.constants(session), np.ascontiguousarray(inputs)
    except (TraceLost, LookupError, ValueError):
        return None, np.ascontiguousarray(session.inputs.reduced[:, rows])
