"""Quantities computed from others after a run, balances over a run, and the dense force system."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.derived.balances import balance_table as balance_table
    from mechkin_cli.derived.basis import (
        BasisQuantities as BasisQuantities,
        basis_of as basis_of,
        displacement as displacement,
        rotation_of as rotation_of,
        vector_of as vector_of,
    )
    from mechkin_cli.derived.columns import derived_columns as derived_columns
    from mechkin_cli.derived.dense import row_motion as row_motion
    from mechkin_cli.derived.newton_euler import (
        DenseSystem as DenseSystem,
        coefficient_tables as coefficient_tables,
        dense_system as dense_system,
    )
    from mechkin_cli.derived.rotation import quaternion as quaternion

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "balances": ["balance_table"],
        "basis": ["BasisQuantities", "basis_of", "displacement", "rotation_of", "vector_of"],
        "columns": ["derived_columns"],
        "dense": ["row_motion"],
        "newton_euler": ["DenseSystem", "coefficient_tables", "dense_system"],
        "rotation": ["quaternion"],
    },
)
