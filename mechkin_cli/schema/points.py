"""`points:` and `directions:` - named places and directions that move with a link."""

from mechkin_cli.schema.base import Section
from mechkin_cli.schema.places import NamedOrGiven
from mechkin_cli.schema.scalars import DirectionVector, Name


class PointOfLink(Section):
    """A point fixed in a link; columns read its position, velocity, acceleration and jerk."""

    link: Name
    """The link that carries the point; `ground` for a fixed one."""
    at: NamedOrGiven
    """The point in the home drawing, [x, y, z] in ground axes or the name of a point that is drawn
    at the same place."""


class DirectionOfLink(Section):
    """A unit vector fixed in a link; columns use it by its name."""

    link: Name
    """The link that carries the direction; `ground` for a fixed one."""
    vector: DirectionVector
    """The direction in the home drawing, [x, y, z] in ground axes; its length does not matter."""
