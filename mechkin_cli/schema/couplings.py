"""`couplings:` - relations between coordinates of joints anywhere in the mechanism: gears, racks,
belts, screws, differentials.

All coordinates are zero in the home drawing, so a coupling is drawn as it meshes.
"""

from typing import Annotated, Any, ClassVar, Literal

from mechkin_cli.schema.base import (
    Limits,
    Rule,
    SchemaName,
    Section,
    Shown,
    by_word,
    each_once,
    refuse,
)
from mechkin_cli.schema.coupling_words import (
    BELT_KEYS,
    CABLE_KEYS,
    CHAIN_KEYS,
    FUNCTION_KEYS,
    GEAR_KEYS,
    LINEAR_KEYS,
    PATH_KEYS,
    RACK_KEYS,
    SCREW_KEYS,
    TABLE_KEYS,
)
from mechkin_cli.schema.motion import LAWS, Law, law_tag
from mechkin_cli.schema.scalars import (
    Angle,
    AngleOrLength,
    AnyDimension,
    Coordinate,
    CsvPath,
    Dimensionless,
    DirectionVector,
    Force,
    JoinedTable,
    Length,
    Name,
)


def _truth(value: Any) -> Any:
    words = {"true": True, "false": False}
    return words.get(str(value).strip().lower(), value)


Truth = Annotated[
    bool,
    Rule(_truth, before=True),
    Shown(("boolean",), "true or false", (True,)),
    SchemaName("Truth"),
]

SeveralJoints = Annotated[
    tuple[Name, ...],
    Limits(min_length=2, max_length=100),
    Rule(each_once),
    SchemaName("SeveralJoints"),
]
TwoJoints = Annotated[
    tuple[Name, ...], Limits(min_length=2, max_length=2), Rule(each_once), SchemaName("TwoJoints")
]


class Flanks(Section):
    """Two flanks that bear by turns, with play between them or without."""

    type: str
    backlash: AngleOrLength | None = None
    """Play between the flanks: a length along the pitch circle, along the rack or the nut, or an
    angle of the first joint; of coordinates that of the first one. Left out, none."""
    restitution: Dimensionless | None = None
    """Part of its rate, 0 to 1, with which the play rebounds in a response where flanks meet; left
    out, 0: they stay together until what is between them pulls."""

    def check(self) -> None:
        """Flanks meet where they have play."""
        if self.restitution is not None and self.backlash is None:
            text = "flanks without play do not part, nor do they meet"
            raise refuse("missing-key", text, "add backlash: 0.1 mm", "restitution")


class LinearCoupling(Flanks):
    """The sum of some coordinates, each with its factor, is constant."""

    advice: ClassVar[dict[str, str]] = LINEAR_KEYS

    type: Literal["linear"]
    terms: dict[Coordinate, AnyDimension]
    """Coordinates and their factors; the factor of the first is a number, those of the others
    carry them to what it measures: `{A.theta: 1, S.s: -1 rad/(20 mm)}`."""
    sum: AngleOrLength = "0"
    """What the sum is; left out, 0 as in the drawing."""

    def check(self) -> None:
        """A relation is between two coordinates or more."""
        if len(self.terms) < 2:
            text = "a coupling is between two coordinates or more"
            raise refuse("too-few-terms", text, "name another coordinate with its factor", "terms")
        super().check()


CoordinateLaw = Annotated[Law, by_word("law", LAWS, law_tag)]


class FollowerSection(Section):
    """The follower of a disc cam, which turns with the leading coordinate, counter-clockwise; its
    coordinate grows as it rises."""

    type: Literal["translating", "oscillating"]
    """Whether it slides or turns about a pivot."""
    contact: Literal["knife", "roller", "flat"]
    """What touches the cam: an edge, a roller, or a flat face, square to a slide."""
    base_radius: Length
    """Radius of the cam's base circle, on which the follower lies where its coordinate is 0."""
    radius: Length | None = None
    """Radius of the roller; left out, none, of another contact."""
    offset: Length = "0"
    """How far right of the cam's axis the line of a translating follower passes, as it rises
    upward; of an oscillating one with a flat face, how far that lies below its pivot."""
    arm: Length | None = None
    """Of an oscillating follower, from its pivot to the roller's centre or the edge; left out,
    none, of another follower."""
    distance: Length | None = None
    """Of an oscillating follower, from the cam's axis to its pivot; left out, none, of a
    translating one."""

    def check(self) -> None:
        """What the contact and the motion need is there, and nothing else."""
        swings, flat = self.type == "oscillating", self.contact == "flat"
        needed = {
            "radius": self.contact == "roller",
            "arm": swings and not flat,
            "distance": swings,
        }
        for key, is_needed in needed.items():
            given = getattr(self, key) is not None
            what = f"a {self.type} follower with a {self.contact} contact"
            if is_needed and not given:
                raise refuse("missing-key", f"{what} needs {key}", f"add {key}: 20 mm")
            if given and not is_needed:
                raise refuse("no-such-key", f"{what} has no {key}", f"remove {key}", key)


class FunctionCoupling(Section):
    """A coordinate is a function of another one: a cam and its follower, a Scotch yoke."""

    advice: ClassVar[dict[str, str]] = FUNCTION_KEYS

    type: Literal["function"]
    of: Coordinate
    """The coordinate that leads, such as the turn of a cam."""
    gives: Coordinate
    """The coordinate that follows."""
    value: AngleOrLength | None = None
    """What the following coordinate is, an expression of the leading one, by its last word or in
    full: `20 mm*(1 - cos(theta))`, `20 mm*(1 - cos(A.theta))`; left out, `law`."""
    law: CoordinateLaw | None = None
    """What it is by a law of motion that runs over the leading coordinate instead of time, so that
    its start, its duration and the extents of its segments are angles or lengths; left out,
    `value`."""
    follower: FollowerSection | None = None
    """The follower of a cam, for `mechkin cam`; left out, none."""

    def check(self) -> None:
        """Exactly one of value and law."""
        if self.value is None and self.law is None:
            text = "a function is told by value or by law"
            raise refuse(
                "missing-key", text, "add one of them, such as value: 20 mm*(1 - cos(theta))"
            )
        if self.value is not None and self.law is not None:
            raise refuse("two-choices", "value and law say the same", "keep one of them", "law")


class TableCoupling(JoinedTable):
    """A coordinate is a tabulated function of another one."""

    advice: ClassVar[dict[str, str]] = TABLE_KEYS

    type: Literal["table"]
    table: CsvPath
    """CSV file with a header and two columns: the coordinate that leads, and the one that follows.
    A table that ends a whole turn later where it begins holds for every turn, joined there as
    between its points."""
    over: Coordinate
    """The coordinate of the first column."""
    gives: Coordinate
    """The coordinate of the second column."""
    follower: FollowerSection | None = None
    """The follower of a cam, for `mechkin cam`; left out, none."""

    def check(self) -> None:
        """The slope does not jump."""
        super().check()
        if self.interpolation == "linear":
            text = "the slope of a linear table jumps at its points, where forces would be infinite"
            raise refuse("linear-law", text, "write interpolation: monotone", "interpolation")


class Toothed(Flanks):
    """Teeth that push on each other along their flanks."""

    pressure_angle: Angle | None = None
    """Pressure angle of the teeth, in the section square to them; left out, 0, so that the force
    is tangential."""
    helix: Angle | None = None
    """Helix angle of the first wheel's teeth, positive for a right-hand helix; left out, 0, a spur
    wheel."""
    ideal: Truth = False
    """Whether moments and forces along the coordinates are transmitted alone, without a force
    between the teeth; left out, no."""
    efficiency: Dimensionless | None = None
    """Share of the power put in that comes out, whichever side drives; left out, all of it."""

    def check(self) -> None:
        """An ideal coupling has no teeth."""
        if self.ideal and self.pressure_angle is not None:
            text = "an ideal coupling has no teeth that push"
            raise refuse("two-choices", text, "leave out one of the two", "pressure_angle")
        super().check()


class GearCoupling(Toothed):
    """Two wheels that mesh, on one carrier: with parallel axes; bevel wheels, whose axes meet; or
    crossed helical wheels, such as a worm and its wheel, whose axes pass each other."""

    advice: ClassVar[dict[str, str]] = GEAR_KEYS

    type: Literal["gear"]
    joints: TwoJoints
    """The R or C joints of the two wheels, which turn on one link, the carrier; where a wheel turns
    on another link, that is joined to the carrier about the same axis."""
    teeth: Annotated[tuple[Dimensionless, ...], Limits(min_length=2, max_length=2)] | None = None
    """Numbers of teeth, of a worm its threads, in the order of the joints; left out, `radii`."""
    radii: Annotated[tuple[Length, ...], Limits(min_length=2, max_length=2)] | None = None
    """Pitch radii, in the order of the joints, of bevel wheels at the middle of their faces; left
    out, `teeth`."""
    module: Length | None = None
    """With `teeth`, their module in the section square to them, which the distance of the axes is
    checked against; left out, it follows from that distance."""
    internal: Truth = False
    """Whether one of the wheels is a ring with teeth inside, so that both turn the same way; left
    out, no."""
    friction: Dimensionless | None = None
    """Coefficient of friction along the flanks of crossed helical wheels, such as a worm and its
    wheel; left out, none."""

    def check(self) -> None:
        """The ratio is told."""
        if self.teeth is None and self.radii is None:
            text = "the ratio of a gear is told by teeth or by radii"
            raise refuse("teeth-or-radii", text, "give at least one of them")
        if self.module is not None and self.teeth is None:
            text = "a module goes with numbers of teeth"
            raise refuse("module-alone", text, "give teeth instead of radii", "module")
        if self.friction is not None and self.efficiency is not None:
            text = "efficiency and friction both tell the losses of the teeth"
            raise refuse("two-choices", text, "leave out one of the two", "efficiency")
        super().check()


class RackCoupling(Toothed):
    """A pinion that rolls on a rack."""

    advice: ClassVar[dict[str, str]] = RACK_KEYS

    type: Literal["rack"]
    joints: TwoJoints
    """The R or C joint of the pinion and the P joint of the rack, both on one link."""
    radius: Length
    """The pinion's pitch radius."""
    at: Name | None = None
    """A named point which is drawn on the rack's pitch line and tells its side of the pinion; left
    out, the point of the rack's joint."""


class Strands(Section):
    """Strands that pull at pulleys with parallel axes on one carrier."""

    joints: SeveralJoints
    """The R or C joints of the pulleys, in the order in which the belt passes them; they turn on
    one link, the carrier. Of two, a pulley may turn on another link that is joined to the carrier
    about the same axis."""
    outside: tuple[Name, ...] = ()
    """Of more than two pulleys the joints of those that the belt touches with its back, such as
    idlers outside its loop, which turn the other way; left out, none."""
    tensioner: Name | None = None
    """Of more than two pulleys, which need it, the joint of the one that holds the pretension in
    the strand that comes to it; left out, one of two, both of whose strands have it at rest."""
    pretension: Force | None = None
    """What pulls in each strand at rest, and in the strand of the tensioner always; left out, the
    slack strand, or that of the tensioner, carries nothing."""
    efficiency: Dimensionless | None = None
    """Share of the power put in that comes out, whichever side drives; left out, all of it."""

    def check_numbers(self, key: str) -> None:
        """As many numbers under a key as joints, and what goes with two or with more."""
        count = len(self.joints)
        if len(getattr(self, key)) != count:
            text = f"{count} joints have {len(getattr(self, key))} {key}"
            raise refuse("lengths", text, f"give {key} for each joint, in their order", key)
        for name in (*self.outside, *(() if self.tensioner is None else (self.tensioner,))):
            if name not in self.joints:
                at = "outside" if name in self.outside else "tensioner"
                text = f"{name} is none of the joints {', '.join(self.joints)}"
                raise refuse("unknown-joint", text, "name one of these", at)
        if count > 2 and self.tensioner is None:
            text = (
                "of more than two pulleys one holds the pretension in the strand that comes to it"
            )
            raise refuse("missing-key", text, f"add tensioner: {self.joints[-1]}")
        if count > 2 and self.efficiency is not None:
            text = "an efficiency is that of two pulleys"
            raise refuse("two-choices", text, "write friction of the bearings", "efficiency")
        for own in ("outside", "tensioner") if count == 2 else ():
            if getattr(self, own):
                text = f"{own} goes with more than two pulleys"
                hint = "write crossed: true" if own == "outside" else "write pretension alone"
                raise refuse("two-choices", text, hint, own)


class BeltCoupling(Strands):
    """A belt over pulleys that does not slip."""

    advice: ClassVar[dict[str, str]] = BELT_KEYS

    type: Literal["belt"]
    radii: Annotated[tuple[Length, ...], Limits(min_length=2, max_length=100)]
    """Radii of the pulleys to the middle of the belt, in the order of the joints."""
    crossed: Truth = False
    """Whether the strands of two pulleys cross, so that these turn opposite ways; left out, no."""

    def check(self) -> None:
        """Numbers of radii and joints agree."""
        self.check_numbers("radii")
        if self.crossed and len(self.joints) > 2:
            text = "the strands of more than two pulleys do not cross"
            raise refuse("two-choices", text, "name the pulleys under outside", "crossed")


class ChainCoupling(Strands, Flanks):
    """A chain over wheels."""

    advice: ClassVar[dict[str, str]] = CHAIN_KEYS

    type: Literal["chain"]
    teeth: Annotated[tuple[Dimensionless, ...], Limits(min_length=2, max_length=100)]
    """Numbers of teeth of the wheels, in the order of the joints."""
    pitch: Length
    """Distance of the chain's pins."""

    def check(self) -> None:
        """Numbers of teeth and joints agree."""
        self.check_numbers("teeth")


class ScrewCoupling(Flanks):
    """A screw and its nut, one of which turns and the other slides, on joints of their own."""

    advice: ClassVar[dict[str, str]] = SCREW_KEYS

    type: Literal["screw"]
    joints: TwoJoints
    """The R or C joint of the part that turns and the P joint of the part that slides, along the
    same direction, both on one link."""
    lead: Length
    """Length per turn, positive for a right-hand thread."""
    efficiency: Dimensionless | None = None
    """Share of the power put in that comes out, whichever side drives; left out, all of it."""


FollowedCoupling = FunctionCoupling | TableCoupling
"""Those of a coordinate that follows another one."""


class PathPart(Section):
    """A place that a cable passes: a point, a pulley or a drum."""

    advice: ClassVar[dict[str, str]] = PATH_KEYS

    point: Name | None = None
    """A named point, through which the cable runs, or where it ends; left out, a pulley or a
    drum."""
    pulley: Name | None = None
    """The R joint of a pulley, or a named point that is its centre; of one that swivels, a point of
    the line about which it does, level with its centre. The cable runs over it without friction;
    left out, a point or a drum."""
    drum: Name | None = None
    """The R joint of a drum, its second link, on which the cable is wound and ends; left out, a
    point or a pulley."""
    radius: Length | None = None
    """Of the pulley or drum, to the middle of the cable, which they need; left out, a point."""
    side: Literal["left", "right"] | None = None
    """On which side of the centre the cable passes, seen along its path, in space with the axis
    pointing to the viewer, which pulleys and drums need; left out, a point, or a pulley that
    swivels."""
    axis: DirectionVector | None = None
    """In space, the axis of a pulley whose centre is a named point; left out, that of its joint."""
    swivel: DirectionVector | None = None
    """In space, along the line about which a pulley swivels to where its cable leads. On its other
    side the cable runs along this line, which touches the pulley at the named point; left out, it
    does not swivel."""
    free: Truth = False
    """In space, whether a pulley hangs on its centre, a named point, as by a ball, so that it turns
    its plane to the points before and after it; left out, no."""

    def check(self) -> None:
        """One place, with what it needs."""
        if sum(key is not None for key in (self.point, self.pulley, self.drum)) != 1:
            text = "a place of a cable is a point, a pulley or a drum"
            raise refuse("two-choices", text, "give one of point, pulley and drum")
        turns = "swivel" if self.swivel is not None else "free" if self.free else None
        if turns is not None and self.pulley is None:
            text = "points and drums do not swivel"
            raise refuse("two-choices", text, f"write pulley, or leave out {turns}", turns)
        if turns == "swivel" and self.free:
            text = "a pulley turns about a line or is free"
            raise refuse("two-choices", text, "leave out swivel or free", "free")
        for key in ("side", "axis"):
            if turns is not None and getattr(self, key) is not None:
                text = f"a pulley that swivels has no {key}: it turns to where its cable leads"
                raise refuse("two-choices", text, f"leave out {key}", key)
        for key, value in (("radius", self.radius), ("side", self.side)):
            if self.point is not None and value is not None:
                text = f"a point has no {key}"
                raise refuse("two-choices", text, "write pulley instead of point", key)
            if self.point is None and value is None and (turns is None or key == "radius"):
                text = f"a pulley needs its {key}"
                raise refuse("missing-key", text, "add radius: 50 mm, side: left")
        if self.point is not None and self.axis is not None:
            text = "a point has no axis"
            raise refuse("two-choices", text, "write pulley instead of point", "axis")


def _as_point(value: Any) -> Any:
    return {"point": value} if isinstance(value, str) else value


PointOrPart = Annotated[
    PathPart,
    Rule(_as_point, before=True),
    Shown(("string",), "the name of a point", is_short=True),
]


class CableCoupling(Section):
    """A cable of constant length over points and pulleys, which bears pull alone."""

    advice: ClassVar[dict[str, str]] = CABLE_KEYS

    type: Literal["cable"]
    path: Annotated[tuple[PointOrPart, ...], Limits(min_length=2, max_length=100)]
    """Places from one end to the other: names of points, pulleys, and drums at its ends. A place
    may be named again, as in a tackle."""


AnyCoupling = (
    LinearCoupling
    | GearCoupling
    | RackCoupling
    | BeltCoupling
    | ChainCoupling
    | ScrewCoupling
    | CableCoupling
    | FollowedCoupling
)
"""All forms of a coupling."""

Coupling = Annotated[
    AnyCoupling,
    by_word(
        "type",
        ("linear", "gear", "rack", "belt", "chain", "screw", "cable", "function", "table"),
    ),
]
