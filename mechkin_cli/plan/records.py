"""The records of a kernel plan as plain data, and the one place that hands them over.

A record is a call of the kernel's `PlanBuilder` with its arguments in their order. Its *constants*
are the numbers that parameters may vary; the others (codes, indices, signs) are structure. The
kernel numbers constants in the order of the records and, within a record, of its fields, and
`flatten` gives them in that order, whatever kind of number they are: floats for a plan, or the
results of other arithmetic that is recorded or repeated elsewhere.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from mechkin_cli.kernel import _kernel
from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Outputs, Plan


Number = Any
"""A float, or what stands for one where plans are recorded."""

Triple = Sequence[Number]
FrameNumbers = Sequence[Number]
"""Axes x, y, z and origin of a frame: 12 numbers."""

Loop = Sequence[tuple[int, float]]
"""Tree joints of a loop with their signs."""


class Units(NamedTuple):
    """Length unit, origin and size of the mechanism, in m: the first record of a plan."""

    length: Number
    origin: Triple
    size: Number


class TreeJoint(NamedTuple):
    """A displacement of the tree: `at` in the parent; `pitch` of a screw, length units per rad."""

    type: int
    parent: int
    pitch: Number
    at: FrameNumbers


class ClosingJoint(NamedTuple):
    """A joint that closes a loop, by its frames on both links."""

    type: int
    first: int
    second: int
    on_first: FrameNumbers
    on_second: FrameNumbers
    parameter: Number
    loop: Loop


class HungLinks(NamedTuple):
    """A distance between two points and the links that hang between them: `line` in the body,
    `length` at zero slide."""

    body: int
    rod: int
    first: int
    second: int
    on_first: FrameNumbers
    on_second: FrameNumbers
    length: Number
    line: Triple
    slide_sign: float
    loop: Loop


class JointPlace(NamedTuple):
    """A joint as its user knows it: where its wrench is read off and its point rides."""

    reference: int
    first: int
    second: int
    point_on: int
    point: Triple
    sign: float


class JointAxis(NamedTuple):
    """The axis of a joint's coordinate: the sum of two vectors carried by two links."""

    place: int
    slide: bool
    link: int
    vector: Triple
    other: int
    other_vector: Triple


class FreeDirections(NamedTuple):
    """Directions that a joint leaves free, by the kernel's `FreeCode`: slides or turns."""

    place: int
    slide: bool
    code: int
    link: int
    vector: Triple


class PlanBlock(NamedTuple):
    """The next closing joints, the tree joints that they place and the columns that they solve
    for, with the equations of a chart beside theirs."""

    closing_joints: int
    joints: Sequence[int]
    unknown: Sequence[int]
    charts: int = 0


class Rest(NamedTuple):
    """The tree joints that no block places."""

    joints: Sequence[int]


class Input(NamedTuple):
    """A driven column; `scale` is the effort along the axis per generalised force."""

    column: int
    axis: int
    scale: Number


class Inertia(NamedTuple):
    """Mass (kg), mass centre and tensor of a link, in its frame and length units."""

    link: int
    mass: Number
    centre: Triple
    tensor: Sequence[Number]


class PlanGravity(NamedTuple):
    """In length units."""

    g: Triple


class AppliedLoad(NamedTuple):
    """A load by its code; see the kernel's `Load`."""

    type: int
    link: int
    other: int
    freedom: int
    point: Triple
    other_point: Triple
    vector: Triple
    varying: bool = False


class ProgramCurve(NamedTuple):
    """A curve of a program over a register, nan outside [low, high]; `knots` are x and y, b, c, d
    of each piece."""

    over: int
    low: float
    high: float
    knots: Sequence[tuple[float, float, float, float, float]]


class Program(NamedTuple):
    """Arithmetic over quantities, see the kernel's `ProgramOf`: the values of loads that vary.

    `reads` are kind, then type, number, freedom and order of an `Output`; `numbers` data and factor
    of each; `outputs` are registers, `kinks` numbers of operations.
    """

    reads: Sequence[tuple[int, int, int, int, int]]
    numbers: Sequence[Number]
    curves: Sequence[ProgramCurve]
    constants: Sequence[Number]
    operations: Sequence[int]
    operands: Sequence[tuple[int, int, int]]
    outputs: Sequence[int]
    kinks: Sequence[int]


class Driven(NamedTuple):
    """How many inputs, the first ones, motors or actuators answer for."""

    inputs: int


class Actuator(NamedTuple):
    """A coordinate at which an effort acts instead of at the inputs: as that of an applied load."""

    axis: int
    reference: int
    freedom: int


class Transmission(NamedTuple):
    """An input that is moved by the motor of another, its leader."""

    input: int
    leader: int


class Friction(NamedTuple):
    """The friction of the joint at a place; see the kernel's `Friction`."""

    place: int
    turns: int
    slides: int
    link: int
    falls: bool
    axis: Triple
    radius: Number
    pitch: Number
    at_rest: Number
    sliding: Number
    speed: Number


class PlanContact(NamedTuple):
    """The next contact of the friction before it; see the kernel's `Contact`."""

    type: int
    weight: Number
    share: Number
    tilt: Number
    roll: Number
    direction: Triple


class SizePoint(NamedTuple):
    """A joint's point whose place in the first assembly tells the mechanism's size; of ground in
    m."""

    link: int
    point: Triple


class Output(NamedTuple):
    """A quantity that a run writes, see the kernel's `OutputCode`; `factor` carries it to SI."""

    type: int
    number: int
    freedom: int
    order: int
    data: Triple
    factor: Number


PlanRecord = (
    Units
    | TreeJoint
    | ClosingJoint
    | HungLinks
    | JointPlace
    | JointAxis
    | FreeDirections
    | PlanBlock
    | Rest
    | Input
    | Inertia
    | PlanGravity
    | AppliedLoad
    | Program
    | Driven
    | Actuator
    | Transmission
    | Friction
    | PlanContact
    | SizePoint
)


_VERBS: dict[type, str] = {
    TreeJoint: "add_tree_joint",
    ClosingJoint: "add_closing_joint",
    HungLinks: "add_leg",
    JointPlace: "add_place",
    JointAxis: "add_axis",
    FreeDirections: "add_free_motion",
    PlanBlock: "add_block",
    Rest: "set_rest",
    Input: "add_input",
    Inertia: "set_inertia",
    PlanGravity: "set_gravity",
    AppliedLoad: "add_load",
    Program: "set_load_program",
    Driven: "set_driven",
    Actuator: "add_actuator",
    Transmission: "add_tie",
    Friction: "add_friction",
    PlanContact: "add_contact",
    SizePoint: "add_size_point",
}
"""The builder's call for each record."""

_CONSTANTS: dict[type, tuple[str, ...]] = {
    Units: ("length", "origin", "size"),
    TreeJoint: ("pitch", "at"),
    ClosingJoint: ("on_first", "on_second", "parameter"),
    HungLinks: ("on_first", "on_second", "length", "line"),
    JointPlace: ("point",),
    JointAxis: ("vector", "other_vector"),
    FreeDirections: ("vector",),
    Input: ("scale",),
    Inertia: ("mass", "centre", "tensor"),
    PlanGravity: ("g",),
    AppliedLoad: ("point", "other_point", "vector"),
    Program: ("numbers", "constants"),
    Friction: ("axis", "radius", "pitch", "at_rest", "sliding", "speed"),
    PlanContact: ("weight", "share", "tilt", "roll", "direction"),
    SizePoint: ("point",),
    Output: ("data", "factor"),
}
"""The fields of each record that are constants; the others are structure."""


def flatten(records: Iterable[PlanRecord | Output]) -> list[Number]:
    """The constants of some records in the order in which the kernel numbers them."""
    found: list[Number] = []
    for record in records:
        for name in _CONSTANTS.get(type(record), ()):
            value = getattr(record, name)
            if isinstance(value, tuple | list):
                found.extend(value)
            else:
                found.append(value)
    return found


def hand_over(records: Sequence[PlanRecord]) -> Plan:
    """The kernel's plan of some records, `Units` first.

    Raises:
        ValueError: records that do not fit together; numbers that are not finite.
    """
    units, *others = records
    builder = _kernel.PlanBuilder(*units)
    for record in others:
        getattr(builder, _VERBS[type(record)])(*record)
    return builder.finish()


def hand_over_outputs(plan: Plan, records: Sequence[Output]) -> Outputs:
    """The kernel's outputs of some records, for plans of one structure.

    Raises:
        ValueError: a record that the plan cannot serve.
    """
    return _kernel.Outputs(plan, list(records))
