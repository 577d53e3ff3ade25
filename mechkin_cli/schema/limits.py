"""`limits:` - where coordinates end: ends of strokes, stops, the play of a joint."""

from typing import Annotated, Any, ClassVar

from mechkin_cli.schema.base import FormChoice, Limits, Rule, SchemaName, Section, refuse
from mechkin_cli.schema.scalars import AngleOrLength, Dimensionless


class LimitSection(Section):
    """The least and the largest value of a coordinate."""

    tag = "(limit)"
    advice: ClassVar[dict[str, str]] = {
        "from": "write min: for the least value",
        "to": "write max: for the largest value",
    }

    min: AngleOrLength | None = None
    """The least value; left out, none."""
    max: AngleOrLength | None = None
    """The largest value; left out, none."""
    restitution: Dimensionless | None = None
    """Part of its rate, 0 to 1, with which the coordinate rebounds from the limit in a response;
    left out, the response ends there."""

    def check(self) -> None:
        """There is a limit."""
        if self.min is None and self.max is None:
            raise refuse("no-limit", "a limit has a least or a largest value", "add min: or max:")


def _limit(value: Any) -> str:
    return "(limit)" if isinstance(value, (dict, LimitSection)) else "(range)"


def _two(value: Any) -> Any:
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        text = "limits are a least and a largest value"
        raise refuse("limit-form", text, "write [-30 deg, 60 deg], or {max: 60 deg}")
    return value


CoordinateLimit = Annotated[
    Annotated[
        Annotated[
            tuple[AngleOrLength, ...], Limits(min_length=2, max_length=2), Rule(_two, before=True)
        ],
        "(range)",
    ]
    | LimitSection,
    FormChoice(_limit),
    SchemaName("CoordinateLimit"),
]
