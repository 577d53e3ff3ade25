"""`assembly:` - which way of assembling the mechanism is meant at the first row."""

from typing import Annotated, Any, ClassVar, Literal

from mechkin_cli.schema.base import NOTHING, Section, refuse
from mechkin_cli.schema.rules import Limits
from mechkin_cli.schema.scalars import AngleOrLength, Coordinate, Text, WholeNumber


class AssemblySection(Section):
    """The mode followed; left out, an assembled home drawing, else the mode nearest to it."""

    editors: ClassVar[dict[str, Any]] = {"not": {"required": ["near", "mode"]}}

    near: dict[Coordinate, AngleOrLength] = NOTHING
    """Take the mode nearest to these coordinates; left out, an assembled drawing, else the nearest
    to the drawing."""
    mode: Text | None = None
    """Take the mode of this letter, as `mechkin modes` names it; left out, as `near` says."""
    turns: Annotated[WholeNumber, Limits(ge=0, le=1000)] = 1
    """Turns of helical joints to either side within which modes are looked for."""
    at_branch_points: Literal["straight"] | None = None
    """`straight`: where the branch crosses another, as a parallelogram's does when it lies flat, it
    goes on along its smooth continuation. Left out, the branch ends there."""

    def check(self) -> None:
        """One of near and mode at most."""
        if self.near and self.mode is not None:
            text = "near and mode both choose the assembly mode"
            raise refuse("two-choices", text, "keep one of them", "mode")
