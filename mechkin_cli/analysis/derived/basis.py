"""What derived quantities are computed from: outputs of the kernel, planned with the others.

A link's rotation is read from the ground axes as drawn on it (`link_direction`), its shift from one
of its joint points (`link_point`). The names have a space, so that no file can ask for them.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.mechanism.derived_quantities import (
    FINITE_KINDS,
    INSTANT_KINDS,
    ORIENTATION_KINDS,
)
from mechkin_cli.mechanism.model import Mechanism
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.units import ANGULAR_RATE, DIMENSIONLESS, LENGTH, VELOCITY

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mechkin_cli.analysis.assembly import Start
    from mechkin_cli.analysis.derived.rotations import Rotation
    from mechkin_cli.analysis.derived.row_vectors import RowVector
    from mechkin_cli.analysis.rows import KernelInputs, RowStates
    from mechkin_cli.analysis.setup import Setup
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.solver.demand import Slot
    from mechkin_cli.solver.layout import Layout

AXES = ("x", "y", "z")


class FinishedRun(NamedTuple):
    """A finished run of a sweep: `values` (slots, rows) in SI, nan where a row has none."""

    setup: Setup
    rows: RowStates
    values: Floats

    @property
    def problem(self) -> Problem:
        """What was run."""
        return self.setup.problem

    @property
    def layout(self) -> Layout:
        """How its mechanism lies in the kernel."""
        return self.setup.layout

    @property
    def inputs(self) -> KernelInputs:
        """The inputs with their rates, in kernel units."""
        return self.setup.inputs

    @property
    def start(self) -> Start:
        """The first assembly."""
        return self.setup.start

    @property
    def slots(self) -> Mapping[str, Slot]:
        """Where each quantity stands in `values`."""
        return self.setup.outputs.slots

    def scalar(self, name: str) -> Floats:
        """A scalar output over the rows."""
        found: Floats = self.values[self.slots[name].first]
        return found

    def vector(self, name: str) -> RowVector:
        """A vector output over the rows."""
        return vector_at(self.values, self.slots, name)

    def rotation(self, link: str) -> Rotation:
        """The columns of a link's rotation from the drawing."""
        return rotation_at(self.values, self.slots, link)


def vector_at(values: Floats, slots: Mapping[str, Slot], name: str) -> RowVector:
    """A vector among some outputs."""
    first = slots[name].first
    return (values[first], values[first + 1], values[first + 2])


def rotation_at(values: Floats, slots: Mapping[str, Slot], link: str) -> Rotation:
    """The columns of a link's rotation among some outputs."""
    x, y, z = (vector_at(values, slots, f"{link} {axis}") for axis in AXES)
    return (x, y, z)


def basis_of(mechanism: Mechanism, derived: Iterable[Wanted]) -> list[Wanted]:
    """The outputs of the run that some derived quantities are computed from."""
    found: dict[str, Wanted] = {}
    for quantity in derived:
        for basis in _basis(mechanism, quantity):
            found[basis.name] = basis
    return list(found.values())


def _basis(mechanism: Mechanism, quantity: Wanted) -> list[Wanted]:
    owner = quantity.owner
    if quantity.kind in ORIENTATION_KINDS:
        joint = mechanism.joints[owner]
        return [*directions(joint.first), *directions(joint.second)]
    if quantity.kind in FINITE_KINDS:
        return [*directions(owner), _place(owner)]
    if quantity.kind in INSTANT_KINDS:
        speed = Wanted(f"{owner} velocity", "link_point", owner, VELOCITY, True, order=1)
        return [Wanted(f"{owner}.omega", "omega", owner, ANGULAR_RATE, True), _place(owner), speed]
    return []


def directions(link: str) -> list[Wanted]:
    """The ground axes as drawn on a link."""
    return [
        Wanted(f"{link} {axis}", "link_direction", link, DIMENSIONLESS, True, axis) for axis in AXES
    ]


def _place(link: str) -> Wanted:
    return Wanted(f"{link} place", "link_point", link, LENGTH, True)
