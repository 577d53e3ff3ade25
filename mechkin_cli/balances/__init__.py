"""Balances over a run: work, flywheel, harmonics; and the dense system of forces of a row."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.balances.dense import row_motion as row_motion
    from mechkin_cli.balances.newton_euler import (
        DenseSystem as DenseSystem,
        coefficient_tables as coefficient_tables,
        dense_system as dense_system,
    )
    from mechkin_cli.balances.runs import balance_table as balance_table

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "dense": "row_motion",
        "newton_euler": "DenseSystem coefficient_tables dense_system",
        "runs": "balance_table",
    },
)
