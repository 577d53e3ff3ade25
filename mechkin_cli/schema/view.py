"""`view:` - how `mechkin view` draws the mechanism; nothing in it changes a number of a table."""

from typing import Annotated, Any, Final, Literal

from mechkin_cli.schema.base import (
    NOTHING,
    Limits,
    Rule,
    SchemaName,
    Section,
    Shown,
    each_once,
    refuse,
)
from mechkin_cli.schema.scalars import (
    COLOUR_PATTERN,
    AnyDimension,
    DirectionVector,
    Duration,
    Length,
    Name,
    NamedOrGiven,
)

Kind = Literal["rod", "plate", "star", "cylinder", "wheel", "none"]
KINDS: Final = "rod|plate|star|cylinder|wheel|none"

Colour = Annotated[
    str,
    Limits(pattern=COLOUR_PATTERN),
    Shown(("string",), "a colour as #rrggbb, in quotes", ("#c0392b",)),
    SchemaName("Colour"),
]


class ShapeOfLink(Section):
    """How a link is drawn. A plain word stands for its kind."""

    kind: Kind | None = None
    """`rod` from end to end, `plate` over points of a plane, `star` of rods to the middle,
    `cylinder` (a tube, closed at the first and open at the last of its points), `wheel` about the
    first of its points, or `none`; left out, as its points lie."""
    points: Annotated[tuple[NamedOrGiven, ...], Limits(min_length=1, max_length=100)] | None = None
    """The points it goes through: joints and named points of the link by name, or [x, y, z] in the
    home drawing; left out, all joints and named points of the link."""
    radius: Length | None = None
    """Of a rod, a cylinder or a wheel; left out, by the size of the mechanism. A wheel needs it."""
    width: Length | None = None
    """Of a wheel, along its axis; left out, a quarter of its radius."""
    axis: DirectionVector | None = None
    """Of a wheel, in the home drawing; left out, that of the joint at its centre, and in a plane
    its normal."""

    def check(self) -> None:
        """A shape has the sizes of its kind."""
        if self.kind == "wheel":
            if self.radius is None:
                text = "a wheel is drawn with its own radius"
                raise refuse("missing-key", text, "add `radius:`, a length")
            return
        if self.points is not None and len(self.points) < 2:
            text = f"a {self.kind or 'shape'} goes through 2 points or more"
            raise refuse("wrong-length", text, "add a point, or write kind: wheel", "points")
        of_wheels = [key for key in ("width", "axis") if getattr(self, key) is not None]
        if of_wheels:
            text = f"{of_wheels[0]} belongs to kind: wheel"
            raise refuse("needless-key", text, f"leave {of_wheels[0]} out", of_wheels[0])
        if self.radius is not None and self.kind not in ("rod", "cylinder"):
            text = "radius belongs to kind: rod, cylinder or wheel"
            raise refuse("needless-key", text, "leave radius out, or write the kind", "radius")


class PartBetween(Section):
    """A part drawn between two points of different links, as long as they are apart."""

    kind: Literal["spring", "damper", "cylinder"]
    """A coil `spring`, a `damper`, or a `cylinder` with its piston rod."""
    points: Annotated[tuple[Name, ...], Limits(min_length=2, max_length=2)]
    """Two named points; a cylinder's tube begins at the first."""
    radius: Length | None = None
    """Of the coil or tube; left out, by the size of the mechanism."""


def _with_kind(value: Any) -> Any:
    return {"kind": value} if isinstance(value, str) else value


KindOrShape = Annotated[
    ShapeOfLink,
    Rule(_with_kind, before=True),
    Shown(("string",), "the kind alone", pattern=f"^({KINDS})$", is_short=True),
]


Names = Annotated[tuple[Name, ...], Rule(each_once)]
Ends = Annotated[tuple[AnyDimension, ...], Limits(min_length=2, max_length=2)]


class ViewSection(Section):
    """How `mechkin view` shows the mechanism."""

    colours: dict[Name, Colour] = NOTHING
    """Colours of links by name; left out, the page chooses."""
    hidden: Names = ()
    """Links that are not drawn, nor their halves of joints; left out, none."""
    shapes: dict[Name, KindOrShape] = NOTHING
    """Shapes of links by name; left out, as their joints lie."""
    between: tuple[PartBetween, ...] = ()
    """Springs, dampers and cylinders that are drawn between named points and exert nothing; those
    of `loads:` are drawn anyway; left out, none."""
    joint_radius: Length | None = None
    """Radius of the pins and balls of joints; left out, the radius at which a joint rubs, else by
    the size of the mechanism."""
    paths: Names | None = None
    """Named points whose paths are drawn; left out, all, and [] none."""
    forces: Literal["shown", "hidden"] = "shown"
    """Whether arrows of forces and moments are seen at first."""
    arrow_length: Length | None = None
    """Length of the longest arrow of a force, and of a moment; left out, by the size of the
    mechanism."""
    camera: DirectionVector | None = None
    """Direction from the mechanism to the eye, in ground axes; left out, the page chooses."""
    parameters: dict[Name, Ends] = NOTHING
    """Where the page's sliders of parameters begin and end, by name, as [30 mm, 60 mm]; left out,
    from half to twice the parameter's value."""
    speed: Duration | None = None
    """How long once through a run takes; left out, the page chooses."""
