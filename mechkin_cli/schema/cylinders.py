"""`cylinders:` - hydraulic and pneumatic cylinders, spindles and telescopes between two points."""

from typing import Annotated, ClassVar

from mechkin_cli.schema.base import Limits, SchemaName, Section, refuse
from mechkin_cli.schema.scalars import Length, Name

Stroke = Annotated[tuple[Length, ...], Limits(min_length=2, max_length=2), SchemaName("Stroke")]


class Cylinder(Section):
    """Two links without mass between two points, which slide on each other along the line through
    them."""

    advice: ClassVar[dict[str, str]] = {
        "force": "a force stands in loads: [{type: force, joint: C, value: 5 kN}], in the efforts "
        "of a response, or follows where C.s is an input",
        "length": "its length is the coordinate C.s, which may be an input",
        "points": "write from: and to:, two named points",
    }

    first: Name
    """The named point of the tube's eye."""
    last: Name
    """The named point of the rod's eye."""
    stroke: Stroke | None = None
    """Least and largest length from eye to eye, limits of its coordinate; left out, none."""
    bore: Length | None = None
    """Diameter of the piston, with which there is a pressure; left out, none."""
    rod: Length | None = None
    """Diameter of the rod, where the other side of the piston pulls; left out, none."""

    def check(self) -> None:
        """It leads from one point to another."""
        if self.first == self.last:
            text = "a cylinder leads from one point to another"
            raise refuse("same-point", text, "name two points", "to")
        if self.rod is not None and self.bore is None:
            text = "a rod's diameter goes with that of the piston"
            raise refuse("rod-alone", text, "add bore:", "rod")
