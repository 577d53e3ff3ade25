"""Quantities computed from others after a run, balances over a run, and the dense force system."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.derived.basis import (
        AXES as AXES,
        BasisQuantities as BasisQuantities,
        OtherMoments as OtherMoments,
        basis_of as basis_of,
        directions as directions,
        displacement as displacement,
        quaternion as quaternion,
        rotation_of as rotation_of,
        vector_of as vector_of,
    )
    from mechkin_cli.derived.coefficients import (
        GRAVITY as GRAVITY,
        effort_powers as effort_powers,
        friction_power as friction_power,
        load_powers_along as load_powers_along,
        power_against as power_against,
        unloaded as unloaded,
    )
    from mechkin_cli.derived.columns import derived_columns as derived_columns
    from mechkin_cli.derived.quadrature import (
        largest_between as largest_between,
        mean as mean,
        over_cycle as over_cycle,
        running_integral_of_cycle as running_integral_of_cycle,
        total as total,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "basis": "AXES BasisQuantities OtherMoments basis_of directions displacement quaternion "
        "rotation_of vector_of",
        "coefficients": "GRAVITY effort_powers friction_power load_powers_along power_against "
        "unloaded",
        "columns": "derived_columns",
        "quadrature": "largest_between mean over_cycle running_integral_of_cycle total",
    },
)
