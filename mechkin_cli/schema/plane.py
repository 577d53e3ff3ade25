"""The whole file of a mechanism in a plane: format 1 with `plane: xy`.

Points, directions and forces are two numbers, inertias and torques one, and nothing has an axis.
Spatial values are refused at their key, with what to write instead.

`in_space` makes of it a file in space: the plane is z = 0, and its normal is the axis of all turns.
Every key keeps its path, so that errors are reported where a value is written; the values that a
plane file omits are literals, which have no errors of their own. That no cut joint repeats the
constraints of the plane is up to the pairs (mechanism/pairs.py).
"""

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Final, Literal

from mechkin_cli.schema.base import (
    NOTHING,
    FormChoice,
    Limits,
    Rule,
    SchemaName,
    Section,
    by_word,
    fields_of,
    one_of,
    refuse,
    section_of,
)
from mechkin_cli.schema.curves import Curve, PlaneCurve
from mechkin_cli.schema.file import AnyFile, MechanismFile
from mechkin_cli.schema.links_joints import (
    AnyJoint,
    BodyWithMass,
    DirectionOrPerLink,
    InertiaAxes,
    JointBase,
    Link,
    LinkInertia,
    PerLink,
    PlaceOrPerLink,
    PointJoint,
    PrismaticJoint,
    RevoluteJoint,
    WeldJoint,
)
from mechkin_cli.schema.loads import (
    AnyLoad,
    Axes,
    BushingBetweenLinks,
    BushingDamping,
    BushingFree,
    BushingStiffness,
    DamperAtJoint,
    DamperBetweenPoints,
    ForceOnJoint,
    ForceOnLink,
    ForceValue,
    FrictionAtJoint,
    FrictionLoad,
    Gravity,
    InRuns,
    NamedLoad,
    SpringAtJoint,
    SpringBetweenPoints,
    TorqueOnJoint,
    TorqueOnLink,
    TorqueValue,
    check_free_fall,
    form_of_load,
    standard_or_vector,
)
from mechkin_cli.schema.scalars import (
    Acceleration,
    Angle,
    AnyDimension,
    Damping,
    DirectionOfLink,
    Inertia,
    Length,
    Name,
    NamedOr,
    PointOfLink,
    Stiffness,
)

PLANE_JOINT_LETTERS: Final = ("R", "P", "Ps", "W")
_LEFT_OUT: Final = "leave it out: in a plane file "
_NORMAL: Final = _LEFT_OUT + "turns are about the plane's normal"


def _plane_word(value: Any) -> str:
    if value == "xy":
        return "xy"
    text = "the plane of a file is xy"
    raise refuse("unknown-plane", text, "write plane: xy, with x and y along your own two axes")


def _two_numbers(value: Any) -> Any:
    if not isinstance(value, (list, tuple)):
        raise refuse("wrong-kind", "expected two numbers", "write them in brackets: [x, y]")
    if len(value) == 3:
        text = "a vector of a plane file has two numbers"
        hint = "write [x, y]; a mechanism that leaves its plane is written without plane: xy"
        raise refuse("spatial", text, hint, 2)
    if len(value) != 2:
        raise refuse("wrong-length", "a vector of a plane file has two numbers", "write [x, y]")
    return value


def _about_normal(value: Any) -> Any:
    if isinstance(value, (list, tuple, dict)):
        what = "xx: ..., zz: ..." if isinstance(value, dict) else "x, y, z"
        hint = f"write the one about the normal, without {what}"
        raise refuse("spatial", "in a plane file this is one number, about the normal", hint)
    return value


_TWO: Final = Limits(min_length=2, max_length=2)
PlaneVector = Annotated[
    tuple[Length, ...], _TWO, Rule(_two_numbers, before=True), SchemaName("PlaneVector")
]
PlaneDirection = Annotated[
    tuple[AnyDimension, ...], _TWO, Rule(_two_numbers, before=True), SchemaName("PlaneDirection")
]
PlaneNamedOrGiven = Annotated[NamedOr[PlaneVector], SchemaName("PlaneNamedOrGiven")]
PlanePoint = Annotated[PlaceOrPerLink[PlaneVector, PlaneNamedOrGiven], SchemaName("PlanePoint")]
PlaneDirections = Annotated[DirectionOrPerLink[PlaneDirection], SchemaName("PlaneDirections")]


class PlaneLink(BodyWithMass):
    """A rigid body in a plane. All its keys may be left out: `{}` is a link without mass."""

    center_of_mass: PlaneNamedOrGiven | None = None
    """Mass centre in the home drawing, [x, y] or the name of a point of the link; left out, the
    link has no mass."""
    inertia: Annotated[Inertia, Rule(_about_normal, before=True)] | None = None
    """Moment of inertia about the mass centre, about the plane's normal; left out, zero."""


class PlanePointJoint(JointBase):
    """A joint of a plane with a point: all but the weld."""

    point: PlanePoint
    """A point of the joint in the home drawing, [x, y] or by its name, or one per link."""


class PlaneRevoluteJoint(PlanePointJoint):
    """R: the second link turns by theta against the first, counter-clockwise."""

    advice: ClassVar[dict[str, str]] = {"axis": _NORMAL}

    type: Literal["R"]
    zero: Annotated[PerLink[PlaneDirection], SchemaName("PlaneZeroReference")] | None = None
    """A direction for each link; the two lie in line at theta = 0. Left out, theta is zero as
    drawn."""


class PlanePrismaticJoint(PlanePointJoint):
    """P: the second link slides by s along `axis` and does not turn against the first."""

    advice: ClassVar[dict[str, str]] = {
        "zero": _LEFT_OUT + "the links stand as drawn, or with the axis per link in line"
    }

    type: Literal["P"]
    axis: PlaneDirections
    """Direction of the slide in the home drawing, [x, y], or one direction for each link."""


class PinInSlotJoint(PlanePointJoint):
    """Ps: a pin of the first link in a slot of the second.

    The second link turns by theta against the first, counter-clockwise; s is where the pin is along
    a straight slot, u the parameter of a curved one.
    """

    advice: ClassVar[dict[str, str]] = {"axis": _NORMAL, "groove": "the key is slot: [x, y]"}

    type: Literal["Ps"]
    slot: PlaneDirection | None = None
    """Direction of the slot, fixed in the second link, [x, y]; s grows along it; left out,
    `curve`."""
    curve: PlaneCurve | None = None
    """The curve that the pin's centre stays on, in the home drawing; left out, a straight line."""

    def check(self) -> None:
        """A straight slot or a curve."""
        super().check()
        one_of(self, "slot", "curve")


class PlaneWeldJoint(JointBase):
    """W: the two links are one body."""

    type: Literal["W"]


PlaneJoint = Annotated[
    PlaneRevoluteJoint | PlanePrismaticJoint | PinInSlotJoint | PlaneWeldJoint,
    by_word("type", PLANE_JOINT_LETTERS),
]


class PlanePointOfLink(Section):
    """A point fixed in a link; columns read its position, velocity, acceleration and jerk."""

    link: Name
    """The link that carries the point; `ground` for a fixed one."""
    at: PlaneNamedOrGiven
    """The point in the home drawing, [x, y] or the name of a point that is drawn at the same
    place."""


class PlaneDirectionOfLink(Section):
    """A unit vector fixed in a link; columns use it by its name."""

    link: Name
    """The link that carries the direction; `ground` for a fixed one."""
    vector: PlaneDirection
    """The direction in the home drawing, [x, y]; its length does not matter."""


class PlaneGravity(InRuns):
    """Acts at the mass centre of every link with mass."""

    type: Literal["gravity"]
    g: Annotated[
        Annotated[
            Annotated[tuple[Acceleration, ...], _TWO, Rule(_two_numbers, before=True)], "(vector)"
        ]
        | Annotated[Literal["standard"], "(standard)"],
        FormChoice(standard_or_vector),
        SchemaName("PlaneFreeFall"),
    ]
    """Acceleration of free fall, [x, y]; or standard, 9.80665 m/s^2."""
    direction: PlaneDirection | None = None
    """With g: standard, where things fall; left out, [0, -1]."""

    def check(self) -> None:
        """A direction of its own goes with the standard size alone."""
        check_free_fall(self.g, self.direction)


class PlaneForce(NamedLoad):
    """A force at a point of a link."""

    type: Literal["force"]
    link: Name
    """The link it acts on."""
    point: PlaneNamedOrGiven
    """Where it acts: a point of the link in the home drawing, [x, y] or by its name."""
    force: Annotated[tuple[ForceValue, ...], _TWO, Rule(_two_numbers, before=True)]
    """The force, [x, y]."""
    axes: Axes = "ground"
    """Whether the components are in ground axes or turn with the link (its axes in the drawing)."""


def _one_torque(value: Any) -> Any:
    return _about_normal(value) if isinstance(value, (list, tuple)) else value


class PlaneTorque(NamedLoad):
    """A torque on a link, counter-clockwise."""

    advice: ClassVar[dict[str, str]] = {"axes": _NORMAL}

    type: Literal["torque"]
    link: Name
    """The link it acts on."""
    torque: Annotated[TorqueValue, Rule(_one_torque, before=True)]
    """The torque, positive counter-clockwise."""


class PlaneBushingStiffness(Section):
    """The stiffness of a bushing along its axes and about the normal."""

    x: Stiffness = "0"
    """Force per length along x."""
    y: Stiffness = "0"
    """Force per length along y."""
    rz: Stiffness = "0"
    """Moment per angle (bare numbers: per rad)."""


class PlaneBushingDamping(Section):
    """The damping of a bushing along its axes and about the normal."""

    x: Damping = "0"
    """Force per speed along x."""
    y: Damping = "0"
    """Force per speed along y."""
    rz: Damping = "0"
    """Moment per angular rate (bare numbers: per rad/s)."""


class PlaneBushingFree(Section):
    """Where a bushing has no force: the deflection from the drawing."""

    x: Length = "0"
    """Shift along x."""
    y: Length = "0"
    """Shift along y."""
    rz: Angle = "0"
    """Turn."""


class PlaneBushing(PlanePointJoint, InRuns):
    """A spring between two links in all directions of the plane: a rubber mount, a flexure."""

    advice: ClassVar[dict[str, str]] = {"axes": "write x: [1, 0], the direction of its axis x"}

    type: Literal["bushing"]
    name: Name | None = None
    """Its name, by which columns read its force; left out, it has no quantities."""
    stiffness: PlaneBushingStiffness
    """Force and moment per deflection: {x, y, rz}."""
    damping: PlaneBushingDamping | None = None
    """Force and moment per velocity: {x, y, rz}; left out, it does not damp."""
    x: PlaneDirection | None = None
    """Its axis x in the home drawing, which turns with the first link; left out, that of the
    ground."""
    free: PlaneBushingFree | None = None
    """The deflection without force; left out, it has no force as drawn."""


class PlaneFriction(FrictionLoad):
    """Coulomb friction of a joint R, P or Ps, from the joint's own reaction. A pin rubs along its
    slot."""

    advice: ClassVar[dict[str, str]] = {
        "collar": _LEFT_OUT + "nothing presses along the normal",
        "width": _LEFT_OUT + "no moment tilts a guide about its own axis",
        "across": _LEFT_OUT + "no moment tilts a guide about its own axis",
        "flank": "threads are spatial: write the file without plane: xy",
    }

    radius: Length | None = None
    """R: radius of the pin, which it needs."""
    length: Length | None = None
    """P: distance of the two shoes along the axis; they take the moment; left out, it
    does not rub."""


PlaneLoad = Annotated[
    PlaneGravity
    | PlaneForce
    | ForceOnJoint
    | PlaneTorque
    | TorqueOnJoint
    | SpringBetweenPoints
    | SpringAtJoint
    | DamperBetweenPoints
    | DamperAtJoint
    | PlaneBushing
    | PlaneFriction,
    form_of_load,
]


class PlaneFile(AnyFile):
    """A mechanism in a plane, in the format 1 of mechkin.

    All points, directions and mass centres are written in one drawing, the home pose, as [x, y];
    every joint coordinate is zero there. Angles and torques are positive counter-clockwise. Joints,
    couplings, links, points, directions and parameters share one namespace.
    """

    advice: ClassVar[dict[str, str]] = {
        "chain": "rows of Denavit and Hartenberg are spatial: write the joints under joints: as "
        "{type: R, links: [crank, rod], point: [x, y]}; a chain over two wheels is a coupling: "
        "couplings: {K: {type: chain, joints: [A, B], teeth: [17, 38], pitch: 12.7 mm}}",
        "coefficients": "they are six equations a link: leave it out; A.force and A.moment are "
        "unique in a plane",
        "idle": _LEFT_OUT + "no link spins about its own line",
    }

    in_plane = True

    plane: Annotated[Literal["xy"], Rule(_plane_word, before=True)]
    """Everything moves in the plane x, y: vectors are two numbers, inertias and torques one; left
    out, a mechanism in space."""
    links: dict[Name, PlaneLink] = NOTHING
    """The moving bodies by name; `ground` always exists."""
    joints: dict[Name, PlaneJoint] = NOTHING
    """The joints by name."""
    points: dict[Name, PlanePointOfLink] = NOTHING
    """Points that move with links, by name; left out, none."""
    directions: dict[Name, PlaneDirectionOfLink] = NOTHING
    """Directions that turn with links, by name; left out, none."""
    loads: tuple[PlaneLoad, ...] = ()
    """Gravity, forces, torques, springs, dampers and friction; left out, none."""

    def check(self) -> None:
        """There is a joint or a cylinder, and no two tables are written to the same files."""
        if not self.joints and not self.cylinders:
            raise refuse("no-joints", "the file has no joints", "add joints:")
        super().check()


# --- the same in space ---------------------------------------------------------------------------

Texts = tuple[str, ...]
Place = str | Texts
"""A vector of the plane, or the name of a point."""

_ABOUT_Z: Texts = ("0", "0", "1")
_DOWN: Texts = ("0", "-1", "0")


class PlaneInSpace(MechanismFile):
    """A file in a plane as one in space."""

    in_plane = True


class _PinInSlot(PointJoint):
    """Ps with the normal that it turns about."""

    type: str
    normal: Texts
    slot: Texts | None = None
    curve: Curve | None = None


def in_space(file: AnyFile) -> MechanismFile:
    """A file in a plane as one in space."""
    assert isinstance(file, PlaneFile)
    common = {field.name: getattr(file, field.name) for field in fields_of(AnyFile).values()}
    return section_of(
        PlaneInSpace,
        **common,
        links={name: _link(link) for name, link in file.links.items()},
        joints={name: _joint(joint) for name, joint in file.joints.items()},
        points={
            name: section_of(PointOfLink, link=point.link, at=_flat(point.at))
            for name, point in file.points.items()
        },
        directions={
            name: section_of(DirectionOfLink, link=one.link, vector=_flat(one.vector))
            for name, one in file.directions.items()
        },
        loads=tuple(_load(load) for load in file.loads),
    )


def _flat(place: Place) -> Place:
    """A vector of the plane in space; a name stays a name."""
    return place if isinstance(place, str) else (*place, "0")


def _each(place: Place | Mapping[str, Place]) -> Place | Mapping[str, Place]:
    """One vector, or one per link, in space."""
    if isinstance(place, Mapping):
        return {link: _flat(one) for link, one in place.items()}
    return _flat(place)


def _link(link: PlaneLink) -> Link:
    centre, normal = link.center_of_mass, link.inertia
    return section_of(
        Link,
        mass=link.mass,
        center_of_mass=None if centre is None else _flat(centre),
        inertia=None if normal is None else section_of(LinkInertia, zz=normal),
    )


def _joint(joint: JointBase) -> AnyJoint:
    links = joint.links
    if isinstance(joint, PlaneRevoluteJoint):
        zero = None if joint.zero is None else _each(joint.zero)
        of_pin = {"links": links, "point": _each(joint.point), "axis": _ABOUT_Z, "zero": zero}
        return section_of(RevoluteJoint, type=joint.type, **of_pin)
    if isinstance(joint, PlanePrismaticJoint):
        # seen along the axis, the normal of either drawing is the plane's
        square = dict.fromkeys(links, _ABOUT_Z)
        of_guide = {"point": _each(joint.point), "axis": _each(joint.axis), "zero": square}
        return section_of(PrismaticJoint, type=joint.type, links=links, **of_guide)
    if isinstance(joint, PinInSlotJoint):
        of_slot = {
            "point": _each(joint.point),
            "normal": _ABOUT_Z,
            "slot": None if joint.slot is None else _flat(joint.slot),
            "curve": None if joint.curve is None else _curve(joint.curve),
        }
        return section_of(_PinInSlot, type=joint.type, links=links, **of_slot)  # type: ignore[return-value]
    assert isinstance(joint, PlaneWeldJoint)
    return section_of(WeldJoint, type="W", links=links)


def _curve(curve: PlaneCurve) -> Curve:
    places: dict[str, Any] = {
        key: None if value is None else tuple(_flat(place) for place in value)
        for key in ("line", "arc", "points")
        for value in [getattr(curve, key)]
    }
    for key in ("center", "at"):
        value = getattr(curve, key)
        places[key] = None if value is None else _flat(value)
        axis = None if curve.center is None else _ABOUT_Z
    ends: dict[str, Any] = {"from": curve.first, "to": curve.last}
    return section_of(Curve, **places, **ends, axis=axis, radius=curve.radius, closed=curve.closed)


def _load(load: object) -> AnyLoad:
    if isinstance(load, PlaneGravity):
        g = load.g if isinstance(load.g, str) else _flat(load.g)
        direction = None if load.direction is None else _flat(load.direction)
        if isinstance(g, str) and direction is None:
            direction = _DOWN
        return section_of(Gravity, type=load.type, g=g, direction=direction, runs=load.runs)
    if isinstance(load, PlaneForce):
        force = (*load.force, "0")
        of_force = {"link": load.link, "point": _flat(load.point), "force": force}
        common = {key: getattr(load, key) for key in ("type", "name", "runs")}
        return section_of(ForceOnLink, axes=load.axes, **common, **of_force)
    if isinstance(load, PlaneTorque):
        of_torque = {"link": load.link, "torque": ("0", "0", load.torque)}
        common = {key: getattr(load, key) for key in ("type", "name", "runs")}
        return section_of(TorqueOnLink, **common, **of_torque)
    if isinstance(load, PlaneBushing):
        return _bushing(load)
    if isinstance(load, PlaneFriction):
        common = {field.name: getattr(load, field.name) for field in fields_of(type(load)).values()}
        return section_of(FrictionAtJoint, **common)
    return load  # type: ignore[return-value]


def _bushing(load: PlaneBushing) -> BushingBetweenLinks:
    """What the plane holds has no stiffness."""
    axes = None
    if load.x is not None:
        x, y = load.x
        axes = section_of(InertiaAxes, x=_flat(load.x), y=(f"-({y})", x, "0"))
    forms = {"stiffness": BushingStiffness, "damping": BushingDamping, "free": BushingFree}
    of_axes = {
        key: None if part is None else section_of(form, x=part.x, y=part.y, rz=part.rz)
        for key, form in forms.items()
        for part in [getattr(load, key)]
    }
    same = {key: getattr(load, key) for key in ("type", "name", "links", "runs")}
    return section_of(BushingBetweenLinks, **same, point=_each(load.point), axes=axes, **of_axes)
