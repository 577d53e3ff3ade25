"""`links:` - the rigid bodies; `joints:` - the pairs, by type; `chain:` - a loop in rows.

All places and directions stand in the home drawing, in ground axes. A joint whose two halves do not
meet in the drawing gives a place or direction per link: `point: {crank: [...], rocker: [...]}`. A
place is [x, y, z], or the name of a point.
"""

from typing import Annotated, Any, ClassVar, Final, Literal, TypeVar

from mechkin_cli.schema.base import (
    FormChoice,
    Limits,
    SchemaName,
    Section,
    by_word,
    one_of,
    refuse,
)
from mechkin_cli.schema.curves import Curve, Surface
from mechkin_cli.schema.scalars import (
    Angle,
    DirectionVector,
    Inertia,
    Length,
    LengthVector,
    Mass,
    Name,
    NamedOrGiven,
    name_or_vector,
)


class InertiaAxes(Section):
    """The axes of an inertia tensor or a bushing, drawn in ground axes of the home drawing.

    They are normalised, must be square to one another to 1e-9, and z = x cross y.
    """

    advice: ClassVar[dict[str, str]] = {"z": "leave it out: z = x cross y"}

    x: DirectionVector
    """First axis, [x, y, z]."""
    y: DirectionVector
    """Second axis, [x, y, z]."""


class LinkInertia(Section):
    """The inertia tensor about the mass centre; an entry that is left out is zero.

    `xy` is the entry as it stands in the tensor (minus the integral of x*y).
    """

    xx: Inertia = "0"
    """Moment of inertia about x through the mass centre."""
    yy: Inertia = "0"
    """Moment of inertia about y through the mass centre."""
    zz: Inertia = "0"
    """Moment of inertia about z through the mass centre."""
    xy: Inertia = "0"
    """Entry xy of the tensor: minus the integral of x*y."""
    xz: Inertia = "0"
    """Entry xz of the tensor: minus the integral of x*z."""
    yz: Inertia = "0"
    """Entry yz of the tensor: minus the integral of y*z."""
    axes: InertiaAxes | None = None
    """Axes of the tensor; left out, those of the ground in the home drawing."""


class BodyWithMass(Section):
    """A link in space or in a plane."""

    editors: ClassVar[dict[str, Any]] = {
        "dependentRequired": {"mass": ["center_of_mass"], "center_of_mass": ["mass"]}
    }
    advice: ClassVar[dict[str, str]] = {
        "centre_of_mass": "the key is spelled center_of_mass",
        "com": "the key is spelled center_of_mass",
    }

    mass: Mass | None = None
    """Mass of the link; left out, it has none."""

    def check(self) -> None:
        """Mass and centre come together."""
        centre = getattr(self, "center_of_mass", None)
        if self.mass is not None and centre is None:
            raise refuse("mass-without-centre", "a mass needs a center_of_mass", "add it", "mass")
        if self.mass is None and centre is not None:
            text, hint = "a center_of_mass needs a mass", "add the mass (0 for none)"
            raise refuse("centre-without-mass", text, hint, "center_of_mass")


class Link(BodyWithMass):
    """A rigid body. All its keys may be left out: `{}` is a link without mass."""

    center_of_mass: NamedOrGiven | None = None
    """Mass centre in the home drawing, [x, y, z] in ground axes or the name of a point of the link;
    left out, the link has no mass."""
    inertia: LinkInertia | None = None
    """Inertia tensor about the mass centre; left out, zero."""


JOINT_LETTERS: Final = ("R", "P", "C", "H", "S", "Sp", "Sg", "U", "E", "Ss", "Sc", "Cp", "F", "W")
_PER_LINK_FIELDS = ("point", "axis", "normal", "groove", "slot", "pin", "x", "zero")


def _vector_or_per_link(value: Any) -> str:
    return "(per link)" if isinstance(value, dict) else "(vector)"


def _place_or_per_link(value: Any) -> str:
    return "(per link)" if isinstance(value, dict) else name_or_vector(value)


_Vector = TypeVar("_Vector")
PerLink = Annotated[dict[Name, _Vector], Limits(min_length=2, max_length=2)]
"""One vector for each of the joint's two links."""

_Place = TypeVar("_Place")
PlaceOrPerLink = Annotated[
    Annotated[Name, "(name)"]
    | Annotated[_Vector, "(vector)"]
    | Annotated[PerLink[_Place], "(per link)"],
    FormChoice(_place_or_per_link),
]
"""A place as a vector or by its name, or one place for each link."""
DirectionOrPerLink = Annotated[
    Annotated[_Vector, "(vector)"] | Annotated[PerLink[_Vector], "(per link)"],
    FormChoice(_vector_or_per_link),
]
"""A direction, or one for each link."""

Point = Annotated[PlaceOrPerLink[LengthVector, NamedOrGiven], SchemaName("Point")]
Direction = Annotated[DirectionOrPerLink[DirectionVector], SchemaName("Direction")]
ZeroReference = Annotated[PerLink[DirectionVector], SchemaName("ZeroReference")]


class JointBase(Section):
    """A joint. Its coordinates are the motion of the second link against the first."""

    links: Annotated[tuple[Name, ...], Limits(min_length=2, max_length=2)]
    """The two links, [first, second]; `ground` is a link."""

    def check(self) -> None:
        """Two different links, and vectors per link name these."""
        first, second = self.links
        if first == second:
            raise refuse("same-link", f"{first} is joined to itself", "name two links", "links", 1)
        for key in _PER_LINK_FIELDS:
            per_link = getattr(self, key, None)
            for name in per_link if isinstance(per_link, dict) else ():
                if name not in self.links:
                    text = f"{name} is not a link of this joint"
                    hint = f"write {key}: {{{first}: [...], {second}: [...]}}"
                    raise refuse("not-its-link", text, hint, key, name, "[key]")


class PointJoint(JointBase):
    """A joint with a point: all but the weld."""

    point: Point
    """A point of the joint in the home drawing, [x, y, z] or by its name, or one per link."""


class AxisJoint(PointJoint):
    """Joints with one axis."""

    axis: Direction
    """Direction of the axis in the home drawing, or one direction for each of the two links."""
    zero: ZeroReference | None = None
    """For an axis per link: a direction for each link; seen along the axis, the two lie in line at
    coordinate 0. Left out, the shortest turn that carries one axis onto the other defines it."""


class RevoluteJoint(AxisJoint):
    """R: the second link turns by theta about `axis`."""

    type: Literal["R"]


class PrismaticJoint(AxisJoint):
    """P: the second link slides by s along `axis`."""

    type: Literal["P"]


class CylindricJoint(AxisJoint):
    """C: the second link turns by theta about `axis` and slides by s along it."""

    type: Literal["C"]


class HelicalJoint(AxisJoint):
    """H: the second link turns by theta about `axis` and slides along it by s = lead*theta/turn."""

    advice: ClassVar[dict[str, str]] = {"pitch": "use lead: length per turn, right-handed positive"}

    type: Literal["H"]
    lead: Length
    """Length per turn, positive for a right-handed thread."""


class SphericalJoint(PointJoint):
    """S: ball and socket; `point` is the centre of the sphere."""

    type: Literal["S"]


class SpherePlaneJoint(PointJoint):
    """Sp: a sphere of the first link on a plane or another surface of the second."""

    type: Literal["Sp"]
    normal: Direction | None = None
    """Normal of the plane; left out, `surface`."""
    surface: Surface | None = None
    """The surface that the sphere's centre stays on, in the home drawing; left out, a plane."""

    def check(self) -> None:
        """A plane or a surface."""
        super().check()
        one_of(self, "normal", "surface")


class SphereGrooveJoint(PointJoint):
    """Sg: a sphere of the first link in a groove of the second.

    Of a straight groove s > 0 along `groove`; along a curve u is the curve's parameter.
    """

    type: Literal["Sg"]
    groove: Direction | None = None
    """Direction of the groove; left out, `curve`."""
    curve: Curve | None = None
    """The curve that the sphere's centre stays on, in the home drawing; left out, a straight
    line."""

    def check(self) -> None:
        """A straight groove or a curve."""
        super().check()
        one_of(self, "groove", "curve")


class UniversalJoint(PointJoint):
    """U: turns by theta1 about `axis` of the first link and theta2 about `axis2` of the second.

    The angle drawn between the two axes stays as it is.
    """

    type: Literal["U"]
    axis: DirectionVector
    """Axis fixed in the first link."""
    axis2: DirectionVector
    """Axis fixed in the second link."""


class PlanarJoint(PointJoint):
    """E: the second link slides by x and y in a plane and turns by theta about its normal."""

    type: Literal["E"]
    normal: Direction
    """Normal of the plane; the axis of theta."""
    x: Direction
    """Direction of the coordinate x in the plane; y = normal cross x."""


class SlottedSphereJoint(PointJoint):
    """Ss: a ball of the second link in a socket of the first, its pin in a slot of the socket.

    Turns by theta1 about `slot` and by theta2 about `pin`: a universal joint with square axes.
    """

    type: Literal["Ss"]
    slot: Direction
    """Normal of the slot's plane, fixed in the first link."""
    pin: Direction
    """Direction of the pin, fixed in the second link and drawn in the slot's plane."""


class SphereCylinderJoint(PointJoint):
    """Sc: a ball of the second link in a cylinder of the first, its pin in a slot along it.

    Slides by s along `axis`, then turns by theta1 about the slot's normal, `pin` cross `axis` as
    drawn, and by theta2 about `pin`. The slot's plane holds axis and pin.
    """

    type: Literal["Sc"]
    axis: Direction
    """Axis of the cylinder, fixed in the first link."""
    pin: Direction
    """Direction of the pin, fixed in the second link."""


class CylinderPlaneJoint(PointJoint):
    """Cp: a cylinder of the first link on a plane of the second, in line contact.

    Turns by theta1 about `axis` and by theta2 about `normal`, slides by x and y in the plane: x
    along `axis` cross `normal`, y along `axis`, as drawn in the plane. `point` is a point of the
    cylinder's axis; the radius does not matter.
    """

    type: Literal["Cp"]
    axis: Direction
    """Axis of the cylinder, fixed in the first link and drawn square to `normal`."""
    normal: Direction
    """Normal of the plane, fixed in the second link."""


class FreePose(PointJoint):
    """F: no joint, but the pose of the second link against the first; it holds nothing.

    Slides by x, y and z along the axes of the drawing, then turns by rz about z, by ry about the y
    and by rx about the x that turn with it. Its coordinates may be inputs, or be read.
    """

    type: Literal["F"]


class WeldJoint(JointBase):
    """W: the two links are one body."""

    type: Literal["W"]


AnyAxisJoint = RevoluteJoint | PrismaticJoint | CylindricJoint | HelicalJoint
TwoTurnJoint = UniversalJoint | SlottedSphereJoint | SphereCylinderJoint | CylinderPlaneJoint
AnyJoint = (
    AnyAxisJoint
    | SphericalJoint
    | SpherePlaneJoint
    | SphereGrooveJoint
    | UniversalJoint
    | PlanarJoint
    | SlottedSphereJoint
    | SphereCylinderJoint
    | CylinderPlaneJoint
    | FreePose
    | WeldJoint
)
Joint = Annotated[AnyJoint, by_word("type", JOINT_LETTERS)]


# A chain is a loop written as rows of four numbers (Denavit and Hartenberg 1955). Row by row the
# screw (theta, s) about z carries the next link's frame on, then (alpha, a) about the new x; the
# product over the rows is the identity. Row i holds joint i and the link behind it.


class ChainRow(Section):
    """One joint and the link behind it; the first row's joint moves against `ground`."""

    editors: ClassVar[dict[str, Any]] = {
        "if": {"properties": {"type": {"const": "H"}}},
        "then": {"required": ["lead"]},
        "else": {"properties": {"lead": False}},
    }

    joint: Name
    """Name of the joint."""
    type: Literal["R", "P", "C", "H"]
    """Type of the joint."""
    link: Name
    """The link behind the joint; in the last row `ground`, which closes the loop."""
    theta: Angle = "0"
    """Angle about z from the previous x to the next x, in the home drawing."""
    s: Length = "0"
    """Distance along z from the previous x to the next x, in the home drawing."""
    alpha: Angle = "0"
    """Angle about x from this z to the next z."""
    a: Length = "0"
    """Distance along x from this z to the next z."""
    lead: Length | None = None
    """For type H, which needs it: length per turn, positive for a right-handed thread."""

    def check(self) -> None:
        """A lead belongs to type H alone."""
        if self.type == "H" and self.lead is None:
            hint = "add lead: length per turn"
            raise refuse("missing-key", "a joint of type H needs its lead", hint)
        if self.type != "H" and self.lead is not None:
            raise refuse("unknown-key", "only a joint of type H has a lead", "remove it", "lead")
