"""The table `rows`: per row its inputs, assembly mode, verdict and measured errors.

That of a response is called `NAME.rows`; it has what happened at its rows and the error of their
energy, too.
"""

from __future__ import annotations

import numpy as np

from mechkin_cli.runs import SWEEP
from mechkin_cli.tables.columns import (
    Column,
    Columns,
    Words,
    event_words,
    proof_words,
    status_words,
)
from mechkin_cli.tables.source import Source


def rows_table(source: Source, run: str = SWEEP) -> Columns:
    """Columns row, the inputs, mode, status, residual, condition, power_error; of a sweep whose
    proofs were asked for additionally proof, of a response event and energy_error.

    Rows count from 1; inputs are in file units, errors and condition without dimension.
    """
    inputs = [
        Column(name, source.units.label(source.quantity(name).dimension), values)
        for name, values in source.inputs.items()
    ]
    columns = [
        Column("row", "", np.arange(1, source.rows + 1, dtype=np.float64), 0),
        *inputs,
        Column("mode", "", Words(np.zeros(source.rows, dtype=np.int32), (source.mode,))),
        Column("status", "", status_words(source)),
        Column("residual", "", source.residual),
        Column("condition", "", source.condition),
        Column("power_error", "", source.power_error),
    ]
    if run == SWEEP:
        if source.is_certified:
            columns.insert(-3, Column("proof", "", proof_words(source)))
        return Columns("rows", "Rows and their verdicts", tuple(columns))
    columns.insert(-3, Column("event", "", event_words(source)))
    error = np.asarray(source.quantity("row.energy_error").value, dtype=np.float64)
    columns.append(Column("energy_error", "", error))
    return Columns(f"{run}.rows", f"Rows of {run} and their verdicts", tuple(columns))
