"""Balances over a run: work, flywheel, harmonics; and the dense system of forces of a row."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.balances.dense import *
    from mechkin_cli.balances.newton_euler import *
    from mechkin_cli.balances.runs import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "dense": "RowMotion borne_wrenches row_motion",
        "newton_euler": "DenseSystem coefficient_tables dense_system",
        "runs": "RunningBalance balance_table running_balance",
    },
)
