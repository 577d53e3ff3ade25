"""`chain:` - a loop written as rows of four numbers (Denavit and Hartenberg 1955).

Row by row the screw (theta, s) about z carries the next link's frame on, then (alpha, a) about the
new x; the product over the rows is the identity. Row i holds joint i and the link behind it.
"""

from typing import Any, ClassVar, Literal

from mechkin_cli.schema.base import Section, refuse
from mechkin_cli.schema.scalars import Angle, Length, Name


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
            raise refuse(
                "missing-key", "a joint of type H needs its lead", "add lead: length per turn"
            )
        if self.type != "H" and self.lead is not None:
            raise refuse("unknown-key", "only a joint of type H has a lead", "remove it", "lead")
