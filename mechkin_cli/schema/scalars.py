"""Single values: expressions with the dimension a field has, names, texts, whole numbers.

A value arrives as the text that was written (or as a number from Python). Expressions stay text and
are not evaluated here; the dimension is attached for readers and for editors only.
"""

import re
from numbers import Integral, Real
from typing import Annotated, Any, Final

from mechkin_cli.schema.base import refuse
from mechkin_cli.schema.rules import Before, Dimension, Limits, Named, Shown

NAME_PATTERN: Final = r"^[A-Za-z_][A-Za-z0-9_]*$"
COORDINATE_PATTERN: Final = r"^[A-Za-z_][A-Za-z0-9_]*\.([a-z][a-z0-9]*|position\.[xyz])$"
CYCLE_PATTERN: Final = f"{COORDINATE_PATTERN}|^time$"
START_PATTERN: Final = r"^[A-Za-z_][A-Za-z0-9_]*\.[a-z][a-z0-9]*(_dot)?$"
TABLE_NAME_PATTERN: Final = r"^[A-Za-z0-9_-]{1,100}$"
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
    COLOUR_PATTERN: ("a colour", 'write #rrggbb in quotes, for example "#c0392b"'),
    CSV_PATH_PATTERN: (
        "a CSV file beside or below the file that names it",
        "write a relative path with / that ends in .csv",
    ),
}
"""What a text that fails a pattern should have been, and what to do."""

_NOT_A_NUMBER = re.compile(r"[+-]?\.?(nan|inf|infinity)", re.IGNORECASE)
_WHOLE_NUMBER = re.compile(r"[+-]?[0-9]{1,300}")


def expression_text(value: Any) -> str:
    """The text of an expression, given as text or as a Python number.

    Raises a pydantic error for anything else, for an empty text, and for NaN and infinities.
    """
    text = _number_text(value)
    if text is None:
        text = value if isinstance(value, str) else None
    if text is None:
        is_list = isinstance(value, (list, tuple))
        hint = 'a vector is written in quotes: "[x, y, z]"' if is_list else "for example 0.5 in"
        raise refuse("not-a-number", "expected a number or an expression", hint)
    text = text.strip()
    if not text:
        raise refuse("empty-value", "an empty text is no number", "write a number or an expression")
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


def plain_text(value: Any) -> str:
    """A text as written; Python numbers become the text a user would have written."""
    text = value if isinstance(value, str) else _number_text(value)
    if text is None:
        raise refuse(
            "not-a-text", "expected a text", "write words, in quotes where YAML needs them"
        )
    return text


def _number_text(value: Any) -> str | None:
    if isinstance(value, bool):
        return None
    if isinstance(value, Integral):
        return str(int(value)) if abs(int(value)) < 10**300 else "inf"
    if isinstance(value, Real):
        return repr(float(value))
    return None


Expression = Annotated[str, Before(expression_text)]
WholeNumber = Annotated[int, Before(whole_number)]
Text = Annotated[
    str,
    Before(plain_text),
    Shown(("string", "number", "boolean"), "a text for people"),
    Named("Text"),
]

Length = Annotated[Expression, Dimension("length", ("0.5 in", "-P1", 2.5)), Named("Length")]
Mass = Annotated[Expression, Dimension("mass", ("2 lbm", 0.5)), Named("Mass")]
Inertia = Annotated[
    Expression, Dimension("moment of inertia", (0.02, "3 kg*m^2")), Named("Inertia")
]
Acceleration = Annotated[
    Expression, Dimension("acceleration", ("-9.80665 m/s^2", 0)), Named("Acceleration")
]
Force = Annotated[Expression, Dimension("force", ("10 N", "-k*O2.s")), Named("Force")]
Torque = Annotated[Expression, Dimension("moment", ("10 N*m", 10)), Named("Torque")]
ForceOrTorque = Annotated[
    Expression, Dimension("force or moment", ("10 N*m", "-c*O4.theta_dot")), Named("ForceOrTorque")
]
Dimensionless = Annotated[
    Expression, Dimension("dimensionless number", (1, "cos(alpha1)")), Named("Dimensionless")
]
Duration = Annotated[Expression, Dimension("time", (0, "0.5 s")), Named("Duration")]
Angle = Annotated[Expression, Dimension("angle", ("12 deg", "alpha1", 90)), Named("Angle")]
AngleOrLength = Annotated[
    Expression,
    Dimension("angle or length, as the coordinate", (150, "0.5 in")),
    Named("AngleOrLength"),
]
CoordinateRate = Annotated[
    Expression,
    Dimension("rate of the coordinate", ("0.1 rad/s", "2 in/s")),
    Named("CoordinateRate"),
]
CoordinateAcceleration = Annotated[
    Expression,
    Dimension("second rate of the coordinate", ("0.2 rad/s^2", 0)),
    Named("CoordinateAcceleration"),
]
CoordinateJerk = Annotated[
    Expression,
    Dimension("third rate of the coordinate", ("0.3 rad/s^3", 0)),
    Named("CoordinateJerk"),
]
Velocity = Annotated[Expression, Dimension("velocity", ("5 mm/s", 0.1)), Named("Velocity")]
Stiffness = Annotated[
    Expression,
    Dimension("force per length, or moment per angle (bare: per rad)", ("200 N/m", "5 N*m/rad")),
    Named("Stiffness"),
]
Damping = Annotated[
    Expression,
    Dimension("force per speed, or moment per angular rate (bare: per rad/s)", ("10 N*s/m", 0.2)),
    Named("Damping"),
]
AnyDimension = Annotated[
    Expression, Dimension("any dimension", ("12 deg", 0.5, "2*P1")), Named("AnyDimension")
]

Name = Annotated[
    str,
    Limits(pattern=NAME_PATTERN),
    Shown(("string",), "a name: letters, digits and _, not starting with a digit", ("crank",)),
    Named("Name"),
]
Coordinate = Annotated[
    str,
    Limits(pattern=COORDINATE_PATTERN),
    Shown(("string",), "a joint coordinate: joint.coordinate", ("O1.theta", "O2.s")),
    Named("Coordinate"),
]
CsvPath = Annotated[
    str,
    Limits(pattern=CSV_PATH_PATTERN),
    Shown(("string",), "a CSV file, relative to the file that names it", ("force.csv",)),
    Named("CsvPath"),
]

LengthVector = Annotated[
    tuple[Length, ...], Limits(min_length=3, max_length=3), Named("LengthVector")
]
DirectionVector = Annotated[
    tuple[AnyDimension, ...], Limits(min_length=3, max_length=3), Named("DirectionVector")
]
AccelerationVector = Annotated[
    tuple[Acceleration, ...], Limits(min_length=3, max_length=3), Named("AccelerationVector")
]
