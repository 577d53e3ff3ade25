"""Rows along the inputs: followed, judged, explained.

Hides dead centres, branch points, friction's iteration and unresolved columns. Every row gets a
status and its residual; where a sweep ends, a message says why.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.sweep.branch_end import *
    from mechkin_cli.sweep.dead_centre import *
    from mechkin_cli.sweep.following import *
    from mechkin_cli.sweep.friction import *
    from mechkin_cli.sweep.limits import *
    from mechkin_cli.sweep.messages import *
    from mechkin_cli.sweep.parts import *
    from mechkin_cli.sweep.result import *
    from mechkin_cli.sweep.rows import *
    from mechkin_cli.sweep.slopes import *
    from mechkin_cli.sweep.sweep import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "branch_end": "passed_straight_on",
        "dead_centre": "lost_rates",
        "following": "follow_rows",
        "friction": "is_slack slack_quantities unfounded_in_motion",
        "limits": "beyond judge_limits limited",
        "messages": "refuse_loaded_spin stands_elsewhere",
        "parts": "Part RunVerdicts has_parts",
        "result": "Readable Result",
        "rows": "SHIFTS SweepRows has_turns",
        "slopes": "Bend ROUNDED bends jumps_between place_text size_text value_at",
        "sweep": "Sweep analyze at_once closed_rows first_assembly judge_condition "
        "rest_on_reactions row_notes",
    },
)
