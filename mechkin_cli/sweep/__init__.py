"""Rows along the inputs: followed, judged, explained.

Hides dead centres, branch points, friction's iteration and unresolved columns. Every row gets a
status and its residual; where a sweep ends, a message says why.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.sweep.branch_end import (
        crossing_note as crossing_note,
        explain_end as explain_end,
        input_faults as input_faults,
        passed_straight_on as passed_straight_on,
    )
    from mechkin_cli.sweep.dead_centre import (
        judge_dead_centres as judge_dead_centres,
        lost_rates as lost_rates,
        put_unbounded as put_unbounded,
    )
    from mechkin_cli.sweep.follow_part import followed_session as followed_session
    from mechkin_cli.sweep.following import follow_rows as follow_rows
    from mechkin_cli.sweep.friction import unfounded_in_motion as unfounded_in_motion
    from mechkin_cli.sweep.messages import stands_elsewhere as stands_elsewhere
    from mechkin_cli.sweep.result import Result as Result
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
        "branch_end": ["crossing_note", "explain_end", "input_faults", "passed_straight_on"],
        "dead_centre": ["judge_dead_centres", "lost_rates", "put_unbounded"],
        "follow_part": ["followed_session"],
        "following": ["follow_rows"],
        "friction": ["unfounded_in_motion"],
        "messages": ["stands_elsewhere"],
        "result": ["Result"],
        "rows": ["SweepRows", "has_turns"],
        "sweep": [
            "analyze",
            "at_once",
            "closed_rows",
            "first_assembly",
            "judge_condition",
            "rest_on_reactions",
            "row_notes",
        ],
    },
)
