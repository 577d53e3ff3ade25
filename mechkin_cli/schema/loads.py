"""`loads:` - gravity, forces, torques, springs, dampers, bushings and friction.

A value may be an expression of coordinates, their rates and `time`, or `{table: file.csv}`.
"""

from typing import Annotated, Any, ClassVar, Final, Literal, TypeVar

from mechkin_cli.schema.base import FormChoice, Limits, SchemaName, Section, by_word, refuse
from mechkin_cli.schema.links_joints import InertiaAxes, PointJoint
from mechkin_cli.schema.scalars import (
    AccelerationVector,
    Angle,
    AngleOrLength,
    CsvPath,
    Damping,
    Dimensionless,
    DirectionVector,
    Force,
    ForceOrTorque,
    JoinedTable,
    Length,
    Name,
    NamedOrGiven,
    RunNames,
    Stiffness,
    Text,
    Torque,
    Velocity,
    Viscosity,
)


class TableValue(JoinedTable):
    """A value read from a CSV file."""

    tag = "(table)"

    table: CsvPath
    """CSV file with a header and two columns: what it runs over, and the value."""
    over: Text | None = None
    """The quantity of the first column, for example O1.theta_dot or time; left out, the coordinate
    of a load on a joint, and time for a load on a link."""


def _expression_or_table(value: Any) -> str:
    return "(table)" if isinstance(value, (dict, TableValue)) else "(expression)"


_Expression = TypeVar("_Expression")
OrTable = Annotated[
    Annotated[_Expression, "(expression)"] | TableValue, FormChoice(_expression_or_table)
]
"""An expression, or a table of its values."""

ForceValue = Annotated[OrTable[Force], SchemaName("ForceValue")]
TorqueValue = Annotated[OrTable[Torque], SchemaName("TorqueValue")]
Axes = Literal["ground", "link"]
Between = Annotated[tuple[Name, ...], Limits(min_length=2, max_length=2)]


def standard_or_vector(value: Any) -> str:
    """The form of free fall."""
    is_word = isinstance(value, str) and value.strip()[:1].isalpha()
    return "(standard)" if is_word else "(vector)"


FreeFall = Annotated[
    Annotated[AccelerationVector, "(vector)"] | Annotated[Literal["standard"], "(standard)"],
    FormChoice(standard_or_vector),
    SchemaName("FreeFall"),
]


class InRuns(Section):
    """A load of some runs."""

    runs: RunNames | None = None
    """The runs it acts in, `sweep` or names of responses; left out, all."""


class Gravity(InRuns):
    """Acts at the mass centre of every link with mass."""

    type: Literal["gravity"]
    g: FreeFall
    """Acceleration of free fall in ground axes, [x, y, z]; or standard, 9.80665 m/s^2."""
    direction: DirectionVector | None = None
    """With g: standard, where things fall, in ground axes; left out, [0, 0, -1]."""

    def check(self) -> None:
        """A direction of its own goes with the standard size alone."""
        check_free_fall(self.g, self.direction)


def check_free_fall(g: Any, direction: Any) -> None:
    """Raises an error where free fall has a vector and a direction of its own."""
    if direction is not None and g != "standard":
        text = "g as a vector has a direction already"
        raise refuse("two-choices", text, "write g: standard, or no direction", "direction")


ELEMENT: Final = {
    **dict.fromkeys(("k", "spring_constant", "rate"), "write stiffness: 2 N/mm"),
    **dict.fromkeys(("c", "d", "damping_constant", "coefficient"), "write damping: 2 N*s/mm"),
    **dict.fromkeys(("free_length", "length", "rest", "rest_length", "l0"), "write free: 80 mm"),
    **dict.fromkeys(("force", "pretension", "initial_force"), "write preload: 5 N"),
}
"""What to write for other words of springs and dampers."""

BETWEEN: Final = ELEMENT | dict.fromkeys(
    ("from", "to", "points", "ends", "links", "a", "b", "point1", "point2"),
    "write between: [P, Q] with two names from points:",
)


class NamedLoad(InRuns):
    """A force or torque that may have a name."""

    name: Name | None = None
    """Its name, by which small motions take it as an input; left out, it has none."""


class ForceOnLink(NamedLoad):
    """A force at a point of a link."""

    type: Literal["force"]
    link: Name
    """The link it acts on."""
    point: NamedOrGiven
    """Where it acts: a point of the link in the home drawing, [x, y, z] or by its name."""
    force: Annotated[tuple[ForceValue, ...], Limits(min_length=3, max_length=3)]
    """The force, [x, y, z]."""
    axes: Axes = "ground"
    """Whether the components are in ground axes or turn with the link (its axes in the drawing)."""


class TorqueOnLink(NamedLoad):
    """A couple on a link."""

    type: Literal["torque"]
    link: Name
    """The link it acts on."""
    torque: Annotated[tuple[TorqueValue, ...], Limits(min_length=3, max_length=3)]
    """The couple, [x, y, z]."""
    axes: Axes = "ground"
    """Whether the components are in ground axes or turn with the link (its axes in the drawing)."""


class ForceOnJoint(NamedLoad):
    """A force on the coordinate s of a joint: it acts on the second link, against the first."""

    advice: ClassVar[dict[str, str]] = {"force": "write value: 5 N"}

    tag = "(force at joint)"

    type: Literal["force"]
    joint: Name
    """The joint."""
    value: ForceValue
    """The force, positive in the direction of s."""


class TorqueOnJoint(NamedLoad):
    """A torque on the coordinate theta of a joint: on the second link, against the first."""

    advice: ClassVar[dict[str, str]] = {"torque": "write value: 5 N*m"}

    tag = "(torque at joint)"

    type: Literal["torque"]
    joint: Name
    """The joint."""
    value: TorqueValue
    """The torque, positive in the direction of theta."""


class SpringBetweenPoints(InRuns):
    """A straight spring; its pull is preload + stiffness * (distance - free)."""

    advice: ClassVar[dict[str, str]] = BETWEEN

    type: Literal["spring"]
    between: Between
    """Two named points."""
    stiffness: Stiffness
    """Force per length."""
    free: Length
    """Length without force (apart from the preload)."""
    preload: Force = "0"
    """Pull at the free length."""


class SpringAtJoint(InRuns):
    """A spring on a coordinate; it resists with preload + stiffness * (coordinate - free)."""

    advice: ClassVar[dict[str, str]] = ELEMENT

    tag = "(spring at joint)"

    type: Literal["spring"]
    joint: Name
    """The joint."""
    coordinate: Name
    """The coordinate of the joint, for example theta."""
    stiffness: Stiffness
    """Force per length, or moment per angle (bare numbers: per rad)."""
    free: AngleOrLength = "0"
    """Coordinate without force (apart from the preload)."""
    preload: ForceOrTorque = "0"
    """Force or moment at the free coordinate."""


class DamperBetweenPoints(InRuns):
    """A straight damper; it resists the rate of the distance."""

    advice: ClassVar[dict[str, str]] = BETWEEN

    type: Literal["damper"]
    between: Between
    """Two named points."""
    damping: Damping
    """Force per speed."""


class DamperAtJoint(InRuns):
    """A damper on a coordinate; it resists the rate of the coordinate."""

    advice: ClassVar[dict[str, str]] = ELEMENT

    tag = "(damper at joint)"

    type: Literal["damper"]
    joint: Name
    """The joint."""
    coordinate: Name
    """The coordinate of the joint, for example theta."""
    damping: Damping
    """Force per speed, or moment per angular rate (bare numbers: per rad/s)."""


class BushingStiffness(Section):
    """The stiffness of a bushing along its axes and about them."""

    tag = "(diagonal)"

    x: Stiffness = "0"
    """Force per length along x."""
    y: Stiffness = "0"
    """Force per length along y."""
    z: Stiffness = "0"
    """Force per length along z."""
    rx: Stiffness = "0"
    """Moment per angle about x (bare numbers: per rad)."""
    ry: Stiffness = "0"
    """Moment per angle about y (bare numbers: per rad)."""
    rz: Stiffness = "0"
    """Moment per angle about z (bare numbers: per rad)."""


class BushingDamping(Section):
    """The damping of a bushing along its axes and about them."""

    tag = "(diagonal)"

    x: Damping = "0"
    """Force per speed along x."""
    y: Damping = "0"
    """Force per speed along y."""
    z: Damping = "0"
    """Force per speed along z."""
    rx: Damping = "0"
    """Moment per angular rate about x (bare numbers: per rad/s)."""
    ry: Damping = "0"
    """Moment per angular rate about y (bare numbers: per rad/s)."""
    rz: Damping = "0"
    """Moment per angular rate about z (bare numbers: per rad/s)."""


class BushingFree(Section):
    """Where a bushing has no force: the deflection from the drawing, along and about its axes."""

    x: Length = "0"
    """Shift along x."""
    y: Length = "0"
    """Shift along y."""
    z: Length = "0"
    """Shift along z."""
    rx: Angle = "0"
    """Component of the rotation vector along x."""
    ry: Angle = "0"
    """Component of the rotation vector along y."""
    rz: Angle = "0"
    """Component of the rotation vector along z."""


_SIX = Limits(min_length=6, max_length=6)
_Entry = TypeVar("_Entry")
SixBySix = Annotated[tuple[Annotated[tuple[_Entry, ...], _SIX], ...], _SIX]
"""Six rows of six numbers: x, y, z, rx, ry, rz."""


def _diagonal_or_matrix(value: Any) -> str:
    return "(matrix)" if isinstance(value, (list, tuple)) else "(diagonal)"


class BushingBetweenLinks(PointJoint, InRuns):
    """A spring between two links in all six directions: a rubber mount, a flexure.

    It resists the shift of the second link's point in the axes, which ride on the first link, and
    the rotation vector of the second link against the first, both from the drawing.
    """

    advice: ClassVar[dict[str, str]] = {
        "axis": "write axes: {x: [1, 0, 0], y: [0, 1, 0]}; its own axes are x, y and z",
        "preload": "write free: {z: 2 mm}, where it has no force",
        **dict.fromkeys(("k", "matrix"), "write stiffness: {x: 200 N/mm, rz: 5 N*m/rad}"),
        **dict.fromkeys(("c", "d"), "write damping: {x: 2 N*s/mm}"),
    }

    type: Literal["bushing"]
    name: Name | None = None
    """Its name, by which columns read its force; left out, it has no quantities."""
    stiffness: Annotated[
        Annotated[SixBySix[Stiffness], "(matrix)"] | Annotated[BushingStiffness, "(diagonal)"],
        FormChoice(_diagonal_or_matrix),
        SchemaName("StiffnessInSix"),
    ]
    """Force and moment per deflection: {x, y, z, rx, ry, rz}, or a symmetric matrix of six rows."""
    damping: (
        Annotated[
            Annotated[SixBySix[Damping], "(matrix)"] | Annotated[BushingDamping, "(diagonal)"],
            FormChoice(_diagonal_or_matrix),
            SchemaName("DampingInSix"),
        ]
        | None
    ) = None
    """Force and moment per velocity, likewise; left out, it does not damp."""
    axes: InertiaAxes | None = None
    """Its axes in the home drawing, which turn with the first link; left out, those of the
    ground."""
    free: BushingFree | None = None
    """The deflection without force; left out, it has no force as drawn."""


EXAMPLES_OF_LOADS: Final[dict[tuple[str, str], Any]] = {
    **{
        (section, key): example
        for section in ("BushingBetweenLinks", "PlaneBushing")
        for key, example in {
            "name": "mount",
            "stiffness": {"x": "200 N/mm", "rz": "5 N*m/rad"},
            "damping": {"x": "2 N*s/mm"},
            "free": {"x": "2 mm"},
        }.items()
    },
    **{
        (section, "name"): "push"
        for section in ("ForceOnLink", "TorqueOnLink", "ForceOnJoint", "TorqueOnJoint")
    },
    ("PlaneForce", "name"): "push",
    ("PlaneTorque", "name"): "twist",
    ("PlaneBushing", "point"): [0, "10 mm"],
    ("PlaneBushing", "x"): [1, 2],
}
"""Examples for editors, by section and key."""


class FallingCoefficient(Section):
    """A coefficient of friction that falls from rest to sliding."""

    tag = "(falling)"

    static: Dimensionless
    """At rest."""
    sliding: Dimensionless
    """Of surfaces that slide."""
    speed: Velocity | None = None
    """Speed over which it falls, by exp(-(v / speed)^2); left out, it falls at once."""


def _number_or_falling(value: Any) -> str:
    return "(falling)" if isinstance(value, (dict, FallingCoefficient)) else "(number)"


Coefficient = Annotated[
    Annotated[Dimensionless, "(number)"] | FallingCoefficient,
    FormChoice(_number_or_falling),
    SchemaName("Coefficient"),
]


_OF_FILM = ("viscosity", "clearance", "radius", "length")
_OF_FILM_ALONE = _OF_FILM[:2]


class FrictionLoad(InRuns):
    """Friction in space or in a plane."""

    type: Literal["friction"]
    joint: Name
    """The joint that rubs."""
    law: Literal["dry", "viscous", "stribeck"] = "dry"
    """`dry`, by a coefficient; `viscous`, by a film of oil that carries the load; `stribeck`, both
    together; left out, dry."""
    coefficient: Coefficient | None = None
    """Friction force per normal load; or static, sliding and the speed between them. Dry friction
    needs it; left out, `law: viscous`."""
    viscosity: Viscosity | None = None
    """Dynamic viscosity of the oil film, which it needs; left out, dry."""
    clearance: Length | None = None
    """Thickness of the oil film, the difference of the radii, which it needs; left out, dry."""

    def check(self) -> None:
        """A law has what it goes by."""
        dry, film = ("coefficient",), _OF_FILM
        needs = {"dry": dry, "viscous": film, "stribeck": (*dry, *film)}[self.law]
        for key in needs:
            if getattr(self, key) is None:
                text = f"friction by the law {self.law} needs a {key}"
                raise refuse("missing-key", text, f"it takes {', '.join(needs)}")
        for key in (*dry, *_OF_FILM_ALONE):
            if key not in needs and getattr(self, key) is not None:
                text = f"friction by the law {self.law} has no {key}"
                hint = "write law: viscous for an oil film, or law: stribeck for both"
                raise refuse("two-choices", text, hint, key)


class FrictionAtJoint(FrictionLoad):
    """Coulomb friction of a joint R, P, C, H, S, Sp or Sg, from the joint's own reaction."""

    radius: Length | None = None
    """R, C, S: radius of the surfaces that turn; H: mean radius of the thread. `R`, `C`, `H`
    and `S` need it."""
    length: Length | None = None
    """R, C, P: distance of the two bearings (shoes) along the axis; they take tilting moments;
    left out, moments do not rub."""
    collar: Length | None = None
    """R: mean radius of the face that takes axial force; left out, no face rubs."""
    width: Length | None = None
    """P: distance of the shoes across the axis; they take the moment about it; left out, it
    does not rub."""
    across: DirectionVector | None = None
    """P: direction of the width; left out, the shoes take forces alike in all directions."""
    flank: Angle | None = None
    """H: angle of the flank against the plane square to the axis, half the thread's angle; left
    out, 0, a square thread."""


AnyLoad = (
    Gravity
    | ForceOnLink
    | ForceOnJoint
    | TorqueOnLink
    | TorqueOnJoint
    | SpringBetweenPoints
    | SpringAtJoint
    | DamperBetweenPoints
    | DamperAtJoint
    | BushingBetweenLinks
    | FrictionAtJoint
)
_WORDS = ("gravity", "force", "torque", "spring", "damper", "bushing", "friction")


def _tag(mapping: dict[str, Any]) -> str | None:
    word = mapping.get("type")
    if word not in _WORDS:
        return None
    at_joint = "joint" in mapping and word not in ("gravity", "bushing", "friction")
    return f"({word} at joint)" if at_joint else f"({word})"


form_of_load = by_word("type", _WORDS, _tag)
Load = Annotated[AnyLoad, form_of_load]
