"""Values that several sections share: expressions with the dimension of a field, names, texts,
places, units, joined tables, names of runs.

A value arrives as the text that was written (or as a number from Python). Expressions stay text and
are not evaluated here; the dimension is attached for readers and for editors only.
"""

import re
from numbers import Integral, Real
from typing import Annotated, Any, Final, Literal, TypeVar

from mechkin_cli.schema.base import (
    DimensionRule,
    FormChoice,
    Limits,
    Rule,
    SchemaName,
    Section,
    Shown,
    each_once,
    refuse,
)
from mechkin_cli.verdict import SWEEP

NAME_PATTERN: Final = r"^[A-Za-z_][A-Za-z0-9_]*$"
COORDINATE_PATTERN: Final = r"^[A-Za-z_][A-Za-z0-9_]*\.([a-z][a-z0-9]*|position\.[xyz])$"
CYCLE_PATTERN: Final = f"{COORDINATE_PATTERN}|^time$"
START_PATTERN: Final = r"^[A-Za-z_][A-Za-z0-9_]*\.[a-z][a-z0-9]*(_dot)?$"
TABLE_NAME_PATTERN: Final = r"^[A-Za-z0-9_-]{1,100}$"
SIGNED_PATTERN: Final = r"^-?[A-Za-z_][A-Za-z0-9_]*(\.[A-Za-z0-9_.]+)?$"
COLOUR_PATTERN: Final = r"^#[0-9A-Fa-f]{6}$"
CSV_PATH_PATTERN: Final = r"^[A-Za-z0-9_-][A-Za-z0-9_. -]*(/[A-Za-z0-9_-][A-Za-z0-9_. -]*)*\.csv$"

FORMS: Final = {
    NAME_PATTERN: ("a name", "use letters, digits and _, and no digit at the start"),
    COORDINATE_PATTERN: ("a joint coordinate", "write joint.coordinate, for example O1.theta"),
    CYCLE_PATTERN: (
        "an input that turns, or time",
        "write joint.coordinate, for example A.theta, or time",
    ),
    START_PATTERN: (
        "a joint coordinate or its rate",
        "write joint.coordinate or joint.coordinate_dot, for example O1.theta_dot",
    ),
    TABLE_NAME_PATTERN: ("a name for a file", "use letters, digits, - and _, at most 100"),
    SIGNED_PATTERN: ("a name, with - where signs turn round", "for example O1.F or -O1.FA"),
    COLOUR_PATTERN: ("a colour", 'write #rrggbb in quotes, for example "#c0392b"'),
    CSV_PATH_PATTERN: (
        "a CSV file beside or below the file that names it",
        "write a relative path with / that ends in .csv",
    ),
}
"""The expected form of a text that fails a pattern, and a hint."""

_NOT_A_NUMBER = re.compile(r"[+-]?\.?(nan|inf|infinity)", re.IGNORECASE)
_WHOLE_NUMBER = re.compile(r"[+-]?[0-9]{1,300}")


def expression_text(value: Any) -> str:
    """The text of an expression, given as text or as a Python number.

    Raises a pydantic error for anything else, for an empty text, and for NaN and infinities.
    """
    text = value if isinstance(value, str) else _number_text(value)
    if text is None:
        is_list = isinstance(value, (list, tuple))
        hint = "for example 0.5 in"
        if is_list:
            hint = (
                "write one number without brackets; where an expression may be a vector, it is "
                'written in quotes: "[x, y, z]"'
            )
        raise refuse("not-a-number", "expected a number or an expression", hint)
    text = text.strip()
    if not text:
        hint = "write a number or an expression"
        raise refuse("empty-value", "an empty text is not a number", hint)
    if _NOT_A_NUMBER.fullmatch(text):
        raise refuse("not-finite", f"{text} is not a finite number", "write a finite value")
    return text


def whole_number(value: Any) -> int:
    """The whole number in a text or a Python integer, of at most 300 digits."""
    if isinstance(value, Integral) and not isinstance(value, bool) and abs(int(value)) < 10**300:
        return int(value)
    if isinstance(value, str) and _WHOLE_NUMBER.fullmatch(value.strip()):
        return int(value)
    raise refuse("not-a-whole-number", "expected a whole number", "write digits only, such as 3")


def true_or_false(value: Any) -> bool:
    """The truth in a text or a Python bool."""
    words = {"true": True, "false": False}
    text = str(value).strip().lower() if isinstance(value, (str, bool)) else ""
    if text not in words:
        raise refuse("not-a-flag", "expected true or false", "write true, or leave the key out")
    return words[text]


def plain_text(value: Any) -> str:
    """A text as written; Python numbers become the text a user would have written."""
    text = value if isinstance(value, str) else _number_text(value)
    if text is None:
        hint = "write words, in quotes where YAML needs them"
        raise refuse("not-a-text", "expected a text", hint)
    return text


def _number_text(value: Any) -> str | None:
    if isinstance(value, bool):
        return None
    if isinstance(value, Integral):
        return str(int(value)) if abs(int(value)) < 10**300 else "inf"
    if isinstance(value, Real):
        return repr(float(value))
    return None


Expression = Annotated[str, Rule(expression_text, before=True)]
WholeNumber = Annotated[int, Rule(whole_number, before=True)]
Flag = Annotated[bool, Rule(true_or_false, before=True)]
Text = Annotated[
    str,
    Rule(plain_text, before=True),
    Shown(("string", "number", "boolean"), "a text for people"),
    SchemaName("Text"),
]

Length = Annotated[Expression, DimensionRule("length", ("0.5 in", "-P1", 2.5), "Length")]
Mass = Annotated[Expression, DimensionRule("mass", ("2 lbm", 0.5), "Mass")]
Inertia = Annotated[Expression, DimensionRule("moment of inertia", (0.02, "3 kg*m^2"), "Inertia")]
Acceleration = Annotated[
    Expression, DimensionRule("acceleration", ("-9.80665 m/s^2", 0), "Acceleration")
]
Force = Annotated[Expression, DimensionRule("force", ("10 N", "-k*O2.s"), "Force")]
Torque = Annotated[Expression, DimensionRule("moment", ("10 N*m", 10), "Torque")]
ForceOrTorque = Annotated[
    Expression, DimensionRule("force or moment", ("10 N*m", "-c*O4.theta_dot"), "ForceOrTorque")
]
Dimensionless = Annotated[
    Expression, DimensionRule("dimensionless number", (1, "cos(alpha1)"), "Dimensionless")
]
Duration = Annotated[Expression, DimensionRule("time", (0, "0.5 s"), "Duration")]
Angle = Annotated[Expression, DimensionRule("angle", ("12 deg", "alpha1", 90), "Angle")]
AngleOrLength = Annotated[
    Expression,
    DimensionRule("angle or length, as the coordinate", (150, "0.5 in"), "AngleOrLength"),
]
CoordinateRate = Annotated[
    Expression, DimensionRule("rate of the coordinate", ("0.1 rad/s", "2 in/s"), "CoordinateRate")
]
CoordinateAcceleration = Annotated[
    Expression,
    DimensionRule("second rate of the coordinate", ("0.2 rad/s^2", 0), "CoordinateAcceleration"),
]
CoordinateJerk = Annotated[
    Expression, DimensionRule("third rate of the coordinate", ("0.3 rad/s^3", 0), "CoordinateJerk")
]
Velocity = Annotated[Expression, DimensionRule("velocity", ("5 mm/s", 0.1), "Velocity")]
Viscosity = Annotated[Expression, DimensionRule("dynamic viscosity", ("0.02 Pa*s",), "Viscosity")]
Stiffness = Annotated[
    Expression,
    DimensionRule(
        "force per length, or moment per angle (bare: per rad)",
        ("200 N/m", "5 N*m/rad"),
        "Stiffness",
    ),
]
Damping = Annotated[
    Expression,
    DimensionRule(
        "force per speed, or moment per angular rate (bare: per rad/s)",
        ("10 N*s/m", 0.2),
        "Damping",
    ),
]
AnyDimension = Annotated[
    Expression, DimensionRule("any dimension", ("12 deg", 0.5, "2*P1"), "AnyDimension")
]

Name = Annotated[
    str,
    Limits(pattern=NAME_PATTERN),
    Shown(("string",), "a name: letters, digits and _, not starting with a digit", ("crank",)),
    SchemaName("Name"),
]
Coordinate = Annotated[
    str,
    Limits(pattern=COORDINATE_PATTERN),
    Shown(("string",), "a joint coordinate: joint.coordinate", ("O1.theta", "O2.s")),
    SchemaName("Coordinate"),
]
CsvPath = Annotated[
    str,
    Limits(pattern=CSV_PATH_PATTERN),
    Shown(("string",), "a CSV file, relative to the file that names it", ("force.csv",)),
    SchemaName("CsvPath"),
]

LengthVector = Annotated[
    tuple[Length, ...], Limits(min_length=3, max_length=3), SchemaName("LengthVector")
]
DirectionVector = Annotated[
    tuple[AnyDimension, ...], Limits(min_length=3, max_length=3), SchemaName("DirectionVector")
]
AccelerationVector = Annotated[
    tuple[Acceleration, ...], Limits(min_length=3, max_length=3), SchemaName("AccelerationVector")
]


_NAME: Final = re.compile(NAME_PATTERN)


def name_or_vector(value: Any) -> str:
    """The form of a place: a name, or else coordinates."""
    is_name = isinstance(value, str) and _NAME.search(value.strip())
    return "(name)" if is_name else "(vector)"


_Vector = TypeVar("_Vector")
NamedOr = Annotated[
    Annotated[Name, "(name)"] | Annotated[_Vector, "(vector)"], FormChoice(name_or_vector)
]
"""The name of a point, or coordinates: of space or of a plane."""

NamedOrGiven = Annotated[NamedOr[LengthVector], SchemaName("NamedOrGiven")]


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


UnitText = Annotated[
    str,
    Rule(plain_text, before=True),
    Shown(("string",), "a unit, or units joined by * / ^", ("in", "deg", "lbm*in/s^2")),
    SchemaName("UnitText"),
]


class UnitsSection(Section):
    """The units of bare numbers and of the tables; by default m, deg, kg, N, s.

    The unit of moments is force times length. Rates of lengths are per `time`; angular rates are in
    rad/s unless `angular_rate` says otherwise. Torsional stiffness is per rad, torsional damping
    per rad/s, whatever `angle` and `angular_rate` are.
    """

    length: UnitText = "m"
    """Unit of lengths, for example m, mm, in."""
    angle: UnitText = "deg"
    """Unit of angles: deg or rad."""
    mass: UnitText = "kg"
    """Unit of masses, for example kg, lbm."""
    force: UnitText = "N"
    """Unit of forces, for example N, lbf, lbm*in/s^2; left out, N whatever the other units are."""
    time: UnitText = "s"
    """Unit of time, for example s, min."""
    angular_rate: UnitText = "rad/s"
    """Unit of angular rates, for example rad/s, rpm."""


METRIC = UnitsSection()
"""The units where a file names none."""


_ENDS = {"spline": ("not-a-knot", "natural", "clamped"), "monotone": ("clamped",), "linear": ()}
"""The ends that each interpolation may have."""


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


DEVICE: Final = re.compile("con|prn|aux|nul|com[0-9]|lpt[0-9]", re.IGNORECASE)
"""Names that are devices on Windows, with any ending."""

# JSON Schema has no flag for ignoring case
TAKEN_FOR_EDITORS: Final = (
    "^([Ss][Ww][Ee][Ee][Pp]|[Cc][Oo][Nn]|[Pp][Rr][Nn]|[Aa][Uu][Xx]|[Nn][Uu][Ll]|[Cc][Oo][Mm][0-9]"
    "|[Ll][Pp][Tt][0-9]|.{101,})$"
)

RunName = Annotated[
    str,
    Limits(pattern=NAME_PATTERN),
    Shown(("string",), "a run: sweep, or the name of a response", ("sweep", "start_up")),
    SchemaName("RunName"),
]


RunNames = Annotated[tuple[RunName, ...], Limits(min_length=1), Rule(each_once)]


def free_run_names(responses: dict[str, Any]) -> dict[str, Any]:
    """The responses, if each can have its name: files are called after them."""
    seen: dict[str, str] = {}
    for name in responses:
        twin = seen.setdefault(name.casefold(), name)
        code = "reserved-name"
        if name.casefold() == SWEEP:
            text = "sweep is the run along the inputs of motion:"
        elif DEVICE.fullmatch(name):
            text = f"{name} is a device on Windows, not a file"
        elif len(name) > MOST_LETTERS:
            text = f"a name of {len(name)} letters is too long for a file (limit {MOST_LETTERS})"
        elif twin != name:
            code = "name-clash"
            text = f"files of {twin} and {name} would be the same where case does not count"
        else:
            continue
        raise refuse(code, text, "rename it", name, "[key]")
    return responses


MOST_LETTERS: Final = 100
"""Letters of a run's name, as of a table's."""
