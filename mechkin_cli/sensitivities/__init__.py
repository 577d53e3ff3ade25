"""What a change of a parameter does to any quantity, and what tolerances add up to."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.sensitivities.first_order import *
    from mechkin_cli.sensitivities.stack_tables import *
    from mechkin_cli.sensitivities.tolerance_stack import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "first_order": "Sensitivities sensitivities",
        "stack_tables": "contributions_table extremes_table",
        "tolerance_stack": "Tolerances stack",
    },
)
