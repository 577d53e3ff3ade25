"""Single values: expressions with the dimension a field has, names, texts, whole numbers.

A value arrives as the text that was written (or as a number from Python). Expressions stay text and
are not evaluated here; the dimension is attached for readers and for editors only.
"""

import re
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Annotated, Any, Final

from pydantic import BeforeValidator, Field
from pydantic.annotated_handlers import GetJsonSchemaHandler
from typing_extensions import TypeAliasType

from mechkin_cli.schema.base import refuse

NAME_PATTERN: Final = r"^[A-Za-z_][A-Za-z0-9_]*$"
COORDINATE_PATTERN: Final = r"^[A-Za-z_][A-Za-z0-9_]*\.[a-z][a-z0-9]*$"
TABLE_NAME_PATTERN: Final = r"^[A-Za-z0-9_-]{1,100}$"
CSV_PATH_PATTERN: Final = r"^[A-Za-z0-9_-][A-Za-z0-9_. -]*(/[A-Za-z0-9_-][A-Za-z0-9_. -]*)*\.csv$"

FORMS: Final = {
    NAME_PATTERN: ("a name", "use letters, digits and _, and no digit at the start"),
    COORDINATE_PATTERN: ("a joint coordinate", "write joint.coordinate, for example O1.theta"),
    TABLE_NAME_PATTERN: ("a name for a file", "use letters, digits, - and _, at most 100"),
    CSV_PATH_PATTERN: (
        "a CSV file beside or below the mechanism file",
        "write a relative path with / that ends in .csv",
    ),
}
"""What a text that fails a pattern should have been, and what to do."""

_NOT_A_NUMBER = re.compile(r"[+-]?\.?(nan|inf|infinity)", re.IGNORECASE)
# JSON Schema has no flag for ignoring case
_NOT_A_NUMBER_FOR_EDITORS = r"^[+-]?\.?([Nn][Aa][Nn]|[Ii][Nn][Ff]([Ii][Nn][Ii][Tt][Yy])?)$"
_WHOLE_NUMBER = re.compile(r"[+-]?[0-9]{1,9}")


@dataclass(frozen=True, slots=True)
class Shown:
    """What editors are told about a scalar: the JSON types it may have, a help text, examples."""

    types: tuple[str, ...]
    description: str
    examples: tuple[str | float, ...] = ()

    def __get_pydantic_json_schema__(
        self, schema: Any, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        inner = handler(schema)
        inner["type"] = self.types[0] if len(self.types) == 1 else list(self.types)
        inner["description"] = self.description
        if self.examples:
            inner["examples"] = list(self.examples)
        return inner


@dataclass(frozen=True, slots=True)
class Dimension:
    """The dimension a field's expression must have, in words, with examples for editors."""

    name: str
    examples: tuple[str | float, ...]

    def __get_pydantic_json_schema__(
        self, schema: Any, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        text = (
            f"{self.name}: a number in the file's units, a number with its unit, "
            "or an expression of parameters"
        )
        shown = Shown(("number", "string"), text, self.examples)
        inner = shown.__get_pydantic_json_schema__(schema, handler)
        not_finite = {"type": "string", "pattern": _NOT_A_NUMBER_FOR_EDITORS}
        return inner | {"minLength": 1, "not": not_finite}


def expression_text(value: Any) -> str:
    """The text of an expression, given as text or as a Python number.

    Raises a pydantic error for anything else, for an empty text, and for NaN and infinities.
    """
    text = _number_text(value)
    if text is None:
        text = value if isinstance(value, str) else None
    if text is None:
        raise refuse("not-a-number", "expected a number or an expression", "for example 0.5 in")
    text = text.strip()
    if not text:
        raise refuse("empty-value", "an empty text is no number", "write a number or an expression")
    if _NOT_A_NUMBER.fullmatch(text):
        raise refuse("not-finite", f"{text} is not a finite number", "write a finite value")
    return text


def whole_number(value: Any) -> int:
    """The whole number in a text (at most nine digits) or a Python integer."""
    if isinstance(value, Integral) and not isinstance(value, bool):
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


Expression = Annotated[str, BeforeValidator(expression_text)]
WholeNumber = Annotated[int, BeforeValidator(whole_number)]
Text = TypeAliasType(
    "Text",
    Annotated[
        str,
        BeforeValidator(plain_text),
        Shown(("string", "number", "boolean"), "a text for people"),
    ],
)

Length = TypeAliasType("Length", Annotated[Expression, Dimension("length", ("0.5 in", "-P1", 2.5))])
Mass = TypeAliasType("Mass", Annotated[Expression, Dimension("mass", ("2 lbm", 0.5))])
Inertia = TypeAliasType(
    "Inertia", Annotated[Expression, Dimension("moment of inertia", (0.02, "3 kg*m^2"))]
)
Acceleration = TypeAliasType(
    "Acceleration", Annotated[Expression, Dimension("acceleration", ("-9.80665 m/s^2", 0))]
)
Force = TypeAliasType("Force", Annotated[Expression, Dimension("force", ("10 N", "-k*O2.s"))])
Torque = TypeAliasType("Torque", Annotated[Expression, Dimension("moment", ("10 N*m", 10))])
ForceOrTorque = TypeAliasType(
    "ForceOrTorque",
    Annotated[Expression, Dimension("force or moment", ("10 N*m", "-c*O4.theta_dot"))],
)
Dimensionless = TypeAliasType(
    "Dimensionless", Annotated[Expression, Dimension("dimensionless number", (1, "cos(alpha1)"))]
)
Duration = TypeAliasType("Duration", Annotated[Expression, Dimension("time", (0, "0.5 s"))])
Angle = TypeAliasType("Angle", Annotated[Expression, Dimension("angle", ("12 deg", "alpha1", 90))])
AngleOrLength = TypeAliasType(
    "AngleOrLength",
    Annotated[Expression, Dimension("angle or length, as the coordinate", (150, "0.5 in"))],
)
CoordinateRate = TypeAliasType(
    "CoordinateRate",
    Annotated[Expression, Dimension("rate of the coordinate", ("0.1 rad/s", "2 in/s"))],
)
CoordinateAcceleration = TypeAliasType(
    "CoordinateAcceleration",
    Annotated[Expression, Dimension("second rate of the coordinate", ("0.2 rad/s^2", 0))],
)
CoordinateJerk = TypeAliasType(
    "CoordinateJerk",
    Annotated[Expression, Dimension("third rate of the coordinate", ("0.3 rad/s^3", 0))],
)
Stiffness = TypeAliasType(
    "Stiffness",
    Annotated[
        Expression,
        Dimension(
            "force per length, or moment per angle (bare: per rad)", ("200 N/m", "5 N*m/rad")
        ),
    ],
)
Damping = TypeAliasType(
    "Damping",
    Annotated[
        Expression,
        Dimension(
            "force per speed, or moment per angular rate (bare: per rad/s)", ("10 N*s/m", 0.2)
        ),
    ],
)
AnyDimension = TypeAliasType(
    "AnyDimension",
    Annotated[Expression, Dimension("any dimension", ("12 deg", 0.5, "2*P1"))],
)

Name = TypeAliasType(
    "Name",
    Annotated[
        str,
        Field(pattern=NAME_PATTERN),
        Shown(("string",), "a name: letters, digits and _, not starting with a digit", ("crank",)),
    ],
)
Coordinate = TypeAliasType(
    "Coordinate",
    Annotated[
        str,
        Field(pattern=COORDINATE_PATTERN),
        Shown(("string",), "a joint coordinate: joint.coordinate", ("O1.theta", "O2.s")),
    ],
)
CsvPath = TypeAliasType(
    "CsvPath",
    Annotated[
        str,
        Field(pattern=CSV_PATH_PATTERN),
        Shown(("string",), "a CSV file, relative to the mechanism file", ("force.csv",)),
    ],
)

LengthVector = TypeAliasType(
    "LengthVector", Annotated[tuple[Length, ...], Field(min_length=3, max_length=3)]
)
DirectionVector = TypeAliasType(
    "DirectionVector", Annotated[tuple[AnyDimension, ...], Field(min_length=3, max_length=3)]
)
AccelerationVector = TypeAliasType(
    "AccelerationVector", Annotated[tuple[Acceleration, ...], Field(min_length=3, max_length=3)]
)
