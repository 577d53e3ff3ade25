"""Rows along the inputs: followed, judged, explained.

Hides dead centres, branch points, friction's iteration and unresolved columns. Every row gets a
status and its residual; where a sweep ends, a message says why.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.sweep.branch_end import passed_straight_on as passed_straight_on
    from mechkin_cli.sweep.dead_centre import lost_rates as lost_rates
    from mechkin_cli.sweep.following import follow_rows as follow_rows
    from mechkin_cli.sweep.friction import unfounded_in_motion as unfounded_in_motion
    from mechkin_cli.sweep.messages import (
        refuse_loaded_spin as refuse_loaded_spin,
        stands_elsewhere as stands_elsewhere,
    )
    from mechkin_cli.sweep.result import Readable as Readable, Result as Result
    from mechkin_cli.sweep.rows import SweepRows as SweepRows, has_turns as has_turns
    from mechkin_cli.sweep.sweep import (
        analyze as analyze,
        at_once as at_once,
        closed_rows as closed_rows,
        first_assembly as first_assembly,
        judge_condition as judge_condition,
        rest_on_reactions as rest_on_reactions,
        row_notes as row_notes,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "branch_end": "passed_straight_on",
        "dead_centre": "lost_rates",
        "following": "follow_rows",
        "friction": "unfounded_in_motion",
        "messages": "refuse_loaded_spin stands_elsewhere",
        "result": "Readable Result",
        "rows": "SweepRows has_turns",
        "sweep": "analyze at_once closed_rows first_assembly judge_condition rest_on_reactions "
        "row_notes",
    },
)
