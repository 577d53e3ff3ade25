"""What derived quantities are computed from: outputs of the kernel, planned with the others.

A link's rotation is read from the ground axes as drawn on it (`link_direction`), its shift from one
of its joint points (`link_point`). The names have a space, so that no file can name them. What
depends on the position alone, not on the rates of the file, is evaluated once more at unit rate of
the leading input with the others held (`at_unit_rate`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Protocol

from mechkin_cli.mechanism import FINITE_KINDS, INSTANT_KINDS, ORIENTATION_KINDS, Mechanism, Wanted
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple
from mechkin_cli.units import ANGULAR_RATE, DIMENSIONLESS, LENGTH, VELOCITY

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from mechkin_cli.session import KernelInputs, Session
    from mechkin_cli.show import Bools, Floats

    RowVector = tuple[Floats, Floats, Floats]
    Rotation = tuple[RowVector, RowVector, RowVector]


AXES = ("x", "y", "z")


class RowStates(Protocol):
    """The rows of a run: which have a position (rows,), verdicts, states and closing turns."""

    @property
    def reached(self) -> Bools:
        """Rows that have a position (rows,)."""
        ...

    @property
    def status(self) -> NDArray[np.int8]:
        """Codes of `Status` (rows,)."""
        ...

    @property
    def states(self) -> Floats:
        """States of the plan (states, rows)."""
        ...

    @property
    def turns(self) -> Floats:
        """Turns of closing joints (turn slots, rows)."""
        ...


class Evaluated(Protocol):
    """A finished run on whose states quantities are evaluated (`sweep.Result`)."""

    @property
    def session(self) -> Session:
        """The mechanism in the kernel."""
        ...

    @property
    def row_states(self) -> RowStates:
        """The rows."""
        ...

    @property
    def shifts(self) -> tuple[int, ...]:
        """Other reactions in equilibrium, where constraints are redundant."""
        ...

    def evaluated(
        self,
        wanted: Sequence[Wanted],
        *,
        session: Session | None = None,
        inputs: KernelInputs | None = None,
        demand: Demand = Demand.POSITION,
        shift: int = 0,
    ) -> dict[str, Floats]:
        """Quantities on the states."""
        ...


class OtherMoments(Protocol):
    """A sweep in time between its rows."""

    @property
    def bends(self) -> Floats:
        """Moments between the rows, in the file's unit, at which the laws of the inputs bend."""
        ...

    def at(self, written: Floats) -> Evaluated:
        """The sweep at rising moments within its own, in the file's unit, and at that of its first
        assembly, which may be none of them."""
        ...


class BasisQuantities(NamedTuple):
    """Basis quantities of a result at the rates of `inputs`: `columns` by name, (1, rows) or
    (3, rows) in SI, nan where a row has none; `between`: where the motion is known beside its rows.
    """

    result: Evaluated
    columns: Mapping[str, Floats]
    inputs: KernelInputs
    between: OtherMoments | None = None

    @property
    def session(self) -> Session:
        """The mechanism in the kernel."""
        return self.result.session

    def scalar(self, name: str) -> Floats:
        """A scalar over the rows."""
        values: Floats = self.columns[name][0]
        return values

    def vector(self, name: str) -> RowVector:
        """A vector over the rows."""
        return vector_of(self.columns[name])

    def rotation(self, link: str) -> Rotation:
        """The columns of a link's rotation from the drawing."""
        return rotation_of(self.columns, link)


def vector_of(columns: Floats) -> RowVector:
    """The components of (3, rows)."""
    return (columns[0], columns[1], columns[2])


def rotation_of(columns: Mapping[str, Floats], link: str) -> Rotation:
    """The columns of a link's rotation among some quantities."""
    x, y, z = (vector_of(columns[f"{link} {axis}"]) for axis in AXES)
    return (x, y, z)


def basis_of(mechanism: Mechanism, derived: Iterable[Wanted]) -> list[Wanted]:
    """The outputs of the run that some derived quantities are computed from."""
    every = (basis for quantity in derived for basis in _basis(mechanism, quantity))
    return list({basis.name: basis for basis in every}.values())


def _basis(mechanism: Mechanism, quantity: Wanted) -> list[Wanted]:
    owner = quantity.owner
    if quantity.kind in ORIENTATION_KINDS:
        joint = mechanism.joints[owner]
        return [*directions(joint.first), *directions(joint.second)]
    if quantity.kind in FINITE_KINDS:
        return displacement(owner)
    if quantity.kind in INSTANT_KINDS:
        speed = Wanted(f"{owner} velocity", "link_point", owner, VELOCITY, True, order=1)
        return [Wanted(f"{owner}.omega", "omega", owner, ANGULAR_RATE, True), _place(owner), speed]
    return []


def displacement(link: str) -> list[Wanted]:
    """What a link's displacement from the drawing is read from."""
    return [*directions(link), _place(link)]


def directions(link: str) -> list[Wanted]:
    """The ground axes as drawn on a link."""
    return [
        Wanted(f"{link} {axis}", "link_direction", link, DIMENSIONLESS, True, axis) for axis in AXES
    ]


def _place(link: str) -> Wanted:
    return Wanted(f"{link} place", "link_point", link, LENGTH, True)


def at_unit_rate(run: BasisQuantities, wanted: Iterable[Wanted]) -> BasisQuantities:
    """Other quantities of the run (nan in rows without a clear rank); its motion has an input."""
    motion = run.session.problem.motion
    leading = motion.leading
    assert leading is not None
    number = motion.driven.index((leading.joint, leading.coordinate))
    inputs = run.session.inputs.at_unit_rate(number)
    columns = run.result.evaluated(list(wanted), inputs=inputs, demand=Demand.VELOCITY)
    return BasisQuantities(run.result, columns, inputs)
