"""`motion:` - which coordinates are driven, and through which values.

Rows of a sweep: n = floor(|to - from|/|step| + 1e-9) + 1, x_i = from + i*step. One input is swept;
others are held (`at`), follow (`with`) or run in step through equally many values. Or the rows are
moments of `time`, and inputs move by laws.
"""

from typing import Annotated, Any, ClassVar, Literal

from mechkin_cli.schema.alternatives import Tag, by_word
from mechkin_cli.schema.base import NOTHING, Key, Section, refuse
from mechkin_cli.schema.laws import LAWS, TaggedLaw, law_tag
from mechkin_cli.schema.rules import Limits
from mechkin_cli.schema.scalars import (
    AngleOrLength,
    AnyDimension,
    Coordinate,
    CoordinateAcceleration,
    CoordinateJerk,
    CoordinateRate,
    Duration,
    WholeNumber,
)

_STEP_OR_COUNT: dict[str, Any] = {"oneOf": [{"required": ["step"]}, {"required": ["count"]}]}


class WithRates(Section):
    """What inputs with rows of their own share."""

    rate: CoordinateRate = "0"
    """Rate of the input, the same in every row."""
    acceleration: CoordinateAcceleration = "0"
    """Second rate of the input, the same in every row."""
    jerk: CoordinateJerk = "0"
    """Third rate of the input, the same in every row."""


class SweptInput(WithRates):
    """An input that runs from one value to another in equal steps."""

    editors: ClassVar[dict[str, Any]] = _STEP_OR_COUNT

    first: Annotated[AngleOrLength, Key("from")]
    """Value of the first row."""
    last: Annotated[AngleOrLength, Key("to")]
    """Value that the last row reaches or stays below."""
    step: AngleOrLength | None = None
    """Distance between rows, its sign does not matter; left out, `count` says it."""
    count: Annotated[WholeNumber, Limits(ge=1)] | None = None
    """Number of rows, the last of which is exactly `to`; left out, `step` says it."""

    def check(self) -> None:
        """Exactly one of step and count."""
        if self.step is None and self.count is None:
            raise refuse("missing-key", "from and to need a step or a count", "add one of them")
        if self.step is not None and self.count is not None:
            text = "step and count both say how many rows there are"
            raise refuse("two-choices", text, "keep one of them", "count")


class ListedInput(WithRates):
    """An input that takes the listed values, one per row."""

    values: Annotated[tuple[AngleOrLength, ...], Limits(min_length=1)]
    """The value of each row."""


class HeldInput(WithRates):
    """An input that has the same value in every row."""

    at: AngleOrLength
    """The value."""


class FollowingInput(Section):
    """An input that follows others; its rates follow from the expression by the chain rule."""

    value: Annotated[AnyDimension, Key("with")]
    """An expression of other inputs, and of `time` where there is one: `2*O1.theta`."""
    drive: Literal["own", "tie"] | None = None
    """`tie`: the motors of the inputs that it follows move it, too; `own`: it has a motor
    of its own; left out, `own`."""


class TimeSection(Section):
    """The moments of the rows, where the inputs are given by laws."""

    editors: ClassVar[dict[str, Any]] = _STEP_OR_COUNT

    first: Annotated[Duration, Key("from")]
    """First moment."""
    last: Annotated[Duration, Key("to")]
    """Last moment."""
    step: Duration | None = None
    """Time between rows; left out, `count` says it."""
    count: Annotated[WholeNumber, Limits(ge=1)] | None = None
    """Number of rows; left out, `step` says it."""

    def check(self) -> None:
        """Exactly one of step and count."""
        if (self.step is None) == (self.count is None):
            text = "time needs either a step or a count"
            raise refuse("step-or-count", text, "give exactly one of them")


def _tag(mapping: dict[str, Any]) -> str | None:
    if "law" in mapping:
        return law_tag(mapping)
    if {"from", "to", "step", "count"} & mapping.keys():
        return "(swept)"
    for key, tag in (("values", "(listed)"), ("with", "(following)"), ("at", "(held)")):
        if key in mapping:
            return tag
    return "(swept)"


InputMotion = Annotated[
    Annotated[SweptInput, Tag("(swept)")]
    | Annotated[ListedInput, Tag("(listed)")]
    | Annotated[HeldInput, Tag("(held)")]
    | Annotated[FollowingInput, Tag("(following)")]
    | TaggedLaw,
    by_word("law", _tag, ", ".join(LAWS)),
]


class MotionSection(Section):
    """The driven coordinates. Without inputs the mechanism has one row."""

    inputs: dict[Coordinate, InputMotion] = NOTHING
    """Driven coordinates by name; left out, one row, which stands as it is assembled."""
    time: TimeSection | None = None
    """The moments of the rows, for inputs that are given by laws; left out, inputs have rows of
    their own."""

    def check(self) -> None:
        """Laws go with `time`, rows of an input's own do not."""
        for name, motion in self.inputs.items():
            has_law = isinstance(motion, tuple(LAWS.values()))
            if has_law and self.time is None:
                text = f"the law of {name} needs the moments of the rows"
                raise refuse("law-without-time", text, "add time: {from, to, step}", "inputs", name)
            if self.time is not None and isinstance(motion, (SweptInput, ListedInput)):
                text = f"{name} lists rows of its own beside time:"
                hint = "give it a law, or remove time"
                raise refuse("rows-beside-time", text, hint, "inputs", name)
