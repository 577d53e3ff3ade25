"""The table `rows`: per row its inputs, assembly mode, verdict and measured errors."""

from __future__ import annotations

import numpy as np

from mechkin_cli.tables.columns import Column, Columns, Words, status_words
from mechkin_cli.tables.source import Source


def rows_table(source: Source) -> Columns:
    """Columns row, the inputs, mode, status, residual, condition, power_error.

    Rows count from 1; inputs are in file units, the last three without dimension.
    """
    inputs = [
        Column(name, source.units.label(source.quantity(name).dimension), values)
        for name, values in source.inputs.items()
    ]
    columns = (
        Column("row", "", np.arange(1, source.rows + 1, dtype=np.float64), 0),
        *inputs,
        Column("mode", "", Words(np.zeros(source.rows, dtype=np.int32), (source.mode,))),
        Column("status", "", status_words(source)),
        Column("residual", "", source.residual),
        Column("condition", "", source.condition),
        Column("power_error", "", source.power_error),
    )
    return Columns("rows", "Rows and their verdicts", columns)
