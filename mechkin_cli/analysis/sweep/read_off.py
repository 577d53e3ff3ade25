"""The outputs of a run by name, as far as the rows' verdicts let them stand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.solver.demand import Slot, demand_of
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.rows import Rows
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.model import Mechanism
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.batch import Batch


def read_off(
    rows: Rows,
    mechanism: Mechanism,
    wanted: Sequence[Wanted],
    batch: Batch,
    slots: Mapping[str, Slot],
) -> dict[str, Floats]:
    """Quantities (width, rows); nan in rows without a position, and what depends on a rank that is
    unclear."""
    values = batch.outputs
    assert values is not None
    if not rows.reached.all():
        values[:, ~rows.reached] = np.nan
    unclear = rows.status == Status.rank_unclear
    some_unclear = bool(unclear.any())
    columns = {}
    for quantity in wanted:
        slot = slots[quantity.name]
        column = values[slot.first : slot.first + slot.width]
        if some_unclear and demand_of(mechanism, [quantity]):
            column[:, unclear] = np.nan
        columns[quantity.name] = column
    return columns
