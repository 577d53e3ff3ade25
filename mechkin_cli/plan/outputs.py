"""The demand plan: from the requested quantities to what the kernel has to compute.

Positions only read no mass; reactions need accelerations unless no link has mass, velocities only
where something is damped or a load reads rates; an effort needs no joint reactions
(docs/internals.md, What a run skips).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import (
    BEARING_KINDS,
    COEFFICIENT_KINDS,
    DERIVED_KINDS,
    GROUND,
    LEDGER_KINDS,
    ZERO,
    Attached,
    Mechanism,
    Vector,
    Wanted,
    is_angle,
    reference_point,
)
from mechkin_cli.plan.layout import Layout
from mechkin_cli.plan.records import Demand, Output, OutputCode, hand_over_outputs
from mechkin_cli.record import NamedTuple
from mechkin_cli.units import DIMENSIONLESS, FORCE, LENGTH, MOMENT

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Outputs, Plan


_TOTAL_KINDS = {"total_force", "total_moment"}
WRENCH_KINDS = {"force", "moment", "moment_about_origin"} | _TOTAL_KINDS
_SHAKING_KINDS = {"shaking_force", "shaking_moment"}
_INERTIA_KINDS = {"inertia_force", "inertia_moment"}
_HOLDING_KINDS = {"holding_moment", "holding_force"}
FRICTION_KINDS = {"normal_load", "friction_force", "friction_moment", "friction_power"}
COUPLING_KINDS = {"coupling_force", "coupling_torque", "tooth_force", "tension"}
BUSHING_KINDS = {"bushing_force", "bushing_moment", "bushing_shift", "bushing_turn"}
REACTION_KINDS = WRENCH_KINDS | COUPLING_KINDS
"""What redundant constraints may leave open."""
_VERDICT_KINDS = {"friction_state", "self_locking", "rest_share", "reaction_level"}
FORCE_KINDS = (
    REACTION_KINDS
    | _SHAKING_KINDS
    | _INERTIA_KINDS
    | _HOLDING_KINDS
    | COEFFICIENT_KINDS
    | BEARING_KINDS
    | FRICTION_KINDS
    | _VERDICT_KINDS
    | {"effort", "dynamic_transmission_angle", "actuation"}
)
_ENERGY_KINDS = {"kinetic_energy", "potential_energy"}


def demand_of(mechanism: Mechanism, wanted: Iterable[Wanted]) -> Demand:
    """The computation that some quantities need."""
    demand = Demand.POSITION
    for quantity in wanted:
        if quantity.order == 1 or quantity.kind == "omega":
            demand |= Demand.VELOCITY
        elif quantity.order == 2 or quantity.kind == "alpha":
            demand |= Demand.VELOCITY | Demand.ACCELERATION
        elif quantity.order == 3:
            demand |= Demand.VELOCITY | Demand.ACCELERATION | Demand.JERK
        elif quantity.kind in ("bushing_force", "bushing_moment"):
            demand |= Demand.VELOCITY
        elif quantity.kind in FORCE_KINDS:
            demand |= forces_demand(mechanism)
        elif quantity.kind == "kinetic_energy":
            demand |= Demand.VELOCITY
        elif quantity.kind == "load_power" or quantity.kind in LEDGER_KINDS:
            demand |= forces_demand(mechanism) | Demand.VELOCITY
        elif quantity.kind == "condition":
            demand |= Demand.CONDITION
        elif quantity.kind == "power_error":
            demand |= forces_demand(mechanism) | Demand.VELOCITY | Demand.POWER
    return demand


def forces_demand(mechanism: Mechanism) -> Demand:
    """The computation that forces need: accelerations if a link has mass or a joint rubs,
    velocities if a load reads rates."""
    demand = Demand.FORCES
    if mechanism.frictions or any(link.has_mass for link in mechanism.links.values()):
        return demand | Demand.VELOCITY | Demand.ACCELERATION
    reads_rates = any(load.reads_rates for load in mechanism.loads)
    return demand | Demand.VELOCITY if reads_rates else demand


def needs_all_links(mechanism: Mechanism, wanted: Iterable[Wanted]) -> bool:
    """Whether some quantities are of the mechanism as a whole: forces and energies."""
    wanted = list(wanted)
    energies = any(quantity.kind in _ENERGY_KINDS | BUSHING_KINDS for quantity in wanted)
    return energies or bool(demand_of(mechanism, wanted) & Demand.FORCES)


class Readout(NamedTuple):
    """Outputs of a plan: the columns of each requested quantity in the kernel's output array, its
    slot, and the first columns of points."""

    outputs: Outputs
    slots: Mapping[str, slice]
    points: Sequence[int]
    wanted: tuple[Wanted, ...] = ()


class OutputPlan:
    """Collects the quantities that runs of a plan write, and their slots.

    `plan` serves them (None: only their records are needed); a run takes the `outputs`. Another
    `OutputPlan` on the same plan reads other quantities.
    """

    def __init__(
        self, layout: Layout, plan: Plan | None, inputs: Sequence[tuple[str, str]]
    ) -> None:
        self.layout, self.plan, self.inputs = layout, plan, inputs
        self.slots: dict[str, slice] = {}
        self.records: list[Output] = []
        self._width = 0
        self._outputs: Outputs | None = None

    @property
    def outputs(self) -> Outputs:
        """The collected outputs, checked against the plan."""
        if self._outputs is None:
            assert self.plan is not None
            self._outputs = hand_over_outputs(self.plan, self.records)
        return self._outputs

    def add(self, wanted: Wanted) -> None:
        """Plans one quantity; those of the row itself and derived ones need no slot."""
        if wanted.name in self.slots or wanted.owner == "row" or wanted.kind in DERIVED_KINDS:
            return
        add = self._add_coordinate if wanted.kind == "coordinate" else self._add_other
        first = add(wanted)
        self.slots[wanted.name] = slice(first, first + (3 if wanted.vector else 1))

    def _output(
        self,
        code: OutputCode,
        index: int,
        factor: float,
        order: int = 0,
        data: Vector = ZERO,
        freedom: int = 0,
    ) -> int:
        first = self._width
        self.records.append(Output(code, index, freedom, order, data, factor))
        self._width += _kernel.output_width(code)
        self._outputs = None
        return first

    def _add_coordinate(self, wanted: Wanted) -> int:
        layout = self.layout
        joint = layout.mechanism.joints[wanted.owner]
        factor = joint.unit_of(wanted.coordinate, layout.length)
        freedom = joint.type.freedom_of[wanted.coordinate]
        reference = layout.joint_reference[wanted.owner]
        if reference < 0:
            number = -1 - reference
            return self._output(OutputCode.CLOSING, number, factor, wanted.order, freedom=freedom)
        edge = layout.edge_number[joint.name]
        if wanted.order == 0:
            return self._output(OutputCode.STATE, layout.state(edge, freedom), factor)
        code = (OutputCode.RATE, OutputCode.ACCELERATION, OutputCode.JERK)[wanted.order - 1]
        return self._output(code, layout.column(edge, freedom), factor)

    def _add_other(self, wanted: Wanted) -> int:
        layout, mechanism = self.layout, self.layout.mechanism
        length = layout.length
        kind, owner = wanted.kind, wanted.owner
        if kind == "point":
            return self.add_point(mechanism.points[owner], wanted.order)
        if kind == "direction":
            return self._vector(mechanism.directions[owner])
        if kind == "link_direction":
            axis: Vector = getattr(GROUND, wanted.coordinate)
            return self._vector(Attached(owner, axis))
        if kind == "link_point":
            return self.add_point(reference_point(mechanism, owner), wanted.order)
        if kind in ("axis", "joint_point"):
            joint = mechanism.joints[owner]
            if kind == "axis":
                return self._vector(joint.axis)
            return self.add_point(joint.point, 0)
        if kind == "slip":
            joint = mechanism.joints[owner]
            contact = layout.point(Attached(joint.second, joint.on_second.o))
            return self._output(OutputCode.SLIP, layout.place_number[owner], length, 0, contact)
        if kind in ("omega", "alpha"):
            code = OutputCode.OMEGA if kind == "omega" else OutputCode.ALPHA
            return self._output(code, layout.link_number[owner], 1.0)
        if kind in WRENCH_KINDS:
            factor = length if wanted.dimension == FORCE else length * length
            code = self._wrench_code(owner, kind)
            return self._output(code, layout.place_number[owner], factor)
        if kind == "effort":
            return self._motor(owner, wanted.coordinate)
        if kind == "actuation":
            return self._output(OutputCode.ACTUATION, 0, 1.0)
        if kind in _HOLDING_KINDS and wanted.coordinate:
            joint_name, _, coordinate = wanted.coordinate.rpartition(".")
            return self._effort(joint_name, coordinate)
        if kind == "holding_moment":
            number = layout.hung_number[owner]
            return self._output(OutputCode.HOLDING_MOMENT, number, length * length)
        if kind == "reaction_level":
            return self._output(OutputCode.REACTION_LEVEL, 0, length)
        if kind in _ENERGY_KINDS:
            return self._output(OutputCode[kind.upper()], 0, length * length)
        if kind == "load_power":
            return self._output(OutputCode.LOAD_POWER, int(wanted.coordinate), length * length)
        if kind in FRICTION_KINDS or kind == "friction_state":
            return self._friction(wanted)
        if kind in COUPLING_KINDS:
            return self._coupling(wanted)
        if kind in BUSHING_KINDS:
            return self._bushing(wanted)
        if kind in ("self_locking", "rest_share"):
            return self._output(OutputCode[kind.upper()], 0, 1.0)
        code = OutputCode[kind.upper()]
        return self._output(code, 0, length if kind.endswith("force") else length * length)

    def _friction(self, wanted: Wanted) -> int:
        length = self.layout.length
        names = [rubbing.joint for rubbing in self.layout.mechanism.frictions]
        code = OutputCode[wanted.kind.upper()]
        factor = {FORCE: length, DIMENSIONLESS: 1.0}.get(wanted.dimension, length * length)
        return self._output(code, names.index(wanted.owner), factor)

    def _bushing(self, wanted: Wanted) -> int:
        """What a bushing exerts, or its deflection."""
        length = self.layout.length
        loads = self.layout.mechanism.loads
        number, *others = (k for k, load in enumerate(loads) if load.owner == wanted.owner)
        factor = {FORCE: length, LENGTH: length, MOMENT: length * length}.get(wanted.dimension, 1.0)
        # its damper is the next load
        damped = len(others) if wanted.dimension in (FORCE, MOMENT) else 0
        return self._output(OutputCode[wanted.kind.upper()], number, factor, freedom=damped)

    def _coupling(self, wanted: Wanted) -> int:
        """What a coupling applies along one of its coordinates, or by its teeth."""
        layout = self.layout
        number = layout.coupling_number[wanted.owner]
        if wanted.kind == "tooth_force":
            return self._output(OutputCode.MESH_FORCE, number, layout.length)
        if wanted.kind == "tension":
            tension = dict(layout.mechanism.couplings[wanted.owner].tensions)[wanted.coordinate]
            length = layout.length
            # a multiplier is a force, or a moment
            arm = 1.0 if layout.mechanism.couplings[wanted.owner].length else length
            parts = (arm * tension.along, arm * tension.apart, tension.at_rest / length)
            return self._output(OutputCode.TENSION, number, length, data=parts)
        joint, _, coordinate = wanted.coordinate.rpartition(".")
        axis = layout.axis_number[joint, coordinate]
        relation, loop = layout.mechanism.couplings[wanted.owner], layout.graph.loops[number]
        rows = layout.relation_rows(relation, loop)
        at = next(k for k, row in enumerate(rows) if row.axis == axis and row.freedom >= 0)
        factor = layout.length if wanted.kind == "coupling_force" else layout.length * layout.length
        return self._output(OutputCode.MULTIPLIER, number, factor, freedom=at)

    def _wrench_code(self, joint: str, kind: str) -> OutputCode:
        """The output of a joint's wrench. A pair that holds nothing has only the wrench of its
        drives, or none where actuators act instead."""
        if self.layout.mechanism.joints[joint].type.is_free:
            drives, force = self.layout.drives, kind.endswith("force")
            if kind in _TOTAL_KINDS and (drives is None or not drives.actuators):
                return OutputCode.CARRIED_FORCE if force else OutputCode.CARRIED_MOMENT
            return OutputCode.JOINT_FORCE if force else OutputCode.JOINT_MOMENT
        return {
            "force": OutputCode.JOINT_FORCE,
            "moment": OutputCode.JOINT_MOMENT,
            "moment_about_origin": OutputCode.JOINT_MOMENT_ORIGIN,
            "total_force": OutputCode.TOTAL_FORCE,
            "total_moment": OutputCode.TOTAL_MOMENT,
        }[kind]

    def _motor(self, joint: str, coordinate: str) -> int:
        """The effort where it acts: at an input with what it carries of others, or at an
        actuator."""
        drives = self.layout.drives
        if drives is None or not drives.actuators:
            code = OutputCode.EFFORT if drives is None else OutputCode.MOTOR
            return self._effort(joint, coordinate, code)
        number = drives.actuators.index((joint, coordinate))
        length = self.layout.length
        factor = length * length if is_angle(coordinate) else length
        return self._output(OutputCode.MOTOR, number, factor)

    def _effort(self, joint: str, coordinate: str, code: OutputCode = OutputCode.EFFORT) -> int:
        """The effort at a driven or held coordinate."""
        length = self.layout.length
        number = self.inputs.index((joint, coordinate))
        # a force along a thread does the work of the torque force * slide per radian
        unit = self.layout.mechanism.joints[joint].unit_of(coordinate, length)
        return self._output(code, number, length * length / unit)

    def add_point(self, at: Attached, order: int) -> int:
        """Plans a position (order 0) or a derivative of it; returns its first slot."""
        number = self.layout.link_number[at.link]
        return self._output(OutputCode.POINT, number, 1.0, order, self.layout.point(at))

    def _vector(self, at: Attached) -> int:
        number = self.layout.link_number[at.link]
        return self._output(OutputCode.VECTOR, number, 1.0, 0, self.layout.vector(at))
