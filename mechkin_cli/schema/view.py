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
)
from mechkin_cli.schema.scalars import (
    COLOUR_PATTERN,
    DirectionVector,
    Duration,
    Length,
    Name,
    NamedOrGiven,
)

Kind = Literal["rod", "plate", "star", "none"]
KINDS: Final = "rod|plate|star|none"

Colour = Annotated[
    str,
    Limits(pattern=COLOUR_PATTERN),
    Shown(("string",), "a colour as #rrggbb, in quotes", ("#c0392b",)),
    SchemaName("Colour"),
]


class ShapeOfLink(Section):
    """How a link is drawn. A plain word stands for its kind."""

    kind: Kind | None = None
    """`rod` from end to end, `plate` over points of a plane, `star` of rods to the middle, or
    `none`; left out, as its points lie."""
    points: Annotated[tuple[NamedOrGiven, ...], Limits(min_length=2, max_length=100)] | None = None
    """The points it goes through: joints and named points of the link by name, or [x, y, z] in the
    home drawing; left out, all joints and named points of the link."""


def _with_kind(value: Any) -> Any:
    return {"kind": value} if isinstance(value, str) else value


KindOrShape = Annotated[
    ShapeOfLink,
    Rule(_with_kind, before=True),
    Shown(("string",), "the kind alone", pattern=f"^({KINDS})$", is_short=True),
]


Names = Annotated[tuple[Name, ...], Rule(each_once)]


class ViewSection(Section):
    """How `mechkin view` shows the mechanism."""

    colours: dict[Name, Colour] = NOTHING
    """Colours of links by name; left out, the page chooses."""
    hidden: Names = ()
    """Links that are not drawn, nor their halves of joints; left out, none."""
    shapes: dict[Name, KindOrShape] = NOTHING
    """Shapes of links by name; left out, as their joints lie."""
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
    speed: Duration | None = None
    """How long once through a run takes; left out, the page chooses."""
