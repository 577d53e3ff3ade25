"""A quantity by name: its owner, kind, dimension and order."""

from __future__ import annotations

from typing import Any, Literal

from mechkin_cli.expressions import Value, Vector
from mechkin_cli.record import NamedTuple
from mechkin_cli.units import Dimension

_SEEN = {"xyz": (0, 1, 2), "xy": (0, 1), "z": (2,)}
"""What is told of a vector -> the places of its components."""


class Wanted(NamedTuple):
    """One quantity: its kind, whose it is, which derivative, dimension, whether it is a vector, and
    which of a vector's components users see: in a plane x and y, or z alone."""

    name: str
    kind: Kind
    owner: str
    dimension: Dimension
    vector: bool
    coordinate: str = ""
    order: int = 0
    told: str = "xyz"

    @property
    def places(self) -> tuple[int, ...]:
        """Which of its numbers users see."""
        return _SEEN[self.told] if self.vector else (0,)

    def value(self, numbers: Any) -> Value:
        """What users see of its numbers."""
        seen = [numbers[place] for place in self.places]
        return Vector(*seen) if len(seen) > 1 else seen[0]


Kind = Literal[
    "coordinate",
    "point",
    "direction",
    "omega",
    "alpha",
    "axis",
    "joint_point",
    "slip",
    "force",
    "moment",
    "moment_about_origin",
    "effort",
    "shaking_force",
    "shaking_moment",
    "inertia_force",
    "inertia_moment",
    "holding_moment",
    "holding_force",
    "residual",
    "condition",
    "power_error",
    "error_bound",
    "work",
    "dissipated",
    "energy_error",
    "least_stiffness",
    "frequency",
    "imbalance",
    "time",
    "quaternion",
    "turn",
    "arc_length",
    "screw_axis",
    "screw_point",
    "screw_pitch",
    "finite_axis",
    "finite_point",
    "finite_angle",
    "finite_slide",
    "mechanical_advantage",
    "transmission_angle",
    "per_acceleration",
    "without_acceleration",
    "dynamic_transmission_angle",
    "ledger_work",
    "ledger_dissipated",
    "ledger_energy_error",
    "kinetic_energy",
    "potential_energy",
    "total_force",
    "total_moment",
    "link_direction",
    "link_point",
    "normal_load",
    "friction_force",
    "friction_moment",
    "friction_power",
    "friction_state",
    "self_locking",
    "rest_share",
    "rest_from",
    "rest_to",
    "reaction_level",
    "load_power",
    "actuation",
    "radial_force",
    "axial_force",
    "tilting_moment",
    "coupling_force",
    "coupling_torque",
    "coupling_power",
    "coupling_efficiency",
    "tooth_force",
    "tension",
    "bushing_force",
    "bushing_moment",
    "bushing_shift",
    "bushing_turn",
]
"""Some are of no use to users: what derived quantities are computed from, and what cells
are judged by."""
