"""One position near a singular one: a row behind the one that it is continued from, so that it gets
its verdict, and what is infinite there, as rows of a sweep do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.sweep.sweep import closed_rows
from mechkin_cli.expressions import Vector
from mechkin_cli.status import Status
from mechkin_cli.units import ANGLE

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep import Result
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.motion import Motion
    from mechkin_cli.mechanism.quantities import Wanted


def judged_position(
    result: Result, row: int, places: Floats, wanted: Sequence[Wanted]
) -> tuple[Status, list[Floats]]:
    """The verdict and the quantities at some inputs.

    Args:
        result: the sweep.
        row: the one that the position is continued from, its rates are taken.
        places: (inputs,) in the file's units.
        wanted: quantities.

    Returns:
        The verdict, and the numbers (parts,) of each quantity in SI, none without a position.
    """
    motion = _pair(result, row, places)
    session = result.session.moved(replace(result.problem, motion=motion))
    state = np.ascontiguousarray(result.row_states.states[:, row])
    found = closed_rows(session, replace(result.start, state=state, row=0), wanted, verdicts=True)
    status = Status(int(found.status[1]))
    cells = [_cells(result, row, found, q) for q in wanted] if status.has_solution else []
    return status, cells


def _pair(result: Result, row: int, places: Floats) -> Motion:
    """The row and the place as a motion of two rows."""
    motion, units = result.problem.motion, result.problem.units
    inputs = []
    for item, place in zip(motion.inputs, places, strict=True):
        orders = np.repeat(item.written_orders[:, [row]], 2, axis=1)
        orders[0, 1] = place
        dimension = result.problem.quantities()[item.name].dimension
        inputs.append(
            item._replace(
                values=units.to_si(orders[0].copy(), dimension),
                rates=np.repeat(item.rates[row], 2),
                accelerations=np.repeat(item.accelerations[row], 2),
                jerks=np.repeat(item.jerks[row], 2),
                written_orders=orders,
            )
        )
    ties = None if motion.tie_rates is None else np.repeat(motion.tie_rates[:, [row]], 2, axis=1)
    return motion._replace(inputs=tuple(inputs), rows=2, time=None, course=None, tie_rates=ties)


def _cells(result: Result, row: int, found: Result, wanted: Wanted) -> Floats:
    """A quantity at the second row; angles go on from those of the sweep, whose turns are counted
    from its own first row."""
    parts = _parts(found, wanted, 1)
    if wanted.kind == "coordinate" and wanted.order == 0 and wanted.dimension == ANGLE:
        apart = _parts(result, wanted, row) - _parts(found, wanted, 0)
        parts = parts + 2.0 * pi * np.rint(apart / (2.0 * pi))
    return parts


def _parts(result: Result, wanted: Wanted, row: int) -> Floats:
    value = result.quantity(wanted.name).value
    parts = value.components if isinstance(value, Vector) else (value,)
    return np.array([np.broadcast_to(part, result.rows)[row] for part in parts])
