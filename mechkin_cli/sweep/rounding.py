"""A bound of the rounding errors of every row's states, without numbers more precise than doubles.

What rounding leaves is, seen backwards, the exact row of a mechanism whose constants and inputs are
off by a few roundings. How far such changes move a row is measured: the row is closed again for
constants and inputs off by random parts of `ERROR_PROBE`, `ERROR_PROBES` times, which takes blocks
that hang on each other along as they are (small-sample statistical condition estimation, C. Kenney
and A. Laub, SIAM J. Sci. Comput. 15, 1994, section 3: of three samples the largest is a tenth of
the true size or less once in a thousand times). The bound is

    ERROR_FACTOR u (|x| + largest |move| / ERROR_PROBE) + condition residual,    u = 2^-53,

the largest over the states x of a row: angles in rad, slides in parts of the mechanism's length
unit (the power of two next to the size of its drawing), components of unit quaternions.
"""

from __future__ import annotations

from math import ldexp
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.plan import PLACING, flatten, plan_records
from mechkin_cli.session import POSITIONS
from mechkin_cli.structure import RandomStarts
from mechkin_cli.sweep.rows import RunRows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats


_ROUNDING = ldexp(1.0, -53)


def error_bound(result: RunRows) -> Floats:
    """The bound (rows,); nan in rows without a position, and where none is known."""
    rows = result.row_states
    if not rows.reached.any():
        return np.full(result.rows, np.nan)
    with np.errstate(all="ignore"):
        moved = largest_move(result) / tolerances.ERROR_PROBE
        states = np.abs(rows.states) if rows.states.size else np.zeros((1, result.rows))
        sizes = np.maximum(np.max(states, axis=0), 1.0)
        bound = tolerances.ERROR_FACTOR * _ROUNDING * (sizes + moved)
        if result.graph.blocks:
            condition = np.asarray(result.quantity("row.condition").value)
            bound = bound + condition * result.residual
    return np.where(rows.reached & np.isfinite(bound), bound, np.nan)


def largest_move(result: RunRows) -> Floats:
    """The largest move of any state (rows,) in some runs with constants and inputs slightly off;
    nan where one of them did not close."""
    session, rows = result.session, result.row_states
    stream = RandomStarts()
    largest = np.zeros(result.rows)
    if not rows.states.size:
        return largest
    sizes = _input_sizes(session)
    constants, placing = _constants(session)
    for _ in range(tolerances.ERROR_PROBES):
        off = constants.copy()
        count = int(np.count_nonzero(placing))
        off[placing] *= 1.0 + _signed(stream, count) * tolerances.ERROR_PROBE
        other = session.with_constants(off)
        inputs = session.inputs
        shift = _signed(stream, len(sizes))[:, None] * tolerances.ERROR_PROBE * sizes
        batch = result.run(
            POSITIONS, session=other, inputs=inputs._replace(reduced=inputs.reduced + shift)
        )
        move = np.max(np.abs(batch.states - rows.states), axis=0)
        # of a row far from its place the move says nothing
        largest = np.where(move <= tolerances.ERROR_MOVE, np.fmax(largest, move), np.nan)
    return largest


def _input_sizes(session: Session) -> Floats:
    """By what each input is rounded in every row (inputs, rows), in parts of u: by its size with
    its whole turns, unless it is a whole number in the file's unit that no law gave."""
    motion, inputs = session.problem.motion, session.inputs
    sizes = np.abs(inputs.reduced)
    for number, item in enumerate(motion.inputs):
        rounded = (item.written != np.rint(item.written)) | (motion.time is not None)
        full = np.maximum(np.abs(inputs.values[number]), sizes[number])
        sizes[number] = np.where(rounded, full, sizes[number])
    return sizes


def _constants(session: Session) -> tuple[Floats, NDArray[np.bool_]]:
    """The plan's constants, and which of them place links: masses, loads and what else no position
    reads must not change a random number."""
    records = plan_records(session.layout)
    placing = [record[0] in PLACING for record in records for _ in flatten([record])]
    return np.array(flatten(records), dtype=np.float64), np.array(placing, dtype=np.bool_)


def _signed(stream: RandomStarts, count: int) -> Floats:
    """Uniform in [-1, 1)."""
    return 2.0 * stream.fractions(count) - 1.0
