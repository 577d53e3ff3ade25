"""Quantities computed from others after a run, balances over a run, and the dense force system."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.derived.basis import *
    from mechkin_cli.derived.coefficients import *
    from mechkin_cli.derived.columns import *
    from mechkin_cli.derived.quadrature import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "basis": "AXES BasisQuantities OtherMoments basis_of directions displacement quaternion "
        "rotation_of vector_of",
        "coefficients": "GRAVITY effort_powers friction_power load_powers_along power_against "
        "unloaded",
        "columns": "derived_columns",
        "quadrature": "CycleIntegral RunningTotal largest_between mean running_integral_of_cycle",
    },
)
