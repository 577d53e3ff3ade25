"""How the points of a table are joined."""

from typing import Literal

from mechkin_cli.schema.base import Section, refuse

_ENDS = {"spline": ("not-a-knot", "natural", "clamped"), "monotone": ("clamped",), "linear": ()}
"""The ends that each interpolation has."""


class JoinedTable(Section):
    """A table of two columns, joined by a curve."""

    interpolation: Literal["spline", "monotone", "linear"] = "spline"
    """How its points are joined: by a smooth spline; by a curve that rises and falls only where the
    points do; by straight lines."""
    ends: Literal["not-a-knot", "natural", "clamped"] | None = None
    """Of a spline: as smooth as between the points (not-a-knot), without curvature (natural) or at
    rest (clamped, which a monotone curve can be, too); left out, not-a-knot."""

    def check(self) -> None:
        """The ends are some that the interpolation has."""
        if self.ends is not None and self.ends not in _ENDS[self.interpolation]:
            text = f"a {self.interpolation} curve has no {self.ends} ends"
            hint = "leave ends out, or write interpolation: spline"
            raise refuse("table-ends", text, hint, "ends")
