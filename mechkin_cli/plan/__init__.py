"""Mechanism and graph compiled to the flat plan that the kernel runs: programs, outputs.

The only room that knows the layout of the kernel's arrays.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.plan.layout import *
    from mechkin_cli.plan.outputs import *
    from mechkin_cli.plan.plan import *
    from mechkin_cli.plan.programs import *
    from mechkin_cli.plan.records import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "layout": "Carrier Layout home_inputs home_state is_lifted",
        "outputs": "FORCE_KINDS OutputPlan Readout REACTION_KINDS demand_of forces_demand "
        "needs_all_links",
        "plan": "build_plan plan_records",
        "programs": "kink_laws",
        "records": "Demand FrictionState FrictionTold PassageEnd RowFlag TrackEnd flatten",
    },
)
