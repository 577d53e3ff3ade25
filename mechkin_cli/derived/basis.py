"""What derived quantities are computed from: outputs of the kernel, planned with the others.

A link's rotation is read from the ground axes as drawn on it (`link_direction`), its shift from one
of its joint points (`link_point`). The names have a space, so that no file can name them. What
depends on the position alone, not on the rates of the file, is evaluated once more at unit rate of
the leading input with the others held (`at_unit_rate`).

Vectors over rows are three arrays of shape (rows,), elementwise in a fixed order.

Quaternions: the symmetric matrix 4 q q^T is linear in the entries of a rotation (Shepperd,
Quaternion from rotation matrix, J. Guidance and Control 1, 1978); its row with the largest
diagonal, made a unit vector, is q to rounding at every angle. The angle is 2 atan2(|q1 q2 q3|,
|q0|).

Orientation of a joint's second link against its first, relative to the drawing: R = R1^T R2, so
that axes and components are along the ground axes as drawn on the first link. A quaternion and its
opposite are one rotation; the sign is that of the one carried along in following: the quaternion of
a cut joint, or the state of one in the tree.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Protocol

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import (
    FINITE_KINDS,
    INSTANT_KINDS,
    ORDERS,
    ORIENTATION_KINDS,
    Mechanism,
    Wanted,
)
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple
from mechkin_cli.session import ORIENTATION, continuous_signs, drawn_quaternion
from mechkin_cli.tape import of_two
from mechkin_cli.units import ANGULAR_RATE, DIMENSIONLESS, LENGTH, TIME, VELOCITY

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Span
    from mechkin_cli.session import KernelInputs, Session
    from mechkin_cli.show import Bools, Floats

    RowVector = tuple[Floats, Floats, Floats]
    Rotation = tuple[RowVector, RowVector, RowVector]
    Quaternion = tuple[Floats, Floats, Floats, Floats]


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
        """Turns of cut joints (turn slots, rows)."""
        ...

    @property
    def span(self) -> Span:
        """Where they lie in the run that they are a part of."""
        ...

    @property
    def signs(self) -> dict[str, Floats]:
        """Those of the quaternions of spherical joints (rows,), as far as they were read."""
        ...

    @property
    def signs_before(self) -> Mapping[str, float]:
        """Those of the first row, where it goes on from others."""
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


OtherMoments = Callable[["Floats"], Evaluated]
"""Gives a sweep in time at rising moments within its own, in the file's unit, and at that of its
first assembly, which may be none of them."""


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
    if quantity.kind == "arc_length":
        return parameter_rates(quantity)
    if quantity.kind in FINITE_KINDS:
        return displacement(owner)
    if quantity.kind in INSTANT_KINDS:
        speed = Wanted(f"{owner} velocity", "link_point", owner, VELOCITY, True, order=1)
        return [Wanted(f"{owner}.omega", "omega", owner, ANGULAR_RATE, True), _place(owner), speed]
    return []


def parameter_rates(length: Wanted) -> list[Wanted]:
    """A curve's parameter and its rates, to the order of a length along the curve."""
    of, coordinate = length.owner, length.coordinate
    found, dimension = [], DIMENSIONLESS
    for order, suffix in enumerate(ORDERS[: length.order + 1]):
        name = f"{of}.{coordinate}{suffix}"
        found.append(Wanted(name, "coordinate", of, dimension, False, coordinate, order))
        dimension = dimension / TIME
    return found


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


def add(a: RowVector, b: RowVector) -> RowVector:
    """a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def subtract(a: RowVector, b: RowVector) -> RowVector:
    """a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(s: Floats | float, a: RowVector) -> RowVector:
    """s a."""
    return (s * a[0], s * a[1], s * a[2])


def divide(a: RowVector, s: Floats | float) -> RowVector:
    """a / s."""
    return (a[0] / s, a[1] / s, a[2] / s)


def dot(a: RowVector, b: RowVector) -> Floats:
    """a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: RowVector, b: RowVector) -> RowVector:
    """a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a: RowVector) -> Floats:
    """|a|."""
    return np.sqrt(dot(a, a))


def choose(condition: NDArray[np.bool_], a: RowVector, b: RowVector | float) -> RowVector:
    """a in the rows where the condition holds, else b."""
    bx, by, bz = b if isinstance(b, tuple) else (b, b, b)
    return (
        np.where(condition, a[0], bx),
        np.where(condition, a[1], by),
        np.where(condition, a[2], bz),
    )


def square_to(axis: RowVector, a: RowVector) -> RowVector:
    """The part of a square to a unit vector."""
    return subtract(a, scale(dot(axis, a), axis))


def relative(first: Rotation, second: Rotation) -> Rotation:
    """R1^T R2 of rotations by their columns."""
    x, y, z = ((dot(first[0], c), dot(first[1], c), dot(first[2], c)) for c in second)
    return (x, y, z)


def quaternion(rotation: Rotation) -> Quaternion:
    """Unit quaternion (scalar first) of a rotation's columns, with `upright` sign."""
    (m00, m10, m20), (m01, m11, m21), (m02, m12, m22) = rotation
    q01, q02, q03 = m21 - m12, m02 - m20, m10 - m01
    q12, q13, q23 = m10 + m01, m20 + m02, m21 + m12
    outer = (
        (1.0 + m00 + m11 + m22, q01, q02, q03),
        (q01, 1.0 + m00 - m11 - m22, q12, q13),
        (q02, q12, 1.0 - m00 + m11 - m22, q23),
        (q03, q13, q23, 1.0 - m00 - m11 + m22),
    )
    best, row = outer[0][0], outer[0]
    for k in (1, 2, 3):
        larger = outer[k][k] > best
        best = np.where(larger, outer[k][k], best)
        a, b, c, d = (np.where(larger, p, q) for p, q in zip(outer[k], row, strict=True))
        row = (a, b, c, d)
    size = np.sqrt(inner(row, row))
    return upright((row[0] / size, row[1] / size, row[2] / size, row[3] / size))


def inner(p: Quaternion, q: Quaternion) -> Floats:
    """Sum of the products of the components."""
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]


def times(sign: Floats, q: Quaternion) -> Quaternion:
    """A quaternion with each row's sign."""
    return (sign * q[0], sign * q[1], sign * q[2], sign * q[3])


def upright(q: Quaternion) -> Quaternion:
    """The one of q and -q with positive scalar part; at half a turn the first other component that
    is not zero is positive."""
    sign = np.ones_like(q[0])
    for component in reversed(q):
        decides = np.abs(component) > tolerances.HALF_TURN
        sign = np.where(decides, np.where(component < 0.0, -1.0, 1.0), sign)
    return times(sign, q)


def angle(q: Quaternion) -> Floats:
    """Angle in [0, pi]."""
    half: Floats = of_two("ATAN2", length(q[1:]), np.abs(q[0]))
    return 2.0 * half


def rotation_vector(q: Quaternion) -> RowVector:
    """Axis times angle of an upright quaternion; the angle is in [0, pi]."""
    size = length(q[1:])
    none = size == 0.0
    return scale(np.where(none, 2.0, angle(q) / np.where(none, 1.0, size)), q[1:])


def turn(run: BasisQuantities, joint: str) -> RowVector:
    """The rotation vector (rad), of length 0 to pi."""
    return rotation_vector(_upright(run, joint))


def continuous_quaternion(run: BasisQuantities, joint: str) -> Quaternion:
    """The unit quaternion, scalar first; continuous from the first row, where q0 >= 0."""
    q = _upright(run, joint)
    reached = np.flatnonzero(run.result.row_states.reached)
    if not reached.size:
        return q
    part = _part(q, reached)
    followed = _followed(run, joint, reached)
    if followed is not None:
        signs = continuous_signs(part, followed, 0)
    else:
        # a joint of a hung body turns with its line, less than half a turn from row to row
        back = inner(_part(part, slice(1, None)), _part(part, slice(None, -1))) < 0.0
        signs = np.cumprod(np.concatenate((np.ones(1), np.where(back, -1.0, 1.0))))
    rows = run.result.row_states
    first = -1.0 if part[0][0] < 0.0 else 1.0
    every = np.ones(rows.reached.size)
    every[reached] = signs * rows.signs_before.get(joint, first)
    rows.signs[joint] = every
    return times(every, q)


def _upright(run: BasisQuantities, joint: str) -> Quaternion:
    links = run.session.problem.mechanism.joints[joint]
    return quaternion(relative(run.rotation(links.first), run.rotation(links.second)))


def _followed(run: BasisQuantities, name: str, reached: NDArray[np.intp]) -> Quaternion | None:
    """The orientation in some rows as it was followed, of either sign as a whole; None for the
    spheres of a hung body."""
    layout, rows = run.session.layout, run.result.row_states
    joint = layout.mechanism.joints[name]
    reference = layout.joint_reference[name]
    if reference < 0:
        slot = run.session.structure.closing_slots.get((-1 - reference, ORIENTATION))
        if slot is None:
            return None
        return drawn_quaternion(joint, rows.turns[slot : slot + 4, reached])
    edge = layout.edge_number[name]
    for k in layout.parts_of[edge]:
        carrier = layout.carriers[k]
        if carrier.part.type.is_ball:
            w, x, y, z = rows.states[carrier.state : carrier.state + 4, reached]
            forward = 1.0 if layout.graph.edges[edge].forward else -1.0
            return (w, forward * x, forward * y, forward * z)
    return None


def _part(q: Quaternion, rows: slice | NDArray[np.intp]) -> Quaternion:
    return (q[0][rows], q[1][rows], q[2][rows], q[3][rows])
