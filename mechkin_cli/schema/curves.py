"""`curve:` and `surface:` - what a sphere or a pin stays on beside a straight groove or a plane.

They are drawn in the home drawing and fixed in the joint's second link.
"""

from typing import Annotated, Any, ClassVar

from mechkin_cli.schema.base import Limits, SchemaName, Section, one_of, refuse
from mechkin_cli.schema.scalars import (
    AnyDimension,
    DirectionVector,
    Flag,
    Length,
    NamedOr,
    NamedOrGiven,
)

_TWO, _THREE = Limits(min_length=2, max_length=2), Limits(min_length=3, max_length=3)
Range = Annotated[tuple[AnyDimension, ...], _TWO, SchemaName("ParameterRange")]


class CurveForms(Section):
    """A curve of space or of a plane."""

    advice: ClassVar[dict[str, str]] = {
        "centre": "the key is spelled center",
        "spline": "the key is points: the places that a smooth curve goes through",
        "x": "write the coordinates under at: as expressions of u",
    }

    line: Any = None
    """A straight line from a place to another, which are its ends; left out, none."""
    arc: Any = None
    """An arc of a circle through three places, from the first to the last; left out, none."""
    center: Any = None
    """Centre of a circle, whose u is zero at the joint's point as drawn; left out, none."""
    radius: Length | None = None
    """Radius of the circle; left out, the joint's point lies on it."""
    at: Any = None
    """Coordinates as expressions of the parameter u, which runs from `from` to `to`; left out,
    none."""
    first: AnyDimension | None = None
    """With at: where u begins, an angle, a length or a number; left out, none."""
    last: AnyDimension | None = None
    """With at: where u ends; left out, none."""
    points: Any = None
    """Places that a smooth curve goes through, u the length of the chords from the first on; left
    out, none."""
    closed: Flag = False
    """With at or points: whether the curve comes back to its begin; left out, no."""

    def check(self) -> None:
        """One form, with its keys."""
        one_of(self, "line", "arc", "center", "at", "points")
        forms = {
            "radius": ("center",),
            "axis": ("center",),
            "first": ("at",),
            "last": ("at",),
            "closed": ("at", "points"),
        }
        for key, needs in forms.items():
            given = getattr(self, key, None)
            if given in (None, False) or any(getattr(self, form) is not None for form in needs):
                continue
            name = self.keys.get(key, key)
            text = f"{name} goes with {' or '.join(needs)}"
            raise refuse("other-form", text, "leave it out", name)
        if self.at is not None:
            for key in ("first", "last"):
                if getattr(self, key) is None:
                    text = "a curve by expressions says where its parameter begins and ends"
                    raise refuse("missing-key", text, "add from: and to:", "at")


_Vectors = Annotated[tuple[NamedOrGiven, ...], _TWO]
_Knots = Limits(min_length=3)


class Curve(CurveForms):
    """A curve in space: one of line, arc, center (a circle), at (expressions of u) and points."""

    line: _Vectors | None = None
    """A straight line from a place to another, which are its ends; left out, none."""
    arc: Annotated[tuple[NamedOrGiven, ...], _THREE] | None = None
    """An arc of a circle through three places, from the first to the last; left out, none."""
    center: NamedOrGiven | None = None
    """Centre of a circle, whose u is zero at the joint's point as drawn; left out, none."""
    axis: DirectionVector | None = None
    """Axis of the circle, about which u grows; left out, z."""
    at: Annotated[tuple[Length, ...], _THREE] | None = None
    """Coordinates as expressions of the parameter u, which runs from `from` to `to`; left out,
    none."""
    points: Annotated[tuple[NamedOrGiven, ...], _Knots] | None = None
    """Places that a smooth curve goes through, u the length of the chords from the first on; left
    out, none."""


PlaneVector = Annotated[tuple[Length, ...], _TWO, SchemaName("CurvePlace")]
_InPlane = NamedOr[PlaneVector]


class PlaneCurve(CurveForms):
    """A curve in a plane: one of line, arc, center (a circle), at (expressions of u) and points."""

    advice: ClassVar[dict[str, str]] = CurveForms.advice | {
        "axis": "leave it out: in a plane file u grows counter-clockwise",
    }

    line: Annotated[tuple[_InPlane, ...], _TWO] | None = None
    """A straight line from a place to another, which are its ends; left out, none."""
    arc: Annotated[tuple[_InPlane, ...], _THREE] | None = None
    """An arc of a circle through three places, from the first to the last; left out, none."""
    center: _InPlane | None = None
    """Centre of a circle, whose u is zero at the joint's point as drawn; left out, none."""
    at: PlaneVector | None = None
    """Coordinates as expressions of the parameter u, which runs from `from` to `to`; left out,
    none."""
    points: Annotated[tuple[_InPlane, ...], _Knots] | None = None
    """Places that a smooth curve goes through, u the length of the chords from the first on; left
    out, none."""


class Surface(Section):
    """A surface: one of sphere, cylinder, torus and at (expressions of u and v)."""

    advice: ClassVar[dict[str, str]] = {
        "plane": "write normal: instead of surface:",
        "center": "write it as sphere: or torus:, a place on the axis as cylinder:",
    }

    sphere: NamedOrGiven | None = None
    """Centre of a sphere, u the longitude about `axis` and v the latitude; left out, none."""
    cylinder: NamedOrGiven | None = None
    """A place on the axis of a cylinder, u the angle about it and v the length along it; left out,
    none."""
    torus: NamedOrGiven | None = None
    """Centre of a torus, u the angle about its axis and v that in its tube; left out, none."""
    axis: DirectionVector | None = None
    """Axis of the surface; left out, z, or of a sphere square to the joint's point."""
    radius: Length | None = None
    """Radius, of a torus that of the circle in its tube; left out, that of a sphere or a cylinder
    on which the joint's point lies."""
    tube: Length | None = None
    """Radius of the tube of a torus; left out, none."""
    at: Annotated[tuple[Length, ...], _THREE] | None = None
    """Coordinates as expressions of the parameters u and v; left out, none."""
    u: Range | None = None
    """With at: where u begins and ends; left out, none."""
    v: Range | None = None
    """With at: where v begins and ends; left out, none."""

    def check(self) -> None:
        """One form, with its keys."""
        one_of(self, "sphere", "cylinder", "torus", "at")
        needed = {"at": ("u", "v"), "torus": ("radius", "tube")}
        for form, keys in needed.items():
            for key in keys:
                if getattr(self, form) is not None and getattr(self, key) is None:
                    text = f"a surface by {form} needs {key}"
                    raise refuse("missing-key", text, "add it", form)
        others = {"u": "at", "v": "at", "tube": "torus"}
        for key, form in others.items():
            if getattr(self, key) is not None and getattr(self, form) is None:
                raise refuse("other-form", f"{key} goes with {form}", "leave it out", key)
        for key in ("axis", "radius"):
            if getattr(self, key) is not None and self.at is not None:
                raise refuse("other-form", f"{key} does not go with at", "leave it out", key)


EXAMPLES: dict[tuple[str, str], Any] = {
    ("Curve", "line"): [[0, 0, 0], [80, 0, 20]],
    ("Curve", "arc"): [[0, 0, 0], [40, 20, 0], [80, 0, 0]],
    ("Curve", "center"): [90, 0, 0],
    ("Curve", "at"): ["30 mm*cos(u)", "30 mm*sin(u)", "5 mm*u/(1 rad)"],
    ("Curve", "from"): "-360 deg",
    ("Curve", "to"): "360 deg",
    ("Curve", "points"): [[0, 0, 0], [40, 20, 5], [80, 0, 10]],
    ("Curve", "closed"): True,
    ("PlaneCurve", "closed"): True,
    ("PlaneCurve", "line"): [[0, 0], [80, 20]],
    ("PlaneCurve", "arc"): [[0, 0], [40, 20], [80, 0]],
    ("PlaneCurve", "center"): [90, 0],
    ("PlaneCurve", "at"): ["40 mm*cos(u)", "25 mm*sin(u)"],
    ("PlaneCurve", "from"): "0 deg",
    ("PlaneCurve", "to"): "360 deg",
    ("PlaneCurve", "points"): [[0, 0], [40, 20], [80, 0]],
    ("SphereGrooveJoint", "curve"): {"center": [90, 0, 0], "axis": [0, 0, 1]},
    ("SpherePlaneJoint", "surface"): {"sphere": [0, 0, 0], "radius": "50 mm"},
    ("PinInSlotJoint", "curve"): {"center": [90, 0]},
    ("Surface", "sphere"): [0, 0, 0],
    ("Surface", "cylinder"): [0, 0, 0],
    ("Surface", "torus"): [0, 0, 0],
    ("Surface", "tube"): "8 mm",
    ("Surface", "at"): ["v*cos(u)", "v*sin(u)", "5 mm*cos(2*u)"],
    ("Surface", "u"): ["0 deg", "360 deg"],
    ("Surface", "v"): ["10 mm", "80 mm"],
}
"""Of values in editors and in the format's pages, by section and key."""
