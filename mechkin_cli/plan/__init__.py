"""Mechanism and graph compiled to the flat plan that the kernel runs: programs, outputs.

The only room that knows the layout of the kernel's arrays.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.plan.layout import (
        Carrier as Carrier,
        Layout as Layout,
        home_inputs as home_inputs,
        home_state as home_state,
    )
    from mechkin_cli.plan.outputs import (
        FORCE_KINDS as FORCE_KINDS,
        REACTION_KINDS as REACTION_KINDS,
        OutputPlan as OutputPlan,
        Readout as Readout,
        demand_of as demand_of,
        forces_demand as forces_demand,
        needs_all_links as needs_all_links,
    )
    from mechkin_cli.plan.plan import build_plan as build_plan, plan_records as plan_records
    from mechkin_cli.plan.programs import kink_laws as kink_laws
    from mechkin_cli.plan.records import (
        Demand as Demand,
        FrictionState as FrictionState,
        PassageEnd as PassageEnd,
        RowFlag as RowFlag,
        TrackEnd as TrackEnd,
        flatten as flatten,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "layout": "Carrier Layout home_inputs home_state",
        "outputs": "FORCE_KINDS OutputPlan Readout REACTION_KINDS demand_of forces_demand "
        "needs_all_links",
        "plan": "build_plan plan_records",
        "programs": "kink_laws",
        "records": "Demand FrictionState PassageEnd RowFlag TrackEnd flatten",
    },
)
